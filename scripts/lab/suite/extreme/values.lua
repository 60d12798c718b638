-- suite/extreme/values.lua -- zeros of both signs, the least and the largest numbers, poles, edges of domains, cuts: in
-- every arithmetic. Ends of images are closed forms; digits are from MPFR with 6000 bits.
local image = require "ambit.suite.extreme.image"

local MAX, MIN, INF = 0x1.fffffffffffffp1023, 0x1p-1074, math.huge

local function reciprocal(_, x) return 1 / x end
local function sine(a, x) return a.sin(x) end
local function tangent(a, x) return a.tan(x) end
local function root(a, x) return a.sqrt(x) end
local function logarithm(a, x) return a.log(x) end
local function exponential(a, x) return a.exp(x) end
local function angle(a, x, y) return a.atan2(y, x) end
local function square(_, x) return x ^ 2 end
local function product(_, x, y) return x * y end
local function power(a, x, y) return a.pow(x, y) end

local zeros = {
  { "1/x at 0", reciprocal, x = 0, partial = true, empty = true },
  { "1/x at -0", reciprocal, x = -0.0, partial = true, empty = true },
  { "1/x over [0, 1]", reciprocal, x = { 0, 1 }, partial = true, holds = { 1, 1e300 } },
  { "1/x over [-0, 1]", reciprocal, x = { -0.0, 1 }, partial = true, holds = { 1, 1e300 } },
  { "1/x over [-1, 0]", reciprocal, x = { -1, 0 }, partial = true, holds = { -1, -1e300 } },
  { "x / x at 0", function(_, x, y) return x / y end, x = 0, y = 0, partial = true, empty = true },
  { "x / |x| over [-1, 1]", function(a, x) return x / a.abs(x) end, x = { -1, 1 }, partial = true, holds = { -1, 1 } },
  { "x y, zero times the largest", product, x = { -0.0, 0 }, y = { -MAX, MAX }, holds = { 0 }, within = { 0, 0 } },
  { "sqrt at -0", root, x = -0.0, holds = { 0 }, within = { 0, 0 } },
  { "log at 0", logarithm, x = 0, partial = true, empty = true },
  { "atan2 at the origin", angle, x = 0, y = 0, partial = true, empty = true },
  { "sin x / x about 0", function(a, x) return a.sin(x) / x end, x = { -0.5, 0.5 }, partial = true, holds = { 0.99 } },
}

local least = {
  { "x^2 at the least number", square, x = MIN, holds = { "0" }, within = { 0, MIN } },
  { "x^2 over subnormal numbers", square, x = { -MIN, 3 * MIN }, holds = { 0 }, within = { 0, MIN } },
  { "x / 2 at the least number", function(_, x) return x / 2 end, x = MIN, within = { 0, MIN } },
  { "sqrt of the least number", root, x = MIN,
    holds = { "[2.222758749485077483443e-162, 2.222758749485077483444e-162]" }, within = { 2e-162, 3e-162 } },
  { "log of the least number", logarithm, x = MIN, holds = { "[-744.4400719213812623142, -744.4400719213812623140]" },
    within = { -745, -744 } },
  { "exp where it is subnormal", exponential, x = -745,
    holds = { "[2.822350730471937076353e-324, 2.822350730471937076354e-324]" }, within = { 0, 2 * MIN } },
  { "exp where it vanishes", exponential, x = { -1e300, -800 }, holds = { "[1e-350, 1e-340]" }, within = { 0, MIN } },
  { "sin over subnormal numbers", sine, x = { -3 * MIN, 2 * MIN }, holds = { 0, MIN }, within = { -4 * MIN, 3 * MIN } },
  { "1/x at a subnormal number", reciprocal, x = MIN, holds = { MAX }, within = { MAX, INF } },
  { "x - y over subnormal numbers", function(_, x, y) return x - y end, x = { 0, 5 * MIN }, y = { MIN, 2 * MIN },
    holds = { -2 * MIN, 4 * MIN }, within = { -2 * MIN, 4 * MIN } },
}

