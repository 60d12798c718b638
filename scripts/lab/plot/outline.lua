-- plot/outline.lua -- the shape of a proved set in a plane of two quantities, not only its box.
--
-- run:set() gives the states at the end as functions of the data. For each of some directions d, the set lies where
-- d . (x, y) <= the upper bound of that expression over all data. The intersection of these half planes, which holds
-- the set, is a polygon.
local core = require "ambit.core"

local outline = {}

local DIRECTIONS = 72

local ROUNDING = 1e-9 -- parts of the box that the polygon is made wider by: more than all of its arithmetic is off by

-- The part of a convex polygon { { x, y }, ... } where a x + b y <= c.
local function clipped(polygon, a, b, c)
  local part, n = {}, #polygon
  for i = 1, n do
    local p, q = polygon[i], polygon[i % n + 1]
    local beyond_p, beyond_q = a * p[1] + b * p[2] - c, a * q[1] + b * q[2] - c
    if beyond_p <= 0 then part[#part + 1] = p end
    if (beyond_p < 0 and beyond_q > 0) or (beyond_p > 0 and beyond_q < 0) then
      local s = beyond_p / (beyond_p - beyond_q)
      part[#part + 1] = { p[1] + s * (q[1] - p[1]), p[2] + s * (q[2] - p[2]) }
    end
  end
  return part
end

-- The quantities at the end as functions of the data, each as its distance from the middle of its box in parts of half
-- the box.
local function ends_of(run, quantities, middle, half)
  local set, values, leaves = run:set(), { core.expression(run.t_reached) }, { core.time() }
  for k, name in ipairs(run.states) do leaves[k + 1], values[k + 1] = run.system.symbols[k], set[name] end
  local ends = core.substitute(quantities, leaves, values)
  for i, e in ipairs(ends) do ends[i] = (e - core.expression(middle[i])) / core.expression(half[i]) end
  return ends
end

-- How far the box reaches, in parts of its half: one, but for what `middle` and `half` are rounded by.
local function reach(middle, half) return 1 + 1e-6 + 0x1p-50 * math.abs(middle) / half end

-- Corners in order for the quantities gx and gy (expressions of the run's states and clock), whose box at the end is
-- [x_lo, x_hi] x [y_lo, y_hi], relative to the middle of that: { middle = { x, y }, { x, y }, ... }; nil: a box is all
-- that is known. A run that ends at a time which is no double knows its set there, and its box at the double beside it.
function outline.of(run, gx, gy, box)
  local half = { (box[2] - box[1]) / 2, (box[4] - box[3]) / 2 }
  local middle = { box[1] + half[1], box[3] + half[2] }
  if run.times.last or not (half[1] > 0 and half[2] > 0 and half[1] < math.huge and half[2] < math.huge) then
    return nil
  end
  local ends, directions, forms = ends_of(run, { gx, gy }, middle, half), {}, {}
  for i = 1, DIRECTIONS do
    local angle = 2 * math.pi * i / DIRECTIONS
    directions[i] = { math.cos(angle), math.sin(angle) }
    forms[i] = core.expression(directions[i][1]) * ends[1] + core.expression(directions[i][2]) * ends[2]
  end
  local good, bounds = pcall(core.evaluate, { arithmetic = "gradient", expressions = forms })
  if not good then return nil end
  local x, y = reach(middle[1], half[1]), reach(middle[2], half[2])
  local polygon = { { -x, -y }, { x, -y }, { x, y }, { -x, y } }
  for i, d in ipairs(directions) do polygon = clipped(polygon, d[1], d[2], bounds[i].hi + ROUNDING) end
  for _, p in ipairs(polygon) do p[1], p[2] = p[1] * half[1], p[2] * half[2] end
  polygon.middle = middle
  return #polygon >= 3 and polygon or nil
end

return outline
