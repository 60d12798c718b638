-- split.lua -- simulate { split = { beta1 = 16, [datum] = 2 } } or { split = 32 }: which uncertain data are cut, and
-- into how many parts.
local check = require "ambit.check"
local core = require "ambit.core"

local split = {}

local MOST = 65536 -- pieces

-- The uncertain data below an expression.
local function unknowns(expression)
  local list = {}
  for _, leaf in ipairs(core.leaves { expression }) do
    if leaf.kind == "unknown" and leaf.lo < leaf.hi then list[#list + 1] = leaf.expression end
  end
  return list
end

local function index_of(list, expression)
  for i, known in ipairs(list) do
    if known == expression then return i end
  end
end

-- Everything with a name that may be uncertain: { name, expression }, states first.
local function named_data(q)
  local list = {}
  for i, name in ipairs(q.system.states) do list[i] = { name, q.initial[i] } end
  local parameters = q.system.parameters or {}
  for _, name in ipairs(check.sorted(parameters)) do list[#list + 1] = { name, parameters[name] } end
  return list
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
      check.fail("%s: there is no state or parameter `%s`%s", what, key, check.suggest(key, names))
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
  local data, fields = named_data(q), { unknown = {}, name = {}, parts = {} }
  local function add(unknown, name, parts)
    local n = #fields.unknown + 1
    fields.unknown[n], fields.name[n], fields.parts[n] = unknown, name, parts
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
  for _, entry in ipairs(data) do -- names for the others, where they are one datum
    local list = unknowns(entry[2])
    if #list == 1 and not index_of(fields.unknown, list[1]) then add(list[1], entry[1], 0) end
  end
  return fields
end

return split
