-- suite/stiff_fields.lua -- stiff problems from partial differential equations and from a beam, on few points so that
-- references in quadruple precision can be had: the equations are those of the collections, the grids are coarser.
local problem = require "ambit.suite.problem"

local computed = "; reference: extrapolation in quadruple precision, two tolerances"

-- Brusselator with diffusion, alpha = 1/50, fixed ends u = 1, v = 3: u at y1 to y10, v at y11 to y20.
local POINTS = 10

local function brusselator(y, number)
  local a, rates = number((POINTS + 1) ^ 2) / 50, {}
  local function at(i, offset, ends) return (i < 1 or i > POINTS) and ends or y[offset + i] end
  for i = 1, POINTS do
    local u, v = y[i], y[POINTS + i]
    rates[i] = 1 + u ^ 2 * v - 4 * u + a * (at(i - 1, 0, 1) - 2 * u + at(i + 1, 0, 1))
    rates[POINTS + i] = 3 * u - u ^ 2 * v + a * (at(i - 1, POINTS, 3) - 2 * v + at(i + 1, POINTS, 3))
  end
  return rates
end

local function brusselator_start(ambit)
  local list = {}
  for i = 1, POINTS do
    list[i], list[POINTS + i] = 1 + ambit.sin(2 * ambit.pi * i / (POINTS + 1)), 3
  end
  return list
end

-- A radioactive antibody walks into tissue: u, v in turn on ten points, zeta = 1 - e^(-x)-like coordinate with c = 4;
-- until the supply u = 2 at the surface stops.
local function tissue(y, number)
  local rates, dz = {}, number(POINTS)
  for i = 1, POINTS do
    local u, v = y[2 * i - 1], y[2 * i]
    local behind, ahead = i > 1 and y[2 * i - 3] or 2, i < POINTS and y[2 * i + 1] or u
    local z = number(i) / POINTS - 1
    rates[2 * i - 1] = z ^ 3 / 8 * (ahead - behind) * dz / 2 + z ^ 4 / 16 * (behind - 2 * u + ahead) * dz ^ 2
      - 100 * u * v
    rates[2 * i] = -100 * u * v
  end
  return rates
end

local function tissue_start()
  local list = {}
  for i = 1, POINTS do list[2 * i - 1], list[2 * i] = 0, 1 end
  return list
end

-- CUSP: Zeeman's threshold nerve impulse with van der Pol oscillators that drive it, eps = 1e-4, CELLS in a ring.
local CELLS = 8

local function cusp(y, number)
  local d, rates = number(CELLS ^ 2) / 144, {}
  local function diffused(i, offset)
    return d * (y[offset + (i - 2) % CELLS + 1] - 2 * y[offset + i] + y[offset + i % CELLS + 1])
  end
  for i = 1, CELLS do
    local x, a, b = y[i], y[CELLS + i], y[2 * CELLS + i]
    local u = (x - number "0.7") * (x - number "1.3")
    local v = u / (u + number "0.1")
    rates[i] = -10000 * (x ^ 3 + a * x + b) + diffused(i, 0)
    rates[CELLS + i] = b + number "0.07" * v + diffused(i, CELLS)
    rates[2 * CELLS + i] = (1 - a ^ 2) * b - a - number "0.4" * x + number "0.035" * v + diffused(i, 2 * CELLS)
  end
  return rates
end

local function cusp_start(ambit)
  local list = {}
  for i = 1, CELLS do
    local angle = 2 * ambit.pi * i / CELLS
    list[i], list[CELLS + i], list[2 * CELLS + i] = 0, -2 * ambit.cos(angle), 2 * ambit.sin(angle)
  end
  return list
end

