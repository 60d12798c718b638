-- laub_loomis.lua: LALO20, enzymes of Laub and Loomis: seven states, all of them known to +-W only, to t = 20.
-- The fourth stays below a bound; its width at the end is the figure that is compared.
local ambit = require "ambit"
local n = ambit.number

local centre = { "1.2", "1.05", "1.5", "2.4", "1", "0.1", "0.45" }
local enzymes = ambit.ode {
  states = { "x1", "x2", "x3", "x4", "x5", "x6", "x7" },
  equations = function(s)
    return {
      x1 = n "1.4" * s.x3 - n "0.9" * s.x1, x2 = n "2.5" * s.x5 - n "1.5" * s.x2,
      x3 = n "0.6" * s.x7 - n "0.8" * s.x2 * s.x3, x4 = 2 - n "1.3" * s.x3 * s.x4,
      x5 = n "0.7" * s.x1 - s.x4 * s.x5, x6 = n "0.3" * s.x1 - n "3.1" * s.x6,
      x7 = n "1.8" * s.x6 - n "1.5" * s.x2 * s.x7,
    }
  end,
}

local function case(W, bound)
  local initial = {}
  for i, c in ipairs(centre) do initial["x" .. i] = ambit.around(c, W) end
  return {
    problem = "LALO20 W = " .. W, property = ("x4 < %g"):format(bound),
    request = { enzymes, initial = initial, t = { 0, 20 }, solver = "taylor_model" },
    proved = function(run, bounds) return run.status == "complete" and bounds.x4.hi < bound end,
    widths = function(run) return { x4 = run.x.x4:width() } end,
  }
end

return { case("0.01", 4.5), case("0.05", 4.5), case("0.1", 5) }
