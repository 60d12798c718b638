-- suite/extreme/times.lua -- horizons of zero, negative, huge and tiny; instants twice, backwards, between doubles.
local over = require "ambit.suite.extreme.over"
local refusal = require "ambit.suite.extreme.refusal"

local NAN, INF = 0 / 0, math.huge

local function decay(a) return a.ode { states = { "x" }, equations = function(s) return { x = -s.x } end } end

local function at(t)
  return function(a, solver) return a.simulate { decay(a), initial = { x = 1 }, t = t, solver = solver } end
end

local bad = {
  { "no horizon", at { 0, 0 }, "simulate", "t", "zero" },
  { "a horizon as a number of zero", at(0), "simulate", "t", "zero" },
  { "NaN", at { 0, NAN }, "simulate", "t[2]", "finite", "NaN" },
  { "an infinite end", at { 0, INF }, "simulate", "t[2]", "finite", "inf" },
  { "an end that overflows", at { 0, "1e400" }, "simulate", "t[2]", "finite", "1e400" },
  { "an instant twice", at { 0, 0.5, 0.5, 1 }, "simulate", "t", "one way", "0.5" },
  { "instants to and fro", at { 0, 0.5, 0.2, 1 }, "simulate", "t", "one way", "0.2" },
  { "no instants", at {}, "simulate", "t", "expected" },
  { "one instant", at { 1 }, "simulate", "t", "expected" },
  { "a word", at "soon", "simulate", "t", "soon" },
  { "a truth value", at(true), "simulate", "t", "boolean" },
  { "foreign digits", at { 0, "١" }, "simulate", "t[2]", "١" },
  { "an uncertain instant", function(a, solver) return at { 0, a.between(1, 2) }(a, solver) end, "simulate", "t[2]",
    "uncertain" },
  { "a length that overflows", at { -1.7e308, 1.7e308 }, "time span", "too long" },
}

local function case(name, title, fields)
  local t = { name = name, group = "extreme", title = title, source = fields.source or "closed form",
    quick = fields.quick ~= false,
    budget = { cpu = 2 }, over = over.all(), reference = fields.reference,
    expected = fields.expected or { default = "proved", gsl = "computed" }, least = fields.least }
  t.make = function(a)
    local m = { (fields.ode or decay)(a), initial = { x = fields.x or 1 }, t = fields.t, keep = fields.keep }
    for key, value in pairs(fields.options or {}) do m[key] = value end
    return m
  end
  return t
end

local function still(a) return a.ode { states = { "x" }, equations = function(s) return { x = 0 * s.x } end } end
local function turning(a)
  return a.ode { states = { "x" }, equations = function(s, _, t) return { x = -s.x * a.cos(t) } end }
end

local E, INVERSE = "[2.718281828459045235, 2.718281828459045236]", "[0.3678794411714423215, 0.3678794411714423216]"

return {
  refusal.case("bad_times", "Instants that are none", bad, over.each()),
  case("backwards", "From 0 to -1", { t = { 0, -1 }, reference = { t = -1, x = { x = E } }, least = {
    lohner = { digits = 12 } } }),
  case("tenths", "Ten steps of 0.1 s, none of which is a double", {
    t = { 0, 0.1, 0.2, 0.30000000000000004, 0.4, 0.5, 0.6, 0.7, 0.7999999999999999, 0.8999999999999999,
      0.9999999999999999, 1 },
    reference = { t = 1, x = { x = INVERSE } } }),
  case("next_instants", "Instants one unit in the last place apart", { t = { 1, 0x1.0000000000001p0,
    0x1.0000000000002p0 },
    reference = { t = 0x1.0000000000002p0, x = { x = "[0.999999999999999555910, 0.999999999999999555911]" } },
    expected = { default = "proved", ["gsl real"] = "computed" } }),
  case("horizon_tiny", "A horizon of 1e-300 s", { t = { 0, 1e-300 }, reference = { t = 1e-300, x = { x = "1" } } }),
  case("horizon_least", "A horizon of the least number", { t = { 0, 0x1p-1074 },
    reference = { t = 0x1p-1074, x = { x = "1" } } }),
  case("horizon_huge_rest", "Rest for 1e300 s", { ode = still, t = { 0, 1e300 },
    reference = { t = 1e300, x = { x = "1" } },
    expected = { default = "proved", lohner = "unable", taylor_model = "unable", gsl = "computed" } }),
  case("horizon_huge_decay", "Decay for 1e300 s", { t = { 0, 1e300 }, keep = "last", quick = false,
    expected = { default = "unable" } }),
  case("far_away", "Where doubles are 2 s apart", { ode = turning, t = { 1e16, 1e16 + 2 },
    expected = { default = "unable" } }),
  case("farthest", "Where doubles are 1e284 s apart", { ode = turning, t = { 1e300, 1.0000000000000003e300 },
    expected = { default = "unable" } }),
}
