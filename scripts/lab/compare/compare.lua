-- compare.lua -- ambit.compare { expression or table of them, at = {}, arithmetics = {} } and ambit.compare { ode,
-- initial = {}, t = {}, solvers = {}, arithmetics = {} }: what each combination proves, how tightly, at what cost.
--
-- Every combination runs in a process of its own, once to warm up and then `repeats` times; the least times count. One
-- that fails is a row with its reason. Widths are held against the tightest proved ones and against the hull of n
-- samples, which lies inside every enclosure up to rounding.
local advice = require "ambit.compare.advice"
local binding = require "ambit.run.binding"
local check = require "ambit.check"
local compare_engine = require "ambit.compare.engine"
local compare_records = require "ambit.compare.records"
local compare_table = require "ambit.compare.table"
local core = require "ambit.core"
local evaluate = require "ambit.evaluate"
local evaluation = require "ambit.compare.evaluation"
local event = require "ambit.event"
local grid = require "ambit.compare.grid"
local judge = require "ambit.compare.judge"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local reference = require "ambit.compare.reference"
local session = require "ambit.session"
local shape = require "ambit.shape"
local simulate = require "ambit.simulate"
local simulation = require "ambit.compare.simulation"
local solvers = require "ambit.compare.solvers"

local verb = {}

local shared_keys = { "arithmetics", "repeats", "limit", "memory", "n", "seed" }
local scene_keys = table.move(shared_keys, 1, #shared_keys, 3, { "solvers", "reference" })

local function number_of(value, default, what)
  if value == nil then return default end
  local number = tonumber(value)
  if not number or not (number > 0 and number < math.huge) then
    check.fail("%s: expected a positive number, got %s", what, tostring(value))
  end
  return number
end

-- The keys that say how to compare, checked; `others`: where to look for what t leaves out.
function verb.settings(t, others)
  local function get(key)
    if t[key] ~= nil then return t[key] end
    return others and others[key]
  end
  local seed = get "seed" == nil and 1 or math.tointeger(get "seed")
  if not seed then check.fail("compare: seed: expected an integer, got %s", tostring(get "seed")) end
  return {
    arithmetics = get "arithmetics", solvers = get "solvers", reference = reference.read(get "reference"),
    repeats = check.count(get "repeats" or 5, "compare: repeats"),
    limit = number_of(get "limit", 4, "compare: limit"), memory = number_of(get "memory", 1e9, "compare: memory"),
    n = get "n" ~= nil and check.count(get "n", "compare: n") or nil, seed = seed,
  }
end

-- What was set, for records and pages.
local function shown_settings(settings)
  return { repeats = settings.repeats, limit = settings.limit, memory = settings.memory, n = settings.n,
    seed = settings.seed }
end

-- request: { verb = "evaluate", place, expressions, paths, leaves, values } or { verb = "simulate", place, question =
-- what simulate.request makes } -> the comparison (scripts/lab/interface/comparison.lua says). progress: of
-- compare/engine.lua, or nil.
function verb.run(request, settings, progress)
  local began = core.cpu()
  local engine = compare_engine.new(settings, progress)
  local comparison = { verb = request.verb, place = request.place, settings = shown_settings(settings),
    status = "complete" }
  engine:calm(function()
    if request.verb == "evaluate" then
      evaluation.run(comparison, request, settings, engine)
    else
      simulation.run(comparison, request.question, settings, engine)
    end
    comparison.advice = advice.of(comparison, judge.front(comparison.rows, comparison.measure))
    comparison.title = compare_table.size(comparison)
  end)
  comparison.interrupted = engine.interrupted
  comparison.cpu_seconds = core.cpu() - began + engine.cpu_seconds
  for _, row in ipairs(comparison.rows) do row.at = nil end -- was for finding all that
  return comparison
end

-- -- the verb

local Comparison = { __name = "comparison" }
Comparison.__index = Comparison
Comparison.__tostring = function(self) return compare_table.text(self) end

-- Of a comparison made by the verb: each row's x in the shape that was asked for.
local function reshape(comparison, rebuild)
  for _, row in ipairs(comparison.rows) do row.x = row.enclosures and rebuild(row.enclosures) end
end

local function of_scene(t)
  check.keys(t, scene_keys, "compare without a subject")
  local settings = verb.settings(t)
  if t.arithmetics ~= nil then grid.entries(t.arithmetics) end
  if t.solvers ~= nil then solvers.entries(t.solvers) end
  session.compare = t
  return setmetatable({ status = "complete", rows = {}, names = {}, settings = settings }, Comparison)
end

-- What the verb found, remembered and recorded.
local function finish(comparison)
  session.comparisons[#session.comparisons + 1] = comparison
  compare_records.write(comparison, #session.comparisons)
  local settings = comparison.settings
  session.finish("compare", comparison, { seconds_run = comparison.cpu_seconds },
    { "repeats", settings.repeats, "limit", settings.limit, "seed", settings.seed })
  return setmetatable(comparison, Comparison)
end

local function place() return (core.where():gsub(": $", "")) end

local function of_expressions(t)
  check.keys(t, table.move(shared_keys, 1, #shared_keys, 2, { "at" }), "compare", #t)
  local settings = verb.settings(t, session.compare)
  local expressions, paths, rebuild = shape.flatten(evaluate.subject(t, "compare"), "compare")
  local leaves, values = binding.resolve(t.at, expressions, "compare")
  local comparison = verb.run({ verb = "evaluate", place = place(), expressions = expressions, paths = paths,
    leaves = leaves, values = values }, settings)
  reshape(comparison, rebuild)
  return finish(comparison)
end

-- The solver is what varies: the request is made for whichever comes first.
local function of_system(t)
  local own = table.move(scene_keys, 1, #scene_keys, 5, { "threads", "split", "dense", "events" })
  check.keys(t, table.move(own, 1, #own, 3, { "initial", "t" }), "compare", 1)
  local settings = verb.settings(t, session.compare)
  if t.solvers ~= nil then solvers.entries(t.solvers) end
  local q = simulate.request({ t[1], initial = t.initial, t = t.t }, "compare", "lohner", {})
  q.run_options = simulate.run_options(t, q)
  event.request(t.events, q)
  return finish(verb.run({ verb = "simulate", place = place(), question = q }, settings))
end

function verb.compare(t)
  check.table(t, "compare")
  if #t == 0 then return of_scene(t) end
  if ode.is(t[1]) or mechanism.is(t[1]) then return of_system(t) end
  return of_expressions(t)
end

return verb
