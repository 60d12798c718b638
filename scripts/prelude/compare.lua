-- compare.lua -- ambit.compare { expression or table of them, at = {}, arithmetics = {}, repeats = 5 }: what each
-- arithmetic encloses, how tightly, at what cost.
--
-- Every combination of an arithmetic and its options is run once to warm up, then `repeats` times; the least times
-- count. A combination that fails is a row with its reason. Widths are held against the tightest proved enclosure and
-- against the hull of n samples, which lies inside every enclosure up to rounding.
local binding = require "ambit.binding"
local check = require "ambit.check"
local core = require "ambit.core"
local evaluate = require "ambit.evaluate"
local grid = require "ambit.compare.grid"
local session = require "ambit.session"
local shape = require "ambit.shape"
local compare_table = require "ambit.compare.table"

local verb = {}

local setting_keys = { "arithmetics", "repeats", "limit", "n", "seed" }

local function number_of(value, default, what)
  if value == nil then return default end
  local number = tonumber(value)
  if not number or not (number > 0) then check.fail("%s: expected a positive number, got %s", what, tostring(value)) end
  return number
end

-- The keys that say how to compare, checked; `others`: where to look for what t leaves out.
function verb.settings(t, others)
  local function get(key)
    if t[key] ~= nil then return t[key] end
    return others and others[key]
  end
  local seed = get "seed" == nil and 1 or math.tointeger(get "seed")
  if not seed then check.fail("compare: seed: expected an integer, got %s", tostring(get "seed")) end
  return {
    arithmetics = get "arithmetics", repeats = check.count(get "repeats" or 5, "compare: repeats"),
    limit = number_of(get "limit", 10, "compare: limit"), n = check.count(get "n" or 1000, "compare: n"), seed = seed,
  }
end

