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
    if lo and hi and list[k].lo > list[k].hi then check.fail("%s: the lowest is above the highest", what) end
  end
  return list
end

local function inside(of, i, l)
  return of.lo[i] and of.lo[i] <= of.hi[i] and (not l.lo or of.lo[i] >= l.lo) and (not l.hi or of.hi[i] <= l.hi)
end

-- "holds": within it at all times, for all data; "fails": beyond it at some time, for all data; else "undecided"
function limit.judge(run, course, k, l)
  if not run.rigorous then return "undecided" end
  local of, holds = course[k], run.status == "complete"
  for i in ipairs(course.t) do
    if l.below and of.hi[i] < l.below or l.above and of.lo[i] > l.above then return "fails" end
    holds = holds and inside(of, i, l) and (not course.t[i + 1] or inside(of.tube, i, l))
  end
  return holds and "holds" or "undecided"
end

return limit
