-- record.lua -- what has been tried: a file of lines "outcome, test that noticed, key", with tabs between.
--
-- Whatever survived without an explanation is tried again by the next run.
local explained = require "mutate.explained"

local record = {}

-- key -> { outcome, by }; the last line of a key counts.
function record.read(path)
  local known = {}
  local input = io.open(path)
  if not input then return known end
  for line in input:lines() do
    local outcome, by, key = line:match "^(%a+)\t(.-)\t(.*)$"
    if outcome then known[key] = { outcome, by } end
  end
  input:close()
  return known
end

-- Whether the outcome is final.
function record.is_settled(key, found) return found and (found[1] ~= "survived" or explained[key] ~= nil) end

function record.add(path, key, outcome, by)
  local output = assert(io.open(path, "a"))
  output:write(outcome, "\t", by or "", "\t", key, "\n")
  output:close()
end

-- Writes the file anew, sorted, one line a key, without lines that are gone from the source.
function record.rewrite(path, known, exists)
  local lines = {}
  for key, found in pairs(known) do
    if exists[key] then lines[#lines + 1] = ("%s\t%s\t%s\n"):format(found[1], found[2], key) end
  end
  table.sort(lines, function(a, b) return a:match "\t([^\t]*)$" < b:match "\t([^\t]*)$" end)
  local output = assert(io.open(path, "w"))
  output:write(table.concat(lines))
  output:close()
end

return record
