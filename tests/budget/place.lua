-- place.lua -- what a scene builds does not depend on where it lies, on the environment, or on the order in which Lua
-- goes through tables, which is another one in each process: lua5.4 tests/budget/place.lua AMBIT
package.path = "tests/budget/?.lua;" .. package.path
local measure = require "measure"

local ambit = assert(arg[1], "usage: place.lua AMBIT")
local RUNS = 2 -- of each, since the order is drawn anew
local failed = 0

local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end

-- A copy of the scene in a new folder with a long name; -> its path, a function that removes it
local function moved(scene)
  local root = os.tmpname()
  os.remove(root)
  local folder = root .. "/" .. ("another place "):rep(8)
  assert(os.execute(("mkdir -p %s && cp %s %s"):format(quoted(folder), quoted(scene), quoted(folder))))
  return folder .. "/" .. scene:match "[^/]*$", function() os.execute("rm -r " .. quoted(root)) end
end

local function compare(scene, where, first, other)
  for _, key in ipairs(measure.counts) do
    if first[key] ~= other[key] then
      failed = failed + 1
      print(("%s: %s: %s is %d, but %d %s"):format(scene, key, key, first[key], other[key], where))
    end
  end
end

for _, scene in ipairs { "scripts/verify_arm.lua", "scripts/manipulator.lua", "scripts/reduce_arm.lua" } do
  local first = assert(measure.scene(ambit, scene))
  local copy, remove = moved(scene)
  for _ = 1, RUNS do
    compare(scene, "another time", first, assert(measure.scene(ambit, scene)))
    compare(scene, "in another folder", first, assert(measure.scene(ambit, copy)))
  end
  remove()
end
os.exit(failed == 0)
