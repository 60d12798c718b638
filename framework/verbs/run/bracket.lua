-- run/bracket.lua -- where the states of a run are at an instant of which only a bracket is known: at all times of it.
--
-- What a solver says of the steps that the bracket meets is one enclosure. If one of them ends within the bracket, at m
-- with the states in x, they are also in x + s f(X), the flow over the last ulp, where X holds the states for all of it
-- and s is how far the instant lies behind m: a number that is known much better than the bracket. Proof:
-- docs/numerics/instants.md.
local core = require "ambit.core"
local instant = require "ambit.run.instant"

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
  local list, direction, i = {}, to >= from and 1 or -1, first
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

-- The rates while the states are in `list`, at any of the times; nil: not known, or without a bound.
local function rates_over(run, list, times)
  for _, x in ipairs(list) do
    if not x:is_bounded() then return nil end
  end
  local rates = core.system_rates(run.system.system, list, times)
  for _, rate in ipairs(rates or {}) do
    if not rate:is_bounded() then return nil end
  end
  return rates
end

local function times_span(rates, span)
  local way = {}
  for k, rate in ipairs(rates or {}) do way[k] = span * rate end
  return rates and way
end

-- The rates in a box about `start` that the solutions do not leave in this short a time, as the way from `start` stays
-- inside it: Picard's argument; nil: this one does not show it.
local function rates_in_box(run, start, times, span)
  local guess, box = times_span(rates_over(run, start, times), span), {}
  for k, x in ipairs(guess and start or {}) do
    local r = 2 * guess[k]:mag() + 0x1p-51 * x:mag() + 0x1p-1000
    box[k] = x + core.interval(-r, r)
  end
  local rates = guess and rates_over(run, box, times)
  local way = times_span(rates, span)
  for k, x in ipairs(way and start or {}) do
    local reached = x + way[k]
    if not (reached.lo > box[k].lo and reached.hi < box[k].hi) then return nil end
  end
  return rates
end

-- How far the states, which are in `start` at m, move from there to t, or to any time from `from` to `to` if t is nil;
-- nil: not known. list: where they are all the time, as far as the solver says.
local function moved(run, start, list, from, to, m, t)
  local times = core.interval(math.min(from, to, m), math.max(from, to, m))
  local span, exact = times - core.interval(m), t and instant.behind(t, m, run.times[1])
  local rates = rates_in_box(run, start, times, span) or list and rates_over(run, list, times)
  return times_span(rates, exact and exact:intersect(span) or span)
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

-- The states at m, if that is the end of a step or the start of the run.
local function known_at(run, m)
  if m == run.times[1] then return start_of(run) end
  local i, is_end = core.track_find(run.track, m)
  return is_end and ends_of(run, i) or nil
end

-- The step in which the bracket begins.
local function first_step(run, from)
  local i, is_end = core.track_find(run.track, from)
  return i and number_of_step(run.track, is_end and i + 1 or i)
end

local function samples_around(run, t) return require "ambit.run.samples".around(run, t) end

local function join(list, other)
  for k, x in ipairs(list and other or {}) do list[k] = list[k]:hull(x) end
  return list
end

-- Where states leap, at the instant t: between the same two samples, by a step that ends between these and the way from
-- there, else by all that the solver says of the bracket there.
local function between_samples(run, from, to, m, t)
  local before, after = samples_around(run, instant.expression(t))
  local a, b = math.max(from, before or from), math.max(to, before or to)
  a, b = math.min(a, after or a), math.min(b, after or b)
  for _, double in ipairs { m, from, to, b } do
    local start = (not before or double > before) and (not after or double <= after) and known_at(run, double)
    local way = start and moved(run, start, nil, from, to, double, t)
    if start and not run.rigorous then return start end
    for k, x in ipairs(way and start or {}) do start[k] = x + way[k] end
    if way then return start end
  end
  local list = b == after and known_at(run, b) or nil -- behind it are the states after the leap
  local first = not (list and a == b) and first_step(run, a)
  local other = first and hull(run, first, a, b)
  return list and other and join(list, other) or list or other
end

-- The same at all times from `from` to `to`: on both sides of each sample, also of those at the ends of which the
-- double is on the other side.
local function across_samples(run, from, to)
  local first = first_step(run, from)
  local list = join(first and hull(run, first, from, to), known_at(run, from))
  local before, _, after = samples_around(run, core.expression(to)), samples_around(run, core.expression(from))
  local next_first = before and before >= to and first_step(run, before)
  if next_first then join(list, hull(run, next_first, before, before)) end
  if after and after < from then join(list, known_at(run, after)) end
  return list
end

-- { enclosure of each state }, or nil; from, to: on the clock, within the run, in its direction; m: in between, where
-- the solver was asked to end a step; t: the instant whose bracket that is, nil: all times of it are meant.
function bracket.values(run, from, to, m, t)
  if run.system.sampled then
    if t then return between_samples(run, from, to, m, t) end
    return across_samples(run, from, to)
  end
  local start
  for _, t in ipairs { m, from, to } do
    start = known_at(run, t)
    m = t
    if start then break end
  end
  if not run.rigorous and start then return start end
  local first = first_step(run, from)
  local list = first and hull(run, first, from, to)
  local way = start and moved(run, start, list, from, to, m, t)
  if not way then return list end
  for k, x in ipairs(start) do
    local reached = x + way[k]
    start[k] = list and list[k]:intersect(reached) or reached
  end
  return start
end

-- How far the states may move from the end of the run, `to`, back to t, of which `from` is the bracket's first end;
-- nil: not known.
function bracket.moved(run, from, to, t)
  local start = run.rigorous and known_at(run, to)
  local first = start and first_step(run, from)
  return start and moved(run, start, first and hull(run, first, from, to), from, to, to, t)
end

return bracket
