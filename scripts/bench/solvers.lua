-- solvers.lua: how far, how tight and how fast the validated solvers go on the problems that the field is measured by.
-- ambit run scripts/bench/solvers.lua [NAME ...]   prints a table: what, required, measured, verdict; exit 1 if one is
-- missed. NAME: P1 P2 P3 P4 P5 P6 stiff roots escape; none: all. Times are CPU seconds of the run itself.
local ambit = require "ambit"
local around, between, pi = ambit.around, ambit.between, ambit.pi

local missed, wanted = 0, {}
for _, name in ipairs(arg or {}) do wanted[name] = true end
local function row(what, required, measured, ok)
  if not ok then missed = missed + 1 end
  print(("| %-58s | %-32s | %-44s | %s |"):format(what, required, measured, ok and "reached" or "MISSED"))
end
local function number(x) return ("%.4g"):format(x) end
local function numbers(list)
  local text = {}
  for i, x in ipairs(list) do text[i] = number(x) end
  return table.concat(text, " ")
end
local function section(name, measure)
  if next(wanted) == nil or wanted[name] then measure() end
end

-- run: how wide, relative to the largest magnitude of each state
local function widths(x, names)
  local w = {}
  for i, name in ipairs(names) do w[i] = x[name]:width() end
  return w
end
local function relative(x, names)
  local most = 0
  for _, name in ipairs(names) do most = math.max(most, x[name]:width() / x[name]:mag()) end
  return most
end
local function holds(x, names, digits) -- reference digits: decimal texts
  for i, name in ipairs(names) do
    local truth = ambit.interval(digits[i])
    if not (x[name].lo <= truth.hi and truth.lo <= x[name].hi) then return false end
  end
  return true
end
local function outcome(run, extra)
  local text = run.status == "complete" and ("%s s"):format(number(run.cpu_seconds))
      or ("%s at %s after %s s"):format(run.status, number(run.t_reached), number(run.cpu_seconds))
  return extra and extra .. "; " .. text or text
end
local function done(run, seconds) return run.status == "complete" and run.cpu_seconds <= seconds end

-- The first and the last instant between which the widest state crosses a bound for good.
local function stays_under(run, names, bound)
  local first, last = run.t_reached, 0
  for step in run:steps() do
    local wide = math.max(table.unpack(widths(step.x, names))) > bound
    if wide and first == run.t_reached then first = step.t end
    if not wide then last = step.t end
  end
  return first, last
end

print "| figure | required | measured | |"
print "|---|---|---|---|"

-- P1, P2: the double pendulum in relative angles, equations by hand
local angles = { "beta1", "beta2", "w1", "w2" }
local double_pendulum = ambit.ode {
  states = angles,
  equations = function(s)
    local g = ambit.number "9.81"
    local s1, c1 = ambit.sin(s.beta2), ambit.cos(s.beta2)
    local r1 = s1 * (s.w1 + s.w2) ^ 2 - 2 * g * ambit.sin(s.beta1)
    local r2 = -s1 * s.w1 ^ 2 - g * ambit.sin(s.beta1 + s.beta2)
    local d = 1 + s1 ^ 2
    local a1 = (r1 - c1 * r2) / d
    return { beta1 = s.w1, beta2 = s.w2, w1 = a1, w2 = (2 * r2 - c1 * r1) / d - a1 }
  end,
}
local function start(first) return { beta1 = first, beta2 = -11 * pi / 20, w1 = "0.43", w2 = "0.67" } end