local largest = {
  { "x^2 at the largest number", square, x = MAX, holds = { MAX }, within = { MAX, INF } },
  { "x^2 over all numbers", square, x = { -MAX, MAX }, holds = { 0, MAX }, within = { 0, INF } },
  { "x + x at the largest number", function(_, x) return x + x end, x = MAX, holds = { MAX }, within = { MAX, INF } },
  { "x + y - x over the largest numbers", function(_, x, y) return x + y - x end, x = { 0, MAX }, y = { 0, MAX },
    holds = { 0, 1, MAX }, within = { -INF, INF } },
  { "x - x over all numbers", function(_, x) return x - x end, x = { -MAX, MAX }, holds = { 0 }, within = { -INF,
    INF } },
  { "x y of opposite signs", product, x = { 1e200, 2e200 }, y = { -2e200, -1e200 }, holds = { -MAX },
    within = { -INF, -1e308 } },
  { "exp over its edge", exponential, x = { 709, 710 },
    holds = { "[8.218407461554972e307, 8.218407461554973e307]", MAX }, within = { 8e307, INF } },
  { "exp of the largest number", exponential, x = MAX, holds = { MAX }, within = { MAX, INF } },
  { "sinh over its edge", function(a, x) return a.sinh(x) end, x = 710,
    holds = { "[1.116997383080855515e308, 1.116997383080855516e308]" }, within = { 1e308, 1.2e308 } },
  { "tanh of the largest number", function(a, x) return a.tanh(x) end, x = { -MAX, MAX }, holds = { -1, 0, 1 },
    within = { -1, 1 } },
  { "atan of the largest number", function(a, x) return a.atan(x) end, x = MAX,
    holds = { "[1.570796326794896619231, 1.570796326794896619232]" }, within = { 1.57, 1.5708 } },
  { "log of the largest number", logarithm, x = MAX, holds = { "[709.7827128933839967321, 709.7827128933839967323]" },
    within = { 709, 710 } },
  { "(x y) / y through the overflow", function(_, x, y) return (x * y) / y end, x = { 1e200, 2e200 },
    y = { 1e200, 2e200 }, holds = { 1e200, 2e200 }, within = { -INF, INF } },
}

local periodic = {
  { "sin 1e300", sine, x = 1e300, holds = { "[-0.8178819121159085970460, -0.8178819121159085970458]" },
    within = { -0.8178819121159090, -0.8178819121159080 } },
  { "sin over [0, 1e300]", sine, x = { 0, 1e300 }, holds = { -1, 0, 1 }, within = { -1, 1 } },
  { "cos of the largest number", function(a, x) return a.cos(x) end, x = MAX,
    holds = { "[-0.9999876894265599374650, -0.9999876894265599374648]" }, within = { -0.99999, -0.99998 } },
  { "tan of the largest number", tangent, x = MAX,
    holds = { "[-0.004962015874444894900502, -0.004962015874444894900500]" }, within = { -0.00497, -0.00496 } },
  { "tan over pi/2", tangent, x = { 1, 2 }, partial = true, holds = { 1.5574, 1e10, -1e10, -2.1851 } },
  { "tan over all numbers", tangent, x = { -MAX, MAX }, partial = true, holds = { -1e10, 0, 1e10 } },
}

local poles = {
  { "1/x over [-1, 1]", reciprocal, x = { -1, 1 }, partial = true, holds = { -1, 1, -1e300, 1e300 } },
  { "1/(x y) over [-1, 1]^2", function(_, x, y) return 1 / (x * y) end, x = { -1, 1 }, y = { -1, 1 }, partial = true,
    holds = { -1, 1, -1e300, 1e300 } },
  { "x^-2 over [-1, 2]", function(_, x) return x ^ -2 end, x = { -1, 2 }, partial = true, holds = { 0.25, 1, 1e300 },
    within = { 0.2499, INF } },
  { "sqrt over [-1, 1]", root, x = { -1, 1 }, partial = true, holds = { 0, 1 }, within = { -0.5, 1.5 } },
  { "log over [-1, 1]", logarithm, x = { -1, 1 }, partial = true, holds = { 0, -1, -700 }, within = { -INF, 1 } },
  { "sqrt over negative numbers", root, x = { -2, -1 }, partial = true, empty = true },
  { "log over negative numbers", logarithm, x = { -MAX, -MIN }, partial = true, empty = true },
  { "acos over [0.5, 2]", function(a, x) return a.acos(x) end, x = { 0.5, 2 }, partial = true, holds = { 0, 1 },
    within = { -1, 1.6 } },
  { "asin at 2", function(a, x) return a.asin(x) end, x = 2, partial = true, empty = true },
  { "what follows from no value", function(a, x) return a.min(a.sqrt(x) * 0 + 3, 4) end, x = { -2, -1 },
    partial = true, empty = true },
}

