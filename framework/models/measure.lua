-- measure.lua -- what can be measured on a mechanism, as expressions: positions, velocities and accelerations of
-- frames, distances and angles between them, masses, momenta, and what a joint transmits. Nothing is worked out before
-- it is asked for. Formulas: docs/numerics/forces.md, docs/numerics/mechanics.md.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local Matrix = require "ambit.matrix"
local rotation = require "ambit.rotation"
local Vector = require "ambit.vector"

local measure = {}
local methods = {}

local function pull(self, at, quantity, count, what)
  local part, port = frame.place(self, at, "frame", what)
  return core.pull(self.handle, part, port, quantity, count)
end

local function whole(self, quantity, count) return core.pull(self.handle, -1, 0, quantity, count) end

local function vector_at(list, first) return Vector.new(list[first], list[first + 1], list[first + 2]) end

-- Position (world) and rotation (nine entries by rows, own axes -> world) of a frame.
local function pose(self, at, what)
  local list = pull(self, at, core.POSE, 12, what)
  return Vector.in_unit(vector_at(list, 10), "m"), list
end

-- The twist of a frame in world axes: angular velocity, velocity of its origin; and its rotation.
local function twist(self, at, what)
  local _, r = pose(self, at, what)
  local list = pull(self, at, core.TWIST, 6, what)
  return Vector.in_unit(rotation.turned(r, vector_at(list, 1)), "rad/s"),
    Vector.in_unit(rotation.turned(r, vector_at(list, 4)), "m/s"), r
end

measure.twist = twist

-- -- one frame

-- Position of the frame's origin in the world, m.
function methods:position(at) return (pose(self, at, "position")) end

-- Rotation by rows, own axes -> world.
function methods:orientation(at)
  local _, r = pose(self, at, "orientation")
  return rotation.matrix(r)
end

-- In world axes: of the frame's origin, m/s; rad/s.
function methods:velocity(at) return select(2, twist(self, at, "velocity")) end
function methods:angular_velocity(at) return (twist(self, at, "angular_velocity")) end

-- In world axes, m/s^2: the proper acceleration that the elements carry, plus the field of gravity.
function methods:acceleration(at)
  local _, r = pose(self, at, "acceleration")
  local proper = pull(self, at, core.ACCEL, 6, "acceleration")
  return Vector.in_unit(rotation.turned(r, vector_at(proper, 4)) + vector_at(whole(self, core.FIELD, 3), 1), "m/s^2")
end

-- A point at `offset` (axes of the frame, or nil) of a frame: its position and its velocity, world axes.
function measure.point(self, at, offset, what)
  local r, q = pose(self, at, what)
  local w, v = twist(self, at, what)
  if not offset then return r, v end
  local arm = rotation.turned(q, offset)
  return Vector.in_unit(r + arm, "m"), Vector.in_unit(v + rotation.cross(w, arm), "m/s")
end

-- -- two frames

-- Of the origins, m.
function methods:distance(a, b)
  local d = pose(self, b, "distance: second frame") - pose(self, a, "distance: first frame")
  return core.in_unit(core.sqrt(rotation.dot(d, d)), "m")
end

-- Rotation and position of b in the axes of a.
function methods:relative_pose(a, b)
  local ra, qa = pose(self, a, "relative_pose: first frame")
  local rb, qb = pose(self, b, "relative_pose: second frame")
  return setmetatable({ position = Vector.in_unit(rotation.turned_back(qa, rb - ra), "m"),
    rotation = rotation.matrix(rotation.product_back(qa, qb)) }, Matrix)
end

-- The motion of b as it is seen from a, in the axes of a: velocity of the origin, m/s, and angular velocity, rad/s.
function methods:relative_velocity(a, b)
  local ra, qa = pose(self, a, "relative_velocity: first frame")
  local rb = pose(self, b, "relative_velocity: second frame")
  local wa, va = twist(self, a, "relative_velocity: first frame")
  local wb, vb = twist(self, b, "relative_velocity: second frame")
  local linear = rotation.turned_back(qa, vb - va - rotation.cross(wa, rb - ra))
  return setmetatable({ linear = Vector.in_unit(linear, "m/s"),
    angular = Vector.in_unit(rotation.turned_back(qa, wb - wa), "rad/s") }, Matrix)
