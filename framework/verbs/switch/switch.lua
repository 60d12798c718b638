-- switch.lua -- ambit.hybrid { modes = { fly = { ode, guards = { { g = ..., direction = "falling", to = "fly", reset =
-- function(s, p, t) return { v = -0.8 * s.v } end } } } }, mode = "fly", initial = ..., t = { 0, 3 } }: a model that
-- switches from mode to mode where a guard's g crosses 0. A solution stays in a mode until the first guard is met.
local check = require "ambit.check"
local condense = require "ambit.leg.condense"
local core = require "ambit.core"
local formula = require "ambit.formula"
local event = require "ambit.event"
local instant = require "ambit.run.instant"
local leg = require "ambit.leg"
local ode = require "ambit.ode"
local session = require "ambit.session"
local simulate = require "ambit.simulate"
local surface = require "ambit.leg.surface"
local switch_run = require "ambit.switch.run"

local verb = {}

local SWITCHES = 1000 -- at most, unless the user says otherwise
local SHARE = 1e-3    -- of the time in the last mode: how far behind a switch the solutions meet at one instant

-- -- reading the model

-- The state of a system with this name, or nil.
local function namesake(system, name)
  for i, own in ipairs(system.states) do
    if own == name then return ode.symbol(system, i) end
  end
end

local function read_reset(guard, place, source, target)
  local given = guard.entry.reset
  if type(given) == "function" then given = formula.call(given, place .. ".reset", ode.arguments(source, true)) end
  given = given == nil and {} or check.table(given, place .. ".reset")
  check.keys(given, target.states, place .. ".reset")
  local list = {}
  for i, name in ipairs(target.states) do
    local value = given[name]
    if value == nil then value = namesake(source, name) end
    if value == nil then
      check.fail("%s: reset: the state `%s` of mode `%s` gets no value", place, name, guard.entry.to)
    end
    list[i] = core.expression(value, ode.unit(target, i), ("%s.reset: %s"):format(place, name))
    core.refuse_plain({ list[i] }, place .. ".reset: " .. name, true)
    core.name_data({ list[i] }, "reset of " .. name)
  end
  return instant.formulas(list, source.shift)
end

local function read_guards(mode, modes, names)
  local place = ("hybrid: modes.%s.guards"):format(mode.name)
  mode.guards = event.list(mode.given.guards or {}, mode.system, place, { "to", "reset" })
  for i, guard in ipairs(mode.guards) do
    local own = ("%s[%d]"):format(place, i)
    guard.to, guard.stop = modes[check.text(guard.entry.to, own .. ".to")], true
    if not guard.to then
      check.fail("%s.to: there is no mode `%s`%s", own, guard.entry.to, check.suggest(guard.entry.to, names))
    end
    if guard.entry.name == nil then guard.name = guard.to.name end
    guard.reset = read_reset(guard, own, mode.system, guard.to.system)
  end
end

local function read_modes(t, shift)
  if t == nil then check.fail "hybrid: modes are missing: { name = { ode, guards = { ... } }, ... }" end
  check.table(t, "hybrid: modes")
  local modes, names = {}, check.sorted(t)
  for _, name in ipairs(names) do
    local place = "hybrid: modes." .. tostring(name)
    check.text(name, "hybrid: name of a mode")
    check.table(t[name], place)
    check.keys(t[name], { "guards" }, place, 1)
    modes[name] = { name = name, given = t[name], system = simulate.on_clock(simulate.system(t[name], place), shift) }
  end
  if #names == 0 then check.fail "hybrid: modes: expected at least one" end
  for _, name in ipairs(names) do read_guards(modes[name], modes, names) end
  return modes, names
end

