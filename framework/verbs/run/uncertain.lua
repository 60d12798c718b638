-- run/uncertain.lua -- which uncertain data expressions depend on, and their ranges.
--
-- A range is known from both sides: what the tolerances allow lies in [lo, hi], and all of [inner.lo, inner.hi] is
-- allowed. Where inner.lo > inner.hi no value is known to be allowed: nothing may be refuted or bounded from inside by
-- it.
local core = require "ambit.core"

local uncertain = {}

-- { expression, ... } -> { leaf } as core.leaves gives them, with names that are told apart: in every message, report
-- and record a datum is called so.
function uncertain.leaves(expressions)
  local list, data = {}, {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "unknown" then list[#list + 1], data[#data + 1] = leaf, leaf.expression end
  end
  for i, name in ipairs(core.leaf_names(data)) do list[i].name = name end
  return list
end

-- { expression, ... } -> { datum }, { lo }, { hi }, { lo = { inner lo }, hi = { inner hi } }, { name } of those that
-- are no points
function uncertain.data(expressions)
  local unknowns, lo, hi, inner, names = {}, {}, {}, { lo = {}, hi = {} }, {}
  for _, leaf in ipairs(uncertain.leaves(expressions)) do
    if leaf.lo < leaf.hi then
      local n = #unknowns + 1
      unknowns[n], lo[n], hi[n], names[n] = leaf.expression, leaf.lo, leaf.hi, leaf.name
      inner.lo[n], inner.hi[n] = leaf.inner_lo, leaf.inner_hi
    end
  end
  return unknowns, lo, hi, inner, names
end

-- Do the initial values of a request meet the constraints (closed loops) by themselves, whatever the data? Then every
-- choice of the data is a start of a solution, and a single one of them can be followed. Otherwise doubles would miss
-- the constraints: of a single choice nothing is known, only of a whole set that holds some start.
function uncertain.are_points_starts(q)
  local invariants = core.system_invariants(q.system.system)
  local leaves, values = { core.time() }, { core.expression(q.times[1]) }
  table.move(q.system.symbols, 1, #q.system.symbols, 2, leaves)
  table.move(q.initial, 1, #q.initial, 2, values)
  for _, x in ipairs(core.evaluate { expressions = invariants, leaves = leaves, values = values }) do
    if x.lo ~= 0 or x.hi ~= 0 then return false end
  end
  return true
end

return uncertain
