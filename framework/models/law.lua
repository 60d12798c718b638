-- law.lua -- a function as the value of a parameter: a law, called once with expressions and recorded, so that it is
-- differentiable and rigorous like any formula.
--
-- What it is called with follows from what the element is connected to, and ends with time:
--   joint        coordinate, rate (lists, where the joint has several)
--   from and to  length of the line between the points, its rate
--   at           of a force: position and velocity of the point; of a torque: angular velocity. World axes; with
--                axes = "body" velocities in those of the frame
-- Their units are soft: -x may stand for -1 N/m * x.
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local frame = require "ambit.frame"
local measure = require "ambit.measure"
local rotation = require "ambit.rotation"
local Vector = require "ambit.vector"

local law = {}

local function offset_of(values, name)
  local list = values[name]
  return list and Vector.new(list[1], list[2], list[3])
end

local function connected(d, t, name, kind)
  for _, port in ipairs(d.ports) do
    if port.role == "in" and port.name == name and port.kind == kind then return t[name] ~= nil end
  end
  return false
end

local function of_joint(self, port, value, what, arguments)
  local part, number = frame.place(self, value, "joint", what)
  local q = core.pull(self.handle, part, number, core.COORDINATE, port.coordinates)
  local u = core.pull(self.handle, part, number, core.RATE, port.dof)
  local unit = core.coordinate_unit(self.handle, q[1]) -- nil: a given motion
  if unit and port.coordinates == 1 and port.dof == 1 then
    q[1], u[1] = core.in_unit(q[1], unit, true), core.in_unit(u[1], unit .. "/s", true)
  end
  arguments[#arguments + 1] = port.coordinates == 1 and q[1] or q
  arguments[#arguments + 1] = port.dof == 1 and u[1] or u
end

local function of_line(self, t, values, what, arguments)
  local first, first_rate = measure.point(self, t.from, offset_of(values, "from_offset"), what)
  local second, second_rate = measure.point(self, t.to, offset_of(values, "to_offset"), what)
  local d = second - first
  local length = core.in_unit(core.sqrt(rotation.dot(d, d)), "m", true)
  arguments[#arguments + 1] = length
  arguments[#arguments + 1] = core.in_unit(rotation.dot(d, second_rate - first_rate) / length, "m/s", true)
end

local function of_frame(self, t, values, param, what, arguments)
  local is_force = param.unit == "N"
  local position, velocity = measure.point(self, t.at, offset_of(values, "offset"), what)
  local angular_velocity, _, axes = measure.twist(self, t.at, what)
  local rate = is_force and velocity or angular_velocity
  if is_force then arguments[#arguments + 1] = Vector.in_unit(position, "m", true) end
  if t.axes == "body" then rate = rotation.turned_back(axes, rate) end
  arguments[#arguments + 1] = Vector.in_unit(rate, is_force and "m/s" or "rad/s", true)
end

-- What `value`, given for `param` of the element declared by d, returns; t: the user's table, values: the parameters
-- that are not functions, by name.
function law.record(self, d, t, values, param, value)
  local arguments, what = {}, param.what
  if param.shape ~= "" and not param.shape:find "^%d" then check.fail("%s: cannot be a function", what) end
  for _, port in ipairs(d.ports) do
    if connected(d, t, port.name, "joint") then of_joint(self, port, t[port.name], what, arguments) end
  end
  if connected(d, t, "from", "frame") and connected(d, t, "to", "frame") then
    of_line(self, t, values, what, arguments)
  elseif connected(d, t, "at", "frame") and param.shape == "3" and (param.unit == "N" or param.unit == "N m") then
    of_frame(self, t, values, param, what, arguments)
  end
  arguments[#arguments + 1] = core.time()
  local who = t.name and ("%s `%s`"):format(d.name, t.name) or d.name -- whose kinks these are
  local results = table.pack(core.written_by(self.handle, who, formula.call, value, what, table.unpack(arguments)))
  if results[1] == nil then check.fail("%s: the function returned nothing", what) end
  if results.n > 1 then
    check.fail("%s: the function returned %d values: expected one, or a list of them in a table", what, results.n)
  end
  return results[1]
end

return law
