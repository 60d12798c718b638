-- plot/limit.lua -- limits = { name = { lo, hi } }: lines in the picture, and whether the proved sets stay
-- between them.
local check = require "ambit.check"
local core = require "ambit.core"
local quantity = require "ambit.plot.quantity"

local limit = {}

local function bound(value, q, what)
  if value == nil then return nil end
  local e = core.expression(value, q.unit ~= "" and q.unit or nil, what)
  if not core.is_constant(e) then check.fail("%s: a limit cannot be uncertain", what) end
  return core.interval(e)
end

-- -> { [k] = { lo, hi, below, above } }: what is within [lo, hi] is within the limit, what is less than `below` or more
-- than `above` is not; nil: there is no such limit
function limit.list(t, quantities)
  local list = {}
  for _, name in ipairs(t == nil and {} or check.sorted(check.table(t, "plot: limits"))) do
    local k, what = quantity.find(quantities, name, "plot: limits"), ("plot: limits.%s"):format(name)
    local pair = check.table(t[name], what)
    check.keys(pair, {}, what, 2)
    local lo, hi = bound(pair[1], quantities[k], what .. "[1]"), bound(pair[2], quantities[k], what .. "[2]")
    if not lo and not hi then check.fail("%s: expected { lowest, highest }, one of which may be nil", what) end
    list[k] = { lo = lo and lo.hi, hi = hi and hi.lo, below = lo and lo.lo, above = hi and hi.hi }
    if lo and hi and list[k].below > list[k].above then check.fail("%s: the lowest is above the highest", what) end
  end
  return list
end

-- Is the quantity there for all data, and within the limit?
local function inside(of, i, l)
  return not of.partial[i] and of.lo[i] and of.lo[i] <= of.hi[i] and (not l.lo or of.lo[i] >= l.lo)
    and (not l.hi or of.hi[i] <= l.hi)
end

local function beyond(of, i, l)
  return not of.partial[i] and (l.below and of.hi[i] < l.below or l.above and of.lo[i] > l.above)
end

-- "holds": within it at all times, for all data; "fails": beyond it at some time, for all data; else "undecided"
function limit.judge(plot, k, l)
  if not plot.proved then return "undecided" end
  local course, status = plot.course, plot.run.status
  local of, holds = course[k], status == "complete" or status == "partial"
  for i in ipairs(course.t) do
    if beyond(of, i, l) then return "fails" end
    local known = i == #course.t and course.ends_early or inside(of, i, l)
    holds = holds and known and (not course.t[i + 1] or inside(of.tube, i, l))
  end
  return holds and "holds" or "undecided"
end

return limit
