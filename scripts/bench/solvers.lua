-- solvers.lua: do the validated solvers reach the figures that were asked of them?
-- ambit run scripts/bench/solvers.lua [NAME ...]   prints a table: what, required, measured, verdict; exit 1 if one is
-- missed. NAME: P1 P2 P3 P4 P5 P6 stiff roots escape; none: all. Times are CPU seconds of the run itself, the least of
-- several. scripts/bench/peers.lua holds the same problems against other programs.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"
local problems = require "problems"
local around, number, numbers = ambit.around, bench.number, bench.numbers

local function outcome(run, seconds, extra)
  local text = run.status == "complete" and bench.seconds(seconds)
    or ("%s at %s after %s"):format(run.status, number(run.t_reached), bench.seconds(seconds))
  return extra and extra .. "; " .. text or text
end

-- Does the run reach its end within so many seconds?
local function done(run, seconds, most) return run.status == "complete" and seconds <= most end

local function go(problem, t, settings) return bench.simulate(problems.request(problem, t, settings)) end

local parts = {}

function parts.P1()
  local P1, names = problems.P1, problems.P1.names
  local run, s = go(P1, 1, { solver = "taylor_model" })
  local w, near = bench.widths(run.x, names), true
  for i, x in ipairs { .0128, .1229, .6294, 1.0191 } do near = near and w[i] <= 1.01 * (x + 5e-5) end -- half a digit
  bench.figure("P1, `taylor_model`, widths at t = 1", "true .0128 .1229 .6294 1.0191 +1 %, 20 ms",
    outcome(run, s, numbers(w)), near and done(run, s, 0.02))
  run, s = go(P1, 3, { solver = "taylor_model", pieces_max = 1 })
  bench.figure("... in one piece to t = 3", "50 ms", outcome(run, s), done(run, s, 0.05))
  run, s = go(P1, 5, { solver = "taylor_model" })
  bench.figure("... split where it must, to t = 5", "0.4 s", outcome(run, s), done(run, s, 0.4))
  run, s = go(P1, 7, { solver = "taylor_model" })
  bench.figure("... to t = 7", "3 s", outcome(run, s), done(run, s, 3))
  run, s = go(problems.P1_wide, 1, { solver = "taylor_model" })
  bench.figure("... angle known to 10 %, to t = 1", "0.1 s", outcome(run, s), done(run, s, 0.1))
  run, s = go(P1, 2, { solver = "lohner" })
  bench.figure("P1, `lohner`, proves to", "0.69", outcome(run, s), run.t_reached > 0.69)
  local valencia = { solver = "valencia", arithmetic = { "taylor_model", order = 10 } }
  run, s = go(P1, 0.5, valencia)
  bench.figure("P1, `valencia`, to t = 0.5", "1 s", outcome(run, s, numbers(bench.widths(run.x, names))),
    done(run, s, 1))
  run, s = go(P1, 2, valencia)
  bench.figure("P1, `valencia`, proves to", "1.0", outcome(run, s), run.t_reached > 1)
end

function parts.P2()
  local P2, names = problems.P2, problems.P2.names
  local run, s = go(P2, 10, { solver = "lohner" })
  local w = bench.largest(run.x, names)
  bench.figure("P2, `lohner`, to t = 10, largest width", "2e-10, 15 ms", outcome(run, s, number(w)),
    w < 2e-10 and done(run, s, 0.015))
  run, s = go(P2, 10, { solver = "lohner", order = 20 })
  bench.figure("P2, `lohner`, order 20, a step", "30 us", bench.seconds(s / run.step_count),
    s / run.step_count <= 30e-6)
  run = ambit.simulate(problems.request(P2, 32, { solver = "lohner" }))
  local first, last = bench.stays_under(run, names, 1e-3)
  bench.figure("P2, `lohner`, first over, last under 1e-3", "29", ("%.2f, %.2f"):format(first, last), last > 29)
end

function parts.P3()
  local P3, names = problems.P3, problems.P3.names
  local run, s = go(P3, 20, { solver = "lohner" })
  local w = bench.largest(run.x, names)
  bench.figure("P3, `lohner`, to t = 20, largest width", "1e-4, 6 ms", outcome(run, s, number(w)),
    w < 1e-4 and done(run, s, 0.006))
  run = ambit.simulate(problems.request(P3, 26, { solver = "lohner" }))
  local first, last = bench.stays_under(run, names, 1e-3)
  bench.figure("P3, `lohner`, first over, last under 1e-3", "24", ("%.2f, %.2f"):format(first, last), last > 24)