-- All that the user's data are in.
local function formulas(q, modes, names)
  local list = table.move(q.initial, 1, #q.initial, 1, {})
  for _, name in ipairs(names) do
    table.move(modes[name].system.rates, 1, #modes[name].system.rates, #list + 1, list)
    for _, guard in ipairs(modes[name].guards) do
      list[#list + 1] = guard.g
      table.move(guard.reset, 1, #guard.reset, #list + 1, list)
    end
  end
  return list
end

local function request(t)
  check.table(t, "hybrid")
  local modes, names = read_modes(t.modes, instant.list(t.t, "hybrid: t").shift)
  local first = t.mode
  if first == nil and #names == 1 then first = names[1] end
  if first == nil then check.fail("hybrid: mode is missing: the one to start in (%s)", table.concat(names, ", ")) end
  local mode = modes[check.text(first, "hybrid: mode")]
  if not mode then check.fail("hybrid: there is no mode `%s`%s", first, check.suggest(first, names)) end
  local copy = { mode.given[1] }
  for key, value in pairs(t) do copy[key] = value end
  local q = simulate.request(copy, "hybrid", nil, { "modes", "mode", "switches_max" })
  if q.times[#q.times] < q.times[1] then check.fail "hybrid: t must ascend: a switch cannot be undone" end
  q.switches_max = t.switches_max == nil and SWITCHES or check.count(t.switches_max, "hybrid: switches_max")
  leg.prepare(q, t)
  q.data = condense.data(formulas(q, modes, names))
  return q, mode
end

-- -- running it

-- Which guards of the new mode have the zero that the solutions come from?
local function known_zeros(guard)
  local list = {}
  for i, other in ipairs(guard.to.guards) do
    local g = core.substitute({ other.g }, guard.to.system.symbols, guard.reset)[1]
    list[i] = g == guard.g or g == core.expression(0)
  end
  return list
end

-- Does the reset change how fast g changes? Otherwise only the equations can turn a solution round.
local function is_impact(guard, source)
  local to, target = table.move(source.symbols, 1, #source.symbols, 1, {}), guard.to.system
  for i, name in ipairs(source.states) do
    for k, other in ipairs(target.states) do
      if other == name then to[i] = guard.reset[k] end
    end
  end
  local rate = surface.rate(guard.g, source)
  return core.substitute({ rate }, source.symbols, to)[1] ~= rate
end

local back = { rising = -1, falling = 1 }

-- The guards to be watched behind a switch. One with the same g that the solutions start on must not take them back to
-- the side that they came from in its own direction: both modes point at the surface.
local function watched_behind(guard, source, starts_on, direction)
  local list, target, own = {}, guard.to.system, {}
  for i, name in ipairs(target.states) do own[i] = namesake(source, name) or target.symbols[i] end
  for i, other in ipairs(guard.to.guards) do
    local slides = starts_on[i] and core.substitute({ other.g }, target.symbols, own)[1] == guard.g
      and (other.direction == back[direction] or other.direction == 0 and not is_impact(guard, source))
    list[i] = slides and setmetatable({ direction = back[direction], must_leave = true }, { __index = other }) or other
  end
  return list
end

-- The instants that are asked for, within a leg.
local function instants(q, from)
  local list = { from }
  for _, t in ipairs(q.times) do
    if t > from then list[#list + 1] = t end
  end
  return list
end

-- An instant behind the switch, where all solutions have made it; nil: the run ends before.
local function meeting_time(q, crossing, began)
  local t, latest = crossing, q.times[#q.times]
  local T = t.hi + math.max(t:width(), SHARE * math.max(t.lo - began, 0))
  for _, other in ipairs(q.times) do
    if other > t.hi then T = math.min(T, other) end -- asked for: must be met exactly
  end
  return t.hi < T and T <= latest and T or nil
end

local function failure(format, ...)
  return { status = "unable", code = "unable.switch", reason = format:format(...) }
end

-- Why the new mode cannot be entered with these values; nil: it can.
local function gap(states, x)
  for i, value in ipairs(core.evaluate { expressions = x }) do
    if value.partial or value:is_empty() or not value:is_bounded() then
      return ("the reset gives the state `%s` no finite value for all solutions: %s"):format(states[i], tostring(value))
    end
  end
end

-- Through the guard and the reset to one instant in the new mode: { x, T } or { status, code, reason }.
local function pass(q, result, mode, found, began)
  local guard = mode.guards[found.event.index]
  local at = ("switch `%s` of mode `%s` in t = %s"):format(guard.name, mode.name, tostring(found.event.t))
  local image = surface.onto(q, mode.system, guard.g, found.x, found.t)
  if image.run.status ~= "complete" then
    return { status = image.run.status, code = image.run.code,
      reason = ("%s: on the way to the guard: %s"):format(at, image.run.reason) }
  end
  local T = meeting_time(q, image.when, began)
  if not T then return failure("%s: the run ends before every solution has made it", at) end
  local target = guard.to.system
  local behind = surface.at(guard.reset, mode.system, image.x, image.t)
  local why = gap(target.states, behind)
  if why then return failure("%s: %s", at, why) end
  local starts_on = known_zeros(guard)
  local guards = watched_behind(guard, mode.system, starts_on, found.event.direction)
  local away, watch = surface.away(q, target, behind, image.t, T, guards, starts_on)
  if away.run.status == "unable" then return failure("%s: behind it: %s", at, away.run.reason) end
  local met = event.read(watch, guard.to.guards, target.states)[1]
  if met then
    return failure("%s: guard `%s` of mode `%s` may be met before every solution has made it: %s", at, met.name,
      guard.to.name, met.reason or "the switches overlap in time")
  end
  if away.run.status ~= "complete" then
    return { status = away.run.status, code = away.run.code, reason = away.run.reason }
  end
  switch_run.add_switch(result, mode, guard, image, away, found.t, T)
  return { mode = guard.to, x = away.x, t = T }
end

local function run_modes(q, result, mode)
  local x, t, latest = q.initial, q.times[1], q.times[#q.times]
  local starts_on
  while true do
    local found = leg.to_event(q, mode.system, x, instants(q, t), mode.guards, starts_on)
    switch_run.add_leg(result, mode, found)
    if found.status ~= "event" then return found.status, found.reason or "", found.code end
    if #result.events == q.switches_max then
      return "unable", ("more than %d switches by t = %s; raise `switches_max` if so many are meant"):format(
        q.switches_max, core.literal(t)), "unable.switches-max"
    end
    local next_leg = pass(q, result, mode, found, t)
    if not next_leg.mode then return next_leg.status, next_leg.reason, next_leg.code end
    mode, t, x = next_leg.mode, next_leg.t, next_leg.x
    if t >= latest then return "complete", "" end
  end
end

function verb.hybrid(t)
  local q, mode = request(t)
  local result = switch_run.new(q)
  result.status, result.reason, result.code = run_modes(q, result, mode)
  switch_run.finish(result, q)
  session.finish("hybrid", result, q.report, { "solver", q.solver, "options", q.settings, "t_start",
    instant.first(q.times), "t_end", instant.final(q.times) })
  return result
end

return verb
