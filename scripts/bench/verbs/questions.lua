-- verbs/questions.lua -- what verbs.lua asks about each machine, in words of the machine: a list of { verb, what,
-- ask(machine, seconds) -> answered?, text }.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"

local questions = {}
local folder = (arg[0]:match ".*/" or "./") .. "robots/"

-- Runs the scene up to its simulation, which is not made: the request for it, over the machine's time, and the
-- mechanism.
local function capture(machine)
  local simulate, mechanism, load, named, left = ambit.simulate, ambit.mechanism, ambit.load, arg, {}
  local scene = {}
  ambit.simulate = function(t)
    scene.t = t
    error(left, 0)
  end
  local function keep(make)
    return function(...)
      scene.mechanism = make(...)
      return scene.mechanism
    end
  end
  ambit.mechanism, ambit.load = keep(mechanism), keep(load)
  arg = table.move(machine.words, 1, #machine.words, 1, { [0] = folder .. machine.scene .. ".lua" })
  local good, problem = pcall(dofile, arg[0])
  ambit.simulate, ambit.mechanism, ambit.load, arg = simulate, mechanism, load, named
  if not good and problem ~= left then error(problem, 0) end
  scene.system, scene.initial, scene.end_time = scene.t[1], scene.t.initial, ambit.number(machine.t)
  return scene
end

-- The scene's question with further keys.
local function question(scene, more)
  local t = { scene.system, initial = scene.initial, t = { 0, scene.end_time }, threads = 1 }
  for key, value in pairs(more or {}) do t[key] = value end
  return t
end

local function outcome(run)
  if run.status == "complete" then return "complete" end
  return ("%s at %.3g s: %s"):format(run.status, run.t_reached or 0, run.reason)
end

local function add(verb, what, ask)
  questions[#questions + 1] = { verb = verb, what = what, ask = function(machine, seconds)
    core.deadline(core.cpu() + seconds)
    local good, text = ask(capture(machine), machine)
    session.worst = "ok"
    return good, text
  end }
end

-- A value of the joint that every motion passes on its way, from an ordinary run: where it is after a third of the
-- time.
local function passed(scene, machine)
  local run = ambit.simulate(question(scene, { solver = "gsl", t = { 0, scene.end_time / 3, scene.end_time } }))
  local from, at, to = run:at(0)[machine.joint], run:at(run.times[2])[machine.joint], run.x[machine.joint]
  return at:mid(), from:mid(), to:mid()
end

add("simulate", "a run, and between its steps", function(scene, machine)
  local run = ambit.simulate(question(scene, { dense = true }))
  if run.status ~= "complete" then return false, outcome(run) end
  local between = run:at(run.t_reached * 0.37)[machine.joint]
  return true, ("%s, %d steps, %s within %.2g on the way"):format(run.solver, run.step_count, machine.joint,
    between:width())
end)

add("events", "an event", function(scene, machine)
  local level = passed(scene, machine)
  local run = ambit.simulate(question(scene, { events = { { name = "passed",
    g = function(s) return s[machine.joint] - level end } } }))
  local event = run.events[1]
  local good = run.status == "complete" and event and event.certain
  return good, good and ("one crossing, proved, its time within %.2g s"):format(event.t:width()) or outcome(run)
end)

add("poincare", "a return map", function(scene, machine)
  local level = passed(scene, machine)
  local map = ambit.poincare { scene.system, initial = scene.initial, t_max = scene.end_time,
    section = function(s) return s[machine.joint] - level end }
  local good = map.status == "complete" and #map.returns == 1
  if not good then return false, map.status .. ": " .. map.reason end
  local set = map.returns[1]
  local again = ambit.simulate { scene.system, initial = set.set, t = { 0, scene.end_time / 10 } }
  return again.status == "complete", ("at a time within %.2g s; gone on from: %s"):format(set.t:width(), outcome(again))
end)

add("hybrid", "a switch", function(scene, machine)
  local level = passed(scene, machine)
  local speed = machine.joint .. "'"
  local run = ambit.hybrid { mode = "free", initial = scene.initial, t = { 0, scene.end_time }, modes = {
    free = { scene.system, guards = { { g = function(s) return s[machine.joint] - level end, to = "braked",
      reset = function(s) return { [speed] = s[speed] * "0.9" } end } } },
    braked = { scene.system, guards = {} } } }
  local good = run.status == "complete" and #run.events == 1
  return good, good and ("one switch, its time within %.2g s"):format(run.events[1].t:width()) or outcome(run)
end)

add("verify", "bounds at all times", function(scene, machine)
  local _, from, to = passed(scene, machine)
  local far = math.max(math.abs(to - from), 1e-3)
  local low, high = math.min(from, to) - far, math.max(from, to) + far
  local report = ambit.verify { scene.system, initial = scene.initial, t = { 0, scene.end_time }, safe = {
    high = function(s) return s[machine.joint] - high end, low = function(s) return low - s[machine.joint] end } }
  return report.status == "proved", ("%s %s"):format(report.status, report.reason or "")
end)

-- Which datum has this in its name?
local function datum(scene, name)
  local form = core.system_implicit(scene.system.system)
  for _, leaf in ipairs(core.leaves(form.residuals)) do
    if leaf.kind == "unknown" and leaf.name and leaf.name:find(name, 1, true) then return leaf.expression end
  end
  error("no datum has `" .. name .. "` in its name", 0)
end

add("sensitivity", "the derivative by a mass", function(scene, machine)
  local wrt = { mass = datum(scene, machine.mass) }
  local found = ambit.sensitivity(question(scene, { wrt = wrt }))
  if found.run.status ~= "complete" then return false, outcome(found.run) end
  local by_mass = found:d(machine.joint, "mass")
  return true, ("d %s/d mass in %s"):format(machine.joint, by_mass)
end)

add("split", "data cut into pieces", function(scene)
  local run = ambit.simulate(question(scene, { split = 4 }))
  return run.status == "complete", ("%s, %d pieces"):format(outcome(run), run.pieces or 1)
end)

add("certify", "a smaller model, proved", function(scene, machine)
  local part = scene.mechanism:tree().parts
  local small = ambit.reduce { scene.system, t = { 0, scene.end_time }, initial = scene.initial,
    outputs = { machine.joint }, error = { [machine.joint] = "0.01" }, elements = { machine.light or part[#part].name },
    reductions = {} }
  return small.status == "complete" and #small.terms > 0, ("%s, error of %s %.2g"):format(small.status, machine.joint,
    small.error and small.error[machine.joint] or 0 / 0)
end)

add("continue", "a run, and one from its set", function(scene, machine)
  local first = ambit.simulate(question(scene, { t = { 0, scene.end_time / 2 } }))
  if first.status ~= "complete" then return false, outcome(first) end
  local second = ambit.simulate(question(scene, { initial = first:set(), t = { scene.end_time / 2, scene.end_time } }))
  if second.status ~= "complete" then return false, outcome(second) end
  local whole = ambit.simulate(question(scene))
  local one, two = whole.x[machine.joint], second.x[machine.joint]
  return one.lo <= two.hi and two.lo <= one.hi, ("complete, %.3g times as wide as in one go"):format(two:width()
    / one:width())
end)

add("compare", "solvers side by side", function(scene)
  local found = ambit.compare(question(scene, { repeats = 1, limit = 4 }))
  return found.status == "complete", found.advice or found.reason
end)

add("profile", "where the time goes", function(scene)
  core.profile_begin()
  local run = ambit.simulate(question(scene))
  local sums = require "ambit.profile.sums".of((core.profile_end()))
  return sums.total > 0 and run.status == "complete", ("%s, %d stages"):format(outcome(run), #sums.stages)
end)

add("stability", "rest, and whether it is stable", function(scene, machine)
  local box = {}
  for name, value in pairs(scene.initial) do
    if not name:find "'$" then
      local x = core.evaluate({ expressions = { core.expression(value) } })[1]
      box[name] = { x.lo - 1, x.hi + 1 }
    end
  end
  local found = ambit.equilibria { scene.mechanism, box = box, stability = true }
  local point = found.proved[1]
  return found.status == "complete", ("%s, %d found%s"):format(found.status, #found.proved,
    point and ", " .. point.stability or "")
end)

return questions
