-- structure.lua -- connections that no mechanism can mean: an element that closes a loop between a thing and itself, or
-- closes it where another one of the same kind has closed it already.
--
-- What is left cannot be built at all: a part is connected only to what an element has handed out, so every frame
-- hangs on the world, by way of frames that were there before it.
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"

local structure = {}

-- The IN ports of an element that has equations of its own (a constraint port); nil for all others.
local function ends(d)
  local list, closes = {}, false
  for _, port in ipairs(d.ports) do
    closes = closes or port.kind == "constraint"
    if port.role == "in" then list[#list + 1] = port end
  end
  return closes and #list > 1 and list or nil
end

local DEEPEST = 3 -- a parameter is a number, a list or a list of rows; what is deeper is refused as what it is

local function text_of(value, depth)
  if type(value) ~= "table" or depth == DEEPEST then return tostring(value) end
  local list = {}
  for i, entry in ipairs(value) do list[i] = text_of(entry, depth + 1) end
  return table.concat(list, ",")
end

-- "gear 3:2 5:2": what says the same. Gears between the same joints never agree with each other; two closures of the
-- same frames may, when they compare different directions.
local function signature(d, places, t, of_joints)
  local words = { d.name, table.concat(places, " ") }
  for _, param in ipairs(of_joints and {} or d.parameters) do words[#words + 1] = text_of(t[param.name], 1) end
  return table.concat(words, " ")
end

-- Refuses what the table says about an element that is about to be added; returns what to enter once it has been.
function structure.check(self, type, t)
  local d = element.declaration(type)
  local ports = ends(d)
  if not ports or check.kind(t) ~= "table" then return end
  local places, at, of_joints = {}, {}, true
  for i, port in ipairs(ports) do
    if t[port.name] == nil then return end
    local part, number = frame.place(self, t[port.name], port.kind, ("%s: %s"):format(type, port.name))
    places[i] = ("%d:%d"):format(part, number)
    if at[places[i]] then
      check.fail("%s: `%s` and `%s` are the same %s, %s", type, at[places[i]], port.name, port.kind,
        tostring(t[port.name]))
    end
    at[places[i]] = port.name
    of_joints = of_joints and port.kind == "joint"
  end
  table.sort(places)
  local key = signature(d, places, t, of_joints)
  local other = self.closures[key]
  if other then
    check.fail("%s: it joins the same %ss as the %s `%s` (%s)", type, ports[1].kind, type,
      core.part_name(self.handle, other), self.places[other])
  end
  return key
end

-- The part has been added; passes the rest on.
function structure.enter(self, key, part, ...)
  if key then self.closures[key] = part end
  return ...
end

return structure
