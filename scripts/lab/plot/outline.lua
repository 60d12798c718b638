-- plot/outline.lua -- the shape of a proved set in a plane of two quantities, not only its box.
--
-- run:set() gives the states at the end as functions of the data. For each of some directions d, the set lies where
-- d . (x, y) <= the upper bound of that expression over all data. The intersection of these half planes, which holds
-- the set, is a polygon.
local core = require "ambit.core"

local outline = {}

local DIRECTIONS = 72

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

-- Corners in order for the quantities gx and gy (expressions of the run's states and clock), or nil: a box is all that
-- is known.
function outline.of(run, gx, gy, box)
  local set, values, leaves = run:set(), { core.expression(run.t_reached) }, { core.time() }
  for k, name in ipairs(run.states) do leaves[k + 1], values[k + 1] = run.system.symbols[k], set[name] end
  local ends = core.substitute({ gx, gy }, leaves, values)
  local wide, high = box[2] - box[1], box[4] - box[3]
  if not (wide > 0 and high > 0 and wide < math.huge and high < math.huge) then return nil end
  local directions, forms = {}, {}
  for i = 1, DIRECTIONS do -- in parts of the box, so that both quantities count alike
    local angle = 2 * math.pi * i / DIRECTIONS
    directions[i] = { math.cos(angle) / wide, math.sin(angle) / high }
    forms[i] = core.expression(directions[i][1]) * ends[1] + core.expression(directions[i][2]) * ends[2]
  end
  local good, bounds = pcall(core.evaluate, { arithmetic = "gradient", expressions = forms })
  if not good then return nil end
  local polygon = { { box[1], box[3] }, { box[2], box[3] }, { box[2], box[4] }, { box[1], box[4] } }
  for i, d in ipairs(directions) do polygon = clipped(polygon, d[1], d[2], bounds[i].hi) end
  return #polygon >= 3 and polygon or nil
end

return outline
