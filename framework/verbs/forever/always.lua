-- forever/always.lua -- ambit.verify { ..., t = math.huge }: conditions for all times.
--
-- A set S about the state of rest that nothing leaves, and in which the conditions hold, is proved first; then, by a
-- run up to some time, that the conditions hold until then and that every solution is in S at its end.
local ball = require "ambit.forever.ball"
local check = require "ambit.check"
local conditions = require "ambit.verify.condition"
local core = require "ambit.core"
local equilibria = require "ambit.equilibria"
local invariant = require "ambit.forever.invariant"
local report = require "ambit.verify.report"
local simulate = require "ambit.simulate"

local always = {}

local SHRINK, SHRINKS = 0.8, 60
local CUTS = 200 -- boxes for such a set
local BLIND = 5 -- times 1/rate: how far a run looks for what refutes a condition, without a set to run to
local SHARES = { 0.3, 1, 3 } -- of the time that the decay in the set suggests: for how long solutions are followed

-- Does the condition hold all over a set?
local function holds(self, set, g)
  local leaves, values = {}, {}
  for i, x in ipairs(set.by.decay:ranges(set.by.frame, set)) do
    leaves[i], values[i] = self.system.symbols[i], core.expression(x)
  end
  for _, arithmetic in ipairs { core.default.linear, core.default.ranges } do
    local value = core.evaluate { arithmetic = arithmetic, expressions = { g }, leaves = leaves, values = values }[1]
    if not value:is_empty() and not value.partial and value.hi <= 0 then return true end
  end
  return false
end

-- The largest part of the set, of the same shape, in which all conditions hold and which nothing leaves; or nil and the
-- name of one that fails.
local function safe_part(self, list)
  local whole, failing = self.set, nil
  local part = whole
  for _ = 1, SHRINKS do
    failing = nil
    for _, c in ipairs(list) do
      if c.kind == "always" and not holds(self, part, c.g) then failing = c.name end
    end
    if not failing then
      local proved = part == whole and whole or ball.try(whole.by, part.outer, CUTS)
      if proved then return proved end
    end
    part = { centre = whole.centre, outer = part.outer * SHRINK, by = whole.by }
    if part.outer < whole.by.needed then break end
  end
  return nil, failing
end

-- Are all solutions in the set at the time `till`? The set at the end of a run is known as functions of the data.
local function enters(t, self, set, start, till)
  local q = simulate.request({ t[1], initial = t.initial, t = { start, till }, solver = t.solver }, "verify", nil, {})
  q.run_options = { silent = true }
  local run, x = simulate.solve(q), {}
  if run.status ~= "complete" or not run.rigorous then return false end
  local good, found = pcall(run.set, run)
  if not good then return false end -- a set in pieces is no function of the data
  for i, name in ipairs(self.states) do x[i] = found[name] end
  return (set.by.decay:holds(set, x))
end

-- A time at which all solutions are in the set; nil: none was found.
local function arrival(t, self, set, start, square)
  local times = 1 + math.log(math.max(1, math.sqrt(math.max(square:mid(), 0)) / set.radius))
  for _, share in ipairs(SHARES) do
    local till = start + share * times / set.by.rate
    if enters(t, self, set, start, till) then return till end
  end
end

local function check_request(t, list)
  if t.at_end ~= nil then check.fail "verify: at_end: there is no last time if t = math.huge" end
  if #list == 0 then check.fail "verify: expected a condition: safe or reach" end
  for _, c in ipairs(list) do
    for _, leaf in ipairs(core.leaves { c.g }) do
      if leaf.kind == "time" then check.fail("verify: %s: a condition for all times may not depend on time", c.name) end
    end
  end
end

-- Where rest is looked for if nobody says: the middle of the starts, at speed 0.
local function about_start(system, initial)
  local about = {}
  for i, name in ipairs(system.states) do about[name] = initial[i] end
  for name in pairs(equilibria.speeds(system)) do about[name] = 0 end
  return about
end

-- The request for the times up to `till`, for some time if none is given.
function always.finite(t, till)
  local start, copy = type(t.t) == "table" and t.t[1] or 0, {}
  for key, value in pairs(t) do copy[key] = value end
  copy.t, copy.about = { start, till or start + BLIND }, nil
  return copy
end

-- t: the request of ambit.verify; ask(t): its answer for a finite time; nothing(list, reason): one without any run,
-- proved if there is no reason why not. -> report
function always.verify(t, ask, nothing)
  local system = simulate.system(t, "verify")
  invariant.refuse(system, "verify: t = math.huge")
  local list = conditions.read(t, system)
  check_request(t, list)
  local start = type(t.t) == "table" and t.t[1] or 0
  local initial = simulate.initial(t.initial, system, "verify")
  local about = t.about or about_start(system, initial)
  local self = invariant.find { system = system, guess = invariant.guess(about, system, "verify"), within = {} }
  -- without a set a condition can still be refuted
  local function without(reason)
    local result = report.for_ever(ask(always.finite(t, start + BLIND / (self.set and self.set.by.rate or 1))))
    if result.status == "refuted" then return result end
    return nothing(list, reason)
  end
  if not self.set then return without("no set was found that nothing leaves: " .. self.reason) end
  local set, failing = safe_part(self, list)
  if not set then
    return without(("the sets that nothing leaves reach to where `%s` is not known to hold"):format(
      failing or list[1].name))
  end
  local inside, square = set.by.decay:holds(set, initial)
  local reaches = false
  for _, c in ipairs(list) do reaches = reaches or c.kind == "once" end
  if inside and not reaches then return nothing(list) end
  local till = arrival(t, self, set, start, square)
  if not till then return without "not all solutions were seen to come into a set that nothing leaves" end
  local result = report.for_ever(ask(always.finite(t, till)))
  result.followed = till
  return result
end

return always
