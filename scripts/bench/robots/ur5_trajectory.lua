-- ur5_trajectory.lua -- a UR5 follows a trajectory of its joints by computed torque: the controller knows the maker's
-- data, the arm has masses within a tolerance of them.
--   ambit run ur5_trajectory.lua [2%]
local ambit = require "ambit"
local substitute = require "ambit.core".substitute

local t = ambit.time
local file = (arg[0]:match ".*/" or "./") .. "../../robots/ur5.urdf"
local gravity = { 0, 0, "-9.81" }
local arm = ambit.load { file, gravity = gravity,
  tolerances = { ["*_link.mass"] = arg[1] or "2%", ["base_link.mass"] = 0 } }
local nominal = ambit.load { file, gravity = gravity }

local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
  "wrist_3_joint" }
local from = { 0, "-0.5", "0.9", "0.3", "-0.7", 0 }
local to = { 1, -1, "1.4", "0.1", "-0.4", "0.5" }
local stiffness, damping = 100, 20 -- of the error, 1/s^2 and 1/s

-- The way from the first pose to the second and half back: s(t) = (1 - cos(w t)) / 2.
local w = ambit.pi / 2
local s, ds, dds = (1 - ambit.cos(w * t)) / 2, w / 2 * ambit.sin(w * t), w ^ 2 / 2 * ambit.cos(w * t)

-- The controller: torques that would give the nominal arm the acceleration q_d'' + d (q_d' - q') + k (q_d - q).
local q, planned = arm:coordinates(), nominal:coordinates()
local symbols, values, initial = {}, {}, {}
for i, name in ipairs(joints) do
  local way, velocity = ambit.number(to[i]) - from[i], name .. "'"
  local wanted = way * dds + damping * (way * ds - q[velocity]) + stiffness * (from[i] + way * s - q[name])
  for key, value in pairs { [name] = q[name], [velocity] = q[velocity], [name .. "''"] = wanted } do
    symbols[#symbols + 1], values[#values + 1] = planned[key], value
  end
  initial[name], initial[velocity] = from[i], 0
end
local torque = nominal:inverse_dynamics() -- in the order of the joints
for i, name in ipairs(joints) do
  local law = substitute({ torque[i] }, symbols, values)[1]
  arm:joint_torque { joint = arm.joints[name], torque = law }
end

local run = ambit.simulate { arm:dynamics(), initial = initial,
  t = { 0, "0.25", "0.5", "0.75", 1, "1.25", "1.5", "1.75", 2 } }
print(run)
for _, name in ipairs(joints) do print(name, run.x[name]) end
