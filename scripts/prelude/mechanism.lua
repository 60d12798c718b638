-- mechanism.lua -- m = ambit.mechanism "arm"; m:<element> { ... }; m:position(frame); m:dynamics().
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"
local ode = require "ambit.ode"
local session = require "ambit.session"
local Vector = require "ambit.vector"

local Matrix = { __name = "matrix", is_shape = true }

local Mechanism = { __name = "mechanism" }
local methods = {}
local constructors = {}

-- A method, else an element plugin of that name.
function Mechanism.__index(_, key)
  if methods[key] then return methods[key] end
  if type(key) ~= "string" then check.fail("a mechanism has no entry [%s]", tostring(key)) end
  if not constructors[key] then
    local near = core.nearest(key, check.sorted(methods))
    local exists = false
    for _, entry in ipairs(near and core.list() or {}) do
      exists = exists or entry.kind == "element" and entry.name == key
    end
    if near and not exists then check.fail('a mechanism has no `%s`; did you mean `%s`?', key, near) end
    element.declaration(key)
    constructors[key] = function(self, t)
      if getmetatable(self) ~= Mechanism then check.fail("%s: write m:%s { ... }, with a colon", key, key) end
      return element.add(self, key, t)
    end
  end
  return constructors[key]
end

function Mechanism.__tostring(self) return ('mechanism "%s" (%d parts)'):format(self.name,
  core.part_count(self.handle)) end

local function motion(self, at, quantity, count)
  local part, port = frame.place(self, at, "frame", "expected m:position(frame)")
  return core.pull(self.handle, part, port, quantity, count)
end

-- Position of the frame's origin in the world, m.
function methods:position(at)
  local pose = motion(self, at, core.POSE, 12)
  return Vector.new(pose[10], pose[11], pose[12])
end

-- Rotation by rows, own axes -> world.
function methods:orientation(at)
  local p = motion(self, at, core.POSE, 12)
  return setmetatable({ { p[1], p[2], p[3] }, { p[4], p[5], p[6] }, { p[7], p[8], p[9] } }, Matrix)
end

local function turned(self, at, quantity, first)
  local pose, list = motion(self, at, core.POSE, 12), motion(self, at, quantity, 6)
  return Vector.turned(pose, { x = list[first], y = list[first + 1], z = list[first + 2] })
end

-- In world axes: of the frame's origin, m/s; rad/s.
function methods:velocity(at) return turned(self, at, core.TWIST, 4) end
function methods:angular_velocity(at) return turned(self, at, core.TWIST, 1) end

-- In world axes, m/s^2: the proper acceleration that the elements carry, plus the field of gravity.
function methods:acceleration(at)
  local field = core.pull(self.handle, -1, 0, core.FIELD, 3)
  return turned(self, at, core.ACCEL, 4) + Vector.new(field[1], field[2], field[3])
end

-- Energy of the whole mechanism, J.
function methods:energy()
  local e = core.pull(self.handle, -1, 0, core.ENERGY, 2)
  return setmetatable({ kinetic = e[1], potential = e[2], total = e[1] + e[2] }, Matrix)
end

-- The joint coordinates as expressions, by name: beta1, beta1', beta1''.
function methods:coordinates()
  local t = {}
  for _, c in ipairs(core.coordinates(self.handle)) do
    t[c.name], t[c.name .. "'"], t[c.name .. "''"] = c.q, c.qd, c.qdd
  end
  return setmetatable(t, Matrix)
end

-- M(q) q'' = h(q, q'): the matrix by rows, and h.
function methods:mass_matrix()
  local n, mass = core.motion(self.handle)
  local rows = {}
  for i = 1, n do rows[i] = table.move(mass, (i - 1) * n + 1, i * n, 1, {}) end
  return setmetatable(rows, Matrix)
end

function methods:generalised_forces()
  local _, _, force = core.motion(self.handle)
  return setmetatable(force, Matrix)
end

-- The equations of motion as a first-order system; made once as long as no part is added.
function methods:dynamics()
  local parts = core.part_count(self.handle)
  if self.cached_parts ~= parts then
    self.cached = ode.of_system(core.dynamics(self.handle), self.name)
    self.cached_parts = parts
  end
  return self.cached
end

check.methods(methods, Mechanism)

local mechanism = {}

-- mechanism "name" or mechanism { "name", gravity = { 0, "-9.81", 0 } }
function mechanism.new(t)
  if type(t) == "string" or t == nil then t = { t } end
  check.table(t, "mechanism")
  check.keys(t, { "name", "gravity" }, "mechanism", 1)
  local name = check.text(t[1] or t.name or "mechanism", "mechanism: name")
  local self = setmetatable({ name = name, handle = core.mechanism(name), declared = {}, cached = false,
    cached_parts = false },
    Mechanism)
  self.world = frame.new(self, 0, { index = 0, kind = "frame" })
  session.add(session.mechanisms, self)
  if t.gravity ~= nil then element.add(self, "gravity", type(t.gravity) == "table" and t.gravity or { t.gravity }) end
  return self
end

function mechanism.is(value) return getmetatable(value) == Mechanism end

return mechanism
