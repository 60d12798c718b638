-- suite/stiff.lua -- stiff problems: all cases of the group, in order.
local list = {}
local implicit = { { solver = "gsl", options = { method = "msbdf" } } } -- explicit methods prove nothing here either
for _, name in ipairs { "relaxation", "kinetics", "pollution", "circuit", "fields" } do
  local cases = require("ambit.suite.stiff_" .. name)
  for _, case in ipairs(cases) do
    case.group, case.over, case.also = "stiff", case.over or "solvers", case.also or implicit
    list[#list + 1] = case
  end
end
return list
