-- expressions.lua: three formulas that show what an arithmetic is good for. `ambit compare scripts/expressions.lua`
-- holds all of them against each other.
--
-- 1. x (1 - x): the same x twice. Intervals forget that; the true range over [0, 1] is [0, 1/4].
-- 2. Rump's polynomial (S. M. Rump, in: Reliability in Computing, 1988, pages 109-126): no uncertain datum, but so much
--    cancellation that double precision gives a number of the wrong size. The value is -0.8273960599468213...
-- 3. The rate of a reaction, k = A exp(-E / (R T)), with a tolerance in each of its data: smooth, nearly linear, the
--    everyday case.
local ambit = require "ambit"
local around, between, number = ambit.around, ambit.between, ambit.number

local x = between(0, 1)
local a, b = number "77617", number "33096"
local rump = number "333.75" * b ^ 6 + a ^ 2 * (11 * a ^ 2 * b ^ 2 - b ^ 6 - 121 * b ^ 4 - 2)
  + number "5.5" * b ^ 8 + a / (2 * b)
local energy, temperature = around(50000, "1%"), around(300, "1%") -- J/mol, K
local rate = around(1e9, "2%") * ambit.exp(-energy / (number "8.314462618" * temperature))
local ratio = rate / (1 + rate)

local expressions = {
  { "x (1 - x)", x * (1 - x) }, { "Rump's polynomial", rump }, { "reaction, k / (1 + k)", ratio },
}
local arithmetics = { "real", "interval", "gradient", "affine", "taylor_model", { "mpfr", precision = 200 } }
local there = ambit.plugins "arithmetic"

for _, case in ipairs(expressions) do
  print(case[1])
  for _, arithmetic in ipairs(arithmetics) do
    local name = type(arithmetic) == "table" and arithmetic[1] or arithmetic
    if there[name] then
      local y = ambit.evaluate { case[2], arithmetic = arithmetic }
      print(("  %-13s %-50s width %.3g"):format(name, tostring(y), y:width()))
    end
  end
end
