-- A car keeps its lane on a curve at 25 m/s: it starts up to 20 cm beside the middle and never leaves +-60 cm.
-- Mass +-2 %, cornering stiffness +-5 %.
local ambit = require "ambit"
local around = ambit.around

local mass, cf, cr = around(1500, "2%", "mass"), around(80000, "5%", "front"), around(95000, "5%", "rear")
local inertia, a, b, v = 2600, "1.2", "1.5", 25

local car = ambit.ode { "lane keeping", states = { "beside", "heading", "slip", "rate" }, check_units = false,
  equations = function(s, _, t)
    local bend = "0.002" * (1 - ambit.cos(ambit.pi * t / 4))                    -- curvature, 1/m
    local steer = "-0.035" * s.beside - "0.5" * s.heading - "0.02" * s.rate + "3.5" * bend
    local front = cf * ambit.atan(steer - s.slip - ambit.number(a) * s.rate / v)
    local rear = cr * ambit.atan(-s.slip + ambit.number(b) * s.rate / v)
    return {
      beside = v * ambit.sin(s.heading + s.slip),
      heading = s.rate - v * ambit.cos(s.heading + s.slip) * bend,
      slip = (front + rear) / (mass * v) - s.rate,
      rate = (ambit.number(a) * front - ambit.number(b) * rear) / inertia,
    }
  end }

local report = ambit.verify { car, t = 8,
  initial = { beside = around(0, "0.2"), heading = 0, slip = 0, rate = 0 },
  safe = { left = function(s) return s.beside - "0.6" end, right = function(s) return -s.beside - "0.6" end } }
print(report)
