-- suite/stiff_circuit.lua -- RINGMOD: a ring modulator of four diodes, between oscillations of 3e7 1/s.
local problem = require "ambit.suite.problem"

local function modulator(y, n, t, ambit)
  local C, Cs, Cp = n "1.6e-8", n "2e-12", n "1e-8"
  local L1, L2 = n "0.002", n "5e-4"
  local in1, in2 = ambit.sin(2000 * ambit.pi * t) / 2, 2 * ambit.sin(20000 * ambit.pi * t)
  local function diode(u) return n "40.67286402e-9" * (ambit.exp(n "17.7493332" * u) - 1) end
  local q1, q2 = diode(y[3] - y[5] - y[7] - in2), diode(y[6] - y[4] - y[7] - in2)
  local q3, q4 = diode(y[4] + y[5] + y[7] + in2), diode(y[7] - y[3] - y[6] + in2)
  return {
    (y[8] + (y[11] - y[10]) / 2 + y[14] - y[1] / 25000) / C,
    (y[9] + (y[13] - y[12]) / 2 + y[15] - y[2] / 25000) / C,
    (y[10] - q1 + q4) / Cs, (q2 - y[11] - q3) / Cs, (y[12] + q1 - q3) / Cs, (q4 - y[13] - q2) / Cs,
    (q1 + q2 - q3 - q4 - y[7] / 50) / Cp,
    -y[1] / n "4.45", -y[2] / n "4.45",
    (y[1] / 2 - y[3] - n "17.3" * y[10]) / L2, (y[4] - y[1] / 2 - n "17.3" * y[11]) / L2,
    (y[2] / 2 - y[5] - n "17.3" * y[12]) / L2, (y[6] - y[2] / 2 - n "17.3" * y[13]) / L2,
    (in1 - y[1] - n "86.3" * y[14]) / L1, (-y[2] - n "636.3" * y[15]) / L1,
  }
end

return {
  { name = "ringmod", title = "RINGMOD: a ring modulator, its first 10 microseconds", budget = { cpu = 25 },
    source = "Test Set for Initial Value Problem Solvers (Bari), to a hundredth of its end; reference: extrapolated \z
      linearly implicit Euler in quadruple precision",
    make = problem.make("ring modulator", 15, modulator, problem.zeros(15), "1e-5"),
    expected = { gsl = "computed", lohner = "proved", taylor_model = "late", default = "unable" },
    least = { stiff = { t_reached = 8e-7 }, valencia = { t_reached = 2.1e-6 } },
    reference = { t = 1e-5, x = problem.digits { "1.1190266960470352?3e-2", "-1.4260066493855679?3e-3",
      "2.2671171537031104?41e-1", "-2.1997727159872168?44e-1", "-2.2628512788231290?44e-1",
      "2.2040385908671981?41e-1", "-1.3505828128775063?3e-1", "-7.0841608319481998?3e-9",
      "5.3169083574846121?3e-10", "-1.5256363669380127?3e-3", "-1.5489194850667280?3e-3",
      "1.5489161970557268?3e-3", "1.5256396549490139?3e-3", "5.3931229870673808?3e-5",
      "8.1072501208277631?3e-7" } } },
}
