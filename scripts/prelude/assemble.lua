-- assemble.lua -- m:assemble { ... }: a proved configuration of closed loops.
local methods = {}

local assemble = {}

function assemble.install(into)
  for name, method in pairs(methods) do into[name] = method end
end

return assemble
