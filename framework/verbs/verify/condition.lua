-- verify/condition.lua -- the conditions of ambit.verify: `safe` (g <= 0 at all times), `at_end` (at the end) and
-- `reach` (at some time), each an expression, a function(s, p, t) that returns one, or a table of them.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local event = require "ambit.event"
local ode = require "ambit.ode"

local condition = {}

local kinds = { { key = "safe", kind = "always" }, { key = "at_end", kind = "at_end" },
  { key = "reach", kind = "once" } }

condition.keys = { "safe", "at_end", "reach" }

-- A table in which a wrong name is an error with the nearest one.
local function strict(values, what)
  return setmetatable({}, {
    __index = function(_, key)
      if values[key] == nil then
        check.fail("verify: there is no %s `%s`%s", what, tostring(key), check.suggest(key, check.sorted(values)))
      end
      return values[key]
    end,
  })
end

local function arguments(system)
  local states = {}
  for i, name in ipairs(system.states) do states[name] = ode.symbol(system, i) end
  return strict(states, "state"), strict(system.parameters, "parameter"), core.time()
end

local function add(list, kind, name, value, system, depth)
  if type(value) == "function" then value = formula.call(value, "verify: " .. name, arguments(system)) end
  if check.kind(value) ~= "table" then
    local g = event.formula(value, system, "verify: " .. name, "condition " .. name)
    list[#list + 1] = { kind = kind, name = name, g = g }
    return
  end
  local keys = check.sorted(value)
  if #keys == 0 then check.fail("verify: %s: expected a condition, got an empty table", name) end
  if depth > 0 then check.fail("verify: %s: expected an expression, got a table", name) end
  for _, key in ipairs(keys) do
    add(list, kind, type(key) == "string" and key or ("%s[%s]"):format(name, tostring(key)), value[key], system,
      depth + 1)
  end
end

-- -> { name, kind, g } in order
function condition.read(t, system)
  local list, known = {}, {}
  for _, entry in ipairs(kinds) do
    if t[entry.key] ~= nil then add(list, entry.kind, entry.key, t[entry.key], system, 0) end
  end
  if #list == 0 then
    check.fail "verify: nothing to prove: give `safe`, `at_end` or `reach`, an expression that shall not be positive"
  end
  for _, c in ipairs(list) do
    if known[c.name] then check.fail("verify: there are two conditions `%s`", c.name) end
    known[c.name] = true
  end
  return list
end

return condition
