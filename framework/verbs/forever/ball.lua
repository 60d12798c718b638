-- forever/ball.lua -- the largest set about a state of rest that is found, and proved to be left by nothing.
local core = require "ambit.core"
local weight = require "ambit.forever.weight"

local ball = {}

local BEST = 3 -- weights that are tried for large sets
local SHRINK, GROW = 0.85, 1.4
local TRIES, GROWTHS = 30, 60
local ENOUGH = 0.5    -- of the rate at the centre
local MARGIN = 1.0001 -- of the radius by the residual
local SMALL = 1e-6    -- radius to begin with, where neither data nor `within` say one
local REFINED = 4     -- how often the last, smallest set is looked at again
local FIRST = 60      -- boxes for a first look at the centre,
local MANY = 12       -- with more states and data than these cutting is hopeless, and only whole boxes are looked at

-- Outer radius of the largest set within { [state] = { lo, hi } }, or math.huge.
local function radius_within(system, frame, centre, within)
  local most = math.huge
  for i, name in ipairs(system.states) do
    local range = within[name]
    if range then most = math.min(most, math.min(range.hi - centre[i].hi, centre[i].lo - range.lo) / frame.reach[i]) end
  end
  return most * (1 - 1e-14)
end

-- Is the rate of a set enough against what the data do at its centre? (least F'W F) rate R > |F' g(c)|
local function stays(set, residual) return set.rate * set.least * set.outer > residual * (1 + 1e-12) end

-- What a candidate is worth: the rate at the states of rest of all data, the residual there. middle: rest at the middle
local function judge(one, request, middle)
  local centre = one.decay:rest(middle)
  if not centre then return nil end
  one.centre = centre
  one.residual = one.decay:residual(one.frame, centre)
  local point = { centre = centre, outer = 0 }
  local cuts = #request.system.states + #one.decay.data > MANY and 0 or FIRST
  if not one.residual or not one.decay:bound(one.frame, point, 0, math.huge, cuts) then return nil end
  one.rate, one.most = point.rate, radius_within(request.system, one.frame, centre, request.within)
  one.needed = MARGIN * one.residual / (point.rate * point.least)
  one.score = one.most < math.huge and one.most / math.max(one.needed, 1e-9 * one.most)
    or one.rate / math.max(one.needed, 1e-9)
  return one
end

-- The set of this outer radius, if it is proved.
function ball.try(one, outer, budget)
  local set = { centre = one.centre, outer = outer, by = one }
  if not (outer > 0) or not one.decay:is_smooth(one.frame, set) then return nil end
  local least = one.residual / outer
  if not one.decay:bound(one.frame, set, least, math.max(1.05 * least, ENOUGH * one.rate), budget) then return nil end
  set.radius = outer * core.sqrt(core.interval(set.least)).lo * (1 - 1e-15)
  return stays(set, one.residual) and set or nil
end

local function shrink(one, budget)
  local outer = one.most
  for _ = 1, TRIES do
    if outer < one.needed then return nil end
    local set = ball.try(one, outer, budget)
    if set then return set end
    outer = outer * SHRINK
  end
end

local function grow(one, budget)
  local outer, best = math.max(one.needed * GROW, SMALL), nil
  for _ = 1, GROWTHS do
    local set = ball.try(one, outer, budget)
    if not set then break end
    best, outer = set, outer * GROW
  end
  return best or ball.try(one, one.needed * 1.01, budget)
end

-- Where everything ends up: r <= residual / (rate sqrt(least)), hence |u| <= that / sqrt(least); again in that set,
-- where rates are better.
local function settle(set, budget)
  local one, last = set.by, set
  for _ = 1, REFINED do
    local outer = MARGIN * one.residual / (last.rate * last.least) + 1e-300
    if outer >= 0.99 * last.outer then break end
    local inner = { centre = set.centre, outer = outer, by = one }
    if not one.decay:bound(one.frame, inner, last.rate, 0.98 * one.rate, budget) then
      inner.rate, inner.least = last.rate, last.least
    end
    last = inner
  end
  return last
end

local function size(set)
  local product = 0
  for _, reach in ipairs(set.by.frame.reach) do product = product + math.log(reach * set.outer) end
  return product
end

-- The point of rest for the middle of the data, near `guess`; nil and why none was found.
local function middle(system, guess)
  local good, x, _, converged = pcall(core.approach, { equations = system.rates, unknowns = system.symbols,
    names = system.states, leaves = {}, values = {}, x = guess })
  if not good then return nil, (tostring(x):gsub("^.-: ", "")) end
  return converged and x, "no state of rest was found from there, at the middle of the data"
end

local function candidates(request, centre)
  local list = request.system.mechanism and weight.of_mechanism(request.system, centre) or {}
  local others, why = weight.of_ode(request.system, centre, request.scales)
  table.move(others or {}, 1, #(others or {}), #list + 1, list)
  if #list == 0 then return nil, why end
  local worthy = {}
  for _, one in ipairs(list) do worthy[#worthy + 1] = judge(one, request, centre) end
  if #worthy == 0 then return nil, "no quadratic form was found that decays about the states of rest of all data" end
  table.sort(worthy, function(x, y) return x.score > y.score end)
  return worthy
end

-- request: { system, guess (numbers), within ({ [state] = enclosure }), scales or nil, budget } -> { set, settled }, or
-- nil and why there is none.
function ball.find(request)
  local centre, why = middle(request.system, request.guess)
  if not centre then return nil, why end
  local list
  list, why = candidates(request, centre)
  if not list then return nil, why end
  local best
  for k = 1, math.min(BEST, #list) do
    local budget = #request.system.states + #list[k].decay.data > MANY and 0 or request.budget
    local set = (list[k].most < math.huge and shrink or grow)(list[k], budget)
    if set and (not best or size(set) > size(best)) then best = set end
  end
  if not best then
    return nil, ("the data move the state of rest too far, or the form decays in too small a set: by the data a radius "
      .. "of %.3g is needed, %.3g is allowed"):format(list[1].needed, list[1].most)
  end
  return { set = best, settled = settle(best, request.budget) }
end

return ball
