-- reduce/certify/bounds.lua -- criterion "bounds", equation 19 of Mikelsons and Brandt (2009), made rigorous: at each
-- of some instants, how far the supremum and the infimum of an output of the reduced model are off those of the
-- detailed one.
--
-- sup Y is known from above by an enclosure over all data, and from below by what the output surely is for single
-- choices of the data, or for all of them where constraints may exclude single ones; so are inf Y and those of the
-- reduced model. The bound holds for the true ranges.
local core = require "ambit.core"
local couple = require "ambit.reduce.certify.couple"
local run = require "ambit.reduce.certify.run"
local uncertain = require "ambit.run.uncertain"
local values = require "ambit.reduce.certify.values"

local bounds = {}

local MOST_CORNERS = 4 -- uncertain data of which all corners are tried; otherwise each by itself

-- The data as they are: a whole set holds a start of the system, of its single points that is not known.
local function whole(lo, hi)
  local at = {}
  for j in ipairs(lo) do at[j] = core.interval(lo[j], hi[j]) end
  return { at }
end

-- Choices of the data, within the tolerances: the middle, and corners.
local function choices(lo, hi, inner)
  local middle, list, least, most = {}, {}, {}, {}
  for j in ipairs(lo) do
    least[j], most[j] = inner.lo[j], inner.hi[j]
    middle[j] = math.min(math.max(0.5 * least[j] + 0.5 * most[j], least[j]), most[j])
    if not (least[j] <= most[j]) then -- which of these numbers are allowed is not known: all of them
      middle[j] = core.interval(lo[j], hi[j])
      least[j], most[j] = middle[j], middle[j]
    end
  end
  local function add(bits, of)
    local at = {}
    for j in ipairs(lo) do at[j] = of(j) and (bits >> (j - 1) & 1 == 0 and least[j] or most[j]) or middle[j] end
    list[#list + 1] = at
  end
  add(0, function() return false end)
  local corners = #lo <= MOST_CORNERS and (1 << #lo) - 1 or 1
  for bits = 0, #lo > 0 and corners or -1 do
    add(#lo <= MOST_CORNERS and bits or -bits, function() return true end)
  end
  for j = 1, #lo > MOST_CORNERS and #lo or 0 do
    for bits = 0, 1 do add(-bits, function(i) return i == j end) end
  end
  return list
end

-- Rigorous runs at single choices: at each instant what the supremum is at least, and the infimum at most.
local function inner(q, how, instants, total)
  local unknowns, lo, hi, inside = run.data(q)
  local least, most = {}, {}
  for _, at in ipairs(uncertain.are_points_starts(q) and choices(lo, hi, inside) or whole(lo, hi)) do
    local data = {}
    for j, x in ipairs(at) do data[j] = core.expression(x) end
    local part = values.one(values.at_data(q, unknowns, data), how, instants)
    total.steps = total.steps + part.steps
    if part.status ~= "complete" then return nil, part end
    for j, list in ipairs(part.value) do
      least[j], most[j] = least[j] or {}, most[j] or {}
      for k, x in ipairs(list) do
        least[j][k] = math.max(least[j][k] or -math.huge, x.lo)
        most[j][k] = math.min(most[j][k] or math.huge, x.hi)
      end
    end
  end
  return { sup_least = least, inf_most = most }
end

-- Where nothing is uncertain the run for all data is that for a single choice: its enclosure bounds both ends twice.
local function inner_of(outer)
  local least, most = {}, {}
  for j, list in ipairs(outer) do
    least[j], most[j] = {}, {}
    for k, x in ipairs(list) do least[j][k], most[j][k] = x.lo, x.hi end
  end
  return { sup_least = least, inf_most = most }
end

-- Both bounds of the range of each output of a model at each instant; or nil and the run that did not get there.
local function ranges(model, s, how, instants, total)
  local q = couple.alone(model, s)
  q.times = instants -- steps end there: no dense enclosure is as narrow
  local outer, range, failed = values.all(q, how, instants), nil, nil
  total.steps = total.steps + outer.steps
  if outer.status ~= "complete" then return nil, outer end
  if #run.data(q) == 0 then range = inner_of(outer.value) else range, failed = inner(q, how, instants, total) end
  if not range then return nil, failed end
  range.outer = outer.value
  return range
end

local function instants_of(s, settings) return values.instants(s.times, settings.nodes or 100) end

-- Those of the detailed model are the same for every reduced one: kept in settings.memory, if there is one, for all
-- proofs that share it, full ones and those of lower order apart.
local function remembered(detailed, s, settings, instants, total)
  local memory, key = settings.memory or {}, settings.lowered and "lowered" or "full"
  if not memory[key] or memory[key].detailed ~= detailed then memory[key] = { detailed = detailed } end
  local range, failed = memory[key][s], nil
  if not range then range, failed = ranges(detailed, s, settings, instants, total) end
  memory[key][s] = range
  return range, failed
end

-- The greatest that |a - b| can be for a in [a_lo, a_hi], b in [b_lo, b_hi], rounded upward.
local function apart(a_lo, a_hi, b_lo, b_hi)
  return (core.interval(a_lo, math.max(a_lo, a_hi)) - core.interval(b_lo, math.max(b_lo, b_hi))):mag()
end

local function compare(a, b, instants, n)
  local bound, when = {}, {}
  for k = 1, n do
    bound[k], when[k] = 0, instants[1]
    for j, t in ipairs(instants) do
      local x, y = a.outer[j][k], b.outer[j][k]
      local sup = apart(a.sup_least[j][k], x.hi, b.sup_least[j][k], y.hi)
      local inf = apart(x.lo, a.inf_most[j][k], y.lo, b.inf_most[j][k])
      local worst = math.max(sup, inf)
      if worst > bound[k] then bound[k], when[k] = worst, t end
    end
  end
  return bound, when
end

local function is_bounded(bound)
  for _, b in ipairs(bound) do
    if not (b < math.huge) then return false end
  end
  return true
end

local function unable(total, failed, which)
  total.status, total.code = failed.status == "stopped" and "stopped" or "unable", failed.code
  total.reason, total.t_reached = ("%s: %s"):format(which, failed.reason), failed.t_reached
  return total
end

-- Where nothing is uncertain: the detailed model alone, remembered for the proofs, and in how many steps; nil if
-- something is, or if the run did not get there.
function bounds.alone(detailed, s, settings)
  if #run.data(couple.alone(detailed, s)) > 0 then return nil end
  local total = { steps = 0 }
  return remembered(detailed, s, settings, instants_of(s, settings), total) and total.steps
end

-- As run.bounds of certify/run.lua.
function bounds.prove(detailed, reduced, s, settings)
  local start = core.cpu()
  local total = { status = "proved", reason = "", t_reached = s.times[#s.times], bound = {}, when = {}, steps = 0,
    exceeded = false, solver = settings.solver, arithmetic = settings.arithmetic }
  local instants = instants_of(s, settings)
  local a, failed = remembered(detailed, s, settings, instants, total)
  local which = "the detailed model"
  local b
  if a then
    which = "the reduced model"
    b, failed = ranges(reduced, s, settings, instants, total)
  end
  if a and b then
    total.bound, total.when = compare(a, b, instants, #detailed.outputs)
    if not is_bounded(total.bound) then
      total.status, total.code = "unable", "unable.partial"
      total.reason = "an output is not known to be defined, or is unbounded, for some data"
    end
  else
    unable(total, failed, which)
  end
  total.cpu_seconds = core.cpu() - start
  return total
end

return bounds
