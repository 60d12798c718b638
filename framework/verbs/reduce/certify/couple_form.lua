-- reduce/certify/couple_form.lua -- the implicit form of one model, and of two that run together, where their rates are
-- those of mechanisms: balances with accelerations in them instead of formulas that divide.
--
-- With R(x, a) = 0 of the detailed model and S(y, b) = 0 of the reduced one, x = y + e and a = b + c,
-- R(x, a) - S(x - e, a - c) = 0 has c in it as S has b: affine, stage by stage. Why: docs/numerics/reduction.md.
local core = require "ambit.core"
local fresh = require "ambit.fresh"
local scenario = require "ambit.reduce.certify.scenario"

local form = {}

local LARGE = 5 -- unknowns from which on formulas for accelerations are far longer (verbs/sensitivity)

-- Are the rates of a model those of the system that it was made of, state by state?
local function is_as_written(model, system)
  local rate, right = {}, core.system_right(system.system)
  for i, name in ipairs(system.states) do rate[name] = right[i] end
  for i, name in ipairs(model.states) do
    if rate[name] ~= model.rates[i] then return false end
  end
  return true
end

-- The form of a model over a scenario, with rates = { [state] = F }; nil: there is none that is taken.
function form.of(model, s)
  local system = model.origin or model.system
  local own = system and core.system_implicit(system.system)
  if not own or #own.unknowns < LARGE or not is_as_written(model, system) then return nil end
  local rates = {}
  for i, rate in ipairs(scenario.apply(s, own.rates)) do rates[system.states[i]] = rate end
  return { unknowns = own.unknowns, residuals = scenario.apply(s, own.residuals), stage_end = own.stage_end,
    pivot = own.pivot, rates = rates }
end

local function are_equal(a, b)
  for i = 1, math.max(#a, #b) do
    if a[i] ~= b[i] then return false end
  end
  return true
end

local function twice(list, n)
  local both = table.move(list, 1, #list, 1, {})
  for i, x in ipairs(list) do both[#list + i] = n + x end
  return both
end

local function append(to, list) return table.move(list, 1, #list, #to + 1, to) end

-- What changes of a list where a model's symbols stand for the reduced model's values, and x = y + e.
local function moved(list, leaves, deltas)
  local values = {}
  for k, leaf in ipairs(leaves) do values[k] = leaf + deltas[k] end
  return core.substitute(list, leaves, values)
end

-- active: states with errors, { name, symbol, error }; about: "detailed" or "reduced", as in certify/couple.lua.
-- Unknowns: those of the model that the run is about, then what the others are off by.
function form.of_pair(detailed, reduced, s, active, about)
  local d, r = form.of(detailed, s), form.of(reduced, s)
  if not d or not r or not are_equal(d.unknowns, r.unknowns) or not are_equal(d.stage_end, r.stage_end)
    or not are_equal(d.pivot, r.pivot) then return nil end
  local leaves, deltas, f, g, errors, used = {}, {}, {}, {}, {}, fresh.set(detailed.states, reduced.states)
  for _, unknown in ipairs(d.unknowns) do used[core.leaves({ unknown })[1].name] = true end
  for j, state in ipairs(active) do
    used[state.error_name] = true
    leaves[j], deltas[j], f[j], g[j] = state.symbol, state.error, d.rates[state.name], r.rates[state.name]
  end
  for k, unknown in ipairs(d.unknowns) do
    errors[k] = core.symbol(fresh.name("error of " .. core.leaves({ unknown })[1].name, used), "")
    leaves[#active + k], deltas[#active + k] = unknown, errors[k]
  end
  local residuals = core.difference(append(append({}, d.residuals), f), append(append({}, r.residuals), g), leaves,
    deltas)
  local is_reduced = about == "reduced"
  if is_reduced then residuals = moved(residuals, leaves, deltas) end
  local rates, n = {}, #d.unknowns
  for name, rate in pairs(d.rates) do rates[name] = is_reduced and moved({ rate }, leaves, deltas)[1] or rate end
  for j, state in ipairs(active) do
    rates[state.error_name] = residuals[n + j]
    if is_reduced then rates[state.name] = g[j] end
  end
  local own = is_reduced and r or d
  return { unknowns = append(append({}, d.unknowns), errors), stage_end = twice(d.stage_end, n),
    pivot = twice(d.pivot, n), rates = rates,
    residuals = append(append({}, own.residuals), table.move(residuals, 1, n, 1, {})) }
end

-- Gives the form to a system of some of the states, if it depends on no others.
function form.give(system, own)
  local known, list = {}, {}
  for _, leaves in ipairs { system.symbols, own.unknowns } do
    for _, leaf in ipairs(leaves) do known[core.leaves({ leaf })[1].name] = true end
  end
  for i, name in ipairs(system.states) do
    list[i] = own.rates[name]
    if not list[i] then return end
  end
  for _, leaf in ipairs(core.leaves(append(append({}, list), own.residuals))) do
    if leaf.kind == "symbol" and not known[leaf.name] then return end
  end
  core.system_give_implicit(system.system, { unknowns = own.unknowns, rates = list, residuals = own.residuals,
    stage_end = own.stage_end, pivot = own.pivot })
end

return form
