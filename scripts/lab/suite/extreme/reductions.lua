-- suite/extreme/reductions.lua -- models to be reduced within no error, a NaN, or for ever; systems that explode
-- before the end: refused by name, or left as they are.
local refusal = require "ambit.suite.extreme.refusal"

local NAN, INF = 0 / 0, math.huge

local function decay(_, s) return -s.x + "1e-9" * s.x ^ 2 end

local function reduced(fields)
  return function(a)
    local system = a.ode { states = { "x" }, equations = function(s) return { x = (fields.f or decay)(a, s) } end }
    return a.reduce { system, t = fields.t or { 0, 1 }, initial = { x = fields.x or 1 }, outputs = { "x" },
      error = { x = fields.error or "0.1" } }
  end
end

local bad = {
  { "a NaN state", reduced { x = NAN }, "reduce", "initial.x", "NaN" },
  { "an infinite state", reduced { x = INF }, "reduce", "initial.x", "infinite" },
  { "an empty state", reduced { x = "[empty]" }, "reduce", "initial.x", "empty" },
  { "no horizon", reduced { t = { 0, 0 } }, "reduce", "t", "zero" },
  { "NaN as an end", reduced { t = { 0, NAN } }, "reduce", "t[2]", "NaN" },
}
for _, bound in ipairs { 0, -1, NAN, INF, "1e400", "much" } do
  bad[#bad + 1] = { ("an error of %s"):format(bound), reduced { error = bound }, "reduce", "error" }
end
return { refusal.case("bad_reductions", "Bounds, data and horizons of a reduction that are none", bad) }
