-- compare/judge.lua -- widths against each other: ratios, the Pareto front, which combination to use. Widths are by
-- name; where there are several, the largest ratio over the names counts.
local judge = {}

function judge.any(rows, key)
  for _, row in ipairs(rows) do if row[key] then return true end end
  return false
end

-- The least width of each name; list: of widths by name, or false.
function judge.least(list, names)
  local least = {}
  for _, widths in ipairs(list) do
    for _, name in ipairs(names) do
      local w = widths and widths[name]
      if w then least[name] = math.min(least[name] or math.huge, w) end
    end
  end
  return least
end

-- The largest ratio over the names; nil: there is nothing to hold against.
function judge.ratio(widths, reference, names)
  local largest
  for _, name in ipairs(names) do
    local r, w = reference[name], widths[name]
    if r and w and (r > 0 or w > 0) and r < math.huge then
      largest = math.max(largest or 0, r > 0 and w / r or math.huge)
    elseif r == 0 and w then
      largest = math.max(largest or 0, 1)
    end
  end
  return largest
end

-- Samples of no width hold no information about an overestimation.
function judge.positive(widths, names)
  local list = {}
  for _, name in ipairs(names) do list[name] = widths[name] and widths[name] > 0 and widths[name] or nil end
  return list
end

local function finite(x) return x and x == x and x < math.huge end

-- -- which quantity is to be seen first

local ALIKE = 1.05 -- largest over least, below which a quantity tells nothing apart

-- The largest of the positive ones over the least, among what is drawn.
local function spread(rows, key)
  local least, largest = math.huge, 0
  for _, row in ipairs(rows) do
    local x = row[key]
    if row.status == "complete" and (row.rigorous or key == "error") and finite(x) and x > 0 then
      least, largest = math.min(least, x), math.max(largest, x)
    end
  end
  return largest > 0 and largest / least or 1
end

-- The measure, unless it is the same for all: then that of the keys which tells the rows apart best.
function judge.telling(rows, measure, keys)
  if not measure or spread(rows, measure) >= ALIKE then return measure end
  local best, most = measure, spread(rows, measure)
  for _, key in ipairs(keys) do
    local s = spread(rows, key)
    if s >= ALIKE and s > most then best, most = key, s end
  end
  return best
end

-- -- the Pareto front

local NOTICED = 0.999 -- widths that differ by less than a thousandth are the same

-- The rows that may be on the front: proofs that are complete; if there is none, what proves nothing.
local function candidates(rows, key)
  local proofs, others = {}, {}
  for _, row in ipairs(rows) do
    if row.status == "complete" and finite(row[key]) and finite(row.seconds_run) then
      local list = row.rigorous and proofs or others
      list[#list + 1] = row
    end
  end
  if #proofs > 0 then return proofs end
  return key == "error" and others or {}
end

-- Marks the rows than which no other one is both as fast and, but for a thousandth, as tight, and returns them, the
-- fastest first.
function judge.front(rows, key)
  local list, front, best = candidates(rows, key), {}, math.huge
  local place = {}
  for i, row in ipairs(rows) do place[row] = i end
  table.sort(list, function(a, b)
    if a.seconds_run ~= b.seconds_run then return a.seconds_run < b.seconds_run end
    if a[key] ~= b[key] then return a[key] < b[key] end
    return place[a] < place[b]
  end)
  for _, row in ipairs(list) do
    if row[key] == 0 and best > 0 or row[key] < NOTICED * best then
      row.pareto, best = true, row[key]
      front[#front + 1] = row
    end
  end
  return front
end

return judge
