-- equilibria.lua -- ambit.equilibria { m:dynamics() or an ode, box = { beta1 = { lo, hi }, ... } }: every state of rest
-- in the box, proved.
--
-- At rest every rate vanishes. A rate that is nothing but another state (beta1' of beta1: a speed) says that this state
-- is 0; it is put in, and what is left are the accelerations at speed 0, or, where there is an implicit form without
-- forces of constraints, the balances of forces at acceleration 0, which divide by nothing. Invariants (closed loops,
-- the norm of a quaternion) must hold besides. Whether rest is stable is worked out for each point when
-- `point.stability` is read, or for all of them with stability = true.
local check = require "ambit.check"
local core = require "ambit.core"
local ode = require "ambit.ode"
local roots = require "ambit.roots"
local simulate = require "ambit.simulate"
local stability = require "ambit.stability"

local verb = {}

-- The rates, and what vanishes besides where they do: of a system in implicit form whose unknowns are all rates of
-- states, the equations at unknowns 0, which then say all that the rates of these states would.
local function balances(system)
  local form = not rawget(system, "rates") and core.system_implicit(system.system)
  if not form then return system.rates, {} end
  local zeros = {}
  for k, unknown in ipairs(form.unknowns) do
    local is_rate = false
    for _, rate in ipairs(form.rates) do is_rate = is_rate or rate == unknown end
    if not is_rate then return system.rates, {} end
    zeros[k] = core.expression(0)
  end
  return core.substitute(form.rates, form.unknowns, zeros), core.substitute(form.residuals, form.unknowns, zeros)
end

-- The states that must be 0: { name = true }. A mechanism knows its speeds; those of a quaternion are no one's rate.
function verb.speeds(system, rates)
  local speeds, is_state = {}, {}
  rates = rates or balances(system)
  for _, name in ipairs(system.states) do is_state[name] = true end
  for _, speed in ipairs(system.mechanism and core.speeds(system.mechanism.handle) or {}) do
    speeds[speed.name] = is_state[speed.name]
  end
  for i in ipairs(system.states) do
    for k, name in ipairs(system.states) do
      if rates[i] == system.symbols[k] then speeds[name] = true end
    end
  end
  return speeds
end

-- Does the rate of this state say nothing at rest? That of a coordinate of a mechanism is linear in the speeds; without
-- motions given in time there is nothing else in it. `own`: states with equations of their own.
local function is_idle(system, i, rate, speeds, own)
  if not system.mechanism or speeds[system.states[i]] or own[system.states[i]] then return false end
  return not roots.symbols({ rate }).t
end

-- The equations with all speeds 0, and the bindings that make them so.
local function equations(system, speeds, rates, others)
  local leaves, values, list, own = {}, {}, {}, {}
  for _, c in ipairs(system.mechanism and core.own_states(system.mechanism.handle) or {}) do own[c.name] = true end
  for k, name in ipairs(system.states) do
    if speeds[name] then leaves[#leaves + 1], values[#values + 1] = system.symbols[k], core.expression(0) end
  end
  local zero = core.expression(0)
  for i, rate in ipairs(rates) do
    local skipped = is_idle(system, i, rate, speeds, own) or #others > 0 and rate == zero
    for k, name in ipairs(system.states) do skipped = skipped or speeds[name] and rate == system.symbols[k] end
    if not skipped then list[#list + 1] = rate end
  end
  table.move(others, 1, #others, #list + 1, list)
  local invariants = core.system_invariants(system.system)
  table.move(invariants, 1, #invariants, #list + 1, list)
  return list, leaves, values
end

-- Nothing rests under what may change at any time, and eigenvalues at single values of it tell nothing of stability.
local function check_fixed(expressions)
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "varying" then
      check.fail("equilibria: `%s` varies in time, so that nothing stays at rest: use ambit.between for one unknown "
        .. "constant, or ambit.simulate for what can be reached", leaf.name)
    end
  end
end

local function check_box(names, system, speeds, what)
  local positions = {}
  for _, name in ipairs(system.states) do
    if not speeds[name] then positions[#positions + 1] = name end
  end
  local searched = {}
  for _, name in ipairs(names) do
    searched[name] = true
    if speeds[name] then check.fail("%s: box: the speed `%s` is 0 at rest; leave it out", what, name) end
    local known = false
    for _, position in ipairs(positions) do known = known or position == name end
    if not known then
      check.fail("%s: box: there is no state `%s`%s", what, name, check.suggest(name, positions))
    end
  end
  return searched
end

function verb.equilibria(t)
  check.table(t, "equilibria")
  local system = simulate.system(t, "equilibria")
  local q = roots.settings(t, "equilibria", { "box", "at", "stability" }, 1)
  if t.stability ~= nil and type(t.stability) ~= "boolean" then
    check.fail("equilibria: stability: expected true or false, got %s", check.kind(t.stability))
  end
  local rates, others = balances(system)
  check_fixed(rates)
  check_fixed(others)
  local speeds = verb.speeds(system, rates)
  local units = {}
  for i, name in ipairs(system.states) do units[name] = ode.unit(system, i) end
  local names, ranges = roots.read_box(t.box, "equilibria", units)
  local searched = check_box(names, system, speeds, "equilibria")
  local list, leaves, values = equations(system, speeds, rates, others)
  local symbols, allowed = roots.symbols(list), {}
  for _, name in ipairs(system.states) do allowed[name] = true end
  for _, name in ipairs(check.sorted(check.table(t.at == nil and {} or t.at, "equilibria: at"))) do
    if speeds[name] or searched[name] then check.fail("equilibria: at: `%s` has a place already", name) end
  end
  local more_leaves, more_values = roots.bind(t.at, symbols, allowed, "equilibria")
  table.move(more_leaves, 1, #more_leaves, #leaves + 1, leaves)
  table.move(more_values, 1, #more_values, #values + 1, values)
  q.expressions, q.names, q.ranges, q.leaves, q.values = list, names, ranges, leaves, values
  q.symbols = {}
  for i, name in ipairs(names) do
    for k, state in ipairs(system.states) do if state == name then q.symbols[i] = system.symbols[k] end end
  end
  q.more = stability.new { system = system, speeds = speeds, searched = searched, leaves = more_leaves,
    values = more_values }
  local found = roots.finish(q, "equilibria", roots.run(q))
  for _, point in ipairs(t.stability and found.proved or {}) do local _ = point.stability end
  return found
end

return verb
