-- lua5.4 tests/docs/architecture.lua, in the root of the tree: the files and functions that docs/architecture.md and
-- CONTRIBUTING.md name are there, the table of rooms is nearly what scripts/rooms.lua counts, and the kernel is small.
local MOST = 15000 -- lines of C in the kernel
local NEAR = 0.1  -- by which lines of a room may be off

local function read(name)
  local file = assert(io.open(name), name .. " is not there")
  local text = file:read "a"
  file:close()
  return text
end

-- Is a function of this name defined in the file? "run.bounds" is bounds in Lua.
local function defines(path, name)
  local text, bare = "\n" .. read(path), name:match "[%w_]+$"
  if path:find "%.lua$" then
    return text:find("function [%w_.:]*%f[%w_]" .. bare .. "%(") or text:find("%f[%w_]" .. bare .. " = function")
  end
  return text:find("\n%a[%w_ *]*%f[%w_]" .. bare .. "%(") or text:find("\n#define " .. bare .. "%(")
end
assert(defines("tests/docs/architecture.lua", "x.defines") and not defines("tests/docs/architecture.lua", "lost"))

local page, stops = read "docs/architecture.md", 0
local _, walks = page:gsub("\n| stop |", "")
assert(walks >= 5, walks)
for path, name in page:gmatch "\n| `([%w_/.]+): ([%w_.]+)` |" do
  assert(defines(path, name), ("docs/architecture.md: there is no function %s in %s"):format(name, path))
  stops = stops + 1
end
local _, rows = page:gsub("\n| `[^`\n]+: ", "")
assert(rows == stops, "a stop that is not written as `FILE: FUNCTION`")
assert(stops >= 50, ("%d stops"):format(stops))
for _, name in ipairs { "docs/architecture.md", "CONTRIBUTING.md" } do
  for path in read(name):gmatch "`(%l+/[%w_/]+%.%l+)`" do
    local top = path:match "^%l+"
    if (top == "framework" or top == "plugins" or top == "tests" or top == "scripts") and not path:find "NAME" then
      read(path)
    end
  end
end

-- Rows of the table, by room: { C, Lua }.
local function rooms_of(text)
  local list, n = {}, 0
  for room, c, lua in text:gmatch "| `([%w_/]+)` | (%d+) | (%d+) |" do
    list[room], n = { tonumber(c), tonumber(lua) }, n + 1
  end
  return list, n
end
local pipe = assert(io.popen "lua5.4 scripts/rooms.lua")
local now, n = rooms_of(pipe:read "a")
pipe:close()
local then_, written = rooms_of(page)
assert(n >= 15 and n == written, ("%d rooms, %d of them in docs/architecture.md"):format(n, written))
for room, counts in pairs(now) do
  local old = assert(then_[room], room)
  for k = 1, 2 do
    local off = math.abs(counts[k] - old[k]) / math.max(counts[k], old[k], 2000)
    assert(off <= NEAR, ("%s has %d lines, docs/architecture.md says %d: lua5.4 scripts/rooms.lua docs/architecture.md")
      :format(room, counts[k], old[k]))
  end
end
local kernel = 0 -- without the descriptions of functions, of which there are as many as functions
for _, part in ipairs { "abi", "base", "num", "graph", "host" } do
  kernel = kernel + now["framework/kernel/" .. part][1]
end
assert(kernel <= MOST, ("the kernel has %d lines, %d are allowed"):format(kernel, MOST))
print(("%d stops, %d rooms, %d lines of kernel"):format(stops, n, kernel))
