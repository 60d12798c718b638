-- compare/evaluation.lua -- the same expressions in each arithmetic: how wide, in what time.
local compare_table = require "ambit.compare.table"
local core = require "ambit.core"
local grid = require "ambit.compare.grid"
local judge = require "ambit.compare.judge"
local sample = require "ambit.sample"
local sample_overestimation = require "ambit.sample.overestimation"

local evaluation = {}

function evaluation.status_of(set)
  return set:is_empty() and "empty" or not set:is_bounded() and "unbounded" or "complete"
end

-- "complete", or what is the matter with which results
local function status_of_all(x, names)
  local found, reasons = { empty = {}, unbounded = {} }, {}
  for i, set in ipairs(x) do
    local list = found[evaluation.status_of(set)]
    if list then list[#list + 1] = names[i] end
  end
  if #found.empty > 0 then reasons[1] = table.concat(found.empty, ", ") .. " has no point in the domain" end
  if #found.unbounded > 0 then reasons[#reasons + 1] = table.concat(found.unbounded, ", ") .. " has no bounds" end
  if #reasons == 0 then return "complete" end
  return #found.empty > 0 and "empty" or "unbounded", table.concat(reasons, "; ")
end

-- Repeats until there are enough, or the limit is used up; the least times count.
local function repeated(run, settings, row, report)
  local began = core.cpu()
  row.seconds_run, row.seconds_build, row.repeats = report.seconds_run, report.seconds_build, 1
  if row.seconds_first > settings.limit then return end
  for i = 1, settings.repeats do
    local _, again = run()
    row.seconds_run = i == 1 and again.seconds_run or math.min(row.seconds_run, again.seconds_run)
    row.seconds_build = i == 1 and again.seconds_build or math.min(row.seconds_build, again.seconds_build)
    row.repeats = i
    if core.cpu() - began > settings.limit or core.interrupted() then break end
  end
end

-- In the child: one combination -> what its row is to hold.
local function measure(request, c, settings, names)
  local function run()
    return core.evaluate { arithmetic = c.arithmetic, options = c.options, expressions = request.expressions,
      leaves = request.leaves, values = request.values }
  end
  local row, began = { widths = {}, width = 0 }, core.cpu()
  local x, report = run()
  row.seconds_first = core.cpu() - began
  row.enclosures, row.work = x, report
  row.status, row.reason = status_of_all(x, names)
  row.unknowns, row.instructions = report.unknowns, report.tape_instructions
  for i, set in ipairs(x) do
    row.widths[names[i]] = set:width()
    row.width = math.max(row.width, set:width())
    row.partial = row.partial or set.partial
  end
  repeated(run, settings, row, report)
  return row
end

-- With the widths of what was drawn; those of which no draw was defined have none.
local function sampled(engine, request, settings, names)
  local result = engine:child(function()
    local inner, reason = sample.inner(request, settings.n or 1000, settings.seed, { cpu = settings.limit })
    return inner or { reason = reason }
  end)
  local inner = result and result.data
  if not inner then return nil, result and (result.message or result.outcome) or "interrupted" end
  if not inner.lo then return nil, inner.reason end
  inner.x, inner.widths, inner.width = {}, {}, 0
  for i, name in ipairs(names) do
    local lo, hi = inner.lo[i][1], inner.hi[i][1]
    local defined = lo <= hi
    inner.x[i] = core.interval(defined and lo or "[empty]", defined and hi or nil)
    inner.widths[name] = defined and inner.x[i]:width() or nil
    inner.width = math.max(inner.width, inner.widths[name] or 0)
  end
  return inner
end

local function is_proof(row) return row.rigorous and row.enclosures ~= nil end

-- An enclosure that misses values that were seen.
local function missed(comparison)
  local inner = comparison.sample
  for _, row in ipairs(inner and comparison.rows or {}) do
    for i, name in ipairs(is_proof(row) and comparison.names or {}) do
      local _, problem = sample_overestimation.of_inner(inner, i, 1, row.enclosures[i], name)
      if problem then return ("%s: %s"):format(row.label, problem) end
    end
  end
end

-- Two proofs with no point in common, where one says that the expression is defined everywhere: a bug, to be shouted.
local function contradiction(comparison)
  local rows = comparison.rows
  for i, a in ipairs(rows) do
    for k = 1, i - 1 do
      local b = rows[k]
      if is_proof(a) and is_proof(b) and not (a.partial and b.partial) then
        for n, name in ipairs(comparison.names) do
          if a.enclosures[n]:intersect(b.enclosures[n]):is_empty() then
            return ("%s and %s contradict each other about %s: %s and %s"):format(b.label, a.label, name,
              tostring(b.enclosures[n]), tostring(a.enclosures[n]))
          end
        end
      end
    end
  end
end

-- Widths that a row proves of what has a point at all.
local function proved_widths(comparison, row)
  if not is_proof(row) then return nil end
  local widths = {}
  for i, name in ipairs(comparison.names) do
    if not row.enclosures[i]:is_empty() then widths[name] = row.widths[name] end
  end
  return widths
end

local function hold_against(comparison)
  local names, rows, proved = comparison.names, comparison.rows, {}
  for i, row in ipairs(rows) do proved[i] = proved_widths(comparison, row) or false end
  local least = judge.least(proved, names)
  local inner = comparison.sample and judge.positive(comparison.sample.widths, names)
  for i, row in ipairs(rows) do
    if proved[i] then
      row.over_tightest = judge.ratio(row.widths, least, names)
      row.over_sample = inner and judge.ratio(row.widths, inner, names)
    end
  end
end

local function names_of(paths)
  local names = {}
  for i, path in ipairs(paths) do names[i] = compare_table.name_of(path) end
  return names
end

-- Fills the comparison of a request { expressions, paths, leaves, values }.
function evaluation.run(comparison, request, settings, engine)
  comparison.paths, comparison.names = request.paths, names_of(request.paths)
  local names = comparison.names
  comparison.rows = engine:rows(grid.combinations(settings.arithmetics),
    function(c) return measure(request, c, settings, names) end)
  if not comparison.sample then
    comparison.sample, comparison.sample_problem = sampled(engine, request, settings, names)
  end
  hold_against(comparison)
  local proofs = 0
  for _, row in ipairs(comparison.rows) do
    if is_proof(row) then proofs = proofs + 1 end
    comparison.unknowns = comparison.unknowns or row.unknowns
    comparison.instructions = math.max(comparison.instructions or 0, row.instructions or 0)
  end
  local wrong = contradiction(comparison) or missed(comparison)
  comparison.contradicted = wrong ~= nil
  if wrong then
    comparison.status, comparison.code, comparison.reason = "broken", "broken.contradiction", wrong
  elseif proofs == 0 then
    comparison.status, comparison.reason = "unable", "no arithmetic proved an enclosure"
  end
  comparison.measure = #names > 1 and judge.any(comparison.rows, "over_sample") and "over_sample" or "width"
end

return evaluation
