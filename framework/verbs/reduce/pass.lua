-- reduce/pass.lua -- one pass of ambit.reduce: candidates of one technique at one level, ranked and cancelled by a
-- solver with `solves reduction` (algorithm 1 of Mikelsons and Brandt 2009), each trial proved against the detailed
-- model over all scenarios.
--
-- job: detailed, model (the reduced one so far), proof (of it), references, scenarios, apply, keep, stays, has,
-- outputs, bounds (numbers in their order), rankings, solver_options, prove(model, how) -> proof, elements and form (of
-- reduce/mechanism.lua), and the lists that the result consists of: terms, log, history, ranked.
local candidate = require "ambit.reduce.candidate"
local core = require "ambit.core"
local merge = require "ambit.reduce.candidate_merge"
local model = require "ambit.reduce.model"
local reference = require "ambit.reduce.reference"

local pass = {}

-- -- what core.reduce is asked

-- Leaves of some expressions that are neither states nor time, and that references give a value.
local function data_of(expressions, symbols)
  local list = {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    local is_state = leaf.kind == "time"
    for _, symbol in ipairs(symbols) do is_state = is_state or symbol == leaf.expression end
    if not is_state then list[#list + 1] = leaf.expression end
  end
  return list
end

-- Rows of numbers, one after the other.
local function flat(rows)
  local list = {}
  for _, row in ipairs(rows) do table.move(row, 1, #row, #list + 1, list) end
  return list
end

local function references_of(references, symbols, data)
  local list = {}
  for k, r in ipairs(references) do
    local x, p, n = reference.values(r, symbols), reference.values(r, data), #r.t
    local times = r.t
    if times[n] < times[1] then -- the solver wants them ascending
      local back_t, back_x, back_p = {}, {}, {}
      for i = 1, n do back_t[i], back_x[i], back_p[i] = times[n + 1 - i], x[n + 1 - i], p[n + 1 - i] end
      times, x, p = back_t, back_x, back_p
    end
    list[k] = { scenario = r.scenario, t = times, x = flat(x), data = flat(p) }
  end
  return list
end

-- The request of core.reduce without its callbacks.
local function request_of(job, found)
  local m, names, texts, effect, of, state = job.model, {}, {}, {}, {}, {}
  for k, c in ipairs(found) do
    texts[k] = ("%s: %s"):format(c.equation, c.text)
    for _, e in ipairs(c.effects) do
      local n = #effect + 1
      state[n], effect[n], of[n] = e[1], e[2], k
    end
  end
  local outputs = {}
  for k, output in ipairs(m.outputs) do names[k], outputs[k] = output.name, output.expression end
  local all = model.expressions(m)
  table.move(effect, 1, #effect, #all + 1, all)
  local data = data_of(all, m.symbols)
  return { solver = core.default.strategy, states = m.states, symbols = m.symbols, data = data, rates = m.rates,
    outputs = names, output_expressions = outputs, bounds = job.bounds, candidates = texts, effect = effect,
    effect_candidate = of, effect_state = state, references = references_of(job.references, m.symbols, data),
    options = job.solver_options }
end

-- -- trials

local function same_list(a, b)
  if #a ~= #b then return false end
  for i, x in ipairs(a) do
    if x ~= b[i] then return false end
  end
  return true
end

-- Do two models say the same?
local function same(a, b)
  return same_list(a.states, b.states) and same_list(model.expressions(a), model.expressions(b))
end

-- Trials of a pass: the same model is proved once only.
local function trials(job, found)
  local known = { { model = job.model, how = "full", proof = job.proof } }
  local list = { last = nil }
  function list.prove(cut, how)
    local m, mechanism = found.build(cut)
    if not m then
      list.last = { proof = { status = "unable", reason = mechanism or "there is no such model" } }
      return list.last.proof
    end
    for _, trial in ipairs(known) do
      if trial.how == how and same(trial.model, m) then
        list.last = { model = trial.model, mechanism = mechanism, proof = trial.proof } -- other parts, same equations
        return trial.proof
      end
    end
    local trial = { model = m, mechanism = mechanism, how = how, proof = job.prove(m, how) }
    if trial.proof.status ~= "stopped" then known[#known + 1] = trial end
    list.last = trial
    return trial.proof
  end
  return list
end

local function by_output(job, errors)
  local named = {}
  for k, name in ipairs(job.outputs) do named[name] = errors and errors[k] or nil end
  return named
end

-- What has been decided, as it is decided.
local function note(job, found, trial, outcome, indices, errors)
  local texts, effect = {}, by_output(job, errors)
  for n, k in ipairs(indices) do
    texts[n] = ("%s: %s"):format(found[k].equation, found[k].text)
    found[k].effect = effect
    found[k].status = outcome == "accepted" and "cut" or "kept"
  end
  job.log[#job.log + 1] = { pass = job.pass_name, outcome = outcome, candidates = texts, error = effect,
    reason = trial.proof.reason ~= "" and trial.proof.reason or nil }
  if outcome ~= "accepted" then return end
  job.model, job.proof, job.mechanism = trial.model, trial.proof, trial.mechanism or job.mechanism
  job.history[#job.history + 1] = { terms = candidate.count(job.model), error = effect }
end

-- -- what is kept of a pass

local function has_state(m, name)
  for _, state in ipairs(m.states) do
    if state == name then return true end
  end
  return false
end

local function record(job, found, technique, result)
  local rank = result.rankings[job.rankings[1]] or {}
  for k, c in ipairs(found) do
    local status = c.status or "kept"
    local moot = found.moot and found.moot(k) -- of an element that another one has left nothing of
    local gone = status == "kept" and not found.moot and not has_state(job.model, c.equation)
    if moot or gone then status = "removed" end
    job.terms[#job.terms + 1] = { pass = job.pass_name, equation = c.equation, level = c.level, text = c.text,
      technique = c.technique or technique, replacement = c.replacement, rank = rank[k], effect = c.effect,
      status = status }
  end
  local ranked = { pass = job.pass_name }
  for name, values in pairs(result.rankings) do ranked[name] = values end
  job.ranked[#job.ranked + 1] = ranked
end

-- What may be cut by a technique at a level, or (elements) of a mechanism.
local function candidates_of(job, technique, level)
  if technique == "elements" then return job.elements:list(job.model, job.form) end
  if technique == "merge" then return merge.list(job, job.model) end
  return candidate.list(job, job.model, technique, level)
end

-- Runs a pass; returns "complete", "stopped" or "unable" with a reason. level: nil for what has none.
function pass.run(job, technique, level)
  job.pass_name = level and ("%s, level %d"):format(technique, level) or technique
  local found = candidates_of(job, technique, level)
  if #found == 0 then return "complete" end
  local q, list = request_of(job, found), trials(job, found)
  function q.prove(cut, how)
    local proof = list.prove(cut, how)
    if proof.status ~= "proved" then return proof.status, nil, proof.reason end
    local errors = {}
    for k, name in ipairs(job.outputs) do errors[k] = proof.error[name] end
    return "proved", errors
  end
  function q.tried(outcome, indices, errors) note(job, found, list.last, outcome, indices, errors) end
  local result = core.reduce(q)
  job.cpu_seconds_rank = job.cpu_seconds_rank + result.cpu_seconds_rank
  record(job, found, technique, result)
  return result.status, result.reason
end

return pass
