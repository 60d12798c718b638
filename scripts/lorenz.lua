-- lorenz.lua: the Lorenz system from one exact point, proved over 20 s although it is chaotic.
--
-- Nearby motions part by a factor of e^0.9 a second, so the rounding errors of the first step are enlarged some 10^8
-- times.
local ambit = require "ambit"

local lorenz = ambit.ode {
  states     = { "x", "y", "z" },
  parameters = { sigma = 10, rho = 28, beta = "8/3" },
  equations  = function(s, p)
    return { x = p.sigma * (s.y - s.x), y = s.x * (p.rho - s.z) - s.y, z = s.x * s.y - p.beta * s.z }
  end,
}

local run = ambit.simulate { lorenz, initial = { x = 15, y = 15, z = 36 }, t = { 0, 1, 5, 10, 15, 20 },
  solver = "lohner" }

print(("%-5s  %-38s  %-38s  %-38s  %s"):format("t, s", "x", "y", "z", "width"))
for _, t in ipairs { 1, 5, 10, 15, 20 } do
  if t <= run.t_reached then
    local x = run:at(t)
    local width = math.max(x.x:width(), x.y:width(), x.z:width())
    print(("%-5g  %-38s  %-38s  %-38s  %.1e"):format(t, x.x, x.y, x.z, width))
  end
end
print(run)
print(("%.3f s of CPU time"):format(run.cpu_seconds))
