-- reduce/certify/scenario.lua -- the scenarios over which a reduced model has to hold: sets of initial values,
-- parameters and inputs, several at once.
--
-- SCENARIO = { name, times = { numbers }, initial = { [state] = expression of unknowns }, leaves = { symbol }, values =
-- { expression of unknowns and time } }. The same unknown in initial values and equations is the same datum.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local instant = require "ambit.run.instant"
local simulate = require "ambit.simulate"
local uncertain = require "ambit.run.uncertain"

local scenario = {}

local keys = { "name", "t", "initial", "parameters", "inputs" }

-- The entries of scenarios = { ... }, or the verb's table itself as the only one.
local function entries(t, what)
  if t.scenarios == nil then return { {} } end
  local list = check.table(t.scenarios, what .. ": scenarios")
  check.keys(list, {}, what .. ": scenarios", #list)
  if #list == 0 then check.fail("%s: scenarios: expected at least one", what) end
  for i, entry in ipairs(list) do
    local where = ("%s: scenarios[%d]"):format(what, i)
    check.keys(check.table(entry, where), keys, where)
  end
  return list
end

-- What an entry or the verb says about parameters and inputs: { [key] = value }, each once; { [key] = true } of inputs.
local function said(t, what)
  local values, is_input = {}, {}
  for _, field in ipairs { "parameters", "inputs" } do
    local list = t[field] == nil and {} or check.table(t[field], ("%s: %s"):format(what, field))
    for _, key in ipairs(check.sorted(list)) do
      if values[key] ~= nil then check.fail("%s: `%s` is a parameter and an input", what, tostring(key)) end
      if type(key) ~= "string" and check.kind(key) ~= "expression" then
        check.fail("%s: %s: expected names, or uncertain data as keys, got %s", what, field, check.kind(key))
      end
      values[key], is_input[key] = list[key], field == "inputs" or nil
    end
  end
  return values, is_input
end

-- Equal data are equal keys, even if they are two Lua values.
local function find(values, key)
  if values[key] ~= nil then return values[key] end
  if type(key) == "string" then return nil end
  for other, value in pairs(values) do
    if other == key then return value end
  end
end

-- A datum as a symbol must not meet another one: no state and no parameter is called so.
local function symbol_of(key, used)
  if type(key) == "string" then return core.symbol(key, "1") end
  local leaf = uncertain.leaves({ key })[1]
  local name = ("datum `%s`"):format(leaf and leaf.name or tostring(key))
  while used[name] do name = name .. "'" end
  used[name] = true
  return core.symbol(name, "1")
end

-- { [parameter or datum] = symbol } for everything that scenarios give values to.
function scenario.symbols(t, what)
  local symbols, used = {}, {}
  local function add(values)
    for _, key in ipairs(check.sorted(values)) do
      if not find(symbols, key) then symbols[key] = symbol_of(key, used) end
    end
  end
  add(said(t, what))
  for i, entry in ipairs(entries(t, what)) do add(said(entry, ("%s: scenarios[%d]"):format(what, i))) end
  return symbols
end

-- unit: that of what the value stands for; nil: not known. An input varies: a plain interval for one says too little;
-- for a parameter it is a datum.
local function value_of(value, unit, is_input, what)
  if type(value) == "function" then value = formula.call(value, what, core.time()) end
  local e = core.expression(value, unit, what)
  core.refuse_plain({ e }, what, is_input)
  for _, leaf in ipairs(core.leaves { e }) do
    if leaf.kind == "symbol" then check.fail("%s depends on `%s`: expected data and time only", what, leaf.name) end
  end
  return e
end

-- What the system says where no scenario does: its own parameter, or the datum itself.
local function default_of(model, key)
  if type(key) ~= "string" then return key end
  return model.parameters[key]
end

-- -- initial values

local function strict(values, what)
  return setmetatable({}, { __index = function(_, key)
    if values[key] == nil then
      check.fail("%s: there is no parameter `%s`%s", what, tostring(key), check.suggest(key, check.sorted(values)))
    end
    return values[key]
  end })
end

-- A table, or a function(p) of the parameters of this scenario.
local function initial_of(value, m, s, what)
  if type(value) == "function" then
    local p = {}
    for name, own in pairs(m.parameters) do p[name] = own end
    for key, v in pairs(s.by_key) do
      if type(key) == "string" then p[key] = v end
    end
    value = formula.call(value, what .. ": initial", strict(p, what .. ": initial"))
  end
  local list = simulate.initial(value, m.start, what)
  list = core.substitute(list, { core.time() }, { instant.start(s.times) })
  local named = {}
  for i, name in ipairs(m.start.states) do
    named[name] = list[i]
    for _, leaf in ipairs(core.leaves { list[i] }) do
      if leaf.kind == "symbol" then
        check.fail("%s: initial.%s depends on `%s`: expected data only", what, name, leaf.name)
      end
    end
  end
  return named
end

-- -- all together

local function read(t, entry, number, count, m, what)
  local where = count > 1 and ("%s: scenarios[%d]"):format(what, number) or what
  local s = { name = entry.name or (count > 1 and ("scenario %d"):format(number) or "scenario"), by_key = {},
    leaves = {}, values = {} }
  check.text(s.name, where .. ": name")
  s.times = instant.list(entry.t == nil and t.t or entry.t, where .. ": t")
  local own, own_inputs = said(entry, where)
  local common, common_inputs = said(t, what)
  for _, key in ipairs(check.sorted(m.varied)) do
    local value, is_input = find(own, key), find(own_inputs, key)
    if value == nil then value, is_input = find(common, key), find(common_inputs, key) end
    if value == nil then value = default_of(m, key) end
    local n = #s.leaves + 1
    s.leaves[n] = m.varied[key]
    local name = ("%s: `%s`"):format(where, tostring(key))
    s.values[n] = value_of(value, core.unit_of(default_of(m, key)), is_input or false, name)
    core.name_data({ s.values[n] }, tostring(key))
    s.by_key[key] = s.values[n]
  end
  s.initial = initial_of(entry.initial == nil and t.initial or entry.initial, m, s, where)
  return s
end

-- The union of the states of the detailed model and of those that only the reduced one has.
local function start_of(model, reduced)
  local states, units, known = {}, {}, {}
  for _, m in ipairs { model, reduced } do
    for i, name in ipairs(m.states) do
      if not known[name] then states[#states + 1], units[#units + 1], known[name] = name, m.units[i], true end
    end
  end
  return { states = states, units = units, mechanism = model.system and model.system.mechanism }
end

-- What scenarios vary has a symbol, and so has a state: those of one name would be taken for each other.
local function check_names(varied, states, what)
  for _, key in ipairs(check.sorted(varied)) do
    for _, name in ipairs(states) do
      if varied[key] == core.symbol(name, "1") then
        check.fail("%s: `%s` is a parameter that scenarios vary and a state: rename one of them", what, name)
      end
    end
  end
end

-- model: MODEL with its `varied` symbols, which scenario.symbols made; reduced: nil, or a MODEL with states of its own,
-- which want initial values too
function scenario.list(t, model, what, reduced)
  local list, names = {}, {}
  local m = { varied = model.varied, parameters = model.parameters, start = start_of(model, reduced) }
  local given = entries(t, what)
  check_names(m.varied, m.start.states, what)
  for i, entry in ipairs(given) do
    list[i] = read(t, entry, i, #given, m, what)
    if names[list[i].name] then check.fail("%s: there are two scenarios `%s`", what, list[i].name) end
    names[list[i].name] = true
  end
  return list
end

-- Expressions of a model, with the values that a scenario gives, by the clock of its runs.
function scenario.apply(s, list) return instant.formulas(core.substitute(list, s.leaves, s.values), s.times.shift) end

return scenario
