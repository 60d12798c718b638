-- simulate/experiment.lua -- where the width of a run that ended early came from, by experiment: how wide the set is
-- beside sampled motions shortly before the end, what is left of it with each datum put to its middle, and how narrow
-- the datum that makes most of it has to be for the run to complete. Nothing is said that was not tried.
local core = require "ambit.core"
local flow = require "ambit.run.flow"
local uncertain = require "ambit.run.uncertain"

local experiment = {}

local BEFORE = 0.95 -- of the way to where the run ended: there is a set to look at
local SOME = 0.1    -- share of a width that is worth a word
local NARROW = { 0.01, 1e-4 } -- parts of a datum's width that are tried first,
local HALVINGS = 5            -- and how often the part is sought between one that did and one that did not
local DRAWS = 64
local TRY = 0.5     -- of the CPU time that is left, for looking where the width comes from

-- The uncertain data of a request: { unknowns, lo, hi, names }
function experiment.data(q)
  local all = table.move(q.initial, 1, #q.initial, 1, {})
  table.move(q.system.rates or {}, 1, #(q.system.rates or {}), #all + 1, all)
  local data = {}
  data.unknowns, data.lo, data.hi, data.inner, data.names = uncertain.data(all)
  return data
end

-- The middle part of the range of each datum, or of datum `only`.
local function cut(data, part, only)
  local lo, hi = {}, {}
  for j, a in ipairs(data.lo) do
    local b, own = data.hi[j], (not only or only == j) and part or 1
    local mid, half = 0.5 * a + 0.5 * b, 0.5 * own * (b - a)
    lo[j], hi[j] = own == 1 and a or math.max(a, mid - half), own == 1 and b or math.min(b, mid + half)
  end
  return lo, hi
end

-- One run over a part of the data -> its outcome, and the widths of the states at the end if it came there.
local function try(q, solver, data, times, part, only)
  local conditions, lo, hi = {}, cut(data, part, only)
  for i, x in ipairs(q.system.symbols) do
    conditions[2 * i - 1] = { g = x, kind = "at_end", name = q.system.states[i] }
    conditions[2 * i] = { g = -x, kind = "at_end", name = q.system.states[i] }
  end
  local findings, outcome = core.watch(flow(q.by(solver), { times = times }),
    { conditions = conditions, cuts = 1, unknowns = data.unknowns, lo = lo, hi = hi })
  if outcome.status ~= "complete" then return outcome end
  local widths = {}
  for i in ipairs(q.system.states) do widths[i] = findings[2 * i - 1].hi + findings[2 * i].hi end
  return outcome, widths
end

-- Does the solver come to the end with this part of all data, or of one?
function experiment.completes(q, solver, data, part, only)
  return try(q, solver, data, q.times, part, only).status == "complete"
end

-- The state that is widest beside sampled motions at the last of these times, its factor, or nil.
local function widest(q, times, widths, seconds)
  local hull = require "ambit.sample".inner(q, DRAWS, 1, { t = times, threads = 1, cpu = seconds })
  if not hull or hull.failed > 0 then return nil end
  local which, most
  for i, width in ipairs(widths) do
    local spread = hull.hi[i][#hull.t] - hull.lo[i][#hull.t]
    if spread > 1e-6 * math.max(math.abs(hull.hi[i][#hull.t]), math.abs(hull.lo[i][#hull.t])) then
      local factor = width / spread
      if not most or factor > most then which, most = i, factor end
    end
  end
  return which, most
end

-- What is left of the width of state i with each datum at its middle: { { j, name, share } }, the largest share first.
local function shares_of(q, solver, data, times, i, whole)
  local list = {}
  for j, name in ipairs(data.names) do
    local outcome, widths = try(q, solver, data, times, 0, j)
    if outcome.status == "stopped" then break end
    if widths then list[#list + 1] = { j = j, datum = name, share = 1 - widths[i] / whole } end
  end
  table.sort(list, function(a, b) return a.share > b.share or a.share == b.share and a.j < b.j end)
  return list
end

-- The widest part of datum j with which the solver completes, of those that were tried, in found.part: narrow ones,
-- which take least, come first.
local function find_part(q, solver, data, j, found)
  local failed = 1
  for _, part in ipairs(NARROW) do
    if experiment.completes(q, solver, data, part, j) then
      found.part = part
      break
    end
    failed = part
  end
  if not found.part then return end
  for _ = 1, HALVINGS do
    local between = math.sqrt(found.part * failed)
    if experiment.completes(q, solver, data, between, j) then found.part = between else failed = between end
  end
end

-- The tolerance of datum j with this part of its width, rounded down: what is printed is no wider than what was tried.
local function tolerance(data, j, part)
  local mid, half = 0.5 * data.lo[j] + 0.5 * data.hi[j], 0.5 * part * (data.hi[j] - data.lo[j])
  local percent = math.abs(mid) > half
  local value = percent and 100 * half / math.abs(mid) or half
  local digit = 10 ^ (math.floor(math.log(value, 10)) - 1)
  if part < 1 then value = math.floor(value / digit) * digit end
  return ("+-%.3g%s"):format(value, percent and " %" or "")
end

-- found: { state, t, factor = its width by that of samples, shares, part of the datum with the largest share that does,
-- datum, tolerance = that in words }
local function look(q, run, data, found)
  local first, last = q.times[1], run.t_reached
  local times = { first, first + BEFORE * (last - first) }
  if times[2] == first then return end
  local _, widths = try(q, run.solver, data, times, 1)
  if not widths then return end
  local i, factor = widest(q, times, widths, 1)
  if not i then return end
  found.state, found.t, found.factor = q.system.states[i], times[2], factor
  found.shares = shares_of(q, run.solver, data, times, i, widths[i])
end

local function advise(q, run, data, found)
  local most = found.shares[1]
  if not most or most.share < SOME then return end
  find_part(q, run.solver, data, most.j, found)
end

local function described(data, found)
  local list = {}
  if not found.state then return list end
  list[1] = ("at t = %.4g `%s` is %.3g times as wide as sampled motions"):format(found.t, found.state, found.factor)
  for k, entry in ipairs(found.shares) do
    if entry.share < SOME or k > 3 then break end
    list[#list + 1] = ("`%s` (%s) makes %.0f %% of that width"):format(entry.datum, tolerance(data, entry.j, 1),
      100 * entry.share)
  end
  return list
end

-- Looks into a run that ended early until the CPU time `ends`, by within(seconds, f). -> what was found, or nil; the
-- sentences
function experiment.explain(q, run, ends, within)
  local data, found = experiment.data(q), {}
  if #data.unknowns == 0 then return nil, {} end
  within(TRY * (ends - core.cpu()), function() look(q, run, data, found) end)
  local list = described(data, found)
  if found.shares and ends > core.cpu() then
    within(TRY * (ends - core.cpu()), function() advise(q, run, data, found) end)
  end
  if found.part then
    local most = found.shares[1]
    found.datum, found.tolerance = most.datum, tolerance(data, most.j, found.part)
    list[#list + 1] = ("with `%s` %s, `%s` completes"):format(found.datum, found.tolerance, run.solver)
  end
  return found.state and found or nil, list
end

return experiment
