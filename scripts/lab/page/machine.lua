-- page/machine.lua -- where and when a report was made, for those who compare its times with their own.
local core = require "ambit.core"

local machine = {}

local function processors()
  local file = io.open "/proc/cpuinfo"
  if not file then return nil end
  local model, count = nil, 0
  for line in file:lines() do
    local name = line:match "^model name%s*:%s*(.+)$" or line:match "^Processor%s*:%s*(.+)$"
    model = model or name
    if line:find "^processor%s*:" then count = count + 1 end
  end
  file:close()
  if count == 0 then return nil end
  return ("%s, %d processor%s"):format(model or "of unknown make", count, count == 1 and "" or "s")
end

-- { { name, text }, ... }
function machine.facts()
  local list = { { "Ambit", core.version }, { "made", os.date "!%Y-%m-%d %H:%M UTC" } }
  list[#list + 1] = { "machine", processors() or "unknown" }
  return list
end

return machine
