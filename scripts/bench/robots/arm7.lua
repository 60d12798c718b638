-- arm7.lua -- an arm of seven joints, read from a file, is sent from one pose to another by a PD controller; everything
-- that the file says of its bodies is known within a tolerance.
--   ambit run arm7.lua [1%]
local ambit = require "ambit"

local tolerance = arg[1] or "1%"
local arm = ambit.load {
  (arg[0]:match ".*/" or "./") .. "../../robots/arm7.urdf", gravity = { 0, 0, "-9.81" },
  tolerances = { mass = tolerance, inertia = tolerance, centre = tolerance, offset = tolerance,
    ["base.mass"] = 0, ["base.inertia"] = 0, ["base.centre"] = 0 },
}
local pose = { "0.1", "-0.5", "0.9", "0.3", "-0.7", "1.1", "0.2" }
local goal = { "0.3", "-0.9", "1.2", "0.1", "-0.4", "0.8", 0 }
local stiffness, damping = { 400, 400, 100, 100, 20, 20, 2 }, { 60, 60, 10, 15, 1, 1, "0.1" }

local initial = {}
for i = 1, 7 do
  local name = "joint" .. i
  arm:joint_torque { joint = arm.joints[name],
    torque = function(q, v) return stiffness[i] * (goal[i] - q) - damping[i] * v end }
  initial[name], initial[name .. "'"] = pose[i], 0
end

local run = ambit.simulate { arm:dynamics(), initial = initial,
  t = { 0, "0.1", "0.2", "0.4", "0.6", "0.8", 1, "1.5", 2, 3, 4, 5 } }
print(run)
for i = 1, 7 do print("joint" .. i, run.x["joint" .. i]) end
