-- reduce/json.lua -- a reduction, or a certificate, as one JSON object: everything that a reader needs to repeat the
-- proof. Numbers are the shortest texts that read back as the same double; what JSON has no number for is `null` (not
-- a number) or the text "inf", "-inf", as in the records of `ambit run --json`.
local check = require "ambit.check"
local core = require "ambit.core"
local encoder = require "ambit.report.json"
local provenance = require "ambit.provenance"
local scenarios = require "ambit.reduce.report_scenario"
local source_lua = require "ambit.source.lua"

local json = {}

local function number(x)
  if x ~= x then return encoder.raw "null" end
  if x == math.huge or x == -math.huge then return core.literal(x) end
  return encoder.raw(core.literal(x))
end

-- A table by name stays an object when it is empty.
local function object(t) return next(t) == nil and encoder.raw "{}" or t end

local by_name = { error = true, when = true }

-- Plain values -> what the encoder takes: numbers exact, expressions and enclosures as text, functions left out.
local function plain(value)
  local kind = type(value)
  if kind == "number" then return number(value) end
  if kind == "userdata" then return tostring(value) end
  if kind ~= "table" then return value end
  local copy = {}
  for key, entry in pairs(value) do
    if type(entry) ~= "function" then copy[key] = plain(entry) end
    if by_name[key] and type(entry) == "table" then copy[key] = object(copy[key]) end
  end
  return copy
end

-- -- models: what is uncertain bears the names under which the data are listed

local function texts_of(expressions)
  local list = {}
  for k, e in ipairs(expressions) do list[k] = tostring(e) end
  return list
end

-- Lua, or nil for what is too long without names for its parts.
local function lua_of(expression, names)
  local good, list = pcall(core.source, { expression }, "lua", names)
  return good and list[1] or nil
end

-- What data are in Lua: variables, or fields of `data`.
local function data_names(data)
  local names = {}
  for k, datum in ipairs(data) do names[k] = { core.symbol(datum.name, "1"), source_lua.variable(datum.name) } end
  return names
end

local function outputs_of_model(model, data)
  local names, list = data_names(data), {}
  for i, symbol in ipairs(model.symbols) do names[#names + 1] = { symbol, ("s[%q]"):format(model.states[i]) } end
  for k, output in ipairs(model.outputs) do
    local e = scenarios.named(data, { output.expression })[1]
    list[k] = { name = output.name, unit = output.unit, text = tostring(e), lua = lua_of(e, names) }
  end
  return list
end

-- { states, equations as text, lua = a program that returns the ambit.ode for values of the data, outputs }
local function model_of(model, data, name)
  local rates, states, equations = scenarios.named(data, model.rates), {}, {}
  local texts = texts_of(rates)
  for i, state in ipairs(model.states) do
    states[i] = { name = state, unit = model.units[i] }
    equations[i] = { state = state, text = texts[i] }
  end
  local program = source_lua.write { name = name, states = model.states, units = model.units, symbols = model.symbols,
    rates = rates, parameters = {} }
  return { states = states, equations = equations, lua = program, outputs = outputs_of_model(model, data) }
end

-- -- scenarios

-- { name = expression } -> { name = Lua text }
local function named(data, expressions)
  local list, names = {}, data_names(data)
  for _, name in ipairs(check.sorted(expressions)) do
    local e = scenarios.named(data, { expressions[name] })[1]
    list[name] = lua_of(e, names) or tostring(e)
  end
  return object(list)
end

local function ranges_of(data)
  local list = {}
  for k, datum in ipairs(data) do list[k] = { name = datum.name, lo = number(datum.lo), hi = number(datum.hi) } end
  return list
end

-- Symbols by name: themselves where a scenario gives them just a datum of their name.
local function given_of(self, given)
  local data, values = scenarios.data(self, given), {}
  for k, leaf in ipairs(given.leaves) do values[tostring(leaf)] = given.values[k] end
  return { times = plain(given.times.said or given.times), data = ranges_of(data), initial = named(data, given.initial),
    given = named(data, values) }
end

local function scenarios_of(self)
  local list = {}
  for k, s in ipairs(self.scenarios) do
    list[k] = plain(s)
    for key, value in pairs(given_of(self, self.given[k])) do list[k][key] = value end
  end
  return list
end

-- -- the whole

local function outputs_of(self)
  local list = {}
  for k, name in ipairs(self.outputs) do
    list[k] = { name = name, bound = self.bounds[k] and number(self.bounds[k]),
      error = self.error[name] and number(self.error[name]) }
  end
  return list
end

-- What a proof depends on.
local function settings_of(settings)
  local list = {}
  for _, key in ipairs { "solver", "arithmetic", "arithmetic_options", "options", "nodes", "reductions", "levels",
    "budget" } do
    list[key] = plain(settings[key])
  end
  list.threads = settings.run_options and plain(settings.run_options.threads)
  return object(list)
end

local facts = { "status", "reason", "criterion", "ranking", "strategy", "cluster", "give_up", "terms", "log", "history",
  "rankings", "proofs", "cpu_seconds", "cpu_seconds_rank", "cpu_seconds_detailed", "terms_before", "terms_after",
  "equations_before", "equations_after", "operations_before", "operations_after" }

-- The text of a result.
function json.text(self)
  local data = scenarios.data(self)
  local whole = { ambit = core.version, outputs = outputs_of(self),
    detailed = model_of(self.detailed, data, "detailed"), reduced = model_of(self.model, data, "reduced"),
    data = ranges_of(data), scenarios = scenarios_of(self), settings = settings_of(self.settings) }
  for _, key in ipairs(facts) do whole[key] = plain(self[key]) end
  return provenance.json(encoder.encode(whole)) .. "\n"
end

-- The result in memory is not touched: what could not be written can be written elsewhere.
function json.save(name, content, what)
  check.text(name, what .. ": file")
  local problem = core.write_file(name, content)
  if problem then check.fail("%s: cannot write the file: %s", what, problem) end
end

-- Complains about a file that cannot be written before anything is computed for it; leaves it as it was.
function json.writable(name, what)
  check.text(name, what .. ": file")
  local there = io.open(name)
  if there then there:close() end
  local file, problem = io.open(name, "a")
  if not file then check.fail("%s: cannot write the file: %s", what, problem) end
  file:close()
  if not there then os.remove(name) end
end

-- The text; into a file as well, if one is named.
function json.write(self, name, what)
  local content = json.text(self)
  if name ~= nil then json.save(name, content, what) end
  return content
end

return json
