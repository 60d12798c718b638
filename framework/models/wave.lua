-- wave.lua -- functions of time that may be drawn for what varies: waves between the bounds, from a sine to nearly a
-- square, of any frequency and phase. Each is allowed; which of them is drawn are data like others.
local core = require "ambit.core"
local ode = require "ambit.ode"

local wave = {}

local SLOWEST, FASTEST = 0.5, 50 -- periods in the time span
local STEEPEST = 20              -- of a sine that is cut off at 1

-- The wave in [-1, 1], over the times from t0 on.
local function any_wave(t0, span)
  local pi = core.pi()
  local periods = SLOWEST * core.exp(core.between(0, 1, "frequency of a wave") * core.log(FASTEST / SLOWEST))
  local phase = core.between(0, 1, "phase of a wave")
  local sine = core.sin(2 * pi * (periods * (core.time() - t0) / span + phase))
  return core.max(-1, core.min(1, core.between(1, STEEPEST, "steepness of a wave") * sine))
end

-- What may depend on what varies: right-hand sides, and laws of sampled controllers.
function wave.formulas(system)
  local all = table.move(system.rates, 1, #system.rates, 1, {})
  if not system.sampled then return all end
  local laws = require "ambit.sampled".formulas(system)
  return table.move(laws, 1, #laws, #all + 1, all)
end

-- A request without what varies: waves take its place; nil: of some of it no value is known to be allowed.
function wave.instead(q)
  local from, to = {}, {}
  local span = math.abs(q.times[#q.times] - q.times[1])
  for _, leaf in ipairs(core.leaves(wave.formulas(q.system))) do
    if leaf.kind == "varying" then
      if leaf.inner_lo > leaf.inner_hi then return nil end
      local lo, hi = core.expression(leaf.inner_lo), core.expression(leaf.inner_hi)
      from[#from + 1] = leaf.expression
      to[#to + 1] = 0.5 * (lo + hi) + 0.5 * (hi - lo) * any_wave(q.times[1], span)
    end
  end
  if #from == 0 then return q end
  local system = setmetatable({ system = ode.replaced(q.system, from, to) }, { __index = q.system })
  return setmetatable({ system = system }, { __index = q })
end

return wave
