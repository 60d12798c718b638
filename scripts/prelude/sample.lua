-- sample.lua -- ambit.sample { expression or ode, ..., n = 1000, seed = 1 }: Monte Carlo in ordinary floating
-- point. It proves nothing: the hull of what was drawn is the honest estimate from inside, to hold against an
-- enclosure.
local binding = require "ambit.binding"
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.instant"
local evaluate = require "ambit.evaluate"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local option = require "ambit.option"
local session = require "ambit.session"
local shape = require "ambit.shape"
local simulate = require "ambit.simulate"

local verb = {}

local function draws_and_seed(t)
  local seed = t.seed == nil and 1 or math.tointeger(t.seed)
  if not seed then check.fail("sample: seed: expected an integer, got %s", tostring(t.seed)) end
  return check.count(t.n == nil and 1000 or t.n, "sample: n"), seed
end

local function of_expressions(t)
  check.keys(t, { "at", "arithmetic", "n", "seed" }, "sample", #t)
  local draws, seed = draws_and_seed(t)
  local expressions, _, rebuild = shape.flatten(evaluate.subject(t, "sample"), "sample")
  local leaves, values = binding.resolve(t.at, expressions, "sample")
  local name, options = option.arithmetic(t.arithmetic == nil and "real" or t.arithmetic, "sample: arithmetic")
  local results, defined, report = core.sample_expressions(name, options, expressions, leaves, values, draws, seed)
  local facts = { status = "complete", draws = draws, defined = defined, cpu_seconds = report.seconds_run,
    report = report }
  session.finish("sample", facts, report, { "draws", draws, "seed", seed, "arithmetic", name })
  return evaluate.with_status(rebuild(results), facts)
end

local Sample = { __name = "sample" }
Sample.__index = Sample

-- The hull of all draws at one of the listed times, by state name.
function Sample:at(t)
  t = instant.of(t, "at: t")
  for k, time in ipairs(self.t) do
    if time == t then
      local named = {}
      for i, name in ipairs(self.states) do named[name] = self.values[(k - 1) * #self.states + i] end
      return named
    end
  end
  check.fail("at: t = %s is not one of the listed times", core.literal(t))
end

check.methods(Sample, Sample)

function Sample.__tostring(self)
  return ("%s: %d draws, %d of them did not reach the end"):format(self.status, self.draws, self.failed)
end

local function of_system(t)
  local draws, seed = draws_and_seed(t)
  local q = simulate.request(t, "sample", "gsl", { "n", "seed", "threads" })
  local threads = simulate.threads(t, "sample")
  local values, facts, report = core.sample_system(q.system.system, q.solver, q.arithmetic, q.options,
    q.arithmetic_options,
    q.initial, q.times, draws, seed, threads)
  facts.values, facts.states, facts.t, facts.report = values, q.system.states, q.times, report
  session.finish("sample", facts, report, { "draws", draws, "seed", seed, "solver", q.solver })
  local result = setmetatable(facts, Sample)
  result.x = result:at(q.times[#q.times])
  return result
end

function verb.sample(t)
  check.table(t, "sample")
  if ode.is(t[1]) or mechanism.is(t[1]) then return of_system(t) end
  return of_expressions(t)
end

return verb
