-- linkage.lua -- what the shipped planar linkages (chain/four_bar.lua, chain/slider_crank.lua) share: their plane, and
-- proofs about lengths.
local check = require "ambit.check"
local core = require "ambit.core"
local Vector = require "ambit.vector"

local linkage = {}

-- The plane across an axis "x" ... "-z": first and second direction in it, with first x second along the axis.
linkage.axes = "z|x|y|-x|-y|-z"
local letters = { x = 1, y = 2, z = 3 }

-- offset(along [, across]): a vector in the plane
function linkage.plane(axis)
  local turned, k = axis:sub(1, 1) == "-", letters[axis:sub(-1)]
  return function(along, across)
    local v = { 0, 0, 0 }
    v[k % 3 + 1] = along
    if across ~= nil then v[(k + 1) % 3 + 1] = turned and -across or across end
    return Vector.new(v[1], v[2], v[3])
  end
end

-- The enclosure of an expression, whatever its unknowns are.
function linkage.enclose(e) return (core.evaluate { expressions = { e } })[1] end

-- The enclosure of a length; refuses one that moves.
function linkage.check_fixed(what, name, length)
  local fixed, x = pcall(linkage.enclose, length)
  if fixed then return x end
  check.fail("%s: %s must be fixed, but it depends on %s", what, name, tostring(x):match "`.-`" or tostring(x))
end

-- Refuses lengths that are not certainly positive: lengths { crank = p.crank, ... }.
function linkage.check_positive(what, lengths)
  for _, name in ipairs(check.sorted(lengths)) do
    local x = linkage.check_fixed(what, name, lengths[name])
    if not (x.lo > 0) then check.fail("%s: %s must be positive, got %s m", what, name, tostring(x)) end
  end
end

-- Is e certainly positive? false, and whether it is certainly not.
function linkage.is_positive(e)
  local x = linkage.enclose(e)
  return x.lo > 0, x.hi <= 0
end

return linkage
