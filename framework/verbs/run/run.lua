-- run.lua -- what a simulation gives back: status, steps, enclosures at any time.
--
-- Inside, times are those of the run's clock, doubles (instant.lua); what a user sees is the time.
local bracket = require "ambit.run.bracket"
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.run.instant"

local WIDE = 2 -- times the sampled hull, from which on the text of a run says it

local Run = { __name = "run" }
local Step = { __name = "step" }
local run = {}

-- By state name; a wrong name is an error with the nearest one. Verbs take it for the plain table that it is.
local function strict(values, states)
  return setmetatable(values, {
    is_shape = "plain",
    __index = function(_, key) check.fail('there is no state `%s`%s', tostring(key), check.suggest(key, states)) end,
  })
end

local function enclosures(self, i, tube)
  local values = {}
  for k, name in ipairs(self.states) do
    local x = core.track_value(self.track, i, k, tube)
    if not x then return nil end
    values[name] = x
  end
  return strict(values, self.states)
end

-- step.x and step.tube are made when they are asked for; step.t and step.t_from are numbers, and enclosures in a run
-- that starts at a time that is no double.
function Step.__index(self, key)
  if key ~= "x" and key ~= "tube" then return nil end
  local value = enclosures(self.run, self.number, key == "tube")
  rawset(self, key, value)
  return value
end

function Step.__tostring(self) return ("step to t = %s"):format(tostring(self.t)) end

local function step_of(self, i)
  local from, to, kind, _, order, has_tube = core.track_step(self.track, i)
  return setmetatable({ run = self, number = i, clock_from = from, clock = to, kind = kind, order = order,
    t_from = instant.of_clock(from, self.times.shift), t = instant.of_clock(to, self.times.shift),
    has_tube = has_tube }, Step)
end

local methods = {}

-- for step in run:steps() do print(step.t, step.x.beta1) end
function methods:steps()
  local i, n = 0, core.track_count(self.track)
  return function()
    while i < n do
      i = i + 1
      local step = step_of(self, i)
      if step.kind == "step" then return step end
    end
  end
end

-- Within step i: from its dense enclosure, otherwise its tube, which holds for all its times.
local function within(self, i, t)
  local values = {}
  for k, name in ipairs(self.states) do
    local x = core.track_dense(self.track, i, k, t) or core.track_value(self.track, i, k, true)
    if not x then return nil end
    values[name] = x
  end
  return strict(values, self.states)
end

local function not_within(self, t)
  check.fail("at: t = %s is not within the run, which goes from %s to %s", instant.text(t),
    core.literal(self.t_start), core.literal(self.t_reached))
end

local function by_name(self, list)
  local values = {}
  for k, name in ipairs(self.states) do values[name] = list[k] end
  return strict(values, self.states)
end

local function at_double(self, t)
  if t.lo == self.times[1] then return strict(self.initial(), self.states) end
  local i, is_end = core.track_find(self.track, t.lo)
  if not i then not_within(self, t) end
  if is_end then return enclosures(self, i, false) end
  return within(self, i, t.lo)
end

-- At an instant with a bracket on the clock; of an enclosure, at its times within the run.
local function at_bracket(self, t, given)
  local first, last, lo, hi = self.times[1], self.t_reached, t.lo, t.hi
  local forward = last >= first
  local least, most = math.min(first, last), math.max(first, last)
  if t.set then lo, hi = math.max(lo, least), math.min(hi, most) end
  local is_behind = self.times.exact and not t.set and instant.is_later(t, self.times.final)
  if lo < least or hi > most or lo > hi or is_behind then not_within(self, given or t) end
  if lo == hi and not self.system.sampled then return at_double(self, { lo = lo, hi = lo }) end
  local list = bracket.values(self, forward and lo or hi, forward and hi or lo, t.near, not t.set and t or nil)
  return list and by_name(self, list)
end

