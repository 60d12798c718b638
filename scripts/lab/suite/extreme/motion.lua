-- suite/extreme/motion.lua -- right-hand sides that explode, are not Lipschitz, jump, are not defined, over- or
-- underflow.
local over = require "ambit.suite.extreme.over"

local function case(name, title, fields)
  return { name = name, group = "extreme", title = title, source = fields.source or "closed form",
    quick = fields.quick ~= false, budget = { cpu = fields.cpu or 5 }, over = over.all(), reference = fields.reference,
    expected = fields.expected, least = fields.least,
    make = function(a)
      return { a.ode { states = fields.states or { "x" }, equations = function(s, _, t) return fields.f(a, s, t) end },
        initial = fields.initial and fields.initial(a) or { x = fields.x }, t = fields.t, keep = fields.keep }
    end }
end

local proved = { default = "proved", gsl = "computed" }
local unable = { default = "unable" }

-- A state that must be inside at t, whatever else is: one of several solutions, as a reference of its own.
local function solutions(name, title, fields)
  local list = {}
  for i, references in ipairs(fields.each) do
    fields.reference = references
    list[i] = case(("%s_%d"):format(name, i), title, fields)
  end
  return list
end

local cases = {
  case("finite_escape", "x' = x^2 from 1 explodes at t = 1", { f = function(_, s) return { x = s.x ^ 2 } end, x = 1,
    t = { 0, 0.5, 0.9, 2 }, expected = unable, least = { default = { t_reached = 0.9 } },
    reference = { { t = 0.5, x = { x = "2" } },
      { t = 0.9, x = { x = "[10.0000000000000022, 10.0000000000000023]" } } } }),
  case("finite_escape_back", "x' = -x^2 from 1, backwards", { f = function(_, s) return { x = -s.x ^ 2 } end, x = 1,
    t = { 0, -0.5, -2 }, expected = unable, least = { default = { t_reached = -2 } },
    reference = { t = -0.5, x = { x = "2" } } }),
  case("escape_of_some", "x' = x^2, only a part of the set explodes", { f = function(_, s) return { x = s.x ^ 2 } end,
    initial = function(a) return { x = a.between(-1, 1) } end, t = { 0, 0.5, 2 }, expected = { default = "unable",
      gsl = "computed" }, reference = { t = 0.5, x = { x = "0" } } }),
  case("exp_exp", "x' = exp(exp x) explodes at t = 0.2193...", {
    f = function(a, s) return { x = a.exp(a.exp(s.x)) } end, x = 0, t = { 0, 1 },
    source = "the exponential integral E1(1)", expected = unable,
    least = { default = { t_reached = 0.2 } } }),
  case("jump", "x' = -sign x by a quotient, into the jump", { f = function(a, s) return { x = -s.x / a.abs(s.x) } end,
    x = 1, t = { 0, 2 }, keep = "last", expected = { default = "unable", stiff = "unable" }, cpu = 20, quick = false,
    least = { default = { t_reached = 0.99 }, stiff = {} } }),
  case("division_through_zero", "y' = 1/x where x passes zero at t = 1", { states = { "x", "y" },
    f = function(_, s) return { x = -1, y = 1 / s.x } end, initial = function() return { x = 1, y = 0 } end,
    t = { 0, 0.5, 2 }, expected = { default = "unable", taylor_model = "late" }, cpu = 4, quick = false,
    least = { default = { t_reached = 0.9 } },
    reference = { t = 0.5, x = { x = "0.5", y = "[0.6931471805599453094, 0.6931471805599453095]" } } }),
  case("undefined", "A right-hand side without a value at the start", {
    f = function(a, s) return { x = a.sqrt(-1 - s.x ^ 2) } end, x = 0, t = { 0, 1 }, expected = unable }),
  case("pole", "x' = 1/x from 0", { f = function(_, s) return { x = 1 / s.x } end, x = 0, t = { 0, 1 },
    expected = unable }),
  case("removable", "x / sin x at 0, where it is not defined", { f = function(a, s) return { x = s.x / a.sin(s.x) } end,
    x = 0, t = { 0, 1 }, expected = unable }),
  case("leaves_domain", "x' = -sqrt x reaches the edge of its domain at t = 2", {
    f = function(a, s) return { x = -a.sqrt(s.x) } end, x = 1, t = { 0, 1, 3 }, expected = unable,
    least = { default = { t_reached = 1 } }, reference = { t = 1, x = { x = "0.25" } } }),
  case("underflow", "Decay to below the least number", { f = function(_, s) return { x = -s.x } end, x = 1,
    t = { 0, 1000 }, expected = proved,
    reference = { t = 1000, x = { x = "[5.0759588975494567e-435, 5.0759588975494568e-435]" } } }),
  case("tiny_start", "From a subnormal number", { f = function(_, s) return { x = -s.x } end, x = 1e-320, t = { 0, 1 },
    expected = proved, reference = { t = 1, x = { x = "[3.67e-321, 3.69e-321]" } } }),
  case("huge_start", "From 1e308", { f = function(_, s) return { x = -s.x } end, x = 1e308, t = { 0, 1 },
    expected = { default = "unable", valencia = "proved" },
    reference = { t = 1, x = { x = "[3.678794411714423e307, 3.678794411714424e307]" } } }),
  case("overflow", "Growth beyond the largest number", { f = function(_, s) return { x = s.x } end, x = 1,
    t = { 0, 100, 1000 }, expected = unable,
    least = { lohner = { t_reached = 100 }, stiff = { t_reached = 100 }, gsl = { t_reached = 700 } },
    reference = { t = 100, x = { x = "[2.688117141816135e43, 2.688117141816136e43]" } } }),
  case("huge_width", "A set of 1e300", { f = function(_, s) return { x = -s.x } end,
    initial = function(a) return { x = a.between(-1e300, 1e300) } end, t = { 0, 1 }, expected = { default = "proved",
      stiff = "unable", gsl = "computed" },
    reference = { t = 1, x = { x = "[-3.678794411714423e299, -3.678794411714422e299]" } } }),
  case("widest", "All numbers as a set", { f = function(_, s) return { x = -s.x } end,
    initial = function(a) return { x = a.between(-1.7e308, 1.7e308) } end, t = { 0, 1 },
    expected = { default = "unable", gsl = "computed" } }),
}

