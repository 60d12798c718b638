-- random_spatial.lua -- spatial linkages at random: a crank about z, a coupler on a universal joint, and a rocker about
-- x whose tip is a ball joint with the coupler's, with pendulums hung on them. For random_mechanism.lua.
--
-- The dependent angles follow from the crank's in closed form, as expressions of the data; the oracle closes the loop
-- by itself.
local ambit = require "ambit"

local spatial = {}

local function straight(b) -- its axes are those of its parent at angle 0
  b.turn, b.slides = 0, false
  return b
end

-- With w from the crank's tip to the rocker's hinge, the rocker's tip w + r (0, cos a, sin a) is at a distance L of the
-- crank's: L^2 = w^2 + r^2 + 2 r (w_y cos a + w_z sin a). f: functions of numbers or of expressions
local function rocker_angle(f, w, r, L, side)
  local cosine = (L * L - w[1] * w[1] - w[2] * w[2] - w[3] * w[3] - r * r) / (2 * r * f.sqrt(w[2] * w[2] + w[3] * w[3]))
  return f.atan2(w[3], w[2]) + side * f.acos(cosine), cosine
end

-- The coupler's direction in the crank's axes is (sin b, -sin a cos b, cos a cos b), a and b the universal's angles.
local function angles(f, crank, length, ground, r, L, side)
  local c, s = f.cos(crank), f.sin(crank)
  local w = { ground[1] - length * c, ground[2] - length * s, ground[3] }
  local rocker, cosine = rocker_angle(f, w, r, L, side)
  local x, y, z = w[1], w[2] + r * f.cos(rocker), w[3] + r * f.sin(rocker)
  local along, across = c * x + s * y, c * y - s * x
  return { f.atan2(-across, z), f.asin(along / L), rocker }, cosine, z
end

local NUMBERS = { sin = math.sin, cos = math.cos, sqrt = math.sqrt, acos = math.acos, asin = math.asin, atan2 = math.atan }

-- A geometry that closes with room to spare: the angle of the rocker, and the numbers that decide it.
local function geometry(r, crank)
  while true do
    local length, reach, turn = r.between(0.15, 0.3), r.between(0.3, 0.6), r.between(-3, 3)
    local tip = { length * math.cos(crank), length * math.sin(crank), 0 }
    local d = { r.between(-0.3, 0.3), r.between(-0.3, 0.3), r.between(0.4, 0.8) }
    local ground = { tip[1] + d[1], tip[2] + d[2] - reach * math.cos(turn), d[3] - reach * math.sin(turn) }
    local L = math.sqrt(d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2)
    for side = -1, 1, 2 do
      local q, cosine, z = angles(NUMBERS, crank, length, ground, reach, L, side)
      if math.abs(cosine) < 0.85 and z > 0.3 then return length, ground, reach, L, side, q end
    end
  end
end

function spatial.new(r, n, make, massless, drive)
  local plan = { bodies = {}, gravity = { 0, 0, -9.81 }, dependent = { [2] = true, [3] = true, [4] = true },
    spatial = true, v = {} }
  local crank, across = straight(make(r, 0, "crank")), massless(1, "coupler")
  local coupler, rocker = straight(make(r, 2, "coupler")), straight(make(r, 0, "rocker"))
  local angle = r.between(-1.5, 1.5)
  local length, ground, reach, L, side, q = geometry(r, angle)
  crank.offset, crank.axis, crank.state = { 0, 0, 0 }, "z", "crank"
  drive(r, crank)
  across.offset, across.axis, across.state = { length, 0, 0 }, "x", "coupler.1"
  across.compound, across.count = "universal", 2
  coupler.offset, coupler.axis, coupler.state = { 0, 0, 0 }, "y", "coupler.2"
  rocker.offset, rocker.axis, rocker.state = ground, "x", "rocker"
  plan.bodies = { crank, across, coupler, rocker }
  plan.q = { angle, q[1], q[2], q[3] }
  plan.loops = { { a_length = { L }, b_length = { reach }, side = side } }
  plan.v[1] = r.between(-2, 2)
  while #plan.bodies < n do -- pendulums
    local i, parent = #plan.bodies + 1, r.integer(#plan.bodies)
    local b = make(r, parent == 2 and 3 or parent, "j" .. i)
    b.axis, b.slides, b.state = r.one_of { "x", "y", "z" }, false, "j" .. i
    drive(r, b)
    plan.bodies[i], plan.q[i], plan.v[i] = b, r.between(-1, 1), r.between(-1, 1)
  end
  for i = 1, #plan.bodies do plan.v[i] = plan.v[i] or 0 end
  plan.name = ("spatial loop of %d"):format(#plan.bodies)
  return plan
end

function spatial.close(m, frames, plan, value, initial, angle)
  local loop = plan.loops[1]
  local L, reach = value(loop.a_length, 1), value(loop.b_length, 1)
  m:close_point { a = m:rigid_link { from = frames[3], offset = { 0, 0, L } },
    b = m:rigid_link { from = frames[4], offset = { 0, reach, 0 } } }
  local at = plan.bodies[4].offset
  local ground = { value(at, 1), value(at, 2), value(at, 3) }
  local q = angles(ambit, angle, value(plan.bodies[2].offset, 1), ground, reach, L, loop.side)
  for k = 1, 3 do initial[plan.bodies[1 + k].state] = q[k] end
end

function spatial.resolve(plan, t)
  local loop = plan.loops[1]
  t.loops[1] = { a = 3, b = 4, at_a = { 0, 0, loop.a_length[1] }, at_b = { 0, loop.b_length[1], 0 },
    along = { true, true, true } }
end

return spatial
