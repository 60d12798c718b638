-- rotation.lua -- rotations (nine entries by rows, own axes -> axes before) and vectors of expressions.
local core = require "ambit.core"
local Matrix = require "ambit.matrix"
local parameter = require "ambit.parameter"
local Vector = require "ambit.vector"

local rotation = {}

function rotation.dot(u, v) return u.x * v.x + u.y * v.y + u.z * v.z end

function rotation.cross(u, v)
  return Vector.new(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x)
end

-- R v, R^T v
rotation.turned = Vector.turned

function rotation.turned_back(r, v)
  local column = function(i) return r[i] * v.x + r[i + 3] * v.y + r[i + 6] * v.z end
  return Vector.new(column(1), column(2), column(3))
end

-- R^T S
function rotation.product_back(r, s)
  local product = {}
  for i = 1, 3 do
    for j = 1, 3 do product[3 * i - 3 + j] = r[i] * s[j] + r[i + 3] * s[j + 3] + r[i + 6] * s[j + 6] end
  end
  return product
end

function rotation.trace(r) return r[1] + r[5] + r[9] end

-- 2 sin(angle) times the axis: what R - R^T makes of a vector is the cross product with it.
function rotation.vee(r) return Vector.new(r[8] - r[6], r[3] - r[7], r[4] - r[2]) end

function rotation.matrix(r)
  local n = {}
  for i = 1, 9 do n[i] = core.in_unit(r[i], "1") end
  return setmetatable({ { n[1], n[2], n[3] }, { n[4], n[5], n[6] }, { n[7], n[8], n[9] } }, Matrix)
end

-- "x", "-z" or three numbers, as a unit vector
function rotation.direction(axis, what)
  local list = parameter.express({ shape = "axis", unit = "1" }, axis, what)
  local n = Vector.new(list[1], list[2], list[3])
  local length = core.sqrt(rotation.dot(n, n))
  return Vector.new(n.x / length, n.y / length, n.z / length)
end

-- By the angle about a unit vector [Rodrigues 1840].
function rotation.about(n, angle)
  local c, s = core.cos(angle), core.sin(angle)
  local function entry(u, v, off) return u * v * (1 - c) + off end
  return { n.x * n.x + c * (1 - n.x * n.x), entry(n.x, n.y, -n.z * s), entry(n.x, n.z, n.y * s),
    entry(n.x, n.y, n.z * s), n.y * n.y + c * (1 - n.y * n.y), entry(n.y, n.z, -n.x * s),
    entry(n.x, n.z, -n.y * s), entry(n.y, n.z, n.x * s), n.z * n.z + c * (1 - n.z * n.z) }
end

return rotation
