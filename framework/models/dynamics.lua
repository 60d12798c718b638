-- dynamics.lua -- the equations of motion of a mechanism, M u' + bias = tau, and its energy.
--
-- Lists are in the order of m:speed_names(). Everything is pulled on demand, and ambit.evaluate takes it as it is.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local Matrix = require "ambit.matrix"
local ode = require "ambit.ode"

local methods = {}

local function shaped(list) return setmetatable(list, Matrix) end

local function rows_of(list, n, count)
  local rows = {}
  for i = 1, count do rows[i] = shaped(table.move(list, (i - 1) * n + 1, i * n, 1, {})) end
  return shaped(rows)
end

local forms = { "auto", "mass_matrix", "articulated" }

-- nil, "articulated" or { form = "articulated" }
local function form_of(t, what)
  if type(t) == "table" then
    check.keys(t, { "form" }, what, 0)
    t = t.form
  end
  if t == nil then return "auto" end
  for _, form in ipairs(forms) do
    if t == form then return form end
  end
  check.fail("%s: there is no form `%s`%s", what, tostring(t), check.suggest(t, forms))
end

-- Energy of the whole mechanism, J.
function methods:energy()
  local e = core.pull(self.handle, -1, 0, core.ENERGY, 2)
  local kinetic, potential = core.in_unit(e[1], "J"), core.in_unit(e[2], "J")
  return shaped { kinetic = kinetic, potential = potential, total = kinetic + potential }
end

-- What drives, dampers and applied forces put in beyond that, W: the total energy changes by it.
function methods:power() return core.in_unit(core.pull(self.handle, -1, 0, core.POWER, 1)[1], "W") end

local function names_of(list)
  local names = {}
  for i, entry in ipairs(list) do names[i] = entry.name end
  return names
end

function methods:coordinate_names() return names_of(core.coordinates(self.handle)) end
function methods:speed_names() return names_of(core.speeds(self.handle)) end

-- The joint coordinates and the states as expressions, by name: beta1, beta1', beta1'', i.
function methods:coordinates()
  local t = {}
  for _, c in ipairs(core.coordinates(self.handle)) do
    t[c.name] = core.in_unit(c.q, c.unit)
  end
  for _, c in ipairs(core.own_states(self.handle)) do t[c.name] = core.in_unit(c.q, c.unit) end
  for _, s in ipairs(core.speeds(self.handle)) do
    t[s.name], t[s.du_name] = core.in_unit(s.u, s.unit), core.in_unit(s.du, s.unit .. "/s")
  end
  return shaped(t)
end

-- Quantities along the speeds, each in its unit: that of `all` by that of the speed.
local function by_speed(self, list, all)
  for i, speed in ipairs(core.speeds(self.handle)) do
    list[i] = core.in_unit(list[i], ("%s/(%s)"):format(all, speed.unit))
  end
  return list
end

-- M by rows.
function methods:mass_matrix()
  local n, mass = core.motion(self.handle)
  local speeds, rows = core.speeds(self.handle), rows_of(mass, n, n)
  for i, row in ipairs(rows) do by_speed(self, row, ("J/(%s)"):format(speeds[i].unit)) end
  return rows
end

-- h = -bias: what all elements exert along the speeds while u' is zero.
function methods:generalised_forces() return shaped(by_speed(self, core.force(self.handle), "W")) end

-- C u + g, and whatever else the elements exert: M u' + bias = tau.
function methods:bias()
  local list = core.force(self.handle)
  for i, h in ipairs(list) do list[i] = -h end
  return shaped(by_speed(self, list, "W"))
end

-- What holds the mechanism at rest against the field of gravity alone.
function methods:gravity_torque() return shaped(by_speed(self, core.gravity_torque(self.handle), "W")) end

-- Leaves and values of core.substitute for { name of a coordinate, speed or acceleration = value }.
local function read_motion(self, t, what)
  local unit, leaf, leaves, values = {}, {}, {}, {}
  local function known(name, e, of) leaf[name], unit[name] = e, of end
  for _, c in ipairs(core.coordinates(self.handle)) do known(c.name, c.q, c.unit) end
  for _, s in ipairs(core.speeds(self.handle)) do
    known(s.name, s.u, s.unit)
    known(s.du_name, s.du, s.unit .. "/s")
  end
  check.keys(check.table(t, what), check.sorted(leaf), what)
  for i, name in ipairs(check.sorted(t)) do
    leaves[i] = leaf[name]
    values[i] = core.expression(t[name], unit[name], ("%s: %s"):format(what, name))
    core.refuse_plain({ values[i] }, ("%s: %s"):format(what, name), true)
  end
  return leaves, values
end

-- The generalised forces of a motion q, q', q''. t: { ["a''"] = value, ... }: what is put in for variables by name, as
-- a controller does with the accelerations that it wants.
function methods:inverse_dynamics(t)
  local list = core.inverse(self.handle)
  if t ~= nil then list = core.substitute(list, read_motion(self, t, "inverse_dynamics")) end
  return shaped(by_speed(self, list, "W"))
end

-- The accelerations as functions of q, q' and forces named tau_beta1, ...; form: "mass_matrix" | "articulated".
function methods:forward_dynamics(t)
  local list = core.forward(self.handle, form_of(t, "forward_dynamics"))
  for i, speed in ipairs(core.speeds(self.handle)) do list[i] = core.in_unit(list[i], speed.unit .. "/s") end
  return shaped(list)
end

-- 6 rows, angular above linear velocity in world axes, for each speed; of a frame, or of a point { frame, offset }.
function methods:jacobian(at)
  local offset
  if type(at) == "table" and not frame.is(at) and at[1] ~= nil then
    check.keys(at, {}, "jacobian", 2)
    local p = at[2]
    if type(p) ~= "table" then
      check.fail("jacobian: expected { frame, { x, y, z } }, got %s as offset", check.kind(p))
    end
    offset = {}
    for i = 1, 3 do offset[i] = core.expression(p[i], "m", ("jacobian: offset[%d]"):format(i)) end
    at = at[1]
  end
  local part, port = frame.place(self, at, "frame", "jacobian: expected m:jacobian(frame)")
  local n, list = core.jacobian(self.handle, part, port, offset)
  local rows = rows_of(list, n, 6)
  for i, row in ipairs(rows) do by_speed(self, row, i <= 3 and "rad/s" or "m/s") end
  return rows
end

-- The equations of motion as a first-order system; made once as long as no part is added.
function methods:dynamics(t)
  local parts, form = core.part_count(self.handle), form_of(t, "dynamics")
  if self.cached_parts ~= parts or self.cached_form ~= form then
    self.cached = ode.of_system(core.dynamics(self.handle, form), self.name, self)
    local controllers = rawget(self, "controllers")
    if controllers then require "ambit.sampled".attach(self.cached, controllers) end
    self.cached_parts, self.cached_form = parts, form
  end
  return self.cached
end

return { methods = methods }
