-- coupled_van_der_pol.lua: CVDP20 and CVDP23, two Van der Pol oscillators on a spring. With coupling 1 and mu = 1 or
-- 2 as in 2020, and with a coupling of which only b in [1, 3] is known as in 2023. The speeds stay below a bound.
local ambit = require "ambit"
local between = ambit.between

local function case(name, mu, b, x, bound, t)
  local function oscillators(s)
    local pull = b * (s.x2 - s.x1)
    return { x1 = s.y1, y1 = mu * (1 - s.x1 ^ 2) * s.y1 + pull - s.x1,
      x2 = s.y2, y2 = mu * (1 - s.x2 ^ 2) * s.y2 - pull - s.x2 }
  end
  local request = { ambit.ode { states = { "x1", "y1", "x2", "y2" }, equations = oscillators },
    initial = { between(x[1], x[2]), between("2.35", "2.45"), between(x[1], x[2]), between("2.35", "2.45") },
    t = { 0, t }, solver = "taylor_model" }
  return {
    problem = name, property = ("y1, y2 < %s"):format(bound), request = request,
    proved = function(run, bounds)
      return run.status == "complete" and bounds.y1.hi < bound and bounds.y2.hi < bound
    end,
    widths = function(run) return { x1 = run.x.x1:width(), y1 = run.x.y1:width() } end,
  }
end

return {
  case("CVDP20 mu = 1", 1, 1, { "1.25", "1.55" }, 2.75, 7),
  case("CVDP20 mu = 2", 2, 1, { "1.55", "1.85" }, 4.05, 8),
  case("CVDP23 b in [1, 3]", 1, between(1, 3), { "1.25", "1.55" }, 2.75, 7),
}
