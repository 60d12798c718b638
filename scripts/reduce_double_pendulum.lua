-- reduce_double_pendulum.lua -- the double pendulum at small amplitudes, its first angle known to 1 %: which terms of
-- its equations of motion are needed to know where its hand is to a millimetre?
--
-- The mechanism of double_pendulum.lua, released at 0.05 rad. Terms are cut where they hardly matter, then what is left
-- is linearised where that hardly matters.
local ambit = require "ambit"
local around = ambit.around

local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
m:point_mass { at = hand, mass = 1 }

local small = ambit.reduce { m:dynamics(), t = { 0, 2 },
  initial = { beta1 = around("0.05", "1%"), beta2 = 0, ["beta1'"] = 0, ["beta2'"] = 0 },
  outputs = { "beta1", "beta2" }, error = { beta1 = "1e-3", beta2 = "2e-3" },
  reductions = { "neglect", "linearise" }, levels = 2, budget = 40 }
print(small)
