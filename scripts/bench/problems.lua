-- problems.lua -- the initial-value problems that validated solvers are measured by, as equations written by hand:
-- { system, names, initial, t } each. P1 to P6 are those on which the peers of docs/results.md were run.
local ambit = require "ambit"
local around, between, number, pi = ambit.around, ambit.between, ambit.number, ambit.pi

local problems = {}

-- P1, P2: the double pendulum in relative angles (ValEncIA-IVP paper, equations 23 to 25); `first` is the angle of
-- its first arm, known to 1 % in P1.
local angles = { "beta1", "beta2", "w1", "w2" }
local double_pendulum = ambit.ode {
  states = angles,
  equations = function(s)
    local g = number "9.81"
    local s1, c1 = ambit.sin(s.beta2), ambit.cos(s.beta2)
    local r1 = s1 * (s.w1 + s.w2) ^ 2 - 2 * g * ambit.sin(s.beta1)
    local r2 = -s1 * s.w1 ^ 2 - g * ambit.sin(s.beta1 + s.beta2)
    local d = 1 + s1 ^ 2
    local a1 = (r1 - c1 * r2) / d
    return { beta1 = s.w1, beta2 = s.w2, w1 = a1, w2 = (2 * r2 - c1 * r1) / d - a1 }
  end,
}
local function pendulum_from(first)
  return { system = double_pendulum, names = angles, t = 10,
    initial = { beta1 = first, beta2 = -11 * pi / 20, w1 = "0.43", w2 = "0.67" } }
end
problems.P1 = pendulum_from(around(3 * pi / 4, "1%"))
problems.P1_wide = pendulum_from(around(3 * pi / 4, "10%"))
problems.P2 = pendulum_from(3 * pi / 4)

-- P3: Lorenz's equations.
problems.P3 = {
  system = ambit.ode {
    states = { "x", "y", "z" },
    equations = function(s)
      return { x = 10 * (s.y - s.x), y = s.x * (28 - s.z) - s.y, z = s.x * s.y - number "8/3" * s.z }
    end,
  },
  names = { "x", "y", "z" }, initial = { x = 15, y = 15, z = 36 }, t = 20,
}

-- P4, P5: Van der Pol's oscillator.
function problems.van_der_pol(mu)
  return ambit.ode {
    states = { "x", "v" }, equations = function(s) return { x = s.v, v = mu * (1 - s.x ^ 2) * s.v - s.x } end,
  }
end
local pair = { "x", "v" }
problems.P4 = { system = problems.van_der_pol(1), names = pair, t = 7,
  initial = { x = between("1.25", "1.55"), v = between("2.35", "2.45") } }
problems.P5_van_der_pol = { system = problems.van_der_pol(1000), names = pair, t = 2000, initial = { x = 2, v = 0 },
  digits = { "1.7061677321704650084765", "-8.9280970102481654777515e-4" } }
-- the period is (3 - 2 log 2) mu + 7.0143 mu^(-1/3) + ...: 161371 for mu = 1e5
problems.P5_period = { system = problems.van_der_pol(100000), names = pair, t = 161400, initial = { x = 2, v = 0 } }

-- P5: Robertson's reactions.
local kinetics = { "y1", "y2", "y3" }
function problems.robertson(t, k1, k2, k3)
  k1, k2, k3 = k1 or number "0.04", k2 or 3e7, k3 or 1e4
  return {
    system = ambit.ode {
      states = kinetics,
      equations = function(s)
        return { y1 = -k1 * s.y1 + k3 * s.y2 * s.y3, y2 = k1 * s.y1 - k3 * s.y2 * s.y3 - k2 * s.y2 ^ 2,
          y3 = k2 * s.y2 ^ 2 }
      end,
    },
    names = kinetics, initial = { y1 = 1, y2 = 0, y3 = 0 }, t = t,
    digits = t == 1e11 and { "2.0833401497012942e-8", "8.3333607703347834e-14", "0.99999997916651517" } or nil,
  }
end

-- P5: a fast decay towards a slow curve.
problems.P5_linear = {
  system = ambit.ode { states = { "y" },
    equations = function(s, _, t) return { y = -1000 * (s.y - ambit.cos(t)) } end },
  names = { "y" }, initial = { y = 0 }, t = 2000,
}

-- P6: oscillators for a long time.
local swing = { "phi", "omega" }
problems.P6_pendulum = {
  system = ambit.ode { states = swing,
    equations = function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) } end },
  names = swing, initial = { phi = 1, omega = 0 }, t = 100,
}
problems.P6_linear = {
  system = ambit.ode { states = pair, equations = function(s) return { x = s.v, v = -s.x } end },
  names = pair, initial = { x = 1, v = 0 }, t = 100,
}

-- HIRES and OREGO of the test set for initial value problems.
local responses = { "y1", "y2", "y3", "y4", "y5", "y6", "y7", "y8" }
problems.hires = {
  system = ambit.ode {
    states = responses,
    equations = function(y)
      local n = number
      return {
        y1 = -n "1.71" * y.y1 + n "0.43" * y.y2 + n "8.32" * y.y3 + n "0.0007",
        y2 = n "1.71" * y.y1 - n "8.75" * y.y2,
        y3 = -n "10.03" * y.y3 + n "0.43" * y.y4 + n "0.035" * y.y5,
        y4 = n "8.32" * y.y2 + n "1.71" * y.y3 - n "1.12" * y.y4,
        y5 = -n "1.745" * y.y5 + n "0.43" * (y.y6 + y.y7),
        y6 = -280 * y.y6 * y.y8 + n "0.69" * y.y4 + n "1.71" * y.y5 - n "0.43" * y.y6 + n "0.69" * y.y7,
        y7 = 280 * y.y6 * y.y8 - n "1.81" * y.y7,
        y8 = -280 * y.y6 * y.y8 + n "1.81" * y.y7,
      }
    end,
  },
  names = responses, initial = { 1, 0, 0, 0, 0, 0, 0, "0.0057" }, t = "321.8122",
  digits = { "7.371312573325667807277e-4", "1.442485726316184658188e-4", "5.888729740967575007484e-5",
    "1.175651343283149145506e-3", "2.386356198831330468821e-3", "6.238968252742795786648e-3",
    "2.849998395185768657930e-3", "2.850001604814231342070e-3" },
}
problems.orego = {
  system = ambit.ode {
    states = kinetics,
    equations = function(y)
      local s, q, w = number "77.27", number "8.375e-6", number "0.161"
      return { y1 = s * (y.y2 + y.y1 - y.y1 * y.y2 - q * y.y1 ^ 2), y2 = (y.y3 - (1 + y.y1) * y.y2) / s,
        y3 = w * (y.y1 - y.y3) }
    end,
  },
  names = kinetics, initial = { 1, 2, 3 }, t = 360,
  digits = { "1.0008148703185227163", "1228.1785215498879837", "132.05549428465082877" },
}

-- Explodes at t = 1.
problems.escape = {
  system = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end },
  names = { "x" }, initial = { x = 1 }, t = 2,
}

-- What ambit.simulate takes: the problem to time t (its own if nil) with these settings.
function problems.request(problem, t, settings)
  local request = { problem.system, initial = problem.initial, t = type(t) == "table" and t or { 0, t or problem.t } }
  for key, value in pairs(settings) do request[key] = value end
  return request
end

return problems
