-- check.lua -- the messages that every verb and element shares: one line, names the thing, says what was expected.
local core = require "ambit.core"

local check = {}

-- Raises "scene.lua:12: message" at the nearest line that is not Ambit's own.
function check.fail(format, ...)
  local message = select("#", ...) > 0 and format:format(...) or format
  return core.fail((message:gsub("\0", "\\0"))) -- C would end the text there
end

-- What a value is, in a user's words.
function check.kind(value)
  local meta = getmetatable(value)
  if type(value) == "userdata" and type(meta) == "string" then return (meta:gsub("^ambit%.", "")) end
  if type(meta) == "table" and type(rawget(meta, "__name")) == "string" then return rawget(meta, "__name") end
  return type(value)
end

-- The keys of t: numbers by size, then the others as text.
function check.sorted(t)
  local list = {}
  for key in pairs(t) do list[#list + 1] = key end
  table.sort(list, function(a, b)
    local first, second = type(a) == "number", type(b) == "number"
    if first and second then return a < b end
    if first ~= second then return first end
    return tostring(a) < tostring(b)
  end)
  return list
end

-- '; did you mean "x"?', or the list of what there is.
function check.suggest(name, known)
  if type(name) ~= "string" then return "" end
  local near = core.nearest(name, known)
  if near then return ('; did you mean `%s`?'):format(near) end
  if #known == 0 then return "" end
  return " (there is: " .. table.concat(known, ", ") .. ")"
end

-- The one table that a verb or an element takes.
function check.table(value, what)
  if type(value) ~= "table" then check.fail("%s: expected a table { ... }, got %s", what, check.kind(value)) end
  return value
end

-- Every string key of t must be among `known`; `positional`: how many list entries are allowed.
function check.keys(t, known, what, positional)
  local is_known = {}
  for _, key in ipairs(known) do is_known[key] = true end
  for key in pairs(t) do
    if type(key) == "string" then
      if not is_known[key] then check.fail('%s: unknown key `%s`%s', what, key, check.suggest(key, known)) end
    elseif math.type(key) ~= "integer" or key < 1 or key > (positional or 0) then
      check.fail("%s: unexpected entry [%s]", what, tostring(key))
    end
  end
end

-- The methods of a class, each of which refuses to be called with a dot instead of a colon.
function check.methods(methods, class)
  for name, method in pairs(methods) do
    if type(method) == "function" and name:sub(1, 2) ~= "__" then
      methods[name] = function(self, ...)
        if getmetatable(self) ~= class then
          local kind = class.__name
          check.fail("%s: expected the %s in front of the colon, as in %s:%s(...), got %s", name, kind, kind, name,
            check.kind(self))
        end
        return method(self, ...)
      end
    end
  end
end

function check.text(value, what)
  if type(value) ~= "string" then check.fail("%s: expected text, got %s", what, check.kind(value)) end
  return value
end

-- A number as it is, anything else by its kind: for "expected ..., got ...".
function check.shown(value)
  return type(value) == "number" and tostring(value) or type(value) == "string" and ("the text `%s`"):format(value)
    or check.kind(value)
end

-- A positive integer, as data in Lua.
function check.count(value, what)
  local n = math.tointeger(value)
  if type(value) ~= "number" or not n or n < 1 then
    check.fail("%s: expected a positive integer, got %s", what, check.shown(value))
  end
  return n
end

return check
