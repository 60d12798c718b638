-- leg/condense.lua -- keeps the number of unknowns bounded in a run of many legs.
--
-- Each leg adds an unknown w_j per state for what was enclosed on the way: the expressions are a zonotope around what
-- the user's data make of them. Some of them are gathered in a box: those that matter little, and when there are many,
-- those that are most like a box (Girard, HSCC 2005). By the mean value theorem the part of x that is due to them is
-- within sum_j dx/dw_j w_j, evaluated over the box of all unknowns, if that contains w_j = 0; it becomes one fresh
-- unknown per expression. The others stay: they are what the states have in common.
local core = require "ambit.core"

local condense = {}

local KEPT = 6       -- unknowns per expression that may be kept
local LITTLE = 1e-4  -- of the width of an expression matters little

-- The leaves of the expressions that are uncertain data.
function condense.unknowns(list)
  local found = {}
  for _, leaf in ipairs(core.leaves(list)) do
    if leaf.kind == "unknown" then found[#found + 1] = leaf end
  end
  return found
end

-- The data that are never gathered: what these expressions depend on.
function condense.data(list)
  local kept = {}
  for _, leaf in ipairs(condense.unknowns(list)) do kept[#kept + 1] = leaf.expression end
  return kept
end

local function is_kept(leaf, kept)
  for _, e in ipairs(kept) do
    if e == leaf.expression then return true end
  end
  return false
end

-- { effect = { dx_i/dw w }, unlike = how far the column is from an axis, share = the largest of a width, w, place };
-- nil if a slope has no bound (that of an unknown of next to no width overflows)
local function column(list, w, widths, place)
  local products = {}
  for i, x in ipairs(list) do products[i] = core.derivative(x, w) * w end
  local effect, sum, largest, share = core.evaluate { expressions = products }, 0, 0, 0
  for i, x in ipairs(effect) do
    if not x:is_bounded() then return nil end
    sum, largest = sum + x:mag(), math.max(largest, x:mag())
    if widths[i] > 0 then share = math.max(share, x:mag() / widths[i]) end
  end
  return { w = w, effect = effect, unlike = sum - largest, share = share, place = place }
end

local function gathered(list, columns)
  local from, to, result = {}, {}, {}
  for k, c in ipairs(columns) do from[k], to[k] = c.w, core.expression(0) end
  for i, x in ipairs(core.substitute(list, from, to)) do
    local spread = core.interval(0)
    for _, c in ipairs(columns) do spread = spread + c.effect[i] end
    result[i] = spread:mag() > 0 and x + core.expression(spread) or x
  end
  return result
end

-- The columns to be gathered: of little share, and of the others all but those least like a box.
local function choose(columns, most)
  table.sort(columns, function(a, b)
    if a.unlike ~= b.unlike then return a.unlike > b.unlike end
    return a.place < b.place
  end)
  local chosen, kept = {}, 0
  for _, c in ipairs(columns) do
    if c.share > LITTLE / #columns and kept < most then kept = kept + 1 else chosen[#chosen + 1] = c end
  end
  return chosen
end

-- The expressions with few unknowns besides those in `data`.
function condense.few(list, data)
  local rests, widths = {}, {}
  for _, leaf in ipairs(condense.unknowns(list)) do
    if leaf.lo <= 0 and leaf.hi >= 0 and not is_kept(leaf, data) then rests[#rests + 1] = leaf.expression end
  end
  if #rests <= #list then return list end
  for i, x in ipairs(core.evaluate { expressions = list }) do widths[i] = x:width() end
  local columns = {}
  for k, w in ipairs(rests) do columns[#columns + 1] = column(list, w, widths, k) end
  local chosen = choose(columns, KEPT * #list)
  return #chosen > #list and gathered(list, chosen) or list
end

return condense
