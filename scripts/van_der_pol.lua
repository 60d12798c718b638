-- van_der_pol.lua: Van der Pol's oscillator from one exact point, and from a box of starting points.
--
-- The limit cycle attracts: the point's enclosure stays narrow. A whole box is stretched along the cycle and folded;
-- polynomials of the two starting values follow it.
local ambit = require "ambit"

local oscillator = ambit.ode {
  states     = { "x", "v" },
  parameters = { mu = 1 },
  equations  = function(s, p) return { x = s.v, v = p.mu * (1 - s.x ^ 2) * s.v - s.x } end,
}

local function report(what, initial, times, solver)
  local run = ambit.simulate { oscillator, initial = initial, t = times, solver = solver }
  print(what)
  for i = 2, #times do
    if times[i] <= run.t_reached then
      local x = run:at(times[i])
      print(("  t = %-4g  x in %-42s  v in %s"):format(times[i], x.x, x.v))
    end
  end
  print("  " .. tostring(run))
end

report("from (2, 0)", { x = 2, v = 0 }, { 0, 5, 10, 20 }, "lohner")
report("from [1.25, 1.55] x [2.35, 2.45]", { x = ambit.between("1.25", "1.55"), v = ambit.between("2.35", "2.45") },
  { 0, 1, 2, 4, 7 }, "taylor_model")
