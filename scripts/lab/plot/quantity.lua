-- plot/quantity.lua -- what is drawn: states by name, formulas of states, data and time, or functions (s, p, t) that
-- return one; a table of these stands for its entries.
local check = require "ambit.check"
local core = require "ambit.core"
local event = require "ambit.event"
local formula = require "ambit.formula"
local ode = require "ambit.ode"

local quantity = {}

local MOST = 12 -- states that are drawn where the scene chooses none: as many panels as one page can hold
local axes = { "x", "y", "z" }

local function state_named(system, name)
  for i, state in ipairs(system.states) do
    if state == name then return { name = name, unit = ode.unit(system, i) or "", g = system.symbols[i], state = i } end
  end
end

local function unit_of(g)
  local good, unit = pcall(core.unit_of, g)
  return good and unit or ""
end

-- What a run says nothing about, such as the speeds that a loop implies, has no bounds to enclose the formula over.
local function check_known(g, system, what)
  local known = {}
  for _, state in ipairs(system.states) do known[state] = true end
  for _, leaf in ipairs(core.leaves { g }) do
    if leaf.kind == "symbol" and not known[leaf.name] then
      check.fail("%s: the run says nothing about `%s`: its states are %s; m:of_states writes speeds and accelerations "
        .. "of a mechanism as formulas of these", what, leaf.name, table.concat(system.states, ", "))
    end
  end
end

-- Appends { name, unit, g } for the value, or for each of its entries.
local function add(list, system, name, value, what)
  if type(value) == "function" then value = formula.call(value, what, ode.arguments(system)) end
  local kind = check.kind(value)
  if kind == "string" and state_named(system, value) then
    local state = state_named(system, value)
    state.name = name or value
    list[#list + 1] = state
  elseif kind == "string" and not name then
    check.fail("%s: there is no state `%s`%s", what, value, check.suggest(value, system.states))
  elseif type(value) == "table" and (kind == "table" or getmetatable(value).is_shape) then
    local is_point = #value == 3
    for _, key in ipairs(check.sorted(value)) do
      local part = is_point and axes[key] or tostring(key)
      add(list, system, ("%s.%s"):format(name or "quantity", part), value[key], ("%s.%s"):format(what, part))
    end
  else
    local g = event.formula(value, system, what)
    check_known(g, system, what)
    list[#list + 1] = { name = name or ("quantity %d"):format(#list + 1), unit = unit_of(value), g = g }
  end
end

-- `quantities` of a run -> { { name, unit, g }, ... }: g on the run's clock. nil: its first states.
function quantity.list(t, run)
  local list, system = {}, run.system
  if t == nil then
    for i = 1, math.min(MOST, #run.states) do list[i] = state_named(system, run.states[i]) end
    return list
  end
  check.table(t, "plot: quantities")
  for _, key in ipairs(check.sorted(t)) do
    local name = type(key) == "string" and key or nil
    add(list, system, name, t[key], ("plot: quantities%s"):format(name and "." .. name or ("[%s]"):format(key)))
  end
  if #list == 0 then check.fail "plot: quantities: expected names of states or formulas, got an empty table" end
  local known = {}
  for _, q in ipairs(list) do
    if known[q.name] then check.fail("plot: quantities: there are two of the name `%s`", q.name) end
    known[q.name] = true
  end
  return list
end

-- The place of a name in the list.
function quantity.find(list, name, what)
  local names = {}
  for k, q in ipairs(list) do
    if q.name == name then return k end
    names[k] = q.name
  end
  check.fail("%s: there is no quantity `%s`%s", what, tostring(name), check.suggest(name, names))
end

return quantity
