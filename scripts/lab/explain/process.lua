-- explain/process.lua -- what is in the process, and what could be: plugins, shared libraries and the memory they map.
local core = require "ambit.core"

local explain = {}

local function size_of(path)
  local file = path and io.open(path, "rb")
  if not file then return 0 end
  local size = file:seek "end"
  file:close()
  return size or 0
end

-- { { kind, name, loaded, bytes = of its file } }
function explain.plugins()
  local list = {}
  for i, entry in ipairs(core.list()) do
    list[i] = { kind = entry.kind, name = entry.name, loaded = entry.loaded, bytes = size_of(entry.file) }
  end
  return list
end

-- { name = true }: the modules of Ambit's own that have been read
function explain.modules()
  local names = {}
  for name in pairs(package.loaded) do
    if package.preload[name] and name:find "^ambit%." then names[name] = true end
  end
  return names
end

-- How many modules there are.
function explain.module_count()
  local count = 0
  for name in pairs(package.preload) do
    if name:find "^ambit%." and not name:find "^ambit%.command%." then count = count + 1 end
  end
  return count
end

-- The mappings of the process by file: bytes of address space, and of memory that is really there.
local function mappings()
  local by_path, current = {}, nil
  local file = io.open "/proc/self/smaps"
  if not file then return by_path end
  for line in file:lines() do
    local path = line:match "^%x+%-%x+ %S+ %x+ %S+ %d+%s*(.-)%s*$"
    if path then
      current = by_path[path] or { mapped = 0, resident = 0 }
      by_path[path] = current
    else
      local key, kilobytes = line:match "^(%w+):%s+(%d+) kB"
      if key == "Size" then current.mapped = current.mapped + 1024 * math.tointeger(kilobytes) end
      if key == "Rss" then current.resident = current.resident + 1024 * math.tointeger(kilobytes) end
    end
  end
  file:close()
  return by_path
end

-- Where the loader names a library by a link, the mappings name the file behind it: libm.so.6 may be libm.so.6.0.1 in
-- another folder.
local function mapping_of(maps, path_asked, name)
  if maps[path_asked] then return maps[path_asked] end
  local sum = { mapped = 0, resident = 0 }
  for path, map in pairs(maps) do
    if path:match("[^/]*$"):sub(1, #name) == name then
      sum.mapped, sum.resident = sum.mapped + map.mapped, sum.resident + map.resident
    end
  end
  return sum
end

-- { { name, mapped, resident } }: every shared object, by name; what the system puts into every process is no file
function explain.libraries()
  local list, maps = {}, mappings()
  for _, path in ipairs(core.libraries()) do
    local name = path:match "[^/]+$"
    if not name:find "^linux%-" then
      local map = mapping_of(maps, path, name)
      list[#list + 1] = { name = name, mapped = map.mapped, resident = map.resident }
    end
  end
  table.sort(list, function(a, b) return a.name < b.name end)
  return list
end

return explain
