-- reduce/report_scenario.lua -- a scenario for readers: its uncertain data by name, and everything that is given as
-- expressions of them.
local check = require "ambit.check"
local compare_table = require "ambit.compare.table"
local core = require "ambit.core"
local number = require "ambit.report.number"
local uncertain = require "ambit.run.uncertain"

local scenario = {}

local function name_of(leaf) return core.leaves({ leaf })[1].name end

local function is_in(list, expression)
  for _, entry in ipairs(list) do
    if entry.expression == expression then return true end
  end
  return false
end

local function expressions_of(model)
  local list = table.move(model.rates, 1, #model.rates, 1, {})
  for _, output in ipairs(model.outputs) do list[#list + 1] = output.expression end
  return list
end

-- The uncertain data of both models, and of a scenario if one is given: { { name, lo, hi, expression }, ... }. Those of
-- the models come first.
function scenario.data(self, given)
  local list, used = {}, {}
  for _, name in ipairs(self.detailed.states) do used[name] = true end
  local function add(expressions)
    for _, leaf in ipairs(uncertain.leaves(expressions)) do
      if not is_in(list, leaf.expression) then
        local name = leaf.name
        while used[name] do name = name .. "'" end -- a state of the same name
        used[name] = true
        list[#list + 1] = { name = name, lo = leaf.lo, hi = leaf.hi, expression = leaf.expression }
      end
    end
  end
  add(expressions_of(self.detailed))
  add(expressions_of(self.model))
  if not given then return list end
  add(given.values or {})
  for _, state in ipairs(check.sorted(given.initial)) do add { given.initial[state] } end
  return list
end

-- Expressions with the data in them as symbols of their names.
function scenario.named(data, expressions)
  local leaves, symbols = {}, {}
  for k, datum in ipairs(data) do leaves[k], symbols[k] = datum.expression, core.symbol(datum.name, "1") end
  return core.substitute(expressions, leaves, symbols)
end

local NAMES = 8 -- of states with the same value that are all listed

-- "x = 1", "u1, u2 = 0", "u1 ... u50 = 0" for neighbours with equal values; nothing for a datum that bears the name
-- itself, which is listed with its range
local function assignments(data, list)
  local parts, names, value = {}, {}, nil
  local function close()
    if #names > NAMES then names = { names[1] .. " ... " .. names[#names] } end
    if #names > 0 then parts[#parts + 1] = ("%s = %s"):format(table.concat(names, ", "), value) end
  end
  for _, entry in ipairs(list) do
    local text = tostring(scenario.named(data, { entry[2] })[1])
    if text ~= value then
      close()
      names, value = {}, text
    end
    if text ~= entry[1] then names[#names + 1] = entry[1] end
  end
  close()
  return parts
end

-- Parts joined by commas into lines no longer than `width`.
local function flowed(parts, width)
  local lines, line = {}, nil
  for _, part in ipairs(parts) do
    part = compare_table.short(part, width - 1)
    local joined = line and line .. ", " .. part
    if joined and compare_table.length(joined) < width then
      line = joined
    else
      if line then lines[#lines + 1] = line .. "," end
      line = part
    end
  end
  if line then lines[#lines + 1] = line end
  return lines
end

local function time(said) return type(said) == "number" and core.literal(said) or said end

-- Times, data and initial values as lines.
function scenario.lines(self, given, width)
  local data, parts, list = scenario.data(self, given), {}, {}
  local said = given.times.said or given.times
  parts[1] = ("t from %s to %s s"):format(time(said[1]), time(said[#said]))
  for _, datum in ipairs(data) do
    parts[#parts + 1] = ("%s in %s"):format(datum.name, number.range(datum.lo, datum.hi))
  end
  for k, leaf in ipairs(given.leaves or {}) do list[#list + 1] = { name_of(leaf), given.values[k] } end
  for _, state in ipairs(self.detailed.states) do
    if given.initial[state] then list[#list + 1] = { state, given.initial[state] } end
  end
  local assigned = assignments(data, list)
  table.move(assigned, 1, #assigned, #parts + 1, parts)
  return flowed(parts, width)
end

return scenario