-- x' = sqrt |x| from 0: x = 0, x = t^2 / 4, and all that wait before they leave.
for _, entry in ipairs(solutions("several_solutions", "x' = sqrt |x| from 0 has many solutions", {
  f = function(a, s) return { x = a.sqrt(a.abs(s.x)) } end, x = 0, t = { 0, 0.5, 1 },
  expected = { default = "unable", stiff = "unable", valencia = "proved", gsl = "computed" },
  each = { { { t = 0.5, x = { x = "0" } }, { t = 1, x = { x = "0" } } },
    { { t = 0.5, x = { x = "0.0625" } }, { t = 1, x = { x = "0.25" } } },
    { { t = 0.5, x = { x = "0" } }, { t = 1, x = { x = "0.0625" } } } },
})) do cases[#cases + 1] = entry end

-- from -1 they reach 0 at t = 2, and part there
for _, entry in ipairs(solutions("solutions_part", "x' = sqrt |x| from -1: solutions part at t = 2", {
  f = function(a, s) return { x = a.sqrt(a.abs(s.x)) } end, x = -1, t = { 0, 1, 4 },
  expected = { default = "unable", stiff = "unable", valencia = "proved", gsl = "computed" },
  each = { { { t = 1, x = { x = "-0.25" } }, { t = 4, x = { x = "0" } } },
    { { t = 1, x = { x = "-0.25" } }, { t = 4, x = { x = "1" } } } },
})) do cases[#cases + 1] = entry end

return cases
