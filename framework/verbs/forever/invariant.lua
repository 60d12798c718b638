-- forever/invariant.lua -- ambit.invariant { m:dynamics() or an ode, about = { angle = 0 }, within = { angle = { lo, hi
-- } } }: a set about a state of rest that no solution leaves, ever, for any value of the data.
local ball = require "ambit.forever.ball"
local check = require "ambit.check"
local core = require "ambit.core"
local equilibria = require "ambit.equilibria"
local ode = require "ambit.ode"
local roots = require "ambit.roots"
local session = require "ambit.session"
local simulate = require "ambit.simulate"

local verb = {}

local BUDGET = 400 -- boxes that are looked at for one set

local Set = { __name = "invariant" }
local methods = {}

local function point_of(self, values, what)
  check.keys(check.table(values, what), self.states, what)
  local x = {}
  for i, name in ipairs(self.states) do
    local value = values[name]
    if value == nil then check.fail("%s: the state `%s` has no value", what, name) end
    x[i] = core.expression(value, ode.unit(self.system, i), ("%s: %s"):format(what, name))
  end
  return x
end

-- Does all of { state = value or uncertain } lie in the set, proved, for all data?
function methods:contains(values)
  local x = point_of(self, values, "contains")
  return self.set ~= nil and (self.set.by.decay:holds(self.set, x))
end

check.methods(methods, Set)
Set.__index = methods

function Set.__tostring(self)
  if self.status ~= "proved" then return self.status .. ": " .. self.reason end
  local lines = { ("%s: no solution leaves this set, and what decays in it does so at a rate of %.4g per s"):format(
    self.status, self.rate) }
  for _, name in ipairs(self.states) do
    lines[#lines + 1] = ("  %s in %s, in the end in %s"):format(name, tostring(self.box[name]),
      tostring(self.settles[name]))
  end
  return table.concat(lines, "\n")
end

-- Why the question makes no sense for the system; nil: it does.
function verb.refuse(system, what)
  if system.sampled then check.fail("%s: a sampled system moves between samples: it has no such set", what) end
  if #core.system_invariants(system.system) > 0 then
    check.fail("%s: the states of this system depend on each other (closed loops, quaternions): it has no "
      .. "set of its own about a state of rest", what)
  end
  for _, leaf in ipairs(core.leaves(system.rates)) do
    if leaf.kind == "time" then check.fail("%s: the system depends on time, and so would the set", what) end
  end
end

-- { state = number, text or enclosure }: where rest is looked for; speeds that are not named are 0
function verb.guess(about, system, what)
  if about == nil then check.fail("%s: about is missing: roughly where it rests, { state = value }", what) end
  check.keys(check.table(about, what .. ": about"), system.states, what .. ": about")
  local speeds, guess = equilibria.speeds(system), {}
  for i, name in ipairs(system.states) do
    local value = about[name]
    if value == nil and speeds[name] then value = 0 end
    if value == nil then check.fail("%s: about: the state `%s` has no value", what, name) end
    local e = core.expression(value, ode.unit(system, i), ("%s: about.%s"):format(what, name))
    local x = core.evaluate { expressions = { e } }[1]
    if not x:is_bounded() or x:is_empty() then
      check.fail("%s: about.%s: expected a number, got %s", what, name, tostring(value))
    end
    guess[i] = x:mid()
  end
  return guess
end

-- { state = { lo, hi } } -> { [state] = enclosure }
function verb.within(within, system, what)
  if within == nil then return {} end
  check.keys(check.table(within, what .. ": within"), system.states, what .. ": within")
  local ranges = {}
  for i, name in ipairs(system.states) do
    if within[name] ~= nil then
      ranges[name] = roots.range(within[name], ("%s: within.%s"):format(what, name), ode.unit(system, i))
    end
  end
  if next(ranges) == nil then check.fail("%s: within is empty: { state = { lo, hi } }", what) end
  return ranges
end

-- Half the ranges, as scales of the states, if all are given.
local function scales_of(system, within)
  local list = {}
  for i, name in ipairs(system.states) do
    local range = within[name]
    if not range or not range:is_bounded() then return nil end
    list[i] = range:rad()
  end
  return list
end

-- q: { system, guess, within, budget } -> the set, unfinished
function verb.find(q)
  local start = core.cpu()
  local found, why = ball.find { system = q.system, guess = q.guess, within = q.within,
    scales = scales_of(q.system, q.within), budget = q.budget or BUDGET }
  local self = setmetatable({ status = found and "proved" or "undecided", reason = why or "", system = q.system,
    states = q.system.states }, Set)
  if found then
    self.set, self.settled, self.rate = found.set, found.settled, found.set.rate
    self.centre, self.box, self.settles = {}, {}, {}
    local one = found.set.by
    local box, settles = one.decay:ranges(one.frame, found.set), one.decay:ranges(one.frame, found.settled)
    for i, name in ipairs(self.states) do
      self.centre[name], self.box[name], self.settles[name] = found.set.centre[i], box[i], settles[i]
    end
  end
  self.cpu_seconds = core.cpu() - start
  return self
end

local function record(self)
  if not core.recording() then return end
  local fields = {}
  for _, name in ipairs(self.states) do
    fields[#fields + 1], fields[#fields + 2] = name, self.box[name]
  end
  core.record("value", { "name", "box", "value", fields })
end

function verb.invariant(t)
  check.table(t, "invariant")
  local system = simulate.system(t, "invariant")
  check.keys(t, { "about", "within", "budget" }, "invariant", 1)
  verb.refuse(system, "invariant")
  local budget = t.budget == nil and BUDGET or check.count(t.budget, "invariant: budget")
  local self = verb.find { system = system, guess = verb.guess(t.about, system, "invariant"),
    within = verb.within(t.within, system, "invariant"), budget = budget }
  self.code = self.status == "proved" and "ok" or "unable.undecided"
  if self.set then record(self) end
  session.finish("invariant", self, {}, { "budget", budget })
  return self
end

return verb
