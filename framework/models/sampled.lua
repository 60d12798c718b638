-- sampled.lua -- ambit.sampled { period = "1 ms", outputs = { "u" }, memory = { sum = 0 }, law = function(s, m, t) ...
-- end }: a controller that looks at its plant at the instants of a clock and holds what it finds until the next one.
--
-- What it holds, what it remembers and what is on the way to its outputs are states of the plant with rate 0. At each
-- sample the states jump (ambit_jump in graph/system.h): the solver applies the law to its set, so that everything
-- keeps what it has in common.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local ode = require "ambit.ode"

local Sampled = { __name = "sampled" }
Sampled.__index = Sampled

local sampled = {}

local MOST_DELAY = 100

function sampled.is(value) return getmetatable(value) == Sampled end

function Sampled.__tostring(self)
  local period = tostring(core.interval(self.period))
  return ('sampled "%s": %s every %s s'):format(self.name, table.concat(self.outputs, ", "), period)
end

-- -- what is said

local function read_time(value, what, default)
  if value == nil then value = default end
  if value == nil then check.fail("%s is missing: a time, such as \"1 ms\"", what) end
  local e = core.expression(value, "s", what)
  if not core.is_constant(e) then check.fail("%s: expected a known time, got %s", what, check.shown(value)) end
  return e, core.interval(e)
end

