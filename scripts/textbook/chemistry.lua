-- Reactions: { name, states, rates, initial values, end }; rate constants within 5 %, concentrations within 2 %.
local ambit = require "ambit"
local around, exp = ambit.around, ambit.exp
local ab, abc = { "a", "b" }, { "a", "b", "c" }
local function rate(k) return around(k, "5%") end
local function amount(c) return around(c, "2%") end
local k1, k2 = rate(1), rate("0.5")

return {
  { "first order", { "a" }, function(s) return { -k1 * s.a } end, { amount(1) }, 5 },
  { "second order", { "a" }, function(s) return { -k1 * s.a ^ 2 } end, { amount(1) }, 10 },
  { "A to B to C", abc, function(s) return { -k1 * s.a, k1 * s.a - k2 * s.b, k2 * s.b } end, { amount(1), 0, 0 }, 8 },
  { "reversible", ab, function(s) return { -k1 * s.a + k2 * s.b, k1 * s.a - k2 * s.b } end, { amount(1), 0 }, 10 },
  { "A + B to C", abc, function(s)
    local r = k1 * s.a * s.b
    return { -r, -r, r }
  end, { amount(1), amount(2), 0 }, 5 },
  { "autocatalysis", ab, function(s)
    local r = k1 * s.a * s.b
    return { -r, r }
  end, { 1, amount("0.01") }, 8 },
  { "Michaelis-Menten, full", { "s", "e", "c", "p" }, function(s)
    local bind = 10 * s.s * s.e - s.c
    return { -bind, -bind + k1 * s.c, bind - k1 * s.c, k1 * s.c }
  end, { amount(1), "0.2", 0, 0 }, 10 },
  { "Michaelis-Menten, reduced", { "s" }, function(s) return { -k1 * s.s / (k2 + s.s) } end, { amount(2) }, 4 },
  { "Brusselator", ab, function(s)
    return { 1 + s.a ^ 2 * s.b - "3.5" * s.a, "2.5" * s.a - s.a ^ 2 * s.b }
  end, { around(1, "0.5%"), 1 }, 8 },
  { "Robertson", abc, function(s)
    local x, y, z = "0.04" * s.a, 1e4 * s.b * s.c, 3e7 * s.b ^ 2
    return { y - x, x - y - z, z }
  end, { amount(1), 0, 0 }, 40 },
  { "Oregonator, mild", abc, function(s)
    return { 10 * (s.b + s.a - s.a * s.b - "0.01" * s.a ^ 2), (s.c - s.b - s.a * s.b) / 10, "0.2" * (s.a - s.c) }
  end, { amount(1), 2, 1 }, 5 },
  { "stirred tank, heat of reaction", { "a", "heat" }, function(s)
    local r = s.a * exp(s.heat / (1 + s.heat / 20))
    return { 1 - s.a - "0.1" * r, -s.heat + "0.3" * r - k1 * s.heat }
  end, { amount(1), 0 }, 5 },
  { "batch reactor by Arrhenius", { "a", "T" }, function(s)
    local r = 1e6 * exp(-5000 / s.T) * s.a
    return { -r, 50 * r }
  end, { amount(1), around(300, 1) }, 5 },
  { "chain of five decays", { "x1", "x2", "x3", "x4", "x5" }, function(s)
    return { -k1 * s.x1, k1 * s.x1 - 2 * s.x2, 2 * s.x2 - k2 * s.x3, k2 * s.x3 - 3 * s.x4, 3 * s.x4 }
  end, { amount(1), 0, 0, 0, 0 }, 6 },
  { "parallel and consecutive", abc, function(s)
    return { -(k1 + k2) * s.a, k1 * s.a - 2 * s.b * s.a, k2 * s.a + 2 * s.b * s.a }
  end, { amount(1), 0, 0 }, 5 },
  { "ozone by Chapman", ab, function(s)
    return { 2 - 10 * s.a - s.a * s.b, 10 * s.a - s.a * s.b - k1 * s.b }
  end, { 0, 0 }, 6 },
  { "polymerisation", { "m", "r" }, function(s)
    return { -k1 * s.m * s.r, "0.1" - 2 * s.r ^ 2 }
  end, { amount(1), 0 }, 10 },
  { "stiff pair", ab, function(s) return { -1000 * s.a + 999 * s.b, s.a - 2 * s.b } end, { amount(1), amount(2) }, 10 },
  { "enzyme with inhibitor", abc, function(s)
    local r = k1 * s.a / (1 + s.a + s.c)
    return { -r, r - k2 * s.b, k2 * s.b }
  end, { amount(2), 0, 0 }, 8 },
  { "Schnakenberg", ab, function(s)
    return { "0.2" - s.a + s.a ^ 2 * s.b, rate("1.3") - s.a ^ 2 * s.b }
  end, { 1, 1 }, 6 },
}
