-- mutate.lua -- are the tests worth their name? Makes single lines wrong on which proofs rest, one at a time, in a copy
-- of the tree, and counts how many the tests notice.
--
--   lua5.4 scripts/mutate.lua [--count N] [--seed N] [--area NAME] [--place DIR] [--results FILE]
--
-- N mutations (390) are drawn from all that are possible, spread over the areas and the operators. What has been tried
-- stands in FILE (docs/results/mutations.txt) and is not tried again, so that a run can be interrupted and go on;
-- remove the file to try everything anew. A mutation that survives must be explained in scripts/mutate/explained.lua:
-- it changes no answer, or only makes a set wider or a run slower. The exit code is 3 if one is not; the next run tries
-- it again. scripts/bench/mutations.lua prints the counts.
package.path = "./scripts/?.lua;" .. package.path
local areas = require "mutate.areas"
local draw = require "mutate.draw"
local explained = require "mutate.explained"
local record = require "mutate.record"
local trial = require "mutate.trial"

local settings = { count = 390, seed = 1, place = "build/mutate/tree", results = "docs/results/mutations.txt" }

local function read_arguments()
  local i = 1
  while arg[i] do
    local name = arg[i]:match "^%-%-(%a+)$"
    local value = arg[i + 1]
    if (name == "count" or name == "seed") and math.tointeger(tonumber(value)) then
      settings[name] = math.tointeger(tonumber(value))
    elseif (name == "area" or name == "place" or name == "results") and value then
      settings[name] = value
    else
      io.stderr:write("usage: mutate.lua [--count N] [--seed N] [--area NAME] [--place DIR] [--results FILE]\n")
      os.exit(2)
    end
    i = i + 2
  end
  if settings.place:sub(1, 1) ~= "/" then settings.place = os.getenv "PWD" .. "/" .. settings.place end
end

local function try(area, tests, mutation, known)
  local log = settings.place .. ".log"
  local outcome, by = trial.run(area, tests, mutation, known, settings.place, log)
  known[mutation.key] = { outcome, by or "" }
  record.add(settings.results, mutation.key, outcome, by)
  print(("%-9s %s:%d %s %s"):format(outcome, mutation.file, mutation.line, mutation.operator, by or ""))
  print("          " .. mutation.new:match "^%s*(.*)$")
end

-- How many of the mutations of an area are tried.
local function wanted(area)
  local share = 0
  for _, a in ipairs(areas) do share = share + a.share end
  return math.ceil(settings.count * area.share / share)
end

-- The next mutations to try, file by file: those that survived before, and as many new ones as are wanted still, since
-- some do not build.
local function next_of(drawn, known, count)
  local list = {}
  for _, mutation in ipairs(drawn) do
    local found = known[mutation.key]
    if found and found[1] ~= "unbuilt" then count = count - 1 end
    if found and not record.is_settled(mutation.key, found) and not mutation.tried then list[#list + 1] = mutation end
  end
  for _, mutation in ipairs(drawn) do
    if count > 0 and not known[mutation.key] then list[#list + 1], count = mutation, count - 1 end
  end
  table.sort(list, function(a, b) return a.file < b.file or a.file == b.file and a.line < b.line end)
  return list
end

-- Returns the mutations that survived without an explanation.
local function try_area(area, files, known)
  local drawn = draw.order(draw.possible(area, files), settings.seed, known)
  local named, tests = draw.named(area), nil
  table.move(drawn, 1, #drawn, #named + 1, named)
  local count = wanted(area) + #named - #drawn
  local list = next_of(named, known, count)
  while #list > 0 do
    tests = tests or trial.tests(area, settings.place, settings.place .. ".log")
    for _, mutation in ipairs(list) do
      try(area, tests, mutation, known)
      mutation.tried = true
    end
    list = next_of(named, known, count)
  end
  local open = {}
  for _, mutation in ipairs(named) do
    local found = known[mutation.key]
    if found and found[1] == "survived" and not explained[mutation.key] then open[#open + 1] = mutation end
  end
  return open
end

local function main()
  read_arguments()
  os.execute(("mkdir -p %s %s"):format(settings.results:match "^(.*)/" or ".", settings.place:match "^(.*)/" or "."))
  local files, known, open = draw.files(), record.read(settings.results), {}
  io.stdout:setvbuf "line"
  trial.prepare(settings.place)
  for _, area in ipairs(areas) do
    if not settings.area or settings.area == area.name then
      local list = try_area(area, files, known)
      table.move(list, 1, #list, #open + 1, open)
    end
  end
  local exists = {}
  for _, area in ipairs(areas) do
    for _, mutation in ipairs(draw.possible(area, files)) do exists[mutation.key] = true end
    for _, mutation in ipairs(draw.named(area)) do exists[mutation.key] = true end
  end
  record.rewrite(settings.results, known, exists)
  for _, mutation in ipairs(open) do print("open: " .. mutation.key .. "  ->  " .. mutation.new:match "^%s*(.*)$") end
  os.exit(#open > 0 and 3 or 0)
end

main()
