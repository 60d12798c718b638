-- four_bar.lua -- a crank and rocker whose links are made to a tolerance: where can a point of the coupler be?
--
-- The loop is closed by formulas (docs/mechanisms.md), so the crank's angle is the only coordinate. Lengths +-0.05 mm
-- on links of 40 to 140 mm: for each angle, a box in which the point is for every linkage that passes inspection, with
-- the proof that each of them can turn all the way. Taylor models know that one length moves everything together.
local ambit = require "ambit"
local around, degrees = ambit.around, ambit.degrees

local m = ambit.mechanism "four-bar"
local links = m:four_bar {
  from = m.world, name = "links",
  ground = around("140 mm", "0.05 mm"), crank = around("40 mm", "0.05 mm"),
  coupler = around("120 mm", "0.05 mm"), rocker = around("100 mm", "0.05 mm"),
}
local point = m:frame { from = links.coupler, offset = { "60 mm", "50 mm", 0 } }
local wanted = { point = m:position(point), gap = m:position(links.pin) - m:position(links.rocker_pin) }

print "crank, degrees   point of the coupler, mm                                width, um      gap of the loop, m"
for angle = 0, 330, 30 do
  local now = ambit.evaluate { wanted, at = { ["links.crank"] = degrees(angle) }, arithmetic = "taylor_model" }
  local x, y = 1000 * now.point.x, 1000 * now.point.y
  print(("%-15d  %-26s  %-26s  %3.0f x %-3.0f      %.1e"):format(angle, x:text(7), y:text(7), 1000 * x:width(),
    1000 * y:width(), math.max(now.gap.x:mag(), now.gap.y:mag())))
end
