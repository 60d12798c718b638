-- page/number.lua -- numbers of a report for people, and for its drawings. Widths and bounds are rounded outward.
local json = require "ambit.report.json"
local report_number = require "ambit.report.number"

local number = {}

local huge = math.huge

-- What is no ordinary number, as a text; nil: it is one.
local function odd(x)
  if x == nil then return "" end
  if x ~= x then return "nan" end
  if x == huge then return "\u{221E}" end
  if x == -huge then return "-\u{221E}" end
end

-- Rounded up: what is said of an enclosure stays true.
function number.up(x) return odd(x) or report_number.up(x, 3) end

function number.plain(x) return odd(x) or ("%.4g"):format(x) end

-- Right digits, rounded down.
function number.digits(x) return odd(x) or ("%.1f"):format(math.floor(10 * x) / 10) end

local function scaled(x, units)
  for _, unit in ipairs(units) do
    if math.abs(x) >= unit[1] then return ("%.3g %s"):format(x / unit[1], unit[2]) end
  end
  return ("%.3g %s"):format(x / units[#units][1], units[#units][2])
end

local times = { { 1, "s" }, { 1e-3, "ms" }, { 1e-6, "µs" }, { 1e-9, "ns" } }
local sizes = { { 1e9, "GB" }, { 1e6, "MB" }, { 1e3, "kB" }, { 1, "B" } }

function number.seconds(x)
  if odd(x) then return odd(x) end
  if x == 0 then return "0 s" end
  return x >= 1000 and ("%.0f s"):format(x) or scaled(x, times)
end

function number.memory(x) return odd(x) or x == 0 and "0 B" or scaled(x, sizes) end

-- 12345 -> "12 345"
function number.count(x)
  if odd(x) or x % 1 ~= 0 or math.abs(x) >= 2 ^ 53 then return number.plain(x) end
  local text, more = ("%.0f"):format(x), 1
  while more > 0 do text, more = text:gsub("^(%-?%d+)(%d%d%d)", "%1\u{202F}%2") end
  return text
end

-- "n cases", "1 case"
number.of = report_number.count

-- -- for drawings, and to sort by

-- As JSON: an infinite number overflows where it is read, and so stays infinite; null: not a number.
function number.drawn(x)
  if x == huge or x == -huge then return json.raw(x > 0 and "1e999" or "-1e999") end
  return json.raw(json.drawn(x or 0 / 0))
end

-- As the attribute that a column is sorted by; "": nothing to sort by.
function number.sort(x)
  if x == nil or x ~= x then return "" end
  if x == huge or x == -huge then return x > 0 and "Infinity" or "-Infinity" end
  return ("%.9g"):format(x)
end

-- With so many digits, not above x (way = -1) or not below it (way = 1).
function number.outward(x, digits, way)
  if x == 0 then return "0" end
  local form = ("%%.%dg"):format(digits)
  local text = form:format(x)
  if (tonumber(text) - x) * way >= 0 then return text end
  local unit = 10.0 ^ (math.floor(math.log(math.abs(x), 10)) - digits + 1)
  text = form:format(x + way * 0.75 * unit)
  return (tonumber(text) - x) * way >= 0 and text or ("%.17g"):format(x)
end

local function finite(x) return x == x and x ~= huge and x ~= -huge end

-- Bounds as JSON with as few digits as keep their distance to a part in a hundred, rounded outward, or inward (way =
-- -1); null: no finite bound.
function number.bounds(lo, hi, way)
  if not (finite(lo) and finite(hi)) then return json.raw "null", json.raw "null" end
  local width, size, digits = hi - lo, math.max(math.abs(lo), math.abs(hi)), 17
  if width > 0 and finite(width) then
    digits = math.max(3, math.min(17, math.ceil(math.log(size / width, 10)) + 3))
  end
  way = way or 1
  return json.raw(number.outward(lo, digits, -way)), json.raw(number.outward(hi, digits, way))
end

return number
