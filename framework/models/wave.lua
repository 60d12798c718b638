-- wave.lua -- functions of time that may be drawn for what varies: waves between the bounds, from a sine to nearly a
-- square, of any frequency and phase; where the rate is bounded, from a sine to nearly a triangle. Each is allowed;
-- which of them is drawn are data like others.
local core = require "ambit.core"
local ode = require "ambit.ode"

local wave = {}

local SLOWEST, FASTEST = 0.5, 50 -- periods in the time span
local STEEPEST = 20              -- of a sine that is cut off at 1
local SHARPEST = 0.999           -- of a triangle, where 1 has corners
local INSIDE = 1 - 1e-9          -- of bounds, for what is rounded

-- The angle of a wave over the times from t0 on, and how fast it grows.
local function angle_of(t0, span)
  local pi = core.pi()
  local periods = SLOWEST * core.exp(core.between(0, 1, "frequency of a wave") * core.log(FASTEST / SLOWEST))
  local phase = core.between(0, 1, "phase of a wave")
  return 2 * pi * (periods * (core.time() - t0) / span + phase), 2 * pi * periods / span
end

-- The wave in [-1, 1].
local function any_wave(t0, span)
  return core.max(-1, core.min(1, core.between(1, STEEPEST, "steepness of a wave") * core.sin((angle_of(t0, span)))))
end

-- The wave in [lo, hi] that nowhere changes faster than `rate`; its derivative by time; its value at the time t0, from
-- `start` if that is given.
local function slow_wave(t0, span, lo, hi, rate, start)
  local angle, speed = angle_of(t0, span)
  local sharp = core.between(SHARPEST / 10, SHARPEST, "sharpness of a wave")
  local whole, sine = core.asin(sharp), core.sin(angle)
  local first = core.substitute({ sine }, { core.time() }, { core.expression(t0) })[1]
  local shape, at_first = core.asin(sharp * sine) / whole, core.asin(sharp * first) / whole
  local middle, room
  if start then
    room = 0.5 * core.min(hi - start, start - lo)
  else
    local share = core.between(-1, 1, "middle of a wave")
    middle, room = 0.5 * (lo + hi) + 0.5 * (hi - lo) * share, 0.5 * (hi - lo) * (1 - core.abs(share))
  end
  local height = INSIDE * core.min(core.max(room, 0), rate * whole / (sharp * speed))
  middle = middle or start - height * at_first
  local slope = sharp * speed * core.cos(angle) / (core.sqrt(1 - (sharp * sine) ^ 2) * whole)
  return middle + height * shape, height * slope, middle + height * at_first
end

-- What may depend on what varies: right-hand sides, and laws of sampled controllers.
function wave.formulas(system)
  local all = table.move(system.rates, 1, #system.rates, 1, {})
  if not system.sampled then return all end
  local laws = require "ambit.sampled".formulas(system)
  return table.move(laws, 1, #laws, #all + 1, all)
end

-- How fast a function may change both ways.
local function rate_of(about)
  return core.expression(math.max(0, math.min(-core.tight(about.rate.lo).hi, core.tight(about.rate.hi).lo)))
end

-- Of a state that is a function of bounded rate, by the leaf of its rate: its number among the states, and what it is.
local function carried_by(system, leaf)
  for k, one in ipairs(system.carried or {}) do
    if one.rate_number == leaf.number then return system.plain + k, one end
  end
end

-- What takes the place of a leaf, or nil; changes the start of a state that it is the rate of.
local function stand_in(q, leaf, span, initial)
  local varying = require "ambit.varying"
  local t0, at, one = q.times[1], carried_by(q.system, leaf)
  local of = one and one.leaf or leaf
  if of.inner_lo > of.inner_hi then return nil end
  local lo, hi = core.expression(of.inner_lo), core.expression(of.inner_hi)
  if one then
    local own = not varying.is_start(one, q.initial[at]) and q.initial[at] or nil
    local _, slope, first = slow_wave(t0, span, lo, hi, rate_of(one.about), own)
    initial[at] = first
    return slope
  end
  local about = varying.of(leaf)
  if about then return (slow_wave(t0, span, lo, hi, rate_of(about))) end
  return 0.5 * (lo + hi) + 0.5 * (hi - lo) * any_wave(t0, span)
end

-- A request without what varies: waves take its place; nil: of some of it no value is known to be allowed.
function wave.instead(q)
  local from, to, initial = {}, {}, table.move(q.initial, 1, #q.initial, 1, {})
  local span = math.abs(q.times[#q.times] - q.times[1])
  for _, leaf in ipairs(core.leaves(wave.formulas(q.system))) do
    if leaf.kind == "varying" then
      local value = stand_in(q, leaf, span, initial)
      if not value then return nil end
      from[#from + 1], to[#to + 1] = leaf.expression, value
    end
  end
  if #from == 0 then return q end
  local system = setmetatable({ system = ode.replaced(q.system, from, to) }, { __index = q.system })
  return setmetatable({ system = system, initial = initial }, { __index = q })
end

return wave
