-- dropped_in.lua -- ambit run tests/lua/dropped_in.lua: a copy of a shipped solver under another name, with a rule of
-- its own, is chosen, compared, and certified and differentiated with like the shipped one (tests/lua/dropped.cmake).
local ambit = require "ambit"

local MADE_OF, NAME = "lohner", "dropped"

local function decay(rest)
  return ambit.ode { "decay", states = { "x", "y" }, parameters = { k = ambit.around(1, "1%") },
    equations = function(s, p) return { x = -p.k * s.x + rest * s.y ^ 2, y = -2 * s.y } end }
end
local start, whole = { x = ambit.around(1, "1%"), y = "0.5" }, decay "0.01"

local function same(a, b, what)
  assert(a.lo == b.lo and a.hi == b.hi, ("%s: %s and %s"):format(what, tostring(a), tostring(b)))
end

local chosen = ambit.simulate { whole, initial = start, t = { 0, 1 } }
local named = ambit.simulate { whole, initial = start, t = { 0, 1 }, solver = MADE_OF }
assert(chosen.solver == NAME, chosen.solver)
same(chosen.x.x, named.x.x, "simulate")

local slope = ambit.sensitivity { whole, initial = start, t = { 0, 1 } }
assert(slope.run.solver == NAME, slope.run.solver)

local proof = ambit.certify { whole, decay "0", initial = start, t = { 0, 1 }, outputs = { "x" } }
local shipped = ambit.certify { whole, decay "0", initial = start, t = { 0, 1 }, outputs = { "x" }, solver = MADE_OF }
assert(proof.settings.solver == NAME, proof.settings.solver)
assert(proof.error.x == shipped.error.x, ("%.17g and %.17g"):format(proof.error.x, shipped.error.x))

local rows = ambit.compare { whole, initial = start, t = { 0, 1 }, arithmetics = { "interval" }, repeats = 1, n = 10 }.rows
local labels = {}
for _, row in ipairs(rows) do
  if row.solver == NAME then labels[row.label] = row end
end
local seen = 0
for _, row in ipairs(rows) do
  if row.solver == MADE_OF then
    seen = seen + 1
    local twin = assert(labels[(row.label:gsub(MADE_OF, NAME))], row.label)
    same(row.values.x, twin.values.x, row.label)
  end
end
assert(seen == 8, seen) -- the orders and tolerances that the solver declares

local good, why = pcall(ambit.simulate, { whole, initial = start, t = { 0, 1 }, solver = "stiff",
  arithmetic = "affine" })
assert(not good and tostring(why):find("always computes in `interval`, so that another one would have no effect", 1, true), why)
print "dropped in, and treated as shipped"
