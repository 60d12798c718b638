-- questions.lua: what is asked of solvers besides a simulation: events, switching, orbits, derivatives, proofs,
-- postures.
-- ambit run scripts/bench/questions.lua   prints a table: what, truth, measured; exit 1 where one is not proved or
-- misses the truth. Times are CPU time.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local core = require "ambit.core"
local bench = require "bench"
local problems = require "problems"

-- The result of an action, and its CPU seconds.
local function timed(action)
  local began = core.cpu()
  local result = action()
  return result, core.cpu() - began
end

bench.head("question", "truth", "measured", "")

local PERIOD, RADIUS = 6.6632868593231301897, 2.0086198608748431365 -- of Van der Pol's cycle, mu = 1, 20 digits
for _, radius in ipairs { 1e-3, 1e-11 } do
  local orbit, s = timed(function()
    return ambit.poincare {
      problems.van_der_pol(1), section = function(x) return x.v end, direction = "falling", t_max = 8,
      tolerance = 1e-14, initial = { x = ambit.around(2.008619860874843, radius), v = 0 },
    }:orbit()
  end)
  bench.figure(("Van der Pol's cycle: an orbit proved for starts within %g, its period"):format(radius), PERIOD,
    ("%.2g wide, %s"):format(orbit.period:width(), bench.seconds(s)),
    orbit.proved and orbit.period:contains(PERIOD) and orbit.x.x:contains(RADIUS))
end

do
  local run, s = timed(function() return bench.listen("bouncing_ball", { "hybrid" })[1].result end)
  bench.figure("bouncing ball, three bounces (scene `bouncing_ball`)", "each once",
    ("third in %s, %s"):format(run.events[3].t, bench.seconds(s)), run.status == "complete" and #run.events == 3)
end

do -- switches of a linear cooling and heating have closed forms
  local function mode(goal)
    return ambit.ode { states = { T = "K" }, equations = function(x) return { T = -(x.T - goal) / 5 } end }
  end
  local run, s = timed(function()
    return ambit.hybrid {
      modes = {
        off = { mode(10), guards = { { g = function(x) return x.T - 18 end, direction = "falling", to = "on" } } },
        on = { mode(30), guards = { { g = function(x) return x.T - 22 end, direction = "rising", to = "off" } } },
      },
      mode = "off", initial = { T = ambit.between(19, 20) }, t = { 0, 20 }, solver = "taylor_model",
    }
  end)
  local first, last, worst, inside = 5 * math.log(9 / 8), 5 * math.log(10 / 8), 0, true
  for n, e in ipairs(run.events) do
    local later = (n - 1) * 5 * math.log(12 / 8)
    worst = math.max(worst, e.t:width() / (last - first))
    inside = inside and e.t:contains(first + later) and e.t:contains(last + later)
  end
  bench.figure("thermostat with two modes, start 1 K wide, 10 switches: width of their times over the true one", "1",
    ("%.4f, %s"):format(worst, bench.seconds(s)), #run.events == 10 and inside)
end

do
  local names = problems.P2.names
  local run, s = timed(function()
    return ambit.sensitivity { problems.P2.system, initial = problems.P2.initial, t = { 0, 0.4 } }
  end)
  local widest, count = 0, 0
  for _, state in ipairs(names) do
    for _, wrt in ipairs(run.wrt) do
      widest, count = math.max(widest, run:d(state, wrt):width()), count + 1
    end
  end
  bench.figure("sensitivities of P2 at t = 0.4", "",
    ("%d derivatives, each within %.1g, %s"):format(count, widest, bench.seconds(s)), run.status == "complete")
end

do
  local report, s = timed(function() return bench.listen("verify_arm", { "verify" })[1].result end)
  local text = tostring(report)
  local _, proved = text:gsub(": proved", "")
  local _, refuted = text:gsub(": refuted", "")
  bench.figure("an arm with four tolerances: bounds at all times (scene `verify_arm`)", "5 hold, 1 does not",
    ("%d proved, %d refuted by an example, %s"):format(proved, refuted, bench.seconds(s)), proved == 5 and refuted == 1)
end

for i, tolerance in ipairs { "0", "0.1%" } do
  local found = bench.listen("inverse_kinematics", { "inverse_kinematics" })[i].result
  bench.figure(("all postures of a UR5 for one pose of its tool, lengths +-%s"):format(tolerance), "8",
    ("%d, %d undecided, %s"):format(#found.proved, #found.undecided, bench.seconds(found.cpu_seconds)),
    #found.proved == 8 and #found.undecided == 0)
end

do
  local function wall(threads)
    local t = problems.request(problems.P1, 2, { solver = "lohner", split = 60, threads = threads })
    return ambit.simulate(t).wall_seconds
  end
  local one, two = math.min(wall(1), wall(1), wall(1)), math.min(wall(2), wall(2), wall(2))
  bench.figure("P1 in 60 pieces (`split`): two threads against one", "2",
    ("%.2f times as fast"):format(one / two), true)
end
bench.leave()