-- The message without the place, which is that of the whole comparison.
local function bare(problem)
  local text, where = tostring(problem), core.where()
  if where ~= "" and text:sub(1, #where) == where then text = text:sub(#where + 1) end
  return text
end

function verb.status_of(set)
  return set:is_empty() and "empty" or not set:is_bounded() and "unbounded" or "complete"
end

-- "complete", or what is the matter with which results
local function status_of_all(x, paths)
  local names, reasons = { empty = {}, unbounded = {} }, {}
  for i, set in ipairs(x) do
    local list = names[verb.status_of(set)]
    if list then list[#list + 1] = compare_table.name_of(paths[i]) end
  end
  if #names.empty > 0 then reasons[1] = table.concat(names.empty, ", ") .. " has no point in the domain" end
  if #names.unbounded > 0 then reasons[#reasons + 1] = table.concat(names.unbounded, ", ") .. " has no bounds" end
  if #reasons == 0 then return "complete" end
  return #names.empty > 0 and "empty" or "unbounded", table.concat(reasons, "; ")
end

local function new_row(c)
  return { arithmetic = c.arithmetic, options = c.settings, family = c.family, axis = c.axis, value = c.value,
    label = c.label, rigorous = c.rigorous }
end

local function fail_row(row, status, reason)
  row.status, row.reason = status, reason
  return row
end

-- Repeats until there are enough, or the limit is used up; the least times count.
local function measure(request, c, settings, row)
  local began = core.cpu()
  for i = 1, settings.repeats do
    local _, report = core.evaluate(c.arithmetic, c.options, request.expressions, request.leaves, request.values)
    row.seconds_run = i == 1 and report.seconds_run or math.min(row.seconds_run, report.seconds_run)
    row.seconds_build = i == 1 and report.seconds_build or math.min(row.seconds_build, report.seconds_build)
    row.repeats = i
    if core.cpu() - began > settings.limit then break end
  end
end

-- One combination -> its row.
local function run_combination(request, c, settings)
  local row = new_row(c)
  if c.problem then return fail_row(row, "failed", bare(c.problem)) end
  local began = core.cpu()
  local good, x, report = pcall(core.evaluate, c.arithmetic, c.options, request.expressions, request.leaves,
    request.values)
  row.seconds_first = core.cpu() - began
  if not good then return fail_row(row, "failed", bare(x)) end
  row.enclosures = x
  row.status, row.reason = status_of_all(x, request.paths)
  row.unknowns, row.instructions = report.unknowns, report.tape_instructions
  row.widths, row.width = {}, 0
  for i, set in ipairs(x) do
    row.widths[i] = set:width()
    row.width = math.max(row.width, row.widths[i])
    row.partial = row.partial or set.partial
  end
  if row.seconds_first > settings.limit then
    row.seconds_run, row.seconds_build, row.repeats = report.seconds_run, report.seconds_build, 1
  else
    measure(request, c, settings, row)
  end
  return row
end

-- After an order that took too long, the higher ones are rows without a result.
local function skip_row(c, slow, limit)
  return fail_row(new_row(c), "skipped", ("%s=%s took %.3g s, which is over the limit of %.3g s"):format(c.axis,
    slow.value, slow.seconds, limit))
end

local function run_all(request, combinations, settings, progress)
  local rows, slow = {}, {}
  for i, c in ipairs(combinations) do
    if progress then progress(i, #combinations, c.label) end
    local before = slow[c.family]
    if before and c.axis and tonumber(c.value) and tonumber(c.value) > before.number then
      rows[i] = skip_row(c, before, settings.limit)
    else
      rows[i] = run_combination(request, c, settings)
      local seconds = rows[i].seconds_first or 0
      if c.axis and tonumber(c.value) and seconds > settings.limit then
        slow[c.family] = { value = c.value, number = tonumber(c.value), seconds = seconds }
      end
    end
  end
  return rows
end

-- -- against the tightest, against samples, against each other

local function is_proof(row) return row.rigorous and row.enclosures ~= nil end

local function sampled(request, settings)
  local good, x, defined = pcall(core.sample_expressions, "real", {}, request.expressions, request.leaves,
    request.values, settings.n, settings.seed)
  if not good then return nil, bare(x) end
  local widths, widest = {}, 0
  for i, set in ipairs(x) do
    widths[i] = defined[i] > 0 and set:width() or nil
    widest = math.max(widest, widths[i] or 0)
  end
  return { x = x, widths = widths, width = widest }
end

local function tightest_widths(rows, count)
  local least = {}
  for _, row in ipairs(rows) do
    for i = 1, count do
      local proved = is_proof(row) and not row.enclosures[i]:is_empty()
      if proved then least[i] = math.min(least[i] or math.huge, row.widths[i]) end
    end
  end
  return least
end

-- The largest ratio over the results; nil: there is nothing to hold against.
local function ratio(widths, reference, count)
  local largest
  for i = 1, count do
    local r = reference[i]
    if r and (r > 0 or widths[i] > 0) and r < math.huge then
      largest = math.max(largest or 0, r > 0 and widths[i] / r or math.huge)
    elseif r == 0 then
      largest = math.max(largest or 0, 1)
    end
  end
  return largest
end

-- Samples of no width hold no information about an overestimation.
local function positive(widths, count)
  local list = {}
  for i = 1, count do list[i] = widths[i] and widths[i] > 0 and widths[i] or nil end
  return list
end

local function hold_against(comparison)
  local count, rows = #comparison.paths, comparison.rows
  local least = tightest_widths(rows, count)
  local inner = comparison.sample and positive(comparison.sample.widths, count)
  for _, row in ipairs(rows) do
    if is_proof(row) then
      row.over_tightest = ratio(row.widths, least, count)
      row.over_sample = inner and ratio(row.widths, inner, count)
    end
  end
end

-- Two proofs with no point in common, where one says that the expression is defined everywhere: a bug, to be shouted.
local function find_contradiction(comparison)
  local rows = comparison.rows
  for i, a in ipairs(rows) do
    for k = 1, i - 1 do
      local b = rows[k]
      if is_proof(a) and is_proof(b) and not (a.partial and b.partial) then
        for n, path in ipairs(comparison.paths) do
          if a.enclosures[n]:intersect(b.enclosures[n]):is_empty() then
            return ("%s and %s contradict each other about %s: %s and %s"):format(b.label, a.label,
              compare_table.name_of(path), tostring(b.enclosures[n]), tostring(a.enclosures[n]))
          end
        end
      end
    end
  end
end

-- request: { place, expressions, paths, leaves, values } -> { status, reason, place, paths, rows, sample, settings }
function verb.run(request, settings, progress)
  local began = core.cpu()
  local comparison = { place = request.place, paths = request.paths, settings = settings, status = "complete" }
  comparison.rows = run_all(request, grid.combinations(settings.arithmetics), settings, progress)
  comparison.sample, comparison.sample_problem = sampled(request, settings)
  hold_against(comparison)
  local proofs = 0
  for _, row in ipairs(comparison.rows) do
    if is_proof(row) then proofs = proofs + 1 end
    comparison.unknowns = comparison.unknowns or row.unknowns
    comparison.instructions = math.max(comparison.instructions or 0, row.instructions or 0)
  end
  local wrong = find_contradiction(comparison)
  if wrong or proofs == 0 then
    comparison.status, comparison.reason = "unable", wrong or "no arithmetic proved an enclosure"
  end
  comparison.cpu_seconds = core.cpu() - began
  return comparison
end

-- -- records

local function pairs_of(row, comparison, number)
  local list = {}
  local function add(key, value)
    if value ~= nil and value ~= "" then list[#list + 1], list[#list + 2] = key, value end
  end
  add("comparison", number)
  add("place", comparison.place)
  for _, key in ipairs { "arithmetic", "options", "status", "reason", "width", "over_tightest", "over_sample",
    "seconds_run", "seconds_build", "repeats" } do add(key, row[key]) end
  add("rigorous", row.rigorous and "yes" or "no")
  add("partial", row.partial and "yes" or nil)
  if row.enclosures then
    local values = {}
    for i, path in ipairs(comparison.paths) do values[2 * i - 1], values[2 * i] = path, row.enclosures[i] end
    add("values", values)
  end
  return list
end

-- One `row` record for each combination.
function verb.write_records(comparison, number)
  if not core.recording() then return end
  for _, row in ipairs(comparison.rows) do core.record("row", pairs_of(row, comparison, number)) end
end

-- -- the verb

local Comparison = { __name = "comparison" }
Comparison.__index = Comparison
Comparison.__tostring = function(self) return compare_table.text(self) end

-- Of a comparison made by the verb: each row's x in the shape that was asked for.
local function reshape(comparison, rebuild)
  for _, row in ipairs(comparison.rows) do row.x = row.enclosures and rebuild(row.enclosures) end
end

function verb.compare(t)
  check.table(t, "compare")
  if #t == 0 then
    check.keys(t, setting_keys, "compare without expressions")
    local settings = verb.settings(t)
    if t.arithmetics ~= nil then grid.entries(t.arithmetics) end
    session.compare = t
    return setmetatable({ status = "complete", rows = {}, paths = {}, settings = settings }, Comparison)
  end
  check.keys(t, { "at", table.unpack(setting_keys) }, "compare", #t)
  local settings = verb.settings(t, session.compare)
  local expressions, paths, rebuild = shape.flatten(evaluate.subject(t, "compare"), "compare")
  local leaves, values = binding.resolve(t.at, expressions, "compare")
  local comparison = verb.run({ place = core.where():gsub(": $", ""), expressions = expressions, paths = paths,
    leaves = leaves, values = values }, settings)
  session.comparisons[#session.comparisons + 1] = comparison
  verb.write_records(comparison, #session.comparisons)
  session.finish("compare", comparison, { seconds_run = comparison.cpu_seconds },
    { "repeats", settings.repeats, "limit", settings.limit, "n", settings.n, "seed", settings.seed })
  reshape(comparison, rebuild)
  return setmetatable(comparison, Comparison)
end

return verb
