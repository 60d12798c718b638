-- compare/agree.lua -- do proofs contradict each other? Two enclosures of the same state at the same instant without a
-- common point: a bug in one of them, to be shouted.
local core = require "ambit.core"

local agree = {}

-- The greatest lower and the least upper bound of state k at instant i, and whose they are.
local function bounds(rows, i, k)
  local lo, hi, lower, upper = -math.huge, math.huge, nil, nil
  for _, row in ipairs(rows) do
    local x = row.rigorous and row.at and row.at[i]
    if x then
      if x.lo[k] > lo then lo, lower = x.lo[k], row end
      if x.hi[k] < hi then hi, upper = x.hi[k], row end
    end
  end
  return lo, hi, lower, upper
end

local function shown(row, i, k) return tostring(core.interval(row.at[i].lo[k], row.at[i].hi[k])) end

-- nil, or what is wrong; missed: what was found to miss the samples or the reference.
function agree.contradiction(comparison)
  if comparison.missed then return comparison.missed end
  for i, t in ipairs(comparison.instants) do
    for k, name in ipairs(comparison.names) do
      local lo, hi, lower, upper = bounds(comparison.rows, i, k)
      if lower and upper and lo > hi then
        return ("%s and %s contradict each other about %s at t = %s: %s and %s"):format(upper.label, lower.label, name,
          core.literal(t), shown(upper, i, k), shown(lower, i, k))
      end
    end
  end
end

return agree
