-- suite/extreme/roots.lua -- boxes that are empty, infinite, huge, points; equations that are nowhere defined, or flat.
local refusal = require "ambit.suite.extreme.refusal"

local NAN, INF, MAX = 0 / 0, math.huge, 0x1.fffffffffffffp1023

local function parabola(_, s) return s.x ^ 2 - 2 end

local function find(a, fields)
  local t = { function(s) return { fields.f(a, s) } end, box = { x = fields.box } }
  for key, value in pairs(fields.options or {}) do t[key] = value end
  return a.roots(t)
end

local function asked(fields)
  fields.f = fields.f or parabola
  return function(a) find(a, fields) end
end

local bad = {
  { "an empty box", asked { box = { 1, -1 } }, "roots", "box.x", "empty" },
  { "the empty set", asked { box = "[empty]" }, "box", "`x`", "empty" },
  { "NaN", asked { box = { NAN, 1 } }, "roots", "box.x", "NaN" },
  { "no box", function(a) a.roots { function(s) return { s.x } end } end, "roots", "box" },
  { "a variable that is nowhere", function(a)
    a.roots { function(s) return { s.x } end, box = { x = { 0, 1 }, y = { 0, 1 } } }
  end, "roots", "box", "`y`" },
  { "a tolerance below zero", asked { box = { 0, 2 }, options = { tolerance = -1 } }, "tolerance", "[0, 1)" },
  { "10^15 boxes", asked { box = { 0, 2 }, options = { boxes_max = 1e15 } }, "boxes_max", "4e+09" },
  { "10^15 roots", asked { box = { 0, 2 }, options = { roots_max = 1e15 } }, "roots_max", "1e+06" },
  { "a kink", asked { f = function(a, s) return a.abs(s.x) - 1 end, box = { -2, 2 } }, "equation 1", "derivative" },
}

local outcome_of = { complete = "proved", unable = "unable", stopped = "late", broken = "wrong" }

-- A point that holds the truth, among these.
local function holds(a, points, truth)
  for _, point in ipairs(points) do
    if not point.x:intersect(a.interval(truth)):is_empty() then return true end
  end
  return false
end

-- fields.truth: texts that hold a root each; they are all roots if it ends "proved".
local function run(fields)
  return function(a)
    local rest = find(a, fields)
    local row = { outcome = outcome_of[rest.status], reason = rest.reason ~= "" and rest.reason or nil,
      steps = #rest.proved, rigorous = true }
    for _, truth in ipairs(fields.truth) do
      if not holds(a, rest.proved, truth) and not holds(a, rest.undecided, truth) then
        return { outcome = "wrong", reason = ("the root %s is lost"):format(truth) }
      end
    end
    if row.outcome == "proved" and #rest.proved ~= #fields.truth then
      return { outcome = "wrong", reason = ("%d roots are proved, there are %d"):format(#rest.proved, #fields.truth) }
    end
    return row
  end
end

local function case(name, title, fields)
  fields.f = fields.f or parabola
  return { name = name, group = "extreme", title = title, source = "closed form", question = "roots", quick = true,
    budget = { cpu = 5 }, over = { { solver = "krawczyk" } }, run = run(fields),
    expected = { default = fields.expected or "proved" } }
end

local ROOTS = { "[1.414213562373095048, 1.414213562373095049]", "[-1.414213562373095049, -1.414213562373095048]" }

return {
  refusal.case("bad_boxes", "Boxes and bounds that are none", bad),
  case("box_of_all_reals", "All real numbers", { box = { -INF, INF }, truth = ROOTS }),
  case("box_of_all_numbers", "From the least to the largest number", { box = { -MAX, MAX }, truth = ROOTS }),
  case("box_of_a_point", "A single point", { box = { 1, 1 }, truth = {} }),
  case("box_of_subnormals", "A root at 1e-310", { f = function(_, s) return s.x - 1e-310 end, box = { -1e-300, 1e-300 },
    truth = { "1e-310" } }),
  case("equation_undefined", "Nowhere defined", { f = function(a, s) return a.sqrt(-1 - s.x ^ 2) end, box = { 0, 1 },
    truth = {} }),
  case("equation_with_pole", "1/x has no root", { f = function(_, s) return 1 / s.x end, box = { -1, 1 }, truth = {} }),
  case("equation_overflows", "exp(exp x) = 2 over +-1000", { f = function(a, s) return a.exp(a.exp(s.x)) - 2 end,
    box = { -1000, 1000 }, truth = { "[-0.366512920581664328, -0.366512920581664326]" } }),
  case("equation_at_edge", "sqrt x = 1 over [-5, 5]", { f = function(a, s) return a.sqrt(s.x) - 1 end, box = { -5, 5 },
    truth = { "1" } }),
  case("root_at_edge", "sqrt x = 0, at the edge of the domain", { f = function(a, s) return a.sqrt(s.x) end,
    box = { -5, 5 }, truth = { "0" }, expected = "unable" }),
  case("root_twofold", "x^2 = 0", { f = function(_, s) return s.x ^ 2 end, box = { -1, 1 }, truth = { "0" },
    expected = "unable" }),
  case("root_threefold", "x^3 = 0 with boxes down to 1e-300", { f = function(_, s) return s.x ^ 3 end, box = { -1, 1 },
    truth = { "0" }, options = { tolerance = 1e-300 }, expected = "unable" }),
  case("roots_too_many", "sin x = 0 over [0, 1e300]", { f = function(a, s) return a.sin(s.x) end, box = { 0, 1e300 },
    truth = { "0", "[3.14159265358979, 3.14159265358980]" }, expected = "unable" }),
}
