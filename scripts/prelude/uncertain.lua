-- uncertain.lua -- which uncertain data expressions depend on, and their ranges.
--
-- A range is known from both sides: what the tolerances allow lies in [lo, hi], and all of [inner.lo, inner.hi] is
-- allowed. Where inner.lo > inner.hi no value is known to be allowed: nothing may be refuted or bounded from inside by
-- it.
local core = require "ambit.core"

local uncertain = {}

-- { expression, ... } -> { datum }, { lo }, { hi }, { lo = { inner lo }, hi = { inner hi } } of those that are no points
function uncertain.data(expressions)
  local unknowns, lo, hi, inner = {}, {}, {}, { lo = {}, hi = {} }
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "unknown" and leaf.lo < leaf.hi then
      local n = #unknowns + 1
      unknowns[n], lo[n], hi[n] = leaf.expression, leaf.lo, leaf.hi
      inner.lo[n], inner.hi[n] = leaf.inner_lo, leaf.inner_hi
    end
  end
  return unknowns, lo, hi, inner
end

return uncertain
