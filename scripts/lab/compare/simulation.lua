-- compare/simulation.lua -- the same simulation by each combination of solver, arithmetic and options.
local agree = require "ambit.compare.agree"
local core = require "ambit.core"
local flow = require "ambit.run.flow"
local course = require "ambit.compare.course"
local event = require "ambit.event"
local judge = require "ambit.compare.judge"
local option = require "ambit.option"
local overestimation = require "ambit.compare.overestimation"
local reference = require "ambit.compare.reference"
local sample = require "ambit.sample"
local simulate = require "ambit.simulate"
local solvers = require "ambit.compare.solvers"

local simulation = {}

local REPEATING = 0.2 -- part of the limit that repeats of a run may take
local DRAWS = 300     -- of the inner hull, unless the scene says how many

-- The request q asked of the combination c. Threads would add their own overhead to CPU times.
local function request_of(q, c, dense)
  local run_options = {}
  for key, value in pairs(q.run_options or {}) do run_options[key] = value end
  run_options.threads = run_options.threads or 1
  run_options.dense = run_options.dense or dense
  run_options.last = false
  local watch = q.events and event.watch(q, q.events, {}) -- a watch is for one run
  return setmetatable({ watch = watch, solver = c.solver, options = c.options, arithmetic = c.arithmetic,
    arithmetic_options = c.arithmetic_options or {}, run_options = run_options, suggestion = false }, { __index = q })
end

-- What the end of a run says.
local function take(row, run)
  row.status, row.code, row.t_reached = run.status, run.code, run.t_reached
  row.reason = run.reason ~= "" and run.reason or nil
  row.steps, row.work, row.arithmetic = run.step_count, run.report, run.arithmetic
  row.unknowns, row.instructions = run.report.unknowns, run.report.tape_instructions
  row.rigorous = run.rigorous
  row.widths, row.width, row.values = {}, 0, {}
  for _, name in ipairs(run.states) do
    local x = run.x[name]
    row.values[name] = x
    row.widths[name] = x:width()
    row.width = math.max(row.width, x:width())
  end
end

local function least(a, b) return a and math.min(a, b) or b end

-- Timed runs after the one that warmed up, as long as they are worth their time.
local function repeated(q, c, settings, row)
  local began, cost = core.cpu(), row.seconds_first
  for i = 1, settings.repeats do
    if cost > REPEATING * settings.limit or core.cpu() - began + cost > settings.limit or core.interrupted() then
      break
    end
    local before = core.cpu()
    local run = simulate.solve(request_of(q, c, false))
    cost = core.cpu() - before
    if run.status == "stopped" then break end
    if i == 1 then
      row.seconds_run, row.seconds_build = nil, nil
      take(row, run)
    end
    row.seconds_run = least(row.seconds_run, run.report.seconds_run)
    row.seconds_build = least(row.seconds_build, run.report.seconds_build)
    row.repeats = i
    if core.cpu() - began > REPEATING * settings.limit then break end
  end
end

-- In the child: one combination -> what its row is to hold. The run that warms up is dense, for its course; the ones
-- that are timed are as the scene wants them.
local function measure(q, c, settings, instants)
  local row, began = {}, core.cpu()
  local run = simulate.solve(request_of(q, c, true))
  row.seconds_first = core.cpu() - began
  take(row, run)
  row.seconds_run, row.seconds_build, row.repeats = run.report.seconds_run, run.report.seconds_build, 1
  row.at = course.at(run, instants)
  local bracket = settings.reference and settings.reference.bracket
  row.at_reference = bracket and course.over(run, bracket)
  row.track, row.width_max = course.track(run)
  if run.status == "stopped" then
    row.reason = core.interrupted() and "interrupted" or
      ("its limit of %.3g s of CPU time is used up (`limit`)"):format(settings.limit)
  else
    repeated(q, c, settings, row)
  end
  return row
end

-- How many uncertain data there are; nil: the system is such that only a run can tell.
local function unknowns_of(q)
  local facts = core.look(flow(q, { solver = "" }))
  return facts and facts.unknowns
end

local function sampled(engine, q, settings)
  local result = engine:child(function()
    local inner, reason = sample.inner(q, settings.n or DRAWS, settings.seed, { cpu = 0.9 * settings.limit })
    return inner or { reason = reason }
  end)
  if not result then return nil, "interrupted" end
  if not result.data then return nil, result.message or "drawing was " .. result.outcome end
  if not result.data.lo then return nil, result.data.reason end
  return result.data
end

-- The instants at which rows are held against each other, the samples and the reference.
local function instants_of(q, inner, settings)
  local list, taken = {}, {}
  local function add(t)
    if t and not taken[t] then list[#list + 1], taken[t] = t, true end
  end
  for _, t in ipairs(q.times) do add(t) end
  for _, t in ipairs(inner and inner.t or {}) do add(t) end
  local first, last = q.times[1], q.times[#q.times]
  local forward = last > first
  local given = settings.reference
  if given and (given.t - first) * (given.t - last) <= 0 then add(given.t) end
  table.sort(list, function(a, b) if forward then return a < b end return a > b end)
  return list
end

local function units_of(system)
  local list = {}
  for i in ipairs(system.states) do list[i] = system.units[i] or "" end
  return list
end

local function outcome(comparison)
  local wrong = agree.contradiction(comparison)
  local complete = false
  for _, row in ipairs(comparison.rows) do complete = complete or row.rigorous and row.status == "complete" end
  comparison.contradicted = wrong ~= nil
  if wrong then
    comparison.status, comparison.code, comparison.reason = "broken", "broken.contradiction", wrong
  elseif not complete then
    comparison.status, comparison.reason = "unable", "no combination proved the simulation to its end"
  end
end

-- Fills the comparison of a request that simulate made.
function simulation.run(comparison, q, settings, engine)
  local times = q.times
  comparison.names, comparison.units = q.system.states, units_of(q.system)
  comparison.t = { times[1], times[#times] }
  comparison.unknowns = unknowns_of(q)
  local combinations = solvers.combinations(settings.solvers, settings.arithmetics)
  if comparison.unknowns ~= 0 and not comparison.sample then
    engine.progress.begin(0, #combinations, "sampled hull")
    comparison.sample, comparison.sample_problem = sampled(engine, q, settings)
  end
  comparison.instants = instants_of(q, comparison.sample, settings)
  local function way(row)
    return row.t_reached and (row.t_reached - times[1]) / (times[#times] - times[1])
  end
  comparison.rows = engine:rows(combinations,
    function(c) return measure(q, c, settings, comparison.instants) end, way)
  for _, row in ipairs(comparison.rows) do
    comparison.unknowns = comparison.unknowns or row.unknowns
    comparison.instructions = math.max(comparison.instructions or 0, row.instructions or 0)
  end
  overestimation.find(comparison)
  comparison.reference = reference.find(comparison, settings.reference, function(solver, options)
    local declaration = option.declaration("solver", solver)
    local c = { solver = solver, options = (option.collect(options, declaration)) }
    return engine:child(function() return measure(q, c, settings, comparison.instants) end)
  end)
  reference.hold_against(comparison)
  comparison.measure = judge.any(comparison.rows, "error") and "error" or "width"
  outcome(comparison)
end

return simulation
