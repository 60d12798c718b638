-- suite/chaotic.lua -- motions that forget where they came from, and long quiet ones: how far can they be proved?
--
-- References: Gragg's method with extrapolation (28th order) in quadruple precision, two tolerances that agree; Lorenz
-- to t = 1 also as printed in the documentation of VNODE-LP.
local problem = require "ambit.suite.problem"

local computed = "reference: extrapolated midpoint rule in quadruple precision"

local function case(t)
  t.group, t.over, t.source = "chaotic", t.over or "solvers", t.source and t.source .. "; " .. computed or computed
  return t
end

local function lorenz(y, number)
  return { 10 * (y[2] - y[1]), 28 * y[1] - y[2] - y[1] * y[3], y[1] * y[2] - number "8/3" * y[3] }
end

local first_lorenz = { t = 1, x = problem.digits { "-6.9453541599034593?3", "2.9971546266290307?3",
  "35.144350305722419?3" } }

-- In relative angles, two massless arms of 1 m with 1 kg at each end: E. Auer, M. Kecher et al., ValEncIA-IVP.
local function double_pendulum(y, number, _, ambit)
  local g, s, c = number "9.81", ambit.sin(y[2]), ambit.cos(y[2])
  local r1, r2 = s * (y[3] + y[4]) ^ 2 - 2 * g * ambit.sin(y[1]), -s * y[3] ^ 2 - g * ambit.sin(y[1] + y[2])
  local d = 1 + s ^ 2
  local a1 = (r1 - c * r2) / d
  return { y[3], y[4], a1, (2 * r2 - c * r1) / d - a1 }
end

local function pendulum_from(tolerance)
  return function(ambit)
    local first = 3 * ambit.pi / 4
    return { tolerance and ambit.around(first, tolerance) or first, -11 * ambit.pi / 20, "0.43", "0.67" }
  end
end

local third = { t = 3, x = problem.digits { "1.0162042327244053?3", "-10.420848801409251?3", "-1.2130632680126406?3",
  "-2.8880480368505798?3" } }

local function henon_heiles(y) return { y[3], y[4], -y[1] - 2 * y[1] * y[2], -y[2] - y[1] ^ 2 + y[2] ^ 2 } end

-- A satellite of earth and moon, in their rotating frame: R. F. Arenstorf 1963; Hairer, Norsett, Wanner, II.0.
local function arenstorf(y, number, _, ambit)
  local moon = number "0.012277471"
  local earth = 1 - moon
  local d1 = ambit.sqrt((y[1] + moon) ^ 2 + y[2] ^ 2) ^ 3
  local d2 = ambit.sqrt((y[1] - earth) ^ 2 + y[2] ^ 2) ^ 3
  return { y[3], y[4], y[1] + 2 * y[4] - earth * (y[1] + moon) / d1 - moon * (y[1] - earth) / d2,
    y[2] - 2 * y[3] - earth * y[2] / d1 - moon * y[2] / d2 }
end

local function roessler(y, number)
  return { -y[2] - y[3], y[1] + number "0.2" * y[2], number "0.2" + y[3] * (y[1] - number "5.7") }
end

local function pendulum(y, _, _, ambit) return { y[2], -ambit.sin(y[1]) } end
local function oscillator(y) return { y[2], -y[1] } end

