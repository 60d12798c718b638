-- suite/extreme/options.lua -- tolerances of 0 and 1e-300, negative, NaN; orders 0, 1 and huge; steps that may not
-- shrink.
local over = require "ambit.suite.extreme.over"
local refusal = require "ambit.suite.extreme.refusal"

local function decay(a) return a.ode { states = { "x" }, equations = function(s) return { x = -s.x } end } end
local function growth(a) return a.ode { states = { "x" }, equations = function(s) return { x = s.x } end } end

local function question(a, solver, options)
  local t = { decay(a), initial = { x = 1 }, t = { 0, 1 }, solver = solver }
  for key, value in pairs(options) do t[key] = value end
  return t
end

local function set(key, value)
  return { ("%s = %s"):format(key, value), function(a, solver) a.simulate(question(a, solver, { [key] = value })) end,
    key }
end

-- Values of an option that no solver takes; a solver that does not know the option names it all the same.
local function refused(key, values)
  local list = {}
  for i, value in ipairs(values) do list[i] = set(key, value) end
  return list
end

local any = { 0 / 0, "1e400", "much", "", {}, { 1, 2 }, { { { 1 } } }, true }

local bad = {}
for _, group in ipairs {
  refused("tolerance", { -1, math.huge, table.unpack(any) }),
  refused("relative", { -1, math.huge, table.unpack(any) }),
  refused("step_max", { 0, -0.0, -1, table.unpack(any) }),
  refused("step_min", { -1, table.unpack(any) }),
  refused("width_max", { -1, table.unpack(any) }),
  refused("order", { -1, 1e9, 2 ^ 31, 2 ^ 53, 1e300, 3.5, 200, table.unpack(any) }),
  refused("nodes", { -1, 1, 21, 2 ^ 53, 4.5, table.unpack(any) }),
  refused("pieces_max", { -1, 2 ^ 53, 1.5, table.unpack(any) }),
  refused("steps_max", { -1, 0, table.unpack(any) }),
  refused("threads", { -1, 0, 257, 2 ^ 31, 2 ^ 53, 1.5, 0 / 0, true }),
  refused("keep", { "some", 1, true }),
  refused("dense", { "yes", 1 }),
} do table.move(group, 1, #group, #bad + 1, bad) end

local INVERSE, E = "[0.3678794411714423215, 0.3678794411714423216]", "[2.718281828459045235, 2.718281828459045236]"

local function list(option, values, solvers)
  local found = {}
  for _, solver in ipairs(solvers) do
    for _, value in ipairs(values) do
      found[#found + 1] = { solver = solver, arithmetic = "interval", options = { [option] = value } }
    end
  end
  return found
end

local function case(name, title, fields)
  return { name = name, group = "extreme", title = title, source = "closed form",
    quick = fields.quick ~= false,
    budget = { cpu = fields.cpu or 5 }, over = fields.over,
    reference = fields.reference or { t = 1, x = { x = INVERSE } },
    expected = fields.expected,
    make = function(a)
      return { (fields.ode or decay)(a), initial = { x = 1 }, t = fields.t or { 0, 1 }, keep = fields.keep }
    end }
end

local four = { "lohner", "taylor_model", "valencia", "stiff" }

-- An enclosure whose error is larger than wanted, because no shorter step is allowed, holds the solution at its end.
local function least_steps()
  local found = {}
  for _, solver in ipairs(four) do
    for _, step in ipairs { 0.005, 0.01, 0.1, 0.5 } do
      found[#found + 1] = { solver = solver, arithmetic = "interval",
        options = { step_min = step, tolerance = 1e-16, [solver == "stiff" and "nodes" or "order"] = 6 } }
    end
  end
  return found
end

local grown = {}
for i, x in ipairs { "[1.10517091807564762, 1.10517091807564763]", "[1.64872127070012814, 1.64872127070012815]", E } do
  grown[i] = { t = ({ 0.1, 0.5, 1 })[i], x = { x = x } }
end
grown[1].x.x = "[1.10517091807564761, 1.10517091807564764]" -- of the double next to 0.1

return {
  refusal.case("bad_options", "Options out of their range", bad, over.each()),
  case("tolerance_none", "Tolerances of 0 and 1e-300", { over = list("tolerance", { 0, -0.0, 1e-300 }, four),
    expected = { default = "proved", stiff = "unable" } }),
  case("tolerance_loose", "The loosest tolerance", { over = list("tolerance", { 1 }, { "lohner", "taylor_model" }),
    expected = { default = "proved" } }),
  case("steps_forced", "Steps that may not be as short as the tolerance needs", { ode = growth, t = { 0, 0.1, 0.5, 1 },
    over = least_steps(), reference = grown,
    expected = { default = "unable", taylor_model = "proved",
      ["lohner interval order=6 step_min=0.005 tolerance=1e-16"] = "proved",
      ["valencia interval order=6 step_min=0.005 tolerance=1e-16"] = "proved",
      ["valencia interval order=6 step_min=0.5 tolerance=1e-16"] = "proved" } }),
  case("step_max_huge", "The longest steps allowed", { over = list("step_max", { 1e300, math.huge }, four),
    expected = { default = "proved" } }),
  case("step_max_tiny", "Steps of at most 1e-300 s", { over = list("step_max", { 1e-300 }, four), keep = "last",
    expected = { default = "unable", stiff = "late" }, cpu = 1, quick = false }),
  case("step_max_short", "Steps of at most 2^-40 s: 10^12 of them", { over = list("step_max", { 0x1p-40 }, four),
    keep = "last", expected = { default = "late" }, cpu = 0.5, quick = false }),
  case("steps_max", "More steps than GSL may take", { keep = "last", over = {
    { solver = "gsl", arithmetic = "real", options = { step_max = 0x1p-40, steps_max = 1000 } },
    { solver = "gsl", arithmetic = "real", options = { step_max = 0.125, steps_max = 1000 } } },
    expected = { ["gsl real step_max=0.125 steps_max=1000"] = "computed", default = "unable" } }),
}
