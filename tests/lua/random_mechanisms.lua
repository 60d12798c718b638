-- random_mechanisms.lua -- does any motion of a random mechanism leave what was proved about it?
--   ambit run tests/lua/random_mechanisms.lua [--solver NAME] [--mechanisms N] [--draws N] [--seed N] [--seconds S]
--     [--oracle S] [--joints N] [--data N] [--time T] [--beyond X] [--varying] [--verbose]
--
-- Trees, plane and spatial loops of 3 to 12 joints, ball joints as quaternions among them, some tied by gears or as
-- mimic joints, some with given motions, friction or PD control, with 5 to 40 data of .01 to 5 % are simulated;
-- motions of drawn mechanisms, half of them corners of the data, are integrated in extended precision by formulas that
-- share nothing with Ambit's (tests/oracle/multibody.h) and must lie inside, at ends of steps and between. Needs the
-- test module `multibody` in LUA_CPATH. Full length: --mechanisms 200 --draws 500. Without --solver each mechanism is
-- run by the solver that suits. --seconds: CPU time after which a run is stopped; what it proved until then is
-- checked. --oracle: CPU time after which no more motions of a mechanism are drawn: stiff ones cost 10 s each. --beyond
-- 2: data are drawn from twice their tolerances, so that motions must be found outside. --varying: much of what acts in
-- joints varies in time; half of the torques are drawn as waves. Exit 1 if a motion is outside.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"
local folder = arg[0]:match ".*/" or "./"
package.path = folder .. "?.lua;" .. package.path
local random_mechanism = require "random_mechanism"

local function options()
  local o = { mechanisms = 20, draws = 20, seed = 1, seconds = 20, oracle = 1e9, joints = 12, data = 40, time = 0.5, beyond = 1 }
  local i = 1
  while arg[i] do
    local key = arg[i]:match "^%-%-(%a+)$"
    if key == "verbose" or key == "varying" then
      o[key], i = true, i + 1
    elseif key == "solver" then
      o.solver, i = arg[i + 1], i + 2
    elseif key and o[key] and tonumber(arg[i + 1]) then
      o[key], i = tonumber(arg[i + 1]), i + 2
    else
      io.stderr:write(("random_mechanisms.lua: unknown or incomplete option `%s`\n"):format(arg[i]))
      os.exit(2)
    end
  end
  return o
end

local o = options()
local total = { fewer = 0, lost = 0, motions = 0, values = 0, outside = 0, complete = 0, nothing = 0, share = 0, skipped = 0 }

-- Instants at which is looked: ends of steps (tight), and times between.
local function instants(run, r)
  local ends, list = {}, {}
  for step in run:steps() do ends[#ends + 1] = step.t end
  if #ends == 0 then return list end
  local n = math.min(#ends, 6)
  for k = 1, n do list[k] = ends[1 + (k - 1) * (#ends - 1) // math.max(1, n - 1)] end
  for _ = 1, 6 do list[#list + 1] = run.t_reached * r.unit() end
  table.sort(list)
  local apart = {}
  for _, t in ipairs(list) do
    if t > 0 and t ~= apart[#apart] then apart[#apart + 1] = t end
  end
  return apart
end

-- How far a motion is outside, and where: the largest distance in 1 + |x|, less what the oracle may be off.
local function compare(enclosures, motion, mechanism)
  local worst, where = 0, nil
  for k, x in ipairs(enclosures) do
    for name, value in pairs(motion[k]) do
      local set = x[name]
      total.values = total.values + 1
      local off = math.max(set.lo - value, value - set.hi) / (1 + math.abs(value)) - mechanism.slack
      if off > worst or off ~= off then
        worst, where = off, ("%s at t = %.17g is %.17g, proved %s"):format(name, x.t, value, set)
      end
    end
  end
  return worst, where
end

-- The oracle against itself: with steps of another length.
local function slack_of(mechanism, times)
  local fine, coarse = mechanism.motion({}, times, 1e-16), mechanism.motion({}, times, 1e-14)
  if not fine or not coarse then return nil end
  local apart = 0
  for k in ipairs(times) do
    for name, value in pairs(fine[k]) do
      apart = math.max(apart, math.abs(value - coarse[k][name]) / (1 + math.abs(value)))
    end
  end
  return 1e-14 + 10 * apart
end

local function simulate(mechanism, r)
  local times = { 0, o.time * r.unit(), o.time }
  local question = mechanism.question()
  question.t, question.solver, question.dense, question.threads = times, o.solver, true, 1
  core.deadline(core.cpu() + o.seconds)
  local good, run = pcall(ambit.simulate, question)
  core.deadline(nil)
  session.worst = "ok" -- runs may well be unable
  return good and run, good or run
end

local function check(mechanism, run, r)
  local times = instants(run, r)
  if #times == 0 then
    total.nothing = total.nothing + 1
    return "nothing proved"
  end
  mechanism.slack = slack_of(mechanism, times)
  if not mechanism.slack or mechanism.slack > 1e-9 then
    total.skipped = total.skipped + 1
    return "the oracle does not know it"
  end
  local enclosures = {}
  for k, t in ipairs(times) do
    enclosures[k] = run:at(t)
    rawset(enclosures[k], "t", t)
  end
  local outside, lost, start = 0, 0, core.cpu()
  for draw = 1, o.draws do
    if core.cpu() - start > o.oracle then
      total.fewer = total.fewer + 1
      break
    end
    local drawn = r.draw(mechanism.data, draw, o.beyond)
    local motion = mechanism.motion(drawn, times, 1e-16) or mechanism.motion(drawn, times, 1e-14) -- in the slack
    local off, where = 0, nil
    if motion then
      total.motions = total.motions + 1
      off, where = compare(enclosures, motion, mechanism)
    else
      lost = lost + 1
    end
    if off > 0 or off ~= off then
      outside = outside + 1
      print(("OUTSIDE by %.3g: mechanism %s, draw %d: %s"):format(off, mechanism.name, draw, where))
    end
  end
  total.outside, total.lost = total.outside + outside, total.lost + lost
  return (outside == 0 and "inside" or outside .. " outside") .. (lost > 0 and (", %d lost"):format(lost) or "")
end

for k = 1, o.mechanisms do
  local r = random_mechanism.source(1000003 * o.seed + k)
  local mechanism = random_mechanism.new(r, o)
  local run, problem = simulate(mechanism, r)
  local verdict = run and check(mechanism, run, r) or "refused: " .. tostring(problem)
  if not run then total.outside = total.outside + 1 end -- every scene made here is a valid one
  if run then
    total.share = total.share + run.t_reached / o.time
    if run.status == "complete" then total.complete = total.complete + 1 end
  end
  if o.verbose or not run then
    print(("%4d  %-44s %-12s %-8s to %.4g in %.2f s: %s"):format(k, mechanism.name, run and run.solver or "-",
      run and run.status or "-", run and run.t_reached or 0, run and run.cpu_seconds or 0, verdict))
  end
end
print(("%d mechanisms, %d complete, %d nothing proved, %d unknown to the oracle, %.0f %% of the time; \z
  %d motions, %d values: %d outside"):format(o.mechanisms, total.complete, total.nothing, total.skipped,
  100 * total.share / o.mechanisms, total.motions, total.values, total.outside))
if total.lost + total.fewer > 0 then
  print(("%d more motions were lost by the oracle; of %d mechanisms fewer were drawn than asked for"):format(total.lost,
    total.fewer))
end
os.exit(total.outside == 0 and total.lost * 100 <= total.motions and 0 or 1)
