-- two_track.lua: a planar two-track model of a car, 18 states, proved for 10 s; and a reduction of it.
--
-- Four wheels turn, eight tyre forces build up over their relaxation lengths, the body moves in the plane: the model
-- over which the integrator of Mikelsons and Brandt (DETC2009-86954, section 4.2) ended after 0.05 s.
--
-- Tyres: the linear part (lambda >= 1) of Dugoff, Fancher and Segel (Tire Performance Characteristics Affecting Vehicle
-- Response to Steering and Braking Control Inputs, 1969). With u and w the velocity of the hub along and across the
-- wheel, omega R its rolling speed, the slip s = 1 - omega R / u and the slip angle tan alpha = w / u,
--   F_x = -C_s s / (1 - s) = C_s (omega R - u) / (omega R),    F_y = -C_a tan(alpha) / (1 - s) = -C_a w / (omega R):
-- what the contact patch slides, relative to how far the wheel rolls. Each force follows by
--   F' = u / sigma (F_steady - F),   sigma the relaxation length [Pacejka, Tyre and Vehicle Dynamics, chapter 7].
-- There is no drive, so corners slow the car down. Data as of the one-track model (one_track.lua), halved for a wheel.
--   ambit run two_track.lua           10 s of driving; the reduction takes three minutes
--   ambit run two_track.lua 0.5       half a second of it, in half a minute
local ambit = require "ambit"
local number = ambit.number

local two_track = {}

local R, J = number "0.3", 1            -- m, kg m^2: radius and inertia of a wheel
local Cs = 60000                        -- N, longitudinal stiffness
local sigma_x, sigma_y = number "0.3", number "0.6" -- m
local m, Jz = 1450, 1920                -- kg, kg m^2

-- where wheels are (m, ahead and to the left of the centre of mass), and their cornering stiffness (N/rad)
local wheels = {
  { name = "fl", x = number "1.3", y = number "0.75", Ca = 40000, steers = true },
  { name = "fr", x = number "1.3", y = number "-0.75", Ca = 40000, steers = true },
  { name = "rl", x = number "-1.45", y = number "0.75", Ca = 50000 },
  { name = "rr", x = number "-1.45", y = number "-0.75", Ca = 50000 },
}

local function turned(x, y, angle)
  local c, s = ambit.cos(angle), ambit.sin(angle)
  return x * c - y * s, x * s + y * c
end

-- Rates of one wheel; the force on the body and its moment.
local function wheel_rates(w, s, delta, rates)
  local spin, along, across = "omega_" .. w.name, "fx_" .. w.name, "fy_" .. w.name
  local u, v = s.vx - w.y * s.yaw_rate, s.vy + w.x * s.yaw_rate
  if w.steers then u, v = turned(u, v, -delta) end
  local rolling = R * s[spin]
  rates[spin] = -R / J * s[along]
  rates[along] = u / sigma_x * (Cs * (rolling - u) / rolling - s[along])
  rates[across] = u / sigma_y * (-w.Ca * v / rolling - s[across])
  local X, Y = s[along], s[across]
  if w.steers then X, Y = turned(X, Y, delta) end
  return X, Y, w.x * Y - w.y * X
end

-- X, Y and moment of all wheels
local function forces(s, delta, rates)
  local X, Y, M = 0, 0, 0
  for _, w in ipairs(wheels) do
    local x, y, moment = wheel_rates(w, s, delta, rates)
    X, Y, M = X + x, Y + y, M + moment
  end
  return X, Y, M
end

function two_track.rates(s, p)
  local rates = {}
  local X, Y, M = forces(s, p.delta, rates)
  rates.x, rates.y = turned(s.vx, s.vy, s.yaw)
  rates.yaw, rates.yaw_rate = s.yaw_rate, M / Jz
  rates.vx, rates.vy = X / m + s.yaw_rate * s.vy, Y / m - s.yaw_rate * s.vx
  return rates
end

-- delta: rad, angle of both front wheels
function two_track.car(delta)
  local states = {}
  for _, kind in ipairs { "omega_", "fx_", "fy_" } do
    for _, w in ipairs(wheels) do states[#states + 1] = kind .. w.name end
  end
  for _, name in ipairs { "x", "y", "yaw", "vx", "vy", "yaw_rate" } do states[#states + 1] = name end
  return ambit.ode { "two-track model", states = states, parameters = { delta = delta }, equations = two_track.rates }
end

-- Rolling straight ahead.
function two_track.rolling(v)
  local initial = { x = 0, y = 0, yaw = 0, vx = v, vy = 0, yaw_rate = 0 }
  for _, w in ipairs(wheels) do
    initial["omega_" .. w.name], initial["fx_" .. w.name], initial["fy_" .. w.name] = v / R, 0, 0
  end
  return initial
end

-- A scenario of `seconds` at 60 km/h; sides get up to some hundred newtons, from nothing
function two_track.question(delta, seconds)
  return { two_track.car(delta), initial = two_track.rolling(number(50) / 3), t = { 0, seconds }, solver = "lohner",
    width_max = 1e6 }
end

-- The smallest model for where the car is and how it turns, over all steering angles: which right-hand sides may be
-- zero?
function two_track.reduce(delta, seconds)
  local question = two_track.question(delta, seconds)
  question.outputs, question.error = { "y", "yaw_rate" }, { y = "0.1", yaw_rate = "2e-4" } -- m, rad/s
  question.reductions, question.levels = { "neglect" }, 0
  return ambit.reduce(question)
end

two_track.straight = ambit.between("-1e-6", "1e-6")                  -- rad: what the paper tried
two_track.tenth = ambit.between(-ambit.pi / 1800, ambit.pi / 1800)   -- 0.1 degree to either side

if ... == "model" then return two_track end

-- -- the scene
local seconds = tonumber(arg and arg[1]) or 10
local shown = { "x", "y", "yaw", "vx", "vy", "yaw_rate", "omega_fl", "fx_fl", "fy_fl" }
for _, case in ipairs { { "+-1e-6 rad", two_track.straight }, { "+-0.1 degree", two_track.tenth } } do
  local question = two_track.question(case[2], seconds)
  local run = ambit.simulate(question)
  print(("delta = %s: %s, %.2f s of CPU time"):format(case[1], run, run.cpu_seconds))
  question.n, question.solver, question.width_max = 20, nil, nil
  local sampled = ambit.sample(question)
  print(("%-10s %-44s %-10s %s"):format("", "proved", "width", "width of 20 samples"))
  for _, name in ipairs(shown) do
    print(("%-10s %-44s %-10.4g %.4g"):format(name, run.x[name], run.x[name]:width(), sampled.x[name]:width()))
  end
end

-- With the speed ahead, the spin of the wheels and the forces along them at rest, the one-track model is left, with
-- tyres that need time.
print(("\nreduced over %s s, delta = +-0.1 degree"):format(seconds))
print(two_track.reduce(two_track.tenth, seconds))
