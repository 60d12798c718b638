-- peers.lua: the problems on which other validated solvers were run, and by what factor Ambit is better.
-- ambit run scripts/bench/peers.lua [NAME ...]   prints a table for each of P1 P2 P3 P4 P5 P6; exit 1 where a peer is
-- better by more than its last digit. Figures of peers are quoted (run once, two shared Zen 4 cores: CAPD 5 with C0
-- sets of order 20, VNODE-LP, kv with affine mean values; Flow* was found not to enclose; or the papers named). Ours
-- are measured now: enclosures, CPU seconds of the run, the least of several. A factor over 1 is in our favour.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"
local problems = require "problems"
local number, numbers = bench.number, bench.numbers

local function go(problem, t, settings) return bench.simulate(problems.request(problem, t, settings)) end

local function head(name, title)
  print(("\n**%s** %s\n"):format(name, title))
  bench.head("question", "best peer", "Ambit", "factor")
end

-- One question; the factor says how much better we are. `more`: greater figures are better.
local function row(question, peer, theirs, solver, text, ours, more)
  local factor = more and ours / theirs or theirs / ours
  if factor < 0.995 then bench.missed = bench.missed + 1 end
  bench.line(question, peer, ("%s (`%s`)"):format(text, solver), ("%.3g"):format(factor))
end

-- The largest of width over true width.
local function over(widths, truth)
  local most = 0
  for i, w in ipairs(widths) do most = math.max(most, w / truth[i]) end
  return most
end

-- When the largest width is over a bound for the first time; what is reached where it never is.
local function break_down(run, names, bound)
  for step in run:steps() do
    if bench.largest(step.x, names) > bound then return step.t end
  end
  return run.t_reached
end

local valencia = { solver = "valencia", arithmetic = { "taylor_model", order = 10 } }

local parts = {}

function parts.P1()
  local P1, names = problems.P1, problems.P1.names
  head("P1", "double pendulum, relative angles (3 pi/4 +-1 %, -11 pi/20, 0.43, 0.67)")
  local broken = { "kv .618 to .684 (CAPD .603, VNODE-LP .538 to .566)", "papers of 2006: RiOT .820 in 9312 s",
    "papers of 2006: COSY VI .63 to > 1.0, hours" }
  local best = { .684, .82, 1 }
  for i, s in ipairs { { solver = "lohner" }, valencia, { solver = "taylor_model", pieces_max = 1 } } do
    local run = ambit.simulate(problems.request(P1, 5, s))
    local t = break_down(run, names, 10)
    row("proved until the width is 10", broken[i], best[i], s.solver, ("%.3g"):format(t), t, true)
  end
  local truth = { { .0715, .0611, .1188, .3658 }, { .0865, .1085, .1983, .6149 }, { .0128, .1229, .6294, 1.0191 } }
  local theirs = {
    { "kv", { .0746, .0667, .155, .432 } }, { "kv", { .0966, .128, .329, .906 } },
    { "CAPD in 64 hand-made pieces", { .017, .127, .637, 1.034 } },
  }
  local quick = { { "CAPD", .017 }, { "CAPD", .023 }, { "CAPD in 64 pieces (32: 2.4 s)", 4.9 } }
  for i, t in ipairs { 0.4, 0.5, 1 } do
    local question = ("overestimation at t = %g"):format(t)
    for _, s in ipairs { { solver = "taylor_model" }, valencia, { solver = "lohner" } } do
      if t < 1 or s.solver == "taylor_model" then
        local run, seconds = go(P1, t, s)
        local w = bench.widths(run.x, names)
        row(question, ("%s %s: %.3g"):format(theirs[i][1], numbers(theirs[i][2]), over(theirs[i][2], truth[i])),
          over(theirs[i][2], truth[i]), s.solver, ("%s: %.3g"):format(numbers(w), over(w, truth[i])), over(w, truth[i]))
        if s.solver == "taylor_model" then
          row(("CPU to t = %g"):format(t), ("%s %s"):format(quick[i][1], bench.seconds(quick[i][2])), quick[i][2],
            s.solver, bench.seconds(seconds), seconds)
        end
      end
    end
  end
  local _, seconds = go(P1, 0.504, valencia)
  row("CPU of the method of the ValEncIA-IVP paper to t = 0.504", "12 to 294 s (paper, 2006)", 12, "valencia",
    bench.seconds(seconds), seconds)
end

-- Widths at some instants, CPU, steps, how long narrow: of problems that start at a point.
local function from_a_point(problem, solver, q)
  for i, t in ipairs(q.instants) do
    local run, seconds = go(problem, t, { solver = solver, order = q.order })
    local w = bench.largest(run.x, problem.names)
    row(("largest width at t = %g"):format(t), q.width[i][1], q.width[i][2], solver,
      ("%s in %s"):format(number(w), bench.seconds(seconds)), w)
  end
  local run, seconds = go(problem, q.to, { solver = solver })
  row(("CPU to t = %g"):format(q.to), q.cpu[1], q.cpu[2], solver, bench.seconds(seconds), seconds)
  if q.step then
    local us = 1e6 * seconds / run.step_count
    row("CPU of a step, us", q.step[1], q.step[2], solver, ("%.3g in %d steps"):format(us, run.step_count), us)
  end
  if q.until_t then
    local long = ambit.simulate(problems.request(problem, q.until_t[3], { solver = solver }))
    local first, last = bench.stays_under(long, problem.names, 1e-3)
    row("width under 1e-3 for the last time at", q.until_t[1], q.until_t[2], solver,
      ("%.4g, over it first at %.4g"):format(last, first), last, true)
  end
