-- reduce/mechanism_model.lua -- the MODEL (certify/model.lua) of a mechanism that was built anew without some elements:
-- its equations of motion, and the outputs of the mechanism as it was, written for the new one.
--
-- An output is a name, an expression, or a function(s, p, t, m): m is the mechanism at hand, whose frames may be said
-- as those of the original. What an output says of a joint that is locked has the joint's motion in its place.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local ode = require "ambit.ode"
local certify = require "ambit.reduce.certify.model"

local model = {}

-- { [name of a variable of a locked joint] = its motion }; "x'" is the rate of x where no variable has this name.
local function still_by_name(copy)
  local named, names = {}, {}
  for i, leaf in ipairs(copy.leaves) do
    names[i] = core.leaves({ leaf })[1].name
    named[names[i]] = copy.motions[i]
  end
  for i, name in ipairs(names) do
    local rate = name .. "'"
    named[rate] = named[rate] or core.derivative(copy.motions[i], core.time())
  end
  return named
end

-- The states that a function may ask for: those of the mechanism as it was.
local function states_of(s, still, states)
  local all = {}
  for _, name in ipairs(states) do all[name] = still[name] or s[name] end
  return setmetatable(all, { __index = s }) -- which says what there is
end

-- A written output with the motions of locked joints in it, as a function that certify/model.lua calls.
local function written(value, copy, still, states, what)
  return function(s, p, t)
    local result = value
    if type(value) == "function" then
      result = formula.call(value, what, states_of(s, still, states), p, t, copy.mechanism)
    end
    local e = core.expression(result, nil, what)
    if #copy.leaves == 0 then return e end
    return core.in_unit(core.substitute({ e }, copy.leaves, copy.motions)[1], (core.unit_of(e, true)))
  end
end

-- outputs = { "x", y = ... } for the copy: a listed name whose state is locked becomes a written one.
local function outputs_of(outputs, copy, states, what)
  local still, list = still_by_name(copy), {}
  for _, key in ipairs(check.sorted(outputs)) do
    local value = outputs[key]
    if type(key) == "string" then
      list[key] = written(value, copy, still, states, ("%s: outputs: `%s`"):format(what, key))
    elseif still[value] then
      list[value] = still[value]
    else
      list[#list + 1] = value
    end
  end
  return list
end

-- In the order of the detailed model's outputs, with their units.
local function in_order(found, wanted)
  local by_name, list = {}, {}
  for _, output in ipairs(found) do by_name[output.name] = output.expression end
  for i, output in ipairs(wanted) do
    list[i] = { name = output.name, unit = output.unit, expression = by_name[output.name] }
  end
  return list
end

-- copy: { mechanism, system = of core.dynamics, leaves, motions }; detailed: MODEL of the original; outputs: as the
-- user gave them.
function model.of(copy, detailed, outputs, what)
  local system = ode.of_system(copy.system, detailed.name, copy.mechanism)
  local m = certify.of(system, outputs_of(outputs, copy, detailed.states, what), what, detailed.varied)
  m.outputs = in_order(m.outputs, detailed.outputs)
  return m
end

return model
