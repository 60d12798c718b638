-- source.lua -- the mutations that are possible in a file.
--
-- A mutation is { file, line (its number), operator, old, new (lines), key }; the key names it by what the line says, so
-- that it stays the same when lines above change.
local operators = require "mutate.operators"

local source = {}

-- The text with comments and strings blanked out, of the same length.
local function blanked(text, is_lua)
  local function blank(s) return (s:gsub("[^\n]", " ")) end
  local out, at = {}, 1
  local openings = is_lua and { "%-%-%[(=*)%[", "%-%-", '"', "'" } or { "/%*", "//", '"', "'" }
  while at <= #text do
    local first, opening
    for _, pattern in ipairs(openings) do
      local a = text:find(pattern, at)
      if a and (not first or a < first) then first, opening = a, pattern end
    end
    if not first then break end
    out[#out + 1] = text:sub(at, first - 1)
    local last
    if opening == "/%*" then
      last = select(2, text:find("*/", first + 2, true))
    elseif opening:find("%[", 1, true) then
      last = select(2, text:find("]" .. text:match(opening, first) .. "]", first, true))
    elseif opening == "//" or opening == "%-%-" then
      last = (text:find("\n", first, true) or #text + 1) - 1
    else
      last = first
      repeat
        last = text:find(opening, last + 1, true) or #text
        local slashes = #text:sub(first + 1, last - 1):match "\\*$"
      until slashes % 2 == 0
    end
    out[#out + 1] = blank(text:sub(first, last or #text))
    at = (last or #text) + 1
  end
  out[#out + 1] = text:sub(at)
  return table.concat(out)
end

local function lines_of(text)
  local list = {}
  for line in (text .. "\n"):gmatch "(.-)\n" do list[#list + 1] = line end
  return list
end

-- Code inside a function: indented, no directive, no declaration of data that nothing calculates.
local function is_code(line) return line:find "^%s+%S" and not line:find "^%s*#" and not line:find "^%s*static const" end

-- Adds the mutations of a file to `list`.
function source.mutations(file, list)
  local input = assert(io.open(file))
  local text = input:read "a"
  input:close()
  local real, code = lines_of(text), lines_of(blanked(text, file:find "%.lua$"))
  for number, line in ipairs(code) do
    if is_code(line) and not real[number]:find "[\"']" then -- lines with texts stay as they are
      for _, operator in ipairs(operators) do
        for k, new in ipairs(operator[2](line)) do
          list[#list + 1] = { file = file, line = number, operator = operator[1], old = real[number], new = new,
            key = ("%s | %s %d | %s"):format(file, operator[1], k, line:match "^%s*(.-)%s*$") }
        end
      end
    end
  end
end

-- A mutation given by hand: { file, old, new } with texts that stand once in the file.
function source.find(entry)
  local input = assert(io.open(entry.file))
  for number, line in ipairs(lines_of(input:read "a")) do
    local a, b = line:find(entry.old, 1, true)
    if a then
      input:close()
      return { file = entry.file, line = number, operator = "named", old = line,
        new = line:sub(1, a - 1) .. entry.new .. line:sub(b + 1),
        key = ("%s | named 1 | %s -> %s"):format(entry.file, entry.old, entry.new) }
    end
  end
  error(("%s: no line holds `%s`"):format(entry.file, entry.old), 0)
end

-- The whole text of a file with one line replaced.
function source.with(text, mutation)
  local lines = lines_of(text)
  assert(lines[mutation.line] == mutation.old, mutation.key)
  lines[mutation.line] = mutation.new
  return table.concat(lines, "\n", 1, #lines)
end

return source
