-- page/compare_data.lua -- what the diagrams of a comparison draw, for JSON. What is in the table is read from there.
local compare_table = require "ambit.compare.table"
local html = require "ambit.report.html"
local judge = require "ambit.compare.judge"
local json = require "ambit.report.json"
local number = require "ambit.page.number"

local data = {}

-- What may go across, in the order in which it is offered.
local quantities = { { "width", "final width" }, { "width_max", "largest width" },
  { "over_sample", "final overestimation" }, { "over_sample_max", "largest overestimation" },
  { "error", "true error" } }

local function finite(x) return x and x == x and math.abs(x) < math.huge end

-- The finite ones of some times, exactly -> JSON, their places
local function times(list)
  local out, places = {}, {}
  for i, t in ipairs(list) do
    if finite(t) then
      local text = ("%.15g"):format(t)
      out[#out + 1] = json.raw(tonumber(text) == t and text or ("%.17g"):format(t))
      places[#places + 1] = i
    end
  end
  return out, places
end

-- Bounds { {..} per name } at some of the places -> JSON
local function bounds(from_lo, from_hi, names, places, way)
  local lo, hi = {}, {}
  for k = 1, #names do
    local lows, highs = from_lo[k] or {}, from_hi[k] or {}
    lo[k], hi[k] = {}, {}
    for i, place in ipairs(places) do
      lo[k][i], hi[k][i] = number.bounds(lows[place] or 0 / 0, highs[place] or 0 / 0, way)
    end
  end
  return lo, hi
end

-- { t, lo = { {..} per name }, hi, tube = { lo, hi } } -> the same for JSON. way: -1: bounds are rounded inward.
local function track(from, names, way)
  if not (from and from.t and from.t[1]) then return nil end
  local t, places = times(from.t)
  local to = { t = t }
  to.lo, to.hi = bounds(from.lo, from.hi, names, places, way)
  if from.tube and #places == #from.t then -- the last place has none: it ends
    local tube = {}
    tube.lo, tube.hi = bounds(from.tube.lo, from.tube.hi, names, places)
    to.tube = tube
  end
  return to
end

-- The hull of samples: { t, lo, hi, error = { {..} per name } }; where lo = hi, that is off by the error.
local function sampled(from, names)
  local to = track(from, names, -1)
  if not to then return nil end
  local _, places = times(from.t)
  to.error = {}
  for k = 1, #names do
    to.error[k] = {}
    for i, place in ipairs(places) do to.error[k][i] = number.drawn(((from.error or {})[k] or {})[place]) end
  end
  return to
end

local function list_of(x) return type(x) == "table" and x or { x } end

-- x[name] is a list over the instants, or one value if there is one instant; what is no number is not drawn.
local function reference(from, names)
  if not (from and from.t and from.x) then return nil end
  local t, places = times(list_of(from.t))
  local to = { t = t, x = {} }
  for k, name in ipairs(names) do
    local values = list_of(from.x[name])
    to.x[k] = {}
    for i, place in ipairs(places) do
      local value = tonumber(values[place]) or 0 / 0
      to.x[k][i] = number.bounds(value, value)
    end
  end
  return to
end

local function row(from, names)
  local to = { label = html.plain(from.label), family = html.plain(from.family or from.label), status = from.status,
    rigorous = from.rigorous ~= false, seconds = number.drawn(from.seconds_run), pareto = from.pareto == true,
    track = track(from.track, names) }
  for _, quantity in ipairs(quantities) do
    local proved = quantity[1] == "error" or to.rigorous
    to[quantity[1]] = number.drawn(proved and from[quantity[1]] or nil)
  end
  return to
end

-- Those that at least one row has.
local function offered(comparison)
  local list = {}
  for _, quantity in ipairs(quantities) do
    for _, from in ipairs(comparison.rows) do
      if from[quantity[1]] then
        list[#list + 1] = comparison.t and quantity or { quantity[1], (quantity[2]:gsub("^final ", "")) }
        break
      end
    end
  end
  return list
end

function data.of(comparison)
  local names, rows, shown, units = comparison.names or {}, {}, {}, {}
  for i, from in ipairs(comparison.rows) do rows[i] = row(from, names) end
  for i, name in ipairs(names) do
    shown[i] = html.plain(compare_table.name_of(name))
    units[i] = html.plain((comparison.units or {})[i] or "")
  end
  local offers, keys, measure = offered(comparison), {}, nil
  for i, quantity in ipairs(offers) do
    if quantity[1] == comparison.measure or not measure then measure = quantity[1] end
    keys[i] = quantity[1]
  end
  return { names = shown, units = units, rows = rows, quantities = offers, measure = measure,
    first = judge.telling(comparison.rows, measure, keys),
    sample = comparison.t and sampled(comparison.sample, names), reference = reference(comparison.reference, names) }
end

return data
