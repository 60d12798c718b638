-- simulate/rates.lua -- runs without the rates of functions of time, where these make sets wider.
--
-- A function of bounded rate is a state, of which each step forgets a part of what keeps it within its bounds
-- (docs/numerics/zonotope.md, 7f). Of one that crosses its range faster than the system moves, that is more than its
-- rate says. Any value within the bounds at any time holds it, too; which of the two is tighter, runs tell.
local core = require "ambit.core"

local rates = {}

-- The sets of the states that a scene wrote, at the end and at the listed times before it, by those of another run:
-- mean of the logarithms; nil: it did not get as far.
local function compare(q, run, other)
  if run.status ~= "complete" then return other.status == "complete" and -math.huge or 0 end
  if other.status ~= "complete" then return nil end
  local sum, count = 0, 0
  for k = 2, #q.times do
    local i, is_end = core.track_find(run.track, q.times[k])
    local j, ends = core.track_find(other.track, q.times[k])
    for s = 1, is_end and ends and q.system.plain or 0 do
      local a, b = core.track_value(run.track, i, s):width(), core.track_value(other.track, j, s):width()
      if a > 0 and b > 0 then sum, count = sum + math.log(b / a), count + 1 end
    end
  end
  return count > 0 and sum / count or 0
end

-- May another run take the place of this one? Not of one that was stopped, that shows a plugin to be broken, or that
-- found events: the times of these are what was asked for.
local function may_change(q, run)
  return not q.watch and run.status ~= "stopped" and run.status ~= "broken"
end

-- The run, or a tighter one that forgets rates, from the fastest function on. solve: makes a run of a request.
function rates.tightest(q, run, solve)
  local seconds = run.cpu_seconds
  for count = 1, may_change(q, run) and #q.system.carried or 0 do
    local asked = run.solver == q.solver and q or q.by(run.solver)
    core.records_hold()
    local good, other = pcall(solve, setmetatable({ system = q.without_rates(count).system }, { __index = asked }))
    local gain = good and compare(q, run, other)
    local is_next = good and (other.status == "broken" or gain and gain < 0)
    core.records_release(is_next)
    if not good then error(other, 0) end
    seconds = seconds + other.cpu_seconds
    if not is_next then break end
    other.solver_reason, run = run.solver_reason, other
    if not may_change(q, run) then break end
  end
  run.cpu_seconds = seconds
  return run
end

return rates
