-- one_track.lua: the linear one-track model of a car, and how far its reductions that were published in 2009 are off.
--
-- Riekert and Schunck, Ingenieur-Archiv 11 (1940); data, scenarios and reduced models: Mikelsons and Brandt, Symbolic
-- model reduction for interval-valued scenarios, DETC2009-86954, equations 21 to 41. Their (22) is printed with
-- C_R l_R + C_F l_F before v_y; the moments of the tyre forces have opposite signs, and only with C_R l_R - C_F l_F are
-- their means 0.00825, 0.10917 and 16.64796 those of the model.
--   ambit run one_track.lua           the published models, then reductions of our own
local ambit = require "ambit"
local number, between, degrees = ambit.number, ambit.between, ambit.degrees

local one_track = {}

-- -- the model

local m, Jz, CR, CF = number(1450), number(1920), number(1e5), number(8e4) -- kg, kg m^2, N/rad for each axle
local lR, lF = number "1.45", number "1.3"                                 -- m, from the centre of mass

-- Lateral and yaw acceleration are linear in the states and delta: these are the rows of (21) and (22), and the outputs
-- C x + D delta of (33).
local function lateral(s, p)
  return -(CR + CF) / (m * p.v) * s.vy + ((CR * lR - CF * lF) / (m * p.v) - p.v) * s.yaw_rate + CF / m * p.delta
end

local function yawing(s, p)
  return (CR * lR - CF * lF) / (Jz * p.v) * s.vy - (CR * lR ^ 2 + CF * lF ^ 2) / (Jz * p.v) * s.yaw_rate
    + CF * lF / Jz * p.delta
end

local states = { "vy", "yaw_rate", "yaw", "x", "y" }

-- v: m/s, delta: rad, angle of the front wheel
function one_track.car(v, delta)
  return ambit.ode { "one-track model", states = states, parameters = { v = v, delta = delta },
    equations = function(s, p)
      return { vy = lateral(s, p), yaw_rate = yawing(s, p), yaw = s.yaw_rate,
        x = p.v * ambit.cos(s.yaw) - s.vy * ambit.sin(s.yaw), y = p.v * ambit.sin(s.yaw) + s.vy * ambit.cos(s.yaw) }
    end }
end

-- Where vy and the yaw rate stay constant: Cramer's rule.
function one_track.steady(p)
  local a, b = -(CR + CF) / (m * p.v), (CR * lR - CF * lF) / (m * p.v) - p.v
  local c, d = (CR * lR - CF * lF) / (Jz * p.v), -(CR * lR ^ 2 + CF * lF ^ 2) / (Jz * p.v)
  local f, g = -CF / m * p.delta, -CF * lF / Jz * p.delta
  local determinant = a * d - b * c
  return { vy = (f * d - b * g) / determinant, yaw_rate = (a * g - c * f) / determinant, yaw = 0, x = 0, y = 0 }
end

-- -- the scenarios

local rest = { vy = 0, yaw_rate = 0, yaw = 0, x = 0, y = 0 }
local slow, medium, fast = number(125) / 9, number(50) / 3, number(175) / 9

local function reduced(name, car, equations)
  return ambit.ode { name, states = states, parameters = car.parameters, equations = equations }
end

local function either(r) return between("-" .. r, r) end

-- The mean over the run of the greatest yaw rate, which the paper puts in the place of the yaw rate.
local function mean_rate(car)
  local times = {}
  for k = 0, 100 do times[k + 1] = k / 10 end
  local run, sum = ambit.simulate { car, initial = rest, t = times, solver = "taylor_model" }, 0
  for _, t in ipairs(times) do sum = sum + run:at(t).yaw_rate.hi end
  return sum / #times
end

-- Straight ahead, 10 s: v; delta is 0 give or take 0.1 degree. Equations (25) to (28), and (29) to (32).
local tenth = ambit.pi / 1800

function one_track.straight()
  local car = one_track.car(medium, between(-tenth, tenth))
  local function like(yaw_rate, yaw)
    return reduced("(25) to (28)", car, function(s, p)
      return { vy = either "0.13772" + either "0.13745", yaw_rate = yaw_rate, yaw = yaw(s),
        x = between("16.64796", "16.667"), y = p.v * ambit.sin(s.yaw) }
    end)
  end
  local rate = either "0.00825"
  return { car = car, initial = rest, t = { 0, 10 }, outputs = { "x", "y" }, error = { x = "0.1", y = "0.1" },
    printed = like(rate, function(s) return s.yaw_rate end),       -- yaw acceleration
    meant = like(0, function() return rate end) }                  -- yaw rate
end

function one_track.straight_fast()
  local car = one_track.car(between(medium, fast), between(-tenth, tenth))
  local mean = mean_rate(car)
  local function like(yaw_rate, yaw, surplus)
    return reduced("(29) to (32)", car, function(s, p)
      return { vy = either "0.18137" + either "0.14601", yaw_rate = yaw_rate, yaw = yaw(s),
        x = ambit.cos(either "0.04335") * p.v + surplus, y = p.v * ambit.sin(s.yaw) }
    end)
  end
  local rate = between(-mean, mean)
  return { car = car, initial = rest, t = { 0, 10 }, outputs = { "x", "y" }, error = { x = 10, y = "0.6" },
    printed = like(either "0.10917" + either "0.09457", function(s) return s.yaw_rate end, "16.6667"),
    meant = like(0, function() return rate end, 0) }
