-- A washing machine spins up with 0.5 kg of laundry off centre: the drum hangs on springs and dampers. Masses +-2 %,
-- springs and dampers +-5 %.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism { "washing machine", gravity = { 0, "-9.81", 0 } }
local across, jx = m:prismatic { from = m.world, axis = "x", name = "x" }
local tub, jy = m:prismatic { from = across, axis = "y", name = "y" }
m:point_mass { at = tub, mass = around(35, "2%", "tub") }
local drum = m:revolute { from = tub, axis = "z", angle = 12 * t ^ 2 }
local laundry = m:rigid_link { from = drum, offset = { "0.2", 0, 0 } }
m:point_mass { at = laundry, mass = around("0.5", "2%", "laundry") }
for _, joint in ipairs { jx, jy } do
  m:joint_spring { joint = joint, stiffness = around(9000, "5%", "spring") }
  m:joint_damper { joint = joint, damping = around(180, "5%", "damper") }
end

local run = ambit.simulate { m:dynamics(), initial = { x = 0, y = "-0.0387", ["x'"] = 0, ["y'"] = 0 },
  t = { 0, "0.5", 1, "1.5", 2, 3 } }
print(run)
