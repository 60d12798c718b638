-- loops.lua -- closed loops of a mechanism: constraints, independent coordinates, multipliers, rank.
local methods = {}

local loops = {}

function loops.install(into)
  for name, method in pairs(methods) do into[name] = method end
end

return loops