end

function parts.P2()
  head("P2", "the same from the point")
  from_a_point(problems.P2, "lohner", { instants = { 1, 5, 10 },
    width = { { "kv 1.1e-12", 1.1e-12 }, { "kv 1.2e-10", 1.2e-10 },
      { "kv 1.9e-10 (CAPD 1.2e-8, VNODE-LP 2e-8)", 1.9e-10 } },
    to = 10, cpu = { "CAPD .83 s (VNODE-LP 1.38, kv 18)", .83 },
    step = { "CAPD 1300 in 636 steps (VNODE-LP 2830, kv 40 000)", 1300 },
    until_t = { "kv beyond 27 (CAPD 21.2, VNODE-LP 19.0)", 27, 32 } })
end

function parts.P3()
  head("P3", "Lorenz's equations from (15, 15, 36)")
  from_a_point(problems.P3, "lohner", { instants = { 10, 20 }, order = 20,
    width = { { "kv 3.2e-8 (CAPD 2.3e-7)", 3.2e-8 }, { "kv 8.1e-5 (CAPD 5.9e-4, VNODE-LP 1.2e-3)", 8.1e-5 } },
    to = 20, cpu = { "CAPD .124 s (VNODE-LP .38, kv 2.2)", .124 },
    step = { "CAPD 145 in 857 steps", 145 },
    until_t = { "kv 23.5 (CAPD 21.8, VNODE-LP 20.4)", 23.5, 26 } })
end

function parts.P4()
  local P4 = problems.P4
  head("P4", "Van der Pol, mu = 1, from [1.25, 1.55] x [2.35, 2.45], to t = 7")
  local run, seconds = go(P4, nil, { solver = "taylor_model" })
  row("proved until", "kv 3.29 (CAPD 2.4, VNODE-LP 2.3)", 3.29, "taylor_model", number(run.t_reached), run.t_reached,
    true)
  local w = bench.widths(run.x, P4.names)
  row("overestimation at t = 7 (true .1042 x .4360)", "Flow* .147 x .591, not proved: 1.41", 1.41, "taylor_model",
    ("%s: %.4g"):format(numbers(w), over(w, { .1042, .4360 })), over(w, { .1042, .4360 }))
  bench.line("CPU to t = 7", "none", bench.seconds(seconds) .. " (`taylor_model`)", "")
end

-- Time to get as far as the best peer in its 60 s.
local function stiff(what, problem, peer, reach)
  local run, seconds = go(problem, nil, { solver = "stiff" })
  row(what .. ": t reached", peer, reach, "stiff", ("%s in %s"):format(number(run.t_reached), bench.seconds(seconds)),
    run.t_reached, true)
  local _, same = go(problem, reach, { solver = "stiff" })
  row("... CPU to the t of that peer", "60 s", 60, "stiff", bench.seconds(same), same)
end

function parts.P5()
  head("P5", "stiff, peers for 60 s")
  stiff("Van der Pol, mu = 1000, from (2, 0)", problems.P5_van_der_pol, "CAPD 829 (VNODE-LP 652, kv 6.9)", 829)
  stiff("Robertson", problems.robertson(1e11), "CAPD 319 (VNODE-LP 48, kv 4.5)", 319)
  local _, seconds = go(problems.P5_linear, nil, { solver = "stiff" })
  row("y' = -1000 (y - cos t) to 2000: CPU", "CAPD 11.6 s", 11.6, "stiff", bench.seconds(seconds), seconds)
end

function parts.P6()
  head("P6", "oscillators to t = 100")
  local pendulum, linear = problems.P6_pendulum, problems.P6_linear
  local run, seconds = go(pendulum, nil, { solver = "lohner" })
  local w = bench.largest(run.x, pendulum.names)
  row("pendulum from (1, 0): largest width", "kv 8.5e-13 (CAPD 3.3e-12, VNODE-LP 4e-12)", 8.5e-13, "lohner",
    number(w), w)
  row("... CPU", "CAPD .054 s (VNODE-LP .126, kv 2.2)", .054, "lohner", bench.seconds(seconds), seconds)
  run = ambit.simulate(problems.request(linear, nil, { solver = "stiff" }))
  w = bench.largest(run.x, linear.names)
  row("x'' = -x: largest width", "CAPD 4e-14", 4e-14, "stiff", ("%s in %s"):format(number(w),
    bench.seconds(run.cpu_seconds)), w)
  _, seconds = go(linear, nil, { solver = "lohner" })
  row("... CPU", "CAPD 1.2 ms", 1.2e-3, "lohner", bench.seconds(seconds), seconds)
end

for _, name in ipairs { "P1", "P2", "P3", "P4", "P5", "P6" } do
  if bench.wants(name) then parts[name]() end
end
bench.leave()
