-- reduce.lua -- ambit.reduce { ode or mechanism, t =, initial =, outputs = { "x" }, error = { x = "0.1" } }: the
-- smallest set of equations whose outputs provably stay within their bounds of the detailed ones, over whole
-- scenarios.
--
-- After Mikelsons and Brandt, Symbolic model reduction for interval-valued scenarios, DETC2009-86954, algorithm 1,
-- with a proof for each accepted step: docs/numerics/reduction.md; how to use it: docs/reduction.md. Each pass goes on
-- with the model that the one before has left; every proof is against the detailed one.
local branch = require "ambit.reduce.branch"
local candidate = require "ambit.reduce.candidate"
local certify_bound = require "ambit.reduce.certify.bound"
local certify_model = require "ambit.reduce.certify.model"
local certify_scenario = require "ambit.reduce.certify.scenario"
local certify_settings = require "ambit.reduce.certify.settings"
local check = require "ambit.check"
local code = require "ambit.code"
local core = require "ambit.core"
local mechanism = require "ambit.reduce.mechanism"
local datum = require "ambit.reduce.datum"
local model = require "ambit.reduce.model"
local model_ode = require "ambit.reduce.model_ode"
local pass = require "ambit.reduce.pass"
local proof = require "ambit.reduce.certify.proof"
local reference = require "ambit.reduce.reference"
local report = require "ambit.reduce.report"
local request = require "ambit.reduce.request"
local session = require "ambit.session"

local verb = {}

local own_keys = { "t", "initial", "parameters", "inputs", "scenarios", "outputs", "error" }

-- -- the request

-- Does an expression depend on uncertain data, none of which the scenarios replace by other values?
local function is_uncertain(expression, symbols)
  local own = reference.unknowns { expression }
  for key in pairs(symbols) do
    for _, leaf in ipairs(type(key) ~= "string" and core.leaves { key } or {}) do
      for _, unknown in ipairs(own) do
        if unknown.expression == leaf.expression then return false end
      end
    end
  end
  return #own > 0
end

-- Uncertain parameters are symbols while terms are read and printed; every scenario gives them back their data.
local function with_uncertain(symbols, system)
  for _, name in ipairs(check.sorted(system.declaration and system.parameters or {})) do
    if not symbols[name] and is_uncertain(system.parameters[name], symbols) then
      symbols[name] = core.symbol(name, "1")
    end
  end
  return symbols
end

-- There must be something to leave out: a term, or a part.
local function check_terms(m, name, elements)
  local _, list = candidate.terms(m, 1)
  for _, term in ipairs(list) do
    if not core.is_constant(term.expression) then return list end
  end
  if elements then return list end
  check.fail("reduce: `%s` has no terms to cut: each right-hand side that an output needs is a number", name)
end

