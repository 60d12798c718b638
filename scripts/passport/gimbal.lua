-- A camera on a two-axis gimbal that looks ahead while the vehicle below it yaws and pitches: it stays within half a
-- degree. Masses +-2 %, bearings +-5 %.
local ambit = require "ambit"
local around, degrees, t = ambit.around, ambit.degrees, ambit.time

local m = ambit.mechanism { "gimbal", gravity = { 0, 0, "-9.81" } }
local yaw = degrees(6) * ambit.sin(2 * t) * t / (1 + t)
local pitch = degrees(4) * (1 - ambit.cos(3 * t))
local deck = m:revolute { from = m.world, axis = "z", angle = yaw }
deck = m:revolute { from = deck, axis = "y", angle = pitch }
local outer, pan = m:revolute { from = deck, axis = "z", name = "pan" }
local inner, tilt = m:revolute { from = outer, axis = "y", name = "tilt" }
m:rigid_body { at = outer, mass = around("0.6", "2%", "fork"),
  inertia = { { "0.002", 0, 0 }, { 0, "0.002", 0 }, { 0, 0, "0.003" } } }
m:rigid_body { at = inner, mass = around("0.9", "2%", "camera"), centre = { "0.5 mm", 0, "0.2 mm" },
  inertia = { { "0.001", 0, 0 }, { 0, "0.002", 0 }, { 0, 0, "0.002" } } }
m:joint_damper { joint = pan, damping = around("0.01", "5%", "pan bearing") }
m:joint_damper { joint = tilt, damping = around("0.008", "5%", "tilt bearing") }

-- the encoders and the deck's own measured attitude
m:joint_torque { joint = pan, torque = function(q, w) return -60 * (q + yaw) - "0.7" * w end }
m:joint_torque { joint = tilt, torque = function(q, w) return -40 * (q + pitch) - "0.5" * w end }

local q = m:coordinates()
local report = ambit.verify { m:dynamics(), t = 3,
  initial = { pan = degrees(around(0, "0.1")), tilt = degrees(around(0, "0.1")), ["pan'"] = 0, ["tilt'"] = 0 },
  safe = { left = q.pan + yaw - degrees("0.5"), right = -q.pan - yaw - degrees("0.5"),
    up = q.tilt + pitch - degrees("0.5"), down = -q.tilt - pitch - degrees("0.5") } }
print(report)
