-- Biology: { name, states, rates, initial values, end }; rates within 5 %, counts within 2 %.
local ambit = require "ambit"
local around, exp, tanh = ambit.around, ambit.exp, ambit.tanh
local xy, xyz = { "x", "y" }, { "x", "y", "z" }
local function rate(k) return around(k, "5%") end
local function count(n) return around(n, "2%") end
local r = rate(1)

return {
  { "growth", { "x" }, function(s) return { r * s.x } end, { count(1) }, 3 },
  { "logistic growth", { "x" }, function(s) return { r * s.x * (1 - s.x / 10) } end, { count(1) }, 8 },
  { "Gompertz tumour", { "x" }, function(s) return { -r * s.x * ambit.log(s.x / 10) } end, { count(1) }, 5 },
  { "Allee effect", { "x" }, function(s) return { r * s.x * (s.x - "0.2") * (1 - s.x) } end, { count("0.4") }, 10 },
  { "Lotka-Volterra", xy, function(s) return { s.x * (r - s.y), s.y * (s.x - 1) } end, { count("1.2"), 1 }, 6 },
  { "competition", xy, function(s)
    return { s.x * (1 - s.x - "0.5" * s.y), r * s.y * (1 - s.y - "0.6" * s.x) }
  end, { count("0.1"), count("0.2") }, 12 },
  { "predators that saturate", xy, function(s)
    local eaten = s.x * s.y / (1 + s.x)
    return { s.x * (1 - s.x / 3) - eaten, r * eaten - "0.4" * s.y }
  end, { 1, count(1) }, 8 },
  { "SIR", xyz, function(s)
    local infected, healed = rate(2) * s.x * s.y, "0.5" * s.y
    return { -infected, infected - healed, healed }
  end, { "0.99", count("0.01"), 0 }, 10 },
  { "SEIR", { "s", "e", "i", "r" }, function(s)
    local infected = 3 * s.s * s.i
    return { -infected, infected - r * s.e, r * s.e - "0.5" * s.i, "0.5" * s.i }
  end, { "0.99", 0, count("0.01"), 0 }, 10 },
  { "SIR with births", xyz, function(s)
    local infected = 3 * s.x * s.y
    return { "0.1" - infected - "0.1" * s.x, infected - r * s.y - "0.1" * s.y, r * s.y - "0.1" * s.z }
  end, { "0.9", count("0.1"), 0 }, 15 },
  { "FitzHugh-Nagumo", xy, function(s)
    return { s.x - s.x ^ 3 / 3 - s.y + around("0.5", "1%"), "0.08" * (s.x + "0.7" - "0.8" * s.y) }
  end, { -1, around("-0.5", "1%") }, 20 },
  { "Morris-Lecar gate", xy, function(s)
    local open = (1 + tanh((s.x + "0.01") / "0.15")) / 2
    return { -2 * (s.x + "0.5") - open * (s.x - 1) - 2 * s.y * (s.x + "0.7") + around("0.3", "1%"),
      "0.3" * ((1 + tanh(s.x / "0.145")) / 2 - s.y) }
  end, { "-0.3", "0.1" }, 5 },
  { "toggle switch", xy, function(s)
    return { 2 / (1 + s.y ^ 2) - s.x, rate(2) / (1 + s.x ^ 2) - s.y }
  end, { count("1.5"), "0.5" }, 8 },
  { "repressilator, proteins only", xyz, function(s)
    return { 5 / (1 + s.z ^ 2) - s.x, 5 / (1 + s.x ^ 2) - s.y, rate(5) / (1 + s.y ^ 2) - s.z }
  end, { count(1), 2, 3 }, 6 },
  { "glycolysis by Sel'kov", xy, function(s)
    local made = "0.1" * s.y + s.x ^ 2 * s.y
    return { made - s.x, around("0.6", "1%") - made }
  end, { 1, 1 }, 10 },
  { "two compartments of a drug", xy, function(s)
    return { -r * s.x - "0.5" * s.x + "0.3" * s.y, "0.5" * s.x - "0.3" * s.y }
  end, { count(10), 0 }, 12 },
  { "glucose and insulin", xyz, function(s)
    return { -"0.03" * s.x - s.z * s.x + "2.4", "0.05" * (s.x - 80) - rate("0.2") * s.y,
      -"0.02" * s.z + "2e-5" * s.y }
  end, { count(200), 10, 0 }, 40 },
  { "chemostat", xy, function(s)
    local growth = r * s.y / ("0.3" + s.y) * s.x
    return { growth - "0.4" * s.x, "0.4" * (2 - s.y) - 2 * growth }
  end, { count("0.1"), 2 }, 12 },
  { "virus and cells", xyz, function(s)
    return { 1 - "0.1" * s.x - s.x * s.z, s.x * s.z - "0.5" * s.y, rate(2) * s.y - 3 * s.z }
  end, { 10, 0, count("0.01") }, 6 },
  { "muscle by Hill", xy, function(s)
    return { (1 - s.x / (1 + s.y)) * exp(-s.x), r * (2 - s.x - s.y) }
  end, { 0, count(1) }, 6 },
}
