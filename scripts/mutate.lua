-- mutate.lua -- are the tests worth their name? Makes single lines wrong on which proofs rest, one at a time, in a copy
-- of the tree, and counts how many the tests notice.
--
--   lua5.4 scripts/mutate.lua [--count N] [--seed N] [--area NAME] [--place DIR] [--results FILE]
--
-- N mutations (300) are drawn from all that are possible, spread over the areas and the operators. What has been tried
-- stands in FILE (docs/results/mutations.txt) and is not tried again, so that a run can be interrupted and go on; remove
-- the file to try everything anew. A mutation that survives must be explained in scripts/mutate/explained.lua: it changes no answer, or only makes a set
-- wider or a run slower. The exit code is 3 if one is not.
package.path = "./scripts/?.lua;" .. package.path
local areas = require "mutate.areas"
local explained = require "mutate.explained"
local known_before = require "mutate.known"
local source = require "mutate.source"
local trial = require "mutate.trial"

local settings = { count = 300, seed = 1, place = "build/mutate/tree", results = "docs/results/mutations.txt" }

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
end

local function tracked()
  local list = {}
  local pipe = assert(io.popen "git ls-files")
  for file in pipe:lines() do list[#list + 1] = file end
  pipe:close()
  return list
end

local function mutations_of(area, files)
  local list = {}
  for _, file in ipairs(files) do
    for _, pattern in ipairs(area.files) do
      local stem, words, ending = pattern:match "^(.-)(%b())(.*)$"
      for word in words:sub(2, -2):gmatch "[^|]+" do
        if file:find(stem .. word .. ending) then
          source.mutations(file, list)
          break
        end
      end
    end
  end
  return list
end

local function shuffle(list)
  for i = #list, 2, -1 do
    local j = math.random(i)
    list[i], list[j] = list[j], list[i]
  end
end

-- n of them, each operator in turn, so that frequent ones do not crowd out the rest.
local function draw(list, n)
  local by, names = {}, {}
  shuffle(list)
  for _, mutation in ipairs(list) do
    local name = mutation.operator
    if not by[name] then by[name], names[#names + 1] = {}, name end
    table.insert(by[name], mutation)
  end
  table.sort(names)
  local drawn, round = {}, 1
  while #drawn < n and round <= #list do
    for _, name in ipairs(names) do
      if #drawn < n and by[name][round] then drawn[#drawn + 1] = by[name][round] end
    end
    round = round + 1
  end
  return drawn
end

-- What was tried before: key -> outcome.
local function results_before()
  local known = {}
  local input = io.open(settings.results)
  if not input then return known end
  for line in input:lines() do
    local outcome, by, key = line:match "^(%a+)\t(.-)\t(.*)$"
    if outcome then known[key] = { outcome, by } end
  end
  input:close()
  return known
end

local function remember(key, outcome, by)
  local output = assert(io.open(settings.results, "a"))
  output:write(outcome, "\t", by or "", "\t", key, "\n")
  output:close()
end

-- What is tried of an area, in order: the mutations that were once not noticed, then a draw of `wanted` and more, since
-- some do not compile.
local function choose(area, files, wanted)
  local candidates = mutations_of(area, files)
  local drawn = draw(candidates, 2 * wanted)
  for _, entry in ipairs(known_before) do
    if entry.area == area.name then table.insert(drawn, 1, source.find(entry)) end
  end
  return drawn, #candidates
end

local function count(area, files, known, is_ready)
  local total = { tried = 0, killed = 0, explained = 0, unbuilt = 0, open = {} }
  local share = 0
  for _, a in ipairs(areas) do share = share + a.share end
  local wanted = math.ceil(settings.count * area.share / share)
  for _, entry in ipairs(known_before) do wanted = wanted + (entry.area == area.name and 1 or 0) end
  local drawn
  drawn, total.possible = choose(area, files, wanted)
  for _, mutation in ipairs(drawn) do
    if total.tried >= wanted then break end
    local found = known[mutation.key]
    if not found then
      if not is_ready[area] then
        local failed = trial.failing(area, settings.place, settings.place .. ".log")
        if failed then error(("the tests of `%s` fail without a mutation: %s"):format(area.name, failed), 0) end
        is_ready[area] = true
      end
      found = { trial.run(area, mutation, settings.place, settings.place .. ".log") }
      remember(mutation.key, found[1], found[2])
      print(("%-9s %s:%d %s %s"):format(found[1], mutation.file, mutation.line, mutation.operator, found[2] or ""))
      print("          " .. mutation.new:match "^%s*(.*)$")
    end
    if found[1] == "unbuilt" then
      total.unbuilt = total.unbuilt + 1
    else
      total.tried = total.tried + 1
      if found[1] == "killed" then
        total.killed = total.killed + 1
      elseif explained[mutation.key] then
        total.explained = total.explained + 1
      else
        total.open[#total.open + 1] = mutation
      end
    end
  end
  return total
end

local function main()
  read_arguments()
  os.execute(("mkdir -p %s"):format(settings.results:match "^(.*)/" or "."))
  local files, known, is_ready, rows, open = tracked(), results_before(), {}, {}, {}
  if settings.place:sub(1, 1) ~= "/" then settings.place = os.getenv "PWD" .. "/" .. settings.place end
  io.stdout:setvbuf "line"
  trial.prepare(settings.place)
  for k, area in ipairs(areas) do
    math.randomseed(settings.seed, k)
    if not settings.area or settings.area == area.name then
      local total = count(area, files, known, is_ready)
      rows[#rows + 1] = ("| %s | %d | %d | %d | %d | %d |"):format(area.name, total.possible, total.tried, total.killed,
        total.explained, #total.open)
      table.move(total.open, 1, #total.open, #open + 1, open)
    end
  end
  print "| area | possible | tried | killed | explained | open |\n|---|---|---|---|---|---|"
  for _, row in ipairs(rows) do print(row) end
  for _, mutation in ipairs(open) do print("open: " .. mutation.key .. "  ->  " .. mutation.new:match "^%s*(.*)$") end
  os.exit(#open > 0 and 3 or 0)
end

main()
