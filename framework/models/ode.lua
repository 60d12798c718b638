-- ode.lua -- a first-order system x' = f(x, p, t): from a mechanism, or written down with ambit.ode.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local session = require "ambit.session"

local Ode = { __name = "ode" }

local ode = {}

-- The unit that a state was declared with; nil: none, so that any value fits. A mechanism declares all of its own.
function ode.unit(self, i)
  local unit = self.units[i]
  if unit == "1" and not self.mechanism then return nil end
  return unit
end

local function rate_unit(self, i)
  local unit = ode.unit(self, i)
  return unit and unit .. "/s"
end

-- The state i as functions get it: in its unit, where it has one; soft: which is not insisted on.
function ode.symbol(self, i, soft)
  return core.in_unit(self.symbols[i], ode.unit(self, i), soft or self.unchecked)
end

function Ode.__tostring(self)
  local lines = { ('ode "%s"'):format(self.name) }
  for i, name in ipairs(self.states) do lines[#lines + 1] = ("  d %s/dt = %s"):format(name, tostring(self.rates[i])) end
  return table.concat(lines, "\n")
end

-- The right-hand side of a state, as an expression.
function Ode:rate(name)
  for i, state in ipairs(self.states) do
    if state == name then return core.in_unit(self.rates[i], rate_unit(self, i)) end
  end
  check.fail('ode `%s`: no state `%s`%s', self.name, tostring(name), check.suggest(name, self.states))
end

for _, name in ipairs { "text", "lua", "latex", "modelica" } do
  Ode[name] = function(self, ...)
    if self.sampled then require "ambit.sampled".refuse(self, name) end
    return require "ambit.source".methods[name](self, ...)
  end
end
check.methods(Ode, Ode)

-- The right-hand sides, which of a large mechanism are written only now.
function Ode.__index(self, key)
  if key ~= "rates" then return Ode[key] end
  local rates = core.system_right(self.system)
  rawset(self, "rates", rates)
  return rates
end

local function object(system, name, mechanism, parameters, declaration)
  local names, units, symbols = core.system_parts(system)
  return setmetatable({ name = name, system = system, states = names, units = units, symbols = symbols,
    mechanism = mechanism or false, parameters = parameters or {}, declaration = declaration or false,
    unchecked = false }, Ode)
end

-- mechanism: the one whose equations of motion these are, if they are of one; parameters: { name = expression };
-- declaration: the equations as they were written, function(s, p, t), if they can be written again
function ode.of_system(system, name, mechanism, parameters, declaration)
  local self = object(system, name, mechanism, parameters, declaration)
  session.add_ode(self)
  return self
end

function ode.is(value) return getmetatable(value) == Ode end

-- A table of expressions in which a wrong name is an error, not nil.
local function strict(values, what)
  return setmetatable({}, {
    __index = function(_, key)
      if values[key] == nil then
        check.fail('%s: there is no `%s`%s', what, tostring(key), check.suggest(key, check.sorted(values)))
      end
      return values[key]
    end,
    __newindex = function(_, key) check.fail('%s: `%s` cannot be assigned; return the derivatives in a table', what,
      tostring(key)) end,
    __pairs = function() return next, values end,
  })
end

-- What a function(s, p, t) of a system is called with; of that of a mechanism function(s, p, t, m).
function ode.arguments(self, soft)
  local s = {}
  for i, name in ipairs(self.states) do s[name] = ode.symbol(self, i, soft) end
  return strict(s, "states"), strict(self.parameters, "parameters"), core.time(), self.mechanism or nil
end

-- { "x", "v" } or { x = "m", v = "m/s" } or, where the order counts, { { "x", "m" }, { "v", "m/s" } }
local function read_states(list)
  check.table(list, "ode: states")
  local names, units, seen = {}, {}, {}
  for i, name in ipairs(list) do
    local pair = type(name) == "table" and name or { name, "1" }
    names[i], units[i] = check.text(pair[1], "ode: states"), check.text(pair[2], "ode: unit of a state")
  end
  for _, key in ipairs(check.sorted(list)) do
    if type(key) == "string" then
      names[#names + 1], units[#units + 1] = key, check.text(list[key], "ode: unit of " .. key)
    end
  end
  if #names == 0 then check.fail "ode: states: expected at least one name" end
  for _, name in ipairs(names) do
    if seen[name] then check.fail('ode: state `%s` is given twice', name) end
    seen[name] = true
  end
  return names, units
end

local function read_parameters(t, is_state)
  local values = {}
  for _, name in ipairs(check.sorted(check.table(t or {}, "ode: parameters"))) do
    check.text(name, "ode: name of a parameter")
    if is_state[name] then check.fail('ode: `%s` is a state and a parameter', name) end
    values[name] = core.expression(t[name], nil, "ode: parameter " .. name)
    core.refuse_plain({ values[name] }, "ode: parameter " .. name)
    core.name_data({ values[name] }, name)
  end
  return values
end

-- The derivatives by state name: what the function returned, or a table of functions and expressions.
local function read_rates(result, self, s, p, t)
  check.table(result, "ode: equations")
  local rates, names = {}, self.states
  local by_place = #result == #names and next(result, #result) == nil
  if not by_place then check.keys(result, names, "ode: equations") end
  for i, name in ipairs(names) do
    local value
    if by_place then value = result[i] else value = result[name] end
    if value == nil then check.fail('ode: equations: the derivative of `%s` is missing', name) end
    if type(value) == "function" then value = formula.call(value, "ode: derivative of " .. name, s, p, t) end
    rates[i] = core.expression(value, rate_unit(self, i), "ode: derivative of " .. name)
    core.refuse_plain({ rates[i] }, "ode: derivative of " .. name, true)
    core.name_data({ rates[i] }, "derivative of " .. name)
  end
  return rates
end

-- self: { states, units, symbols } with which the equations are written; own: of how many of them, the others rest
local function write_rates(equations, self, parameters, own)
  local by_name = {}
  for i, name in ipairs(self.states) do by_name[name] = ode.symbol(self, i) end
  local s, p, time = strict(by_name, "ode: states"), strict(parameters, "ode: parameters"), core.time()
  local result = equations
  if type(result) == "function" then result = formula.call(result, "ode: equations", s, p, time) end
  if not own or own == #self.states then return read_rates(result, self, s, p, time) end
  local first = setmetatable({ states = table.move(self.states, 1, own, 1, {}) }, { __index = self })
  local rates = read_rates(result, first, s, p, time)
  for i = own + 1, #self.states do rates[i] = core.expression(0) end
  return rates
end

-- Is there something to be called again with other parameters?
local function is_rewritable(equations)
  if type(equations) == "function" then return true end
  for _, rate in pairs(type(equations) == "table" and equations or {}) do
    if type(rate) ~= "function" then return false end
  end
  return type(equations) == "table"
end

-- What controllers hold are states, too.
local function add_held(controllers, names, units)
  local taken = {}
  for _, name in ipairs(names) do taken[name] = true end
  for _, controller in ipairs(controllers) do
    for _, state in ipairs(require "ambit.sampled".states(controller)) do
      if taken[state.name] then check.fail("ode: sampled: there are two states `%s`", state.name) end
      taken[state.name] = true
      names[#names + 1], units[#units + 1] = state.name, state.unit
    end
  end
end

-- ambit.ode { states = { "x" }, parameters = { a = 1 }, equations = function(s, p, t) return { x = -p.a * s.x } end }
function ode.new(t)
  check.table(t, "ode")
  check.keys(t, { "states", "parameters", "equations", "name", "check_units", "sampled" }, "ode", 1)
  if t.check_units ~= nil and type(t.check_units) ~= "boolean" then
    check.fail("ode: check_units: expected true or false, got %s", check.kind(t.check_units))
  end
  if t.states == nil then check.fail "ode: states are missing: a list of names" end
  if t.equations == nil then
    check.fail "ode: equations are missing: a function(s, p, t) that returns the derivatives"
  end
  local names, units = read_states(t.states)
  local own, symbols, values = #names, {}, {}
  local controllers = t.sampled ~= nil and require "ambit.sampled".list(t.sampled, "ode: sampled") or {}
  add_held(controllers, names, units)
  for i, name in ipairs(names) do
    symbols[i] = core.symbol(name, units[i])
    values[name] = symbols[i]
  end
  local parameters = read_parameters(t.parameters, values)
  local unchecked = t.check_units == false
  local rates = write_rates(t.equations, { states = names, units = units, symbols = symbols, unchecked = unchecked },
    parameters, own)
  local self = ode.of_system(core.system(names, units, symbols, rates), t.name or t[1] or "ode", nil, parameters,
    #controllers == 0 and is_rewritable(t.equations) and t.equations)
  self.unchecked = unchecked
  if #controllers > 0 then require "ambit.sampled".attach(self, controllers) end
  return self
end

-- u such that a datum of one unknown u, of which it is a linear function, has a value; nil: it is none.
local function unknown_for(datum, value)
  local leaves = core.leaves { datum }
  if #leaves ~= 1 or leaves[1].kind ~= "unknown" then return nil end
  local u = leaves[1].expression
  local slope = core.derivative(datum, u)
  if not core.is_constant(slope) then return nil end
  return u, (value - core.substitute({ datum }, { u }, { core.expression(0) })[1]) / slope
end

-- { [name of a parameter or uncertain datum] = expression } -> what is written anew, and leaves to be replaced.
local function read_values(self, values, what)
  local parameters, anew, from, to = {}, false, {}, {}
  for name, value in pairs(self.parameters) do parameters[name] = value end
  for _, key in ipairs(check.sorted(values)) do
    local datum = key
    if type(key) == "string" then datum = self.parameters[key] end
    local value = core.expression(values[key], core.unit_of(datum), ("%s: %s"):format(what, tostring(key)))
    if type(key) == "string" then
      datum = self.parameters[key]
      if not datum then
        check.fail("%s: `%s` has no parameter `%s`%s", what, self.name, key,
          check.suggest(key, check.sorted(self.parameters)))
      end
      parameters[key] = value
    end
    if type(key) == "string" and self.declaration then
      anew = true
    else
      local u, inverse = unknown_for(core.expression(datum), value)
      if not u then
        check.fail("%s: `%s` cannot be replaced in the equations of `%s`: give ambit.ode its equations as a \z
          function(s, p, t), or make it an uncertain datum", what, tostring(key), self.name)
      end
      from[#from + 1], to[#to + 1] = u, inverse
    end
  end
  return parameters, anew, from, to
end

-- A system in which leaves that are no states are replaced everywhere: the system, its rates.
function ode.replaced(self, from, to)
  local invariants, names = core.system_invariants(self.system)
  local rates = core.substitute(self.rates, from, to)
  local system = core.system(self.states, self.units, self.symbols, rates, core.substitute(invariants, from, to), names,
    self.system, from, to)
  for _, jump in ipairs(core.system_jumps(self.system)) do
    core.system_jump(system, jump[1], jump[2], core.substitute(jump[3], from, to))
  end
  return system, rates
end

-- The same equations with other values of parameters: { v = expression }, by name, or by the uncertain datum that is
-- to be replaced.
function ode.instance(self, values, what)
  if next(values) == nil then return self end
  local parameters, anew, from, to = read_values(self, values, what or "instance")
  local system = self
  if anew then -- only what ambit.ode wrote: without invariants
    local rates = write_rates(self.declaration, self, parameters)
    system = { system = core.system(self.states, self.units, self.symbols, rates), rates = rates, states = self.states,
      units = self.units, symbols = self.symbols }
  end
  for name, value in pairs(parameters) do parameters[name] = core.substitute({ value }, from, to)[1] end
  local instance = object(ode.replaced(system, from, to), self.name, self.mechanism, parameters, self.declaration)
  instance.replaced, instance.unchecked = { from, to }, self.unchecked
  return instance
end

-- Expressions that were written with the data of the system, as an instance of it has them.
function ode.as_instance(self, list)
  local replaced = rawget(self, "replaced")
  return replaced and core.substitute(list, replaced[1], replaced[2]) or list
end

return ode
