-- report/json.lua -- Lua values as JSON that may stand inside an HTML page: whatever a name of the scene contains, it
-- stays a text. A table with an entry [1], or without any entry, is an array.
local json = {}

local Raw = {}

-- Text that is JSON already.
function json.raw(text) return setmetatable({ text }, Raw) end

-- Valid UTF-8: each byte that is none of it becomes U+FFFD.
function json.clean(text)
  local parts, from = {}, 1
  while true do
    local good, wrong = utf8.len(text, from)
    if good then
      parts[#parts + 1] = text:sub(from)
      return table.concat(parts)
    end
    parts[#parts + 1] = text:sub(from, wrong - 1)
    parts[#parts + 1] = "\u{FFFD}"
    from = wrong + 1
  end
end

-- Besides what JSON asks for: the letters that could end a script, and the two that end a line in JavaScript.
local function escape(letter) return ("\\u%04x"):format(utf8.codepoint(letter)) end

function json.text(value)
  local text = json.clean(value):gsub('[%c"\\<>&]', escape):gsub("\u{2028}", "\\u2028"):gsub("\u{2029}", "\\u2029")
  return '"' .. text .. '"'
end

-- A double for drawing only; null: not a finite number.
function json.drawn(x)
  if x ~= x or x == math.huge or x == -math.huge then return "null" end
  return x == 0 and "0" or ("%.5g"):format(x)
end

local encode

local function array(list)
  local parts = {}
  for i, value in ipairs(list) do parts[i] = encode(value) end
  return "[" .. table.concat(parts, ",") .. "]"
end

local function object(t)
  local names, parts = {}, {}
  for name in pairs(t) do names[#names + 1] = name end
  table.sort(names)
  for i, name in ipairs(names) do parts[i] = json.text(name) .. ":" .. encode(t[name]) end
  return "{" .. table.concat(parts, ",") .. "}"
end

function encode(value)
  local kind = type(value)
  if kind == "string" then return json.text(value) end
  if kind ~= "table" then return tostring(value) end
  if getmetatable(value) == Raw then return value[1] end
  return (value[1] ~= nil or next(value) == nil) and array(value) or object(value)
end

json.encode = encode

return json
