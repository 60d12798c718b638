-- production_destruction.lua: PRDE20, a cascade that moves all of x into z, from (9.98, 0.01, 0.01) to t = 100: with an
-- uncertain start (I), an uncertain rate (P), and both. States stay positive and their sum is kept.
local ambit = require "ambit"
local between = ambit.between

local function case(name, x0, a, sum)
  return {
    problem = "PRDE20 " .. name, property = "x, y, z > 0, sum kept",
    request = {
      ambit.ode { states = { "x", "y", "z" }, equations = function(s)
        local eaten, died = s.x * s.y / (1 + s.x), a * s.y
        return { x = -eaten, y = eaten - died, z = died }
      end },
      initial = { x0, "0.01", "0.01" }, t = { 0, 100 }, solver = "taylor_model", order = 6,
    },
    proved = function(run, bounds)
      local positive = bounds.x.lo > 0 and bounds.y.lo > 0 and bounds.z.lo > 0
      return run.status == "complete" and positive and (run.x.x + run.x.y + run.x.z):contains(ambit.interval(sum))
    end,
    widths = function(run)
      local x = run.x
      return { z = x.z:width(), volume = x.x:width() * x.y:width() * x.z:width() }
    end,
  }
end

local rate = between("0.296", "0.304")
return {
  case("I", between("9.5", 10), ambit.number "0.3", "[9.52, 10.02]"),
  case("P", "9.98", rate, "10"),
  case("I and P", between("9.5", 10), rate, "[9.52, 10.02]"),
}
