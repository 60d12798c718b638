-- compare/advice.lua -- one plain sentence: which combination to use for which accuracy.
local compare_table = require "ambit.compare.table"
local report_number = require "ambit.report.number"

local advice = {}

local NOTICED = 0.99 -- a width below this part of another one is worth a word
local STEP = 0.3     -- and below this part of the last that was named, a word of its own

local what = { width = "widths", error = "errors", over_sample = "overestimations", width_max = "widths" }

-- The fastest, the tightest, and between them whatever is noticeably tighter than the one before.
local function stations(front, key)
  local list, last = { front[1] }, front[#front]
  for i = 2, #front - 1 do
    local row = front[i]
    if row[key] < STEP * list[#list][key] and last[key] < STEP * row[key] then list[#list + 1] = row end
  end
  if last[key] < NOTICED * list[#list][key] then list[#list + 1] = last end
  return list
end

local function cost(row) return compare_table.seconds(row.seconds_run) end

-- front: rows of judge.front(rows, key), the fastest first
local function of_front(front, key)
  local list, parts = stations(front, key), {}
  if #list == 1 then
    return ("Use %s (%s): nothing else is noticeably tighter or faster."):format(list[1].label, cost(list[1]))
  end
  for i, row in ipairs(list) do
    local size = row[key] == 0 and "0" or report_number.up(row[key], key == "over_sample" and 3 or 2)
    parts[i] = i == 1 and ("For %s to %s use %s (%s)"):format(what[key], size, row.label, cost(row)) or
      ("for %s %s (%s)"):format(size, row.label, cost(row))
  end
  return table.concat(parts, "; ") .. ", the tightest."
end

-- Where nothing reached the end: what came farthest.
local function of_farthest(rows, from)
  local farthest, reach
  for _, row in ipairs(rows) do
    local way = row.rigorous and row.t_reached and math.abs(row.t_reached - from)
    if way and way > (reach or 0) then farthest, reach = row, way end
  end
  if not farthest then return nil end
  return ("Nothing reached the end; %s came farthest, to t = %.4g."):format(farthest.label, farthest.t_reached)
end

function advice.of(comparison, front)
  if comparison.contradicted then
    return "No advice: one of the proofs is wrong, and it may be the tightest."
  end
  if #front > 0 then return of_front(front, comparison.measure) end
  if comparison.t then return of_farthest(comparison.rows, comparison.t[1]) end
end

return advice
