-- bouncing_ball.lua: a ball that bounces, its height, weight and restitution only known to tolerances.
--
-- A switching model of one mode: where the height crosses 0 downwards the speed is reset. Every bounce is proved to
-- happen, once, for every ball in the set, and the enclosures stay correlated through all of them.
local ambit = require "ambit"

local restitution = ambit.around("0.8", "0.001")

local ball = ambit.ode {
  states     = { y = "m", v = "m/s" },
  parameters = { g = "9.81", drag = ambit.around("0.01", "10%") },
  equations  = function(s, p) return { y = s.v, v = -p.g - p.drag * s.v } end,
}

local run = ambit.hybrid {
  modes = {
    flight = { ball, guards = { {
      g = function(s) return s.y end, direction = "falling", name = "bounce", to = "flight",
      reset = function(s) return { v = -restitution * s.v } end,
    } } },
  },
  initial = { y = ambit.around(1, "0.001"), v = 0 },
  t = { 0, 2 },
}

for _, bounce in ipairs(run.events) do
  print(("%s in t = %-22s with v in %s"):format(bounce.name, bounce.t, bounce.x.v))
end
for _, t in ipairs { 0.4, 0.8, 1.2, 1.6, 2 } do
  print(("t = %.1f  y in %s"):format(t, run:at(t).y))
end
print(run)
