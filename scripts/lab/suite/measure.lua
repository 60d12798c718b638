-- suite/measure.lua -- one combination of one case: the question is asked, the answer is looked at. Runs in a child.
--
-- The answer is wrong if an enclosure misses its reference, has a NaN for a bound, or bounds the wrong way round;
-- bounds are looked at on the way too.
local core = require "ambit.core"
local option = require "ambit.option"

local measure = {}

local MOST_DIGITS = 17

local function is_enclosure(x) return type(x) == "userdata" or (type(x) == "table" and x.lo ~= nil) end

-- What is the matter with an enclosure, or nil.
local function fault(name, x, where)
  if type(x) == "userdata" and x:is_empty() then return end
  if x.lo ~= x.lo or x.hi ~= x.hi then return ("%s%s has a NaN for a bound"):format(name, where) end
  if x.lo > x.hi then return ("%s%s has its bounds the wrong way round"):format(name, where) end
end

-- -- against the reference

local function relative(error, reference)
  local size = math.abs(reference:mid())
  return size > 0 and error / size or error
end

local function digits_of(error)
  if not (error > 0) then return error == 0 and MOST_DIGITS or 0 end
  return math.max(0, math.min(MOST_DIGITS, -math.log(error, 10)))
end

-- How far the truth can be from what was found, at most (rigorous) or about.
local function distance(x, reference, rigorous)
  if rigorous then return math.max(reference.hi - x.lo, x.hi - reference.lo, 0) end
  return math.abs((x.lo + x.hi) / 2 - reference:mid())
end

local function misses(x, reference)
  return (type(x) == "userdata" and x:is_empty()) or x.lo > reference.hi or x.hi < reference.lo
end

