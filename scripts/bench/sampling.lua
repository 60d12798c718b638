-- sampling.lua: how fast are draws, and how near do their hulls come to the true range?
-- ambit run scripts/bench/sampling.lua [NAME ...]   NAME: tip systems hull; none: all. Exit 1 if a figure is missed.
-- Wall times are the least of several; the two ways to sample a system take turns.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"
local problems = require "problems"
local around = ambit.around

local parts = {}
local TURNS = 3

local function tool()
  local folder = arg[0]:match ".*/" or "./"
  local arm = ambit.load {
    folder .. "../robots/ur5.urdf", gravity = { 0, 0, "-9.81" },
    tolerances = { ["*_joint.offset"] = "0.2%", ["tool0_fixed_joint.offset"] = 0 },
  }
  local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
    "wrist_3_joint" }
  local tip, at = arm:position(arm.links.tool0), {}
  for i, angle in ipairs { "0.1", "-0.5", "0.9", "0.3", "-0.7", "1.1" } do at[joints[i]] = around(angle, "0.5 deg") end
  return { tip.x, tip.y, tip.z, at = at, arm = arm } -- names of its joints hold as long as the arm
end

local function widths(hull) return bench.numbers { hull[1]:width(), hull[2]:width(), hull[3]:width() } end

-- Both ways in turn: the result and the least of the key's values of each.
local function in_turn(key, first, second)
  local a, b, least_a, least_b
  for _ = 1, TURNS do
    a, b = first(), second()
    least_a, least_b = math.min(least_a or math.huge, a[key]), math.min(least_b or math.huge, b[key])
  end
  return a, least_a, b, least_b
end

function parts.tip()
  local q = tool()
  local function draw(points)
    return function()
      local result = ambit.sample { { q[1], q[2], q[3] }, at = q.at, n = 1000000, points = points, polish = false }
      return { hull = result, wall = result.wall_seconds, threads = result.threads, unknowns = result.report.unknowns }
    end
  end
  local sobol, seconds, random, seconds_random = in_turn("wall", draw "sobol", draw "random")
  bench.figure(("10^6 tips of the UR5, %d uncertain data, Sobol's points"):format(sobol.unknowns), "1 s of wall time",
    ("%s with %d threads"):format(bench.seconds(seconds), sobol.threads), seconds < 1)
  bench.figure("... pseudo-random points", "", bench.seconds(seconds_random), true)
  bench.figure("... width of the hull: Sobol, random", "", widths(sobol.hull) .. "; " .. widths(random.hull), true)
  local polished = ambit.sample { { q[1], q[2], q[3] }, at = q.at, n = 1000 }
  bench.figure(("1000 draws, extremes followed (%d evaluations more)"):format(polished.polished), "as wide",
    ("%s in %s"):format(widths(polished), bench.seconds(polished.cpu_seconds)),
    polished[1]:width() >= sobol.hull[1]:width() * (1 - 1e-9))
end

local function systems()
  local decay = ambit.ode { states = { "x", "y" }, parameters = { a = around(1, "10%") },
    equations = function(s, p) return { x = s.y, y = -p.a * s.x - "0.1" * s.y } end }
  local lorenz = ambit.ode { states = { "x", "y", "z" }, parameters = { r = around(28, "0.1%") },
    equations = function(s, p)
      return { x = 10 * (s.y - s.x), y = s.x * (p.r - s.z) - s.y, z = s.x * s.y - 8 / 3 * s.z }
    end }
  return {
    { "damped oscillator, t = 20", { decay, initial = { x = around(1, "0.1"), y = 0 }, t = { 0, 20 } } },
    { "Lorenz, t = 5", { lorenz, initial = { x = around(15, "0.01"), y = 15, z = 36 }, t = { 0, 5 } } },
    { "double pendulum (P1), t = 3", problems.request(problems.P1, 3, {}) },
  }
end

function parts.systems()
  for _, entry in ipairs(systems()) do
    local function draw(solver)
      return function()
        local q = { n = 2000, threads = 1, polish = false, solver = solver }
        for key, value in pairs(entry[2]) do q[key] = value end
        return ambit.sample(q)
      end
    end
    local lanes, fast, alone, slow = in_turn("cpu_seconds", draw(nil), draw "gsl")
    local apart = 0
    for name, x in pairs(lanes.x) do
      apart = math.max(apart, math.abs(x.lo - alone.x[name].lo), math.abs(x.hi - alone.x[name].hi))
    end
    bench.figure(("2000 draws of %s"):format(entry[1]), "faster in lanes than one by one",
      ("%s against %s: %.1f times; hulls apart by %.1g"):format(bench.seconds(fast), bench.seconds(slow), slow / fast,
        apart), fast < slow)
  end
end

-- What following the extremes is worth: x'' = -k x - c x' with five uncertain data.
function parts.hull()
  local o = ambit.ode { states = { "x", "v" },
    parameters = { k = around(1, "5%"), c = around("0.1", "5%"), f = around("0.2", "5%") },
    equations = function(s, p) return { x = s.v, v = p.f - p.k * s.x - p.c * s.v } end }
  local q = { o, initial = { x = around(1, "5%"), v = around("0.3", "5%") }, t = { 0, 5 } }
  local function width(n, polish)
    local t = { n = n, polish = polish, threads = 1 }
    for key, value in pairs(q) do t[key] = value end
    local s = ambit.sample(t)
    return s.x.x:width(), s
  end
  local many, most = width(100000, false)
  local plain = width(100, false)
  local followed, few = width(100, true)
  bench.figure("oscillator, width of x: 100 draws of the width of 10^5", "99 % with their extremes followed",
    ("%.2f %%, %.2f %% followed; %s against %s"):format(100 * plain / many, 100 * followed / many,
      bench.seconds(few.cpu_seconds), bench.seconds(most.cpu_seconds)), followed > 0.99 * many)
end

bench.head("what", "required", "measured", "")
for _, name in ipairs { "tip", "systems", "hull" } do if bench.wants(name) then parts[name]() end end
bench.leave()
