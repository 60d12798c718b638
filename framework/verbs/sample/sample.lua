-- sample.lua -- ambit.sample { expression or ode, ..., n = 1000, seed = 1 }: draws from the tolerances in ordinary
-- floating point. It proves nothing: the hull of what was drawn is the honest estimate from inside, to hold against an
-- enclosure.
local binding = require "ambit.run.binding"
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.run.instant"
local evaluate = require "ambit.evaluate"
local flow = require "ambit.run.flow"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local option = require "ambit.option"
local partial = require "ambit.run.partial"
local session = require "ambit.session"
local shape = require "ambit.shape"
local simulate = require "ambit.simulate"

local verb = {}

local own_keys = { "n", "seed", "threads", "points", "corners", "polish", "partial" }
local sequences = { "sobol", "niederreiter", "halton", "reverse_halton", "random" }

-- -- what is asked

local function draws_and_seed(t)
  local seed = t.seed == nil and 1 or math.tointeger(t.seed)
  if not seed then check.fail("sample: seed: expected an integer, got %s", check.shown(t.seed)) end
  return check.count(t.n == nil and 1000 or t.n, "sample: n"), seed
end

local function flag(t, key)
  if t[key] ~= nil and type(t[key]) ~= "boolean" then
    check.fail("sample: %s: expected true or false, got %s", key, check.shown(t[key]))
  end
  return t[key] ~= false
end

local function sequence(t)
  if t.points == nil then return nil end
  for _, name in ipairs(sequences) do if t.points == name then return name end end
  check.fail("sample: points: expected one of %s, got %s%s", table.concat(sequences, ", "), check.shown(t.points),
    check.suggest(t.points, sequences))
end

local function plan_of(t)
  local draws, seed = draws_and_seed(t)
  return { draws = draws, seed = seed, points = sequence(t), no_corners = not flag(t, "corners"),
    polish = flag(t, "polish"), threads = simulate.threads(t, "sample") }
end

-- An error allowed in a step; text is the decimal it says.
local function tolerance(t, key)
  if t[key] == nil then return nil end
  local number = tonumber(t[key])
  if not number or not (number >= 0 and number < math.huge) then
    check.fail("sample: %s: expected a number that is 0 or greater, got %s", key, check.shown(t[key]))
  end
  return number
end

-- failed: of how many draws there is no value, and why
local function judge(facts, failed, why, allowed)
  local what = ("%d of %d draws %s"):format(failed, facts.draws, why)
  if facts.status == "complete" and failed >= facts.draws then
    facts.status, facts.code, facts.reason = "unable", "unable", what
  end
  return partial.judge(facts, failed > 0 and what or nil, allowed)
end

