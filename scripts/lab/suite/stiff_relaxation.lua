-- suite/stiff_relaxation.lua -- fast relaxation towards slow motion: Van der Pol, and problems with exact solutions.
local problem = require "ambit.suite.problem"

local bari = "Test Set for Initial Value Problem Solvers (Bari)"
local computed = "; reference: extrapolated linearly implicit Euler in quadruple precision"

local function van_der_pol(mu, t)
  return problem.make("Van der Pol", 2, function(y)
    return { y[2], mu * (1 - y[1] ^ 2) * y[2] - y[1] }
  end, { 2, 0 }, t)
end

-- The same in the time of the slow motion.
local function relaxed(y, number) return { y[2], ((1 - y[1] ^ 2) * y[2] - y[1]) / number "1e-6" } end

local function linear(y, _, t, ambit) return { -1000 * (y[1] - ambit.cos(t)) } end

-- y1 = e^(-2t), y2 = e^(-t) whatever the stiffness 1/eps is (P. Kaps)
local function kaps(y) return { -(1e6 + 2) * y[1] + 1e6 * y[2] ^ 2, y[1] - y[2] - y[2] ^ 2 } end

return {
  { name = "vdpol_mu", title = "Van der Pol, mu = 1000, to t = 2000", source = bari .. computed,
    make = van_der_pol(1000, 2000),
    expected = { gsl = "computed", lohner = "late", taylor_model = "late", valencia = "unable", default = "proved"
      },
    least = { stiff = { digits = 14 }, valencia = { t_reached = 93 } },
    reference = { t = 2000, x = problem.digits { "1.7061677321704650?3", "-8.9280970102481655?3e-4" } } },
  { name = "vdpol", budget = { cpu = 8 }, title = "Van der Pol, eps = 1e-6, to t = 2", source = bari .. computed,
    quick = { "stiff" }, make = problem.make("Van der Pol", 2, relaxed, { 2, 0 }, 2),
    expected = { gsl = "computed", lohner = "late",
      taylor_model = "late", valencia = "unable", default = "proved" },
    least = { stiff = { digits = 14 }, valencia = { t_reached = 0.029 } },
    reference = { t = 2, x = problem.digits { "1.7061677321704650?3", "-0.89280970102481655?5" } } },
  { name = "linear", over = "all", title = "y' = -1000 (y - cos t), y(0) = 0, to t = 20", quick = true,
    source = "exact: (1e6 cos t + 1e3 sin t - 1e6 e^(-1000 t)) / (1e6 + 1)",
    make = problem.make("linear", 1, linear, { 0 }, 20),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 13 }, stiff = { digits = 13 }, taylor_model = { digits = 11 },
      valencia = { digits = 9 } },
    reference = { t = 20, x = { y1 = "0.40899459806952154420?5" } } },
  { name = "linear_long", budget = { cpu = 12 }, title = "y' = -1000 (y - cos t), y(0) = 0, to t = 2000",
    source = "exact: (1e6 cos t + 1e3 sin t - 1e6 e^(-1000 t)) / (1e6 + 1)",
    make = problem.make("linear", 1, linear, { 0 }, 2000),
    expected = { gsl = "computed", taylor_model = "late", default = "proved" },
    least = { lohner = { digits = 13 }, stiff = { digits = 11 }, valencia = { digits = 7 } },
    reference = { t = 2000, x = { y1 = "-0.36652914306727212550?5" } } },
  { name = "kaps", budget = { cpu = 10 }, over = "all", title = "Kaps, eps = 1e-6, on its slow manifold, to t = 1",
    quick = { "stiff", "valencia" },
    source = "P. Kaps, see Dekker and Verwer 1984; exact: e^(-2t), e^(-t)",
    make = problem.make("Kaps", 2, kaps, { 1, 1 }, 1),
    expected = { gsl = "computed", taylor_model = "late", valencia = "unable",
      ["valencia interval"] = "proved", default = "proved" },
    least = { lohner = { digits = 13 }, stiff = { digits = 14 }, valencia = { t_reached = 0.064 } },
    reference = { t = 1, x = problem.digits { "0.1353352832366126919?2", "0.3678794411714423216?2" } } },
}
