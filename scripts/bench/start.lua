-- start.lua -- how much memory a scene takes and how soon it has its first result, from the start of the process.
--
--   ambit run scripts/bench/start.lua [SCENE.lua ...]
--
-- Each run is a process of its own; CPU time, because others may be at work on the machine: the least of many runs and
-- the ratio of the median to it. Results begin when the first verb has returned.
local RUNS = 15
local MOST = 0.015 -- s to the first result of a kinematic scene
local MOST_MEMORY = 12e6 -- bytes

-- Runs before the scene: notes the CPU time when the first verb has returned.
local probe = [[
local core, session = require "ambit.core", require "ambit.session"
local finish, first = session.finish, nil
function session.finish(...)
  finish(...)
  first = first or core.cpu()
end
local scene, out = arg[1], arg[2]
print = function() end
io.output "/dev/null"
dofile(scene)
local _, peak = core.memory()
local file = assert(io.open(out, "w"))
file:write(("%.9f %.9f %d"):format(first or core.cpu(), core.cpu(), peak))
file:close()
]]

local function write(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end

local function own_program()
  local pipe = assert(io.popen "readlink /proc/$PPID/exe")
  local path = pipe:read "l"
  pipe:close()
  return path
end

-- { first =, whole = } in s of CPU, { memory = } in bytes: one run
local function run(program, script, scene)
  local out = os.tmpname()
  local good = os.execute(("%s run --quiet %s %s %s"):format(quoted(program), script, quoted(scene), out))
  local file = good and io.open(out)
  local first, whole, peak
  if file then first, whole, peak = file:read("n", "n", "n") end
  if file then file:close() end
  os.remove(out)
  return first and { first = first, whole = whole, memory = peak }
end

local function least_and_median(list)
  table.sort(list)
  return list[1], list[(#list + 1) // 2]
end

-- Lists of CPU times to the first result and of the whole scene, and the largest memory.
local function measured(program, script, scene)
  local firsts, wholes, memory = {}, {}, 0
  for i = 1, RUNS do
    local r = run(program, script, scene)
    if not r then error("cannot run " .. scene, 0) end
    firsts[i], wholes[i], memory = r.first, r.whole, math.max(memory, r.memory)
  end
  return firsts, wholes, memory
end

local scenes = #arg > 0 and arg or
  { "tests/budget/kinematic.lua", "scripts/manipulator.lua", "tests/budget/real.lua", "scripts/double_pendulum.lua" }
local kinematic = { ["tests/budget/kinematic.lua"] = true, ["scripts/manipulator.lua"] = true }

local program, script = own_program(), write(probe)
print(("%-32s %12s %8s %12s %8s %10s"):format("CPU time, least of " .. RUNS, "first result", "median/", "whole scene",
  "median/", "memory"))
for _, scene in ipairs(scenes) do
  local firsts, wholes, memory = measured(program, script, scene)
  local first, middle = least_and_median(firsts)
  local whole, half = least_and_median(wholes)
  print(("%-32s %9.1f ms %8.2f %9.1f ms %8.2f %7.1f MB%s"):format(scene, 1e3 * first, middle / first, 1e3 * whole,
    half / whole, memory / 1e6, kinematic[scene] and (first <= MOST and memory <= MOST_MEMORY) and
    "  within 15 ms and 12 MB" or kinematic[scene] and "  NOT within 15 ms and 12 MB" or ""))
end
os.remove(script)
