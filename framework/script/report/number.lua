-- report/number.lua -- numbers of a reduction for people.
local core = require "ambit.core"

local number = {}

local function with_digits(x, digits) return (("%%.%dg"):format(digits)):format(x) end

-- The least decimal of so many digits (3) that is not below x: a proved bound stays one.
function number.up(x, digits)
  digits = digits or 3
  if x ~= x then return "nan" end
  if x == math.huge or x == -math.huge or x == 0 then return with_digits(x, digits) end
  local text = with_digits(x, digits)
  if core.interval(text).lo >= x then return text end
  local unit = 10.0 ^ (math.floor(math.log(math.abs(x), 10)) - digits + 1)
  text = with_digits(x + 0.75 * unit, digits)
  return core.interval(text).lo >= x and text or core.literal(x)
end

-- A number as it was written: six digits if that is what it says to 15; otherwise marked as rounded.
function number.short(x)
  local text = with_digits(x, 6)
  return tonumber(text) == tonumber(with_digits(x, 15)) and text or "~" .. text
end

function number.time(t) return with_digits(t, 4) end

-- The range of a datum, as it was proved for: a decimal that was written, such as 0.001, lies just inside of the double
-- below it; what is no short decimal keeps all its digits.
function number.range(lo, hi)
  local function inside(x)
    local text = with_digits(x, 15)
    local decimal = core.interval(text)
    return decimal.lo >= lo and decimal.hi <= hi and text or core.literal(x)
  end
  return ("[%s, %s]"):format(inside(lo), inside(hi))
end

-- A ranking's value: an estimate, so any rounding will do.
function number.rank(x) return x == x and with_digits(x, 3) or "" end

-- Rounded up: 100 % is said only of what is at most the bound.
function number.percent(share)
  if share == math.huge then return "inf" end
  if share > 0 and share < 0.01 then return "< 1 %" end
  return ("%.0f %%"):format(math.ceil(100 * share))
end

function number.count(n, what) return ("%d %s%s"):format(n, what, n == 1 and "" or "s") end

return number
