-- Mechanics: { name, states, rates, initial values, end }; data within the tolerances that exercises give.
local ambit = require "ambit"
local around, sin, cos, sqrt, exp = ambit.around, ambit.sin, ambit.cos, ambit.sqrt, ambit.exp
local two = { "x", "v" }
local g = "9.81"

local k, c, m = around(40, "5%"), around("0.8", "5%"), around(1, "2%")
local length, mu = around("0.5", "1%"), around("0.3", "5%")

return {
  { "mass on a spring", two, function(s) return { s.v, -k / m * s.x } end, { "0.1", 0 }, 5 },
  { "damped spring from rest under a step", two, function(s) return { s.v, (2 - k * s.x - c * s.v) / m } end,
    { 0, 0 }, 10 },
  { "resonance", two, function(s, _, t) return { s.v, (sin(6 * t) - k * s.x - c * s.v) / m } end, { 0, 0 }, 10 },
  { "overdamped door", two, function(s) return { s.v, -k * s.x - 60 * s.v } end, { around(1, "5%"), 0 }, 5 },
  { "pendulum", two, function(s) return { s.v, -g / length * sin(s.x) } end, { around(1, "1%"), 0 }, 10 },
  { "pendulum over the top", two, function(s) return { s.v, -g * sin(s.x) } end, { 0, around("6.6", "0.1%") }, 4 },
  { "damped pendulum from 170 degrees", two, function(s) return { s.v, -g * sin(s.x) - c * s.v } end,
    { around("2.96", "0.5%"), 0 }, 8 },
  { "falling with air", two, function(s) return { s.v, "9.81" - mu * s.v ^ 2 } end, { 0, 0 }, 5 },
  { "rocket of Tsiolkovsky", { "h", "v", "mass" }, function(s)
    return { s.v, 2000 * around(2, "2%") / s.mass - g, -2 }
  end, { 0, 0, 200 }, 40 },
  { "projectile with drag", { "x", "y", "u", "w" }, function(s)
    local speed = sqrt(s.u ^ 2 + s.w ^ 2)
    return { s.u, s.w, -"0.01" * mu * speed * s.u, -"0.01" * mu * speed * s.w - g }
  end, { 0, 0, around(30, "1%"), 30 }, 5 },
  { "Kepler ellipse", { "x", "y", "u", "w" }, function(s)
    local r3 = (s.x ^ 2 + s.y ^ 2) ^ "1.5"
    return { s.u, s.w, -s.x / r3, -s.y / r3 }
  end, { 1, 0, 0, around("1.1", "0.1%") }, 10 },
  { "Duffing oscillator", two, function(s, _, t)
    return { s.v, "0.3" * cos(t) - "0.2" * s.v + s.x - s.x ^ 3 }
  end, { around(1, "0.5%"), 0 }, 10 },
  { "pendulum on a turning hoop", two, function(s)
    return { s.v, (around(9, "1%") * cos(s.x) - g) * sin(s.x) - "0.5" * s.v }
  end, { "0.3", 0 }, 6 },
  { "bead on a parabola", two, function(s)
    return { s.v, -(4 * s.x * s.v ^ 2 + 2 * 9.81 * s.x) / (1 + 4 * s.x ^ 2) }
  end, { around("0.5", "1%"), 0 }, 5 },
  { "Foucault's pendulum", { "x", "y", "u", "w" }, function(s)
    local turn = around("5.2e-5", "5%")
    return { s.u, s.w, -s.x / 7 + 2 * turn * s.w, -s.y / 7 - 2 * turn * s.u }
  end, { 1, 0, 0, 0 }, 60 },
  { "two masses, three springs", { "x", "y", "u", "w" }, function(s)
    return { s.u, s.w, -k * s.x - 10 * (s.x - s.y), -k * s.y + 10 * (s.x - s.y) }
  end, { "0.1", 0, 0, 0 }, 5 },
  { "Euler's top", { "p", "q", "r" }, function(s)
    return { -s.q * s.r, s.p * s.r, -"0.5" * s.p * s.q }
  end, { around(1, "1%"), "0.1", around(1, "1%") }, 10 },
  { "vibration absorber", { "x", "y", "u", "w" }, function(s, _, t)
    return { s.u, s.w, sin(5 * t) - 25 * s.x - around(5, "5%") * (s.x - s.y),
      around(25, "5%") * (s.x - s.y) - "0.1" * (s.w - s.u) }
  end, { 0, 0, 0, 0 }, 6 },
  { "rolling with friction of a tanh law", two, function(s) return { s.v, -2 * ambit.tanh(s.v / "0.1") } end,
    { 0, around(3, "1%") }, 1 },
  { "bungee jump, smooth cord", two, function(s)
    return { s.v, "9.81" - around(4, "5%") * ambit.log(1 + exp(s.x - 20)) - "0.05" * s.v }
  end, { 0, 0 }, 8 },
}