-- An elastic beam, clamped at one end and pulled at the other: angles of LINKS links, then their speeds. With the
-- tridiagonal C (1, 2, ..., 2, 3; -cos of neighbours' angles) and D (-sin of them): theta'' = C v + D C^-1 (D v + w^2).
local LINKS = 6

local function bending(y, force, number, cos, sin)
  local n, v = number(LINKS), {}
  for k = 1, LINKS do
    local before, after = k > 1 and y[k - 1] or -y[1], k < LINKS and y[k + 1] or y[LINKS]
    v[k] = n ^ 4 * (before - 2 * y[k] + after) + n ^ 2 * force * (cos(y[k]) + sin(y[k]))
  end
  return v
end

-- The tridiagonal system C x = b, by elimination.
local function solve(main, beside, b)
  local a, x = { main[1] }, { b[1] }
  for k = 2, LINKS do
    a[k] = main[k] - beside[k - 1] ^ 2 / a[k - 1]
    x[k] = b[k] + beside[k - 1] / a[k - 1] * x[k - 1]
  end
  x[LINKS] = x[LINKS] / a[LINKS]
  for k = LINKS - 1, 1, -1 do x[k] = (x[k] + beside[k] * x[k + 1]) / a[k] end
  return x
end

local function beam(y, number, t, ambit)
  local v = bending(y, number "1.5" * ambit.sin(t) ^ 2, number, ambit.cos, ambit.sin)
  local main, c, s = {}, {}, {}
  for k = 1, LINKS do main[k] = k == 1 and 1 or k == LINKS and 3 or 2 end
  for k = 1, LINKS - 1 do c[k], s[k] = ambit.cos(y[k] - y[k + 1]), ambit.sin(y[k] - y[k + 1]) end
  local right, across = {}, {}
  for k = 1, LINKS do
    right[k], across[k] = y[LINKS + k] ^ 2, main[k] * v[k]
    if k > 1 then
      right[k], across[k] = right[k] + s[k - 1] * v[k - 1], across[k] - c[k - 1] * v[k - 1]
    end
    if k < LINKS then
      right[k], across[k] = right[k] - s[k] * v[k + 1], across[k] - c[k] * v[k + 1]
    end
  end
  local u, rates = solve(main, c, right), {}
  for k = 1, LINKS do
    rates[k], rates[LINKS + k] = y[LINKS + k], across[k]
    if k > 1 then rates[LINKS + k] = rates[LINKS + k] + s[k - 1] * u[k - 1] end
    if k < LINKS then rates[LINKS + k] = rates[LINKS + k] - s[k] * u[k + 1] end
  end
  return rates
end

return {
  { name = "brusselator", title = "Brusselator with diffusion, 10 points, to t = 10",
    source = "E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, IV.1" .. computed,
    make = problem.make("Brusselator", 2 * POINTS, brusselator, brusselator_start, 10),
    expected = { gsl = "computed", default = "proved" },
    least = { lohner = { digits = 12 }, stiff = { digits = 10 }, taylor_model = { digits = 8 },
      valencia = { digits = 7 } },
    reference = { t = 10, x = problem.digits { "7.7231491082609058?19e-1", "6.0573085343150577?43e-1",
      "5.0607366400554875?48e-1", "4.5428004415606748?11e-1", "4.3282933448030896?18e-1", "4.3294915736847381?13e-1",
      "4.5468330274289112?3e-1", "5.0687297574764076?33e-1", "6.0696491781165993?29e-1", "7.7352535619475020?11e-1",
      "3.2900214693464474?5", "3.4982674179327507?5", "3.6156484793914254?4", "3.6708412785220388?10",
      "3.6928964046412748?7", "3.6969669128285839?7", "3.6817123277321284?9", "3.6296724725034565?5",
      "3.5106744628192749?5", "3.2968927471763634?5" } } },
  { name = "tissue", title = "Medical Akzo Nobel, 10 points, until the supply stops (t = 5)",
    budget = { cpu = 15 }, source = "Test Set for Initial Value Problem Solvers (Bari)" .. computed,
    make = problem.make("Medical Akzo Nobel", 2 * POINTS, tissue, tissue_start(), 5),
    expected = { gsl = "computed", lohner = "late", default = "proved" },
    least = { stiff = { digits = 6 }, taylor_model = { digits = 10 }, valencia = { digits = 10 } },
    reference = { t = 5, x = { y1 = "1.6951705464136089?3", y3 = "1.3253057430538231?3", y5 = "0.88985537126425464?3",
      y7 = "0.42009001173997960?3", y9 = "2.3307140446757502?3e-3", y10 = "0.83088835328498999?3",
      y12 = "0.99963526696986985?3", y14 = "0.99999975710194774?3" } } },
  { name = "cusp", title = "CUSP: nerve impulses in a ring of 8 cells, to t = 0.1", budget = { cpu = 15 },
    source = "E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, IV.10, to an eleventh of its end"
      .. computed,
    make = problem.make("CUSP", 3 * CELLS, cusp, cusp_start, "0.1"),
    expected = { gsl = "computed", stiff = "late", taylor_model = "late", default = "proved" },
    least = { stiff = { t_reached = 0.005 } },
    reference = { t = 0.1, x = problem.digits { "-1.4892198673572226?6", "-1.2425382169878797?4",
      "-6.026428548051316?29e-1", "8.67205722225739?13e-2", "7.8119319361667177?84e-1", "1.3500718927951868?45",
      "1.5059219775052576?15", "-1.4433132835878841?12", "-1.2286986581041312?3", "2.1333302838674245?3e-1",
      "1.5102872705941321?3", "1.9458293411532227?3", "1.2345447044498242?3", "-2.0621046250459645?14e-1",
      "-1.5003887839014065?30", "-1.9302798779463083?3", "1.4729309802324683?3", "2.1834254735152310?3",
      "1.1289067367186634?3", "-1.6947257276162494?3e-1", "-1.4412219017982618?3", "-2.1824723489155711?3",
      "-1.1557740568588338?3", "2.2079034391296765?4e-1" } } },
  { name = "beam", title = "An elastic beam of 6 links is pulled, to t = 1", budget = { cpu = 15 },
    source = "E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, IV.1" .. computed,
    make = problem.make("beam", 2 * LINKS, beam, problem.zeros(2 * LINKS), 1),
    expected = { gsl = "computed", stiff = "unable", taylor_model = "late", valencia = "unable",
      default = "proved" },
    least = { lohner = { digits = 11 }, stiff = { t_reached = 0.17 }, valencia = { t_reached = 0.5 } },
    reference = { t = 1, x = problem.digits { "7.2342785990792082?6e-2", "2.0092278679352517?3e-1",
      "3.1146424773870686?3e-1",
      "4.0138483599723716?3e-1",
      "4.6696821865078336?3e-1", "5.0307720290656011?3e-1", "2.5964141556458775?28e-1", "6.8592357456805547?65e-1",
      "1.0179409543843029?9e0", "1.2586452905227614?8e0", "1.4126745084094471?6e0", "1.4859792345083440?4e0" } } },
}
