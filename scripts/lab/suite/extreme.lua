-- suite/extreme.lua -- inputs that nobody means, in every arithmetic and solver: nothing crashes, hangs or lies.
local cases = {}
for _, name in ipairs { "values", "texts", "times", "options", "motion", "mechanisms", "roots", "samples",
  "reductions", "sizes" } do
  for _, case in ipairs(require("ambit.suite.extreme." .. name)) do cases[#cases + 1] = case end
end
return cases
