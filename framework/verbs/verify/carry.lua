-- verify/carry.lua -- conditions as further states of a system: y = g(x, p, t), y' = g_x f + g_t.
--
-- g over the box of all states forgets what the states have in common; a solver that keeps this for its states
-- (Lohner's set, a Taylor model) keeps it for y too. The first states are not touched: y is in nobody's right-hand
-- side.
local core = require "ambit.core"
local fresh = require "ambit.fresh"

local carry = {}

-- g_x f + g_t, or nil where g has no derivative, or may jump (atan2) so that it is not the integral of this.
function carry.rate_of(system, g)
  if core.jumps { g } then return nil end
  local good, sum = pcall(core.derivative, g, core.time())
  if not good then return nil end
  for i, state in ipairs(system.symbols) do
    local partial
    good, partial = pcall(core.derivative, g, state)
    if not good then return nil end
    sum = sum + partial * system.rates[i]
  end
  return sum
end

local function copy(list) return table.move(list, 1, #list, 1, {}) end

-- A request and conditions -> the request with them as states and { [k] = expression of the state } for condition k.
function carry.of(q, conditions)
  local system, outputs = q.system, {}
  local names, units, symbols, rates = copy(system.states), copy(system.units), copy(system.symbols), copy(system.rates)
  local further, used = {}, fresh.set(names)
  local leaves, values, initial = copy(system.symbols), copy(q.initial), copy(q.initial)
  leaves[#leaves + 1], values[#values + 1] = core.time(), core.expression(q.times[1])
  for k, condition in ipairs(conditions) do
    local rate = carry.rate_of(system, condition.g)
    if rate then
      local n = #names + 1
      names[n], units[n] = fresh.name("condition " .. condition.name, used), "1"
      symbols[n], rates[n], further[#further + 1] = core.symbol(names[n], "1"), rate, condition.g
      initial[n] = core.substitute({ condition.g }, leaves, values)[1]
      outputs[k] = symbols[n]
    end
  end
  local invariants, invariant_names = core.system_invariants(system.system)
  local carrying = setmetatable({ initial = initial }, { __index = q })
  carrying.system = setmetatable({ states = names, units = units, symbols = symbols, rates = rates,
    system = core.system(names, units, symbols, rates, invariants, invariant_names, system.system, {}, {},
      further) }, { __index = system })
  return carrying, outputs
end

return carry
