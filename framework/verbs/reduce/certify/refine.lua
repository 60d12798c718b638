-- reduce/certify/refine.lua -- a bound that is a little above its limit: the data are cut where it is worst.
--
-- An enclosure over a part of the data is narrower than one over all of them; the bound is the greatest over boxes that
-- cover them. The box with the worst bound is halved, over and over.
local core = require "ambit.core"

local refine = {}

refine.REACH = 4 -- times its limit: a bound further above is not worth cutting

local LEAST = 1e-3 -- of a bound
local FAR = 0.25 -- weight of data that no rate depends on: how the solution depends on them is close to linear

local function weights(q, unknowns)
  local list, in_rates = {}, {}
  for _, leaf in ipairs(core.leaves(q.system.rates)) do in_rates[#in_rates + 1] = leaf.expression end
  for j, unknown in ipairs(unknowns) do
    list[j] = FAR
    for _, other in ipairs(in_rates) do
      if other == unknown then list[j] = 1 end
    end
  end
  return list
end

local function is_any_in_rates(weight)
  for _, w in ipairs(weight) do
    if w == 1 then return true end
  end
  return false
end

local function hull(boxes)
  local lo, hi = {}, {}
  for _, box in ipairs(boxes) do
    for j in ipairs(box.lo) do
      lo[j], hi[j] = math.min(lo[j] or box.lo[j], box.lo[j]), math.max(hi[j] or box.hi[j], box.hi[j])
    end
  end
  return lo, hi
end

-- How far a box is above its limits: the greatest ratio.
local function badness(box, limits)
  local most = 0
  for k, bound in ipairs(box.bound) do
    if limits[k] > 0 then most = math.max(most, bound / limits[k]) end
  end
  return most
end

local function worst(boxes, limits)
  local at, most = 1, -1
  for i, box in ipairs(boxes) do
    local bad = badness(box, limits)
    if bad > most then at, most = i, bad end
  end
  return at, most
end

-- The datum with the widest part of its range, and where to cut it; nil: all are points.
local function cut_of(box, lo, hi, weight)
  local best, most, at
  for j in ipairs(box.lo) do
    local middle = 0.5 * box.lo[j] + 0.5 * box.hi[j]
    local share = (box.hi[j] - box.lo[j]) / (hi[j] - lo[j]) * weight[j]
    local inside = box.lo[j] < middle and middle < box.hi[j]
    if inside and (not most or share > most) then best, most, at = j, share, middle end
  end
  return best, at
end

local function half(box, j, lo, hi)
  local part = { lo = table.move(box.lo, 1, #box.lo, 1, {}), hi = table.move(box.hi, 1, #box.hi, 1, {}) }
  part.lo[j], part.hi[j] = lo, hi
  return part
end

-- Without goals, every bound should become smaller by as much as it can.
local function default_goals(boxes)
  local goals = {}
  for _, box in ipairs(boxes) do
    for k, bound in ipairs(box.bound) do goals[k] = math.max(goals[k] or 0, LEAST * bound) end
  end
  return goals
end

-- boxes: each with its bounds; limits: what they should come down to, or nil; solve(box): another run; at most `runs`
-- of them; gain: nil, or give up where halving leaves more than this part of a bound, or no rate depends on the data.
-- Boxes are replaced by their halves.
function refine.run(q, unknowns, boxes, limits, runs, solve, gain)
  limits = limits or default_goals(boxes)
  local lo, hi = hull(boxes)
  local weight = weights(q, unknowns)
  if gain and not is_any_in_rates(weight) then return end
  while runs >= 2 do
    local i, bad = worst(boxes, limits)
    if bad <= 1 then return end
    local j, at = cut_of(boxes[i], lo, hi, weight)
    if not j then return end
    local a, b = half(boxes[i], j, boxes[i].lo[j], at), half(boxes[i], j, at, boxes[i].hi[j])
    if not solve(a) or not solve(b) then return end
    for k, bound in ipairs(boxes[i].bound) do -- what holds for all of it holds for a part
      for _, part in ipairs { a, b } do part.bound[k] = math.min(part.bound[k], bound) end
    end
    boxes[i] = a
    table.insert(boxes, i + 1, b)
    runs = runs - 2
    if gain and math.max(badness(a, limits), badness(b, limits)) > gain * bad then return end
  end
end

return refine
