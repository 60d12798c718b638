-- ode.lua -- a first-order system x' = f(x, p, t): from a mechanism, or written down with ambit.ode.
local check = require "ambit.check"
local core = require "ambit.core"
local session = require "ambit.session"

local Ode = { __name = "ode" }
Ode.__index = Ode

function Ode.__tostring(self)
  local lines = { ('ode "%s"'):format(self.name) }
  for i, name in ipairs(self.states) do lines[#lines + 1] = ("  d %s/dt = %s"):format(name, tostring(self.rates[i])) end
  return table.concat(lines, "\n")
end

-- The right-hand side of a state, as an expression.
function Ode:rate(name)
  for i, state in ipairs(self.states) do
    if state == name then return self.rates[i] end
  end
  check.fail('ode `%s`: no state `%s`%s', self.name, tostring(name), check.suggest(name, self.states))
end

check.methods(Ode, Ode)

local ode = {}

-- mechanism: the one whose equations of motion these are, if they are of one; parameters: { name = expression }
function ode.of_system(system, name, mechanism, parameters)
  local names, units, symbols, rates = core.system_parts(system)
  local self = setmetatable({ name = name, system = system, states = names, units = units, symbols = symbols,
    rates = rates, mechanism = mechanism or false, parameters = parameters or {} }, Ode)
  session.add(session.odes, self)
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

-- What a function(s, p, t) of a system is called with.
function ode.arguments(self)
  local s = {}
  for i, name in ipairs(self.states) do s[name] = self.symbols[i] end
  return strict(s, "states"), strict(self.parameters, "parameters"), core.time()
end

-- { "x", "v" } or { x = "m", v = "m/s" }: a state with its unit
local function read_states(list)
  check.table(list, "ode: states")
  local names, units, seen = {}, {}, {}
  for i, name in ipairs(list) do names[i], units[i] = check.text(name, "ode: states"), "1" end
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
  for name, value in pairs(check.table(t or {}, "ode: parameters")) do
    check.text(name, "ode: name of a parameter")
    if is_state[name] then check.fail('ode: `%s` is a state and a parameter', name) end
    values[name] = core.expression(value, nil, "ode: parameter " .. name)
  end
  return values
end

-- The derivatives by state name: what the function returned, or a table of functions and expressions.
local function read_rates(result, names, s, p, t)
  check.table(result, "ode: equations")
  local rates = {}
  local by_place = #result == #names and next(result, #result) == nil
  if not by_place then check.keys(result, names, "ode: equations") end
  for i, name in ipairs(names) do
    local value
    if by_place then value = result[i] else value = result[name] end
    if value == nil then check.fail('ode: equations: the derivative of `%s` is missing', name) end
    if type(value) == "function" then value = value(s, p, t) end
    rates[i] = core.expression(value, nil, "ode: derivative of " .. name)
  end
  return rates
end

-- ambit.ode { states = { "x" }, parameters = { a = 1 }, equations = function(s, p, t) return { x = -p.a * s.x } end }
function ode.new(t)
  check.table(t, "ode")
  check.keys(t, { "states", "parameters", "equations", "name" }, "ode", 1)
  if t.states == nil then check.fail "ode: states are missing: a list of names" end
  if t.equations == nil then
    check.fail "ode: equations are missing: a function(s, p, t) that returns the derivatives"
  end
  local names, units = read_states(t.states)
  local symbols, values = {}, {}
  for i, name in ipairs(names) do
    symbols[i] = core.symbol(name, units[i])
    values[name] = symbols[i]
  end
  local parameters = read_parameters(t.parameters, values)
  local s, p = strict(values, "ode: states"), strict(parameters, "ode: parameters")
  local result = t.equations
  if type(result) == "function" then result = result(s, p, core.time()) end
  local rates = read_rates(result, names, s, p, core.time())
  return ode.of_system(core.system(names, units, symbols, rates), t.name or t[1] or "ode", nil, parameters)
end

return ode
