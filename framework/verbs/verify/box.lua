-- verify/box.lua -- one run over a box of the uncertain data, and what it says about the conditions: each is proved for
-- the whole box, disproved for the whole box, or left open (framework/verbs/verify/watch.h).
--
-- A box is { lo, hi } (a number for each uncertain datum); a run adds a finding for each condition [1], [2], ... and
-- the outcome of the run. job: request (as simulate's), times, conditions { name, kind, g }, outputs { [k] = state that
-- carries condition k }, unknowns { expression }, lo, hi, inner { lo, hi } (uncertain.lua), budget
-- { runs = number } or { seconds = number }, runs, start.
local code = require "ambit.code"
local core = require "ambit.core"
local flow = require "ambit.run.flow"

local box = {}

local PATIENCE = 2 -- s of CPU time after which a run that makes no way ends, where other solvers can be asked
local CUTS = 64 -- in time, for a condition in a step of a run

-- What a run watches: each condition and, where it is carried as a state, that state behind all of them.
local function watched(job)
  local list, of = {}, {}
  local function add(expression, k)
    list[#list + 1] = { g = expression, name = job.conditions[k].name, kind = job.conditions[k].kind }
    of[#list] = k
  end
  for k, condition in ipairs(job.conditions) do add(condition.g, k) end
  for k in ipairs(job.conditions) do
    if job.outputs[k] then add(job.outputs[k], k) end
  end
  return list, of
end

-- Two findings of the same condition: both are true.
local function join(a, b)
  if not a then return b end
  local seen = a.value and a or b
  return { holds = a.holds or b.holds, fails = a.fails or b.fails, undefined = a.undefined and b.undefined,
    lo = math.max(a.lo, b.lo), hi = math.min(a.hi, b.hi), when = seen.when, value = seen.value,
    worst = a.hi < b.hi and a.worst or b.worst }
end

function box.is_spent(job)
  if job.stopped then return true end
  if job.budget.seconds then return core.cpu() - job.start >= job.budget.seconds end
  return job.runs > job.budget.runs
end

-- Runs over the box `b`; what it is a part of is in b.part_of.
function box.run(job, b)
  local q = job.request
  job.runs = job.runs + 1
  local conditions, of = watched(job)
  local findings, outcome, report = core.watch(flow(q, { times = job.times }), { conditions = conditions, cuts = CUTS,
    unknowns = job.unknowns, lo = b.lo, hi = b.hi, last = job.asked.times.last,
    patience = #job.others > 0 and PATIENCE or nil })
  job.report = job.report or report
  code.refuse_broken(outcome)
  job.stopped = outcome.status == "stopped"
  b.outcome = outcome
  for n, finding in ipairs(findings) do b[of[n]] = join(b[of[n]], finding) end
  for k in ipairs(job.conditions) do
    local finding = b[k]
    local whole = b.part_of and b.part_of[k]
    if whole and outcome.impossible then -- no solution starts in this part
      finding.holds, finding.fails, finding.lo, finding.hi = true, false, -math.huge, -math.huge
    elseif whole then -- what holds for all of it holds for a part
      finding.holds = finding.holds or whole.holds
      finding.lo, finding.hi = math.max(finding.lo, whole.lo), math.min(finding.hi, whole.hi)
    end
  end
  b.part_of = nil
  return b
end

-- Does the box surely hold values that the tolerances allow? (One that reaches over the whole of a range does.)
local function is_allowed(job, b)
  for j, lo in ipairs(b.lo) do
    local hi, least, most = b.hi[j], job.inner.lo[j], job.inner.hi[j]
    local whole, inside = lo <= job.lo[j] and hi >= job.hi[j], least <= most and lo <= most and hi >= least
    if not whole and not inside then return false end
  end
  return true
end

-- A number for each datum, moved to where the tolerances surely allow it, if they surely allow any.
function box.allowed(job, at)
  local moved = {}
  for j, x in ipairs(at) do
    local least, most = job.inner.lo[j], job.inner.hi[j]
    moved[j] = least <= most and math.min(math.max(x, least), most) or x
  end
  return moved
end

-- A box that holds the start of some solution says something about the largest g, and may refute. (Constraints of loops
-- may miss a part of the data.)
function box.note(job, b)
  if not is_allowed(job, b) then return end
  for k, condition in ipairs(b.outcome.impossible and {} or job.conditions) do
    condition.lo = math.max(condition.lo, b[k].lo)
    if b[k].fails and not condition.status then
      condition.status, condition.box, condition.finding = "refuted", b, b[k]
    end
  end
end

-- Is there a condition that this box leaves undecided?
function box.is_open(job, b)
  for k, condition in ipairs(job.conditions) do
    if not condition.status and not b[k].holds then return true end
  end
  return false
end

-- How far the box is from a proof: its largest bound of what is open.
function box.badness(job, b)
  local worst = -math.huge
  for k, condition in ipairs(job.conditions) do
    if not condition.status and not b[k].holds then worst = math.max(worst, b[k].hi) end
  end
  return worst
end

-- How much of the worst box's bound may be overestimation: the gap to what is known to occur.
function box.gap(job, b)
  local worst = 0
  for k, condition in ipairs(job.conditions) do
    if not condition.status and not b[k].holds then worst = math.max(worst, b[k].hi - condition.lo) end
  end
  return worst
end

return box
