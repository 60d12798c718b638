-- Control: { name, states, rates, initial values, end }; plants within 5 %, starts uncertain.
local ambit = require "ambit"
local around, sin, cos, tanh, atan = ambit.around, ambit.sin, ambit.cos, ambit.tanh, ambit.atan
local xv, xvi = { "x", "v" }, { "x", "v", "i" }
local function plant(k) return around(k, "5%") end
local a, b = plant(1), plant(2)

return {
  { "double integrator, PD", xv, function(s) return { s.v, -4 * a * s.x - 3 * s.v } end, { around(0, 1), 0 }, 8 },
  { "first order with PI", { "x", "i" }, function(s)
    return { -a * s.x + b * (2 * (1 - s.x) + 3 * s.i), 1 - s.x }
  end, { 0, 0 }, 8 },
  { "position servo, PID", xvi, function(s)
    return { s.v, a * (10 * (1 - s.x) + 4 * s.i - 5 * s.v), 1 - s.x }
  end, { 0, 0, 0 }, 8 },
  { "lag of third order, P", { "x", "y", "z" }, function(s)
    return { a * (3 * (1 - s.z) - s.x), b * (s.x - s.y), s.y - s.z }
  end, { 0, 0, 0 }, 8 },
  { "saddle held by feedback", xv, function(s) return { s.v, a * s.x - 5 * s.x - 4 * s.v } end,
    { around(0, "0.5"), around(0, "0.5") }, 6 },
  { "inverted pendulum, PD", xv, function(s) return { s.v, "9.81" * sin(s.x) - a * (30 * s.x + 8 * s.v) } end,
    { around("0.3", "0.05"), 0 }, 4 },
  { "pendulum swung up by energy", xv, function(s)
    local energy = s.v ^ 2 / 2 - "9.81" * (1 + cos(s.x))
    return { s.v, "9.81" * sin(s.x) * -1 - "0.02" * energy * s.v }
  end, { around("0.5", "1%"), 0 }, 4 },
  { "actuator that saturates", xv, function(s) return { s.v, 2 * tanh(-3 * s.x - 3 * s.v) } end,
    { around(1, "0.1"), 0 }, 6 },
  { "observer and feedback", { "x", "v", "y", "w" }, function(s)
    local u = -2 * s.y - 3 * s.w
    return { s.v, a * u, s.w + 6 * (s.x - s.y), u + 9 * (s.x - s.y) }
  end, { around(1, "5%"), 0, 0, 0 }, 6 },
  { "model reference adaptation", { "x", "r", "k" }, function(s)
    local e = s.x - s.r
    return { a * s.x + s.k * s.x + 1, -2 * s.r + 1, -e * s.x }
  end, { "0.5", 0, -1 }, 5 },
  { "tank level by a valve", { "h" }, function(s)
    return { "0.5" + (1 - s.h) - "0.4" * a * ambit.sqrt(s.h) }
  end, { around("0.5", "5%") }, 10 },
  { "two tanks", { "h", "j" }, function(s)
    return { 1 - a * ambit.sqrt(s.h), a * ambit.sqrt(s.h) - "0.8" * ambit.sqrt(s.j) }
  end, { "0.5", around("0.5", "5%") }, 10 },
  { "cruise control", { "v", "i" }, function(s)
    return { (2 * (25 - s.v) + "0.5" * s.i) * a / 2 - "0.002" * s.v ^ 2, 25 - s.v }
  end, { around(20, "2%"), 0 }, 20 },
  { "ship's heading", xv, function(s)
    return { s.v, (-s.v - s.v ^ 3 + a * (-s.x - 2 * s.v)) / 5 }
  end, { around(1, "5%"), 0 }, 20 },
  { "aircraft, short period", { "angle", "rate" }, function(s, _, t)
    return { -a * s.angle + s.rate, -5 * s.angle - b * s.rate - 2 * sin(t) }
  end, { 0, 0 }, 8 },
  { "flexible joint", { "q", "w", "m", "n" }, function(s)
    local spring = plant(400) * (s.q - s.m)
    return { s.w, -spring, s.n, spring + 30 * (1 - s.m) - 12 * s.n }
  end, { 0, 0, 0, 0 }, 4 },
  { "stiff actuator", xvi, function(s) return { s.v, s.i - s.v, 2000 * (-3 * s.x - s.v - a * s.i) } end,
    { around(1, "5%"), 0, 0 }, 10 },
  { "unicycle to a line", { "y", "angle" }, function(s)
    return { sin(s.angle), -2 * atan(a * s.y) - 2 * s.angle }
  end, { around(1, "5%"), 0 }, 10 },
  { "predator-like integrator windup", { "x", "i" }, function(s)
    return { tanh(2 * (1 - s.x) + s.i) - "0.5" * s.x * a, 1 - s.x }
  end, { 0, 0 }, 8 },
  { "magnetic bearing", xv, function(s)
    local e = 4 * s.x + s.v / 2
    return { s.v, a * (((1 - e) / (1 - s.x)) ^ 2 - ((1 + e) / (1 + s.x)) ^ 2) }
  end, { around("0.1", "0.05"), 0 }, 6 },
}
