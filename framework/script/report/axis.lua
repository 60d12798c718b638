-- report/axis.lua -- axes: a range around values, and ticks at round numbers however far it goes. Logarithmic ones
-- for positive values, linear ones.
local axis = {}

local ticks_at_least = 4
local farthest = 1e250 -- beyond it and below its inverse, margins and ticks would leave the doubles

-- Has the value a place on an axis?
function axis.on_axis(v) return v >= 1 / farthest and v <= farthest end

local function round_steps(lo, hi)
  local step = 10 ^ math.floor(math.log((hi - lo) / 5, 10))
  for _, factor in ipairs { 1, 2, 5, 10 } do
    if (hi - lo) / (step * factor) <= 8 then
      step = step * factor
      break
    end
  end
  local list = {}
  for k = math.ceil(lo / step), math.floor(hi / step) do list[#list + 1] = k * step end
  return list
end

-- m * 10^k within [lo, hi] for the given m, every `skip`-th power
local function powers(lo, hi, digits, skip)
  local list = {}
  for k = math.floor(math.log(lo, 10)), math.ceil(math.log(hi, 10)) do
    for _, m in ipairs(digits) do
      local v = m * 10.0 ^ k
      if k % skip == 0 and v >= lo and v <= hi then list[#list + 1] = v end
    end
  end
  return list
end

local function ticks(lo, hi)
  local decades = math.log(hi, 10) - math.log(lo, 10)
  if decades < 0.7 then return round_steps(lo, hi) end
  if decades > 3 then return powers(lo, hi, { 1 }, math.ceil(decades / 8)) end
  local list = powers(lo, hi, decades > 2 and { 1, 3 } or { 1, 2, 5 }, 1)
  return #list >= ticks_at_least and list or powers(lo, hi, { 1, 2, 3, 5, 7 }, 1)
end

-- { lo, hi, ticks } around values that are on_axis, with hi/lo at least `least`
function axis.range(values, least)
  local lo, hi = math.huge, 0
  for _, v in ipairs(values) do lo, hi = math.min(lo, v), math.max(hi, v) end
  if hi == 0 then lo, hi = 0.1, 10 end
  local decades = math.log(hi, 10) - math.log(lo, 10)
  local margin = 10 ^ math.max(0.08 * decades, 0.5 * (math.log(least, 10) - decades))
  lo, hi = lo / margin, hi * margin
  return { lo = lo, hi = hi, ticks = ticks(lo, hi) }
end

-- A linear axis from lo to hi, lo < hi.
function axis.linear(lo, hi) return { lo = lo, hi = hi, ticks = round_steps(lo, hi), linear = true } end

-- Where v is between the pixels `from` and `to`.
function axis.pixel(range, v, from, to)
  if range.linear then return from + (v - range.lo) / (range.hi - range.lo) * (to - from) end
  local log_lo = math.log(range.lo)
  return from + (math.log(v) - log_lo) / (math.log(range.hi) - log_lo) * (to - from)
end

return axis
