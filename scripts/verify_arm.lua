-- verify_arm.lua: a two-link arm on servos (springs whose rest position moves) lifts a payload that is known to 4 %.
-- Proved for every payload, length and start that the tolerances allow: the tip stays off a wall and a post, the servo
-- of the shoulder within its torque, and the tip ends near its goal. A tighter wall is refuted, by an example.
local ambit = require "ambit"
local around, degrees, t = ambit.around, ambit.degrees, ambit.time

local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
local stiffness, damping = 100, 4       -- N m/rad, N m s/rad
local lift = (1 - ambit.cos(ambit.pi * t)) / 2 -- from 0 to 1 in one second

local function link(name, from, length, mass, first, last)
  local joint = m:revolute { from = from, axis = "z", name = name }
  local rest = degrees(first) + degrees(last - first) * lift
  m:joint_spring { joint = joint, stiffness = stiffness, rest = rest }
  m:joint_damper { joint = joint, damping = damping }
  local tip = m:rigid_link { from = joint, offset = { length, 0, 0 } }
  m:point_mass { at = tip, mass = mass }
  return tip, rest
end

local elbow, rest = link("shoulder", m.world, around("0.5 m", "1 mm"), "1 kg", -20, 60)
local tip = link("elbow", elbow, "0.4 m", around("0.5 kg", "4%"), 80, 30)

local p, q = m:position(tip), m:coordinates()
local torque = stiffness * (rest - q.shoulder) - damping * q["shoulder'"]
local function square_distance(x, y) return ambit.sqr(p.x - x) + ambit.sqr(p.y - y) end

local report = ambit.verify {
  m:dynamics(), t = { 0, 1 },
  initial = { shoulder = degrees(around(-25, "0.5")), elbow = degrees(80), ["shoulder'"] = 0, ["elbow'"] = 0 },
  safe = {                                   -- each is proved to be <= 0 at all times
    wall = p.x - "0.76",
    post = ambit.sqr(ambit.number "0.08") - square_distance("0.72", "0.62"),
    torque_above = torque - 25, torque_below = -25 - torque,
    tight_wall = p.x - "0.70",
  },
  at_end = { goal = square_distance("0.25", "0.83") - ambit.sqr(ambit.number "0.03") },
}
print(report)
