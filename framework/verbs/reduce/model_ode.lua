-- reduce/model_ode.lua -- a reduced model as an ambit.ode that is ready to run: what scenarios vary is a parameter of
-- it again, uncertain data are the same data.
local check = require "ambit.check"
local core = require "ambit.core"
local ode = require "ambit.ode"

local model_ode = {}

-- A parameter's value: what the only scenario says, else what the detailed system says.
local function value_of(key, symbol, detailed, scenarios)
  if #scenarios > 1 then return type(key) == "string" and detailed.parameters[key] or key end
  for k, leaf in ipairs(scenarios[1].leaves) do
    if leaf == symbol then return scenarios[1].values[k] end
  end
end

-- Does an expression depend on data that others depend on?
local function shares(expression, leaves)
  for _, leaf in ipairs(core.leaves { expression }) do
    for _, other in ipairs(leaves) do
      if other.expression == leaf.expression then return true end
    end
  end
  return false
end

-- Does a value move with time? Then it is written into the equations: the value of a parameter does not.
local function moves(value)
  for _, leaf in ipairs(core.leaves { core.expression(value) }) do
    if leaf.kind == "time" then return true end
  end
  return false
end

-- The reduced model of a detailed one -> ode; data: { [name of a symbol] = value } of what only the reduced one has
function model_ode.of(m, detailed, scenarios, data)
  local parameters, inputs, symbols, names, leaves = {}, {}, {}, {}, core.leaves(m.rates)
  local function add(symbol, value)
    if not shares(symbol, leaves) then return end
    local n = #names + 1
    symbols[n], names[n] = symbol, core.leaves({ symbol })[1].name
    local field = moves(value) and inputs or parameters
    field[names[n]] = value
  end
  for _, key in ipairs(check.sorted(detailed.varied)) do
    local symbol = detailed.varied[key]
    add(symbol, value_of(key, symbol, detailed, scenarios))
  end
  for _, name in ipairs(check.sorted(data)) do add(core.symbol(name, "1"), data[name]) end
  for name, value in pairs(detailed.parameters) do
    if not parameters[name] and not inputs[name] and shares(value, leaves) then parameters[name] = value end
  end
  local function equations(s, p)
    local from, to = table.move(m.symbols, 1, #m.symbols, 1, {}), {}
    for i, state in ipairs(m.states) do to[i] = s[state] end
    for k, symbol in ipairs(symbols) do from[#from + 1], to[#to + 1] = symbol, inputs[names[k]] or p[names[k]] end
    return core.substitute(m.rates, from, to)
  end
  local states = {}
  for i, name in ipairs(m.states) do states[name] = m.symbols[i] end
  local system = core.system(m.states, m.units, m.symbols, equations(states, parameters))
  return ode.of_system(system, detailed.name, nil, parameters, equations)
end

return model_ode
