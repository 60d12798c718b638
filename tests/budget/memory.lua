-- memory.lua -- does anything stay behind when scenes are dropped and verbs are asked again and again?
-- Bytes are those that live; at full length: ambit run scripts/bench/memory.lua scenes 100000 (or a verb and a number).
package.path = (arg[0]:match ".*/" or "./") .. "../../scripts/bench/?.lua;" .. package.path
local ambit = require "ambit"
local memory = require "memory"

local times = { scenes = 600, evaluate = 4000, simulate = 2000, roots = 1000, verify = 800, sample = 2000,
  sensitivity = 2000 }
local NODES = 1000   -- what the module, the questions and nothing else may hold
local SETTLING = 4096 -- bytes by which tables of Lua and of the allocator differ between two counts
local bad = 0

local function expect(good, ...)
  if good then return end
  print(string.format(...))
  bad = bad + 1
end

local doit = memory.questions()
doit.scenes = memory.scene
for _, name in ipairs { "scenes", table.unpack(memory.verbs) } do
  local m = memory.measure(times[name], doit[name])
  expect(m.bytes < 1 + SETTLING / (times[name] // 2), "%s: each leaves %.1f bytes", name, m.bytes)
  expect(m.nodes < NODES, "%s: %d nodes of expressions live at the end", name, m.nodes)
end

-- The test itself: what is kept is seen.
local kept = {}
local m = memory.measure(1000, function() kept[#kept + 1] = ambit.around(1, "1%") end)
expect(m.bytes > 100 and m.nodes >= #kept, "1000 data that are kept: %.1f bytes each, %d nodes", m.bytes, m.nodes)
kept = nil
local _, nodes = memory.living()
expect(nodes < NODES, "data that are dropped: %d nodes live", nodes)

os.exit(bad == 0 and 0 or 1)
