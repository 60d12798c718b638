-- vector.lua -- three components with names: p.x, p.y, p.z; also p[1], p[2], p[3] and ipairs(p). Of expressions or of
-- enclosures.
local core = require "ambit.core"

local Vector = { __name = "vector", is_shape = true }
local names = { "x", "y", "z" }

function Vector.__index(self, key)
  local name = names[key]
  return name and rawget(self, name)
end

function Vector.__len() return 3 end

function Vector.__tostring(self)
  return ("(%s, %s, %s)"):format(tostring(self.x), tostring(self.y), tostring(self.z))
end

function Vector.__add(a, b) return Vector.new(a.x + b.x, a.y + b.y, a.z + b.z) end
function Vector.__sub(a, b) return Vector.new(a.x - b.x, a.y - b.y, a.z - b.z) end
function Vector.__unm(a) return Vector.new(-a.x, -a.y, -a.z) end

-- by a number, an expression or an enclosure; write an expression second (v * e): the first operand decides
function Vector.__mul(a, b)
  local v, s = a, b
  if getmetatable(a) ~= Vector then v, s = b, a end
  return Vector.new(v.x * s, v.y * s, v.z * s)
end

-- The same components in this unit; soft: which is not insisted on.
function Vector.in_unit(self, unit, soft)
  local function component(x) return core.in_unit(x, unit, soft) end
  return Vector.new(component(self.x), component(self.y), component(self.z))
end

function Vector.new(x, y, z) return setmetatable({ x = x, y = y, z = z }, Vector) end

-- rotation (nine entries by rows) times v
function Vector.turned(r, v)
  local row = function(i) return r[i] * v.x + r[i + 1] * v.y + r[i + 2] * v.z end
  return Vector.new(row(1), row(4), row(7))
end

return Vector