end

-- Cornering, delta from 2/3 to 1 degree. Equations (34) to (37), from the steady state, and (38) to (41), from rest.
local corner = { degrees(number(2) / 3), degrees(1) }
local accelerations = { ["vy'"] = lateral, ["yaw_rate'"] = yawing }

function one_track.steady_corner()
  local car = one_track.car(medium, between(corner[1], corner[2]))
  local box = ambit.evaluate { one_track.steady(car.parameters), arithmetic = "affine" }
  local apart = { vy = between(box.vy.lo, box.vy.hi), yaw_rate = between(box.yaw_rate.lo, box.yaw_rate.hi), yaw = 0,
    x = 0, y = 0 }
  return { car = car, initial = one_track.steady(car.parameters), apart = apart, t = { 0, 10 }, outputs = accelerations,
    error = { ["vy'"] = "0.01", ["yaw_rate'"] = "0.001" },
    printed = reduced("(34) to (37)", car, { vy = 0, yaw_rate = 0, yaw = 0, x = 0, y = 0 }) }
end

function one_track.corner()
  local car = one_track.car(between(slow, medium), between(corner[1], corner[2]))
  return { car = car, initial = rest, t = { 0, 2 }, outputs = { "vy", "yaw_rate" },
    error = { vy = "0.3", yaw_rate = "0.1" }, accelerations = accelerations,
    acceleration_error = { ["vy'"] = "0.3", ["yaw_rate'"] = "0.1" },
    printed = reduced("(38) to (41)", car, function(s, p)
      return { vy = 0, yaw = 0, x = 0, y = 0,
        yaw_rate = -(CR * lR ^ 2 + CF * lF ^ 2) / (Jz * p.v) * s.yaw_rate + CF * lF / Jz * p.delta }
    end) }
end

-- A published model against the car, as the paper judges: by how far the ends of the ranges are off (its equation 19).
function one_track.judge(q, model, changes)
  local question = { q.car, model, t = q.t, initial = q.initial, outputs = q.outputs, error = q.error,
    criterion = "bounds" }
  for key, value in pairs(changes or {}) do question[key] = value end
  return ambit.certify(question)
end

-- All published models: { what, scenario, model, what is asked otherwise }
function one_track.published()
  local straight, fast_straight = one_track.straight(), one_track.straight_fast()
  local steady, from_rest = one_track.steady_corner(), one_track.corner()
  return {
    { "straight ahead at 60 km/h, yaw rate = its mean", straight, straight.meant },
    { "... as printed, yaw acceleration", straight, straight.printed, { expect = "exceeded" } },
    { "straight ahead at 60 to 70 km/h, yaw rate = its mean", fast_straight, fast_straight.meant },
    { "... as printed, yaw acceleration", fast_straight, fast_straight.printed, { expect = "exceeded" } },
    { "steady cornering, nothing moves", steady, steady.printed, { criterion = "difference" } },
    { "... from a box of steady states", steady, steady.printed,
      { criterion = "difference", expect = "exceeded", initial = steady.apart } },
    { "cornering from rest, states", from_rest, from_rest.printed },
    { "... accelerations", from_rest, from_rest.printed, { expect = "exceeded",
      outputs = accelerations, error = from_rest.acceleration_error } },
  }
end

-- Reductions of our own: { what, scenario, criterion }
function one_track.own()
  local from_rest = one_track.corner()
  local driven = setmetatable({ outputs = accelerations, error = from_rest.acceleration_error },
    { __index = from_rest })
  return {
    { "straight ahead at 60 km/h, by the ends of ranges", one_track.straight(), "bounds" },
    { "straight ahead at 60 km/h", one_track.straight(), "difference" },
    { "straight ahead at 60 to 70 km/h", one_track.straight_fast(), "difference" },
    { "steady cornering", one_track.steady_corner(), "difference" },
    { "cornering from rest, states", from_rest, "difference" },
    { "cornering from rest, accelerations", driven, "difference" },
  }
end

function one_track.reduce(q, criterion)
  return ambit.reduce { q.car, t = q.t, initial = q.initial, outputs = q.outputs, error = q.error,
    criterion = criterion }
end

if ... == "model" then return one_track end

-- -- the scene

print(("%-54s %-9s %-11s %-10s %s"):format("published model", "verdict", "output", "error <=", "bound"))
for _, case in ipairs(one_track.published()) do
  local verdict = one_track.judge(case[2], case[3], case[4])
  for k, name in ipairs(verdict.outputs) do
    print(("%-54s %-9s %-11s %-10.4g %g"):format(k == 1 and case[1] or "",
      k == 1 and (verdict.status == "proved" and "accepted" or "rejected") or "", name, verdict.error[name],
      verdict.bounds[name]))
  end
end

for _, case in ipairs(one_track.own()) do
  print("\n" .. case[1])
  print(one_track.reduce(case[2], case[3]))
end
