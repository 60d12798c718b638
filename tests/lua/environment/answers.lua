-- answers.lua MODE FLUSH -- prints proved answers bit by bit, in a floating-point environment that a careless host set.
local ambit = require "ambit"
require "hostile" (arg[1], arg[2] == "flush")

local function show(what, x) print(what, ("%a"):format(x.lo), ("%a"):format(x.hi), x:text(17)) end

for _, text in ipairs { "0.1", "[2e-310, 1/3]", "3.56?2", "4.9e-324", "1.7976931348623158e308" } do
  local x = ambit.interval(text)
  show(text, x)
  print(("%a %a %a"):format(x:width(), x:mid(), x:rad()))
end

local tiny, third = ambit.interval "[1e-310, 3e-310]", ambit.interval "1/3"
show("tiny / 3", tiny * third)
show("tiny + tiny", tiny + tiny)
show("1e-160^2", ambit.interval "1e-160" ^ 2)
for _, name in ipairs { "sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh" } do
  show(name, ambit[name](third))
  show(name, ambit[name](tiny))
end

local function expressions()
  local x, y = ambit.around("0.4", "10%"), ambit.between("2e-309", "1e-300")
  return {
    ambit.sin(x) * x - x / 3, (x + y) * (x - y), y * "0.3" + y ^ 2, ambit.exp(x * "1.1") * ambit.sqrt(y), ambit.pi * x,
  }
end
for _, entry in ipairs(ambit.plugins "arithmetic") do
  local name = entry.name
  local values = ambit.evaluate { expressions(), arithmetic = name }
  if name ~= "real" then for i, value in ipairs(values) do show(name .. " " .. i, value) end end
end

local run = ambit.simulate {
  ambit.ode { states = { "q", "p" }, equations = function(s) return { q = s.p, p = -ambit.sin(s.q) / 3 } end },
  initial = { q = ambit.around("0.5", "1e-3"), p = 0 }, t = { 0, 1 },
}
show("q", run.x.q)
show("p", run.x.p)
