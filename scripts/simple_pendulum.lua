-- simple_pendulum.lua: phi'' = -sin phi from rest at 1 rad, proved over 100 s.
local ambit = require "ambit"

local pendulum = ambit.ode {
  states    = { "phi", "omega" },
  equations = function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) } end,
}

local run = ambit.simulate { pendulum, initial = { phi = 1, omega = 0 }, t = { 0, 25, 50, 75, 100 }, solver = "lohner" }

print(("%-5s  %-38s  %-38s  %s"):format("t, s", "phi, rad", "omega, rad/s", "width"))
for _, t in ipairs { 25, 50, 75, 100 } do
  if t <= run.t_reached then
    local x = run:at(t)
    print(("%-5g  %-38s  %-38s  %.1e"):format(t, x.phi, x.omega, math.max(x.phi:width(), x.omega:width())))
  end
end
print(run)
print(("%.3f s of CPU time"):format(run.cpu_seconds))