-- { "u" } or { u = "N m" } or { { "u", "N m" } } -> names, units by name
local function read_outputs(list)
  if list == nil then check.fail "sampled: outputs are missing: the names of what is held" end
  check.table(list, "sampled: outputs")
  local names, units = {}, {}
  local function add(name, unit)
    names[#names + 1] = check.text(name, "sampled: name of an output")
    units[name] = unit and check.text(unit, "sampled: unit of " .. name) or "1"
  end
  for _, entry in ipairs(list) do
    if type(entry) == "table" then add(entry[1], entry[2]) else add(entry) end
  end
  for _, key in ipairs(check.sorted(list)) do
    if type(key) == "string" then add(key, list[key]) end
  end
  if #names == 0 then check.fail "sampled: outputs: expected at least one name" end
  return names, units
end

-- { sum = 0 } -> names, { [name] = initial value }
local function read_memory(list)
  local names, values = {}, {}
  for _, name in ipairs(check.sorted(check.table(list or {}, "sampled: memory"))) do
    names[#names + 1] = check.text(name, "sampled: name in memory")
    values[name] = core.expression(list[name], nil, "sampled: memory " .. name)
  end
  return names, values
end

-- "0.1 deg" for all, or { x = "0.1 deg" } by name -> that, checked
local function read_quantum(given)
  if given == nil or type(given) ~= "table" then return given end
  for _, name in ipairs(check.sorted(given)) do check.text(name, "sampled: quantum: name of a state") end
  return given
end

local function read_delay(value)
  if value == nil then return 0 end
  local n = math.tointeger(value)
  if type(value) ~= "number" or not n or n < 0 or n > MOST_DELAY then
    check.fail("sampled: delay: expected a number of samples, 0 to %d, got %s", MOST_DELAY, check.shown(value))
  end
  return n
end

local keys = { "name", "period", "start", "outputs", "memory", "delay", "quantum", "law" }

function sampled.new(t)
  check.table(t, "sampled")
  check.keys(t, keys, "sampled", 1)
  if type(t.law) ~= "function" then
    check.fail("sampled: law: expected a function(s, m, t) that returns the outputs and the new memory, got %s",
      check.kind(t.law))
  end
  local self = { name = t.name or t[1] or "sampled", law = t.law, delay = read_delay(t.delay),
    quantum = read_quantum(t.quantum) }
  check.text(self.name, "sampled: name")
  local period, start
  self.period, period = read_time(t.period, "sampled: period")
  self.start, start = read_time(t.start, "sampled: start", 0)
  if not (period.lo > 0) then check.fail("sampled: period: expected more than 0 s, got %s", tostring(t.period)) end
  if not (start.lo >= 0) then check.fail("sampled: start: expected 0 s or more, got %s", tostring(t.start)) end
  self.outputs, self.units = read_outputs(t.outputs)
  self.memory, self.initial = read_memory(t.memory)
  return setmetatable(self, Sampled)
end

-- One of them or a list.
function sampled.list(value, what)
  if value == nil then return {} end
  local list = sampled.is(value) and { value } or value
  check.table(list, what)
  for _, one in ipairs(list) do
    if not sampled.is(one) then check.fail("%s: expected ambit.sampled { ... }, got %s", what, check.kind(one)) end
  end
  return list
end

-- What is on the way to an output: results of the last `delay` samples, the oldest first.
local function waiting(self, output)
  local names = {}
  for k = 1, self.delay do names[k] = ("%s.%d"):format(output, k) end
  return names
end

-- All states that it adds to its plant: { { name, unit, initial value }, ... }
function sampled.states(self)
  local list = {}
  local function add(name, unit, value, like)
    list[#list + 1] = { name = name, unit = unit, initial = value, like = like }
  end
  for _, name in ipairs(self.outputs) do
    add(name, self.units[name], core.expression(0))
    for _, other in ipairs(waiting(self, name)) do add(other, self.units[name], core.expression(0), name) end
  end
  for _, name in ipairs(self.memory) do add(name, "1", self.initial[name]) end
  return list
end

-- -- the law

local function quantum_of(self, name)
  local q = self.quantum
  if type(q) == "table" then return q[name] end
  return q
end

-- The states as the controller sees them: rounded to multiples of the quantum, that is, off by at most half of it.
local function measured(self, system, s)
  local seen, own, noises = {}, {}, {}
  for _, state in ipairs(sampled.states(self)) do own[state.name] = true end
  if type(self.quantum) == "table" then
    check.keys(self.quantum, system.states, ("sampled `%s`: quantum"):format(self.name))
  end
  for i, name in ipairs(system.states) do
    local step = not own[name] and quantum_of(self, name)
    seen[name] = s[name]
    if step then
      local e = core.expression(step, ode.unit(system, i), ("sampled `%s`: quantum of %s"):format(self.name, name))
      local size = core.interval(e)
      if not (size.lo > 0) then
        check.fail("sampled `%s`: quantum of %s: expected more than 0, got %s", self.name, name, tostring(step))
      end
      noises[name] = core.varying(-size.hi / 2, size.hi / 2, ("rounding of %s"):format(name))
      seen[name] = s[name] + core.in_unit(noises[name], ode.unit(system, i), true)
    end
  end
  return seen
end

local function strict(values, what)
  return setmetatable({}, {
    __index = function(_, key)
      if values[key] == nil then
        check.fail('%s: there is no `%s`%s', what, tostring(key), check.suggest(key, check.sorted(values)))
      end
      return values[key]
    end,
    __newindex = function(_, key) check.fail("%s: `%s` cannot be assigned", what, tostring(key)) end,
    __pairs = function() return next, values end,
  })
end

-- What the law returned for these names, by name: a table by name or place, or for one name the value itself.
local function read_results(result, names, units, what)
  if #names == 1 and (type(result) ~= "table" or getmetatable(result)) then result = { [names[1]] = result } end
  check.table(result, what)
  local by_place = #result == #names
  if not by_place then check.keys(result, names, what) end
  local values = {}
  for i, name in ipairs(names) do
    local value = result[name]
    if by_place then value = result[i] end
    if value == nil then check.fail("%s: `%s` is missing", what, name) end
    values[name] = core.expression(value, units and units[name] ~= "1" and units[name] or nil,
      ("%s: %s"):format(what, name))
    core.refuse_plain({ values[name] }, ("%s: %s"):format(what, name), true)
    core.name_data({ values[name] }, ("%s of the law"):format(name))
  end
  return values
end

local function call_law(self, system)
  local s = ode.arguments(system, true)
  local seen, memory, what = measured(self, system, s), {}, ("sampled `%s`: law"):format(self.name)
  for _, name in ipairs(self.memory) do memory[name] = seen[name] end
  local results, remembered = formula.call(self.law, what, strict(seen, what .. ": states"),
    strict(memory, what .. ": memory"), core.time())
  if results == nil then check.fail("%s: the function returned nothing", what) end
  if #self.memory > 0 and remembered == nil then
    check.fail("%s: the function returned no memory: a second table with %s", what, table.concat(self.memory, ", "))
  end
  return read_results(results, self.outputs, self.units, what),
    read_results(remembered or {}, self.memory, nil, what .. ": memory")
end

-- What each state of the system becomes at a sample.
local function jump(self, system)
  local to, at = {}, {}
  for i, name in ipairs(system.states) do to[i], at[name] = system.symbols[i], i end
  local results, remembered = call_law(self, system)
  for _, name in ipairs(self.outputs) do
    local line = waiting(self, name)
    table.insert(line, 1, name)
    for k, one in ipairs(line) do
      to[at[one]] = line[k + 1] and system.symbols[at[line[k + 1]]] or results[name]
    end
  end
  for _, name in ipairs(self.memory) do to[at[name]] = remembered[name] end
  return to
end

-- Lets the states of a system, which has those of the controllers already, jump.
function sampled.attach(system, list)
  if #list == 0 then return end
  system.sampled, system.defaults = list, {}
  for _, self in ipairs(list) do
    for _, state in ipairs(sampled.states(self)) do system.defaults[state.name] = state end
  end
  for _, self in ipairs(list) do core.system_jump(system.system, self.period, self.start, jump(self, system)) end
end

-- Lets all states of a system that rests step by `law`, function(s, p, t), at 0, 1, 2, ...
function sampled.step(system, law)
  local units = {}
  for i, name in ipairs(system.states) do units[name] = ode.unit(system, i) or "1" end
  local to, what = {}, ("map `%s`: next"):format(system.name)
  local values = read_results(formula.call(law, what, ode.arguments(system)), system.states, units, what)
  for i, name in ipairs(system.states) do to[i] = values[name] end
  system.sampled, system.defaults, system.declaration = {}, {}, false
  for _, name in ipairs(system.states) do system.defaults[name] = {} end
  core.system_jump(system.system, core.expression(1), core.expression(0), to)
end

-- All formulas of the laws, for who looks for data in them.
function sampled.formulas(system)
  local all = {}
  for _, one in ipairs(system.sampled and core.system_jumps(system.system) or {}) do
    table.move(one[3], 1, #one[3], #all + 1, all)
  end
  return all
end

-- The verb cannot follow it.
function sampled.refuse(system, what)
  if not system.sampled then return end
  check.fail("%s: `%s` is sampled, and %s takes systems that move steadily: ambit.simulate, verify and sample take \z
    sampled ones", what, system.name, what)
end

local methods = {}

-- m:sampled(controller) -> { output = expression }, to be used in laws of m
function methods:sampled(controller)
  if not sampled.is(controller) then
    check.fail("m:sampled: expected ambit.sampled { ... }, got %s", check.kind(controller))
  end
  local controllers = rawget(self, "controllers") or {}
  self.controllers = controllers
  local values = {}
  for _, state in ipairs(sampled.states(controller)) do
    local unit = state.unit ~= "1" and state.unit or nil
    values[state.name] = self:state { state.name, unit = unit, rate = core.expression(0) }
  end
  table.insert(controllers, controller)
  local outputs = {}
  for _, name in ipairs(controller.outputs) do outputs[name] = values[name] end
  return outputs
end

sampled.methods = methods
return sampled
