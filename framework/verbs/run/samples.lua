-- run/samples.lua -- which side of a sample an instant is on, and the states there (docs/numerics/instants.md).
--
-- The states leap at the true instants of clocks; a solver leaps at doubles beside them. Instants are compared exactly
-- (run/schedule.h): what was asked for lies between two samples, and only what the solver says between these is used.
local core = require "ambit.core"
local instant = require "ambit.run.instant"

local samples = {}

-- For instant.list: which double a solver steps on for an instant that is none. It is the one before, where a sample
-- leaps that is not earlier, so that one step serves both; or the one behind, if a sample lies between.
function samples.sides(system)
  return function(start, final)
    local schedule
    return function(t)
      if t.lo == t.hi then return nil end
      if schedule == nil then
        local good, made = pcall(core.schedule, system.system, start, final.hi, instant.expression(final))
        schedule = good and made -- the run will say why not
      end
      local good, before = pcall(core.schedule_around, schedule, instant.expression(t))
      return good and before and before >= t.lo and t.hi or t.lo
    end
  end
end

-- The doubles of the last sample before t and of the next one; nil: there is none in this run.
function samples.around(run, t)
  local times = run.times
  local schedule = run.schedule or core.schedule(run.system.system, times[1], times[#times], times.exact)
  run.schedule = schedule
  return core.schedule_around(schedule, t)
end

return samples