local function settings_of(plan, facts, ...)
  local list = { "draws", plan.draws, "seed", plan.seed, "points", facts.points, "failed", facts.failed, "polished",
    facts.polished, "threads", facts.threads, ... }
  if facts.points_reason then list[#list + 1], list[#list + 2] = "points_reason", facts.points_reason end
  return list
end

local function write_values(names, values, errors)
  if not core.recording() then return end
  for i, name in ipairs(names) do
    core.record("value", { "name", name, "value", values[i], "rigorous", "no", "error",
      errors[i] == errors[i] and errors[i] < math.huge and errors[i] or nil })
  end
end

-- -- expressions

local function of_expressions(t)
  check.keys(t, { "at", "arithmetic", table.unpack(own_keys) }, "sample", #t)
  local plan = plan_of(t)
  local allowed = partial.read(t, "sample")
  local expressions, paths, rebuild = shape.flatten(evaluate.subject(t, "sample"), "sample")
  local leaves, values = binding.resolve(t.at, expressions, "sample")
  local name, options = option.arithmetic(t.arithmetic == nil and core.default.points or t.arithmetic,
    "sample: arithmetic")
  local results, defined, report, facts = core.sample_expressions({ arithmetic = name, options = options,
    expressions = expressions, leaves = leaves, values = values }, plan)
  facts.defined, facts.report, facts.sample_error = defined, report, facts.errors
  facts.error = rebuild(facts.errors)
  local undefined = 0
  for i in ipairs(results) do undefined = math.max(undefined, facts.draws - defined[i]) end
  judge(facts, undefined, "have no value", allowed)
  write_values(paths, results, facts.errors)
  session.finish("sample", facts, report, settings_of(plan, facts, "arithmetic", name))
  return evaluate.with_status(rebuild(results), facts)
end

-- -- systems

local Sample = { __name = "sample" }
Sample.__index = Sample

-- Which of the listed times t is.
local function number_of(self, t)
  local given = instant.read(t, "at: t")
  if self.start and instant.is_same(given, self.start) then return 1 end
  local own = instant.on_clock(given, self.t)
  for k, time in ipairs(self.t) do if own.lo <= time and time <= own.hi then return k end end
  check.fail("at: t = %s is not one of the listed times", instant.text(given))
end

local function named(self, k, list)
  local values = {}
  for i, name in ipairs(self.states) do values[name] = list[(k - 1) * #self.states + i] end
  return values
end

-- The hull of all draws at one of the listed times, by state name.
function Sample:at(t) return named(self, number_of(self, t), self.values) end

-- How far the ends of that hull may be off, an estimate; NaN where nothing is known.
function Sample:error_at(t) return named(self, number_of(self, t), self.errors) end

check.methods(Sample, Sample)

function Sample.__tostring(self)
  local text = ("%s: %d draws"):format(self.status, self.draws)
  if self.failed > 0 then text = text .. ": " .. self.reason end
  return text
end

function verb.is(value) return getmetatable(value) == Sample end

-- Without a solver, or an option that only gsl has, the draws go in lanes.
local function request_of(t)
  local default = (t.method ~= nil or t.step_max ~= nil) and core.default.draws or false
  local in_lanes = t.solver == nil and not default
  local keys = table.move(own_keys, 1, #own_keys, 1, {})
  if in_lanes then table.move({ "relative", "absolute" }, 1, 2, #keys + 1, keys) end
  return simulate.request(t, "sample", default, keys), in_lanes
end

local function without_varying(q)
  local wave = require "ambit.wave"
  for _, leaf in ipairs(core.leaves(wave.formulas(q.system))) do
    if leaf.kind == "varying" then return wave.instead(q) or q end
  end
  return q
end

local function solve(q, plan)
  q = without_varying(q)
  local values, facts, report = core.sample_system(flow(q, { solver = q.solver or "" }), plan)
  facts.values, facts.states, facts.t, facts.report = values, q.system.states, q.times, report
  facts.start = q.times.start
  return setmetatable(facts, Sample), report
end

local function of_system(t)
  local plan = plan_of(t)
  local allowed = partial.read(t, "sample")
  local q, in_lanes = request_of(t)
  if in_lanes then plan.relative, plan.absolute = tolerance(t, "relative"), tolerance(t, "absolute") end
  if plan.relative == 0 and (plan.absolute or 0) == 0 then
    check.fail("sample: one of relative and absolute must be greater than 0")
  end
  if q.times.final then -- a double next to the end will do, behind all samples of a clock
    q.times[#q.times] = nil
    q.times[math.max(2, #q.times)] = q.times.exact and q.times.final.hi or q.times.final.near
  end
  local result, report = solve(q, plan)
  local k = #q.times
  result.x, result.error = named(result, k, result.values), named(result, k, result.errors)
  local last = (k - 1) * #result.states
  judge(result, result.failed, "did not reach the end" .. (result.reason and ": " .. result.reason or ""), allowed)
  write_values(result.states, table.move(result.values, last + 1, last + #result.states, 1, {}),
    table.move(result.errors, last + 1, last + #result.states, 1, {}))
  session.finish("sample", result, report, settings_of(plan, result, "solver", report.solver))
  return result
end

function verb.sample(t)
  check.table(t, "sample")
  if ode.is(t[1]) or mechanism.is(t[1]) then return of_system(t) end
  return of_expressions(t)
end

-- -- the inner hull of what another verb was asked

local INSTANTS = 50 -- at least, so that a largest overestimation means something

-- The times of a request and equidistant ones between them.
local function dense_times(times)
  local first, last, extra = times[1], times[#times], {}
  for i = 1, INSTANTS - 1 do extra[i] = first + (last - first) * (i / INSTANTS) end
  table.move(times, 1, #times, #extra + 1, extra)
  local forward, list = last > first, {}
  table.sort(extra, function(a, b) if forward then return a < b end return a > b end)
  for _, t in ipairs(extra) do if list[#list] ~= t then list[#list + 1] = t end end
  return list
end

local function bounds_of(values, width, times)
  local lo, hi, error = {}, {}, {}
  for i = 1, width do
    lo[i], hi[i], error[i] = {}, {}, {}
    for k = 1, times do
      local at = (k - 1) * width + i
      lo[i][k], hi[i][k], error[i][k] = values[at].lo, values[at].hi, values[at].error
    end
  end
  return lo, hi, error
end

local function inner_of(facts, times, values, width)
  local lo, hi, error = bounds_of(values, width, #times)
  return { t = times, lo = lo, hi = hi, error = error, draws = facts.draws, failed = facts.failed,
    status = facts.status, reason = facts.reason, points = facts.points, cpu_seconds = facts.cpu_seconds }
end

local function inner_of_system(q, plan, times)
  times = times or dense_times(q.times)
  times.exact = times[#times] == q.times[#q.times] and q.times.exact or nil
  local result = solve({ system = q.system, initial = q.initial, times = times }, plan)
  return inner_of(result, times, result.values, #q.system.states)
end

local function inner_of_expressions(q, plan)
  local x, defined, _, facts = core.sample_expressions({ expressions = q.expressions, leaves = q.leaves,
    values = q.values }, plan)
  for i in ipairs(x) do facts.failed = math.max(facts.failed, facts.draws - defined[i]) end
  return inner_of(facts, { 0 }, x, #x)
end

-- The inner hull for what another verb was asked: q = what simulate.request makes, or { expressions, leaves, values }
-- of an evaluation -> { t, lo = { { bound at t[1], ... } by state or result }, hi, error, draws, failed, status,
-- cpu_seconds }, or nil and why there is none. Where no draw reached a time, lo = inf and hi = -inf; the hull is made
-- smaller by `error` already (NaN: not known); where that leaves nothing, lo = hi is off by `error`. options: cpu = s
-- after which it ends with what it has, threads, t = { times of its own instead of those of the request and 49 between
-- }, points.
function verb.inner(q, n, seed, options)
  local own = options or {}
  local plan = { draws = n or 1000, seed = seed or 1, polish = true, cpu = own.cpu, threads = own.threads,
    points = own.points }
  local good, inner = pcall(q.system and inner_of_system or inner_of_expressions, q, plan, own.t)
  if good then return inner end
  return nil, tostring(inner)
end

return verb
