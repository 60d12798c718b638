-- robertson.lua: ROBE21, the auto-catalytic reactions of Robertson with alpha = 0.4 and three pairs of rates, to t =
-- 40. Nothing is to be verified: asked for are the width of x + y + z, which is 1 for every solution, and the work.
local ambit = require "ambit"
local bench = require "bench"

local names = { "x", "y", "z" }
local alpha = ambit.number "0.4"

local function case(number, beta, gamma, digits)
  return {
    problem = ("ROBE21 case %d"):format(number), property = "reference inside",
    request = {
      ambit.ode { states = names, equations = function(s)
        local slow, back, fast = alpha * s.x, beta * s.y * s.z, gamma * s.y ^ 2
        return { x = back - slow, y = slow - back - fast, z = fast }
      end },
      initial = { 1, 0, 0 }, t = { 0, 40 }, solver = "stiff",
    },
    proved = function(run) return run.status == "complete" and bench.holds(run.x, names, digits) end,
    widths = function(run) return { ["x + y + z"] = (run.x.x + run.x.y + run.x.z):width() } end,
  }
end

return {
  -- solutions at t = 40 in quadruple precision, by extrapolation of linearly implicit Euler steps
  case(1, 100, 1e3, { "0.3132201467586434769915523", "1.782991841269860817622e-3", "0.6849968614000866621908" }),
  case(2, 1000, 1e5, { "0.3134629503363360649567000", "1.780656796463175039819e-4", "0.6863589839840176175393" }),
  case(3, 1000, 1e7, { "0.02120410101875859453301239", "8.010156447494317594274e-6", "0.9787878888247939111494" }),
}
