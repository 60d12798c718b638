-- reduce/datum.lua -- uncertain data that a reduced model has and the detailed one has not: c1, c2, ...
--
-- In the equations a datum is a symbol with a name; each scenario gives it its unknown, the same one in all of them, as
-- it does for parameters that vary.
local core = require "ambit.core"

local datum = {}

local function name_of(leaf) return core.leaves({ leaf })[1].name end

local function used_names(m, scenarios)
  local used = {}
  for _, name in ipairs(m.states) do used[name] = true end
  for name in pairs(m.parameters) do used[name] = true end
  for _, s in ipairs(scenarios) do
    for _, leaf in ipairs(s.leaves) do used[name_of(leaf)] = true end
  end
  return used
end

-- fresh(lo, hi), texts -> a new symbol; what is known of them is in `made`: { { symbol, unknown }, ... }
function datum.maker(detailed, scenarios)
  local used, made, number = used_names(detailed, scenarios), {}, 0
  return function(lo, hi)
    repeat number = number + 1 until not used["c" .. number]
    local symbol, unknown = core.symbol("c" .. number, "1"), core.between(lo, hi, "c" .. number)
    made[#made + 1] = { symbol, unknown }
    for _, s in ipairs(scenarios) do
      s.leaves[#s.leaves + 1], s.values[#s.values + 1] = symbol, unknown
      s.by_key["c" .. number] = unknown
    end
    return symbol
  end, made
end

-- The names of what every scenario leaves alone over time: { [name] = true }.
function datum.steady(scenarios)
  local steady = {}
  for _, s in ipairs(scenarios) do
    for k, leaf in ipairs(s.leaves) do
      local name = name_of(leaf)
      if steady[name] == nil then steady[name] = true end
      for _, below in ipairs(core.leaves { s.values[k] }) do
        if below.kind == "time" then steady[name] = false end
      end
    end
  end
  return steady
end

-- Forgets what none of the expressions depends on: { [name] = unknown } of what is left.
function datum.prune(made, scenarios, expressions)
  local used, left, gone = {}, {}, {}
  for _, leaf in ipairs(core.leaves(expressions)) do used[leaf.name or ""] = true end
  for _, entry in ipairs(made) do
    local name = name_of(entry[1])
    if used[name] then left[name] = entry[2] else gone[name] = true end
  end
  for _, s in ipairs(scenarios) do
    for k = #s.leaves, 1, -1 do
      local name = name_of(s.leaves[k])
      if gone[name] then
        table.remove(s.leaves, k)
        table.remove(s.values, k)
        s.by_key[name] = nil
      end
    end
  end
  return left
end

return datum
