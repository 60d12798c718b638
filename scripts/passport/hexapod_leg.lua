-- A leg of a six-legged robot swings forward and up: three joints under PD control along a cycloid. Masses +-2 %, links
-- +-0.1 mm, joint damping +-5 %.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism { "hexapod leg", gravity = { 0, 0, "-9.81" } }
local hip, j1 = m:revolute { from = m.world, axis = "z", name = "hip" }
local coxa = m:rigid_link { from = hip, offset = { around("52 mm", "0.1 mm", "coxa"), 0, 0 } }
local thigh, j2 = m:revolute { from = coxa, axis = "y", name = "thigh" }
local femur = m:rigid_link { from = thigh, offset = { around("66 mm", "0.1 mm", "femur"), 0, 0 } }
local knee, j3 = m:revolute { from = femur, axis = "y", name = "knee" }
local foot = m:rigid_link { from = knee, offset = { around("133 mm", "0.1 mm", "tibia"), 0, 0 } }
m:point_mass { at = coxa, mass = around("0.11", "2%", "servo 2") }
m:point_mass { at = femur, mass = around("0.12", "2%", "servo 3") }
m:point_mass { at = foot, mass = around("0.05", "2%", "foot") }

local s = t / "0.4" - ambit.sin(2 * ambit.pi * t / "0.4") / (2 * ambit.pi)
local lift = (1 - ambit.cos(2 * ambit.pi * t / "0.4")) / 2
local goal = { "0.5" * s - "0.25", "-0.2" - "0.4" * lift, "1.3" + "0.2" * lift }
for i, joint in ipairs { j1, j2, j3 } do
  local k, d = ({ 12, 15, 8 })[i], around(({ "0.25", "0.3", "0.12" })[i], "5%", "damping")
  m:joint_torque { joint = joint, torque = function(q, w) return k * (goal[i] - q) - d * w end }
end

local run = ambit.simulate { m:dynamics(), t = { 0, "0.1", "0.2", "0.3", "0.4" },
  initial = { hip = "-0.25", thigh = "-0.2", knee = "1.3", ["hip'"] = 0, ["thigh'"] = 0, ["knee'"] = 0 } }
print(run)
