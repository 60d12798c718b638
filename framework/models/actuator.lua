-- actuator.lua -- what the shipped drives (chain/dc_motor.lua, chain/pid.lua, chain/hydraulic_cylinder.lua) share: the
-- motion of the joint that they act on, and commands that are numbers, expressions or functions.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local frame = require "ambit.frame"

local actuator = {}

-- Coordinate and speed of a joint of one degree of freedom, with their units; "rad" or "m".
function actuator.motion(m, joint, what)
  local part, port = frame.place(m, joint, "joint", what)
  for _, out in ipairs(m.declared[part].outs) do
    if out.index == port and (out.coordinates ~= 1 or out.dof ~= 1) then
      check.fail("%s: expected a joint of one degree of freedom, got %d", what, out.dof)
    end
  end
  local q, v = core.pull(m.handle, part, port, core.COORDINATE, 1)[1], core.pull(m.handle, part, port, core.RATE, 1)[1]
  local unit = core.coordinate_unit(m.handle, q)
  if not unit then
    check.fail("%s: the motion of `%s` is given: no drive can move it", what, core.part_name(m.handle, part))
  end
  return core.in_unit(q, unit), core.in_unit(v, unit .. "/s"), unit
end

-- A number, an expression or what a function(...) returns, in that unit.
function actuator.command(given, unit, what, ...)
  if type(given) == "function" then
    given = formula.call(given, what, ...)
    if given == nil then check.fail("%s: the function returned nothing", what) end
  end
  local e = core.expression(given, unit, what)
  core.refuse_plain({ e }, what, true)
  return core.in_unit(e, unit)
end

return actuator
