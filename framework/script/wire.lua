-- wire.lua -- plain data as a text and back, exactly: what a child process hands to its parent. Tables of booleans,
-- numbers, texts, enclosures and such tables, no cycles; anything else is an error that names where it is.
local check = require "ambit.check"
local core = require "ambit.core"

local wire = {}

local function number(x)
  if math.type(x) == "integer" then return ("%d"):format(x) end
  if x ~= x then return "0/0" end
  if x == math.huge then return "1/0" end
  if x == -math.huge then return "-1/0" end
  return ("%a"):format(x)
end

local write

local writers = {
  boolean = tostring,
  number = number,
  string = function(x) return ("%q"):format(x) end,
  table = function(x, path)
    local list = {}
    for key, value in pairs(x) do
      list[#list + 1] = ("[%s]=%s"):format(write(key, path), write(value, path .. "." .. tostring(key)))
    end
    return "{" .. table.concat(list, ",") .. "}"
  end,
  userdata = function(x, path)
    if check.kind(x) ~= "enclosure" then error(("wire: %s is a %s"):format(path, check.kind(x)), 0) end
    if x:is_empty() then return "E '[empty]'" end
    return ("E(%s,%s)"):format(number(x.lo), number(x.hi))
  end,
}

function write(x, path)
  local writer = writers[type(x)]
  if not writer then error(("wire: %s is a %s"):format(path, type(x)), 0) end
  return writer(x, path)
end

-- data -> text
function wire.write(data) return "return " .. write(data, "data") end

-- text -> data
function wire.read(text)
  return assert(load(text, "=wire", "t", { E = core.interval }))()
end

return wire
