-- uncertain.lua -- which uncertain data expressions depend on, and their ranges.
local core = require "ambit.core"

local uncertain = {}

-- { expression, ... } -> { datum }, { lo }, { hi } of those that are no points
function uncertain.data(expressions)
  local unknowns, lo, hi = {}, {}, {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "unknown" and leaf.lo < leaf.hi then
      unknowns[#unknowns + 1], lo[#lo + 1], hi[#hi + 1] = leaf.expression, leaf.lo, leaf.hi
    end
  end
  return unknowns, lo, hi
end

return uncertain
