-- reduce/branch.lua -- abs, min and max of the equations, replaced by the branch that is proved to be the active one at
-- all times, for all data of all scenarios.
--
-- Exact: let f be the detailed right-hand side and g the one with the branches. A validated run of x' = f encloses the
-- argument along every solution and proves its sign, so f(x(t)) = g(x(t)) along every solution x of x' = f: it solves
-- x' = g too, from the same start. Solutions of x' = g are unique where the proofs that follow run it (their solvers
-- need a Lipschitz condition), so both models have the same ones, and what is proved of one holds for the other.
local core = require "ambit.core"
local flow = require "ambit.run.flow"
local model = require "ambit.reduce.model"

local branch = {}

local CUTS = 64 -- in time, for a condition in a step of a run

-- For each kind: the two conditions <= 0 of which one decides, and what then remains.
local cases = {
  abs = function(k) return { { -k.a, k.a }, { k.a, -k.a } } end,
  max = function(k) return { { k.b - k.a, k.a }, { k.a - k.b, k.b } } end,
  min = function(k) return { { k.a - k.b, k.a }, { k.b - k.a, k.b } } end,
}

-- Which of the conditions hold at all times of one scenario: { [number] = true }, or nil and what the run said.
local function proved_over(job, scenario, m, conditions)
  local rates, initial, watched = job.apply(scenario, m.rates), {}, {}
  for i, name in ipairs(m.states) do initial[i] = scenario.initial[name] end
  for k, g in ipairs(job.apply(scenario, conditions)) do
    watched[k] = { g = g, name = tostring(k), kind = "always" }
  end
  local q = { initial = initial, times = scenario.times, system = { states = m.states, rates = rates, parameters = {},
    system = core.system(m.states, m.units, m.symbols, rates) } }
  local how = job.solver_of(q)
  local findings, outcome = core.watch(flow(q, how), { conditions = watched, cuts = CUTS })
  job.count()
  local holds = {}
  for k, finding in ipairs(findings) do holds[k] = finding.holds end
  return holds, outcome.status == "stopped"
end

-- Those that hold over every scenario.
local function proved(job, m, conditions)
  local all = {}
  for k in ipairs(conditions) do all[k] = true end
  for _, scenario in ipairs(job.scenarios) do
    local holds, stopped = proved_over(job, scenario, m, conditions)
    if stopped then return {}, true end
    for k in ipairs(conditions) do all[k] = all[k] and holds[k] end
  end
  return all, false
end

-- What each kink becomes: { { kink, expression or nil } }.
local function decide(job, m, kinks)
  local conditions, list = {}, {}
  for _, kink in ipairs(kinks) do
    for _, case in ipairs(cases[kink.op](kink)) do conditions[#conditions + 1] = case[1] end
  end
  local holds, stopped = proved(job, m, conditions)
  for k, kink in ipairs(kinks) do
    local one, other = table.unpack(cases[kink.op](kink))
    list[k] = { kink, holds[2 * k - 1] and one[2] or holds[2 * k] and other[2] or nil }
  end
  return list, stopped
end

-- The model with each decided kink replaced: from the outermost inwards, since a branch may hold further ones.
local function simplified(m, decisions)
  local expressions = model.expressions(m)
  for k = #decisions, 1, -1 do
    local kink, active = decisions[k][1], decisions[k][2]
    if active then expressions = core.substitute(expressions, { kink.node }, { active }) end
  end
  return model.rewritten(m, expressions)
end

-- How any model is written without the kinks of m that are decided, { { text, replacement or nil } } of all, and
-- whether the user interrupted. job: scenarios, apply, solver_of, count.
function branch.of(job, m)
  local kinks = core.kinks(model.expressions(m))
  if #kinks == 0 then return function(other) return other end, {}, false end
  local decisions, stopped = decide(job, m, kinks)
  local list = {}
  for k, d in ipairs(decisions) do list[k] = { tostring(d[1].node), d[2] and tostring(d[2]) } end
  return function(other) return simplified(other, decisions) end, list, stopped
end

return branch
