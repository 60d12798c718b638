-- compare/choice.lua -- { "affine", symbols = { 10, 20 } }: a plugin with lists of values for its options stands for
-- one combination for each value.
local check = require "ambit.check"
local option = require "ambit.option"

local choice = {}

-- Does a list given for this option mean several values, not one value with several numbers?
local function is_scalar(param)
  return param.shape == "" or param.shape == "integer" or param.shape == "flag" or param.shape:find "|" ~= nil
end

local function is_numeric(param) return param.shape == "" or param.shape == "integer" end

local function with(chosen, name, value)
  local copy = { chosen[1] }
  for key, old in pairs(chosen) do copy[key] = old end
  copy[name] = value
  return copy
end

-- { { name = value, ... }, ... }: every choice of one value for each option, those of the last option side by side
local function choices(entry, parameters)
  local list = { {} }
  for _, param in ipairs(parameters) do
    local value = entry[param.name]
    if value ~= nil then
      local is_list = type(value) == "table" and (is_scalar(param) or type(value[1]) == "table")
      local values, longer = is_list and value or { value }, {}
      if #values == 0 then check.fail("compare: %s: the list of values for `%s` is empty", entry[1], param.name) end
      for _, chosen in ipairs(list) do
        for _, one in ipairs(values) do longer[#longer + 1] = with(chosen, param.name, one) end
      end
      list = longer
    end
  end
  return list
end

-- The option whose numbers are the points of a line in the picture: the last one with a list of numbers.
local function find_axis(entry, parameters)
  local axis
  for _, param in ipairs(parameters) do
    local value = entry[param.name]
    if is_numeric(param) and type(value) == "table" and #value > 1 then axis = param end
  end
  return axis
end

-- Options in the order of the declaration, but the axis last, so that its values are next to each other.
local function ordered(parameters, axis)
  local list, last = {}, nil
  for _, param in ipairs(parameters) do
    if param == axis then last = param else list[#list + 1] = param end
  end
  list[#list + 1] = last
  return list
end

local function chosen_of(chosen, declaration, axis)
  local options, settings = option.collect(chosen, declaration)
  local words, value = {}, nil
  for i = 1, #settings, 2 do
    if axis and settings[i] == axis.name then
      value = settings[i + 1]
    else
      words[#words + 1] = ("%s=%s"):format(settings[i], settings[i + 1])
    end
  end
  -- a larger integer (an order) takes longer, and so does a smaller number (a tolerance)
  return { options = options, settings = settings, words = words, axis = axis and axis.name, value = value,
    effort = axis and tonumber(value) and (axis.shape == "integer" and tonumber(value) or -tonumber(value)) }
end

-- An entry { "name", option = value or list } of that plugin -> { options, settings, words = those that do not vary,
-- axis, value, effort = grows with what the value on the axis costs }, one for each choice of values.
function choice.expand(entry, declaration, what)
  check.keys(entry, option.names(declaration), ("%s: %s"):format(what, entry[1]), 1)
  local axis, list = find_axis(entry, declaration.parameters), {}
  for i, chosen in ipairs(choices(entry, ordered(declaration.parameters, axis))) do
    list[i] = chosen_of(chosen, declaration, axis)
  end
  return list
end

-- The entries of a list { "name", { "name", option = value } }, each as a table, all names among `names`.
function choice.entries(list, names, what, kind)
  check.table(list, what)
  check.keys(list, {}, what, #list)
  if #list == 0 then check.fail("%s: the list is empty", what) end
  local entries, is_known = {}, {}
  for _, name in ipairs(names) do is_known[name] = true end
  for i, entry in ipairs(list) do
    if type(entry) == "string" then entry = { entry } end
    if type(entry) ~= "table" or type(entry[1]) ~= "string" then
      check.fail('%s[%d]: expected a name or { "name", option = value }, got %s', what, i, check.kind(entry))
    end
    if not is_known[entry[1]] then
      check.fail("compare: there is no %s `%s`%s", kind, entry[1], check.suggest(entry[1], names))
    end
    entries[i] = entry
  end
  return entries
end

return choice