local function read(t)
  local keys = table.move(request.keys, 1, #request.keys, #own_keys + 1, { table.unpack(own_keys) })
  local settings = certify_settings.read(t, keys, "reduce", 1)
  local asked = request.read(t, settings.criterion)
  local system = certify_model.system(t[1], "reduce: the first entry")
  local detailed = certify_model.of(t[1], t.outputs, "reduce", with_uncertain(certify_scenario.symbols(t, "reduce"),
    system))
  local names, bounds = certify_bound.read(t.error, detailed.outputs, "reduce")
  local scenarios = certify_scenario.list(t, detailed, "reduce")
  certify_settings.choose(settings, t, detailed, scenarios)
  local job = { asked = asked, settings = settings, scenarios = scenarios, apply = certify_scenario.apply,
    outputs = names, bound_of = bounds, bounds = {}, detailed = detailed, rankings = asked.rankings, has = {} }
  for k, name in ipairs(names) do job.bounds[k] = bounds[name] end
  if t.elements ~= nil and t.elements ~= false then
    job.elements = mechanism.new(detailed, { elements = t.elements, keep = asked.keep, outputs = t.outputs }, "reduce")
  end
  return job
end

-- -- proofs

local function options_of(asked)
  local list = { "ranking", asked.rankings[1], "strategy", asked.strategy, "cluster", core.literal(asked.cluster),
    "give_up", core.literal(asked.give_up) }
  for k = 2, #asked.rankings do list[#list + 1], list[#list + 2] = asked.rankings[k], "true" end
  return list
end

local function is_spent(job) return job.asked.budget and core.cpu() - job.start >= job.asked.budget end

local function spent(job)
  return { status = "stopped", reason = ("the budget of %s s is spent; what was accepted until then is proved"):format(
    core.literal(job.asked.budget)) }
end

-- f(...), whose runs stop when the budget is spent.
local function within_budget(job, f, ...)
  core.deadline(job.asked.budget and job.start + job.asked.budget)
  local result = table.pack(pcall(f, ...))
  core.deadline(nil)
  if not result[1] then error(result[2], 0) end
  return table.unpack(result, 2, result.n)
end

-- The settings of a trial: it may be given up as soon as it cannot be accepted, unless its error is to rank it.
local function trial_settings(job, how)
  local ranks = how == "lowered"
  for _, name in ipairs(job.rankings) do ranks = ranks or name == "exact" end
  return setmetatable({ lowered = how == "lowered", stop_above = not ranks and job.bound_of or nil },
    { __index = job.settings })
end

local function begin(job)
  job.start, job.proofs, job.cpu_seconds_rank = core.cpu(), 0, 0
  job.settings.report = {} -- of all runs together
  job.terms, job.log, job.history, job.ranked = {}, {}, {}, {}
  job.solver_options = options_of(job.asked)
  job.solver_of = function() return job.settings end
  job.count = function() job.proofs = job.proofs + 1 end
  job.fresh, job.made = datum.maker(job.detailed, job.scenarios)
  job.steady = function() return datum.steady(job.scenarios) end
  job.form = function(m) return model.live(job.expands and candidate.expanded(m) or m, job.stays) end
  job.prove = function(m, how)
    if is_spent(job) then return spent(job) end
    job.count()
    local result = within_budget(job, proof.prove, job.detailed, m, job.scenarios, trial_settings(job, how))
    return result.status == "stopped" and is_spent(job) and spent(job) or result
  end
end

-- What is true of a model that is the detailed one.
local function no_error(job)
  local error, when, scenarios = {}, {}, {}
  for _, name in ipairs(job.outputs) do error[name], when[name] = 0, job.scenarios[1].times[1] end
  for k, s in ipairs(job.scenarios) do
    scenarios[k] = { name = s.name, status = "proved", reason = "", error = error, when = when, cpu_seconds = 0,
      steps = 0, solver = job.settings.solver, arithmetic = job.settings.arithmetic }
  end
  return { status = "proved", reason = "", error = error, when = when, scenarios = scenarios, cpu_seconds = 0 }
end

-- -- passes

local function is_within(job, error)
  for _, name in ipairs(job.outputs) do
    if not (error[name] <= job.bound_of[name]) then return false end
  end
  return true
end

-- The reduced model without decided kinks: exact if nothing has been cut so far, otherwise a model to be proved.
local function without_kinks(job, simplify)
  if #job.history == 1 then return job.form(job.plain), job.proof end
  local simple = job.form(simplify(job.model))
  local trial = job.prove(simple, "full")
  if trial.status == "proved" and is_within(job, trial.error) then return simple, trial end
  return job.model, job.proof
end

-- Kinks whose branch is proved: the detailed model itself may be written without them.
local function branch_pass(job)
  local simplify, list, stopped = branch.of(job, job.plain)
  local cut, error = {}, no_error(job).error
  for _, entry in ipairs(list) do
    job.terms[#job.terms + 1] = { pass = "branch", equation = "", level = "kink", text = entry[1], technique = "branch",
      replacement = entry[2], effect = entry[2] and error, status = entry[2] and "cut" or "kept" }
    if entry[2] then cut[#cut + 1] = entry[1] end
  end
  if #cut > 0 then
    job.plain = simplify(job.plain)
    job.detailed = job.expands and candidate.expanded(job.plain) or job.plain
    job.model, job.proof = without_kinks(job, simplify)
    job.log[#job.log + 1] = { pass = "branch", outcome = "accepted", candidates = cut, error = job.proof.error }
  end
  return stopped and "stopped" or "complete", stopped and "stopped on request" or nil
end

-- The passes in order: { technique, level or nil }.
local function passes_of(job)
  local list = {}
  if job.elements then list[1] = { "elements" } end
  for _, technique in ipairs(job.asked.reductions) do
    if technique == "branch" or technique == "merge" then
      list[#list + 1] = { technique }
    else
      for level = 0, job.asked.levels do list[#list + 1] = { technique, level } end
    end
  end
  return list
end

-- Terms are those of right-hand sides that are written out. Models of whole mechanisms share more, and are proved in
-- less time, as the mechanisms write them: they are written out when elements have had their pass.
local function write_out(job)
  if job.expands then return end
  job.expands = true
  job.detailed, job.model = candidate.expanded(job.detailed), job.form(job.model)
end

local function search(job)
  for _, p in ipairs(passes_of(job)) do
    local status, reason
    if p[1] ~= "elements" and p[1] ~= "branch" then write_out(job) end
    if is_spent(job) then
      status, reason = "stopped", spent(job).reason
    elseif p[1] == "branch" then
      status, reason = branch_pass(job)
    else
      status, reason = pass.run(job, p[1], p[2])
    end
    if status == "stopped" and is_spent(job) then reason = spent(job).reason end
    if status ~= "complete" then return status, reason end
    job.has[p[1]] = true
  end
  return "complete", ""
end

-- f(job), which Ctrl-C may end anywhere, also between kernel calls: what was accepted until then stands.
local function until_interrupted(job, f)
  local good, status, reason = pcall(f, job)
  if good then return status, reason end
  if core.interrupted() and tostring(status):find("interrupted", 1, true) then
    return "stopped", "stopped on request"
  end
  error(status, 0)
end

-- The model that is left, proved once more as a whole, for the certificate. Where there is no time for it, the trial
-- that it was accepted by was such a proof; where nothing was cut, there is nothing to prove.
local function certify(job)
  if #job.history == 1 or is_spent(job) then return end
  job.count()
  local whole = within_budget(job, proof.prove, job.detailed, job.model, job.scenarios, job.settings)
  if whole.status == "proved" then job.proof = whole end
end

-- -- the result

-- The model with the equations that nothing was cut from as they were given: they say the same. Written out, an
-- equation may be free of a state that it mentions; where that state is gone, it stays written out.
local function restored(job)
  local place, rates, gone = {}, {}, model.gone(job.plain, job.model)
  for i, name in ipairs(job.detailed.states) do place[name] = i end
  for i, name in ipairs(job.model.states) do
    local k = place[name]
    local is_untouched = k and job.model.rates[i] == job.detailed.rates[k] and not gone(job.plain.rates[k])
    rates[i] = is_untouched and job.plain.rates[k] or job.model.rates[i]
  end
  return model.with(job.model, rates)
end

local function result_of(job, before, status, reason)
  local m, error = restored(job), job.proof.error
  local data = datum.prune(job.made, job.scenarios, model.expressions(m))
  return report.of { status = status, reason = reason, ode = model_ode.of(m, job.given, job.scenarios, data),
    mechanism = job.mechanism, detailed = job.given, model = m, outputs = job.outputs, bounds = job.bounds,
    error = error, when = job.proof.when, scenarios = job.proof.scenarios, given = job.scenarios,
    criterion = job.settings.criterion, ranking = job.rankings[1], strategy = job.asked.strategy,
    cluster = job.asked.cluster, give_up = job.asked.give_up,
    settings = { solver = job.settings.solver, arithmetic = job.settings.arithmetic, options = job.settings.options,
      reductions = table.concat(job.asked.reductions, ", "), levels = job.asked.levels, budget = job.asked.budget,
      nodes = job.settings.criterion == "bounds" and job.settings.nodes or nil },
    terms = job.terms, log = job.log, history = job.history, rankings = job.ranked,
    terms_before = before.terms, terms_after = candidate.count(m), equations_before = before.equations,
    equations_after = #m.states, operations_before = before.operations,
    operations_after = core.operations(model.expressions(m)), proofs = job.proofs,
    cpu_seconds = core.cpu() - job.start, cpu_seconds_rank = job.cpu_seconds_rank,
    cpu_seconds_detailed = job.cpu_seconds_detailed }
end

local function finish(job, result)
  local errors, times = {}, job.scenarios[1].times
  for _, name in ipairs(result.outputs) do
    if result.error[name] then errors[#errors + 1], errors[#errors + 2] = name, result.error[name] end
  end
  session.finish("reduce", { status = result.status, code = result.code, reason = result.reason,
    cpu_seconds = result.cpu_seconds, t_reached = times[#times] }, job.settings.report,
    { "criterion", result.criterion, "solver", result.settings.solver, "options", result.settings.options, "ranking",
      result.ranking, "strategy", result.strategy, "cluster", result.cluster, "give_up", result.give_up, "error",
      errors, "terms_before", result.terms_before, "terms_after", result.terms_after, "proofs", result.proofs })
end

-- The detailed model alone: what it costs, and solutions of it in ordinary doubles.
local function look_at_detailed(job)
  local list, status = proof.detailed(job.detailed, job.scenarios, job.settings)
  job.cpu_seconds_detailed = 0
  for _, s in ipairs(list) do job.cpu_seconds_detailed = job.cpu_seconds_detailed + s.cpu_seconds end
  if status == "stopped" then return "stopped", "stopped on request" end
  job.references = reference.list(job.detailed, job.scenarios, job.apply)
  return "complete", ""
end

local function work(job)
  local status, reason = until_interrupted(job, look_at_detailed)
  if status == "complete" then status, reason = until_interrupted(job, search) end
  if status == "complete" then certify(job) end
  return status, reason
end

-- How to forget all that was cut, because a run broke its contract or the detailed model itself has no proof: the model
-- is the detailed one, and nothing is proved.
local function fallback(job)
  local detailed, model_before, first = job.detailed, job.model, job.history[1]
  return function(outcome)
    job.plain, job.detailed, job.model, job.proof = job.given, detailed, model_before, proof.none(outcome)
    job.terms, job.log, job.history, job.ranked = {}, {}, { { terms = first.terms, error = {} } }, {}
  end
end

function verb.reduce(t)
  check.table(t, "reduce")
  local job = read(t)
  begin(job)
  job.given, job.plain = job.detailed, job.detailed -- as given; the same without kinks that are decided
  local before = { terms = candidate.count(job.given), equations = #job.given.states,
    operations = core.operations(model.expressions(job.given)) }
  job.expands, job.mechanism = not job.elements, job.elements and job.elements.mechanism
  job.detailed = job.expands and candidate.expanded(job.detailed) or job.detailed
  job.stays = request.kept_states(job.asked.keep, job.given.states)
  job.model, job.proof = model.live(job.detailed, job.stays), no_error(job)
  local terms = check_terms(job.model, job.given.name, job.elements)
  job.keep = request.check_keep(job.asked.keep, job.given.states, terms, job.elements)
  request.keep_terms(job.stays, terms, job.model, job.keep)
  job.model.starts = model.starts(job.model, job.scenarios, job.stays)
  job.history[1] = { terms = candidate.count(job.model), error = job.proof.error }
  local back = fallback(job)
  local ended, status, reason = code.until_given_up(work, job)
  if ended then back(ended) end
  local result = result_of(job, before, ended and ended.status or status, ended and ended.reason or reason)
  result.code = ended and ended.code or nil
  finish(job, result)
  return result
end

return verb