local powers = {
  { "0^0", function(_, x) return x ^ 0 end, x = 0, holds = { 1 }, within = { 1, 1 } },
  { "0^-1", function(_, x) return x ^ -1 end, x = 0, partial = true, empty = true },
  { "(-2)^3", function(_, x) return x ^ 3 end, x = -2, holds = { -8 }, within = { -8, -8 } },
  { "x^3 over [-2, 1]", function(_, x) return x ^ 3 end, x = { -2, 1 }, holds = { -8, 0, 1 }, within = { -17, 8 } },
  { "0^(1/2)", function(_, x) return x ^ 0.5 end, x = 0, holds = { 0 }, within = { 0, 0 } },
  { "x^(3/2) over [0, 4]", function(_, x) return x ^ 1.5 end, x = { 0, 4 }, holds = { 0, 8 }, within = { -1, 9 } },
  { "x^(3/2) over [-1, 4]", function(_, x) return x ^ "1.5" end, x = { -1, 4 }, partial = true, holds = { 0, 8 } },
  { "(-8)^(1/3)", function(a, x) return x ^ (a.number(1) / 3) end, x = -8, partial = true, empty = true },
  { "x^y over [0, 2]^[0, 3]", power, x = { 0, 2 }, y = { 0, 3 }, partial = true, holds = { 0.5, 1, 8 } },
  { "x^y over negative bases", power, x = { -2, -1 }, y = { 0.5, 1.5 }, partial = true, empty = true },
  { "x^1000000000 about 1", function(_, x) return x ^ 1000000000 end, x = { 0.5, 2 }, holds = { 0, 1, MAX },
    within = { 0, INF } },
}

local cuts = {
  { "atan2(0, -1)", angle, x = -1, y = 0, holds = { "[3.14159265358979323, 3.14159265358979324]" } },
  { "atan2(-0, -1)", angle, x = -1, y = -0.0, holds = { "[3.14159265358979323, 3.14159265358979324]" } },
  { "atan2 over its cut", angle, x = { -2, -1 }, y = { -1, 1 },
    holds = { "3.1", "-3.1", "[3.14159265358979323, 3.14159265358979324]" }, within = { -3.2, 3.2 } },
  { "atan2 below its cut", angle, x = { -2, -1 }, y = { -1, -MIN }, holds = { "-3.1", "-2.7" }, within = { -3.2,
    -2.3 } },
  { "atan2 about the origin", angle, x = { -1, 1 }, y = { -1, 1 }, partial = true, holds = { -3, -1, 0, 1, 3 },
    within = { -3.2, 3.2 } },
  { "atan2 of the largest and least", angle, x = { MIN, MAX }, y = { MIN, MAX }, holds = { "1e-300", 1, "1.57" },
    within = { -0.1, 1.6 } },
  { "|x| over its kink", function(a, x) return a.abs(x) end, x = { -MAX, MIN }, holds = { 0, 1, MAX },
    within = { -MAX, INF } },
  { "max over a tie", function(a, x, y) return a.max(x, y) end, x = { -1, 0 }, y = { -0.0, 0 }, holds = { 0 },
    within = { -1, 1 } },
}

return {
  image.case("zeros", "Zeros of both signs", zeros),
  image.case("least_numbers", "Subnormal numbers and underflow", least),
  image.case("largest_numbers", "The largest numbers and overflow", largest),
  image.case("huge_angles", "sin, cos and tan of huge angles", periodic),
  image.case("poles", "Boxes over poles and edges of domains", poles),
  image.case("powers", "Powers of zero and of negative bases", powers),
  image.case("cuts", "Over the cut of atan2, and kinks", cuts),
}
