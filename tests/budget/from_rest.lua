-- from_rest.lua -- three links released horizontally, the first angle known to 1e-4 rad, with Taylor models.
--
-- The third link starts at rest and hardly moves: its truncation is rounding of terms that cancel, large beside a speed
-- near zero, and no split mends it. Splitting all the same took 256 pieces and 30 times the work.
local ambit = require "ambit"
local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
local at, rest = m.world, {}
for i = 1, 3 do
  local name = "hinge" .. i
  local hinge = m:revolute { from = at, axis = "z", name = name }
  at = m:rigid_link { from = hinge, offset = { "0.5", 0, 0 } }
  m:point_mass { at = at, mass = 1 }
  rest[name], rest[name .. "'"] = 0, 0
end
rest.hinge1 = ambit.between("-1e-4", "1e-4")
local run = ambit.simulate { m:dynamics(), initial = rest, t = { 0, "0.1" }, solver = "taylor_model" }
assert(run.status == "complete", run.reason)
