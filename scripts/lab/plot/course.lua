-- plot/course.lua -- what a run proved of quantities along its time, as plain numbers.
--
-- A course is { t, [k] = { lo, hi, tube = { lo, hi } } }: quantity k is within [lo[i], hi[i]] at t[i], and within its
-- tube i at all times from t[i] to t[i + 1]; NaN where nothing is known.
local core = require "ambit.core"
local instant = require "ambit.run.instant"
local states_of = require "ambit.compare.course"

local course = {}

local FEW = 100         -- steps: a run with fewer is repeated with dense output
local MOST_SECONDS = 20 -- that this may take
local EVALUATING = 10   -- seconds for all enclosures in gradient arithmetic; if it takes more, plain intervals

local nan = 0 / 0

-- A run whose steps are long says more about the way from one to the next when it is asked for dense output. Where
-- that proves less, the first answer stands.
function course.finer(run)
  local question = run.question
  if not (question and question.again) or run.step_count >= FEW or run.cpu_seconds > MOST_SECONDS then return run end
  local good, again = pcall(question.again, { dense = true, last = false })
  return good and again.status == run.status and again.t_reached == run.t_reached and again or run
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
    for i, name in ipairs(names) do values[i] = core.expression(name and x[index[name]] or t) end
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
  to.lo[i], to.hi[i] = x and not x:is_empty() and x.lo or nan, x and not x:is_empty() and x.hi or nan
end

local function span(a, b) return core.enclosure(math.min(a, b), math.max(a, b)) end

local function fill(found, quantities, enclose, track)
  for i, t in ipairs(track.t) do
    local at, over = states_at(track, i, track), track.t[i + 1] and states_at(track, i, track.tube)
    local now, till = at and enclose(span(t, t), at), over and enclose(span(t, track.t[i + 1]), over)
    for k in ipairs(quantities) do
      put(found[k], i, now and now[k])
      put(found[k].tube, i, till and till[k])
    end
  end
end

-- quantities: { { g = expression of the run's states and clock }, ... }
function course.of(run, quantities)
  local track, found, expressions = states_of.track(run), {}, {}
  for k, quantity in ipairs(quantities) do
    found[k], expressions[k] = { lo = {}, hi = {}, tube = { lo = {}, hi = {} } }, quantity.g
  end
  fill(found, quantities, affordable(run, expressions, track), track)
  found.t = {}
  for i, t in ipairs(track.t) do
    local time = instant.of_clock(t, run.times.shift)
    found.t[i] = type(time) == "number" and time or time:mid()
  end
  return found
end

return course
