-- compare/overestimation.lua -- enclosures of runs against the tightest of them and against the hull of samples.
local core = require "ambit.core"
local judge = require "ambit.compare.judge"
local sample_overestimation = require "ambit.sample.overestimation"

local overestimation = {}

local SURE = 10 -- times what the draws' errors are estimated to be: farther out, an enclosure is wrong

local THIN = 1e-6    -- a hull this thin, as part of its own widest, is mostly what the draws' solver errs by
local ROUNDING = 1e-9 -- and so is one that is this thin as part of the state's size

local function is_proof(row) return row.rigorous and row.widths ~= nil end

-- How wide the hull must be to mean something, by state.
local function floors(sample, names)
  local list = {}
  for k in ipairs(names) do
    local widest, size = 0, 0
    for i in ipairs(sample.t) do
      local lo, hi = sample.lo[k][i], sample.hi[k][i]
      if lo <= hi then widest, size = math.max(widest, hi - lo), math.max(size, math.abs(lo), math.abs(hi)) end
    end
    list[k] = math.max(THIN * widest, ROUNDING * size)
  end
  return list
end

-- The largest ratio over the states at one instant of the sample; nil: it has no width there.
local function at_instant(row_at, sample, i, least)
  local largest
  for k, floor in ipairs(least) do
    local width = sample.hi[k][i] - sample.lo[k][i]
    if width > floor and width < math.huge then
      largest = math.max(largest or 0, (row_at.hi[k] - row_at.lo[k]) / width)
    end
  end
  return largest
end

-- What an enclosure of the row misses at one instant, as text, or nil.
local function missed(row, x, comparison, i)
  local sample = comparison.sample
  for k, name in ipairs(comparison.names) do
    local set, hull = core.interval(x.lo[k], x.hi[k]), sample_overestimation.hull_of(sample, k, i)
    if sample_overestimation.misses(set, hull, SURE) then
      return ("%s misses sampled motions about %s at t = %s: %s, and draws from %s to %s that are off by about %.2g")
        :format(row.label, name, core.literal(sample.t[i]), tostring(set), core.literal(hull.lo),
          core.literal(hull.hi), hull.error)
    end
  end
end

local function against_samples(row, comparison, place, least)
  local sample = comparison.sample
  for i, t in ipairs(sample.t) do
    local x = row.at and row.at[place[t]]
    if x then comparison.missed = comparison.missed or missed(row, x, comparison, i) end
    local ratio = x and at_instant(x, sample, i, least)
    if ratio then
      row.over_sample_max = math.max(row.over_sample_max or 0, ratio)
      if i == #sample.t then row.over_sample = ratio end
    end
  end
end

-- Fills over_tightest, over_sample and over_sample_max of the rows, and comparison.missed if one misses what was seen.
function overestimation.find(comparison)
  local rows, names, complete = comparison.rows, comparison.names, {}
  for i, row in ipairs(rows) do complete[i] = is_proof(row) and row.status == "complete" and row.widths or false end
  local tightest = judge.least(complete, names)
  local place = {}
  for k, t in ipairs(comparison.instants) do place[t] = k end
  local least = comparison.sample and floors(comparison.sample, names)
  for i, row in ipairs(rows) do
    if complete[i] then row.over_tightest = judge.ratio(row.widths, tightest, names) end
    if is_proof(row) and least then against_samples(row, comparison, place, least) end
  end
end

return overestimation
