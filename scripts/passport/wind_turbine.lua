-- The drive train of a wind turbine in a gust: rotor, shaft, gearbox, generator with a torque law of the speed squared.
-- Moments of inertia +-2 %, shaft +-5 %, wind +-5 %.
local ambit = require "ambit"
local around = ambit.around

local rotor, generator = around("4e6", "2%", "rotor"), around(60, "2%", "generator")
local k, d = around("1.2e8", "5%", "shaft"), around("8e5", "5%", "shaft damping")
local wind = around(8, "5%", "wind")
local N, radius = 90, 35

local train = ambit.ode { "wind turbine", states = { "wr", "wg", "twist" }, check_units = false,
  equations = function(s, _, t)
    local v = wind + 3 * (1 - ambit.cos(2 * ambit.pi * t / 20)) / 2
    local ratio = s.wr * radius / v                                          -- tip speed ratio
    local cq = "0.065" * ratio / 7 * ambit.exp(1 - ratio / 7)
    local aero = "0.5" * "1.225" * ambit.pi * ambit.number(radius) ^ 3 * v ^ 2 * cq
    local shaft = k * s.twist + d * (s.wr - s.wg / N)
    return { wr = (aero - shaft) / rotor, wg = (shaft / N - "0.055" * s.wg ^ 2) / generator, twist = s.wr - s.wg / N }
  end }

local run = ambit.simulate { train, initial = { wr = "1.6", wg = 144, twist = "0.0008" }, t = { 0, 5, 10, 15, 20 } }
print(run)
