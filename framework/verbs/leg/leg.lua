-- leg.lua -- one leg of a run that is made of several: from a set, known as expressions of the uncertain data, to
-- the end or to an event that ends the leg.
local condense = require "ambit.leg.condense"
local core = require "ambit.core"
local event = require "ambit.event"
local option = require "ambit.option"
local simulate = require "ambit.simulate"
local work = require "ambit.run.work"

local leg = {}

local CUTS, MOST_CUTS, SEARCHES = 16, 16, 8 -- of the time in which an undecided event may be; how often

-- Makes a verb's request the base of its legs. A set in pieces is no function of the data to go on from: solvers that
-- can split it are told not to, unless the user says how often.
function leg.prepare(q, t)
  q.cpu_seconds, q.step_count, q.rigorous, q.report = 0, 0, true, {}
  for _, name in ipairs(option.names(option.declaration("solver", q.solver))) do
    if name == "pieces_max" and t.pieces_max == nil then
      q.options = table.move(q.options, 1, #q.options, 1, {})
      q.options[#q.options + 1], q.options[#q.options + 2] = name, "1"
    end
  end
end

-- A bare system: what a run needs of one. symbols and rates in the order of the names.
function leg.system(names, units, symbols, rates)
  return { system = core.system(names, units, symbols, rates), states = names, units = units, symbols = symbols,
    rates = rates, mechanism = false, parameters = {} }
end

-- The set at the end of a run: expressions of the states `names`, of few unknowns; nil if it did not get there.
function leg.set(base, run, names)
  if run.status ~= "complete" then return nil end
  local set, list = run:set(), {}
  for i, name in ipairs(names) do list[i] = set[name] end
  return condense.few(list, base.data)
end

-- Runs from `initial` at times[1], written nowhere; base: the request of the verb (solver, arithmetic, options; `data`,
-- the unknowns that are the user's), which adds up what was spent. Returns the run and its watch.
function leg.run(base, system, initial, times, list, options)
  local q = setmetatable({ system = system, initial = initial, times = times }, { __index = base })
  options = options or {}
  q.watch = event.watch(q, list or {}, { quiet = true, hold = options.hold, starts_on = options.starts_on })
  q.run_options = { dense = options.dense }
  local run = simulate.solve(q)
  base.cpu_seconds, base.step_count = base.cpu_seconds + run.cpu_seconds, base.step_count + run.step_count
  base.rigorous = base.rigorous and run.rigorous
  work.add(base.report, run.report)
  return run, q.watch
end

-- Why what a leg found is no event to go on from; nil: it is one. Would a narrower enclosure help?
local function objection(results, last, most)
  if most then return ("there are more than %d events"):format(most), false end
  if not last or last.reason then return event.explain(last or results[1]), true end
  for _, other in ipairs(results) do
    if other ~= last then
      return ("events `%s` in t = %s and `%s` in t = %s: which comes first depends on the uncertain data"):format(
        last.name, tostring(last.t), other.name, tostring(other.t)), false
    end
  end
end

-- The instants from `from` on, and `cuts` more up to `till`: the enclosures within shorter steps are narrower.
local function finer(times, from, till, cuts)
  local list, step = { from }, (till - from) / cuts
  local k = 1
  for _, t in ipairs(times) do
    while k <= cuts and from + k * step < t do
      if from + k * step > list[#list] then list[#list + 1] = from + k * step end
      k = k + 1
    end
    if t > list[#list] then list[#list + 1] = t end
  end
  return list
end

-- Runs to the first event; where that is undecided, again from there with shorter steps. Returns what was found, where
-- the watch held a set before it (time and set), and the runs up to there, of which the last found it.
local function search(base, system, initial, times, list, starts_on)
  local x, runs, cuts, done = initial, {}, CUTS, times[1]
  for attempt = 1, SEARCHES do
    local run, watch = leg.run(base, system, x, times, list, { hold = true, dense = true, starts_on = starts_on })
    local results, last, most = event.read(watch, list, system.states)
    local reason, may_help
    if results[1] then reason, may_help = objection(results, last, most) end
    local from, held = core.events_set(watch)
    runs[#runs + 1] = { run = run, till = results[1] and (from or times[1]) or run.t_reached }
    if held then x, starts_on = condense.few(held, base.data), nil end
    from = from or times[1]
    local found = { results = results, last = last, reason = reason, run = run, from = from, x = x, runs = runs }
    if not reason or not may_help or attempt == SEARCHES or cuts > MOST_CUTS then return found end
    local till = results[1].t.hi
    cuts = results[1].t.lo > done and CUTS or 8 * cuts
    times, done = finer(times, from, till, cuts), till
  end
end

-- To the first of the events in the list, all of which end the leg: { status = "event", event, t, x, runs }, the event
-- as ambit.event reads it, x: the set at t, just before any solution has it; or { status = "complete", x, runs }; or
-- { status = "unable", code, reason, t, runs }. runs = { { run, till }, ... }: where the states were up to t.
function leg.to_event(base, system, initial, times, list, starts_on)
  local found = search(base, system, initial, times, list, starts_on)
  local run, runs, x = found.run, found.runs, found.x
  local first = found.last or found.results[1]
  if not first then
    return { status = run.status, code = run.code, reason = run.reason, t = run.t_reached,
      x = leg.set(base, run, system.states), runs = runs }
  end
  local t = first.t.lo
  if found.from < t then
    run = leg.run(base, system, x, { found.from, t }, {}, { dense = true })
    runs[#runs + 1] = { run = run, till = run.t_reached }
    x = leg.set(base, run, system.states)
    if run.status ~= "complete" then
      return { status = run.status, code = run.code, reason = run.reason, t = run.t_reached, runs = runs }
    end
  end
  if found.reason then
    return { status = "unable", code = "unable.event", reason = found.reason, t = t, runs = runs }
  end
  return { status = "event", event = first, t = t, x = x, runs = runs }
end

return leg
