-- reduce/model.lua -- what can be said of a model as ambit.reduce passes it around: { states = { name }, units,
-- symbols, rates, outputs = { { name, unit, expression } }, starts = { [state] = number that it starts from in every
-- scenario }, origin: the ambit.ode that it was made of, if known };
-- which equations its outputs reach, how large it is.
local core = require "ambit.core"

local model = {}

local ZERO = core.expression(0)

-- { [name of a leaf] = true } of what an expression depends on, without the time.
local function names_below(expression)
  local names = {}
  for _, leaf in ipairs(core.leaves { expression }) do
    if leaf.kind == "symbol" then names[leaf.name] = true end
  end
  return names
end

-- { [name of a state's symbol] = its number }
function model.places(m)
  local place = {}
  for i, symbol in ipairs(m.symbols) do place[core.leaves({ symbol })[1].name] = i end
  return place
end

-- The states that the outputs, and those in `stays`, reach through the right-hand sides: { [number] = true }.
local function reached(m, stays)
  local place, found, queue = model.places(m), {}, {}
  local function visit(expression)
    for name in pairs(names_below(expression)) do
      local i = place[name]
      if i and not found[i] then
        found[i] = true
        queue[#queue + 1] = i
      end
    end
  end
  for _, output in ipairs(m.outputs) do visit(output.expression) end
  for i, name in ipairs(m.states) do
    if stays[name] then visit(m.symbols[i]) end
  end
  while #queue > 0 do visit(m.rates[table.remove(queue)]) end
  return found
end

-- A reduced model: that one with other rates. What is known of the detailed one besides (invariants of closed loops)
-- need not hold for it.
function model.with(m, rates)
  return { states = m.states, units = m.units, symbols = m.symbols, rates = rates, outputs = m.outputs,
    initial = m.initial, starts = m.starts }
end

-- The same model, written differently: rates, then outputs.
function model.rewritten(m, expressions)
  local same = {}
  for key, value in pairs(m) do same[key] = value end
  same.rates, same.outputs = table.move(expressions, 1, #m.rates, 1, {}), {}
  for k, output in ipairs(m.outputs) do
    same.outputs[k] = { name = output.name, unit = output.unit, expression = expressions[#m.rates + k] }
  end
  return same
end

-- The model of the states in `keep`, { [number] = true }, only.
local function part(m, keep)
  local n = { states = {}, units = {}, symbols = {}, rates = {}, outputs = m.outputs, initial = m.initial,
    starts = m.starts, origin = m.origin or m.system }
  for i in ipairs(m.states) do
    if keep[i] then
      local k = #n.states + 1
      n.states[k], n.units[k], n.symbols[k], n.rates[k] = m.states[i], m.units[i], m.symbols[i], m.rates[i]
    end
  end
  return n
end

-- The numbers that states start from, all scenarios alike; not those of states in `keep`, { [name] = true }.
function model.starts(m, scenarios, keep)
  local starts = {}
  for _, name in ipairs(m.states) do
    local value = scenarios[1].initial[name]
    local same = not keep[name] and core.is_constant(value)
    for _, s in ipairs(scenarios) do same = same and s.initial[name] == value end
    if same then starts[name] = value end
  end
  return starts
end

-- States that never move are the numbers that they start from, as long as that stops others.
local function without_resting(m)
  local moved = true
  while moved do
    local from, to = {}, {}
    for i, name in ipairs(m.states) do
      local value = not (m.initial and m.initial[name]) and m.starts and m.starts[name]
      if value and m.rates[i] == ZERO then from[#from + 1], to[#to + 1] = m.symbols[i], value end
    end
    local expressions = #from > 0 and core.substitute(model.expressions(m), from, to)
    moved = false
    for i, e in ipairs(expressions or {}) do
      moved = moved or e ~= (m.rates[i] or m.outputs[i - #m.rates].expression)
    end
    if moved then m = model.rewritten(m, expressions) end
  end
  return m
end

-- The model without states that never move, and without the equations that no output depends on. What is left has the
-- same solutions: the others are in nobody's right-hand side. A model needs one state at least. stays:
-- { [name of a state] = true } of equations that the user wants to keep.
function model.live(m, stays)
  m = without_resting(m)
  local keep = reached(m, stays)
  if next(keep) == nil then keep[1] = true end
  return part(m, keep)
end

-- A function of an expression: does it depend on a state of a model that another one has not?
function model.gone(m, reduced)
  local missing = {}
  for name in pairs(model.places(m)) do missing[name] = true end
  for name in pairs(model.places(reduced)) do missing[name] = nil end
  return function(expression)
    for name in pairs(names_below(expression)) do
      if missing[name] then return true end
    end
    return false
  end
end

-- States replaced by others wherever they occur, { leaf } by { leaf }; the equations of `gone`, { [number] = true },
-- are dropped.
function model.merged(m, gone, from, to)
  local keep = {}
  for i in ipairs(m.states) do keep[i] = not gone[i] end
  return part(model.rewritten(m, core.substitute(model.expressions(m), from, to)), keep)
end

-- All that a model says: its rates, then its outputs.
function model.expressions(m)
  local list = table.move(m.rates, 1, #m.rates, 1, {})
  for _, output in ipairs(m.outputs) do list[#list + 1] = output.expression end
  return list
end

return model
