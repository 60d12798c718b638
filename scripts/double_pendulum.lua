-- double_pendulum.lua: a validated simulation with an uncertain first angle.
--
-- Two point masses on massless rods, the first angle known to 1 %. Chaos stretches the set of possible motions; the
-- enclosures hold for every one of them, until no step can be proved any more (Auer et al. 2007; usual validated
-- solvers end between t = 0.4 and 0.6).
local ambit = require "ambit"
local pi, around = ambit.pi, ambit.around

local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
local hand  = m:rigid_link { from = m:revolute { from = elbow,   axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
m:point_mass { at = hand,  mass = 1 }

local times = { 0, "0.1", "0.2", "0.3", "0.4", "0.5", "0.6" }
local run = ambit.simulate {
  m:dynamics(),                                  -- states beta1, beta2, beta1', beta2'
  initial = { beta1 = around(3 * pi / 4, "1%"), beta2 = -11 * pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" },
  t = times, solver = "lohner",
}

print "t, s   beta1, rad         beta2, rad            beta1', rad/s        beta2', rad/s"
for i = 2, #times do
  if tonumber(times[i]) <= run.t_reached then
    local x = run:at(times[i])
    print(("%.1f    %-17s  %-20s  %-19s  %s"):format(times[i], x.beta1, x.beta2, x["beta1'"], x["beta2'"]))
  end
end
print(run)
print(("%.3f s of CPU time"):format(run.cpu_seconds))
