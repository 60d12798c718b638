-- reduce/certify/bound.lua -- error = { x = 10, y = "0.6" }: what an output may be off by.
local check = require "ambit.check"
local core = require "ambit.core"

local bound = {}

-- A number, or text with a unit; rounded towards zero, so that nothing is accepted that the text does not allow.
local function value_of(value, unit, what)
  if type(value) == "number" then
    core.check_number(value, what)
    if value ~= value or value == math.huge then
      check.fail("%s: expected a finite number, got %s", what, tostring(value))
    end
    return value
  end
  local e = core.expression(value, unit, what)
  if not core.is_constant(e) then check.fail("%s: a bound cannot be uncertain", what) end
  return core.interval(e).lo
end

-- outputs: of a MODEL -> { name, ... } in their order, { [name] = number > 0 }; optional: some may have no bound
function bound.read(t, outputs, what, optional)
  what = what .. ": error"
  local names, bounds = {}, {}
  for i, output in ipairs(outputs) do names[i] = output.name end
  if t == nil and optional then return names, bounds end
  if t == nil then check.fail("%s is missing: { %s = what it may be off by }", what, names[1]) end
  check.keys(check.table(t, what), names, what)
  for i, name in ipairs(names) do
    if t[name] ~= nil then
      local unit = outputs[i].unit ~= "1" and outputs[i].unit or nil -- "1": not known
      bounds[name] = value_of(t[name], unit, ("%s: %s"):format(what, name))
      if not (bounds[name] > 0) then
        check.fail("%s: %s: expected a bound greater than 0, got %s", what, name, tostring(t[name]))
      end
    elseif not optional then
      check.fail("%s: the bound of `%s` is missing", what, name)
    end
  end
  return names, bounds
end

return bound
