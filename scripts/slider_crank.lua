-- slider_crank.lua -- an engine coasts: how uneven is its turning, whatever the piston weighs?
--
-- Crank 40 mm, rod 130 mm, a flywheel, and a piston of 0.4 kg +-10 %. Rod and piston follow the crank by formulas
-- (docs/mechanisms.md): one degree of freedom, no constraint. The enclosures hold for every piston in the tolerance;
-- twice a turn it takes energy from the flywheel and gives it back.
local ambit = require "ambit"

local m = ambit.mechanism "engine"
local engine = m:slider_crank { from = m.world, name = "engine", crank = "40 mm", rod = "130 mm" }
local piston = ambit.around("0.4 kg", "10%")
m:rigid_body { at = engine.crank, mass = 4, inertia = { { "0.01", 0, 0 }, { 0, "0.01", 0 }, { 0, 0, "0.02" } } }
m:point_mass { at = engine.slider, mass = piston }

local times = { 0 }
for i = 1, 12 do times[i + 1] = ("%.3f"):format(0.005 * i) end
local run = ambit.simulate {
  m:dynamics(), initial = { ["engine.crank"] = 0, ["engine.crank'"] = 100 }, t = times, solver = "lohner",
}

print "t, s    crank, rad                  speed of the crank, rad/s   piston, mm"
local place = m:position(engine.slider).x
for i = 2, #times do
  local x = run:at(times[i])
  local at = ambit.evaluate { place, at = { ["engine.crank"] = x["engine.crank"] } }
  print(("%s   %-26s  %-26s  %s"):format(times[i], x["engine.crank"]:text(6), x["engine.crank'"]:text(6),
    (1000 * at):text(5)))
end
print(run)
