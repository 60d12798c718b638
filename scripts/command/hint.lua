-- hint.lua -- what may be meant where Lua's own message says only that a value is nil or of the wrong type. Read when a
-- scene has failed.
local core = require "ambit.core"

local function members()
  local names = {}
  for name in pairs(require "ambit") do names[#names + 1] = name end
  table.sort(names)
  return names
end

-- `ambit.` and the member of this name, or of the nearest one; false or nil: there is none.
local function meant(name)
  if require "ambit"[name] ~= nil then return "ambit." .. name end
  local near = #name > 3 and core.nearest(name, members()) -- short names are near too many
  return near and "ambit." .. near
end

-- A sentence behind the first line of a message; nil: nothing to add.
return function(message)
  local line = message:match "^[^\n]*"
  if line:find("a nil value (global 'ambit')", 1, true) then
    return "a scene begins with: local ambit = require \"ambit\""
  end
  local name = line:match "attempt to call a nil value %(global '([%w_]+)'%)$"
    or line:match "attempt to call a nil value %(field '([%w_]+)'%)$"
  local member = name and meant(name)
  if member then return ("is `%s` meant?"):format(member) end
  name = line:match "bad argument #%d+ to '([%w_]+)' %(number expected, got ambit%.[%w_]+%)$"
  if name and math[name] and require "ambit"[name] then
    return ("math.%s takes floats only; ambit.%s takes every value of Ambit's"):format(name, name)
  end
end
