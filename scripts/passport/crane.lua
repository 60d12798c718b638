-- A harbour crane moves its trolley by 12 m in 10 s while it hoists: the load never swings by more than 16 degrees.
-- Load +-2 %, rope +-0.1 mm, damping +-5 %, first swing within half a degree.
local ambit = require "ambit"
local around, degrees, t = ambit.around, ambit.degrees, ambit.time

local m = ambit.mechanism { "harbour crane", gravity = { 0, "-9.81", 0 } }
local s = t / 10 - ambit.sin(2 * ambit.pi * t / 10) / (2 * ambit.pi)
local trolley = m:prismatic { from = m.world, axis = "x", displacement = 12 * s }
local pivot, swing = m:revolute { from = trolley, axis = "z", name = "swing" }
local hook = m:prismatic { from = pivot, axis = "-y", displacement = around(12, "0.1 mm", "rope") - 5 * s }
m:point_mass { at = hook, mass = around(4000, "2%", "load") }
m:joint_damper { joint = swing, damping = around(3000, "5%", "damping") }

local q = m:coordinates()
local report = ambit.verify { m:dynamics(), t = 10,
  initial = { swing = degrees(around(0, "0.5")), ["swing'"] = 0 },
  safe = { ahead = q.swing - degrees(16), behind = -q.swing - degrees(16) } }
print(report)
