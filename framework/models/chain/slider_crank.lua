-- chain/slider_crank.lua -- m:slider_crank { from = f, crank = a, rod = l, offset = e }: three hinges and a slider in a
-- loop, whose other coordinates are explicit functions of the crank's angle.
--
-- In the plane, B = a (cos t, sin t) the crank's tip, the slider at (x, e) (Norton, Design of Machinery, 4.8):
--   rod     out: asin((e - a sin t) / l)           in: pi - asin((e - a sin t) / l)        t occurs once
--   slider  x = a cos t +- sqrt(l^2 - (a sin t - e)^2)
-- Dead where the rod is across the guide, |a sin t - e| = l. The crank turns all the way if a + |e| < l, which is
-- proved for all data in their tolerances; else `full_turn = false`.
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"
local linkage = require "ambit.linkage"

local function say(e) return tostring(linkage.enclose(e)) end

local function check_lengths(p)
  linkage.check_positive("slider_crank", { crank = p.crank, rod = p.rod })
  linkage.check_fixed("slider_crank", "offset", p.offset)
  local size = core.abs(p.offset)
  local _, never = linkage.is_positive(p.rod + p.crank - size)
  if never then
    check.fail("slider_crank: it cannot be assembled: crank + rod = %s m do not reach over the offset, %s m",
      say(p.crank + p.rod), say(size))
  end
  if p.full_turn and not linkage.is_positive(p.rod - p.crank - size) then
    check.fail("slider_crank: not proved that the crank can turn all the way: rod = %s m must be longer than crank + "
      .. "offset = %s m; for a crank that only swings say full_turn = false", say(p.rod), say(p.crank + size))
  end
end

local function build(m, p)
  check_lengths(p)
  local offset = linkage.plane(p.axis)
  local crank, joint = m:revolute { from = p.from, axis = p.axis, angle = p.angle, name = "crank" }
  local t = m:coordinate(joint)
  local tilt = core.asin((p.offset - p.crank * core.sin(t)) / p.rod)
  local reach = core.sqrt(core.sqr(p.rod) - core.sqr(p.crank * core.sin(t) - p.offset))
  local out = p.branch == "out"
  local tip = m:rigid_link { from = crank, offset = offset(p.crank), name = "crank_link" }
  local rod, rod_joint = m:revolute { from = tip, axis = p.axis, angle = (out and tilt or core.pi() - tilt) - t,
    name = "rod" }
  local pin = m:rigid_link { from = rod, offset = offset(p.rod), name = "rod_link" }
  local guide = m:rigid_link { from = p.from, offset = offset(0, p.offset), name = "guide" }
  local x = p.crank * core.cos(t) + (out and reach or -reach)
  local slider, slider_joint = m:prismatic { from = guide, axis = offset(1), displacement = x, name = "slider" }
  return { crank = crank, rod = rod, slider = slider, tip = tip, pin = pin, joint = joint, rod_joint = rod_joint,
    slider_joint = slider_joint }
end

return chain.new({
  "slider_crank",
  doc = [[
Crank, rod and slider: the crank's angle NAME.crank is the coordinate, rod and slider follow. Hands out the frames
crank, rod, slider, tip (end of the crank), pin (end of the rod), and the joints joint (of the crank), rod_joint,
slider_joint.]],
  ports = { from = { "frame", "carries the crank's hinge; the slider moves along its first axis in the plane" } },
  parameters = {
    crank = { "m", nil, "length of the crank" },
    rod = { "m", nil, "length of the connecting rod" },
    offset = { "m", "0", "of the slider's line from the crank's hinge, along the second axis in the plane" },
    axis = { "1", "z", "of all hinges; the slider moves along x (axis z), y (axis x) or z (axis y) of `from`",
      shape = linkage.axes },
    branch = { "1", "out", "on which side of the crank the slider is: along the first axis, or against it",
      shape = "out|in" },
    full_turn = { "1", true, "must the crank be able to turn all the way? false: it only swings", shape = "flag" },
    angle = { "rad", nil, "given motion of the crank; absent: its angle is a state", optional = true },
  },
  build = build,
}, true)
