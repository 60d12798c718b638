-- memory.lua -- what scenes and questions leave behind in one Lua state: bytes that live when everything that was
-- dropped has been freed, and whether the time grows more than in proportion.
--   ambit run scripts/bench/memory.lua                         the figures of docs/results.md: 2e4 scenes, 1e5 calls
--   ambit run scripts/bench/memory.lua scenes 100000           arms that are built, run for .01 s and dropped
--   ambit run scripts/bench/memory.lua evaluate 1000000        calls of a verb; also simulate, roots, verify, ...
local ambit = require "ambit"
local core = require "ambit.core"

local memory = {}

-- A three-link arm, built, run for .01 s and dropped.
function memory.scene()
  local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
  local at, start = m.world, {}
  for i = 1, 3 do
    at = m:revolute { from = at, axis = "z", name = "joint" .. i }
    at = m:rigid_link { from = at, offset = { ambit.around(1, "0.1%"), 0, 0 } }
    m:point_mass { at = at, mass = 1 }
    start["joint" .. i], start["joint" .. i .. "'"] = "0.1", 0
  end
  local run = ambit.simulate { m:dynamics(), initial = start, t = { 0, "0.01" } }
  assert(run.status == "complete", run.reason)
end

-- What is asked again and again of one expression or system, by the verb's name.
function memory.questions()
  local x = ambit.around(2, "1%")
  local e = ambit.sin(x) * x + 1
  local decay = ambit.ode { states = { "y" }, parameters = { k = ambit.around(1, "1%") },
    equations = function(s, p) return { y = -p.k * s.y } end }
  local square = function(s) return s.x ^ 2 - 2 end
  local safe = function(s) return 2 - s.y end
  return {
    evaluate = function() return ambit.evaluate { e } end,
    simulate = function() return ambit.simulate { decay, initial = { y = 1 }, t = { 0, "0.1" } } end,
    roots = function() return ambit.roots { square, box = { x = { 0, 5 } } } end,
    verify = function() return ambit.verify { decay, initial = { y = 1 }, t = { 0, "0.1" }, safe = safe } end,
    sample = function() return ambit.sample { e, n = 8 } end,
    sensitivity = function() return ambit.sensitivity { decay, initial = { y = 1 }, t = { 0, "0.1" } } end,
  }
end

memory.verbs = { "evaluate", "simulate", "roots", "verify", "sample", "sensitivity" }

-- Bytes and nodes that live once everything has been freed that can be.
function memory.living()
  local bytes, nodes
  for _ = 1, 3 do -- what a finalizer lets go is freed by the next collection
    collectgarbage()
    core.settle()
    bytes, nodes = core.heap()
  end
  return bytes or math.floor(collectgarbage "count" * 1024), nodes
end

-- Does it n times: bytes that each of the second half left, and the CPU seconds of both halves. The first half brings
-- everything that grows once to its size.
function memory.measure(n, doit)
  local half, seconds, bytes, nodes = n // 2, {}, {}, nil
  for part = 1, 2 do
    local begun = core.cpu()
    for _ = 1, half do doit() end
    seconds[part] = core.cpu() - begun
    bytes[part], nodes = memory.living()
  end
  return { bytes = (bytes[2] - bytes[1]) / half, nodes = nodes, megabytes = bytes[2] / 1e6, seconds = seconds }
end

-- The largest memory that this process has had, in MB; nil where the system does not say.
function memory.peak()
  local file = io.open "/proc/self/status"
  if not file then return nil end
  local kilobytes = file:read("a"):match "VmHWM:%s*(%d+)"
  file:close()
  return kilobytes and tonumber(kilobytes) / 1024
end

local function print_row(name, n, m)
  print(("| %s | %d | %.2f | %.1f | %s | %.2f |"):format(name, n, m.bytes, m.megabytes,
    memory.peak() and ("%.0f"):format(memory.peak()) or "-", m.seconds[2] / m.seconds[1]))
end

local function main(what, n)
  local doit = memory.questions()
  doit.scenes = memory.scene
  print "| what | times | bytes left by each | living, MB | most so far, MB | second half's time / first's |"
  print "|---|---:|---:|---:|---:|---:|"
  if what then
    assert(doit[what], "there is no such question: scenes, " .. table.concat(memory.verbs, ", "))
    print_row(what, n, memory.measure(n, doit[what]))
    return
  end
  local times = { evaluate = 100000, simulate = 20000, roots = 10000, verify = 2000, sample = 20000,
    sensitivity = 20000 }
  print_row("a three-link arm, built, run for .01 s, dropped", 20000, memory.measure(20000, memory.scene))
  for _, name in ipairs(memory.verbs) do
    print_row(("`%s`"):format(name), times[name], memory.measure(times[name], doit[name]))
  end
end

if arg and arg[0] and arg[0]:find "bench/memory%.lua$" then main(arg[1], tonumber(arg[2] or 1000)) end

return memory
