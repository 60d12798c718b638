-- limits.lua -- the options --time, --memory and --output of every command that runs a scene: what a run may take.
local core = require "ambit.core"

local limits = {}

limits.usage = [[
  --time SECONDS, --memory SIZE, --output SIZE
                   limits: seconds on the clock, memory of the process, what is printed and recorded. A SIZE is a number
                   of bytes, with k, M or G behind it of 1024, 1024^2 or 1024^3. A run that reaches one is stopped (exit
                   code 5); what was done until then holds]]

-- The options of a command, with these.
function limits.with(known)
  for _, name in ipairs { "time", "memory", "output" } do known[name] = true end
  return known
end

local units = { [""] = 1, k = 2 ^ 10, M = 2 ^ 20, G = 2 ^ 30 }

local function size_of(text)
  local number, unit = text:match "^(%d+%.?%d*)([kMG]?)$"
  return number and tonumber(number) * units[unit]
end

-- What is said, and what it means; nil: it is no such thing.
local function read(name, text)
  if name == "time" then
    local seconds = text:match "^%d*%.?%d+$" and tonumber(text)
    return seconds and text .. " s", seconds
  end
  return text, size_of(text)
end

-- Sets the limits that the options name; nil, or what is wrong with them.
function limits.begin(options)
  for _, name in ipairs { "memory", "output", "time" } do
    local text = options[name]
    if text then
      local said, most = read(name, text)
      if not most or most <= 0 or most > 1e15 then
        return ("option `--%s` needs %s, got `%s`"):format(name,
          name == "time" and "seconds, like 10" or "a size, like 512M", text)
      end
      local problem = core.limit(name, most, said)
      if problem then return ("option `--%s`: %s"):format(name, problem) end
    end
  end
end

return limits
