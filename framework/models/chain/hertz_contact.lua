-- chain/hertz_contact.lua -- m:hertz_contact { from = a, to = b, reach = d, radius = r, modulus = e, damping = c }: two
-- balls, or a ball and a plane, that touch where they come nearer than `reach`.
--
--   f = 4/3 e sqrt(r) depth^(3/2) (1 + c depth'),   depth = max(reach - distance, 0)
-- Hertz, J. reine angew. Math. 92 (1882), with the damping of Hunt & Crossley, J. Appl. Mech. 42 (1975). depth^(3/2) is
-- written depth^2 / sqrt(depth + rounding): Hertz's root has no second derivative where contact begins. That is less by
-- at most rounding / (2 depth) of it.
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"

local function law(p, distance, rate)
  local depth = core.max(p.reach - distance, 0)
  return core.expression(4) / 3 * p.modulus * core.sqrt(p.radius) * core.sqr(depth) / core.sqrt(depth + p.rounding)
    * (1 - p.damping * rate)
end

local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end

-- The plane stands still: nothing feels the reaction.
local function on_plane(m, p)
  local force
  m:applied_force { at = p.to, name = "law", force = function(position, velocity)
    force = law(p, dot(p.normal, { position[1] - p.point[1], position[2] - p.point[2], position[3] - p.point[3] }),
      dot(p.normal, velocity))
    return { force * p.normal[1], force * p.normal[2], force * p.normal[3] }
  end }
  return { force = force }
end

local function build(m, p)
  if (p.from == nil) == (p.normal == nil) then
    check.fail "hertz_contact: expected either `from`, the other ball, or `normal`, of a plane"
  end
  if p.normal then return on_plane(m, p) end
  local force
  m:force_law { from = p.from, to = p.to, name = "law", force = function(length, rate)
    force = law(p, length, rate)
    return force
  end }
  return { force = force }
end

return chain.new({
  "hertz_contact",
  doc = [[
Two balls, or a ball and a plane that stands still, push each other where they are nearer than `reach`. Hands out the
expression force.]],
  ports = { from = { "frame", "the centre of one ball", optional = true }, to = { "frame", "that of the other" } },
  parameters = {
    reach = { "m", nil, "distance of the centres where they touch: the sum of the radii, the radius on a plane" },
    radius = { "m", nil, "of both together: 1 / (1/r1 + 1/r2); the ball's on a plane" },
    modulus = { "Pa", nil, "of both together: 1 / ((1 - nu1^2) / E1 + (1 - nu2^2) / E2)" },
    damping = { "s/m", "0", "share of the force per speed at which they come nearer" },
    rounding = { "m", "1e-6", "how deep they are where the force is less than Hertz's by a third" },
    normal = { "1", nil, "of the plane, up from it, in world axes", shape = "axis", optional = true },
    point = { "m", "0,0,0", "of the plane, in the world", shape = "3" },
  },
  build = build,
}, true)
