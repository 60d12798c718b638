-- split.lua -- simulate { split = { beta1 = 16, [datum] = 2 } } or { split = 32 }: which uncertain data are cut, and
-- into how many parts.
local check = require "ambit.check"
local uncertain = require "ambit.run.uncertain"

local split = {}

local MOST = 65536 -- pieces

-- The uncertain data below an expression.
local function unknowns(expression) return (uncertain.data { expression }) end

local function index_of(list, expression)
  for i, known in ipairs(list) do
    if known == expression then return i end
  end
end

-- Everything with a name that may be uncertain: { name, expression }: states, parameters, data.
local function named_data(q)
  local list, taken = {}, {}
  local function add(name, expression)
    if taken[name] then return end
    taken[name], list[#list + 1] = true, { name, expression }
  end
  for i, name in ipairs(q.system.states) do add(name, q.initial[i]) end
  local parameters = q.system.parameters or {}
  for _, name in ipairs(check.sorted(parameters)) do add(name, parameters[name]) end
  local all = table.move(q.initial, 1, #q.initial, 1, {})
  local rates = q.system.rates or {} -- of what another verb asks for, there are states only
  table.move(rates, 1, #rates, #all + 1, all)
  local data, _, _, _, names = uncertain.data(all)
  for i, datum in ipairs(data) do add(names[i], datum) end
  return list, data, names
end

local function count(value, what)
  local n = check.count(value, what)
  if n > MOST then check.fail("%s: at most %d, got %d", what, MOST, n) end
  return n
end

-- The one uncertain datum that a key of the table means.
local function datum_of(key, data, what)
  local expression, name = key, "datum"
  if type(key) == "string" then
    local names = {}
    expression, name = nil, key
    for i, entry in ipairs(data) do
      names[i] = entry[1]
      if entry[1] == key then expression = entry[2] end
    end
    if not expression then
      check.fail("%s: there is no state, parameter or datum `%s`%s", what, key, check.suggest(key, names))
    end
  elseif check.kind(key) ~= "expression" then
    check.fail("%s: expected names of states or parameters, or uncertain data as keys, got %s", what, tostring(key))
  end
  local list = unknowns(expression)
  if #list == 0 then check.fail("%s: `%s` is not uncertain, so there is nothing to cut", what, name) end
  if #list > 1 then
    check.fail("%s: `%s` depends on %d uncertain data; name one of them: split = { [datum] = parts }", what, name,
      #list)
  end
  return list[1], name
end

-- read(value, q, what) -> the fields of core.simulate's run options that a split fills
function split.read(value, q, what)
  if value == nil then return {} end
  local data, all, names = named_data(q)
  local fields, cut = { cuts = {} }, {}
  local function add(unknown, name, parts)
    local i = index_of(all, unknown)
    cut[#cut + 1] = unknown
    fields.cuts[#cut] = { unknown = unknown, name = i and names[i] or name, parts = parts }
  end
  if type(value) == "table" and next(value) ~= nil then
    for _, key in ipairs(check.sorted(value)) do
      local unknown, name = datum_of(key, data, what)
      add(unknown, name, count(value[key], ("%s: %s"):format(what, name)))
    end
  elseif type(value) == "number" then
    fields.pieces = count(value, what)
  else
    check.fail("%s: expected a number of pieces, or { state = parts }, got %s", what,
      type(value) == "table" and "an empty table" or check.kind(value))
  end
  for i, datum in ipairs(all) do -- names for the others
    if not index_of(cut, datum) then add(datum, names[i], 0) end
  end
  return fields
end

return split
