-- check.lua -- fails if a problem takes more work than tests/work/counts.lua says, by more than 1 %:
--   ambit run tests/work/check.lua [rewrite]
-- from the root of the tree. rewrite: the file becomes what is counted now (`ninja work` in a build does that).
local compare = dofile "tests/work/compare.lua"
local measure = dofile "tests/work/measure.lua"
local problems = dofile "tests/work/problems.lua"

local path = "tests/work/counts.lua"
local rewrite = arg[1] == "rewrite"
local pinned = not rewrite and dofile(path) or {}

local head = [[
-- counts.lua -- the work that the problems of tests/work/problems.lua take, counted; zeros are left out. check.lua
-- compares; the target `work` of a build writes this file anew.
return {]]

local function entry_text(name, found)
  local lines = { ("  [%q] = {"):format(name) }
  for _, count in ipairs(measure.counts) do
    if found[count] ~= 0 then lines[#lines + 1] = ("    %s = %d,"):format(count, found[count]) end
  end
  lines[#lines + 1] = "  },"
  return table.concat(lines, "\n")
end

local text, failed, smaller, known = { head }, 0, 0, {}
for _, problem in ipairs(problems) do
  local found = measure.one(problem.run)
  local grown, shrunk = compare.of(problem.name, pinned[problem.name], found, measure.counts)
  known[problem.name] = true
  text[#text + 1] = entry_text(problem.name, found)
  if not rewrite then
    for _, line in ipairs(grown) do print(line) end
    for _, line in ipairs(shrunk) do print(line) end
    failed, smaller = failed + #grown, smaller + #shrunk
  end
end
for name in pairs(pinned) do
  if not known[name] then
    print(name .. ": is in the file, but no problem any more")
    failed = failed + 1
  end
end

if rewrite then
  text[#text + 1] = "}"
  local file = assert(io.open(path, "w"))
  file:write(table.concat(text, "\n"), "\n")
  assert(file:close())
end
if smaller > 0 then print "something shrank: the target `work` of the build writes the new counts" end
if failed > 0 then print "something grew: if it has to, the target `work` of the build writes the new counts" end
print(("%d problems, %d counts that grew, %d that shrank"):format(#problems, failed, smaller))
if failed > 0 then os.exit(1, true) end
