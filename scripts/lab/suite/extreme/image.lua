-- suite/extreme/image.lua -- a list of images of sets under functions, asked of one arithmetic:
--
--   { "1/x", function(ambit, x, y) return 1 / x end, x = { -1, 1 }, y = ..., holds = { 1, "-3", "[0.1, 0.2]" },
--     within = { lo, hi }, partial = true, empty = true }
--
-- holds: exact values, or texts of intervals that surely contain one, each of which the enclosure must hold; within:
-- bounds that it may not leave; partial: the set leaves the function's domain, which must be told; empty: there is no
-- value, and that must be told too. Without `partial` the result must be bounded unless `within` is infinite.
local core = require "ambit.core"
local option = require "ambit.option"

local image = {}

local function datum(ambit, range)
  if type(range) == "table" then return ambit.between(range[1], range[2]) end
  return range
end

-- The values of those variables that the function still depends on: x - x is 0 without any.
local function evaluated(ambit, entry, arithmetic)
  local x, y = core.symbol("x", "1"), core.symbol("y", "1")
  local value, at = entry[2](ambit, x, y), {}
  for _, leaf in ipairs(core.leaves { core.expression(value) }) do at[leaf.name] = datum(ambit, entry[leaf.name]) end
  return ambit.evaluate { value, at = at, arithmetic = arithmetic }
end

-- What is untrue about an enclosure, or nil.
local function lie(entry, r)
  if r.lo ~= r.lo or r.hi ~= r.hi then return "has a NaN for a bound" end
  if entry.partial and not r.partial then return "does not say that the domain was left" end
  for _, truth in ipairs(entry.holds or {}) do
    local exact = core.interval(truth)
    if r:intersect(exact):is_empty() or (exact.lo == exact.hi and not r:contains(exact)) then
      return ("misses %s"):format(tostring(truth))
    end
  end
end

-- Why an enclosure is not as tight as it has to be, or nil.
local function looseness(entry, r)
  if entry.empty then
    return not r:is_empty() and "is not empty"
  end
  local lo, hi = -math.huge, math.huge
  if entry.within then lo, hi = entry.within[1], entry.within[2] end
  if r.lo < lo or r.hi > hi then return ("is wider than [%.9g, %.9g]"):format(lo, hi) end
  if not entry.within and not entry.partial and not r:is_bounded() then return "has no bounds" end
end

local function shown(entry, r, problem)
  return ("%s = [%.17g, %.17g] %s; narrow the data in `at`"):format(entry[1], r.lo, r.hi, problem)
end

-- entries -> run of a case
function image.run(entries)
  return function(ambit, _, arithmetic)
    local rigorous = option.declaration("arithmetic", arithmetic).rigorous
    local row = { outcome = rigorous and "proved" or "computed", rigorous = rigorous, steps = #entries }
    for _, entry in ipairs(entries) do
      local r = evaluated(ambit, entry, arithmetic)
      local untrue = rigorous and lie(entry, r) or r.lo ~= r.lo and "is NaN"
      local loose = rigorous and looseness(entry, r)
      if untrue then return { outcome = "wrong", reason = shown(entry, r, untrue), rigorous = rigorous } end
      if loose then row.outcome, row.reason = "unable", shown(entry, r, loose) end
    end
    return row
  end
end

-- A case: name, title, entries
function image.case(name, title, entries)
  return { name = name, group = "extreme", title = title, source = "closed forms, and MPFR where digits are given",
    question = "evaluate", quick = true, budget = { cpu = 5 }, run = image.run(entries),
    expected = { default = "proved", real = "computed" } }
end

return image
