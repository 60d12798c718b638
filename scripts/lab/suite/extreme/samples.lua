-- suite/extreme/samples.lua -- draws from data that are none, from functions that are not defined everywhere, of
-- systems that explode: lost draws are counted, the others hold, and no bound is NaN.
local refusal = require "ambit.suite.extreme.refusal"

local NAN, INF, MAX, MIN = 0 / 0, math.huge, 0x1.fffffffffffffp1023, 0x1p-1074

-- -- refused

local function square(a) return a.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end } end

local function sampled(fields)
  return function(a)
    local t = { square(a), initial = { x = fields.x or 1 }, t = fields.t or { 0, 0.5 } }
    for key, value in pairs(fields.options or {}) do t[key] = value end
    return a.sample(t)
  end
end

local bad = {
  { "a NaN state", sampled { x = NAN }, "sample", "initial.x", "NaN" },
  { "an infinite state", sampled { x = INF }, "sample", "initial.x", "infinite" },
  { "an empty state", sampled { x = "[empty]" }, "sample", "initial.x", "empty" },
  { "an unbounded state", sampled { x = "[entire]" }, "sample", "initial.x", "not bounded" },
  { "an unbounded datum", function(a)
    local m = a.mechanism "m"
    local angle = m:orientation(m:revolute { from = m.world, axis = "z", name = "q" })
    return a.sample { angle, at = { q = "[entire]" } }
  end, "sample", "at.q", "not bounded" },
  { "NaN as an end", sampled { t = { 0, NAN } }, "sample", "t[2]", "NaN" },
  { "no horizon", sampled { t = { 0, 0 } }, "sample", "t", "zero" },
}
for _, n in ipairs { 0, -1, 1.5, 1e300, INF, NAN, "many" } do
  bad[#bad + 1] = { ("%s draws"):format(n), sampled { options = { n = n } }, "sample", "n", "positive integer" }
end

-- -- expressions: what is drawn, [lo, hi] that must hold the hull, or nothing where no draw has a value

local images = {
  { "1/x over [-1, 1]", function(a) return 1 / a.between(-1, 1) end, -INF, INF },
  { "sqrt over [-1, 1]", function(a) return a.sqrt(a.between(-1, 1)) end, 0, 1 },
  { "log over [-1, 1]", function(a) return a.log(a.between(-1, 1)) end, -INF, 0 },
  { "sqrt over negative numbers", function(a) return a.sqrt(a.between(-2, -1)) end },
  { "twice the largest numbers", function(a) return 2 * a.between(-MAX, MAX) end, -MAX, MAX },
  { "overflow less overflow", function(a)
    return a.between(1e308, MAX) * 1e10 - a.between(1e308, MAX) * 1e10
  end },
  { "sin of huge angles", function(a) return a.sin(a.between(0, 1e300)) end, -1, 1 },
  { "subnormal numbers", function(a) return a.between(-MIN, 3 * MIN) / 2 end, -MIN, 2 * MIN },
  { "a point", function(a) return a.number(2) ^ 1.5 end, 2.82, 2.83 },
}

local function image_fault(a, entry)
  local r = a.sample { entry[2](a), n = 200 }
  if r.lo ~= r.lo or r.hi ~= r.hi then return "is NaN" end
  if entry[3] == nil then return not r:is_empty() and "has values where there are none" end
  if r:is_empty() then return "has no value" end
  if r.lo < entry[3] or r.hi > entry[4] then return ("leaves [%g, %g]"):format(entry[3], entry[4]) end
end

local function images_run(a)
  for _, entry in ipairs(images) do
    local fault = image_fault(a, entry)
    if fault then return { outcome = "wrong", reason = ("the sample of %s %s"):format(entry[1], fault) } end
  end
  return { outcome = "computed", steps = #images }
end

-- -- systems: all, some or no draws reach the end; what the hull at the last listed time that they reach must be within

local systems = {
  { "x' = x^2 from 1", square, x = 1, t = { 0, 0.5, 2 }, lost = "all", at = 0.5, lo = 1.999999, hi = 2.000001 },
  { "x' = x^2 from [-1, 1]", square, x = { -1, 1 }, t = { 0, 0.5, 2 }, lost = "some", at = 0.5, lo = -0.6666667,
    hi = 2.000001 },
  { "x' = x^2 from the largest number", square, x = MAX, t = { 0, 1 }, lost = "all" },
  { "x' = x^2 backwards", square, x = 1, t = { 0, -1 }, at = -1, lo = 0.499999, hi = 0.500001 },
  { "x' = x^2 from the least number", square, x = MIN, t = { 0, 1 }, at = 1, lo = 0, hi = 2 * MIN },
  { "x' = -sqrt x, to the edge of its domain", function(a)
    return a.ode { states = { "x" }, equations = function(s) return { x = -a.sqrt(s.x) } end }
  end, x = { 0.5, 1 }, t = { 0, 1, 3 }, lost = "all", at = 1, lo = 0, hi = 0.250001 },
  { "x' = 1/x from 0", function(a)
    return a.ode { states = { "x" }, equations = function(s) return { x = 1 / s.x } end }
  end, x = 0, t = { 0, 1 }, lost = "all" },
  { "x' = sqrt |x|, towards where it is not Lipschitz", function(a)
    return a.ode { states = { "x" }, equations = function(s) return { x = a.sqrt(a.abs(s.x)) } end }
  end, x = { -1, 0 }, t = { 0, 1 }, at = 1, lo = -0.250001, hi = 0.250001 },
}

local function count_fault(r, lost)
  if lost == "all" and r.failed ~= r.draws then return "has draws that reach an end which no solution reaches" end
  if lost == "some" and (r.failed == 0 or r.failed == r.draws) then return "loses all draws, or none" end
  if not lost and r.failed ~= 0 then return "loses draws" end
  if lost and not (r.reason or ""):find "t = %-?%d" then return "does not say when draws are lost" end
end

local function hull_fault(r, entry)
  for _, t in ipairs(r.t) do
    local x = r:at(t).x
    if x.lo ~= x.lo or x.hi ~= x.hi then return "has NaN for a bound" end
  end
  if not entry.at then return end
  local x = r:at(entry.at).x
  if x:is_empty() then return "has no draws at a time that they reach" end
  if x.lo < entry.lo or x.hi > entry.hi then return ("is [%.9g, %.9g] at t = %g"):format(x.lo, x.hi, entry.at) end
end

local function systems_run(a)
  for _, entry in ipairs(systems) do
    local x = type(entry.x) == "table" and a.between(entry.x[1], entry.x[2]) or entry.x
    local r = a.sample { entry[2](a), initial = { x = x }, t = entry.t, n = 16 }
    local fault = count_fault(r, entry.lost) or hull_fault(r, entry)
    if fault then return { outcome = "wrong", reason = ("the sample of %s %s"):format(entry[1], fault) } end
  end
  return { outcome = "computed", steps = #systems }
end

local function case(name, title, run)
  return { name = name, group = "extreme", title = title, source = "closed forms", question = "sample", quick = true,
    budget = { cpu = 5 }, over = { {} }, run = run, expected = { default = "computed" } }
end

return {
  refusal.case("bad_samples", "Samples of NaN, infinite and empty data", bad),
  case("sample_images", "Samples of functions over poles and edges of domains", images_run),
  case("sample_motions", "Samples of systems that explode or leave their domain", systems_run),
}
