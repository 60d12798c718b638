-- A rotary pendulum is held upright by state feedback: from within 2 degrees it stays within 6 degrees and ends within
-- 1 degree after 4 s. Masses +-2 %, friction +-5 %, lengths +-0.1 mm.
local ambit = require "ambit"
local around, degrees = ambit.around, ambit.degrees

local m = ambit.mechanism { "rotary pendulum", gravity = { 0, 0, "-9.81" } }
local arm, motor = m:revolute { from = m.world, axis = "z", name = "arm" }
m:rigid_body { at = arm, mass = 1, physical = false,
  inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, around("0.002", "2%", "arm inertia") } } }
local edge = m:rigid_link { from = arm, offset = { around("0.2", "0.1 mm", "arm length"), 0, 0 } }
local rod, pin = m:revolute { from = edge, axis = "x", name = "rod" }
local tip = m:rigid_link { from = rod, offset = { 0, 0, around("0.3", "0.1 mm", "rod length") } }
m:point_mass { at = tip, mass = around("0.05", "2%", "bob") }
m:joint_damper { joint = motor, damping = around("0.002", "5%", "motor friction") }
m:joint_damper { joint = pin, damping = around("0.0001", "5%", "pin friction") }

local q = m:coordinates()
m:joint_torque { joint = motor,
  torque = "0.086" * q.arm + "0.057" * q["arm'"] - q.rod - "0.158" * q["rod'"] }

local report = ambit.verify { m:dynamics(), t = 4,
  initial = { arm = 0, ["arm'"] = 0, rod = degrees(around(0, 2)), ["rod'"] = 0 },
  safe = { left = q.rod - degrees(6), right = -q.rod - degrees(6) },
  at_end = { upright = q.rod - degrees(1), back = -q.rod - degrees(1) } }
print(report)
