-- cart_pole.lua -- a pole on a cart, held upright by a linear-quadratic regulator. Its masses are known within 5 and
-- 10 %, its length within 2 %, and it starts anywhere within 2 degrees and 5 cm of its place: does it stay within
-- 5 degrees, and the cart within half a metre?
local ambit = require "ambit"
local around, degrees = ambit.around, ambit.degrees

local m = ambit.mechanism { "cart-pole", gravity = { 0, "-9.81", 0 } }
local cart, rail = m:prismatic { from = m.world, axis = "x", name = "x" }
m:point_mass { at = cart, mass = around(1, "5%", "cart") }
local hinge = m:revolute { from = cart, axis = "z", name = "theta" }
local tip = m:rigid_link { from = hinge, offset = { 0, around("0.5", "2%", "length"), 0 } }
m:point_mass { at = tip, mass = around("0.2", "10%", "pole") }

local q = m:coordinates() -- theta turns the tip to the left; gains for the weights 1, 10, 1, 1 of x, theta, x', theta'
m:joint_torque { joint = rail, force = q.x + "2.6" * q["x'"] - 28 * q.theta - "5.8" * q["theta'"] }

local report = ambit.verify {
  m:dynamics(), t = 10,
  initial = { x = around(0, "0.05", "start"), theta = degrees(around(0, 2, "first angle")),
    ["x'"] = 0, ["theta'"] = 0 },
  safe = { left = q.theta - degrees(5), right = -q.theta - degrees(5), rail = q.x ^ 2 - "0.25" },
}
print(report)
