-- switch_run.lua -- what ambit.hybrid gives back: as a run, with the modes it went through.
--
-- It is a list of parts in the order of time, which touch: legs in one mode, whose steps a solver made; and switches,
-- during which some solutions are in the old mode and some in the new one.
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.instant"

local Run = { __name = "hybrid run" }
local switch_run = {}

local function picked(states, box)
  local values = {}
  for _, name in ipairs(states) do values[name] = box[name] end
  return values
end

function switch_run.new(q)
  local start = {}
  for i, x in ipairs(core.evaluate("interval", {}, q.initial, {}, {})) do start[q.system.states[i]] = x end
  return setmetatable({ parts = {}, events = {}, modes = {}, list = {}, t_start = q.times[1], t_reached = q.times[1],
    x = start, initial = start, solver = q.solver }, Run)
end

local function add_step(result, step)
  result.list[#result.list + 1] = step
  result.t_reached, result.x = step.t, step.x
  if core.recording() then
    local x = {}
    for _, name in ipairs(check.sorted(step.x)) do x[#x + 1], x[#x + 2] = name, step.x[name] end
    core.record("step", { "t", core.interval(step.t), "span", core.interval(step.t_from, step.t), "mode", step.mode,
      "x", x })
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
      if step.t > piece.till then break end
      add_step(result, { t_from = step.t_from, t = step.t, x = step.x, mode = mode.name, of = step })
    end
    if #result.list >= first then
      result.parts[#result.parts + 1] = { from = result.list[first].t_from, till = result.t_reached, run = piece.run }
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
  result.events[#result.events + 1] = { name = guard.name, from = mode.name, to = guard.to.name, t = image.when,
    x = picked(source, image.run.x), certain = image.run.rigorous }
  if core.recording() then
    core.record("event", { "t", image.when, "name", guard.name, "from", mode.name, "to", guard.to.name })
  end
  result.parts[#result.parts + 1] = { from = t, till = T, tube = tube }
  result.modes[#result.modes + 1] = guard.to.name
  add_step(result, { t_from = t, t = T, x = picked(target, away.run.x), tube = tube,
    mode = guard.to.name })
end

function switch_run.finish(result, q)
  result.cpu_seconds, result.step_count, result.rigorous = q.cpu_seconds, #result.list, q.rigorous
  for _, e in ipairs(result.events) do e.certain = e.certain and q.rigorous end
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

-- The enclosure at a time: of what is in the one mode or the other while solutions switch.
function methods:at(t)
  t = instant.of(t, "at: t")
  if t == self.t_start then return self.initial end
  for _, part in ipairs(self.parts) do
    if part.from <= t and t <= part.till then
      if t == part.till and not part.run then break end
      return part.run and part.run:at(t) or part.tube
    end
  end
  for _, step in ipairs(self.list) do
    if step.t == t then return step.x end
  end
  check.fail("at: t = %s is not within the run, which goes from %s to %s", core.literal(t), core.literal(self.t_start),
    core.literal(self.t_reached))
end

check.methods(methods, Run)
Run.__index = methods

function Run.__tostring(self)
  local text = ("%s at t = %s after %d switches"):format(self.status, core.literal(self.t_reached), #self.events)
  return self.status == "complete" and text or text .. ": " .. self.reason
end

return switch_run
