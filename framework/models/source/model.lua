-- source/model.lua -- what the source of an ode has to declare: states, data, parameters, symbols that are given later.
local check = require "ambit.check"
local core = require "ambit.core"

local source_model = {}

local function find(list, expression)
  for _, entry in ipairs(list) do
    if entry.expression == expression then return entry end
  end
end

-- A function that makes names different from all before: n(text), text_2, ...
function source_model.namer(taken, separator)
  return function(wanted)
    local name, k = wanted, 1
    while taken[name] do
      k = k + 1
      name = wanted .. separator .. k
    end
    taken[name] = true
    return name
  end
end

-- The data and symbols that the equations and the parameters depend on.
local function read_leaves(self, states)
  local all = table.move(self.rates, 1, #self.rates, 1, {})
  for _, name in ipairs(check.sorted(self.parameters)) do all[#all + 1] = self.parameters[name] end
  local data, free = {}, {}
  for _, leaf in ipairs(core.leaves(all)) do
    if leaf.kind == "unknown" then
      data[#data + 1] = { expression = leaf.expression, lo = leaf.lo, hi = leaf.hi, wanted = leaf.name }
    elseif leaf.kind == "symbol" and not find(states, leaf.expression) then
      free[#free + 1] = { expression = leaf.expression, wanted = leaf.name, unit = leaf.unit }
    end
  end
  return data, free
end

-- What a datum without a name is called after: the one parameter that it is a part of.
local function owner(self, datum)
  local found
  for _, name in ipairs(check.sorted(self.parameters)) do
    if find(core.leaves { self.parameters[name] }, datum.expression) then
      if found then return nil end
      found = name
    end
  end
  return found and found .. "_datum"
end

-- { states = { { name, unit, expression, rate } }, data = { { name, expression, lo, hi, direct = is it a parameter } },
-- free = { { name, unit, expression } }, parameters = { { name, expression, datum = or nil, free = or nil } } }
function source_model.read(self)
  local model, taken = { name = self.name, states = {}, parameters = {} }, {}
  for i, name in ipairs(self.states) do
    model.states[i] = { name = name, unit = self.units[i], expression = self.symbols[i], rate = self.rates[i] }
    taken[name] = true
  end
  model.data, model.free = read_leaves(self, model.states)
  for i, name in ipairs(check.sorted(self.parameters)) do
    local expression = self.parameters[name]
    local parameter = { name = name, expression = expression }
    local datum, free = find(model.data, expression), find(model.free, expression)
    if datum and not datum.name then datum.name, datum.direct, parameter.datum = name, true, datum end
    if free and not free.name then free.name, parameter.free = name, free end
    model.parameters[i] = parameter
    taken[name] = true
  end
  local unique = source_model.namer(taken, "_")
  for _, free in ipairs(model.free) do free.name = free.name or unique(free.wanted) end
  for _, datum in ipairs(model.data) do
    datum.name = datum.name or unique(datum.wanted or owner(self, datum) or "datum")
  end
  return model
end

-- The rates, after the parts that they share: { { expression, name } }, { texts of the parts }, { texts of the rates }.
-- names: { { expression, name } } of all that has one; part_name(i, count): what the i-th of them is called
function source_model.write(model, language, names, part_name)
  local rates = {}
  for i, state in ipairs(model.states) do rates[i] = state.rate end
  local parts, named, list = core.source_share(rates), table.move(names, 1, #names, 1, {}), {}
  for i, part in ipairs(parts) do
    list[i] = { expression = part, name = part_name(i, #parts) }
    named[#named + 1] = { part, list[i].name }
  end
  local texts = core.source(rates, language, named)
  for i, rate in ipairs(rates) do
    local part = find(list, rate)
    if part then texts[i] = part.name end
  end
  return list, core.source(parts, language, named), texts
end

-- The text broken at blanks outside of quotation marks, so that lines are at most `width` long where that can be.
function source_model.wrap(text, indent, width)
  local lines, line = {}, ""
  local function take(word)
    if line ~= "" and #line + #word > width then
      lines[#lines + 1] = (line:gsub(" +$", ""))
      line = indent
    end
    line = line .. word
  end
  local from, quote, escaped = 1, nil, false
  for i = 1, #text do
    local c = text:sub(i, i)
    if quote then
      if c == quote and not escaped then quote = nil end
      escaped = c == "\\" and not escaped
    elseif c == '"' or c == "'" then
      quote = c
    elseif c == " " and text:sub(from, i):find "%S" and text:sub(i - 6, i) ~= "number " then
      take(text:sub(from, i))
      from = i + 1
    end
  end
  take(text:sub(from))
  lines[#lines + 1] = line
  return table.concat(lines, "\n")
end

return source_model
