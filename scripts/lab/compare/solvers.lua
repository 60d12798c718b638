-- compare/solvers.lua -- which solvers are compared over which arithmetics, with which options.
local check = require "ambit.check"
local choice = require "ambit.compare.choice"
local grid = require "ambit.compare.grid"
local option = require "ambit.option"

local solvers = {}

local function default_of(declaration, name)
  for _, param in ipairs(declaration.parameters) do
    local value = param.name == name and tonumber(param.fallback)
    if value and value > 0 and value < math.huge then return value, param.shape end
  end
end

-- About the defaults of its `order` and its `tolerance`, or as it is.
local function about_defaults(name, declaration)
  local order, shape = default_of(declaration, "order")
  local tolerance = default_of(declaration, "tolerance")
  local list = {}
  if order and shape == "integer" and order > 1 then
    list[1] = { name, order = { math.tointeger((order + 1) // 2), math.tointeger(order), math.tointeger(2 * order) } }
  end
  if tolerance then
    local values = {}
    for i, factor in ipairs { 1e6, 1e3, 1 } do values[i] = tonumber(("%.6g"):format(factor * tolerance)) end
    list[#list + 1] = { name, tolerance = values }
  end
  return #list > 0 and list or { { name } }
end

-- What is compared unless the scene says otherwise: what the solver declares (ambit_solver.compared).
function solvers.declared(name, declaration)
  if not declaration.compared then return about_defaults(name, declaration) end
  local list = {}
  for part in declaration.compared:gmatch "[^;]+" do
    local entry = { name }
    for _, option_values in ipairs(option.declared(part)) do
      local values = {}
      for i, text in ipairs(option_values[2]) do
        values[i] = math.tointeger(tonumber(text)) or tonumber(text) or text
      end
      entry[option_values[1]] = values
    end
    list[#list + 1] = entry
  end
  return list
end

local function default_entries()
  local list = {}
  for _, name in ipairs(grid.installed "solver") do
    local good, declaration = pcall(option.declaration, "solver", name)
    local entries = good and declaration.verb == "simulate" and solvers.declared(name, declaration) or {}
    if not good then entries = { { name } } end
    table.move(entries, 1, #entries, #list + 1, list)
  end
  return list
end

-- As the kernel refuses: by the solver's list, and by what it needs.
local function fits(solver, arithmetic)
  local listed = not solver.arithmetics or (" " .. solver.arithmetics .. " "):find(" " .. arithmetic.arithmetic .. " ",
    1, true) ~= nil
  if solver.rigorous or not solver.arithmetics then return listed and arithmetic.rigorous end
  return listed
end

local function first_of(solver) return (solver.arithmetics or "interval"):match "%S+" end

-- Without a list of arithmetics: a solver's own first one with all the entries of the solver, each other one that fits
-- with the solver's defaults.
local function default_arithmetics(declaration, all)
  local first, others = nil, {}
  for _, c in ipairs(all) do
    if c.arithmetic == first_of(declaration) then
      first = c
    elseif not c.problem and fits(declaration, c) then
      others[#others + 1] = c
    end
  end
  return { first or { arithmetic = first_of(declaration), options = {}, settings = {}, words = {} } }, others
end

local function plain_arithmetics()
  local list = {}
  for i, name in ipairs(grid.installed "arithmetic") do list[i] = { name } end
  return grid.combinations(list)
end

-- The parts of a label: solver and its options, arithmetic and its options; the axis is the solver's if it has one.
local function join(name, s, a, first)
  local family = { name, table.unpack(s.words) }
  if a.arithmetic ~= first or #a.words > 0 or a.axis then
    family[#family + 1] = a.arithmetic
    table.move(a.words, 1, #a.words, #family + 1, family)
  end
  local settings = table.move(s.settings, 1, #s.settings, 1, {})
  for i = 1, #a.settings, 2 do
    settings[#settings + 1] = a.arithmetic .. "." .. a.settings[i]
    settings[#settings + 1] = a.settings[i + 1]
  end
  local by = s.axis and s or a
  if s.axis and a.axis then family[#family + 1] = ("%s=%s"):format(a.axis, a.value) end
  local text = table.concat(family, " ")
  return { solver = name, options = s.options, arithmetic = a.arithmetic, arithmetic_options = a.options,
    settings = settings, axis = by.axis, value = by.value, effort = by.effort, family = text .. (by.axis and
      ", by " .. by.axis or ""), label = by.axis and ("%s %s=%s"):format(text, by.axis, by.value) or text }
end

-- follows: a family without which, if it is too slow, these are not worth trying
local function add_all(list, entry, declaration, arithmetics, follows)
  for _, a in ipairs(arithmetics) do
    for _, s in ipairs(choice.expand(entry, declaration, "compare: solvers")) do
      local c = join(entry[1], s, a, first_of(declaration))
      c.rigorous, c.follows = declaration.rigorous, follows
      list[#list + 1] = c
    end
  end
end

local function failed(name, problem)
  return { solver = name, options = {}, settings = {}, family = name, label = name, problem = problem }
end

local function refused(name, declaration, arithmetics)
  local names = {}
  for i, c in ipairs(arithmetics) do names[i] = c.arithmetic end
  local c = failed(name, nil)
  c.rigorous = declaration.rigorous
  c.refused = ("solver `%s` works with none of the arithmetics %s; what fits: %s"):format(name,
    table.concat(names, ", "), declaration.arithmetics or "those that prove their results")
  return c
end

local function fitting(declaration, arithmetics)
  local list = {}
  for _, c in ipairs(arithmetics) do
    if not c.problem and fits(declaration, c) then list[#list + 1] = c end
  end
  return list
end

-- solvers = { "lohner", { "taylor_model", order = { 8, 12 } } } as entries; all names are of solvers that simulate.
function solvers.entries(list)
  local entries = choice.entries(list, grid.installed "solver", "compare: solvers", "solver")
  for _, entry in ipairs(entries) do
    local good, declaration = pcall(option.declaration, "solver", entry[1])
    if good and declaration.verb ~= "simulate" then
      check.fail("compare: solvers: `%s` is a solver of `%s`, not of `simulate`", entry[1], declaration.verb)
    end
    if good then choice.expand(entry, declaration, "compare: solvers") end -- wrong options are told before any work
  end
  return entries
end

-- The combinations, in the order of the entries; either list may be nil: { solver, options, arithmetic,
-- arithmetic_options, settings, family, axis, value, effort, label, rigorous }, or with `problem` (the plugin cannot
-- be used) or `refused` (nothing that is listed fits it).
function solvers.combinations(entries, arithmetics)
  local named, list, met = entries ~= nil, {}, {}
  local all = arithmetics ~= nil and grid.combinations(arithmetics) or plain_arithmetics()
  for _, entry in ipairs(named and solvers.entries(entries) or default_entries()) do
    local good, declaration = pcall(option.declaration, "solver", entry[1])
    if not good then
      list[#list + 1] = failed(entry[1], tostring(declaration))
    elseif arithmetics == nil then
      local first, others = default_arithmetics(declaration, all)
      add_all(list, entry, declaration, first)
      if not met[entry[1]] and not named then
        add_all(list, { entry[1] }, declaration, others, list[#list].family)
      end
    else
      local some = fitting(declaration, all)
      if #some > 0 then add_all(list, entry, declaration, some) end
      if #some == 0 and named then list[#list + 1] = refused(entry[1], declaration, all) end
    end
    met[entry[1]] = true
  end
  return list
end

return solvers
