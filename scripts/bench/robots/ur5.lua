-- ur5.lua -- a UR5 with a payload of 2 kg is sent from one pose to another by a PD controller. Every length, angle,
-- mass, centre of mass and moment of inertia of it is known within a tolerance: where are its joints, for every such
-- arm?
--   ambit run ur5.lua [1%] [bodies|components|payload]
--     bodies: 27 data; components: 73, each moment of inertia, centre, gain and friction by itself; payload: only that
local ambit = require "ambit"
local around = ambit.around

local tolerance, what = arg[1] or "1%", arg[2] or "bodies"
local own = { ["base_link.mass"] = 0, ["base_link.inertia"] = 0 } -- the base stands still
local tolerances = {
  bodies = { mass = tolerance, inertia = tolerance, centre = tolerance, offset = tolerance, angle = tolerance },
  components = { mass = tolerance, centre = "1 mm", offset = tolerance, angle = tolerance,
    ["inertia.xx"] = tolerance, ["inertia.yy"] = tolerance, ["inertia.zz"] = tolerance, ["base_link.centre"] = 0,
    ["base_link.inertia.xx"] = 0, ["base_link.inertia.yy"] = 0, ["base_link.inertia.zz"] = 0 },
}
local chosen = tolerances[what]
if chosen then for name, value in pairs(own) do chosen[name] = value end end
local arm = ambit.load {
  (arg[0]:match ".*/" or "./") .. "../../robots/ur5.urdf", gravity = { 0, 0, "-9.81" }, tolerances = chosen,
  physical = what ~= "components", -- independent moments of the thin last link break the triangle inequality
}

-- The payload; its moments of inertia are those of a cylinder of 12 cm.
local function known(value, name) return what == "payload" and ambit.number(value) or around(value, tolerance, name) end
local scale = known(1, "payload inertia")
arm:rigid_body { at = arm.links.tool0, mass = around(2, tolerance, "payload"),
  inertia = { "0.004" * scale, 0, 0, 0, "0.004" * scale, 0, 0, 0, "0.003" * scale } }

local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
  "wrist_3_joint" }
local pose = { "0.1", "-0.5", "0.9", "0.3", "-0.7", "1.1" }
local goal = { "0.3", "-0.9", "1.2", "0.1", "-0.4", "0.8" }
local stiffness, damping = { 400, 400, 300, 40, 40, 20 }, { 60, 60, 40, 3, 3, "1.5" }

local initial = {}
for i, name in ipairs(joints) do
  local k, d, friction = stiffness[i], damping[i], 0
  if what == "components" then
    k, d, friction = known(k, "k" .. i), known(d, "d" .. i), known("0.1", "friction" .. i)
  end
  arm:joint_torque { joint = arm.joints[name],
    torque = function(q, v) return k * (goal[i] - q) - (d + friction) * v end }
  initial[name], initial[name .. "'"] = pose[i], 0
end

local times = { 0, "0.1", "0.2", "0.4", "0.6", "0.8", 1, "1.5", 2, 3, 4, 5 }
local run = ambit.simulate { arm:dynamics(), initial = initial, t = times }
print(run)
for _, name in ipairs(joints) do print(name, run.x[name]) end
