-- run/binding.lua -- `at = { beta1 = 0.3 }`: values for the variables that expressions depend on, by name.
local check = require "ambit.check"
local core = require "ambit.core"
local session = require "ambit.session"

local binding = {}

-- Names of variables that exist but that these expressions do not depend on: a value for them is no mistake.
local function existing()
  local known = {}
  for _, m in pairs(session.mechanisms) do
    for _, c in ipairs(core.coordinates(m.handle)) do
      known[c.name] = true
    end
    for _, s in ipairs(core.speeds(m.handle)) do
      known[s.name], known[s.du_name], known["tau_" .. s.name:gsub("'", "")] = true, true, true
    end
    for _, c in ipairs(core.own_states(m.handle)) do known[c.name] = true end
  end
  for _, system in pairs(session.odes) do
    for _, name in ipairs(system.states) do known[name] = true end
  end
  return known
end

-- The value of a variable, in its unit. Variables of one name are one in all models: any model's unit of it will do.
function binding.value(leaf, value, what)
  local function in_unit(unit) return core.expression(value, unit ~= "1" and unit or nil, what) end
  local good, result = pcall(in_unit, leaf.unit)
  if good then return result end
  for _, unit in ipairs(session.units[leaf.name] or {}) do
    local fits, other = pcall(in_unit, unit)
    if fits then return other end
  end
  error(result, 0)
end

-- resolve(at, expressions, what) -> { leaf, ... }, { value, ... }
function binding.resolve(at, expressions, what)
  if at == nil then return {}, {} end
  check.table(at, what .. ": at")
  local leaf_of, leaves, values, others = {}, {}, {}, nil
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "symbol" then leaf_of[leaf.name] = leaf end
    if leaf.kind == "time" then leaf_of.t = leaf end
  end
  for _, name in ipairs(check.sorted(at)) do
    local leaf = leaf_of[name]
    if leaf then
      leaves[#leaves + 1] = leaf.expression
      values[#values + 1] = binding.value(leaf, at[name], ("%s: at.%s"):format(what, name))
      core.name_data({ values[#values] }, name)
    else
      others = others or existing()
      if not others[name] and name ~= "t" then
        for known in pairs(leaf_of) do others[known] = true end
        check.fail('%s: at: there is no variable `%s`%s', what, tostring(name), check.suggest(name,
          check.sorted(others)))
      end
    end
  end
  return leaves, values
end

return binding
