-- measure.lua -- what can be measured on a mechanism: position, orientation, velocity, acceleration of a frame.
local core = require "ambit.core"
local frame = require "ambit.frame"
local Matrix = require "ambit.matrix"
local Vector = require "ambit.vector"

local methods = {}

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

local measure = {}

function measure.install(into)
  for name, method in pairs(methods) do into[name] = method end
end

return measure
