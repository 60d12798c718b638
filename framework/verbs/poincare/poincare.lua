-- poincare.lua -- ambit.poincare { ode, section = function(s, p, t) ... end, direction = "rising", initial = ..., t_max
-- = 20, returns = 2 }: the set in which the solutions return to a section, and when.
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.run.instant"
local event = require "ambit.event"
local leg = require "ambit.leg"
local once = require "ambit.poincare.once"
local orbit = require "ambit.poincare.orbit"
local session = require "ambit.session"
local simulate = require "ambit.simulate"
local condense = require "ambit.leg.condense"
local surface = require "ambit.leg.surface"

local verb = {}

local Map = { __name = "poincare" }
Map.__index = Map

-- The set of return i (the last one) as initial values, by state.
function Map:set(i)
  local crossing = self.returns[i or #self.returns]
  if not crossing then check.fail("set: there is no return %s", tostring(i)) end
  return crossing.set
end

-- { proved, period, x, reason, attracting, ... }: is there a periodic orbit through the initial set, for every value of
-- the data?
function Map:orbit() return orbit.prove(self) end

check.methods(Map, Map)

function Map.__tostring(self)
  local text = ("%s after %d return%s"):format(self.status, #self.returns, #self.returns == 1 and "" or "s")
  return self.status == "complete" and text or text .. ": " .. self.reason
end

local own_keys = { "section", "direction", "t_max", "returns", "t_start" }

local function request(t)
  check.table(t, "poincare")
  if t.t_max == nil then check.fail "poincare: t_max is missing: the time by which the returns have happened, s" end
  local copy = {}
  for key, value in pairs(t) do copy[key] = value end
  local start, latest = instant.read(t.t_start or 0, "poincare: t_start"), instant.read(t.t_max, "poincare: t_max")
  copy.t = { start.hi, latest.lo } -- the legs have clocks of their own, and take the start as it is
  if t.t ~= nil then check.fail("poincare: unknown key `t`; did you mean `t_max`?") end
  local q = simulate.request(copy, "poincare", nil, own_keys)
  if q.times[2] < q.times[1] then check.fail "poincare: t_max must be later than the start" end
  q.start = instant.expression(start)
  leg.prepare(q, t)
  q.returns = t.returns == nil and 1 or check.count(t.returns, "poincare: returns")
  q.g = event.formula(t.section, q.system, "poincare: section")
  q.direction = event.direction(t.direction, "poincare: direction")
  local formulas = table.move(q.initial, 1, #q.initial, 2, { q.g })
  q.data = condense.data(table.move(q.system.rates, 1, #q.system.rates, #formulas + 1, formulas))
  return q
end

local function depends_on_time(q)
  local list = table.move(q.system.rates, 1, #q.system.rates, 2, { q.g })
  for _, leaf in ipairs(core.leaves(list)) do
    if leaf.kind == "time" then return true end
  end
  return false
end

local function describe(q, image, found)
  local x, set, fields = {}, {}, {}
  for i, name in ipairs(q.system.states) do
    x[name], set[name] = image.run.x[name], image.x[i]
    fields[2 * i - 1], fields[2 * i] = name, x[name]
  end
  if core.recording() then core.record("event", { "t", image.when, "name", "section", "x", fields }) end
  return { t = image.when, x = x, set = set, direction = found.direction, certain = q.rigorous }
end

function verb.poincare(t)
  local q = request(t)
  local system, g, x, now, latest = q.system, q.g, q.initial, q.start, q.times[2]
  if depends_on_time(q) then
    local clock
    system, clock = surface.with_clock(system)
    g = core.substitute({ g }, { core.time() }, { clock })[1]
    x = table.move(x, 1, #x, 1, {})
    x[#x + 1] = now
  end
  local map = setmetatable({ status = "complete", reason = "", returns = {}, request = q, initial = q.initial }, Map)
  for i = 1, q.returns do
    local image, found, status, code = once(q, system, g, x, now, latest)
    if not image then
      map.status, map.code, map.reason = status, code, ("return %d: %s"):format(i, found)
      break
    end
    map.returns[i] = describe(q, image, found)
    x, now = image.x, image.t
  end
  map.cpu_seconds, map.step_count, map.rigorous = q.cpu_seconds, q.step_count, q.rigorous
  session.finish("poincare", map, q.report, { "solver", q.solver, "options", q.settings, "t_max", latest })
  return map
end

return verb
