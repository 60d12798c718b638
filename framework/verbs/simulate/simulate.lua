-- simulate.lua -- ambit.simulate { ode, initial = { x = 1 }, t = { 0, 1 }, solver = "lohner", <options of the solver>
-- }.
local assemble_data = require "ambit.assemble.data"
local check = require "ambit.check"
local core = require "ambit.core"
local event = require "ambit.event"
local flow = require "ambit.run.flow"
local instant = require "ambit.run.instant"
local loops = require "ambit.loops"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local option = require "ambit.option"
local partial = require "ambit.run.partial"
local run = require "ambit.run"
local session = require "ambit.session"
local split = require "ambit.split"
local suggest = require "ambit.simulate.suggest"

local verb = {}

local MOST_THREADS = 256

-- What follows solutions without asking for more: functions of time whose rate is bounded are states there.
local carries = { simulate = true, verify = true }
local takes_sampled = { simulate = true, verify = true, sample = true }

-- The system that the verb's table starts with; a mechanism stands for its equations of motion.
function verb.system(t, what)
  local subject = t[1]
  if mechanism.is(subject) then subject = subject:dynamics() end
  if not ode.is(subject) then
    check.fail("%s: expected m:dynamics() or an ambit.ode as the first entry, got %s", what, check.kind(subject))
  end
  if subject.sampled and not takes_sampled[what] then require "ambit.sampled".refuse(subject, what) end
  return subject
end

-- initial = { name = value } -> { expression, ... } in the order of the states
function verb.initial(t, system, what)
  if t == nil then
    check.fail("%s: initial is missing: a value for each of %s", what, table.concat(system.states, ", "))
  end
  check.table(t, what .. ": initial")
  local by_place = #t == #system.states
  if system.mechanism and not by_place then
    loops.check_speeds(system.mechanism, system.states, t, what .. ": initial")
  end
  if not by_place then check.keys(t, system.states, what .. ": initial") end
  local list = {}
  for i, name in ipairs(system.states) do
    local value
    if by_place then value = t[i] else value = t[name] end
    local default = system.defaults and system.defaults[name]
    if value == nil and default then value = default.like and t[default.like] or default.initial end
    if value == nil then check.fail('%s: initial: the state `%s` has no value', what, name) end
    list[i] = core.expression(value, ode.unit(system, i), ("%s: initial.%s"):format(what, name))
    core.name_data({ list[i] }, "initial " .. name)
  end
  return list
end

