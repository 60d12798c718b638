-- reduce/certify/couple.lua -- a detailed model and a reduced one, run together on the same data.
--
-- For x' = f(x) and y' = g(y), the error e = x - y obeys e' = f(x) - g(x - e): a system in x and e (about "detailed"),
-- written so that it vanishes with e and with what the models do not have in common (framework/algebra/difference.h);
-- or, with x = y + e, in y and e (about "reduced"). Both are true. In the first, x is enclosed by itself, whatever e
-- is; in the second it is f that damps e, and not g, from which a reduction may have taken the damping. A state of the
-- detailed model alone is x, a state of the reduced model alone is y; errors that vanish identically, and states that
-- nothing depends on, are left out. Why: docs/numerics/reduction.md.
local core = require "ambit.core"
local fresh = require "ambit.fresh"
local form = require "ambit.reduce.certify.couple_form"
local scenario = require "ambit.reduce.certify.scenario"

local couple = {}

local ZERO = core.expression(0)

local function expressions(outputs)
  local list = {}
  for i, output in ipairs(outputs) do list[i] = output.expression end
  return list
end

local function index_of(names)
  local index = {}
  for i, name in ipairs(names) do index[name] = i end
  return index
end

-- The symbols below an expression, as a function that asks for one of them.
local function dependence(expression)
  local list = {}
  for _, leaf in ipairs(core.leaves { expression }) do
    if leaf.kind == "symbol" then list[leaf.name] = leaf.expression end
  end
  return function(name, symbol) return list[name] == symbol end
end

local function initial_of(model, s, name) return model.initial and model.initial[name] or s.initial[name] end

