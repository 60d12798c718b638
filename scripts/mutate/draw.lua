-- draw.lua -- which mutations are tried.
--
-- The order of a draw depends on the seed and on what the lines say, and on nothing else: an edit elsewhere leaves it as
-- it is.
local known_before = require "mutate.known"
local source = require "mutate.source"

local draw = {}

function draw.files()
  local list = {}
  local pipe = assert(io.popen "git ls-files")
  for file in pipe:lines() do list[#list + 1] = file end
  pipe:close()
  return list
end

-- Every mutation that is possible in an area.
function draw.possible(area, files)
  local list = {}
  for _, file in ipairs(files) do
    for _, pattern in ipairs(area.files) do
      local stem, words, ending = pattern:match "^(.-)(%b())(.*)$"
      for word in words:sub(2, -2):gmatch "[^|]*" do
        if file:find(stem .. word .. ending) then
          source.mutations(file, list)
          break
        end
      end
    end
  end
  return list
end

-- A number for a text (FNV-1a).
local function hash(text, seed)
  local h = 0xcbf29ce484222325 ~ seed
  for i = 1, #text do h = (h ~ text:byte(i)) * 0x100000001b3 end
  return h ~ h >> 29
end

-- All of them in the order in which they are tried: each operator in turn, so that frequent ones do not crowd out the
-- rest; what has been tried before comes first.
function draw.order(list, seed, known)
  local by, names, seen = {}, {}, {}
  for _, mutation in ipairs(list) do
    if not seen[mutation.key] then
      seen[mutation.key] = true
      local name = mutation.operator
      if not by[name] then by[name], names[#names + 1] = {}, name end
      mutation.at = hash(mutation.key, seed)
      table.insert(by[name], mutation)
    end
  end
  table.sort(names)
  local drawn, round = {}, 1
  for _, name in ipairs(names) do
    table.sort(by[name], function(a, b) return a.at < b.at end)
    for _, mutation in ipairs(by[name]) do
      if known[mutation.key] then drawn[#drawn + 1] = mutation end
    end
  end
  local rest = true
  while rest do
    rest = false
    for _, name in ipairs(names) do
      local mutation = by[name][round]
      rest = rest or mutation
      if mutation and not known[mutation.key] then drawn[#drawn + 1] = mutation end
    end
    round = round + 1
  end
  return drawn
end

-- What is always tried of an area.
function draw.named(area)
  local list = {}
  for _, entry in ipairs(known_before) do
    if entry.area == area.name then list[#list + 1] = source.find(entry) end
  end
  return list
end

return draw
