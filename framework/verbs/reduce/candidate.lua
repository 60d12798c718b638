-- reduce/candidate.lua -- what one pass may cut: the terms of one level, each replaced by one technique.
--
-- Candidates are { [k] = { equation = name of the state, level, text, replacement = text, effects = { { i, change of
-- the rate of state i } } }, build = function({ k }) -> MODEL with those cut }; those of merging two variables are in
-- reduce/candidate_merge.lua.
local core = require "ambit.core"
local model = require "ambit.reduce.model"
local reference = require "ambit.reduce.reference"
local technique = require "ambit.reduce.technique"

local candidate = {}

local EXPAND = 100 -- summands of a right-hand side at most, when products over sums are written out

-- The rates written as the sums of their terms. The proof wants both models written alike, so that what they have in
-- common cancels.
function candidate.expanded(m)
  local tree, rates = core.term_tree(m.rates, 1, EXPAND), {}
  for _, term in ipairs(core.term_list(tree)) do
    if term.level == 1 then
      local i = term.equation
      rates[i] = rates[i] and rates[i] + term.expression or term.expression
    end
  end
  local all = model.expressions(m)
  return model.rewritten(m, table.move(rates, 1, #rates, 1, all))
end

-- The terms of a model down to a level: tree, list.
function candidate.terms(m, level)
  local tree = core.term_tree(m.rates, level, EXPAND)
  return tree, core.term_list(tree)
end

-- How many summands the right-hand sides of a model have; an equation that says 0 has none.
function candidate.count(m)
  local _, list = candidate.terms(m, 1)
  local n, zero = 0, core.expression(0)
  for _, term in ipairs(list) do
    if term.level == 1 and term.expression ~= zero then n = n + 1 end
  end
  return n
end

-- The least and the greatest value at each node over the references of a scenario, as means over the nodes.
local function mean_range(tables, j)
  local lo, hi, nodes = 0, 0, #tables[1]
  for k = 1, nodes do
    local least, most = math.huge, -math.huge
    for _, rows in ipairs(tables) do least, most = math.min(least, rows[k][j]), math.max(most, rows[k][j]) end
    lo, hi = lo + least / nodes, hi + most / nodes
  end
  return lo, hi
end

-- Over all rows of all tables: mean and greatest magnitude of column j.
local function mean_and_size(tables, j)
  local sum, size, n = 0, 0, 0
  for _, rows in ipairs(tables) do
    for _, row in ipairs(rows) do sum, size, n = sum + row[j], math.max(size, math.abs(row[j])), n + 1 end
  end
  return sum / n, size
end

-- Of each expression along the references: { mean, size, lo, hi }, the last two the hull of the scenarios.
function candidate.along(expressions, references)
  local tables, by_scenario, list = {}, {}, {}
  for k, r in ipairs(references) do
    tables[k] = reference.values(r, expressions)
    by_scenario[r.scenario] = by_scenario[r.scenario] or {}
    table.insert(by_scenario[r.scenario], tables[k])
  end
  for j in ipairs(expressions) do
    local lo, hi = math.huge, -math.huge
    for _, own in pairs(by_scenario) do
      local least, most = mean_range(own, j)
      lo, hi = math.min(lo, least), math.max(hi, most)
    end
    local mean, size = mean_and_size(tables, j)
    list[j] = { mean = mean, size = size, lo = lo, hi = hi }
  end
  return list
end

-- The terms that a name of `keep` is about: those, what they are in and what is in them.
local function kept_terms(list, keep)
  local named, kept = {}, {}
  for k, term in ipairs(list) do
    named[k] = keep[term.text] or named[term.parent] or false
    local above = named[k] and k or 0
    while above > 0 and not kept[above] do
      kept[above] = true
      above = list[above].parent
    end
  end
  return kept
end

-- Terms, by the one they are in, of which not all are numbers: sums of numbers are coefficients, not sums.
local function varied_parents(list)
  local varied = {}
  for _, term in ipairs(list) do
    varied[term.parent] = varied[term.parent] or not core.is_constant(term.expression)
  end
  return varied
end

-- The terms of one level that may be touched: { number in the list }. One that is a whole right-hand side was a
-- candidate at level 0.
local function open_terms(m, list, level, keep)
  local kept, varied, open = kept_terms(list, keep), varied_parents(list), {}
  for k, term in ipairs(list) do
    local is_open = not kept[k] and not keep[m.states[term.equation]] and (level < 2 or varied[term.parent])
    local is_whole = level > 0 and term.expression == m.rates[term.equation]
    if term.level == level and is_open and not is_whole then open[#open + 1] = k end
  end
  return open
end

-- What the techniques look at besides a term: a function of its number among `expressions`.
local function facts_of(job, m, name, expressions)
  local mean, size = {}, {}
  for i, s in ipairs(name == "linearise" and candidate.along(m.symbols, job.references) or {}) do
    mean[i], size[i] = s.mean, s.size
  end
  local is_asked = name == "constant" or name == "enclosure"
  local values = is_asked and candidate.along(expressions, job.references) or {}
  return function(k)
    return { symbols = m.symbols, mean = mean, size = size, values = values[k], has = job.has, fresh = job.fresh,
      steady = job.steady() }
  end
end

-- Candidates of a model for a technique at a level. job: references, keep, stays = { [name] = true }, has =
-- { [technique that came before] = true }, fresh and steady (of reduce/datum.lua).
function candidate.list(job, m, name, level)
  local tree, list = candidate.terms(m, next(job.keep) and math.max(level, 1) or level) -- kept: of level 1
  local open, expressions, found, terms, by = open_terms(m, list, level, job.keep), {}, {}, {}, {}
  for n, k in ipairs(open) do expressions[n] = list[k].expression end
  local facts = facts_of(job, m, name, expressions)
  for n, k in ipairs(open) do
    local term = list[k]
    local replacement, text = technique[name](term, facts(n))
    if replacement then
      local i, c = term.equation, #found + 1
      local change = core.term_rewrite(tree, { k }, { replacement })[i] - m.rates[i]
      terms[c], by[c] = k, replacement
      found[c] = { equation = m.states[i], level = level, text = term.text, replacement = text,
        effects = { { i, change } } }
    end
  end
  function found.build(cut)
    local indices, replacements = {}, {}
    for n, c in ipairs(cut) do indices[n], replacements[n] = terms[c], by[c] end
    return model.live(model.with(m, core.term_rewrite(tree, indices, replacements)), job.stays)
  end
  return found
end

return candidate