section("P1", function()
  local function go(options)
    options[1], options.initial = double_pendulum, start(around(3 * pi / 4, options.tolerance or "1%"))
    options.tolerance = nil
    return ambit.simulate(options)
  end
  local run = go { t = { 0, 1 }, solver = "taylor_model" }
  local w, truth, near = widths(run.x, angles), { .0128, .1229, .6294, 1.0191 }, true
  for i, x in ipairs(truth) do near = near and w[i] <= 1.01 * (x + 5e-5) end -- half a unit of the last digit
  row("P1 +-1 %, taylor_model, widths at t = 1", "true .0128 .1229 .6294 1.0191 +1 %, 0.02 s",
    outcome(run, numbers(w)), near and done(run, 0.02))
  run = go { t = { 0, 3 }, solver = "taylor_model", pieces_max = 1 }
  row("P1 +-1 %, taylor_model, one piece, to t = 3", "0.05 s", outcome(run), done(run, 0.05))
  run = go { t = { 0, 5 }, solver = "taylor_model" }
  row("P1 +-1 %, taylor_model, to t = 5", "0.4 s", outcome(run), done(run, 0.4))
  run = go { t = { 0, 7 }, solver = "taylor_model" }
  row("P1 +-1 %, taylor_model, to t = 7", "3 s", outcome(run), done(run, 3))
  run = go { tolerance = "10%", t = { 0, 1 }, solver = "taylor_model" }
  row("P1 +-10 %, taylor_model, to t = 1", "0.1 s", outcome(run), done(run, 0.1))
  run = go { t = { 0, 2 }, solver = "lohner" }
  row("P1 +-1 %, lohner, proves to", "> 0.69 (kv .684)", outcome(run), run.t_reached > 0.69)
  local models = { "taylor_model", order = 10 }
  run = go { t = { 0, 0.5 }, solver = "valencia", arithmetic = models }
  row("P1 +-1 %, valencia, to t = 0.5", "1 s (paper 94 s)", outcome(run, numbers(widths(run.x, angles))), done(run, 1))
  run = go { t = { 0, 2 }, solver = "valencia", arithmetic = models }
  row("P1 +-1 %, valencia, proves to", "> 1.0", outcome(run), run.t_reached > 1.0)
end)

section("P2", function()
  local run = ambit.simulate { double_pendulum, initial = start(3 * pi / 4), t = { 0, 10 }, solver = "lohner" }
  local w = math.max(table.unpack(widths(run.x, angles)))
  row("P2, lohner, to t = 10, largest width", "2e-10, 0.015 s (kv 1.9e-10, 18 s)", outcome(run, number(w)),
    w < 2e-10 and done(run, 0.015))
  run = ambit.simulate { double_pendulum, initial = start(3 * pi / 4), t = { 0, 10 }, solver = "lohner", order = 20 }
  local us = 1e6 * run.cpu_seconds / run.step_count
  row("P2, lohner, order 20, a step", "30 us", ("%.3g us"):format(us), us <= 30)
  run = ambit.simulate { double_pendulum, initial = start(3 * pi / 4), t = { 0, 32 }, solver = "lohner" }
  local first, last = stays_under(run, angles, 1e-3)
  row("P2, lohner, under 1e-3: at first over it, at last under it", "29", ("%.2f, %.2f"):format(first, last), last > 29)
end)

section("P3", function()
  local names = { "x", "y", "z" }
  local lorenz = ambit.ode {
    states = names,
    equations = function(s)
      return { x = 10 * (s.y - s.x), y = s.x * (28 - s.z) - s.y, z = s.x * s.y - ambit.number "8/3" * s.z }
    end,
  }
  local run = ambit.simulate { lorenz, initial = { x = 15, y = 15, z = 36 }, t = { 0, 20 }, solver = "lohner" }
  local w = math.max(table.unpack(widths(run.x, names)))
  row("P3, lohner, to t = 20, largest width", "1e-4, 0.006 s (kv 8.1e-5, 2.2 s)", outcome(run, number(w)),
    w < 1e-4 and done(run, 0.006))
  run = ambit.simulate { lorenz, initial = { x = 15, y = 15, z = 36 }, t = { 0, 26 }, solver = "lohner" }
  local first, last = stays_under(run, names, 1e-3)
  row("P3, lohner, under 1e-3: at first over it, at last under it", "24", ("%.2f, %.2f"):format(first, last), last > 24)
end)

local function van_der_pol(mu)
  return ambit.ode {
    states = { "x", "v" }, equations = function(s) return { x = s.v, v = mu * (1 - s.x ^ 2) * s.v - s.x } end,
  }
end

