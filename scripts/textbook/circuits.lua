-- Circuits: { name, states, rates, initial values, end }; R and L within 5 %, C within 5 %, diodes exponential.
local ambit = require "ambit"
local around, sin, cos, exp, tanh = ambit.around, ambit.sin, ambit.cos, ambit.exp, ambit.tanh
local R, L, C = around(100, "5%"), around("0.01", "5%"), around("1e-6", "5%")
local vi = { "v", "i" }

local function ladder(n)
  local states, initial = {}, {}
  for i = 1, n do states[i], initial[i] = "v" .. i, 0 end
  return states, function(s)
    local rate = {}
    for i = 1, n do
      local before = i == 1 and 5 or s["v" .. i - 1]
      local after = i < n and s["v" .. i + 1] or s["v" .. i]
      rate[i] = (before - 2 * s["v" .. i] + after) / (R * C)
    end
    return rate
  end, initial
end
local states5, rates5, rest5 = ladder(5)

return {
  { "RC charging", { "v" }, function(s) return { (5 - s.v) / (R * C) } end, { 0 }, "5e-4" },
  { "RC discharging from +-5 V", { "v" }, function(s) return { -s.v / (R * C) } end, { around(0, 5) }, "5e-4" },
  { "RL switched on", { "i" }, function(s) return { (12 - 10 * s.i) / L } end, { 0 }, "5e-3" },
  { "RLC in series", vi, function(s) return { s.i / C, (10 - R * s.i - s.v) / L } end, { 0, 0 }, "2e-3" },
  { "RLC from a box", vi, function(s) return { s.i / "1e-6", (-100 * s.i - s.v) / "0.01" } end,
    { around(0, 10), around(0, "0.1") }, "2e-3" },
  { "RLC driven near resonance", vi, function(s, _, t)
    return { s.i / C, (sin(9000 * t) - 20 * s.i - s.v) / L }
  end, { 0, 0 }, "3e-3" },
  { "low-pass of second order", { "a", "b" }, function(s, _, t)
    return { (sin(2000 * t) - s.a) / (R * C) - (s.a - s.b) / (R * C), (s.a - s.b) / (R * C) }
  end, { 0, 0 }, "5e-3" },
  { "ladder of five", states5, rates5, rest5, "2e-3" },
  { "half-wave rectifier", { "v" }, function(s, _, t)
    return { ("1e-9" * (exp((5 * sin(314 * t) - s.v) / "0.5") - 1) - s.v / 1000) / "1e-4" }
  end, { 0 }, "0.02" },
  { "clipping diodes", { "v" }, function(s, _, t)
    return { ((3 * sin(2000 * t) - s.v) / R - "1e-4" * ambit.sinh(s.v / "0.2")) / C }
  end, { 0 }, "5e-3" },
  { "van der Pol's triode", vi, function(s)
    return { s.i, around(1, "2%") * (1 - s.v ^ 2) * s.i - s.v }
  end, { 2, 0 }, 6 },
  { "tunnel diode", vi, function(s)
    return { (-("17.76" * s.v - "103.79" * s.v ^ 2 + "229.62" * s.v ^ 3 - "226.31" * s.v ^ 4 + "83.72" * s.v ^ 5)
      + s.i) / 2, (-s.v - "1.5" * s.i + around("1.2", "1%")) / 5 }
  end, { "0.1", "0.5" }, 10 },
  { "Chua's circuit, smooth", { "x", "y", "z" }, function(s)
    return { 10 * (s.y - s.x ^ 3 / 16 + s.x / 6), s.x - s.y + s.z, -"14.3" * s.y }
  end, { around("0.1", "0.1%"), 0, 0 }, 4 },
  { "Colpitts oscillator", { "a", "b", "c" }, function(s)
    return { s.c - 6 * (exp(-s.b) - 1), s.c, -(s.a + s.b) - "0.7" * s.c }
  end, { around("0.1", "1%"), 0, 0 }, 3 },
  { "phase-locked loop", { "phase", "v" }, function(s)
    return { around(2, "5%") - s.v, 5 * (4 * sin(s.phase) - s.v) }
  end, { around("0.5", "5%"), 0 }, 5 },
  { "Josephson junction", { "phase", "rate" }, function(s)
    return { s.rate, around("0.8", "2%") - sin(s.phase) - "0.5" * s.rate }
  end, { 0, 0 }, 10 },
  { "transformer", { "i", "j" }, function(s, _, t)
    local a, b = sin(314 * t) - s.i, -around(2, "5%") * s.j
    return { (2 * a - b) * 10, (2 * b - a) * 10 }
  end, { 0, 0 }, "0.1" },
  { "amplifier that saturates", { "v" }, function(s, _, t) return { 1000 * (tanh(10 * sin(200 * t) - s.v) - s.v) } end,
    { around(0, "0.1") }, "0.05" },
  { "stiff supply filter", { "a", "b" }, function(s, _, t)
    return { 1e6 * (5 + "0.1" * sin(6000 * t) - s.a) - 1e5 * (s.a - s.b), 100 * (s.a - s.b) }
  end, { 0, 0 }, "0.05" },
  { "buck converter, averaged", vi, function(s)
    return { (s.i - s.v / around(10, "5%")) / "1e-4", (24 * "0.5" - s.v - "0.1" * s.i) / "1e-3" }
  end, { 0, 0 }, "0.01" },
}
