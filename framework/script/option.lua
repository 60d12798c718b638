-- option.lua -- arithmetics and solvers by name, with their declared options.
local check = require "ambit.check"
local core = require "ambit.core"

local option = {}

local declared = {}

-- The declaration of a plugin, loaded on first use.
function option.declaration(kind, name)
  local id = kind .. "." .. name
  declared[id] = declared[id] or core.plugin(kind, name)
  return declared[id]
end

function option.names(declaration)
  local list = {}
  for i, param in ipairs(declaration.parameters) do list[i] = param.name end
  return list
end

local DEEPEST = 2 -- rows of numbers

-- As the text that the declaration reads: exact for numbers. depth: of lists around the value
local function text_of(value, what, depth)
  local kind = check.kind(value)
  if kind == "number" then
    if value ~= value then check.fail("%s: the number is NaN", what) end
    return math.type(value) == "integer" and tostring(value) or core.literal(value)
  end
  if kind == "string" then return value end
  if kind == "boolean" then return tostring(value) end
  if kind == "table" then
    if depth >= DEEPEST then check.fail("%s: expected a number or a word, got lists within lists", what) end
    local list = {}
    for i, entry in ipairs(value) do list[i] = text_of(entry, ("%s[%d]"):format(what, i), depth + 1) end
    return table.concat(list, ",")
  end
  check.fail("%s: expected a number, a word or a list, got %s", what, kind)
end

-- The keys of t that the plugin declares: { name, text, name, text, ... } and, for records, the same as settings.
function option.collect(t, declaration)
  local list, settings = {}, {}
  for _, param in ipairs(declaration.parameters) do
    if t[param.name] ~= nil then
      local text = text_of(t[param.name], declaration.name .. ": " .. param.name, 0)
      list[#list + 1], list[#list + 2] = param.name, text
    end
  end
  table.move(list, 1, #list, 1, settings)
  return list, settings
end

-- arithmetic = "interval" or { "affine", symbols = 20 } -> name, options
function option.arithmetic(value, what)
  if type(value) == "string" then return value, {} end
  if type(value) ~= "table" or type(value[1]) ~= "string" then
    check.fail('%s: expected a name or { "name", option = value }, got %s', what, check.kind(value))
  end
  local declaration = option.declaration("arithmetic", value[1])
  check.keys(value, option.names(declaration), what .. " " .. value[1], 1)
  return value[1], (option.collect(value, declaration))
end

-- What a solver declares of its options, "order=6,10 tolerance=1e-6" -> { { "order", { "6", "10" } }, ... }
function option.declared(text)
  local list = {}
  for name, values in text:gmatch "([%w_]+)=(%S+)" do
    local all = {}
    for value in values:gmatch "[^,]+" do all[#all + 1] = value end
    list[#list + 1] = { name, all }
  end
  return list
end

return option
