-- check.lua -- fails if a scene of the budget needs more than the budget says:
--   lua5.4 tests/budget/check.lua AMBIT [--rewrite] [BUDGET.lua]
-- from the root of the tree. --rewrite: the budget becomes what is needed now (`ninja budget` in a build does that).
-- AMBIT_BUDGET_MEMORY=0: memory is not looked at (sanitizers need more).
package.path = "tests/budget/?.lua;" .. package.path
local compare = require "compare"
local measure = require "measure"

local ambit = assert(arg[1], "usage: check.lua AMBIT [--rewrite] [BUDGET.lua]")
local rewrite = arg[2] == "--rewrite"
local path = arg[rewrite and 3 or 2] or "tests/budget/budget.lua"
local budget = dofile(path)
local memory = os.getenv "AMBIT_BUDGET_MEMORY" ~= "0"

local SPARE = 1.25 -- of memory, over what was seen

local function entry_text(entry, m)
  local lines = { ("  {\n    scene = %q,"):format(entry.scene) }
  for _, key in ipairs(measure.counts) do lines[#lines + 1] = ("    %s = %d,"):format(key, m[key]) end
  lines[#lines + 1] = ("    megabytes = %s,"):format(entry.fixed and ("%g, fixed = true"):format(entry.megabytes) or
    ("%d"):format(math.ceil(m.megabytes * SPARE)))
  if entry.without then
    local patterns = {}
    for i, pattern in ipairs(entry.without) do patterns[i] = ("%q"):format(pattern) end
    lines[#lines + 1] = ("    without = { %s },"):format(table.concat(patterns, ", "))
  end
  lines[#lines + 1] = "  },"
  return table.concat(lines, "\n")
end

local function header()
  local lines = {}
  for line in io.lines(path) do
    if line:sub(1, 2) ~= "--" then break end
    lines[#lines + 1] = line
  end
  return table.concat(lines, "\n")
end

-- Memory once more, where it was too much: the system maps more or less of what files hold around a page that is read,
-- up to 1 MB of it, and what a scene needs is the least.
local function least_memory(entry, m)
  for _ = 1, memory and 2 or 0 do
    if m.megabytes <= entry.megabytes then break end
    local again = measure.scene(ambit, entry.scene)
    m.megabytes = math.min(m.megabytes, again and again.megabytes or math.huge)
  end
end

local parts, failed, smaller = { header(), "return {" }, 0, 0
for _, entry in ipairs(budget) do
  local m, problem = measure.scene(ambit, entry.scene)
  if not m then
    failed = failed + 1
    print(("%s: %s"):format(entry.scene, problem))
  elseif rewrite then
    parts[#parts + 1] = entry_text(entry, m)
  else
    least_memory(entry, m)
    local grown, shrunk = compare.scene(entry.scene, entry, m, memory)
    for _, line in ipairs(grown) do print(line) end
    for _, line in ipairs(shrunk) do print(line) end
    failed, smaller = failed + (#grown > 0 and 1 or 0), smaller + #shrunk
  end
end
if rewrite and failed == 0 then
  parts[#parts + 1] = "}"
  local file = assert(io.open(path, "w"))
  file:write(table.concat(parts, "\n"), "\n")
  file:close()
end
if smaller > 0 then print "something shrank: the target `budget` of the build writes the tighter budget" end
if failed > 0 then
  print "something grew: if it has to, the target `budget` of the build writes the new budget, for review"
end
print(("%d scenes, %d over their budget"):format(#budget, failed))
os.exit(failed == 0 and #budget > 0)
