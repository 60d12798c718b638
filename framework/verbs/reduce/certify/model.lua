-- reduce/certify/model.lua -- what a reduction works on: states with their rates, and outputs, as plain tables of
-- expressions.
--
-- MODEL = { name, states = { name }, units = { text }, symbols = { expression }, rates = { expression },
-- outputs = { { name =, unit =, expression = } }, invariants, invariant_names: what vanishes along every solution,
-- varied = { [parameter or datum] = symbol }: what scenarios give values to, parameters: the values that the system
-- gives, system: the ambit.ode it comes from, with those symbols in it }
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"

local model = {}

-- An ambit.ode, or a mechanism, which stands for its equations of motion.
function model.system(subject, what)
  if mechanism.is(subject) then subject = subject:dynamics() end
  if not ode.is(subject) then
    check.fail("%s: expected m:dynamics() or an ambit.ode, got %s", what, check.kind(subject))
  end
  if subject.sampled then require "ambit.sampled".refuse(subject, what) end
  return subject
end

local function rate_unit(unit) return unit == "1" and "1/s" or unit .. "/s" end

-- "x", or "x'": the rate of x where no state has this name
local function named_output(m, name, what)
  for i, state in ipairs(m.states) do
    if state == name then return m.symbols[i], m.units[i] end
  end
  for i, state in ipairs(m.states) do
    if state .. "'" == name then return m.rates[i], rate_unit(m.units[i]) end
  end
  check.fail("%s: `%s` is no state%s; other outputs are written `name = function(s, p, t) return ... end`", what, name,
    check.suggest(name, m.states))
end

-- Accelerations of a mechanism, as the equations of motion give them.
local function in_motion(m, expression)
  if not m.system.mechanism then return expression end
  local leaves, values = {}, {}
  for _, speed in ipairs(core.speeds(m.system.mechanism.handle)) do
    for i, state in ipairs(m.states) do
      if state == speed.name then leaves[#leaves + 1], values[#values + 1] = speed.du, m.rates[i] end
    end
  end
  return core.substitute({ expression }, leaves, values)[1]
end

local function check_leaves(m, expression, what)
  local known = {}
  for _, symbol in ipairs(m.symbols) do known[#known + 1] = symbol end
  for _, symbol in pairs(m.varied) do known[#known + 1] = symbol end
  for _, leaf in ipairs(core.leaves { expression }) do
    local is_known = leaf.kind ~= "symbol"
    for _, symbol in ipairs(known) do is_known = is_known or symbol == leaf.expression end
    if not is_known then
      check.fail("%s depends on `%s`, which is no state of `%s`%s", what, leaf.name, m.name,
        check.suggest(leaf.name, m.states))
    end
  end
  return expression
end

local function written_output(m, value, what)
  if type(value) == "function" then value = formula.call(value, what, ode.arguments(m.system, true)) end
  value = core.expression(value, nil, what)
  local unit, expression = core.unit_of(value, true) or "1", in_motion(m, value)
  expression = ode.as_instance(m.system, { expression })[1] -- m:position(frame) is written with the data of m
  return check_leaves(m, expression, what), unit
end

-- { "x", "x'", y = function(s, p, t) ... end } -> { { name, unit, expression } }: listed ones first
local function read_outputs(m, outputs, what)
  what = what .. ": outputs"
  if outputs == nil then check.fail("%s are missing: names of states, or `name = function(s, p, t)`", what) end
  check.table(outputs, what)
  local list, seen = {}, {}
  local function add(name, expression, unit)
    if seen[name] then check.fail("%s: `%s` is given twice", what, name) end
    seen[name] = true
    list[#list + 1] = { name = name, unit = unit, expression = expression }
  end
  for _, key in ipairs(check.sorted(outputs)) do
    if type(key) == "string" then
      add(key, written_output(m, outputs[key], ("%s: `%s`"):format(what, key)))
    elseif math.type(key) ~= "integer" or key < 1 or key > #outputs then
      check.fail("%s: unexpected entry [%s]", what, tostring(key))
    else
      local name = check.text(outputs[key], ("%s[%d]"):format(what, key))
      add(name, named_output(m, name, what))
    end
  end
  if #list == 0 then check.fail("%s: expected at least one", what) end
  return list
end

-- symbols: { [parameter or datum] = symbol } or nil: what is not to have the value that the system gives it
function model.of(subject, outputs, what, symbols)
  local given = model.system(subject, what)
  local system = ode.instance(given, symbols or {}, what)
  local m = { name = system.name, states = system.states, units = system.units, symbols = system.symbols,
    rates = system.rates, system = system, parameters = given.parameters,
    varied = symbols or {} }
  m.invariants, m.invariant_names = core.system_invariants(system.system)
  m.outputs = read_outputs(m, outputs, what)
  return m
end

return model
