-- chain/four_bar.lua -- m:four_bar { from = f, ground = g, crank = a, coupler = b, rocker = c }: a loop of four hinges
-- whose other angles are explicit functions of the crank's angle; no constraint is left to be solved.
--
-- In the plane, A = 0 the crank's hinge, D = (g, 0) the rocker's, B = a (cos t, sin t) the crank's tip, C where coupler
-- and rocker meet. With e = D - B, d = |e|: triangle B C D has the sides b, c, d, and half an interior angle of it is
-- 2 atan sqrt(...) of them (Heron's half-angle formula; McCarthy & Soh, Geometric Design of Linkages, 2011, 2.3):
--   d^2 = g^2 + a^2 - 2 g a cos t
--   coupler  arg e + s 2 atan sqrt((c^2 - (d - b)^2) / ((d + b)^2 - c^2))
--   rocker   arg e + s (pi - 2 atan sqrt((b^2 - (d - c)^2) / ((d + c)^2 - b^2)))
-- s = 1: C is to the left of the line from B to D ("open": not crossed while 0 < t < pi), s = -1: to the right. Of the
-- usual forms this one is the tightest over ranges of t and of the lengths: the one with a single atan2 is about twice
-- as wide, the half-tangent form of Freudenstein's equation three times (docs/numerics/mechanics.md). arg e is written
-- so that it never crosses the cut of atan2: by t + pi + ... where the crank is longer than the ground.
--
-- Dead centres: d = b + c and d = |b - c|, where the square roots are not smooth and the branches meet. If the crank
-- turns all the way without (g + a < b + c and |g - a| > |b - c|; Grashof 1883) this is proved for all data in their
-- tolerances; else `full_turn = false` says that it only swings, and an enclosure that comes to a dead centre is
-- partial. A parallelogram has its dead centres at t = 0 and pi: the square root is avoided altogether by *assuming*
-- that it stays a parallelogram there and does not flip to the crossed branch; then both angles are exact.
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"
local linkage = require "ambit.linkage"

local sin, cos, sqr, sqrt, atan, atan2 = core.sin, core.cos, core.sqr, core.sqrt, core.atan, core.atan2

local function say(e) return tostring(linkage.enclose(e)) end

local function check_assembly(g, a, b, c)
  local names = { ground = g, crank = a, coupler = b, rocker = c }
  for _, name in ipairs(check.sorted(names)) do
    local others = g + a + b + c - names[name]
    local _, never = linkage.is_positive(others - names[name])
    if never then
      check.fail("four_bar: it cannot be assembled: %s = %s m is not shorter than the other three together, %s m", name,
        say(names[name]), say(others))
    end
  end
end

local function check_full_turn(g, a, b, c)
  local long = linkage.is_positive(b + c - g - a)
  local short = linkage.is_positive(core.abs(g - a) - core.abs(b - c))
  if long and short then return end
  local why, first, second = "ground - crank = %s m must differ more than coupler - rocker = %s m", g - a, b - c
  if not long then
    why, first, second = "ground + crank = %s m must be shorter than coupler + rocker = %s m", g + a, b + c
  end
  check.fail("four_bar: not proved that the crank can turn all the way: %s (Grashof); for a crank that only swings say "
    .. "full_turn = false, for equal opposite links branch = \"parallelogram\"", why:format(say(first), say(second)))
end

-- Of the direction from B to D, without a jump.
local function direction(g, a, t)
  if linkage.is_positive(a - g) then return t + core.pi() + atan2(g * sin(t), a - g * cos(t)) end
  return atan2(-a * sin(t), g - a * cos(t))
end

-- Angles of coupler and rocker for s = 1 or -1.
local function angles(g, a, b, c, t, s)
  local d = sqrt(sqr(g) + sqr(a) - 2 * g * a * cos(t))
  local at_b = 2 * atan(sqrt((sqr(c) - sqr(d - b)) / (sqr(d + b) - sqr(c))))
  local at_d = 2 * atan(sqrt((sqr(b) - sqr(d - c)) / (sqr(d + c) - sqr(b))))
  local e = direction(g, a, t)
  return e + s * at_b, e + s * (core.pi() - at_d)
end

local function check_parallelogram(g, a, b, c)
  if a ~= c or g ~= b then
    check.fail("four_bar: a parallelogram needs opposite links that are the same datum, not only equal to their "
      .. "tolerances: crank = %s, rocker = %s; ground = %s, coupler = %s", tostring(a), tostring(c), tostring(g),
      tostring(b))
  end
end

local function follow(p, t)
  local g, a, b, c = p.ground, p.crank, p.coupler, p.rocker
  linkage.check_positive("four_bar", { ground = g, crank = a, coupler = b, rocker = c })
  if p.branch == "parallelogram" then
    check_parallelogram(g, a, b, c)
    return core.expression(0), t
  end
  check_assembly(g, a, b, c)
  if p.full_turn then check_full_turn(g, a, b, c) end
  return angles(g, a, b, c, t, p.branch == "open" and 1 or -1)
end

local function build(m, p)
  local offset = linkage.plane(p.axis)
  local crank, joint = m:revolute { from = p.from, axis = p.axis, angle = p.angle, name = "crank" }
  local t = m:coordinate(joint)
  local coupler_angle, rocker_angle = follow(p, t)
  local tip = m:rigid_link { from = crank, offset = offset(p.crank), name = "crank_link" }
  local coupler, coupler_joint = m:revolute { from = tip, axis = p.axis, angle = coupler_angle - t, name = "coupler" }
  local pin = m:rigid_link { from = coupler, offset = offset(p.coupler), name = "coupler_link" }
  local pivot = m:rigid_link { from = p.from, offset = offset(p.ground), name = "ground_link" }
  local rocker, rocker_joint = m:revolute { from = pivot, axis = p.axis, angle = rocker_angle, name = "rocker" }
  local rocker_pin = m:rigid_link { from = rocker, offset = offset(p.rocker), name = "rocker_link" }
  return { crank = crank, coupler = coupler, rocker = rocker, tip = tip, pin = pin, rocker_pin = rocker_pin,
    joint = joint, coupler_joint = coupler_joint, rocker_joint = rocker_joint }
end

return chain.new({
  "four_bar",
  doc = [[
Four links in a loop of four hinges: the crank's angle NAME.crank is the coordinate, coupler and rocker follow. Hands
out the frames crank, coupler, rocker (at the hinge that comes first, first axis along the link), tip (end of the
crank), pin and rocker_pin (ends of coupler and rocker: one point), and the joints joint (of the crank), coupler_joint,
rocker_joint.]],
  ports = { from = { "frame", "carries the crank's hinge; the rocker's is on its first axis in the plane" } },
  parameters = {
    ground = { "m", nil, "from the crank's hinge to the rocker's" },
    crank = { "m", nil, "length of the crank" },
    coupler = { "m", nil, "length of the coupler" },
    rocker = { "m", nil, "length of the rocker" },
    axis = { "1", "z", "of all hinges; the ground is along x (axis z), y (axis x) or z (axis y) of `from`",
      shape = linkage.axes },
    branch = { "1", "open", "on which side the coupler's end is", shape = "open|crossed|parallelogram" },
    full_turn = { "1", true, "must the crank be able to turn all the way? false: it only swings", shape = "flag" },
    angle = { "rad", nil, "given motion of the crank; absent: its angle is a state", optional = true },
  },
  build = build,
}, true)
