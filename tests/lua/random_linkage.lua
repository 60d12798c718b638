-- random_linkage.lua -- plane linkages at random: a crank, and pairs of bodies (coupler and rocker, or rod and slider)
-- that close loops with it, with pendulums hung on them. For random_mechanism.lua.
--
-- The angles of a pair follow from the crank's by the law of cosines, as an expression of the data; the oracle closes
-- its loops by itself.
local ambit = require "ambit"

local linkage = {}

local function flat(b) -- of a plane mechanism
  b.turn, b.offset[3], b.axis, b.slides = 0, 0, "z", false
  b.state = b.name
  return b
end

-- The pair's geometry: tip of the crank at (x, y) now, pin at (cx, cy).
local function add_rocker(r, plan, make, tip, name)
  local x, y = plan.tip.x, plan.tip.y
  local cx, cy = x + r.between(0.4, 0.9), y + r.between(0.4, 0.9) * r.one_of { 1, -1 }
  local gx, gy = cx + r.between(-0.3, 0.5), cy - r.between(0.5, 0.9) * (cy > y and 1 or -1)
  local coupler, rocker = flat(make(r, 1, name .. "a")), flat(make(r, 0, name .. "b"))
  coupler.offset, rocker.offset = tip, { gx, gy, 0 }
  local n = #plan.bodies
  plan.bodies[n + 1], plan.bodies[n + 2] = coupler, rocker
  local a, b = math.atan(cy - y, cx - x), math.atan(cy - gy, cx - gx)
  plan.q[n + 1], plan.q[n + 2] = a - plan.q[1], b
  plan.dependent[n + 1], plan.dependent[n + 2] = true, true
  local side = (gx - x) * (cy - y) - (gy - y) * (cx - x) > 0 and 1 or -1
  plan.loops[#plan.loops + 1] = { a = n + 1, b = n + 2, kind = "rocker", side = side,
    a_length = { math.sqrt((cx - x) ^ 2 + (cy - y) ^ 2) }, b_length = { math.sqrt((cx - gx) ^ 2 + (cy - gy) ^ 2) } }
end

local function add_slider(r, plan, make, tip, name)
  local x, y = plan.tip.x, plan.tip.y
  local cx, cy = x + r.between(0.5, 0.9), r.between(-0.1, 0.1)
  local rod, slider = flat(make(r, 1, name .. "a")), flat(make(r, 0, name .. "b"))
  rod.offset, slider.offset = tip, { 0, cy, 0 }
  slider.axis, slider.slides = "x", true
  local n = #plan.bodies
  plan.bodies[n + 1], plan.bodies[n + 2] = rod, slider
  plan.q[n + 1], plan.q[n + 2] = math.atan(cy - y, cx - x) - plan.q[1], cx
  plan.dependent[n + 1], plan.dependent[n + 2] = true, true
  plan.loops[#plan.loops + 1] = { a = n + 1, b = n + 2, kind = "slider",
    a_length = { math.sqrt((cx - x) ^ 2 + (cy - y) ^ 2) }, b_length = { 0 } }
end

function linkage.new(r, n, make, drive)
  local plan = { bodies = {}, loops = {}, gravity = { 0, -9.81, 0 }, q = {}, v = {}, dependent = {} }
  local crank, length = flat(make(r, 0, "crank")), r.between(0.15, 0.35)
  crank.offset = { 0, 0, 0 }
  drive(r, crank)
  plan.bodies[1], plan.q[1], plan.v[1] = crank, r.between(-1.5, 1.5), r.between(-3, 3)
  plan.tip = { x = length * math.cos(plan.q[1]), y = length * math.sin(plan.q[1]) }
  local tip = { length, 0, 0 } -- one datum for all pairs
  local pairs_most = (n - 1) // 2
  for k = 1, math.max(1, r.integer(pairs_most)) do
    (r.chance(0.65) and add_rocker or add_slider)(r, plan, make, tip, "p" .. k)
  end
  while #plan.bodies < n do -- pendulums
    local i = #plan.bodies + 1
    local b = flat(make(r, r.integer(i - 1), "j" .. i))
    drive(r, b)
    plan.bodies[i], plan.q[i], plan.v[i] = b, r.between(-1, 1), r.between(-1, 1)
  end
  plan.name = ("%d loops of %d"):format(#plan.loops, #plan.bodies)
  for i = 1, #plan.bodies do plan.v[i] = plan.v[i] or 0 end
  return plan
end

-- Where the pair is, by the crank's angle: the angles (or angle and displacement) of both bodies.
local function pair_at(loop, angle, tip, ground, first, second)
  local x, y = tip * ambit.cos(angle), tip * ambit.sin(angle)
  if loop.kind == "slider" then
    local a = ambit.asin((ground[2] - y) / first)
    return a - angle, x + first * ambit.cos(a) - ground[1]
  end
  local dx, dy = ground[1] - x, ground[2] - y
  local square = dx ^ 2 + dy ^ 2
  local inside = ambit.acos((first ^ 2 + square - second ^ 2) / (2 * first * ambit.sqrt(square)))
  local a = ambit.atan2(dy, dx) + loop.side * inside
  return a - angle, ambit.atan2(y + first * ambit.sin(a) - ground[2], x + first * ambit.cos(a) - ground[1])
end

-- Closes the loops of the scene, and fills in the initial values of the dependent coordinates.
function linkage.close(m, frames, plan, value, initial, angle)
  for _, loop in ipairs(plan.loops) do
    local a, b = plan.bodies[loop.a], plan.bodies[loop.b]
    local first, second = value(loop.a_length, 1), value(loop.b_length, 1)
    m:close_pin { a = m:rigid_link { from = frames[loop.a], offset = { first, 0, 0 } },
      b = loop.kind == "slider" and frames[loop.b]
        or m:rigid_link { from = frames[loop.b], offset = { second, 0, 0 } } }
    initial[a.state], initial[b.state] = pair_at(loop, angle, value(a.offset, 1),
      { value(b.offset, 1), value(b.offset, 2) }, first, second)
  end
end

-- The loops as the oracle takes them.
function linkage.resolve(plan, t)
  for k, loop in ipairs(plan.loops) do
    t.loops[k] = { a = loop.a, b = loop.b, at_a = { loop.a_length[1], 0, 0 }, at_b = { loop.b_length[1], 0, 0 },
      along = { true, true, false } }
  end
end

return linkage
