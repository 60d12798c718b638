-- replay.lua -- runs a scene as it stands, or once more with drawn values in place of its uncertain data.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"

local replay = {}
local folder = (arg[0]:match ".*/" or "./") .. "robots/"

-- Runs a scene silently up to its first question, which `answers` (by verb) take; makers: in place of around and
-- between.
local function run_scene(scene, words, makers, answers)
  local own, mine, left = {}, {}, {}
  for name, f in pairs(makers) do
    own[name], mine[name] = ambit[name], core[name]
    ambit[name], core[name] = f(core[name]), f(core[name])
  end
  local verbs, show, named, exit = {}, print, arg, os.exit
  for verb, answer in pairs(answers) do
    verbs[verb] = ambit[verb]
    local f = ambit[verb]
    ambit[verb] = function(t)
      left.result = answer(f, t)
      error(left, 0)
    end
  end
  arg = table.move(words, 1, #words, 1, { [0] = folder .. scene .. ".lua" })
  print = function() end
  local good, problem = pcall(dofile, arg[0])
  print, arg, os.exit = show, named, exit
  for verb, f in pairs(verbs) do ambit[verb] = f end
  for name in pairs(makers) do ambit[name], core[name] = own[name], mine[name] end
  session.worst = "ok" -- what cannot be proved is told by the table
  if not good and problem ~= left then error(problem, 0) end
  return left.result
end

-- The times of a request as doubles.
local function doubles(t)
  local list = {}
  for i, x in ipairs(type(t) == "table" and t or { 0, t }) do
    list[i] = math.type(x) and x or ambit.evaluate({ ambit.number(x), arithmetic = "interval" }):mid()
  end
  return list
end

-- The scene with its tolerances: { run or report, data = { { lo, hi }, ... } in the order in which they are made,
-- times, cpu_seconds }.
function replay.prove(scene, words, solver, seconds)
  local made = {}
  local function keep(f)
    return function(...)
      local datum = f(...)
      made[#made + 1] = datum
      return datum
    end
  end
  local function ask(verb, t)
    t.solver = solver
    if seconds < math.huge then core.deadline(core.cpu() + seconds) end
    local began = core.cpu()
    local result = verb(t)
    core.deadline(nil)
    return result, t, core.cpu() - began
  end
  local proof = run_scene(scene, words, { around = keep, between = keep }, {
    simulate = function(verb, t)
      t.t, t.threads = doubles(t.t), 1
      local run, _, cpu = ask(verb, t)
      return { run = run, times = t.t, cpu_seconds = cpu }
    end,
    verify = function(verb, t)
      local report, _, cpu = ask(verb, t)
      return { report = report, cpu_seconds = cpu }
    end,
  })
  proof.data = {}
  for k, datum in ipairs(made) do
    local range = ambit.evaluate { { datum }, arithmetic = "interval" }[1]
    proof.data[k] = { range.lo, range.hi }
  end
  return proof
end

-- A motion of the scene: the values of its states at the times. point: of each datum a number in [-1, 1], 0 if missing.
-- The ends are drawn a billionth inside, so that every value is one that the tolerance surely allows.
function replay.sample(scene, words, data, point, times)
  local k = 0
  local function value()
    return function()
      k = k + 1
      local range = data[k]
      local middle, radius = (range[1] + range[2]) / 2, (range[2] - range[1]) / 2
      return ambit.number(middle + (1 - 1e-9) * radius * (point[k] or 0))
    end
  end
  return run_scene(scene, words, { around = value, between = value }, {
    simulate = function(verb, t)
      t.t, t.solver, t.relative, t.absolute = table.move(times, 1, #times, 2, { 0 }), "gsl", 1e-12, 1e-14
      local run, values = verb(t), {}
      if run.status ~= "complete" then error("a sample ends: " .. tostring(run.reason), 0) end
      for i, time in ipairs(times) do
        values[i] = {}
        for name, x in pairs(run:at(time)) do values[i][name] = x:mid() end
      end
      return values
    end,
  })
end

return replay