-- The enclosure at a time: tight at the ends of steps and, if the run was made with dense = true, everywhere. At an
-- enclosure of times (step.t): of the states at all of them.
function methods:at(t)
  local given, start = instant.read(t, "at: t", true), self.times.start
  if start and instant.is_same(given, start) then return strict(self.initial(), self.states) end
  local own = instant.on_clock(given, self.times)
  local is_double = own.lo == own.hi and not self.system.sampled
  local values = (is_double and at_double or at_bracket)(self, own, given)
  if not values then
    check.fail('at: solver `%s` says nothing between its steps; put t into the list of times', self.solver)
  end
  return values
end

-- Did the run reach its end, of which only a bracket is known?
local function ends_in_bracket(self) return self.times.last and self.t_reached == self.times[#self.times] end

-- The states at the end as expressions: there the clock is past the true end, by up to the width of the bracket.
local function set_back(self, list)
  local way = bracket.moved(self, self.times.last, self.times[#self.times], self.times.final)
  for k, x in ipairs(list) do
    list[k] = way and x + core.expression(way[k]) or core.expression(self.x[self.states[k]])
  end
end

-- The set at the end, to go on from: an initial value for each state, as an expression of the same uncertain data that
-- the run started from (so that what the states have in common is kept) and of a fresh one for what was added on the
-- way. Solvers that do not know the set as a function of the data give a box.
function methods:set()
  local list, values = core.track_set(self.track), {}
  if list and ends_in_bracket(self) then set_back(self, list) end
  for i, name in ipairs(self.states) do
    values[name] = list and list[i] or core.expression(self.x[name])
  end
  return strict(values, self.states)
end

-- How many times as wide as the hull of a sample of the same system the enclosures are.
function methods:overestimation(sample) return require "ambit.sample.overestimation".of_run(self, sample) end

-- What was proved as a picture or a page over time, or as a table: see plot.lua.
function methods:plot(t)
  local own = { self }
  for key, value in pairs(t == nil and {} or check.table(t, "plot")) do
    if math.type(key) then check.fail("plot: unexpected entry [%s]: quantities = { ... } says what is drawn", key) end
    own[key] = value
  end
  return require "ambit.plot".plot(own)
end

function methods:csv(t) return require "ambit.plot".csv(self, t) end

check.methods(methods, Run)

-- Number of the last step; behind it there may be an event that the end of the run left open.
local function last_step(track)
  for i = core.track_count(track), 1, -1 do
    local _, _, kind = core.track_step(track, i)
    if kind == "step" then return i end
  end
  return 0
end

-- How many times as wide as sampled sets the enclosures are: an estimate, drawn when it is asked for.
local function estimate(self)
  local value = self.question and require "ambit.simulate.choice".overestimate(self, self.question)
  self.overestimate = value or false
  return value
end

function Run.__index(self, key)
  if methods[key] then return methods[key] end
  if key == "overestimate" then return estimate(self) end
  if key ~= "x" then return nil end
  local n, value = last_step(self.track), nil
  if ends_in_bracket(self) then value = at_bracket(self, self.times.final) end
  value = value or n > 0 and enclosures(self, n, false) or strict(self.initial(), self.states)
  rawset(self, "x", value)
  return value
end

function Run.__tostring(self)
  local text = ("%s at t = %s after %d steps"):format(self.status, core.literal(self.t_reached), self.step_count)
  if self.status ~= "complete" then return text .. ": " .. self.reason end
  local wide = rawget(self, "overestimate")
  if not wide or wide < WIDE then return text end
  return ("%s, with sets about %.3g times as wide as sampled ones"):format(text, wide)
end

-- facts: status, reason, t_reached, cpu_seconds, step_count, rigorous; initial(): enclosures at the start by name;
-- times: as instant.list makes them; system: for the flow over a bracket
function run.new(facts)
  return setmetatable(facts, Run)
end

function run.is(value) return getmetatable(value) == Run end

return run
