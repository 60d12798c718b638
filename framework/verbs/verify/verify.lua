-- verify.lua -- ambit.verify { ode or m:dynamics(), initial = ..., t = ..., safe = g }: prove or refute that g <= 0 for
-- every solution that the uncertain data allow, refining until it is decided or the budget is spent. What each verdict
-- means and why it holds: docs/numerics/verify.md.
local check = require "ambit.check"
local conditions = require "ambit.verify.condition"
local core = require "ambit.core"
local expect = require "ambit.run.expect"
local instant = require "ambit.run.instant"
local option = require "ambit.option"
local report = require "ambit.verify.report"
local search = require "ambit.verify.search"
local session = require "ambit.session"
local simulate = require "ambit.simulate"
local uncertain = require "ambit.run.uncertain"

local verb = {}

local BUDGET = 200 -- runs after the first

-- 200: so many further runs; "10 s": so much CPU time
local function read_budget(value)
  if value == nil then return { runs = BUDGET } end
  if type(value) == "string" then
    local e = core.expression(value, "s", "verify: budget")
    local seconds = core.is_constant(e) and core.interval(e):mid()
    if not seconds or not (seconds >= 0) then
      check.fail('verify: budget: expected a number of runs, or a time such as "10 s", got `%s`', value)
    end
    return { seconds = seconds }
  end
  local runs = math.tointeger(value)
  if not runs or runs < 0 then
    check.fail('verify: budget: expected a number of runs, or a time such as "10 s", got %s', tostring(value))
  end
  return { runs = runs }
end

-- The uncertain data of everything that takes part, as uncertain.data gives them.
local function uncertain_data(q, list)
  local all = table.move(q.initial, 1, #q.initial, 1, {})
  table.move(q.system.rates, 1, #q.system.rates, #all + 1, all)
  if q.system.sampled then
    local laws = require "ambit.sampled".formulas(q.system)
    table.move(laws, 1, #laws, #all + 1, all)
  end
  local invariants = core.system_invariants(q.system.system)
  table.move(invariants, 1, #invariants, #all + 1, all)
  for _, c in ipairs(list) do all[#all + 1] = c.g end
  return uncertain.data(all)
end

-- The solver's tolerance, if it has one.
local function tolerance_of(q)
  for i = 1, #q.options, 2 do
    if q.options[i] == "tolerance" then return tonumber(q.options[i + 1]) end
  end
  for _, param in ipairs(option.declaration("solver", q.solver).parameters) do
    if param.name == "tolerance" then return tonumber(param.fallback) end
  end
end

local own = table.move(conditions.keys, 1, #conditions.keys, 3, { "budget", "expect" })
local verdicts = { "proved", "refuted", "undecided" }

-- The answer to a request about finite times, and what was asked; without the rates of so many functions of time.
local function answer_with(t, count)
  local q = simulate.request(t, "verify", nil, own)
  if count then q.system = q.without_rates(count).system end
  if not option.declaration("solver", q.solver).rigorous then
    check.fail("verify: solver `%s` proves nothing", q.solver)
  end
  local list = conditions.read(t, q.system)
  local unknowns, lo, hi, inner, names = uncertain_data(q, list)
  local job = { asked = q, request = q, others = q.suggestion and q.suggestion.others or {}, conditions = list,
    unknowns = unknowns, lo = lo, hi = hi, inner = inner, names = names,
    sound_points = uncertain.are_points_starts(q), budget = read_budget(t.budget), tolerance_of = tolerance_of }
  search.run(job)
  return report.of(job), job
end

-- The same, and where not all is decided without the rates of the fastest functions of time; that answer counts if it
-- decides all.
local function answer(t)
  local result, job = answer_with(t)
  local q = job.asked
  for count = 1, result.status == "undecided" and q.without_rates and #q.system.carried or 0 do
    local other, asked = answer_with(t, count)
    if other.status ~= "undecided" then return other, asked end
  end
  return result, job
end

local function finish(t, result, settings)
  expect.judge(result, expect.read(t, "verify", verdicts))
  table.move({ "refinements", result.refinements, "conditions", report.fields(result) }, 1, 4, #settings + 1, settings)
  session.finish("verify", result, result.report, settings)
  return result
end

-- For all times: by runs as far as they are needed, and a set that no solution leaves.
local function for_ever(t)
  local start, last = core.cpu(), nil
  local always = require "ambit.forever.always"
  expect.read(t, "verify", verdicts)
  read_budget(t.budget)
  simulate.request(always.finite(t), "verify", nil, own) -- refuses what makes no sense before anything is computed
  local result = always.verify(t, function(copy)
    local found, job = answer(copy)
    last = job
    return found
  end, function(list, reason) return report.without_run(list, reason) end)
  result.cpu_seconds = core.cpu() - start
  return finish(t, result, last and { "solver", last.request.solver, "options", last.request.settings } or {})
end

-- Is t math.huge or { start, math.huge }?
local function is_infinite(t)
  if type(t) == "table" then return #t == 2 and t[2] == math.huge end
  return t == math.huge
end

function verb.verify(t)
  if type(t) == "table" and is_infinite(t.t) then return for_ever(t) end
  local result, job = answer(t)
  local q = job.asked
  return finish(t, result, { "solver", job.request.solver, "options", job.request.settings, "t_start",
    instant.first(q.times), "t_end", instant.final(q.times) })
end

return verb
