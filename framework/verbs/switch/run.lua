-- switch/run.lua -- what ambit.hybrid gives back: as a run, with the modes it went through.
--
-- It is a list of parts in the order of time, which touch: legs in one mode, whose steps a solver made; and switches,
-- during which some solutions are in the old mode and some in the new one.
local bracket = require "ambit.run.bracket"
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.run.instant"

local Run = { __name = "hybrid run" }
local switch_run = {}

local function picked(states, box)
  local values = {}
  for _, name in ipairs(states) do values[name] = box[name] end
  return values
end

function switch_run.new(q)
  local start = {}
  for i, x in ipairs(core.evaluate { expressions = q.initial }) do start[q.system.states[i]] = x end
  return setmetatable({ parts = {}, events = {}, modes = {}, list = {}, t_start = q.times[1], t_reached = q.times[1],
    x = start, initial = start, solver = q.solver, times = q.times }, Run)
end

local function add_step(result, step)
  result.list[#result.list + 1] = step
  result.t_reached, result.x = step.clock, step.x
  step.t_from, step.t = instant.of_clock(step.clock_from, result.times.shift),
    instant.of_clock(step.clock, result.times.shift)
  if core.recording() then
    local x = {}
    for _, name in ipairs(check.sorted(step.x)) do x[#x + 1], x[#x + 2] = name, step.x[name] end
    core.record("step", { "t", core.interval(step.t), "span", core.interval(step.t_from):hull(step.t), "mode",
      step.mode, "x", x })
  end
end

local function enter(result, mode)
  if result.modes[#result.modes] ~= mode.name then result.modes[#result.modes + 1] = mode.name end
end

-- The steps of a leg up to where its mode may have been left.
function switch_run.add_leg(result, mode, found)
  enter(result, mode)
  for _, piece in ipairs(found.runs) do
    local first = #result.list + 1
    for step in piece.run:steps() do
      if step.clock > piece.till then break end
      add_step(result, { clock_from = step.clock_from, clock = step.clock, x = step.x, mode = mode.name, of = step })
    end
    if #result.list >= first then
      result.parts[#result.parts + 1] = { from = result.list[first].clock_from, till = result.t_reached,
        run = piece.run }
    end
  end
end

local function widen(tube, x, states)
  for _, name in ipairs(states) do tube[name] = tube[name] and tube[name]:hull(x[name]) or x[name] end
end

-- Where the states of `states` were over the whole of a run.
local function widen_by_run(tube, run, states)
  for step in run:steps() do widen(tube, step.has_tube and step.tube or step.x, states) end
end

-- Solutions on their way to the guard, and behind it, between t and T.
function switch_run.add_switch(result, mode, guard, image, away, t, T)
  local source, target, tube = mode.system.states, guard.to.system.states, {}
  widen_by_run(tube, image.run, source)
  widen_by_run(tube, away.run, target)
  local when = instant.of_clock(image.when, result.times.shift)
  result.events[#result.events + 1] = { name = guard.name, from = mode.name, to = guard.to.name, t = when,
    x = picked(source, image.run.x), clock = image.when, certain = image.run.rigorous }
  if core.recording() then
    core.record("event", { "t", when, "name", guard.name, "from", mode.name, "to", guard.to.name })
  end
  result.parts[#result.parts + 1] = { from = t, till = T, tube = tube }
  result.modes[#result.modes + 1] = guard.to.name
  add_step(result, { clock_from = t, clock = T, x = picked(target, away.run.x), tube = tube,
    mode = guard.to.name })
end

local methods = {}

-- step.t_from, step.t, step.x, step.tube, step.mode
function methods:steps()
  local i = 0
  return function()
    i = i + 1
    local step = self.list[i]
    if step and not step.tube and step.of then step.tube = step.of.tube end
    return step
  end
end

local function not_within(self, t)
  check.fail("at: t = %s is not within the run, which goes from %s to %s", instant.text(t), core.literal(self.t_start),
    core.literal(self.t_reached))
end

local function at_double(self, t)
  if t == self.times[1] then return self.initial end
  for _, part in ipairs(self.parts) do
    if part.from <= t and t <= part.till then
      if t == part.till and not part.run then break end
      return part.run and part.run:at(t) or part.tube
    end
  end
  for _, step in ipairs(self.list) do
    if step.clock == t then return step.x end
  end
end

-- Of all parts that the bracket meets; t: the instant, if there is just one.
local function at_bracket(self, lo, hi, t)
  local values
  for _, part in ipairs(self.parts) do
    local from, to = math.max(lo, part.from), math.min(hi, part.till)
    if from < to then
      local box = part.tube
      if part.run then
        local list = bracket.values(part.run, from, to, from, from == lo and to == hi and t or nil)
        if not list then check.fail('at: solver `%s` says nothing between its steps', self.solver) end
        box = {}
        for k, name in ipairs(part.run.states) do box[name] = list[k] end
      end
      values = values or {}
      widen(values, box, check.sorted(box))
    end
  end
  return values
end

-- The enclosure at a time: of what is in the one mode or the other while solutions switch.
function methods:at(t)
  local given, start = instant.read(t, "at: t", true), self.times.start
  if start and instant.is_same(given, start) then return self.initial end
  local own, values = instant.on_clock(given, self.times), nil
  local lo, hi = own.lo, own.hi
  if own.set then lo, hi = math.max(lo, self.times[1]), math.min(hi, self.t_reached) end -- its times within the run
  if lo == hi then
    values = at_double(self, lo)
  elseif lo >= self.times[1] and hi <= self.t_reached and lo < hi then
    values = at_bracket(self, lo, hi, not own.set and own or nil)
  end
  return values or not_within(self, given)
end

-- Where the end is known by a bracket, the states at the end are those in it.
local function end_in_bracket(result)
  local last, far = result.times.last, result.times[#result.times]
  if last and result.status == "complete" and result.t_reached == far then
    result.x = at_bracket(result, last, far, result.times.final) or result.x
  end
end

function switch_run.finish(result, q)
  result.cpu_seconds, result.step_count, result.rigorous = q.cpu_seconds, #result.list, q.rigorous
  for _, e in ipairs(result.events) do
    e.certain = e.certain and q.rigorous and not instant.is_behind(q.times, e.clock)
  end
  end_in_bracket(result)
end

check.methods(methods, Run)
Run.__index = methods

function Run.__tostring(self)
  local text = ("%s at t = %s after %d switches"):format(self.status, core.literal(self.t_reached), #self.events)
  return self.status == "complete" and text or text .. ": " .. self.reason
end

return switch_run
