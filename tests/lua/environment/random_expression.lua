-- random_expression.lua -- random expressions, and what they are at a point: for the specs of sources.
local ambit = require "ambit"
local core = require "ambit.core"

local random_expression = {}

-- A function of n: a number from 1 to n.
function random_expression.random_of(seed)
  local state = seed
  return function(n)
    state = (state * 1103515245 + 12345) % 2147483648
    return (state >> 8) % n + 1
  end
end

local unary = { "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "sqr",
  "abs" }

-- n expressions: leaves, numbers, then one made of those before.
function random_expression.grow(random, leaves, n)
  local pool = table.move(leaves, 1, #leaves, 1, {})
  for _, number in ipairs { 2, -3, 0.1, 1e-5, -1.5e10, "0.1", "1/3", ".25e-3", "2.5e4", ambit.pi } do
    pool[#pool + 1] = core.expression(number)
  end
  local function pick() return random(3) == 1 and pool[random(#pool)] or pool[math.max(1, #pool + 1 - random(9))] end
  while #pool < n do
    local kind, a, b = random(11), pick(), pick()
    local e
    if kind <= 2 then e = a + b
    elseif kind <= 4 then e = a - b
    elseif kind <= 6 then e = a * b
    elseif kind == 7 then e = a / b
    elseif kind == 8 then e = a ^ (random(9) - 5)
    elseif kind == 9 then e = ({ ambit.atan2, ambit.min, ambit.max })[random(3)](a, b)
    elseif kind == 10 then e = -a
    else e = ambit[unary[random(#unary)]](a) end
    pool[#pool + 1] = e
  end
  return pool
end

-- What an expression is at a point, or nil where it is not defined, or too large to be told apart from rounding.
function random_expression.value_at(expression, leaves, numbers)
  local e = core.substitute({ expression }, leaves, numbers)[1]
  local x = ambit.evaluate { e, arithmetic = "interval" }
  if x.partial or not (math.abs(x:mid()) < 1e8) or x:width() > 1e-9 * (1 + math.abs(x:mid())) then return nil end
  return x:mid()
end

return random_expression
