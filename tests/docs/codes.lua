-- The codes of <ambit/code.h>: docs/errors.md holds the table that `ambit errors --markdown` prints, and the code of
-- every outcome that some file of the tree gives is in it, as every code of it is given by some file: lua5.4 codes.lua
-- AMBIT
local ambit = arg[1]

local function output(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  assert(pipe:close(), command)
  return text
end

local function read(name)
  local file = assert(io.open(name))
  local text = file:read "a"
  file:close()
  return text
end

local table_text = output(ambit .. " errors --markdown")
assert(read "docs/errors.md":find(table_text, 1, true), "docs/errors.md does not hold what `ambit errors --markdown` prints")

local known, used = {}, {}
for code in table_text:gmatch "\n| `([%w.-]+)` |" do known[code] = true end
assert(known["unable.width"] and known.ok)

-- In C by name, in Lua as text.
local names = {}
for name, code in read "framework/kernel/abi/ambit/code.h":gmatch 'X%(([A-Z_]+),%s*"([%w.-]+)"' do names[name] = code end
for path in output "find framework plugins scripts -name '*.[ch]' -o -name '*.lua'":gmatch "[^\n]+" do
  local text = path:find "/code.h$" and "" or read(path)
  for name in text:gmatch "AMBIT_CODE_([A-Z_]+)" do
    if names[name] then used[names[name]] = true end
  end
  for code in (path:find "lua$" and text or ""):gmatch '"([a-z]+%.?[%w-]*)"' do
    local family = code:match "^[^.]+"
    if known[family] and code:find(".", 1, true) then
      assert(known[code], ("%s: the code %s is not in framework/kernel/abi/ambit/code.h"):format(path, code))
    end
    if known[code] then used[code] = true end
  end
end
for code in pairs(known) do assert(used[code], ("nothing gives the code %s"):format(code)) end
print "ok"
