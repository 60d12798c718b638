-- double_pendulum.lua: a validated simulation with an uncertain first angle.
--
-- Two point masses on massless rods, the first angle known to 1 %. Chaos stretches and folds the set of possible
-- motions; the enclosures hold for every one of them. Boxes and linear maps of the data end between t = 0.4 and 1
-- (Auer et al. 2007, and `lohner` here); polynomials of the uncertain angle follow the fold.
local ambit = require "ambit"
local pi, around = ambit.pi, ambit.around

local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
local hand  = m:rigid_link { from = m:revolute { from = elbow,   axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
m:point_mass { at = hand,  mass = 1 }

local times = { 0, "0.2", "0.4", "0.6", "0.8", 1, "1.5", 2, "2.5", 3 }
local run = ambit.simulate {
  m:dynamics(),                                  -- states beta1, beta2, beta1', beta2'
  initial = { beta1 = around(3 * pi / 4, "1%"), beta2 = -11 * pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" },
  t = times, solver = "taylor_model", order = 12,
}

print "t, s   beta1, rad           beta2, rad            beta1', rad/s        beta2', rad/s"
for i = 2, #times do
  if tonumber(times[i]) <= run.t_reached then
    local x = run:at(times[i])
    print(("%.1f    %-19s  %-20s  %-19s  %s"):format(times[i], x.beta1, x.beta2, x["beta1'"], x["beta2'"]))
  end
end
print(run)
print(("%.3f s of CPU time"):format(run.cpu_seconds))

-- where it can rest, and whether it would stay there
local rest = ambit.equilibria { m:dynamics(), box = { beta1 = { "-3.15", 1 }, beta2 = { "-3.15", 1 } } }
for _, point in ipairs(rest.proved) do
  print(("rest at beta1 = %.4f, beta2 = %.4f: %s"):format(point.beta1:mid(), point.beta2:mid(), point.stability))
end
