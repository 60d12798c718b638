-- event.lua -- events = { { g = function(s, p, t) ... end, name = "impact", direction = "falling", stop = true } }:
-- what is looked for along a run, and what was found. Proofs: docs/numerics/events.md.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local instant = require "ambit.run.instant"
local ode = require "ambit.ode"
local partial = require "ambit.run.partial"

local event = {}

local ROOM = 10000 -- events of one run; more end it
local directions = { rising = 1, falling = -1, both = 0 }
local names_of_direction = { [1] = "rising", [-1] = "falling" }

-- A formula over the states, data and time of a system, or a function(s, p, t) that returns one; by the system's clock.
-- Data that stand in it alone are called `label`, or as `what`.
function event.formula(value, system, what, label)
  if type(value) == "function" then value = formula.call(value, what, ode.arguments(system)) end
  if value == nil then check.fail("%s: expected a formula, or a function(s, p, t) that returns one", what) end
  local g = core.expression(value, nil, what)
  core.refuse_plain({ g }, what, true)
  core.name_data({ g }, label or what)
  return instant.formulas({ g }, system.shift)[1]
end

function event.direction(value, what)
  if value == nil then return 0 end
  local direction = directions[value]
  if not direction then
    check.fail("%s: expected rising, falling or both, got %s%s", what, tostring(value),
      check.suggest(value, check.sorted(directions)))
  end
  return direction
end

local function is_stop(value, what)
  if value == nil or type(value) == "boolean" then return value == true end
  check.fail("%s: expected true or false, got %s", what, check.kind(value))
end

local function check_steady(g, system, what)
  if not system.sampled then return end
  for _, leaf in ipairs(core.leaves { g }) do
    if leaf.kind == "symbol" and system.defaults[leaf.name] then
      check.fail("%s: an event is a zero of what moves steadily, but g depends on `%s`, which jumps at samples", what,
        leaf.name)
    end
  end
end

-- { g, name, direction, stop } of each entry; own_keys: what an entry may say besides
function event.list(t, system, what, own_keys)
  check.table(t, what)
  check.keys(t, {}, what, #t)
  local list, taken = {}, {}
  for i, entry in ipairs(t) do
    local place = ("%s[%d]"):format(what, i)
    check.table(entry, place)
    local known = { "g", "name", "direction", "stop" }
    table.move(own_keys or {}, 1, #(own_keys or {}), #known + 1, known)
    check.keys(entry, known, place)
    local name = entry.name == nil and tostring(i) or check.text(entry.name, place .. ".name")
    if taken[name] then check.fail("%s: two are called `%s`", what, name) end
    taken[name] = true
    list[i] = { g = event.formula(entry.g, system, place .. ".g"), name = name,
      direction = event.direction(entry.direction, place .. ".direction"),
      stop = is_stop(entry.stop, place .. ".stop"), entry = entry }
    check_steady(list[i].g, system, place .. ".g")
  end
  return list
end

-- An entry of a list may say must_leave: to move in its direction from g = 0 at the start is reported, as undecided.
-- The watch for one run of q = { system, initial, times }. options: quiet (no records), hold (keep the set before the
-- event that ends the run), starts_on ([i] = true: g of entry i is known to be 0 at the start).
function event.watch(q, list, options)
  local rows, on = {}, options.starts_on or {}
  for i, e in ipairs(list) do
    rows[i] = { name = e.name, g = e.g, direction = e.direction, stop = e.stop, starts_on = on[i],
      must_leave = e.must_leave }
  end
  return core.events { system = q.system.system, initial = q.initial, start = q.times[1], list = rows, room = ROOM,
    quiet = options.quiet, hold = options.hold }
end

local reasons = {
  crosses = "every solution changes the sign of g, but perhaps more than once or with g' = 0",
  touches = "some solutions may graze g = 0, or cross it and come back",
  part = "some solutions may have crossed and others not when the run ended",
  starts = "the set touches g = 0 at the start: only a part of it may cross",
  edge = "g may leave its domain or jump there; some solutions may have g = 0 first",
}

-- What was found of an event, as a user sees it.
local function result_of(found, list, states, times)
  local x = {}
  for i, name in ipairs(states) do x[name] = found.x[i] end
  local reason = reasons[found.outcome] or not found.rigorous and "the solver proves nothing"
    or instant.is_behind(times, found.t) and "it may lie behind the end, which is no double" or nil
  return { index = found.event, name = list[found.event].name,
    t = instant.of_clock(found.t, times.shift), x = x, certain = reason == nil,
    reason = reason, direction = names_of_direction[found.direction] }
end

-- The found events, the one that ended the run (or nil), and whether there were too many. times: of the run, or nil if
-- they are doubles.
function event.read(watch, list, states, times)
  local found, by, is_full = core.events_found(watch)
  local results = {}
  for i, f in ipairs(found) do results[i] = result_of(f, list, states, times or {}) end
  return results, by and results[by], is_full and ROOM
end

function event.explain(e) return ("event `%s` in t = %s: %s"):format(e.name, tostring(e.t), e.reason) end

-- What is said of the first event that may be one for a part of the data only; nil: there is none.
local function first_uncertain(results)
  for _, e in ipairs(results) do
    if not e.certain then return event.explain(e) end
  end
end

-- The key `events` of a simulation: to its request and, when it is over, to the facts of its run.
function event.request(t, q)
  if t == nil then return end
  q.events = event.list(t, q.system, "simulate: events")
  q.watch = event.watch(q, q.events, {})
end

function event.finish(q, facts)
  facts.partial = false
  if not q.events then return end
  local results, last, most = event.read(q.watch, q.events, q.system.states, q.times)
  facts.events = results
  if most then
    facts.status, facts.code = "unable", "unable.events-max"
    facts.reason = ("there are more than %d events"):format(most)
  elseif last and (last.certain or not facts.rigorous) then
    facts.status, facts.code, facts.reason, facts.ended_by = "complete", "ok", "", last.name
  elseif last then
    facts.status, facts.code, facts.reason = "unable", "unable.event", event.explain(last)
  end
  partial.judge(facts, facts.rigorous and first_uncertain(results) or nil, q.partial)
end

return event
