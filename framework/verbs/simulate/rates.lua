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

-- The run, or a tighter one that forgets rates, from the fastest function on. solve: makes a run of a request.
function rates.tightest(q, run, solve)
  local seconds = run.cpu_seconds
  for count = 1, #q.system.carried do
    local asked = run.solver == q.solver and q or q.by(run.solver)
    local other = solve(setmetatable({ system = q.without_rates(count).system }, { __index = asked }))
    seconds = seconds + other.cpu_seconds
    local gain = compare(q, run, other)
    if not gain or not (gain < 0) then break end
    other.solver_reason, run = run.solver_reason, other
  end
  run.cpu_seconds = seconds
  return run
end

return rates
