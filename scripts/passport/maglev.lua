-- A steel ball of 50 g hangs under a magnet: current controller, position feedback. It is released up to half a
-- millimetre from its place and stays within 2 mm of it. Mass +-2 %, magnet and resistance +-5 %.
local ambit = require "ambit"
local around = ambit.around

local mass, force = around("0.05", "2%", "ball"), around("1.2e-4", "5%", "magnet")
local R, L = around(10, "5%", "resistance"), "0.05"

local ball = ambit.ode { "levitation", states = { "gap", "speed", "current", "sum" }, check_units = false,
  equations = function(s)
    local e = s.gap - "0.01"
    local wanted = "0.639" + 260 * e + "7" * s.speed + 600 * s.sum
    local voltage = 10 * s.current + 25 * (wanted - s.current)
    return { gap = s.speed, speed = "9.81" - force * (s.current / s.gap) ^ 2 / mass,
      current = (voltage - R * s.current) / L, sum = e }
  end }

local report = ambit.verify { ball, t = 2,
  initial = { gap = around("0.01", "0.5 mm"), speed = 0, current = "0.639", sum = 0 },
  safe = { low = function(s) return s.gap - "0.012" end, high = function(s) return "0.008" - s.gap end } }
print(report)