section("P4", function()
  local run = ambit.simulate { van_der_pol(1), initial = { x = between("1.25", "1.55"), v = between("2.35", "2.45") },
    t = { 0, 7 }, solver = "taylor_model" }
  local w = widths(run.x, { "x", "v" })
  row("P4, taylor_model, to t = 7, widths", ".147 x .591 +10 %, 0.5 s", outcome(run, numbers(w)),
    w[1] <= .147 * 1.1 and w[2] <= .591 * 1.1 and done(run, 0.5))
end)

section("P6", function()
  local pendulum = ambit.ode {
    states = { "phi", "omega" },
    equations = function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) } end,
  }
  local run = ambit.simulate { pendulum, initial = { phi = 1, omega = 0 }, t = { 0, 100 }, solver = "lohner" }
  local w = math.max(table.unpack(widths(run.x, { "phi", "omega" })))
  row("P6, lohner, to t = 100, largest width", "3.3e-12, 0.01 s", outcome(run, number(w)), w < 3.3e-12 and done(run, 0.01))
end)

local kinetics = { "y1", "y2", "y3" }
local function robertson(k1, k2, k3)
  return ambit.ode {
    states = kinetics,
    equations = function(s)
      return { y1 = -k1 * s.y1 + k3 * s.y2 * s.y3, y2 = k1 * s.y1 - k3 * s.y2 * s.y3 - k2 * s.y2 ^ 2, y3 = k2 * s.y2 ^ 2 }
    end,
  }
end

section("P5", function()
  local pair = { "x", "v" }
  local run = ambit.simulate { van_der_pol(1000), initial = { x = 2, v = 0 }, t = { 0, 2000 }, solver = "stiff" }
  local good = run.status == "complete" and holds(run.x, pair, { "1.7061677321704650084765", "-8.9280970102481654777515e-4" })
  row("P5 Van der Pol, mu = 1000, stiff, to t = 2000", "2e-8 relative, 0.3 s", outcome(run, number(relative(run.x, pair))),
    good and relative(run.x, pair) < 2e-8 and done(run, 0.3))
  -- the period is (3 - 2 log 2) mu + 7.0143 mu^(-1/3) + ...: 161371 for mu = 1e5
  run = ambit.simulate { van_der_pol(100000), initial = { x = 2, v = 0 }, t = { 0, 161400 }, solver = "stiff" }
  row("P5 Van der Pol, mu = 1e5, stiff, one period", "complete", outcome(run, number(relative(run.x, pair))),
    run.status == "complete")

  local function kinetic(t, k1, k2, k3)
    return ambit.simulate { robertson(k1 or ambit.number "0.04", k2 or 3e7, k3 or 1e4),
      initial = { y1 = 1, y2 = 0, y3 = 0 }, t = { 0, t }, solver = "stiff" }
  end
  run = kinetic(1e9)
  row("P5 Robertson, stiff, to t = 1e9", "0.1 s", outcome(run, number(relative(run.x, kinetics))), done(run, 0.1))
  run = kinetic(1e11)
  good = run.status == "complete"
      and holds(run.x, kinetics, { "2.0833401497012942e-8", "8.3333607703347834e-14", "0.99999997916651517" })
  row("P5 Robertson, stiff, to t = 1e11, reference inside", "1 s", outcome(run, number(relative(run.x, kinetics))),
    good and done(run, 1))
  run = kinetic(1e4, around("0.04", "1%"), around(3e7, "1%"), around(1e4, "1%"))
  row("P5 Robertson, rates +-1 %, stiff, to t = 1e4", "complete", outcome(run, numbers(widths(run.x, kinetics))),
    run.status == "complete")
  local linear = ambit.ode { states = { "y" }, equations = function(s, _, t) return { y = -1000 * (s.y - ambit.cos(t)) } end }
  run = ambit.simulate { linear, initial = { y = 0 }, t = { 0, 2000 }, solver = "stiff" }
  row("P5 y' = -1000 (y - cos t), stiff, to t = 2000", "0.1 s", outcome(run, number(run.x.y:width())), done(run, 0.1))
end)

