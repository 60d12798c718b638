-- instant.lua -- times: doubles, in seconds. Text ("0.1", "5 ms") is taken as the nearest double: a step ends exactly
-- there.
local check = require "ambit.check"
local core = require "ambit.core"

local instant = {}

function instant.of(value, what)
  local t
  if type(value) == "number" then
    t = value + 0.0
  else
    t = type(value) == "string" and tonumber(value)
    if not t then
      local e = core.expression(value, "s", what)
      if not core.is_constant(e) then check.fail("%s: a time cannot be uncertain", what) end
      t = core.interval(e):mid()
    end
  end
  if t ~= t or t == math.huge or t == -math.huge then
    check.fail("%s: the time must be finite, got %s", what, value ~= value and "NaN" or tostring(value))
  end
  return t
end

-- t = { t0, ..., t1 }, ascending or descending; t = 10 means { 0, 10 }
function instant.list(t, what)
  if t == nil then check.fail("%s is missing: { start, ..., end } in seconds", what) end
  if type(t) ~= "table" then t = { 0, t } end
  local times = {}
  for i, value in ipairs(t) do times[i] = instant.of(value, ("%s[%d]"):format(what, i)) end
  check.keys(t, {}, what, #times)
  if #times < 2 then
    check.fail("%s: expected { start, ..., end }, got %d time%s", what, #times, #times == 1 and "" or "s")
  end
  local forward = times[#times] > times[1]
  if times[#times] == times[1] then check.fail("%s: the horizon is zero: start and end are both %s", what, core.literal(times[1])) end
  for i = 2, #times do
    if times[i] == times[i - 1] or (times[i] > times[i - 1]) ~= forward then
      check.fail("%s: the times must go one way, but %s follows %s", what, core.literal(times[i]),
        core.literal(times[i - 1]))
    end
  end
  return times
end

return instant