end

-- Without an axis: the angle of the rotation from a to b, 0 to pi. About an axis (in the axes of a): the signed angle
-- of the twist about it, within pi of `near` (0): 2 atan2(n.vee(Q - Q^T), 1 + tr Q), whose second argument is never
-- negative, so that the branch cut of atan2 is not met; it is undefined where the rotation is by pi away from `near`.
function methods:angle(a, b, axis, near)
  local _, qa = pose(self, a, "angle: first frame")
  local _, qb = pose(self, b, "angle: second frame")
  local q = rotation.product_back(qa, qb)
  if axis == nil then
    if near ~= nil then check.fail "angle: `near` is of the angle about an axis: say which axis" end
    local s = rotation.vee(q)
    return core.in_unit(core.atan2(core.sqrt(rotation.dot(s, s)), rotation.trace(q) - 1), "rad")
  end
  local n = rotation.direction(axis, "angle: axis")
  if near ~= nil then
    near = core.expression(near, "rad", "angle: near")
    q = rotation.product_back(rotation.about(n, near), q)
  end
  local twisted = 2 * core.atan2(rotation.dot(n, rotation.vee(q)), 1 + rotation.trace(q))
  return core.in_unit(near and near + twisted or twisted, "rad")
end

-- -- masses

-- kg
function methods:total_mass() return core.in_unit(whole(self, core.MASS, 1)[1], "kg", "given") end

-- In the world, m.
function methods:centre_of_mass()
  local mass = self:total_mass()
  if mass == core.expression(0) then check.fail "centre_of_mass: the mechanism has no mass" end
  local moment = vector_at(whole(self, core.MASS_MOMENT, 3), 1)
  return Vector.in_unit(Vector.new(moment.x / mass, moment.y / mass, moment.z / mass), "m")
end

-- Linear momentum, N s, and angular momentum, N m s, in world axes, about the world's origin or that of a frame.
function methods:momentum(about)
  local list = whole(self, core.MOMENTUM, 6)
  local angular, linear = vector_at(list, 1), vector_at(list, 4)
  if about ~= nil then angular = angular - rotation.cross(pose(self, about, "momentum: about"), linear) end
  return setmetatable({ linear = Vector.in_unit(linear, "N s"), angular = Vector.in_unit(angular, "N m s") }, Matrix)
end

-- -- what a joint transmits

-- The frame that the joint moves.
local function moved_frame(self, joint, what)
  local part = frame.place(self, joint, "joint", what)
  for _, port in ipairs(self.declared[part] and self.declared[part].outs or {}) do
    if port.kind == "frame" then return part, port.index end
  end
  check.fail("%s: the %s moves no frame", what, tostring(joint))
end

-- Expressions with accelerations and multipliers replaced by what the equations of motion make of them.
local function in_motion(self, list)
  if core.has_constraints(self.handle) then return core.of_states(self.handle, list) end
  local leaves, values, system = {}, {}, self:dynamics()
  for i, speed in ipairs(core.speeds(self.handle)) do leaves[i], values[i] = speed.du, system:rate(speed.name) end
  return core.substitute(list, leaves, values)
end

-- The torque, N m, and the force, N, that the joint exerts on what it carries: of the frame that it moves, in its axes,
-- at its origin. How it depends on accelerations and multipliers stays visible (q'', lambda_...); "motion" puts in what
-- the equations of motion make of them.
function methods:reaction(joint, which)
  if which ~= nil and which ~= "motion" then
    check.fail('reaction: expected nothing or "motion", got %s', tostring(which))
  end
  local part, port = moved_frame(self, joint, "reaction")
  local wrench = core.pull(self.handle, part, port, core.WRENCH, 6)
  for i = 1, 6 do wrench[i] = -wrench[i] end
  if which == "motion" then wrench = in_motion(self, wrench) end
  return setmetatable({ torque = Vector.in_unit(vector_at(wrench, 1), "N m"),
    force = Vector.in_unit(vector_at(wrench, 4), "N") }, Matrix)
end

measure.methods = methods

return measure
