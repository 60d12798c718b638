-- suite/stiff_kinetics.lua -- stiff problems from chemical kinetics.
--
-- Equations and data: F. Mazzia, C. Magherini, Test Set for Initial Value Problem Solvers (Bari), but for E5 and for
-- Robertson's with alpha = 0.4, which is from ARCH-COMP (category nonlinear, ROBE21 and ROBE25). References: linearly
-- implicit Euler, extrapolated, in quadruple precision with two tolerances; where they part is inside the digits'
-- radius ("1.5?3" is 1.5 +- 0.3). They agree with what is published but for E5 (see there).
local problem = require "ambit.suite.problem"

local bari = "Test Set for Initial Value Problem Solvers (Bari)"
local computed = "; reference: extrapolated linearly implicit Euler in quadruple precision"

local function robertson(k1, k2, k3, t)
  return problem.make("Robertson", 3, function(y, number)
    local slow, fast, back = number(k1) * y[1], number(k2) * y[2] ^ 2, number(k3) * y[2] * y[3]
    return { back - slow, slow - back - fast, fast }
  end, { 1, 0, 0 }, t)
end

local function arch(number, beta, gamma, expected, least, digits)
  return { name = "robe_" .. number, source = "ARCH-COMP, nonlinear, ROBE21 and ROBE25" .. computed,
    title = ("Robertson of ARCH-COMP, case %d: alpha = 0.4, beta = %s, gamma = %s"):format(number, beta, gamma),
    make = robertson("0.4", gamma, beta, 40), expected = expected, least = least,
    reference = { t = 40, x = problem.digits(digits) } }
end

local function hires(y, number)
  local n = number
  local r = 280 * y[6] * y[8]
  return {
    -n "1.71" * y[1] + n "0.43" * y[2] + n "8.32" * y[3] + n "0.0007",
    n "1.71" * y[1] - n "8.75" * y[2],
    -n "10.03" * y[3] + n "0.43" * y[4] + n "0.035" * y[5],
    n "8.32" * y[2] + n "1.71" * y[3] - n "1.12" * y[4],
    -n "1.745" * y[5] + n "0.43" * (y[6] + y[7]),
    -r + n "0.69" * y[4] + n "1.71" * y[5] - n "0.43" * y[6] + n "0.69" * y[7],
    r - n "1.81" * y[7],
    -r + n "1.81" * y[7],
  }
end

local function orego(y, number)
  local s, q, w = number "77.27", number "8.375e-6", number "0.161"
  return { s * (y[2] + y[1] - y[1] * y[2] - q * y[1] ^ 2), (y[3] - (1 + y[1]) * y[2]) / s, w * (y[1] - y[3]) }
end

-- The algebraic sixth equation y6 = Ks y1 y4 is put into the others.
local function akzo(y, number, _, ambit)
  local n, root = number, ambit.sqrt(y[2])
  local y6 = n "115.83" * y[1] * y[4]
  local r1, r2 = n "18.7" * y[1] ^ 4 * root, n "0.58" * y[3] * y[4]
  local r3, r4 = n "0.58" / n "34.4" * y[1] * y[5], n "0.09" * y[1] * y[4] ^ 2
  local r5, inflow = n "0.42" * y6 ^ 2 * root, n "3.3" * (n "0.9" / 737 - y[2])
  return { -2 * r1 + r2 - r3 - r4, -r1 / 2 - r4 - r5 / 2 + inflow, r1 - r2 + r3, -r2 + r3 - 2 * r4, r2 - r3 + r5 }
end

local function e5(y, number)
  local a, b = number "7.89e-10" * y[1], number "1.1e7" * y[1] * y[3]
  local c, d = number "1.13e9" * y[2] * y[3], number "1.13e3" * y[4]
  return { -a - b, a - c, a - b - c + d, b - d }
end

