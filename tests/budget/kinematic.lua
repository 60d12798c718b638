-- kinematic.lua -- the smallest question about a mechanism: where is the tip? It needs no solver and no accelerations.
local ambit = require "ambit"
local m = ambit.mechanism "arm"
local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
print(ambit.evaluate { m:position(tip), at = { q = ambit.around("0.5", "0.01") } }.x)