section("stiff", function()
  local names = { "y1", "y2", "y3", "y4", "y5", "y6", "y7", "y8" }
  local n = ambit.number
  local hires = ambit.ode {
    states = names,
    equations = function(y)
      return {
        y1 = -n "1.71" * y.y1 + n "0.43" * y.y2 + n "8.32" * y.y3 + n "0.0007",
        y2 = n "1.71" * y.y1 - n "8.75" * y.y2,
        y3 = -n "10.03" * y.y3 + n "0.43" * y.y4 + n "0.035" * y.y5,
        y4 = n "8.32" * y.y2 + n "1.71" * y.y3 - n "1.12" * y.y4,
        y5 = -n "1.745" * y.y5 + n "0.43" * (y.y6 + y.y7),
        y6 = -280 * y.y6 * y.y8 + n "0.69" * y.y4 + n "1.71" * y.y5 - n "0.43" * y.y6 + n "0.69" * y.y7,
        y7 = 280 * y.y6 * y.y8 - n "1.81" * y.y7,
        y8 = -280 * y.y6 * y.y8 + n "1.81" * y.y7,
      }
    end,
  }
  local run = ambit.simulate { hires, initial = { 1, 0, 0, 0, 0, 0, 0, "0.0057" }, t = { 0, "321.8122" }, solver = "stiff" }
  local inside = run.status == "complete" and holds(run.x, names, { "7.371312573325667807277e-4",
    "1.442485726316184658188e-4", "5.888729740967575007484e-5", "1.175651343283149145506e-3",
    "2.386356198831330468821e-3", "6.238968252742795786648e-3", "2.849998395185768657930e-3",
    "2.850001604814231342070e-3" })
  row("HIRES, stiff, to 321.8122, reference inside", "1e-8 relative, 0.3 s", outcome(run, number(relative(run.x, names))),
    inside and relative(run.x, names) < 1e-8 and done(run, 0.3))
  local orego = ambit.ode {
    states = kinetics,
    equations = function(y)
      local s, q, w = n "77.27", n "8.375e-6", n "0.161"
      return { y1 = s * (y.y2 + y.y1 - y.y1 * y.y2 - q * y.y1 ^ 2), y2 = (y.y3 - (1 + y.y1) * y.y2) / s,
        y3 = w * (y.y1 - y.y3) }
    end,
  }
  run = ambit.simulate { orego, initial = { 1, 2, 3 }, t = { 0, 360 }, solver = "stiff" }
  inside = run.status == "complete"
      and holds(run.x, kinetics, { "1.0008148703185227163", "1228.1785215498879837", "132.05549428465082877" })
  row("OREGO, stiff, to 360, reference inside", "1e-8 relative, 0.3 s", outcome(run, number(relative(run.x, kinetics))),
    inside and relative(run.x, kinetics) < 1e-8 and done(run, 0.3))
end)

section("roots", function()
  local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
  local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
  local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
  m:point_mass { at = elbow, mass = 1 }
  m:point_mass { at = hand, mass = 1 }
  local rest = ambit.equilibria { m:dynamics(), box = { beta1 = { "-3.15", 1 }, beta2 = { "-3.15", 1 } } }
  local widest = 0
  for _, point in ipairs(rest.proved) do
    widest = math.max(widest, point.beta1:width(), point.beta2:width())
  end
  row("equilibria of the double pendulum in [-3.15, 1]^2", "4 proved, 1e-12, 0.02 s, none undecided",
    ("%d proved, %s; %d undecided; %s s"):format(#rest.proved, number(widest), #rest.undecided, number(rest.cpu_seconds)),
    #rest.proved == 4 and #rest.undecided == 0 and widest < 1e-12 and rest.cpu_seconds <= 0.02)
end)

section("escape", function()
  local escape = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
  for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff" } do
    local run = ambit.simulate { escape, initial = { x = 1 }, t = { 0, 2 }, solver = solver }
    row(("x' = x^2 from 1, %s"):format(solver), solver == "lohner" and "unable, in (0.999, 1)" or "unable before 1",
      outcome(run), run.status == "unable" and run.t_reached < 1 and (solver ~= "lohner" or run.t_reached > 0.999))
  end
end)

os.exit(missed == 0 and 0 or 1)
