-- join.lua -- ambit.join { "name", m1, m2, ode, ... }: several mechanisms and systems as one, whose laws may depend on
-- each other's variables. The states are those of all, in this order.
local check = require "ambit.check"
local core = require "ambit.core"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"

local join = {}

local function system_of(value, i)
  if mechanism.is(value) then value = value:dynamics() end
  if not ode.is(value) then
    check.fail("join: entry %d: expected a mechanism or an ambit.ode, got %s", i, check.kind(value))
  end
  require "ambit.sampled".refuse(value, "join")
  local invariants = core.system_invariants(value.system)
  if #invariants > 0 then
    check.fail("join: `%s` has closed loops or quaternions, whose equations would be lost: build both in one mechanism",
      value.name)
  end
  return value
end

-- Its parameters, under their names where these are free.
local function add_parameters(all, system)
  for _, name in ipairs(check.sorted(system.parameters)) do
    if all[name] and all[name] ~= system.parameters[name] then
      check.fail("join: two systems have a parameter `%s`: call one of them otherwise", name)
    end
    all[name] = system.parameters[name]
  end
end

function join.join(t)
  check.table(t, "join")
  local list, name = {}, "joined"
  for i, value in ipairs(t) do
    if i == 1 and type(value) == "string" then name = value else list[#list + 1] = system_of(value, i) end
  end
  check.keys(t, {}, "join", #t)
  if #list < 2 then check.fail("join: expected at least two mechanisms or systems, got %d", #list) end
  local names, units, symbols, rates, parameters, owner = {}, {}, {}, {}, {}, {}
  for _, system in ipairs(list) do
    for i, state in ipairs(system.states) do
      if owner[state] then
        check.fail("join: `%s` and `%s` both have a state `%s`: call one of them otherwise", owner[state], system.name,
          state)
      end
      owner[state] = system.name
      names[#names + 1], units[#units + 1], symbols[#symbols + 1] = state, system.units[i], system.symbols[i]
      rates[#rates + 1] = system.rates[i]
    end
    add_parameters(parameters, system)
  end
  return ode.of_system(core.system(names, units, symbols, rates), name, nil, parameters)
end

return join
