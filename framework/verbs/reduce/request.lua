-- reduce/request.lua -- what ambit.reduce is asked besides what it shares with ambit.certify: which techniques in which
-- order, how deep, how candidates are ranked and grouped, how long it may take, what must stay.
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.reduce.element"
local technique = require "ambit.reduce.technique"

local request = {}

request.keys = { "reductions", "ranking", "strategy", "cluster", "give_up", "levels", "budget", "keep", "elements" }

local rankings = { "adjoint", "residual", "one_step", "lowered_order", "exact" }
local strategies = { "predicted", "clusters" }
local is_relative = { adjoint = true, lowered_order = true, exact = true } -- to the bounds: effects can be added up

-- One word, or a list of different ones, of those that are known.
local function words(value, known, what)
  local list, seen = type(value) == "table" and value or { value }, {}
  if type(value) == "table" then check.keys(value, {}, what, #value) end
  if #list == 0 then check.fail("%s: expected one of %s, got an empty table", what, table.concat(known, ", ")) end
  for _, word in ipairs(list) do
    local is_known = false
    for _, name in ipairs(known) do is_known = is_known or name == word end
    if not is_known then
      check.fail("%s: there is no `%s`%s", what, type(word) == "string" and word or check.kind(word),
        type(word) == "string" and check.suggest(word, known) or ": expected one of " .. table.concat(known, ", "))
    end
    if seen[word] then check.fail("%s: `%s` is given twice", what, word) end
    seen[word] = true
  end
  return table.move(list, 1, #list, 1, {})
end

-- What is tried unless the user says: branches cost one run and nothing else; then zeros, then what replaces a term by
-- something that does not move, a number if errors are differences, a range if they are ranges of outputs (a number
-- would have none, a fresh range on the same data has a large difference); then mergers. "linearise" makes equations
-- linear rather than small, so it is done on request.
local defaults = {
  difference = { "branch", "neglect", "constant", "merge" },
  bounds = { "branch", "neglect", "enclosure", "merge" },
}

local function positive(value, least, what)
  if type(value) ~= "number" or value ~= value or value < least then
    check.fail("%s: expected a number not below %s, got %s", what, tostring(least), check.shown(value))
  end
  return value
end

-- 10, "10 s" or "2 min" -> s
local function seconds(value)
  if type(value) ~= "number" and type(value) ~= "string" then
    check.fail('reduce: budget: expected a time such as 10 or "10 s", got %s', check.kind(value))
  end
  local e = core.expression(value, type(value) == "string" and "s" or nil, "reduce: budget")
  local x = core.is_constant(e) and core.interval(e):mid()
  if not x or not (x > 0) or x == math.huge then
    check.fail("reduce: budget: expected a positive time, got %s", check.shown(value))
  end
  return x
end

local function levels_of(value)
  local n = math.tointeger(value)
  if type(value) ~= "number" or not n or n < 0 then
    check.fail("reduce: levels: expected 0 (whole right-hand sides), 1 (their summands) or more, got %s",
      check.shown(value))
  end
  return n
end

-- How candidates are ranked, grouped and given up: as in the paper, or with fewer proofs (docs/numerics/ranking.md)
-- where the effect of a candidate is the error that the criterion asks for. Ranges may stay although every solution
-- moves.
local function read_search(t, criterion, q)
  local by_paper = criterion == "bounds"
  q.rankings = words(t.ranking == nil and (by_paper and "residual" or "adjoint") or t.ranking, rankings,
    "reduce: ranking")
  local predicts = is_relative[q.rankings[1]]
  q.strategy = t.strategy == nil and (predicts and "predicted" or "clusters")
    or words(t.strategy, strategies, "reduce: strategy")[1]
  if q.strategy == "predicted" and not predicts then
    check.fail('reduce: strategy: "predicted" needs ranking "adjoint", "lowered_order" or "exact", whose effects are '
      .. 'errors; got "%s"', q.rankings[1])
  end
  q.cluster = t.cluster == nil and 10 or positive(t.cluster, 1, "reduce: cluster")
  q.give_up = t.give_up == nil and (by_paper and math.huge or 10) or positive(t.give_up, 1, "reduce: give_up")
end

-- t, the criterion -> { reductions, rankings, strategy, cluster, give_up, levels, budget = s or nil, keep = { name } }
function request.read(t, criterion)
  local q = { levels = 2, keep = {} }
  read_search(t, criterion, q)
  if t.elements and type(t.reductions) == "table" and next(t.reductions) == nil then
    q.reductions = {} -- elements only
  else
    q.reductions = t.reductions == nil and defaults[criterion] or words(t.reductions, technique.names,
      "reduce: reductions")
  end
  if t.levels ~= nil then q.levels = levels_of(t.levels) end
  if t.budget ~= nil then q.budget = seconds(t.budget) end
  if t.keep ~= nil then
    local list = type(t.keep) == "table" and t.keep or { t.keep }
    check.keys(list, {}, "reduce: keep", #list)
    for k, name in ipairs(list) do q.keep[k] = check.text(name, "reduce: keep") end
  end
  return q
end

-- The names of `keep` that are states: { [name] = true }.
function request.kept_states(names, states)
  local stays = {}
  for _, name in ipairs(names) do
    for _, state in ipairs(states) do stays[name] = stays[name] or name == state or nil end
  end
  return stays
end

-- The equations of terms that are kept stay, too, and so do the states in those terms. m: the model of the terms.
function request.keep_terms(stays, terms, m, keep)
  for _, term in ipairs(terms) do
    local is_kept = keep[term.text]
    if is_kept then stays[m.states[term.equation]] = true end
    for _, leaf in ipairs(is_kept and core.leaves { term.expression } or {}) do
      for i, symbol in ipairs(m.symbols) do
        if symbol == leaf.expression then stays[m.states[i]] = true end
      end
    end
  end
end

-- The names of `keep` must be among the states, the terms and (elements: of reduce/mechanism.lua, or nil) the parts of
-- the detailed model.
function request.check_keep(names, states, terms, elements)
  local known, is_known, set = table.move(states, 1, #states, 1, {}), {}, {}
  for _, term in ipairs(terms) do known[#known + 1] = term.text end
  for _, c in ipairs(elements and element.list(elements.mechanism, true) or {}) do
    known[#known + 1], known[#known + 2] = c.element, c.name
  end
  for _, name in ipairs(known) do is_known[name] = true end
  for _, name in ipairs(names) do
    if not is_known[name] then
      local near = core.nearest(name, known)
      check.fail("reduce: keep: there is no state or term `%s`%s", name,
        near and ("; did you mean `%s`?"):format(near) or (" (states: %s)"):format(table.concat(states, ", ")))
    end
    set[name] = true
  end
  return set
end

return request