end

function parts.P4()
  local run, s = go(problems.P4, nil, { solver = "taylor_model" })
  local w = bench.widths(run.x, problems.P4.names)
  bench.figure("P4, `taylor_model`, to t = 7, widths", ".147 x .591 +10 %, 0.5 s", outcome(run, s, numbers(w)),
    w[1] <= .147 * 1.1 and w[2] <= .591 * 1.1 and done(run, s, 0.5))
end

-- A problem with reference digits: relative width, reference inside, time.
local function stiff(what, problem, required, relative, most)
  local run, s = go(problem, nil, { solver = "stiff" })
  local w = bench.relative(run.x, problem.names)
  local good = run.status == "complete" and (not problem.digits or bench.holds(run.x, problem.names, problem.digits))
  bench.figure(what, required, outcome(run, s, number(w)), good and w < relative and s <= most)
end

function parts.P5()
  stiff("P5, Van der Pol, mu = 1000, `stiff`, to t = 2000, relative width", problems.P5_van_der_pol, "2e-8, 0.3 s",
    2e-8, 0.3)
  stiff("... mu = 1e5, one period", problems.P5_period, "complete", math.huge, math.huge)
  stiff("P5, Robertson, `stiff`, to t = 1e9, relative width", problems.robertson(1e9), "0.1 s", math.huge, 0.1)
  stiff("... to t = 1e11", problems.robertson(1e11), "1 s", math.huge, 1)
  local rates = problems.robertson(1e4, around("0.04", "1%"), around(3e7, "1%"), around(1e4, "1%"))
  local run, s = go(rates, nil, { solver = "stiff" })
  bench.figure("... rates known to 1 %, to t = 1e4, widths", "complete",
    outcome(run, s, numbers(bench.widths(run.x, rates.names))), run.status == "complete")
  run, s = go(problems.P5_linear, nil, { solver = "stiff" })
  bench.figure("P5, y' = -1000 (y - cos t), `stiff`, to t = 2000, width", "0.1 s",
    outcome(run, s, number(run.x.y:width())), done(run, s, 0.1))
end

function parts.P6()
  local run, s = go(problems.P6_pendulum, nil, { solver = "lohner" })
  local w = bench.largest(run.x, problems.P6_pendulum.names)
  bench.figure("P6, pendulum, `lohner`, to t = 100, largest width", "3.3e-12, 10 ms", outcome(run, s, number(w)),
    w < 3.3e-12 and done(run, s, 0.01))
end

function parts.stiff()
  stiff("HIRES, `stiff`, to 321.8, relative width", problems.hires, "1e-8, 0.3 s", 1e-8, 0.3)
  stiff("OREGO, `stiff`, to 360, relative width", problems.orego, "1e-8, 0.3 s", 1e-8, 0.3)
end

function parts.roots()
  local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
  local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
  local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
  m:point_mass { at = elbow, mass = 1 }
  m:point_mass { at = hand, mass = 1 }
  local rest = ambit.equilibria { m:dynamics(), box = { beta1 = { "-3.15", 1 }, beta2 = { "-3.15", 1 } } }
  local widest = 0
  for _, point in ipairs(rest.proved) do widest = math.max(widest, point.beta1:width(), point.beta2:width()) end
  bench.figure("equilibria of the double pendulum in [-3.15, 1]^2", "4 proved, none undecided, 1e-12, 20 ms",
    ("%d proved, %d undecided; %s; %s"):format(#rest.proved, #rest.undecided, number(widest),
      bench.seconds(rest.cpu_seconds)),
    #rest.proved == 4 and #rest.undecided == 0 and widest < 1e-12 and rest.cpu_seconds <= 0.02)
end

function parts.escape()
  for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff" } do
    local run, s = go(problems.escape, nil, { solver = solver })
    bench.figure(("x' = x^2 from 1, `%s`"):format(solver), solver == "lohner" and "unable, in (0.999, 1)"
      or "unable before 1", outcome(run, s),
      run.status == "unable" and run.t_reached < 1 and (solver ~= "lohner" or run.t_reached > 0.999))
  end
end

bench.head("figure", "required", "measured", "")
for _, name in ipairs { "P1", "P2", "P3", "P4", "P5", "P6", "stiff", "roots", "escape" } do
  if bench.wants(name) then parts[name]() end
end
bench.leave()
