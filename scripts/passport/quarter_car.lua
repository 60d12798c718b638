-- A quarter of a car passes a bump of 6 cm. Its damper is harder in rebound than in compression. Masses +-2 %, springs
-- and damper +-5 %.
local ambit = require "ambit"
local around, min, max = ambit.around, ambit.min, ambit.max

local body, wheel = around(320, "2%", "body"), around(45, "2%", "wheel")
local spring, tyre = around(22000, "5%", "spring"), around(190000, "5%", "tyre")
local compression, rebound = around(900, "5%", "compression"), around(2200, "5%", "rebound")

local car = ambit.ode { "quarter car", states = { z = "m", v = "m/s", zw = "m", vw = "m/s" },
  equations = function(x, _, t)
    local s = min(max((t - "0.1") / "0.15", 0), 1)
    local road = "0.03 m" * (1 - ambit.cos(2 * ambit.pi * s))
    local d = x.v - x.vw
    local force = spring * (x.z - x.zw) + rebound * max(d, 0) + compression * min(d, 0)
    return { z = x.v, v = -force / body, zw = x.vw, vw = (force - tyre * (x.zw - road)) / wheel }
  end }

local run = ambit.simulate { car, initial = { z = 0, v = 0, zw = 0, vw = 0 },
  t = { 0, "0.1", "0.25", "0.5", 1, "1.5" } }
print(run)
