-- reduce_ur5.lua -- the motors of a UR5 fail while all six joints move; its brakes grip 0.1 s later. Which parts of the
-- arm, and then which terms of its equations, must be known to say within 1 mm where the tool is all that time?
--
-- The arm of ur5.lua with a gripper of 0.5 kg; the losses of its gears are assumed. Parts go first: moments of inertia
-- of the wrist's links, losses of its gears, its second joint (slow) and its third (the tool lies on its axis, so 0 is
-- as good an angle as any). Then summands of what is left.
--
-- All data are exact: what is proved is what the cuts do, in this one motion, with every rounding. Tolerances are too
-- dear here: with one angle known to 1e-4 rad, not one cut was decided in 30 s of CPU.
local ambit = require "ambit"

local arm = ambit.load { "robots/ur5.urdf", gravity = { 0, 0, "-9.81" } }
local tool = arm.links.tool0
arm:rigid_body { at = tool, mass = "0.5", centre = { 0, 0, "0.05" }, name = "gripper",
  inertia = { { "4e-4", 0, 0 }, { 0, "4e-4", 0 }, { 0, 0, "3e-4" } } }

local joints = { "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3" }
local pose = { "0.1", "-0.5", "0.9", "0.3", "-0.7", "1.1" }   -- rad
local speed = { "0.2", "-0.1", "0.3", "0.1", "-0.05", "0.3" } -- rad/s
local loss = { 10, 10, 10, "0.5", "0.5", "0.5" }              -- N m s/rad

local initial = {}
for i, name in ipairs(joints) do
  local q = name .. "_joint"
  initial[q], initial[q .. "'"] = pose[i], speed[i]
  arm:joint_damper { joint = arm.joints[q], damping = loss[i], name = name .. "_gear" }
end

local outputs, error = {}, {}
for _, axis in ipairs { "x", "y", "z" } do
  outputs["tool_" .. axis] = function(_, _, _, at) return at:position(tool)[axis] end
  error["tool_" .. axis] = "1 mm"
end

local small = ambit.reduce {
  arm, t = { 0, "0.1" }, initial = initial, outputs = outputs, error = error,
  elements = { "base_link", "wrist_1_link: inertia", "wrist_2_link: inertia", "wrist_3_link: inertia",
    "gripper: inertia", "wrist_1_gear", "wrist_2_gear", "wrist_3_gear", { "wrist_2_joint", at = pose[5] },
    { "wrist_3_joint", at = 0 }, "wrist_3_link", "wrist_3_link: weight" },
  reductions = { "neglect" }, levels = 1, budget = 120,
}
print(small)

print "\nparts:"
for _, row in ipairs(small.terms) do
  if row.level == "element" then print(("  %-14s %-26s %s"):format(row.equation, row.text, row.status)) end
end
print(small:sample {})
