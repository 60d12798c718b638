-- A SCARA arm whose gears have a play of 0.6 mrad is moved by two servos: payload +-2 %, gear stiffness and damping
-- +-5 %, links +-0.1 mm.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism "scara"
local shoulder, first = m:revolute { from = m.world, axis = "z", name = "a" }
local elbow = m:rigid_link { from = shoulder, offset = { around("0.35", "0.1 mm", "upper"), 0, 0 } }
local fore, second = m:revolute { from = elbow, axis = "z", name = "b" }
local hand = m:rigid_link { from = fore, offset = { around("0.25", "0.1 mm", "lower"), 0, 0 } }
m:rigid_body { at = elbow, mass = 4, centre = { "-0.15", 0, 0 },
  inertia = { { "0.002", 0, 0 }, { 0, "0.06", 0 }, { 0, 0, "0.06" } } }
m:point_mass { at = hand, mass = around("1.5", "2%", "payload") }

local play = "0.0003 rad"
local function drive(joint, goal, k, d)
  k, d = around(k, "5%"), around(d, "5%")
  m:joint_torque { joint = joint, torque = function(q, v)
    local e = q - goal
    return -k * (ambit.max(e - play, 0) + ambit.min(e + play, 0)) - d * v
  end }
end
local s = "0.4" * (1 - ambit.cos(ambit.pi * t / "0.8"))
drive(first, s, 600, 45)
drive(second, -s, 250, 20)

local run = ambit.simulate { m:dynamics(), initial = { a = 0, b = 0, ["a'"] = 0, ["b'"] = 0 },
  t = { 0, "0.2", "0.4", "0.6", "0.8" } }
print(run)
