-- reduce/reference.lua -- solutions of the detailed model in ordinary doubles, at single values of its data: rankings,
-- means and points of linearisation come from them. They prove nothing.
local check = require "ambit.check"
local core = require "ambit.core"

local reference = {}

local NODES = 100       -- equal intervals of time
local STIFF = 1000      -- e-folds of decay over the run from which an implicit method is used
local TOLERANCE = "1e-9"

-- Where the data are taken: signs of the distance from the middle, datum by datum.
local function patterns(n)
  local list = { function() return 0 end }
  if n == 0 then return list end
  local function add(sign) list[#list + 1] = sign end
  add(function() return -1 end)
  add(function() return 1 end)
  if n > 1 then
    add(function(k) return k % 2 == 0 and 1 or -1 end)
    add(function(k) return k % 2 == 0 and -1 or 1 end)
  end
  return list
end

-- The uncertain data below some expressions: leaves as core.leaves gives them.
function reference.unknowns(expressions)
  local list = {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "unknown" then list[#list + 1] = leaf end
  end
  return list
end

local function point_of(leaf, sign)
  local mid = 0.5 * leaf.lo + 0.5 * leaf.hi
  return sign == 0 and mid or sign < 0 and leaf.lo or leaf.hi
end

local function grid(times)
  local t0, t1, list = times[1], times[#times], {}
  for k = 0, NODES do list[k + 1] = t0 + (t1 - t0) * (k / NODES) end
  list[NODES + 1] = t1
  return list
end

-- How the equations are integrated: the implicit methods need derivatives.
function reference.options(system, initial, times)
  local list = { "relative", TOLERANCE, "absolute", "1e-12" }
  local facts = core.look { system = system, solver = "", initial = initial, times = times }
  if facts and facts.kinks == 0 and facts.decay > STIFF then
    list[#list + 1], list[#list + 2] = "method", "msbdf"
  end
  return list
end

-- The states at the nodes, { { x1, x2, ... }, ... }, or nil where the integration ends early.
local function follow(model, rates, initial, nodes)
  local system = core.system(model.states, model.units, model.symbols, rates)
  local track, facts = core.simulate({ system = system, solver = core.default.draws,
    options = reference.options(system, initial, nodes), initial = initial, times = nodes }, nil, { silent = true })
  if facts.status ~= "complete" then return nil end
  local rows = {}
  for k, t in ipairs(nodes) do
    local row, step = {}, k > 1 and core.track_find(track, t)
    for i in ipairs(model.states) do
      if step then row[i] = core.track_value(track, step, i, false):mid() end
    end
    rows[k] = row
  end
  local start = core.evaluate { arithmetic = core.default.points, expressions = initial }
  for i, x in ipairs(start) do rows[1][i] = x:mid() end
  return rows
end

local function numbers(values)
  local list = {}
  for k, value in ipairs(values) do list[k] = core.expression(value) end
  return list
end

local function starts(model, scenario)
  local initial = {}
  for i, name in ipairs(model.states) do initial[i] = scenario.initial[name] end
  return initial
end

-- The data that a scenario is made of.
local function unknowns_of(rates, initial)
  return reference.unknowns(table.move(initial, 1, #initial, #rates + 1, table.move(rates, 1, #rates, 1, {})))
end

-- One solution: { scenario = number, t = { s }, x = rows by node, symbols = { leaf }, unknowns = { leaf }, values =
-- { number } }.
local function solution(model, scenario, number, nodes, rates, initial, leaves, values)
  local at = numbers(values)
  local x = follow(model, core.substitute(rates, leaves, at), core.substitute(initial, leaves, at), nodes)
  return x and { scenario = number, t = nodes, x = x, symbols = model.symbols, unknowns = leaves, values = values,
    applied = scenario }
end

-- Solutions of a model over scenarios; apply(scenario, { expression }) as ambit.certify.scenario has it. `nodes` of the
-- list: the times for each scenario.
function reference.list(model, scenarios, apply)
  local list = { nodes = {} }
  for number, scenario in ipairs(scenarios) do
    local nodes, rates, initial = grid(scenario.times), apply(scenario, model.rates), starts(model, scenario)
    local unknowns = unknowns_of(rates, initial)
    list.nodes[number] = nodes
    for _, sign in ipairs(patterns(#unknowns)) do
      local leaves, values = {}, {}
      for k, leaf in ipairs(unknowns) do leaves[k], values[k] = leaf.expression, point_of(leaf, sign(k)) end
      list[#list + 1] = solution(model, scenario, number, nodes, rates, initial, leaves, values)
    end
    if #list == 0 or list[#list].scenario ~= number then
      check.fail("reduce: scenario `%s`: no solution in ordinary doubles, by which terms are ranked, reaches the end",
        scenario.name)
    end
  end
  return list
end

-- The data of a scenario's unknowns at a reference, and middles for those that it does not know.
local function point_along(r, unknowns)
  local leaves, values = {}, {}
  for k, leaf in ipairs(unknowns) do
    leaves[k], values[k] = leaf.expression, point_of(leaf, 0)
    for n, known in ipairs(r.unknowns) do
      if known == leaf.expression then values[k] = r.values[n] end
    end
  end
  return leaves, values
end

-- Another model along the same data: a reference of it, or nil.
function reference.again(r, model, scenarios, apply)
  local scenario = scenarios[r.scenario]
  local rates, initial = apply(scenario, model.rates), starts(model, scenario)
  local leaves, values = point_along(r, unknowns_of(rates, initial))
  return solution(model, scenario, r.scenario, r.t, rates, initial, leaves, values)
end

-- Leaves of the states that a reference knows, and of time; their values at node k.
local function binding(r, k)
  local leaves, values = table.move(r.symbols, 1, #r.symbols, 1, {}), numbers(r.x[k])
  leaves[#leaves + 1], values[#values + 1] = core.time(), core.expression(r.t[k])
  return leaves, values
end

-- Expressions with the data of a reference put in. An uncertain datum that it does not know is at its middle.
local function with_data(r, expressions)
  local fixed = core.substitute(expressions, r.applied.leaves, r.applied.values)
  fixed = core.substitute(fixed, r.unknowns, numbers(r.values))
  local others, middles = {}, {}
  for k, leaf in ipairs(reference.unknowns(fixed)) do
    others[k], middles[k] = leaf.expression, core.expression(point_of(leaf, 0))
  end
  return core.substitute(fixed, others, middles)
end

-- Values of expressions along a reference, { { number }, ... } by node: over the symbols of its states, what scenarios
-- vary, uncertain data and time.
function reference.values(r, expressions)
  local fixed, rows = with_data(r, expressions), {}
  for k in ipairs(r.t) do
    local row = {}
    local leaves, values = binding(r, k)
    local list = core.evaluate { arithmetic = core.default.points, expressions = fixed, leaves = leaves,
      values = values }
    for i, x in ipairs(list) do row[i] = x:mid() end
    rows[k] = row
  end
  return rows
end

return reference
