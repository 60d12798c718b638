-- compare/label.lua -- where the labels of points go: beside their point, clear of every other label and point, and off
-- the lines where possible. A label without a free place is left out.
local label = {}

local char, height, clear = 6.2, 12, 5 -- pixels, of 11 px sans-serif; radius kept around points

local directions = { { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 }, { 0.8, 0.8 }, { -0.8, 0.8 }, { 0.8, -0.8 },
  { -0.8, -0.8 } }

local function overlap(a, b) return a.left < b.right and b.left < a.right and a.bottom < b.top and b.bottom < a.top end

local function box(x, y, half_width, half_height)
  return { left = x - half_width, right = x + half_width, bottom = y - half_height, top = y + half_height }
end

-- Does the line from p to q cross the box? By halving: enough for a choice between places.
local function crosses(b, p, q)
  local steps = 40
  for i = 0, steps do
    local x, y = p.x + (q.x - p.x) * i / steps, p.y + (q.y - p.y) * i / steps
    if b.left < x and x < b.right and b.bottom < y and y < b.top then return true end
  end
  return false
end

-- nil: not free; otherwise how many lines run through the place
local function cost(b, taken, points, frame)
  if b.left < frame.left or b.right > frame.right or b.bottom < frame.bottom or b.top > frame.top then return nil end
  for _, other in ipairs(taken) do if overlap(b, other) then return nil end end
  local lines = 0
  for _, p in ipairs(points) do
    if overlap(b, box(p.x, p.y, clear, clear)) then return nil end
    if p.before and crosses(b, p.before, p) then lines = lines + 1 end
  end
  return lines
end

local function best_place(p, taken, points, frame)
  local half = utf8.len(p.text) * char / 2
  local best, least
  for _, distance in ipairs { 1, 1.7 } do
    for k, d in ipairs(directions) do
      local x = p.x + d[1] * (half + 8) * distance
      local y = p.y + d[2] * (height / 2 + 8) * distance
      local b = box(x, y, half + 1, height / 2)
      local lines = cost(b, taken, points, frame)
      local price = lines and lines + 0.01 * k + 0.3 * distance
      if price and (not least or price < least) then best, least = { x = x, y = y, box = b }, price end
    end
  end
  return best
end

-- Neighbours on a line that lie on top of each other share a label: "10, 20", "10 to 50".
local function join(points)
  local groups, group = {}, nil
  for _, p in ipairs(points) do
    local first = group and group.first
    if p.text and group and p.before == group.last and math.abs(p.x - first.x) + math.abs(p.y - first.y) < 9 then
      group.count, group.last = group.count + 1, p
      group.text = first.text .. (group.count == 2 and ", " or " to ") .. p.text
    elseif p.text then
      group = { x = p.x, y = p.y, text = p.text, colour = p.colour, first = p, last = p, count = 1 }
      groups[#groups + 1] = group
    end
  end
  return groups
end

-- points: { x, y, text or nil, colour, before = the point that a line comes from }, pixels -> { x, y, text, colour },
-- the middles of the labels
function label.place(points, frame)
  local taken, list = {}, {}
  for _, p in ipairs(join(points)) do
    local place = best_place(p, taken, points, frame)
    if place then
      taken[#taken + 1] = place.box
      list[#list + 1] = { x = place.x, y = place.y, text = p.text, colour = p.colour }
    end
  end
  return list
end

return label
