-- notice.lua -- the budget notices what it is there for: an extra library, an extra plugin, 5 % more instructions, more
-- memory, quantities nobody asked for, a scene that fails; and it says when something shrank.
package.path = "tests/budget/?.lua;" .. package.path
local compare = require "compare"
local measure = require "measure"

local ambit = assert(arg[1], "usage: notice.lua AMBIT")
local scene = "tests/budget/kinematic.lua"
local failed = 0

local function expect(name, condition, ...)
  if condition then return end
  failed = failed + 1
  print("not noticed: " .. name, ...)
end

local function read(path)
  local file = assert(io.open(path))
  local text = file:read "a"
  file:close()
  return text
end

-- A scene that is the kinematic one and something more: its numbers.
local function bloated(more)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(read(scene), more)
  file:close()
  local m, problem = measure.scene(ambit, name)
  os.remove(name)
  return m, problem
end

local function pins_of(m)
  local pins = { megabytes = 1e9, without = { "^solver%." } }
  for _, key in ipairs(measure.counts) do pins[key] = m[key] end
  return pins
end

local base = assert(measure.scene(ambit, scene))
local pins = pins_of(base)

-- Is there a complaint with these words?
local function complains(m, words, memory, of)
  for _, line in ipairs((compare.scene(scene, of or pins, m, memory))) do
    if line:find(words, 1, true) then return true end
  end
  return false
end

expect("that nothing changed", #compare.scene(scene, pins, assert(measure.scene(ambit, scene)), false) == 0)

local solved = assert(bloated [[
local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 }, solver = "gsl" }]])
expect("a library", complains(solved, "libraries grew"))
expect("a plugin", complains(solved, "plugins grew"))
expect("a solver where none may be", complains(solved, "solver.gsl is loaded"))
expect("steps", complains(solved, "steps grew"))

local moved = assert(bloated [[
print(ambit.evaluate { m:velocity(tip), at = { q = 1, ["q'"] = ambit.around(1, 0.1) } }.x)]])
expect("quantities", complains(moved, "quantities grew"))
expect("instructions", complains(moved, "tape_instructions grew"))
expect("nodes", complains(moved, "nodes grew"))

-- on a scene with hundreds of instructions
local large = assert(measure.scene(ambit, "scripts/manipulator.lua"))
for _, key in ipairs { "tape_instructions", "operations", "nodes" } do
  local tight = pins_of(large)
  tight[key] = math.floor(large[key] / 1.05)
  expect("5 % more " .. key, complains(large, key .. " grew", false, tight))
end

local tight = pins_of(base)
tight.megabytes = base.megabytes / 2
expect("memory", complains(base, "of memory", true, tight))
expect("that memory is not looked at", not complains(base, "of memory", false, tight))
tight.nodes = nil
expect("a count without a budget", complains(base, "nodes is not in the budget", false, tight))

local roomy = pins_of(base)
roomy.nodes = roomy.nodes + 10
local grown, shrunk = compare.scene(scene, roomy, base, false)
expect("what shrank", #grown == 0 and #shrunk == 1 and shrunk[1]:find "nodes shrank", shrunk[1])

local none, problem = bloated "error 'broken'"
expect("a scene that fails", none == nil and problem:find "broken", problem)

print(failed == 0 and "everything was noticed" or failed .. " not noticed")
os.exit(failed == 0)
