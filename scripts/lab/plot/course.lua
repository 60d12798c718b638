-- plot/course.lua -- what a run proved of quantities along its time, as plain numbers.
--
-- A course is { t, t_lo, t_hi, [k] = { lo, hi, partial, tube = { lo, hi, partial } } }: quantity k is within [lo[i],
-- hi[i]] at the instant i, which is within [t_lo[i], t_hi[i]] (equal, but where a time is no double), and within its
-- tube i at all times from this instant to the next; NaN where nothing is known, partial[i] where it is not defined for
-- all data. ends_early: a run that an event ended goes to the last instant at most, at which nothing is known.
local core = require "ambit.core"
local instant = require "ambit.run.instant"
local states_of = require "ambit.compare.course"

local course = {}

local FEW = 100         -- steps: a run with fewer is repeated with dense output
local MOST_SECONDS = 20 -- that this may take
local EVALUATING = 10   -- seconds for all enclosures in gradient arithmetic; if it takes more, plain intervals

local nan = 0 / 0

-- The times of a run up to what it reached.
local function times_of(run)
  local times = run.question.times
  if run.t_reached == times[#times] then return times end
  local list, forward = {}, times[#times] >= times[1]
  for i, t in ipairs(times) do
    if i == 1 or forward and t < run.t_reached or not forward and t > run.t_reached then list[#list + 1] = t end
  end
  list[#list + 1] = run.t_reached
  list.shift, list.start = times.shift, times.start
  return list
end

-- A run whose steps are long, or that kept only the last, says more about the way from one to the next when it is asked
-- once more, for dense output. Where that proves less, the first answer stands.
function course.finer(run)
  local question, few = run.question, run.step_count < FEW or run.keeps_last
  if not (question and question.again) or not few or run.cpu_seconds > MOST_SECONDS or run.step_count == 0 then
    return run
  end
  local good, again = pcall(question.again, { dense = true, last = false }, times_of(run))
  return good and again.status == "complete" and again.t_reached == run.t_reached and again or run
end

local function leaves_of(expressions)
  local list, names = {}, {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "symbol" or leaf.kind == "time" then
      list[#list + 1], names[#names + 1] = leaf.expression, leaf.kind == "symbol" and leaf.name or false
    end
  end
  return list, names
end

-- f(t, x): enclosures of the expressions where the time is t and state k is x[k]
local function evaluator(run, expressions, arithmetic)
  local leaves, names = leaves_of(expressions)
  local index = {}
  for k, name in ipairs(run.states) do index[name] = k end
  return function(t, x)
    local values = {}
    for i, name in ipairs(names) do
      if name then values[i] = core.expression(x[index[name]]) else values[i] = core.expression(t) end
    end
    return core.evaluate { arithmetic = arithmetic, expressions = expressions, leaves = leaves, values = values }
  end
end

-- The states at place i, or in the tube behind it; nil: nothing is known.
local function states_at(track, i, of)
  local x = {}
  for k = 1, #track.lo do
    local lo, hi = of.lo[k][i], of.hi[k][i]
    if not (lo and lo <= hi) then return nil end
    x[k] = core.enclosure(lo, hi)
  end
  return x
end

-- Gradient arithmetic is tight where a quantity is monotone; the first enclosure tells what all of them cost.
local function affordable(run, expressions, track)
  local tight = evaluator(run, expressions, "gradient")
  local first = states_at(track, 1, track)
  if not first then return tight end
  local began = core.cpu()
  tight(core.enclosure(track.t[1], track.t[1]), first)
  if (core.cpu() - began) * 2 * #track.t <= EVALUATING then return tight end
  return evaluator(run, expressions, "interval")
end

local function put(to, i, x)
  local known = x and not x:is_empty()
  to.lo[i], to.hi[i] = known and x.lo or nan, known and x.hi or nan
  to.partial[i] = x ~= nil and (x.partial or not known)
end

-- From a to b; of sampled systems, whose samples are at doubles in place of the decimals next to them, an ulp more.
local function span(a, b, is_sampled)
  local lo, hi = math.min(a, b), math.max(a, b)
  local ulp = is_sampled and 0x1p-51 * math.max(math.abs(lo), math.abs(hi)) or 0
  return core.enclosure(lo - ulp, hi + ulp)
end

-- States leap at instants: a tube holds what is behind the leap, the instant what was before it.
local function hull_of(a, b)
  if not (a and b) then return a end
  local list = {}
  for k, x in ipairs(a) do list[k] = x:hull(b[k]) end
  return list
end

local function fill(found, quantities, enclose, track, is_sampled)
  for i, t in ipairs(track.t) do
    local at, over = states_at(track, i, track), track.t[i + 1] and states_at(track, i, track.tube)
    if is_sampled then over = hull_of(over, at) end
    local now = at and enclose(span(t, t, is_sampled), at)
    local till = over and enclose(span(t, track.t[i + 1], is_sampled), over)
    for k in ipairs(quantities) do
      put(found[k], i, now and now[k])
      put(found[k].tube, i, till and till[k])
    end
  end
end

-- Each solution ends at its own time of the event: no instant from the first such time on has them all.
local function cut(found, track, run)
  local last
  for _, e in ipairs(run.events or {}) do
    if not run.ended_by or e.name == run.ended_by then last = e.t end -- an uncertain one is the last that was found
  end
  if not last then return end
  local forward = track.t[#track.t] >= track.t[1]
  local function is_from(t, other) if forward then return t >= other end return t <= other end
  local first, final = forward and last.lo or last.hi, forward and last.hi or last.lo
  local n = #track.t
  while n > 2 and is_from(found.t[n - 1], final) do n = n - 1 end
  for i = #found.t, n + 1, -1 do found.t[i], found.t_lo[i], found.t_hi[i] = nil, nil, nil end
  found.ends_early = true
  found.t[n], found.t_lo[n], found.t_hi[n] = final, final, final
  for i = 2, n do
    if i == n or is_from(found.t[i], first) then
      for _, of in ipairs(found) do of.lo[i], of.hi[i] = nan, nan end
    end
  end
end

local function bounds() return { lo = {}, hi = {}, partial = {} } end

-- quantities: { { g = expression of the run's states and clock }, ... }; finer: the run, or the same asked for more
function course.of(run, finer, quantities)
  local track, found, expressions = states_of.track(finer), { t = {}, t_lo = {}, t_hi = {} }, {}
  for k, quantity in ipairs(quantities) do
    found[k], expressions[k] = bounds(), quantity.g
    found[k].tube = bounds()
  end
  fill(found, quantities, affordable(finer, expressions, track), track, run.system.sampled ~= nil)
  for i, t in ipairs(track.t) do
    local time = instant.of_clock(t, run.times.shift)
    local is_double = type(time) == "number"
    found.t[i] = is_double and time or time:mid()
    found.t_lo[i], found.t_hi[i] = is_double and time or time.lo, is_double and time or time.hi
  end
  if run.ended_by or run.code == "unable.event" then cut(found, track, run) end
  return found
end

return course