return {
  { name = "robertson", budget = { cpu = 15 }, over = "all", title = "Robertson to t = 40", source = bari .. computed,
    quick = { "stiff", "valencia", "gsl" },
    make = robertson("0.04", 3e7, 1e4, 40),
    expected = { gsl = "computed", valencia = "unable", ["valencia interval"] = "proved", default = "proved" },
    least = { lohner = { digits = 12 }, stiff = { digits = 14 }, taylor_model = { digits = 8 },
      valencia = { t_reached = 5.3 } },
    reference = { t = 40, x = problem.digits { "0.71582706871940505?3", "9.1855347645577639?3e-6",
      "0.28416374574583035?3" } } },
  { name = "robertson_long", budget = { cpu = 20 }, title = "Robertson to t = 1e11", source = bari .. computed,
    make = robertson("0.04", 3e7, 1e4, { 0, 40, 1e11 }),
    expected = { ["gsl real"] = "late", ["gsl real method=msbdf"] = "computed", lohner = "unable",
      taylor_model = "unable", valencia = "unable", default = "proved" },
    least = { stiff = { digits = 13 } },
    reference = { { t = 40, x = problem.digits { "0.71582706871940505?3", "9.1855347645577639?3e-6",
      "0.28416374574583035?3" } },
      { t = 1e11, x = problem.digits { "2.08334014970129?2e-8", "8.33336077033478?2e-14",
        "0.99999997916651517?5" } } } },
  arch(1, 100, 1e3, { gsl = "computed", default = "proved" },
    { lohner = { digits = 11 }, stiff = { digits = 14 }, taylor_model = { digits = 8 }, valencia = { digits = 7 } },
    { "0.31322014675864348?3", "1.7829918412698608?3e-3", "0.68499686140008667?3" }),
  arch(2, 1000, 1e5, { gsl = "computed", valencia = "unable", default = "proved" },
    { lohner = { digits = 11 }, stiff = { digits = 14 }, taylor_model = { digits = 8 }, valencia = { t_reached = 13 } },
    { "0.31346295033633607?3", "1.7806567964631750?3e-4", "0.68635898398401760?3" }),
  arch(3, 1000, 1e7, { gsl = "computed", valencia = "unable", default = "proved" },
    { lohner = { digits = 11 }, stiff = { digits = 14 }, taylor_model = { digits = 8 },
      valencia = { t_reached = 3.7 } },
    { "2.1204101018758595?3e-2", "8.0101564474943176?3e-6", "0.97878788882479391?3" }),
  { name = "hires", budget = { cpu = 15 }, title = "HIRES: eight reactions that answer to light",
    quick = { "stiff", "lohner", "gsl" },
    source = bari .. computed,
    make = problem.make("HIRES", 8, hires, { 1, 0, 0, 0, 0, 0, 0, "0.0057" }, "321.8122"),
    expected = { gsl = "computed", taylor_model = "unable", valencia = "unable", default = "proved" },
    least = { lohner = { digits = 8 }, stiff = { digits = 11 }, taylor_model = { t_reached = 1.3e2 },
      valencia = { t_reached = 65 } },
    reference = { t = 321.8122, x = problem.digits { "7.3713125733256678?3e-4", "1.4424857263161847?3e-4",
      "5.8887297409675750?3e-5", "1.1756513432831491?3e-3", "2.3863561988313305?3e-3", "6.2389682527427958?3e-3",
      "2.8499983951857687?3e-3", "2.8500016048142313?3e-3" } } },
  { name = "orego", title = "OREGO: the Oregonator, one and a fifth of its periods",
    source = bari .. computed, make = problem.make("Oregonator", 3, orego, { 1, 2, 3 }, 360),
    expected = { ["gsl real"] = "late", ["gsl real method=msbdf"] = "computed", lohner = "late",
      taylor_model = "late", default = "proved" },
    least = { stiff = { digits = 13 }, valencia = { digits = 5 } },
    reference = { t = 360, x = problem.digits { "1.0008148703185227?5", "1.2281785215498880?3e3",
      "1.3205549428465083?74e2" } } },
  { name = "akzo", title = "Chemical Akzo Nobel, its algebraic equation put in", quick = true,
    source = bari .. computed,
    make = problem.make("Akzo Nobel", 5, akzo, { "0.444", "0.00123", 0, "0.007", 0 }, 180),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 12 }, stiff = { digits = 11 }, taylor_model = { digits = 10 },
      valencia = { digits = 9 } },
    reference = { t = 180, x = problem.digits { "1.1507949206617022?3e-1", "1.2038314715677151?6e-3",
      "1.6115628874079742?3e-1", "3.6561564212492830?3e-4", "1.7080108852644041?3e-2" } } },
  { name = "e5", budget = { cpu = 20 }, title = "E5: pyrolysis, to t = 1e11, with concentrations down to 1e-65",
    source = "E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, IV.10" .. computed
      .. "; digits published for t = 1e13 differ from it in the third place, its own asymptote 1/(1.13e9 t) does not",
    make = problem.make("E5", 4, e5, { "1.76e-3", 0, 0, 0 }, { 0, 1e5, 1e11 }),
    expected = { ["gsl real"] = "late", ["gsl real method=msbdf"] = "computed", lohner = "unable",
      taylor_model = "unable", valencia = "unable", default = "proved" },
    least = { stiff = { digits = 1 } },
    reference = { { t = 1e5, x = problem.digits { "7.4813208224292220?3e-6", "2.3734781561205975?53e-12",
      "2.2123586689581664?49e-12", "1.6111948716243114?36e-13" } },
      { t = 1e11, x = problem.digits { "3.76930821973897?44e-49", "1.01925825681427?33e-20", "1.01925825681427?33e-20",
        "3.7399012194642?17e-65" } } } },
}
