-- simulate/choice_reason.lua -- what is said where no solver came to the end: who was asked besides, where the width
-- came from, and how much narrower the data would have to be. Nothing is advised that was not tried.
local core = require "ambit.core"
local experiment = require "ambit.simulate.experiment"

local reason = {}

local PARTS = { { 0.01, "a hundredth" }, { 0.1, "a tenth" }, { 0.25, "a quarter" }, { 0.5, "half" } } -- of the width
local NEAR = 0.05 -- of the time that a run reached: what ends so soon after it ends with it
local LEAST, MORE = 2, 4 -- s of CPU time for all that is tried, and so many times what the run took

-- The widest of a few narrower data with which `solver` completes, as a sentence; nil: none was found in time. Narrow
-- ones first, which take least.
local function narrower(q, run, seconds, within)
  local data, found = experiment.data(q), nil
  local function completes(part) return experiment.completes(q, run.solver, data, part) end
  within(seconds, function()
    for _, part in ipairs(PARTS) do
      if not completes(part[1]) then break end
      found = ("with data %s as wide, `%s` completes"):format(part[2], run.solver)
    end
    found = found or completes(0) and ("with all data at their middles `%s` completes"):format(run.solver)
  end)
  return found
end

local function named(try)
  return ("`%s`%s"):format(try.solver, try.pieces and (" in %d parts"):format(try.pieces) or "")
end

local function besides(tried, run)
  local list = {}
  for _, try in ipairs(tried) do
    if try.run ~= run then
      list[#list + 1] = ("%s, %s"):format(named(try), try.outcome)
    end
  end
  return #list > 0 and "tried besides: " .. table.concat(list, "; ") or nil
end

local function not_asked(untried)
  local list = {}
  for i, try in ipairs(untried) do list[i] = named(try) end
  return #list > 0 and "not tried, since the CPU time for this was spent: " .. table.concat(list, ", ") or nil
end

-- The run that got furthest with the data whole: cut data say little about each datum.
local function furthest(state, run)
  local best
  for _, try in ipairs(state.tried) do
    local from = run.times[1]
    if not try.pieces and (not best or math.abs(try.run.t_reached - from) > math.abs(best.t_reached - from)) then
      best = try.run
    end
  end
  return best
end

-- Adds to the reason of a run that ended where no ordinary run comes to the end either: whether they end near there.
function reason.say_beyond(q, run)
  local first, last, reached = run.times[1], run.times[#run.times], run.t_reached
  local ahead = reached + NEAR * (reached ~= first and reached - first or last - first)
  local near = math.abs(ahead - first) < math.abs(last - first) and ahead or last
  local inner = require "ambit.sample".inner(q, 1, 1, { t = { first, near }, cpu = math.max(1, run.cpu_seconds) })
  if inner and inner.failed >= inner.draws then
    run.reason = ("%s; an ordinary run of the same data ends before t = %.4g s, too: there solutions may "
      .. "escape, or leave the domain of the equations"):format(run.reason, near)
  else
    run.reason = run.reason .. "; no ordinary run comes to the end either"
  end
end

-- Adds to the reason of a run that ended early. state: tried and untried ways, and when the CPU time for them ends;
-- within(seconds, f): calls f with its CPU time limited.
function reason.add(q, run, state, within)
  local function add(sentence) run.reason = sentence and run.reason .. "; " .. sentence or run.reason end
  add(besides(state.tried, run))
  add(not_asked(state.untried))
  if run.report.unknowns == 0 then return end
  local whole = furthest(state, run)
  local ends = math.max(core.cpu() + LEAST + MORE * whole.cpu_seconds, state.ends)
  local found, sentences = experiment.explain(q, whole, ends, within)
  run.width_from = found
  for _, sentence in ipairs(sentences) do add(sentence) end
  if not (found and found.tolerance) then add(narrower(q, whole, math.max(0.5 * LEAST, ends - core.cpu()), within)) end
end

return reason
