-- simulate.lua -- ambit.simulate { ode, initial = { x = 1 }, t = { 0, 1 }, solver = "lohner", <options of the solver>
-- }.
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.instant"
local loops = require "ambit.loops"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local option = require "ambit.option"
local run = require "ambit.run"
local session = require "ambit.session"

local verb = {}

-- The system that the verb's table starts with; a mechanism stands for its equations of motion.
function verb.system(t, what)
  local subject = t[1]
  if mechanism.is(subject) then return subject:dynamics() end
  if not ode.is(subject) then
    check.fail("%s: expected m:dynamics() or an ambit.ode as the first entry, got %s", what, check.kind(subject))
  end
  return subject
end

-- initial = { name = value } -> { expression, ... } in the order of the states
function verb.initial(t, system, what)
  if t == nil then
    check.fail("%s: initial is missing: a value for each of %s", what, table.concat(system.states, ", "))
  end
  check.table(t, what .. ": initial")
  local by_place = #t == #system.states
  if system.mechanism and not by_place then
    loops.check_speeds(system.mechanism, system.states, t, what .. ": initial")
  end
  if not by_place then check.keys(t, system.states, what .. ": initial") end
  local list = {}
  for i, name in ipairs(system.states) do
    local value
    if by_place then value = t[i] else value = t[name] end
    if value == nil then check.fail('%s: initial: the state `%s` has no value', what, name) end
    list[i] = core.expression(value, system.units[i], ("%s: initial.%s"):format(what, name))
  end
  return list
end

-- Everything that simulate and the sampling of a system share.
function verb.request(t, what, default_solver, own_keys)
  check.table(t, what)
  local system = verb.system(t, what)
  local solver = t.solver == nil and default_solver or check.text(t.solver, what .. ": solver")
  local declaration = option.declaration("solver", solver)
  local known = { "initial", "t", "solver", "arithmetic" }
  table.move(own_keys, 1, #own_keys, #known + 1, known)
  table.move(option.names(declaration), 1, #declaration.parameters, #known + 1, known)
  check.keys(t, known, ("%s with solver %s"):format(what, solver), 1)
  local options, settings = option.collect(t, declaration)
  local arithmetic, arithmetic_options = nil, {}
  if t.arithmetic ~= nil then
    arithmetic, arithmetic_options = option.arithmetic(t.arithmetic, what .. ": arithmetic")
  end
  return {
    system = system, solver = solver, options = options, settings = settings, arithmetic = arithmetic,
    arithmetic_options = arithmetic_options, initial = verb.initial(t.initial, system, what),
    times = instant.list(t.t, what .. ": t"),
  }
end

local function initial_enclosures(q)
  return function()
    local x, named = core.evaluate("interval", {}, q.initial, {}, {}), {}
    for i, name in ipairs(q.system.states) do named[name] = x[i] end
    return named
  end
end

local TORN = 1e-6 -- m, or what else a loop is measured in: more than any rounding, less than anybody wants

-- A solver that proves nothing does not look at the constraints: it would carry a loop that is open at the start along.
local function check_loops(q)
  local invariants, names = core.system_invariants(q.system.system)
  if #invariants == 0 or option.declaration("solver", q.solver).rigorous then return end
  local leaves, values = { core.time() }, { core.expression(q.times[1]) }
  table.move(q.system.symbols, 1, #q.system.symbols, 2, leaves)
  table.move(q.initial, 1, #q.initial, 2, values)
  for i, x in ipairs(core.evaluate("interval", {}, invariants, leaves, values)) do
    if not (x:mig() <= TORN) then
      check.fail("simulate: initial: the constraint `%s` is off by %s at the start; m:assemble finds values that fit",
        names[i], x)
    end
  end
end

-- A request -> its run.
function verb.solve(q)
  check_loops(q)
  local track, facts, report = core.simulate(q.system.system, q.solver, q.arithmetic, q.options, q.arithmetic_options,
    q.initial,
    q.times)
  facts.track, facts.states, facts.report = track, q.system.states, report
  facts.solver, facts.arithmetic, facts.t_start, facts.initial = q.solver, report.arithmetic, q.times[1],
    initial_enclosures(q)
  local result = run.new(facts)
  local hint = facts.status == "unable" and q.system.mechanism and loops.hint(q.system.mechanism, result)
  if hint then facts.reason = facts.reason .. "; " .. hint end
  return result
end

function verb.simulate(t)
  local q = verb.request(t, "simulate", "lohner", {})
  local result = verb.solve(q)
  session.finish("simulate", result, result.report,
    { "solver", q.solver, "arithmetic", result.arithmetic, "options", q.settings, "t_start", q.times[1], "t_end",
      q.times[#q.times] })
  session.remember(result, q)
  return result
end

return verb
