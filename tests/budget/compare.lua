-- compare.lua -- what a scene needs against what it may need.
local measure = require "measure"

local compare = {}

-- compare.scene(scene, pins, m, memory) -> { complaint, ... }, { what has shrunk, ... }; memory: is it looked at?
function compare.scene(scene, pins, m, memory)
  local grown, shrunk = {}, {}
  local function complain(...) grown[#grown + 1] = ("%s: %s"):format(scene, string.format(...)) end
  for _, key in ipairs(measure.counts) do
    local limit = pins[key]
    if not limit then
      complain("%s is not in the budget", key)
    elseif m[key] > limit * (measure.slack[key] or 1) then
      complain("%s grew from %d to %d", key, limit, m[key])
    elseif m[key] < limit then
      shrunk[#shrunk + 1] = ("%s: %s shrank from %d to %d"):format(scene, key, limit, m[key])
    end
  end
  if memory and m.megabytes > pins.megabytes then
    complain("%.1f MB of memory, at most %.1f are allowed", m.megabytes, pins.megabytes)
  end
  for _, pattern in ipairs(pins.without or {}) do
    for _, name in ipairs(m.here) do
      if name:find(pattern) then complain("%s is loaded, but nothing like `%s` may be", name, pattern) end
    end
  end
  return grown, shrunk
end

return compare
