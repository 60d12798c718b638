-- suite/stiff_pollution.lua -- POLLU: 25 reactions between 20 species of polluted air, rates 15 orders of magnitude
-- apart. J. G. Verwer, SIAM J. Sci. Comput. 15 (1994) 1243; ppm and minutes. Reference as in suite/stiff_kinetics.lua.
local problem = require "ambit.suite.problem"

-- rate constant, who reacts, what appears (species) and disappears (-species), each as often as it does
local reactions = {
  { "0.35", { 1 }, { -1, 2, 3 } }, { "26.6", { 2, 4 }, { 1, -2, -4 } }, { "1.23e4", { 5, 2 }, { 1, -2, -5, 6 } },
  { "8.6e-4", { 7 }, { 5, 5, -7, 8 } }, { "8.2e-4", { 7 }, { -7, 8 } }, { "1.5e4", { 7, 6 }, { 5, -6, -7, 8 } },
  { "1.3e-4", { 9 }, { 5, 8, -9, 10 } }, { "2.4e4", { 9, 6 }, { -6, -9, 11 } },
  { "1.65e4", { 11, 2 }, { 1, -2, 10, -11, 12 } }, { "9e3", { 11, 1 }, { -1, -11, 13 } },
  { "0.022", { 13 }, { 1, 11, -13 } }, { "1.2e4", { 10, 2 }, { 1, -2, -10, 14 } }, { "1.88", { 14 }, { 5, 7, -14 } },
  { "1.63e4", { 1, 6 }, { -1, -6, 15 } }, { "4.8e6", { 3 }, { -3, 4 } }, { "3.5e-4", { 4 }, { -4, 16 } },
  { "0.0175", { 4 }, { 3, -4 } }, { "1e8", { 16 }, { 6, 6, -16 } }, { "4.44e11", { 16 }, { 3, -16 } },
  { "1240", { 17, 6 }, { 5, -6, -17, 18 } }, { "2.1", { 19 }, { 2, -19 } }, { "5.78", { 19 }, { 1, 3, -19 } },
  { "0.0474", { 1, 4 }, { -1, -4, 19 } }, { "1780", { 19, 1 }, { -1, -19, 20 } }, { "3.12", { 20 }, { 1, 19, -20 } },
}

local function rates(y, number)
  local list = {}
  for i = 1, 20 do list[i] = number "0" end
  for _, r in ipairs(reactions) do
    local speed = number(r[1])
    for _, i in ipairs(r[2]) do speed = speed * y[i] end
    for _, i in ipairs(r[3]) do
      if i > 0 then list[i] = list[i] + speed else list[-i] = list[-i] - speed end
    end
  end
  return list
end

local start = problem.zeros(20, { [2] = "0.2", [4] = "0.04", [7] = "0.1", [8] = "0.3", [9] = "0.01", [17] = "0.007" })

return {
  { name = "pollu", title = "POLLU: polluted air for an hour", budget = { cpu = 15 },
    source = "Test Set for Initial Value Problem Solvers (Bari); reference: extrapolated linearly implicit Euler in \z
      quadruple precision",
    make = problem.make("POLLU", 20, rates, start, 60),
    expected = { ["gsl real"] = "late", ["gsl real method=msbdf"] = "computed", lohner = "unable",
      taylor_model = "unable", valencia = "unable", default = "proved" },
    least = { stiff = { digits = 13 }, valencia = { t_reached = 0.0097 } },
    reference = { t = 60, x = problem.digits { "5.6462554800227693?3e-2", "1.3424841304223385?3e-1",
      "4.1397343310994270?3e-9", "5.5231402074843599?3e-3", "2.0189772623021960?12e-7", "1.4645418634939658?11e-7",
      "7.7842491189979641?3e-2", "3.2450753533960182?3e-1", "7.4940133838804056?3e-3", "1.6222931573015603?9e-8",
      "1.1358638332570748?28e-8", "2.2305059757213599?3e-3", "2.0871628827986300?3e-4", "1.3969210168401577?3e-5",
      "8.9648848568982942?3e-3", "4.3528463693301037?3e-18", "6.8992196962634054?3e-3", "1.0078030373659460?3e-4",
      "1.7721465139699845?3e-6", "5.6829432923163934?3e-5" } } },
}
