-- foreign.lua -- Lua modules of others (lxp, readline, busted): looked for where they are installed, not in the current
-- folder, which is where a scene or a robot's file happens to lie. The stock search paths name it.
local foreign = {}

-- The templates of a search path that begin at the root of the file system.
local function absolute(path)
  local list = {}
  for template in path:gmatch "[^;]+" do
    if template:sub(1, 1) == "/" then list[#list + 1] = template end
  end
  return table.concat(list, ";")
end

-- The module, or nil if it is not installed. One that is loaded already, or that the host offers itself (preload), is
-- taken as it is.
function foreign.find(name)
  local path, cpath = package.path, package.cpath
  package.path, package.cpath = absolute(path), absolute(cpath)
  local found, module = pcall(require, name)
  package.path, package.cpath = path, cpath
  return found and module or nil
end

return foreign