-- The states that both models have: { name, unit, symbol, f, g, start = x(t0), error_start }, and those of the reduced
-- model alone.
local function compare(detailed, reduced, s)
  local f, g = scenario.apply(s, detailed.rates), scenario.apply(s, reduced.rates)
  local place, shared, own = index_of(detailed.states), {}, {}
  for j, name in ipairs(reduced.states) do
    local i, start = place[name], initial_of(reduced, s, name)
    local state = { name = name, unit = reduced.units[j], symbol = reduced.symbols[j], g = g[j], start = start }
    if i then
      state.f, state.error_start = f[i], core.difference({ s.initial[name] }, { start }, {}, {})[1]
      shared[#shared + 1] = state
    else
      own[#own + 1] = state
    end
  end
  return f, shared, own
end

-- Errors that may become other than zero: those with a source, and those that such an error reaches.
local function spread(shared)
  local f, g, active, count = {}, {}, {}, 0
  for j, state in ipairs(shared) do
    f[j], g[j], state.reaches = state.f, state.g, dependence(state.g)
  end
  for j, source in ipairs(core.difference(f, g, {}, {})) do
    if source ~= ZERO or shared[j].error_start ~= ZERO then active[j], count = true, count + 1 end
  end
  local before
  repeat
    before = count
    for j, state in ipairs(shared) do
      for k, other in ipairs(shared) do
        if not active[j] and active[k] and state.reaches(other.name, other.symbol) then
          active[j], count = true, count + 1
        end
      end
    end
  until count == before
  local list = {}
  for j, state in ipairs(shared) do
    if active[j] then list[#list + 1] = state end
  end
  return list
end

local function errors_of(active, used)
  local leaves, deltas, f, g = {}, {}, {}, {}
  for j, state in ipairs(active) do
    state.error_name = fresh.name("error of " .. state.name, used)
    state.error = core.symbol(state.error_name, state.unit)
    leaves[j], deltas[j], f[j], g[j] = state.symbol, state.error, state.f, state.g
  end
  return leaves, deltas, f, g
end

local function add(system, name, unit, symbol, rate, start)
  local n = #system.states + 1
  system.states[n], system.units[n], system.symbols[n], system.rates[n], system.initial[n] = name, unit, symbol, rate,
    start
end

-- All that could be in the coupled system: detailed and own are { name, unit, symbol, rate, start }.
local function everything(detailed, active, errors, own)
  local all = { states = {}, units = {}, symbols = {}, rates = {}, initial = {} }
  for _, list in ipairs { detailed, own } do
    for _, state in ipairs(list) do add(all, state.name, state.unit, state.symbol, state.rate, state.start) end
  end
  for j, state in ipairs(active) do
    add(all, state.error_name, state.unit, state.error, errors[j], state.error_start)
  end
  return all
end

-- The states that these expressions depend on, whatever way.
local function needed(all, roots)
  local place, wanted, open = {}, {}, core.leaves(roots)
  for i, name in ipairs(all.states) do place[name] = i end
  while #open > 0 do
    local leaf = table.remove(open)
    local i = leaf.kind == "symbol" and place[leaf.name]
    if i and all.symbols[i] == leaf.expression and not wanted[i] then
      wanted[i] = true
      for _, below in ipairs(core.leaves { all.rates[i] }) do open[#open + 1] = below end
    end
  end
  return wanted
end

-- Of the constraints { { expression, name } }, those between states that are all there.
local function whole(constraints, system)
  local there, list, names = {}, {}, {}
  for i, name in ipairs(system.states) do there[name] = system.symbols[i] end
  for _, constraint in ipairs(constraints) do
    local fits = true
    for _, leaf in ipairs(core.leaves { constraint[1] }) do
      fits = fits and (leaf.kind ~= "symbol" or there[leaf.name] == leaf.expression)
    end
    if fits then list[#list + 1], names[#names + 1] = constraint[1], constraint[2] end
  end
  return list, names
end

local function constraints_of(model, s, change)
  local list, at = scenario.apply(s, model.invariants or {}), {}
  for k, g in ipairs(change and change(list) or list) do at[k] = { g, model.invariant_names[k] } end
  return at
end

-- A part of `all`, ready to run: { system = { states, units, symbols, rates, system }, initial, times }; implicit: of
-- certify/couple_form.lua, or nil
local function request(all, wanted, constraints, s, implicit)
  local system, initial = { states = {}, units = {}, symbols = {}, rates = {}, initial = {} }, nil
  for i, name in ipairs(all.states) do
    if wanted[i] then add(system, name, all.units[i], all.symbols[i], all.rates[i], all.initial[i]) end
  end
  if #system.states == 0 then -- there has to be something that runs
    add(system, "nothing", "1", core.symbol("nothing", "1"), ZERO, ZERO)
  end
  initial, system.initial = system.initial, nil
  local invariants, names = whole(constraints, system)
  system.parameters = {}
  system.system = core.system(system.states, system.units, system.symbols, system.rates, invariants, names)
  if implicit then form.give(system, implicit) end
  return { system = system, initial = initial, times = s.times, split = s.split }
end

-- One model alone over a scenario: the states that its outputs need, and the outputs.
function couple.alone(model, s)
  local outputs = scenario.apply(s, expressions(model.outputs))
  local all = { states = {}, units = {}, symbols = {}, rates = {}, initial = {} }
  for i, rate in ipairs(scenario.apply(s, model.rates)) do
    add(all, model.states[i], model.units[i], model.symbols[i], rate, initial_of(model, s, model.states[i]))
  end
  local q = request(all, needed(all, outputs), constraints_of(model, s), s, form.of(model, s))
  q.outputs = outputs
  return q
end

-- Symbols of active states replaced: by symbol + sign e.
local function shifted(active, sign, list)
  local leaves, values = {}, {}
  for j, state in ipairs(active) do leaves[j], values[j] = state.symbol, state.symbol + sign * state.error end
  return core.substitute(list, leaves, values)
end

-- The states by the names of the detailed model: x, or, about "reduced", y where there is an error.
local function named_states(detailed, f, active, s, about)
  local by_name, list = {}, {}
  for _, state in ipairs(active) do by_name[state.name] = about == "reduced" and state end
  for i, name in ipairs(detailed.states) do
    local y = by_name[name]
    list[i] = { name = name, unit = detailed.units[i], symbol = detailed.symbols[i], rate = y and y.g or f[i],
      start = y and y.start or s.initial[name] }
  end
  return list
end

-- -> { system, initial, times, outputs = { error of each output, as an expression of the states } }
function couple.of(detailed, reduced, s, about)
  local f, shared, own = compare(detailed, reduced, s)
  local active = spread(shared)
  local leaves, deltas, u, w = errors_of(active, fresh.set(detailed.states, reduced.states))
  local errors = core.difference(u, w, leaves, deltas)
  local outputs = core.difference(scenario.apply(s, expressions(detailed.outputs)),
    scenario.apply(s, expressions(reduced.outputs)), leaves, deltas, true)
  local function at_x(list) return about == "reduced" and shifted(active, 1, list) or list end
  local function at_y(list) return about == "reduced" and list or shifted(active, -1, list) end
  local own_rates = {}
  for j, state in ipairs(own) do own_rates[j] = state.g end
  for j, rate in ipairs(at_y(own_rates)) do own[j].rate = rate end
  errors, outputs, f = at_x(errors), at_x(outputs), at_x(f)
  local all = everything(named_states(detailed, f, active, s, about), active, errors, own)
  local q = request(all, needed(all, outputs), constraints_of(detailed, s, at_x), s,
    #own == 0 and form.of_pair(detailed, reduced, s, active, about) or nil)
  q.outputs = outputs
  return q
end

return couple