-- The string keys of t that are not among these.
local function other_keys(t, known)
  local is_known, others = {}, {}
  for _, key in ipairs(known) do is_known[key] = true end
  for _, key in ipairs(check.sorted(t)) do
    if type(key) == "string" and not is_known[key] then others[#others + 1] = key end
  end
  return others
end

local function check_options(t, q, known, what)
  local declaration = option.declaration("solver", q.solver)
  local all = table.move(known, 1, #known, 1, {})
  table.move(option.names(declaration), 1, #declaration.parameters, #all + 1, all)
  check.keys(t, all, ("%s with solver %s"):format(what, q.solver), 1)
  q.options, q.settings = option.collect(t, declaration)
end

-- The system by a clock with this shift (instant.lua); `shift` tells those who write formulas for it.
function verb.on_clock(system, shift)
  if not shift then return system end
  local changed, rates = ode.replaced(system, { core.time() }, { core.time() + shift })
  return setmetatable({ rates = rates, shift = shift, system = changed }, { __index = system })
end

-- The first solver of the list that takes sampled systems and proves what it says; else the first, which will say why
-- not.
local function follows_samples(names)
  for _, name in ipairs(names) do
    local declaration = option.declaration("solver", name)
    if declaration.sampled and declaration.rigorous then return name end
  end
  return names[1]
end

-- Everything that simulate and the sampling of a system share. default_solver nil: the one that suits; false: none.
function verb.request(t, what, default_solver, own_keys)
  check.table(t, what)
  local known = { "initial", "t", "solver", "arithmetic" }
  table.move(own_keys, 1, #own_keys, #known + 1, known)
  local q = { system = verb.system(t, what), arithmetic_options = {} }
  if t.arithmetic ~= nil then
    q.arithmetic, q.arithmetic_options = option.arithmetic(t.arithmetic, what .. ": arithmetic")
  end
  if t.solver ~= nil then q.solver = check.text(t.solver, what .. ": solver") else q.solver = default_solver or nil end
  local varying = package.loaded["ambit.varying"] -- before that, nothing varies at a known rate
  local bare = q.system
  if varying and carries[what] then q.system = varying.carried(q.system) end
  -- the same request about the system without the rates of its fastest functions
  q.without_rates = q.system.carried and function(count)
    return setmetatable({ system = verb.on_clock(varying.carried(bare, count), q.times.shift) }, { __index = q })
  end
  local fitting
  if q.solver then
    check_options(t, q, known, what)
  elseif default_solver == false then
    check.keys(t, known, what, 1)
  else
    fitting = suggest.candidates(other_keys(t, known), known, q.arithmetic, what)
    if q.system.sampled then
      q.solver, fitting = follows_samples(fitting), nil
      check_options(t, q, known, what)
    end
  end
  local sides = q.system.sampled and require "ambit.run.samples".sides(q.system)
  q.initial = verb.initial(varying and varying.initial(t.initial, q.system) or t.initial, q.system, what)
  if varying then varying.check_starts(q.initial, q.system, what) end
  q.times = instant.list(t.t, what .. ": t", sides)
  q.initial = assemble_data.correlate(q.initial, t.initial, q.system, q.times)
  if q.system.sampled and q.times.shift then
    check.fail("%s: t: the start of a sampled system: expected a number that is a double, got %s", what,
      tostring(q.times.said[1]))
  end
  q.system = verb.on_clock(q.system, q.times.shift)
  if fitting then
    q.suggestion = suggest.proving(suggest.solver(q, fitting, what))
    q.solver = q.suggestion.solver
    check_options(t, q, known, what)
    q.by = function(solver) -- the same request to another of the fitting solvers
      local own = setmetatable({ solver = solver }, { __index = q })
      check_options(t, own, known, what)
      return own
    end
  end
  return q
end

-- What is said about the run besides: threads, split, keep, dense (and what `simulate` alone knows: events).
verb.run_keys = { "threads", "split", "keep", "dense" }

-- nil: as many as there are processors
function verb.threads(t, what)
  if t.threads == nil then return nil end
  local threads = check.count(t.threads, what .. ": threads")
  if threads > MOST_THREADS then check.fail("%s: threads: at most %d, got %d", what, MOST_THREADS, threads) end
  return threads
end

function verb.run_options(t, q)
  local fields = split.read(t.split, q, "simulate: split")
  fields.threads = verb.threads(t, "simulate")
  if t.keep ~= nil and t.keep ~= "all" and t.keep ~= "last" then
    check.fail('simulate: keep: expected "all" or "last", got %s',
      type(t.keep) == "string" and t.keep or check.shown(t.keep))
  end
  if t.dense ~= nil and type(t.dense) ~= "boolean" then
    check.fail("simulate: dense: expected true or false, got %s", check.kind(t.dense))
  end
  fields.last, fields.dense = t.keep == "last", t.dense
  return fields
end

local function initial_enclosures(q)
  return function()
    local x, named = core.evaluate { expressions = q.initial }, {}
    for i, name in ipairs(q.system.states) do named[name] = x[i] end
    return named
  end
end

local TORN = 1e-6 -- m, or what else a loop is measured in: more than any rounding, less than anybody wants

-- A solver that proves nothing does not look at the constraints: it would carry a loop that is open at the start along.
local function check_loops(q)
  local invariants, names = core.system_invariants(q.system.system)
  if #invariants == 0 or option.declaration("solver", q.solver).rigorous then return end
  local leaves, values = { core.time() }, { core.expression(q.times[1]) }
  table.move(q.system.symbols, 1, #q.system.symbols, 2, leaves)
  table.move(q.initial, 1, #q.initial, 2, values)
  for i, x in ipairs(core.evaluate { expressions = invariants, leaves = leaves, values = values }) do
    if not (x:mig() <= TORN) then
      check.fail("simulate: initial: the constraint `%s` is off by %s at the start; m:assemble finds values that fit",
        names[i], x)
    end
  end
end

-- A request -> its run.
function verb.solve(q)
  check_loops(q)
  core.record_shift(q.times.shift and core.interval(q.times.shift) or 0)
  local track, facts, report = core.simulate(flow(q), q.watch or nil, q.run_options)
  facts.track, facts.states, facts.report = track, q.system.states, report
  facts.solver, facts.arithmetic, facts.t_start, facts.initial = q.solver, report.arithmetic, q.times[1],
    initial_enclosures(q)
  facts.times, facts.system, facts.keeps_last = q.times, q.system, q.run_options and q.run_options.last
  facts.question = { system = q.system, initial = q.initial, times = q.times,
    again = function(options, times) return verb.again(q, options, times) end }
  facts.solver_reason = q.suggestion and q.suggestion.reason or "named in the scene"
  facts.parts = { { solver = q.solver, t_from = q.times[1], t = facts.t_reached } }
  event.finish(q, facts)
  local result = run.new(facts)
  local failed = facts.status == "unable" or facts.status == "impossible"
  local hint = failed and q.system.mechanism and loops.hint(q.system.mechanism, result)
  if hint then facts.reason = facts.reason .. "; " .. hint end
  return result
end

local first_only = { patience = true, due = true, reach = true } -- how long a try may take

-- The same question once more, for what its answer is shown with: nothing is recorded, no event looked for, no datum
-- cut where sets are wide.
function verb.again(q, options, times)
  options.silent = true
  local function inherited(_, key)
    if not first_only[key] and not key:find "^band_" then return (q.run_options or {})[key] end
  end
  return verb.solve(setmetatable({ watch = false, events = false, times = times or q.times,
    run_options = setmetatable(options, { __index = inherited }) }, { __index = q }))
end

-- Asks a solver, the suggested one or another, with some fields of the request changed.
local function asking(t, q)
  return function(other, changes)
    local own = other.solver == q.solver and q or q.by(other.solver)
    if next(changes) then own = setmetatable(changes, { __index = own }) end
    if changes.patience or changes.due or changes.band then
      local more = { patience = changes.patience, due = changes.due, reach = changes.reach, pieces = changes.pieces }
      for key, value in pairs(changes.band or {}) do more["band_" .. key] = value end
      own.run_options = setmetatable(more, { __index = q.run_options })
    end
    if other.solver ~= q.solver then event.request(t.events, own) end
    local run = verb.solve(own)
    run.solver_reason = other.reason
    return run
  end
end

function verb.simulate(t)
  local keys = table.move(verb.run_keys, 1, #verb.run_keys, 3, { "events", "partial" })
  local q = verb.request(t, "simulate", nil, keys)
  q.partial = partial.read(t, "simulate")
  q.run_options = verb.run_options(t, q)
  event.request(t.events, q)
  session.ask_simulation(q)
  local result = q.suggestion and require "ambit.simulate.choice".solve(q, asking(t, q)) or verb.solve(q)
  if q.without_rates then result = require "ambit.simulate.rates".tightest(q, result, verb.solve) end
  session.finish("simulate", result, result.report,
    { "solver", result.solver, "arithmetic", result.arithmetic, "options", q.settings, "t_start",
      instant.first(q.times), "t_end", instant.final(q.times) })
  session.remember(result, q)
  return result
end

return verb
