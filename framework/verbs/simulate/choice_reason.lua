-- simulate/choice_reason.lua -- what is said where no solver came to the end: who was asked besides, and how much
-- narrower the data would have to be. Nothing is advised that was not tried.
local core = require "ambit.core"
local flow = require "ambit.run.flow"
local uncertain = require "ambit.run.uncertain"

local reason = {}

local PARTS = { { 0.5, "half" }, { 0.25, "a quarter" }, { 0.1, "a tenth" }, { 0.01, "a hundredth" } } -- of the width
local LEAST = 1 -- s of CPU time for all that is tried, if the tries of other solvers left less

local function uncertain_data(q)
  local all = table.move(q.initial, 1, #q.initial, 1, {})
  table.move(q.system.rates or {}, 1, #(q.system.rates or {}), #all + 1, all)
  return uncertain.data(all)
end

-- Does the solver come to the end with each datum cut to this part of its width, about its middle?
local function completes(q, solver, part, data)
  local own, lo, hi = q.by(solver), {}, {}
  for j, a in ipairs(data.lo) do
    local b = data.hi[j]
    local mid, half = 0.5 * a + 0.5 * b, 0.5 * part * (b - a)
    lo[j], hi[j] = math.max(a, mid - half), math.min(b, mid + half)
  end
  local _, outcome = core.watch(flow(own), { unknowns = data.unknowns, lo = lo, hi = hi })
  return outcome.status == "complete"
end

-- The widest of a few narrower data with which `solver` completes, as a sentence; nil: none was found in time.
local function narrower(q, run, ends, within)
  local data, found = {}, nil
  data.unknowns, data.lo, data.hi = uncertain_data(q)
  within(math.max(LEAST, ends - core.cpu()), function()
    for _, part in ipairs(PARTS) do
      if completes(q, run.solver, part[1], data) then
        found = ("with data %s as wide, `%s` completes"):format(part[2], run.solver)
        return
      end
    end
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

-- Adds to the reason of a run that ended early. state: tried and untried ways, and when the CPU time for them ends;
-- within(seconds, f): calls f with its CPU time limited.
function reason.add(q, run, state, within)
  local function add(sentence) run.reason = sentence and run.reason .. "; " .. sentence or run.reason end
  add(besides(state.tried, run))
  add(not_asked(state.untried))
  if run.report.unknowns > 0 then add(narrower(q, run, state.ends, within)) end
end

return reason
