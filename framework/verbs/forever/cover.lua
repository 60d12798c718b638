-- forever/cover.lua -- boxes of floats, { lo = { ... }, hi = { ... } }, that together contain another one, or do not.
local cover = {}

local function copy(list) return table.move(list, 1, #list, 1, {}) end

-- Do they share more than a face? In directions in which `box` is a point, that point is enough.
local function meets(box, cell)
  for i, lo in ipairs(box.lo) do
    local hi = box.hi[i]
    local from, to = math.max(lo, cell.lo[i]), math.min(hi, cell.hi[i])
    if not (from < to or lo == hi and from <= to) then return false end
  end
  return true
end

-- What of the box lies outside the cell, as boxes.
local function rest(box, cell)
  local parts, left = {}, { lo = copy(box.lo), hi = copy(box.hi) }
  for i = 1, #box.lo do
    for _, side in ipairs { "lo", "hi" } do
      local other = side == "lo" and "hi" or "lo"
      local beyond = side == "lo" and left.lo[i] < cell.lo[i] or side == "hi" and left.hi[i] > cell.hi[i]
      if beyond then
        local part = { lo = copy(left.lo), hi = copy(left.hi) }
        part[other][i], left[side][i] = cell[side][i], cell[side][i]
        parts[#parts + 1] = part
      end
    end
  end
  return parts
end

-- Is every point of the box in one of the cells? Cells are closed.
function cover.contains(cells, box, from)
  for k = from or 1, #cells do
    if meets(box, cells[k]) then
      for _, part in ipairs(rest(box, cells[k])) do
        if not cover.contains(cells, part, k + 1) then return false end
      end
      return true
    end
  end
  return false
end

-- The two halves of a box across the direction that is widest in these units; nil: doubles do not allow it.
function cover.halves(box, units)
  local best, most = 1, -1
  for i, unit in ipairs(units) do
    local width = (box.hi[i] - box.lo[i]) / unit
    if width > most then best, most = i, width end
  end
  local middle = 0.5 * box.lo[best] + 0.5 * box.hi[best]
  if not (middle > box.lo[best] and middle < box.hi[best]) then return nil end
  local low, high = { lo = copy(box.lo), hi = copy(box.hi) }, { lo = copy(box.lo), hi = copy(box.hi) }
  low.hi[best], high.lo[best] = middle, middle
  return low, high
end

return cover
