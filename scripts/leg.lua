-- leg.lua -- a leg at rest: where does it hang, and what do muscles and joints bear, if muscles are known to 5 %?
--
-- Somebody sits on a bench, the thigh on a cushion, the lower leg hanging free and relaxed. Segments after Winter,
-- Biomechanics and Motor Control of Human Movement (2009), table 4.1, for 75 kg and 1.80 m. Muscles are springs between
-- their attachments (passive tissue: none is told to contract), 4 % stretched in the posture `relaxed`; joints have
-- friction.
-- x points forward, y up; angles are counter-clockwise: knee = 0 is a straight leg, -90 degrees hangs, ankle = 90
-- degrees is a foot at right angles to the shank.
local ambit = require "ambit"
local around, degrees = ambit.around, ambit.degrees

local mass, height, tolerance = 75, 1.80, "5%"
local segments = { -- share of mass, of height; centre and radius of gyration as shares of the length
  thigh = { 0.100, 0.245, 0.433, 0.323 },
  shank = { 0.0465, 0.246, 0.433, 0.302 },
  foot  = { 0.0145, 0.152, 0.500, 0.475 },
}
local relaxed = { hip = degrees(-5), knee = degrees(-85), ankle = degrees(75) }

local m = ambit.mechanism { "leg", gravity = { 0, "-9.81", 0 } }

-- A slender body along x; its far end.
local function segment(name, from)
  local share, length, centre, gyration = table.unpack(segments[name])
  length, share = length * height, share * mass
  local inertia = share * (gyration * length) ^ 2
  m:rigid_body { at = from, name = name, mass = share, centre = { centre * length, 0, 0 },
    inertia = { { 0, 0, 0 }, { 0, inertia, 0 }, { 0, 0, inertia } } }
  return m:rigid_link { from = from, offset = { length, 0, 0 } }
end

local muscles = {}

local function muscle(name, stiffness, from, a, to, b)
  local length = m:distance(m:frame { from = from, offset = a }, m:frame { from = to, offset = b })
  local rest, k = ambit.evaluate({ length, at = relaxed }):mid() / 1.04, around(stiffness, tolerance)
  m:spring_damper { name = name, from = from, from_offset = a, to = to, to_offset = b, length = rest, stiffness = k,
    damping = 30 }
  muscles[#muscles + 1] = { name = name, stretch = length - rest, force = k * (length - rest) }
end

local thigh, hip = m:revolute { from = m.world, axis = "z", name = "hip" }
local shank, knee = m:revolute { from = segment("thigh", thigh), axis = "z", name = "knee" }
local foot, ankle = m:revolute { from = segment("shank", shank), axis = "z", name = "ankle" }
segment("foot", foot)

m:joint_spring { joint = hip, stiffness = around(400, tolerance), name = "cushion" }
muscle("quadriceps", 2000, thigh, { 0.20, 0.05, 0 },  shank, { -0.01, 0.05, 0 }) -- over the kneecap
muscle("hamstrings", 1500, thigh, { 0.15, -0.05, 0 }, shank, { 0.05, -0.04, 0 })
muscle("tibialis",   1500, shank, { 0.10, 0.03, 0 },  foot,  { 0.08, 0.03, 0 })
muscle("soleus",     3000, shank, { 0.10, -0.04, 0 }, foot,  { -0.05, -0.01, 0 })
for _, joint in ipairs { hip, knee, ankle } do
  m:joint_friction { joint = joint, coulomb = 0.05, velocity = 0.1, viscous = 0.5 }
end

-- Every posture within reach in which all forces on the joints are in balance. Forces of muscles nearly cancel around a
-- joint, and one stiffness occurs in many places: affine arithmetic knows that it is the same one; plain intervals
-- forget it, and prove nothing here.
local names = { "hip", "knee", "ankle" }
local still = {}
for _, name in ipairs(names) do still[name .. "'"] = 0 end
local rest = ambit.roots { m:generalised_forces(), at = still, arithmetic = "affine",
  box = { hip = { -0.3, 0.1 }, knee = { -1.6, -0.9 }, ankle = { 1.0, 1.6 } } }
print(("%s: %d posture%s of rest"):format(rest.status, #rest.proved, #rest.proved == 1 and "" or "s"))

local function in_degrees(x) return x * 180 / ambit.interval(ambit.pi) end
for _, p in ipairs(rest.proved) do
  for _, name in ipairs(names) do still[name], still[name .. "''"] = p[name], 0 end
  local function at_rest(e) return ambit.evaluate { e, at = still, arithmetic = "affine" } end
  print "\nthe posture, degrees"
  for _, name in ipairs(names) do print(("  %-11s %s"):format(name, in_degrees(p[name]))) end
  print "the muscles: stretch, mm; pull, N"
  for _, one in ipairs(muscles) do
    print(("  %-11s %-22s %s"):format(one.name, at_rest(one.stretch) * 1000, at_rest(one.force)))
  end
  print "the joints: what they hold, N, along the bone and across"
  for i, joint in ipairs { hip, knee, ankle } do
    local force = at_rest(m:reaction(joint).force)
    print(("  %-11s %-22s %s"):format(names[i], force.x, force.y))
  end
end