-- names: in order -> digits right, and what is wrong
local function against(values, reference, rigorous, where)
  local digits = MOST_DIGITS
  local names = {}
  for name in pairs(reference) do names[#names + 1] = name end
  table.sort(names)
  for _, name in ipairs(names) do
    local known, x = pcall(function() return values[name] end)
    local truth = core.interval(reference[name])
    if not known or x == nil then error(("the reference names `%s`, which is no result"):format(name), 0) end
    if rigorous and misses(x, truth) then
      return nil, ("%s%s: [%.17g, %.17g] misses the reference %s"):format(name, where, x.lo, x.hi, tostring(truth))
    end
    digits = math.min(digits, digits_of(relative(distance(x, truth, rigorous), truth)))
  end
  return digits
end

-- Enclosures by name -> width, fault
local function look(values, where)
  local width, names = 0, {}
  for name in pairs(values) do names[#names + 1] = name end
  table.sort(names)
  for _, name in ipairs(names) do
    local x = values[name]
    local problem = fault(name, x, where)
    if problem then return nil, problem end
    if not (type(x) == "userdata" and x:is_empty()) then width = math.max(width, x.hi - x.lo) end
  end
  return width
end

-- -- simulate

local function at(t) return (" at t = %.9g"):format(t) end

local function check_step(step)
  for _, values in ipairs { step.x, step.has_tube and step.tube or {} } do
    local width, problem = look(values, at(step.t))
    if not width then return problem end
    for name, x in pairs(values) do
      if x:is_empty() then return ("%s%s is empty"):format(name, at(step.t)) end
    end
  end
end

-- All steps, or so many of them, evenly, where looking at all would take longer than the run.
local MOST_STEPS = 20000

local function check_steps(run)
  local stride, i = run.step_count // MOST_STEPS + 1, 0
  for step in run:steps() do
    i = i + 1
    local problem = i % stride == 0 and check_step(step)
    if problem then return problem end
  end
end

local outcome_of = { complete = "proved", unable = "unable", impossible = "unable", stopped = "late", empty = "proved",
  broken = "wrong" }

local function fill_reference(row, references, value_at)
  for _, reference in ipairs(references) do
    local values, where = value_at(reference.t)
    if not values and (row.outcome == "proved" or row.outcome == "computed") then
      row.outcome, row.reason = "wrong", ("the reference%s was held against nothing"):format(where)
      return
    end
    if values then
      local digits, problem = against(values, reference.x, row.rigorous, where)
      if problem then
        row.outcome, row.reason, row.digits = "wrong", problem, nil
        return
      end
      row.digits = digits
    end
  end
end

local function of_run(run, references)
  local row = { rigorous = run.rigorous, reason = run.reason, t_reached = run.t_reached, steps = run.step_count,
    seconds = run.cpu_seconds, arithmetic = run.arithmetic, outcome = outcome_of[run.status] }
  if row.outcome == "proved" and not run.rigorous then row.outcome = "computed" end
  if row.outcome == "late" then row.reason = ("the budget of CPU time was over at t = %.9g"):format(run.t_reached) end
  if row.outcome == "proved" or row.outcome == "computed" then row.reason = nil end
  local problem = check_steps(run)
  if problem then
    row.outcome, row.reason = "wrong", problem
    return row
  end
  local width, at_end = look(run.x, at(run.t_reached))
  if not width then
    row.outcome, row.reason = "wrong", at_end
    return row
  end
  row.width = run.rigorous and width or nil
  if row.outcome == "proved" and row.width == math.huge then
    row.outcome, row.reason = "wrong", "complete, but a state has no bounds" .. at(run.t_reached)
    return row
  end
  fill_reference(row, references, function(t)
    if not t then error("the reference names no time", 0) end
    return (t - run.t_start) * (t - run.t_reached) <= 0 and run:at(t) or nil, at(t)
  end)
  return row
end

local function copy(t)
  local own = {}
  for key, value in pairs(t) do own[key] = value end
  return own
end

local function simulate(ambit, case, c)
  local t = copy(case.make(ambit))
  local times = type(t.t) == "table" and t.t or { 0, t.t }
  t.solver, t.arithmetic, t.threads = c.solver, c.asked, t.threads or 1
  for key, value in pairs(c.options) do t[key] = value end
  local row = of_run(ambit.simulate(t), case.references)
  row.t_end = tonumber(times[#times])
  return row
end

-- -- the other questions

-- Enclosures in tables of any shape -> { [path] = enclosure }
local function flatten(value, path, into)
  if is_enclosure(value) then
    into[path == "" and "value" or path] = value
  elseif type(value) == "table" then
    for key, entry in pairs(value) do
      flatten(entry, path == "" and tostring(key) or path .. "." .. tostring(key), into)
    end
  end
  return into
end

local function no_bounds(values)
  for name, x in pairs(values) do
    if not (type(x) == "userdata" and x:is_empty()) and (x.hi - x.lo) == math.huge then return name end
  end
end

-- Enclosures that answer a question -> row
local function of_values(row, values, references)
  local width, problem = look(values, "")
  if problem then
    row.outcome, row.reason = "wrong", problem
    return row
  end
  row.width = row.width or width
  if next(references) then fill_reference(row, references, function() return values, "" end) end
  return row
end

local function evaluate(ambit, case, c)
  local t = copy(case.make(ambit))
  t.arithmetic = c.asked
  local declaration = option.declaration("arithmetic", c.arithmetic)
  local result = ambit.evaluate(t)
  local values = flatten(result, "", {})
  local row = { rigorous = declaration.rigorous, outcome = declaration.rigorous and "proved" or "computed" }
  local name = row.rigorous and no_bounds(values)
  if name then
    row.outcome = "unable"
    row.reason = ("%s has no bounds over these data: an operation has none there; narrow the data in `at`"):format(name)
  end
  return of_values(row, values, case.references)
end

-- The enclosures of a point, by coordinate.
local function coordinates(point)
  local values = {}
  for name, x in pairs(point) do
    if is_enclosure(x) then values[name] = x end
  end
  return values
end

local function holds(values, reference)
  for name, text in pairs(reference) do
    if values[name] == nil then error(("the reference names `%s`, which is no result"):format(name), 0) end
    if misses(values[name], core.interval(text)) then return false end
  end
  return true
end

-- Each reference is a root, which must lie in a box that is proved or undecided.
local function roots(ambit, case, c)
  local t = copy(case.make(ambit))
  t.solver = c.solver
  for key, value in pairs(c.options) do t[key] = value end
  local rest = ambit[case.question](t)
  local row = { rigorous = true, outcome = outcome_of[rest.status], reason = rest.reason, width = 0,
    steps = #rest.proved }
  if row.outcome == "proved" then row.reason = nil end
  local held = {}
  for _, list in ipairs { rest.proved, rest.undecided } do
    for _, point in ipairs(list) do
      local values = coordinates(point)
      local width, problem = look(values, "")
      if problem then row.outcome, row.reason = "wrong", problem end
      row.width = math.max(row.width, width or 0)
      for i, reference in ipairs(case.references) do held[i] = held[i] or holds(values, reference.x) end
    end
  end
  for i = 1, #case.references do
    if not held[i] then row.outcome, row.reason = "wrong", ("no box holds root %d of the reference"):format(i) end
  end
  return row
end

local asking = { simulate = simulate, evaluate = evaluate, roots = roots, equilibria = roots }

local function own(ambit, case, c)
  local answer = case.run(ambit, c.solver, c.asked, c.options)
  local row = copy(answer)
  row.enclosures = nil
  if row.rigorous == nil then row.rigorous = row.outcome ~= "computed" end
  if answer.enclosures then
    of_values(row, flatten(answer.enclosures, "", {}), case.references)
  else
    fill_reference(row, case.references, function() return nil, "" end)
  end
  return row
end

-- -> { outcome, reason, width, digits, t_reached, t_end, steps, seconds, arithmetic, rigorous }
function measure.row(case, c)
  local ambit = require "ambit"
  local ask = case.run and own or asking[case.question]
  if not ask then error(("no question is called `%s`"):format(case.question), 0) end
  local began = core.cpu()
  local row = ask(ambit, case, c)
  row.seconds = row.seconds or core.cpu() - began
  return row
end

return measure