return {
  case { name = "lorenz_1", over = "all", title = "Lorenz from (15, 15, 36) to t = 1", quick = true,
    make = problem.make("Lorenz", 3, lorenz, { 15, 15, 36 }, 1),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 12 }, stiff = { digits = 13 }, taylor_model = { digits = 8 },
      valencia = { digits = 8 } },
    reference = first_lorenz },
  case { name = "lorenz_20", title = "Lorenz from (15, 15, 36) to t = 20",
    make = problem.make("Lorenz", 3, lorenz, { 15, 15, 36 }, { 0, 1, 20 }),
    expected = { gsl = "computed", taylor_model = "unable", valencia = "unable", default = "proved" },
    least = { lohner = { digits = 4 }, stiff = { digits = 4 }, taylor_model = { t_reached = 12 },
      valencia = { t_reached = 14 } },
    reference = { first_lorenz, { t = 20, x = problem.digits { "14.304146251276021?77", "9.579369077482801?99",
      "39.038325167739236?99" } } } },
  case { name = "double_pendulum", title = "Double pendulum from a point, to t = 10",
    source = "E. Auer, ValEncIA-IVP", make = problem.make("double pendulum", 4, double_pendulum, pendulum_from(),
      { 0, 3, 10 }),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 9 }, stiff = { digits = 8 }, taylor_model = { digits = 5 },
      valencia = { digits = 3 } },
    reference = { third, { t = 10, x = problem.digits { "0.11766126590880896?3", "-12.780386126493975?3",
      "-0.83348225175903033?3", "-6.7827934232140913?3" } } } },
  case { name = "double_pendulum_box", over = "all", title = "Double pendulum, first angle +-1 %, to t = 3",
    source = "E. Auer, ValEncIA-IVP; the motion from the middle must be enclosed",
    make = problem.make("double pendulum", 4, double_pendulum, pendulum_from "1%", 3),
    expected = { gsl = "computed", lohner = "unable", stiff = "late", valencia = "unable", default = "proved" },
    least = { lohner = { t_reached = 0.79 }, valencia = { t_reached = 0.39 } },
    reference = third },
  case { name = "henon_heiles", title = "Henon-Heiles, energy 0.1303, to t = 100",
    source = "M. Henon, C. Heiles, Astron. J. 69 (1964) 73",
    make = problem.make("Henon-Heiles", 4, henon_heiles, { 0, "0.1", "0.5", 0 }, 100),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 11 }, stiff = { digits = 13 }, taylor_model = { digits = 6 },
      valencia = { digits = 5 } },
    reference = { t = 100, x = problem.digits { "2.2514698918543189?3e-1", "3.9201065358528805?3e-1",
      "1.8818797399243556?3e-1", "-1.4132567096172775?3e-1" } } },
  case { name = "arenstorf", title = "Arenstorf's orbit past moon and earth, all but a period (t = 17)",
    source = "R. F. Arenstorf, Amer. J. Math. 85 (1963) 27; data of Hairer, Norsett, Wanner, II.0",
    make = problem.make("Arenstorf", 4, arenstorf, { "0.994", 0, 0, "-2.00158510637908252240537862224" }, { 0, 5, 17 }),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 8 }, stiff = { digits = 8 }, taylor_model = { digits = 5 },
      valencia = { digits = 4 } },
    reference = { { t = 5, x = problem.digits { "2.2688783647977123?3e-2", "8.6654014017124730?3e-1",
      "-1.1773647864086439?3e-1", "-4.2178580416287773?3e-1" } }, { t = 17, x = problem.digits {
      "9.4129929372131128?3e-1", "3.5312350938413346?3e-2", "6.9837516921817858?3e-1",
      "-1.8529228333312175?3e-1" } } } },
  case { name = "roessler", title = "Roessler from (1, 1, 1) to t = 50",
    source = "O. E. Roessler, Phys. Lett. 57A (1976) 397",
    make = problem.make("Roessler", 3, roessler, { 1, 1, 1 }, { 0, 20, 50 }),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 11 }, stiff = { digits = 9 }, taylor_model = { digits = 7 },
      valencia = { digits = 6 } },
    reference = { { t = 20, x = problem.digits { "-4.3690465194821643?3", "7.3043848179111525?3",
      "2.4542600215474426?3e-2" } }, { t = 50, x = problem.digits { "-7.0615322633726025?3",
      "7.8182124498535687?3e-1", "1.5805049191914408?3e-2" } } } },
  case { name = "pendulum", over = "all", title = "Pendulum from 1 rad, a hundred seconds", quick = true,
    make = problem.make("pendulum", 2, pendulum, { 1, 0 }, 100),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 11 }, stiff = { digits = 11 }, taylor_model = { digits = 7 },
      valencia = { digits = 4 } },
    reference = { t = 100, x = problem.digits { "8.9618247769301593?3e-1", "4.1059345729492447?3e-1" } } },
  case { name = "pendulum_long", title = "Pendulum from 1 rad, a thousand seconds",
    make = problem.make("pendulum", 2, pendulum, { 1, 0 }, { 0, 100, 1000 }),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 8 }, stiff = { digits = 8 }, valencia = { digits = 2 } },
    reference = { { t = 100, x = problem.digits { "8.9618247769301593?3e-1", "4.1059345729492447?3e-1" } },
      { t = 1000, x = problem.digits { "-2.7450162128045934?3e-2", "-9.5845809724610745?3e-1" } } } },
  case { name = "oscillator", title = "x'' = -x, a thousand seconds", source = "exact: cos t, -sin t",
    make = problem.make("oscillator", 2, oscillator, { 1, 0 }, 1000),
    expected = { gsl = "computed", taylor_model = "unable", default = "proved" },
    least = { lohner = { digits = 11 }, stiff = { digits = 14 }, taylor_model = { t_reached = 5.9e2 },
      valencia = { digits = 7 } },
    reference = { t = 1000, x = problem.digits { "0.56237907629070299?3", "-0.82687954053200256?3" } } },
}
