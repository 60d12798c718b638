-- A DC motor with a gear of 60 and a cascaded controller raises an arm by 1 rad. Masses +-2 %, torque constant,
-- resistance and friction +-5 %, arm +-0.1 mm.
local ambit = require "ambit"
local around = ambit.around

local mass, length = around(3, "2%", "load"), around("0.4", "0.1 mm", "arm")
local kt, R, friction = around("0.042", "5%", "kt"), around("0.8", "5%", "R"), around("0.004", "5%", "friction")
local N, L = 60, "0.6e-3"

local servo = ambit.ode { "servo", states = { "q", "w", "i", "e" }, check_units = false,
  equations = function(s)
    local wanted = 8 * (1 - s.q)
    local voltage = "1.2" * N * kt * (wanted - s.w) + 20 * s.e
    local inertia = mass * length ^ 2 + "0.9e-4" * ambit.number(N * N)
    return {
      q = s.w,
      w = (N * kt * s.i - friction * N * N * s.w / 10 - mass * "9.81" * length * ambit.cos(s.q)) / inertia,
      i = (voltage - R * s.i - N * kt * s.w) / L,
      e = wanted - s.w,
    }
  end }

local run = ambit.simulate { servo, initial = { q = 0, w = 0, i = 0, e = 0 }, t = { 0, "0.2", "0.5", 1, 2 } }
print(run)
