-- tree.lua -- a trunk on a swivel with two arms of four joints, a waist and a neck, twelve joints in all, is held in a
-- posture by PD controllers. The length and mass of each link are known within a tolerance.
--   ambit run tree.lua [1%]
local ambit = require "ambit"

local tolerance = arg[1] or "1%"
local m = ambit.mechanism { "tree", gravity = { 0, 0, "-9.81" } }
local initial = {}

-- A joint and the link that it moves, which is a rod in the direction of z: the frame at its end.
local function link(from, name, axis, angle, length, mass)
  local turned, joint = m:revolute { from = from, axis = axis, name = name }
  local l = ambit.around(length, tolerance, name .. ".length")
  local own = ambit.around(mass, tolerance, name .. ".mass")
  local moment = own * l ^ 2 / 12 + "0.002"
  local last = m:rigid_link { from = turned, offset = { 0, 0, l } }
  m:rigid_body { at = turned, mass = own, centre = { 0, 0, l / 2 },
    inertia = { moment, 0, 0, 0, moment, 0, 0, 0, own * "0.002" + "0.001" } }
  m:armature { joint = joint, inertia = "0.1" } -- of the motor, behind its gear
  local k = 20 * ambit.number(mass)
  m:joint_torque { joint = joint, torque = function(q, v) return k * (ambit.number(angle) + "0.2" - q) - k * v / 6 end }
  initial[name], initial[name .. "'"] = angle, 0
  return last
end

local trunk = link(m.world, "swivel", "z", 0, "0.4", 8)
trunk = link(trunk, "waist", "y", "0.1", "0.3", 5)
for i, side in ipairs { "left", "right" } do
  local sign = 3 - 2 * i
  local shoulder = m:rigid_link { from = trunk, offset = { 0, sign * ambit.number "0.2", 0 } }
  local at = link(shoulder, side .. ".shoulder", "x", sign * ambit.number "0.4", "0.3", 2)
  at = link(at, side .. ".upper", "y", "0.5", "0.25", "1.5")
  at = link(at, side .. ".elbow", "y", "0.8", "0.25", 1)
  link(at, side .. ".wrist", "x", "0.2", "0.1", "0.5")
end
link(link(trunk, "neck", "y", "0.1", "0.15", 1), "head", "x", 0, "0.15", 2)

local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, "0.05", "0.1", "0.2" } }
print(run)
for _, name in ipairs { "waist", "left.wrist", "head" } do print(name, run.x[name]) end
