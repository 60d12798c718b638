-- A pole of 80 cm on a cart under state feedback: from anywhere within 1.5 degrees and 2 cm it stays within 4 degrees,
-- and the cart within 30 cm, for 6 s.
local ambit = require "ambit"
local around, degrees = ambit.around, ambit.degrees

local m = ambit.mechanism { "cart-pole", gravity = { 0, "-9.81", 0 } }
local cart, rail = m:prismatic { from = m.world, axis = "x", name = "x" }
m:point_mass { at = cart, mass = around("1.5", "2%", "cart") }
local hinge, pin = m:revolute { from = cart, axis = "z", name = "theta" }
local tip = m:rigid_link { from = hinge, offset = { 0, around("0.8", "0.1 mm", "pole"), 0 } }
m:point_mass { at = tip, mass = around("0.3", "2%", "bob") }
m:joint_damper { joint = rail, damping = around(2, "5%", "rail") }
m:joint_damper { joint = pin, damping = around("0.01", "5%", "pin") }

local q = m:coordinates()
m:joint_torque { joint = rail, force = 2 * q.x + 6 * q["x'"] - 48 * q.theta - 14 * q["theta'"] }

local report = ambit.verify { m:dynamics(), t = 6,
  initial = { x = around(0, "0.02"), theta = degrees(around(0, "1.5")), ["x'"] = 0, ["theta'"] = 0 },
  safe = { left = q.theta - degrees(4), right = -q.theta - degrees(4), far = q.x - "0.3", near = -q.x - "0.3" } }
print(report)
