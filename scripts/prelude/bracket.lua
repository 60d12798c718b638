-- bracket.lua -- where the states of a run are at an instant of which only a bracket is known: at all times of it.
--
-- What a solver says of the steps that the bracket meets is one enclosure X. If the bracket starts at the end of a step
-- (or of the run), where the states are in x, they are also in x + [0, its length] f(X): the flow over the last ulp.
local core = require "ambit.core"

local bracket = {}

local function number_of_step(track, i)
  for k = i, core.track_count(track) do
    local _, _, kind = core.track_step(track, k)
    if kind == "step" then return k end
  end
end

-- Of state k in step i, while the clock is between from and to; nil: the solver says nothing.
local function over(track, i, k, from, to)
  return core.track_dense(track, i, k, math.min(from, to), math.max(from, to)) or core.track_value(track, i, k, true)
end

-- The hull over all steps between the times, in the direction of the run; nil: the solver says nothing between steps.
local function hull(run, first, from, to)
  local list, direction, i = {}, to > from and 1 or -1, first
  while i do
    local begins, ends = core.track_step(run.track, i)
    local a = (begins - from) * direction > 0 and begins or from
    local b = (ends - to) * direction < 0 and ends or to
    for k in ipairs(run.states) do
      local x = over(run.track, i, k, a, b)
      if not x then return nil end
      list[k] = list[k] and list[k]:hull(x) or x
    end
    if b == to then return list end
    i = number_of_step(run.track, i + 1)
  end
end

-- How far the states, which are in `list` all the time, move from `from` to any time up to `to`; nil: not known.
local function moved(run, list, from, to)
  local system = run.system
  local leaves, values = { core.time() }, { core.expression(core.interval(math.min(from, to), math.max(from, to))) }
  for k, x in ipairs(list) do
    if not x:is_bounded() then return nil end
    leaves[k + 1], values[k + 1] = system.symbols[k], core.expression(x)
  end
  local rates = core.evaluate("interval", {}, system.rates, leaves, values)
  local span, result = (core.interval(to) - core.interval(from)):hull(0), {}
  for k, rate in ipairs(rates) do
    if rate.partial then return nil end
    result[k] = span * rate
  end
  return result
end

local function narrowed(run, list, start, from, to)
  local way = moved(run, list, from, to)
  for k, x in ipairs(way and list or {}) do list[k] = x:intersect(start[k] + way[k]) end
  return list
end

local function ends_of(run, i)
  local list = {}
  for k in ipairs(run.states) do list[k] = core.track_value(run.track, i, k, false) end
  return list
end

local function start_of(run)
  local named, list = run.initial(), {}
  for k, name in ipairs(run.states) do list[k] = named[name] end
  return list
end

-- { enclosure of each state }, or nil; from, to: on the clock, within the run, in its direction.
function bracket.values(run, from, to)
  local i, is_end = core.track_find(run.track, from)
  if not i then return nil end
  local start = is_end and ends_of(run, i) or from == run.times[1] and start_of(run) or nil
  if not run.rigorous and start then return start end
  local first = is_end and number_of_step(run.track, i + 1) or not is_end and i
  local list = first and hull(run, first, from, to)
  if not list or not start then return list end
  return narrowed(run, list, start, from, to)
end

-- How far the states may move from the end of the run, `from`, back to a time of its last step; nil: not known.
function bracket.moved(run, from, to)
  local i = core.track_find(run.track, to)
  local first = i and number_of_step(run.track, i)
  local list = run.rigorous and first and hull(run, first, to, from)
  return list and moved(run, list, from, to)
end

return bracket
