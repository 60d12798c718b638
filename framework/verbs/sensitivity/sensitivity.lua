-- sensitivity.lua -- ambit.sensitivity { ode or m:dynamics(), initial = ..., t = ..., wrt = { "beta1", k = k } }: how
-- the states depend on their initial values and on uncertain data, enclosed for every point of the initial set at once.
-- The variational equations are joined to the system, and any solver runs on them; docs/numerics/sensitivity.md.
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.run.instant"
local ode = require "ambit.ode"
local session = require "ambit.session"
local simulate = require "ambit.simulate"
local uncertain = require "ambit.run.uncertain"

local verb = {}

-- A list of { name, state = number or 0, datum = expression } that grows without doubles.
local function collector()
  local list, known = {}, {}
  return list, function(name, state, datum)
    if known[name] then check.fail("sensitivity: wrt: `%s` is given twice", name) end
    known[name] = true
    list[#list + 1] = { name = name, state = state, datum = datum }
  end
end

-- What the equations are made of: in implicit form where they have one, which is far shorter than formulas for
-- accelerations.
local function equations(system)
  local form = not rawget(system, "rates") and core.system_implicit(system.system)
  if not form then return system.rates end
  return table.move(form.residuals, 1, #form.residuals, #form.rates + 1, form.rates)
end

-- Every initial value, and every uncertain datum of the equations. A datum that a parameter is made of by a factor is
-- called as the parameter: then the derivative is by the parameter's value.
local function everything(system, add)
  for i, name in ipairs(system.states) do add(name, i, core.expression(0)) end
  for _, leaf in ipairs(uncertain.leaves(equations(system))) do
    local parameter = system.parameters[leaf.name]
    local own = parameter and uncertain.leaves { parameter } or {}
    add(leaf.name, 0, #own == 1 and own[1].expression == leaf.expression and parameter or leaf.expression)
  end
end

local function by_name(system, name, add)
  for i, state in ipairs(system.states) do
    if state == name then return add(name, i, core.expression(0)) end
  end
  if system.parameters[name] then return add(name, 0, system.parameters[name]) end
  local known = check.sorted(system.parameters)
  table.move(system.states, 1, #system.states, #known + 1, known)
  for _, leaf in ipairs(uncertain.leaves(equations(system))) do
    if leaf.name == name then return add(name, 0, leaf.expression) end
    known[#known + 1] = leaf.name
  end
  check.fail("sensitivity: wrt: there is no state, parameter or datum `%s`%s", tostring(name),
    check.suggest(name, known))
end

-- What an expression in the list is called: as its datum, or by its place.
local function name_of(i, expression)
  local data = uncertain.leaves { expression }
  return #data == 1 and data[1].name or ("wrt[%d]"):format(i)
end

-- wrt = { "x", "k", a = datum, datum, ... }
local function quantities(t, system)
  local list, add = collector()
  if t == nil then
    everything(system, add)
    return list
  end
  check.table(t, "sensitivity: wrt")
  for i, value in ipairs(t) do
    if type(value) == "string" then
      by_name(system, value, add)
    else
      local e = core.expression(value, nil, ("sensitivity: wrt[%d]"):format(i))
      add(name_of(i, e), 0, e)
    end
  end
  for _, key in ipairs(check.sorted(t)) do
    if type(key) == "string" then
      add(key, 0, core.expression(t[key], nil, "sensitivity: wrt." .. key))
    elseif math.type(key) ~= "integer" or key < 1 or key > #t then
      check.fail("sensitivity: wrt: unexpected entry [%s]", tostring(key))
    end
  end
  if #list == 0 then check.fail "sensitivity: wrt: expected a state, a parameter or an uncertain datum" end
  return list
end

-- -- the result

local Sensitivity = { __name = "sensitivity" }
local methods = {}

local function place_of(self, state, by)
  local i, j
  for k, name in ipairs(self.of) do
    if name == state then i = k end
  end
  if not i then check.fail("d: there is no state `%s`%s", tostring(state), check.suggest(state, self.of)) end
  for k, name in ipairs(self.wrt) do
    if name == by or self.quantities[k].state == 0 and self.quantities[k].datum == by then j = k end
  end
  if not j then check.fail("d: nothing was differentiated by `%s`%s", tostring(by), check.suggest(by, self.wrt)) end
  return self.place[(i - 1) * #self.wrt + j]
end

-- The derivative among the values of all states.
local function entry(self, values, state, by)
  local place = place_of(self, state, by)
  return place == 0 and core.interval(0) or values[self.run.states[place]]
end

-- d x_state / d by at the end, for every point of the initial set and all values of the data.
function methods:d(state, by) return entry(self, self.run.x, state, by) end

-- The same at a time within the run.
function methods:d_at(t, state, by) return entry(self, self.run:at(t), state, by) end

-- The unit of that derivative.
function methods:unit(state, by)
  local place = place_of(self, state, by)
  return place == 0 and "1" or self.units[place]
end

function methods:at(t) return self.run:at(t) end

-- for step in result:steps() do print(step.t, step.d("x", "k")) end
function methods:steps()
  local next_step = self.run:steps()
  return function()
    local step = next_step()
    if step then rawset(step, "d", function(state, by) return entry(self, step.x, state, by) end) end
    return step
  end
end

check.methods(methods, Sensitivity)

function Sensitivity.__index(self, key)
  if methods[key] then return methods[key] end
  return rawget(self, "run")[key]
end

function Sensitivity.__tostring(self)
  local lines = { tostring(self.run) }
  for _, state in ipairs(self.of) do
    for _, by in ipairs(self.wrt) do
      if place_of(self, state, by) ~= 0 then
        lines[#lines + 1] = ("  d %s/d %s = %s"):format(state, by, tostring(self:d(state, by)))
      end
    end
  end
  return table.concat(lines, "\n")
end

-- Derivatives are enclosed for all data or not at all.
local function refuse_partial(t)
  if type(t) == "table" and t.partial ~= nil then
    check.fail "sensitivity: partial: there is nothing to allow: derivatives hold for all data, or the run is unable"
  end
end

function verb.sensitivity(t)
  refuse_partial(t)
  local keys = table.move(simulate.run_keys, 1, #simulate.run_keys, 2, { "wrt" })
  local q = simulate.request(t, "sensitivity", nil, keys)
  q.run_options = simulate.run_options(t, q)
  local list, names, states, data = quantities(t.wrt, q.system), {}, {}, {}
  for j, by in ipairs(list) do names[j], states[j], data[j] = by.name, by.state, by.datum end
  local system, initial, place = core.variation(q.system.system, q.initial, names, states, data)
  local of = q.system.states
  q.system = ode.of_system(system, q.system.name, q.system.mechanism)
  q.initial = initial
  local run = simulate.solve(q)
  session.finish("sensitivity", run, run.report,
    { "solver", q.solver, "arithmetic", run.arithmetic, "options", q.settings, "t_start", instant.first(q.times),
      "t_end", instant.final(q.times) })
  return setmetatable({ run = run, of = of, wrt = names, quantities = list, place = place, units = q.system.units },
    Sensitivity)
end

return verb
