-- poincare/orbit.lua -- is there a periodic orbit? Brouwer: a continuous map of a box into itself has a fixed point.
--
-- The section must fix one state (g is linear in it and depends on nothing else), the initial values of the others must
-- each be linear in an uncertain datum of its own. Then the initial set is a box of the section; if its image lies
-- inside, every value of the remaining data has a periodic orbit through it. Proof: docs/numerics/events.md.
local condense = require "ambit.leg.condense"
local core = require "ambit.core"

local orbit = {}

local function no(...) return { proved = false, reason = (...):format(select(2, ...)) } end

local function value(e, leaf, at)
  local leaves, values = {}, {}
  if leaf then leaves[1], values[1] = leaf, core.expression(at) end
  return core.evaluate { expressions = { e }, leaves = leaves, values = values }[1]
end

-- The number of the one state that the section fixes.
local function fixed_state(q)
  local leaves = core.leaves { q.g }
  for i, symbol in ipairs(q.system.symbols) do
    if #leaves == 1 and leaves[1].expression == symbol then
      local slope = core.derivative(q.g, symbol)
      if core.is_constant(slope) and value(slope):mig() > 0 then return i end
    end
  end
end

-- Numbers that the linear expression e surely takes: between its values at the ends of its datum.
local function inner(e, leaf)
  if not core.is_constant(core.derivative(e, leaf.expression)) then return end
  local a, b = value(e, leaf.expression, leaf.lo), value(e, leaf.expression, leaf.hi)
  if a.lo > b.lo then a, b = b, a end
  if a.hi <= b.lo then return a.hi, b.lo end
end

local function uses_datum(list, leaf)
  for _, other in ipairs(condense.unknowns(list)) do
    if other.expression == leaf.expression then return true end
  end
end

-- Is the image of state i inside what the initial set has of it? Otherwise why not.
local function objection(map, i, image)
  local q, e = map.request, map.initial[i]
  local name, own = q.system.states[i], condense.unknowns { map.initial[i] }
  if #own ~= 1 then
    return no("the initial value of `%s` is not a box of its own: it has %d uncertain data", name, #own)
  end
  for k, other in ipairs(map.initial) do
    if k ~= i and uses_datum({ other }, own[1]) then
      return no("the initial values of `%s` and `%s` are not independent", name, q.system.states[k])
    end
  end
  if uses_datum(q.system.rates, own[1]) then
    return no("the datum of the initial value of `%s` is one of the system, too", name)
  end
  local lo, hi = inner(e, own[1])
  if not lo then return no("the initial value of `%s` is not linear in its datum", name) end
  if image.lo < lo or image.hi > hi then
    return no("`%s` returns in %s, which is not inside the initial [%s, %s]", name, tostring(image), core.literal(lo),
      core.literal(hi))
  end
end

local JUDGED = { attracting = true, multiplier = true, derivative = true }

-- Whether an orbit attracts takes a longer run: it is found out when somebody asks.
local function when_asked(map, fixed, found, key)
  if not JUDGED[key] or rawget(found, "attracting") ~= nil then return nil end
  local judged, why = require "ambit.poincare.attract".judge(map, fixed)
  if not judged then
    found.attracting, found.reason = false, "whether it attracts is not known: " .. why
    return rawget(found, key)
  end
  found.attracting, found.multiplier = judged.attracting, judged.multiplier
  if not judged.attracting then found.reason = "the derivative of the map is not seen to contract" end
  found.derivative = judged.derivative
  return found[key]
end

function orbit.prove(map)
  local q, last = map.request, map.returns[map.request.returns]
  if #core.system_invariants(q.system.system) > 0 then
    return no "the system has constraints: its initial states are no box"
  end
  if not last then return no("%s", map.reason) end
  if not map.rigorous then return no "the solver proves nothing" end
  for _, leaf in ipairs(core.leaves(q.system.rates)) do
    if leaf.kind == "time" then return no "the system depends on time" end
    if leaf.kind == "varying" then return no("`%s` varies in time: the next turn is another map", leaf.name) end
  end
  local fixed = fixed_state(q)
  if not fixed then return no "the section does not fix a state" end
  local start = value(core.substitute({ q.g }, { q.system.symbols[fixed] }, { map.initial[fixed] })[1])
  if start.lo ~= 0 or start.hi ~= 0 then
    return no("the initial set is not on the section: g is in %s there", tostring(start))
  end
  for i, name in ipairs(q.system.states) do
    local why = i ~= fixed and objection(map, i, last.x[name])
    if why then return why end
  end
  local found = { proved = true, period = last.t - core.interval(q.start), x = last.x }
  return setmetatable(found, { __index = function(self, key) return when_asked(map, fixed, self, key) end })
end

return orbit
