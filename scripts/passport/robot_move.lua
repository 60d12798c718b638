-- A UR5 carries 3 kg along a smooth joint motion of 1 s, PD control with a feed-forward of the speed. Link masses
-- +-2 %, joint offsets +-0.1 mm.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local arm = ambit.load { (arg[0]:match ".*/" or "./") .. "../robots/ur5.urdf", gravity = { 0, 0, "-9.81" },
  tolerances = { ["*_link.mass"] = "2%", ["base_link.mass"] = 0, ["*_joint.offset"] = "0.1 mm" } }
arm:point_mass { at = arm.links.tool0, mass = around(3, "2%", "payload") }

local names = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
  "wrist_3_joint" }
local from, to = { 0, "-1.2", "1.4", "-0.2", "-1.5", 0 }, { "0.6", "-0.8", "1.1", "-0.3", "-1.2", "0.4" }
local kp, kd = { 3000, 5000, 3000, 400, 300, 150 }, { 300, 500, 300, 30, 20, 10 }
local s, v = 3 * t ^ 2 - 2 * t ^ 3, 6 * t - 6 * t ^ 2

local initial = {}
for i, name in ipairs(names) do
  local a, b = ambit.number(from[i]), ambit.number(to[i])
  arm:joint_torque { joint = arm.joints[name], torque = function(q, w)
    return kp[i] * (a + (b - a) * s - q) + kd[i] * ((b - a) * v - w)
  end }
  initial[name], initial[name .. "'"] = a, 0
end

local run = ambit.simulate { arm:dynamics(), initial = initial, t = { 0, "0.25", "0.5", "0.75", 1 } }
print(run)
