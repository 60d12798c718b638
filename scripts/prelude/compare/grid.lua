-- compare/grid.lua -- which arithmetics are compared, with which options: { "affine", symbols = { 10, 20 } } stands for
-- one combination for each value in the list.
local check = require "ambit.check"
local core = require "ambit.core"
local option = require "ambit.option"

local grid = {}

-- What is compared unless the scene says otherwise. Of these, what is installed; what is installed besides runs with
-- its defaults.
grid.usual = {
  { "real" },
  { "interval" },
  { "gradient" },
  { "affine", product = { "fast", "tight" }, symbols = { 0, 10, 20, 50 } },
  { "taylor_model", order = { 1, 2, 3, 4, 5, 6 } },
  { "mpfr", precision = { 53, 113, 200, 500 } },
}

local function installed()
  local names = {}
  for _, entry in ipairs(core.list()) do
    if entry.kind == "arithmetic" then names[#names + 1] = entry.name end
  end
  return names
end

-- The usual grid for what is installed.
function grid.default()
  local there, list = {}, {}
  for _, name in ipairs(installed()) do there[name] = true end
  for _, entry in ipairs(grid.usual) do
    if there[entry[1]] then list[#list + 1] = entry end
    there[entry[1]] = nil
  end
  for _, name in ipairs(check.sorted(there)) do list[#list + 1] = { name } end
  return list
end

-- Does a list given for this option mean several values, not one value with several numbers?
local function is_scalar(param)
  return param.shape == "" or param.shape == "integer" or param.shape == "flag" or param.shape:find "|" ~= nil
end

local function is_numeric(param) return param.shape == "" or param.shape == "integer" end

-- { { name = value, ... }, ... }: every choice of one value for each option, those of the last option side by side
local function choices(entry, parameters)
  local list = { {} }
  for _, param in ipairs(parameters) do
    local value = entry[param.name]
    if value ~= nil then
      local is_list = type(value) == "table" and (is_scalar(param) or type(value[1]) == "table")
      local values = is_list and value or { value }
      if #values == 0 then check.fail("compare: %s: the list of values for `%s` is empty", entry[1], param.name) end
      local longer = {}
      for _, chosen in ipairs(list) do
        for _, one in ipairs(values) do
          local copy = { entry[1] }
          for key, old in pairs(chosen) do copy[key] = old end
          copy[param.name] = one
          longer[#longer + 1] = copy
        end
      end
      list = longer
    end
  end
  return list
end

-- The option whose numbers are the orders of a line in the picture: the last one with a list of numbers.
local function find_axis(entry, parameters)
  local axis
  for _, param in ipairs(parameters) do
    local value = entry[param.name]
    if is_numeric(param) and type(value) == "table" and #value > 1 then axis = param.name end
  end
  return axis
end

-- Options in the order of the declaration, but the axis last, so that its values are next to each other.
local function ordered(parameters, axis)
  local list, last = {}, nil
  for _, param in ipairs(parameters) do
    if param.name == axis then last = param else list[#list + 1] = param end
  end
  list[#list + 1] = last
  return list
end

local function combination(chosen, declaration, axis)
  local options, settings = option.collect(chosen, declaration)
  local family, value = { declaration.name }, nil
  for i = 1, #settings, 2 do
    if settings[i] == axis then
      value = settings[i + 1]
    else
      family[#family + 1] = ("%s=%s"):format(settings[i], settings[i + 1])
    end
  end
  local c = { arithmetic = declaration.name, options = options, settings = settings, axis = axis, value = value,
    family = table.concat(family, " "), rigorous = declaration.rigorous }
  c.label = axis and ("%s %s=%s"):format(c.family, axis, value) or c.family
  return c
end

local function expand(entry, list)
  local good, declaration = pcall(option.declaration, "arithmetic", entry[1])
  if not good then
    list[#list + 1] = { arithmetic = entry[1], options = {}, settings = {}, family = entry[1], label = entry[1],
      problem = tostring(declaration) }
    return
  end
  check.keys(entry, option.names(declaration), "compare: arithmetics: " .. entry[1], 1)
  local axis = find_axis(entry, declaration.parameters)
  for _, chosen in ipairs(choices(entry, ordered(declaration.parameters, axis))) do
    list[#list + 1] = combination(chosen, declaration, axis)
  end
end

local function checked(entry, i, names)
  if type(entry) == "string" then entry = { entry } end
  if type(entry) ~= "table" or type(entry[1]) ~= "string" then
    check.fail('compare: arithmetics[%d]: expected a name or { "name", option = value }, got %s', i,
      check.kind(entry))
  end
  for _, name in ipairs(names) do if name == entry[1] then return entry end end
  check.fail("compare: there is no arithmetic `%s`%s", entry[1], check.suggest(entry[1], names))
end

-- The entries of arithmetics = { ... }, each as a table, all names known; loads nothing.
function grid.entries(arithmetics)
  check.table(arithmetics, "compare: arithmetics")
  check.keys(arithmetics, {}, "compare: arithmetics", #arithmetics)
  if #arithmetics == 0 then check.fail "compare: arithmetics: the list is empty" end
  local list, names = {}, installed()
  for i, entry in ipairs(arithmetics) do list[i] = checked(entry, i, names) end
  return list
end

-- { "interval", { "affine", symbols = { 10, 20 } } }, or nil for the usual grid -> the combinations: { arithmetic,
-- options, settings, family, axis, value, label, rigorous }, or with a problem: why the plugin cannot be used.
function grid.combinations(arithmetics)
  local list = {}
  local entries = arithmetics == nil and grid.default() or grid.entries(arithmetics)
  for _, entry in ipairs(entries) do expand(entry, list) end
  return list
end

return grid
