-- notice.lua -- the check notices what it is there for: a count that grew by a little more than the slack, one that
-- was nothing, a problem without counts; it tells what shrank; and counting the same twice gives the same.
local compare = dofile "tests/work/compare.lua"
local measure = dofile "tests/work/measure.lua"
local problems = dofile "tests/work/problems.lua"

local function expect(what, condition) if not condition then error("not noticed: " .. what) end end

local problem = problems[4]
local found = measure.one(problem.run)
for _, count in ipairs { "steps", "orders", "operations", "coefficients", "tails", "tried", "allocations" } do
  expect("that " .. count .. " are counted", found[count] > 0)
end
expect("memory taken while it runs", found.allocations_run == 0)

local again = measure.one(problem.run)
for _, count in ipairs(measure.counts) do expect("another number of " .. count, again[count] == found[count]) end

local function changed(count, factor)
  local copy = {}
  for key, value in pairs(found) do copy[key] = value end
  copy[count] = math.floor(copy[count] * factor)
  return compare.of("p", copy, found, measure.counts)
end

for _, count in ipairs { "operations", "coefficients", "orders" } do
  local grown, shrunk = changed(count, 1 / 1.02)
  expect("2 % more " .. count, #grown == 1 and #shrunk == 0 and grown[1]:find(count .. " grew from ", 1, true))
  grown, shrunk = changed(count, 1.02)
  expect("2 % less " .. count, #grown == 0 and #shrunk == 1 and shrunk[1]:find(count .. " shrank from ", 1, true))
end
expect("work where there was none", #changed("allocations", 0) == 1)
expect("a problem without counts", #compare.of("p", nil, found, measure.counts) == 1)
expect("that nothing changed", #compare.of("p", found, found, measure.counts) == 0)

-- a longer run is more work
local ambit = require "ambit"
local ode = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x ^ 2 } end }
local function work(t)
  return measure.one(function() ambit.simulate { ode, initial = { x = 1 }, t = { 0, t }, solver = "lohner" } end)
end
local short, long = work(1), work(8)
for _, count in ipairs { "steps", "operations", "orders" } do expect("more " .. count, long[count] > short[count]) end
print "everything was noticed"
