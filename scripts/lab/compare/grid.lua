-- compare/grid.lua -- which arithmetics are compared, with which options.
local check = require "ambit.check"
local choice = require "ambit.compare.choice"
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

-- The names of the installed plugins of a kind.
function grid.installed(kind)
  local names = {}
  for _, entry in ipairs(core.list()) do
    if entry.kind == kind then names[#names + 1] = entry.name end
  end
  return names
end

-- The usual grid for what is installed.
function grid.default()
  local there, list = {}, {}
  for _, name in ipairs(grid.installed "arithmetic") do there[name] = true end
  for _, entry in ipairs(grid.usual) do
    if there[entry[1]] then list[#list + 1] = entry end
    there[entry[1]] = nil
  end
  for _, name in ipairs(check.sorted(there)) do list[#list + 1] = { name } end
  return list
end

local function expand(entry, list)
  local good, declaration = pcall(option.declaration, "arithmetic", entry[1])
  if not good then
    list[#list + 1] = { arithmetic = entry[1], options = {}, settings = {}, family = entry[1], label = entry[1],
      problem = tostring(declaration) }
    return
  end
  for _, c in ipairs(choice.expand(entry, declaration, "compare: arithmetics")) do
    c.arithmetic, c.rigorous = entry[1], declaration.rigorous
    c.family = table.concat({ entry[1], table.unpack(c.words) }, " ")
    c.label = c.axis and ("%s %s=%s"):format(c.family, c.axis, c.value) or c.family
    list[#list + 1] = c
  end
end

-- The entries of arithmetics = { ... }, each as a table, all names known; loads nothing.
function grid.entries(arithmetics)
  return choice.entries(arithmetics, grid.installed "arithmetic", "compare: arithmetics", "arithmetic")
end

-- { "interval", { "affine", symbols = { 10, 20 } } }, or nil for the usual grid -> the combinations: { arithmetic,
-- options, settings, family, axis, value, effort, label, rigorous }, or with a problem: why the plugin cannot be used.
function grid.combinations(arithmetics)
  local list = {}
  local entries = arithmetics == nil and grid.default() or grid.entries(arithmetics)
  for _, entry in ipairs(entries) do expand(entry, list) end
  return list
end

return grid
