-- mutations.lua -- how many single-line mistakes the tests notice, as docs/results/mutations.txt has it: what
-- `lua5.4 scripts/mutate.lua` has tried so far in lines that are still there.
package.path = "./scripts/?.lua;" .. package.path
local areas = require "mutate.areas"
local draw = require "mutate.draw"
local explained = require "mutate.explained"
local record = require "mutate.record"

local KINDS = { "killed", "explained", "open" }

local known, files = record.read "docs/results/mutations.txt", draw.files()

local function count(area)
  local n, seen, possible = { killed = 0, explained = 0, open = 0 }, {}, draw.possible(area, files)
  table.move(draw.named(area), 1, #draw.named(area), #possible + 1, possible)
  for _, mutation in ipairs(possible) do
    local found = known[mutation.key]
    if found and found[1] ~= "unbuilt" and not seen[mutation.key] then
      local kind = found[1] == "killed" and "killed" or explained[mutation.key] and "explained" or "open"
      n[kind] = n[kind] + 1
    end
    seen[mutation.key] = true
  end
  return #possible, n
end

print "| area | possible | tried | noticed by a test | explained | open |\n|---|---:|---:|---:|---:|---:|"
local total = { possible = 0, killed = 0, explained = 0, open = 0 }
local function row(name, possible, n)
  print(("| %s | %d | %d | %d | %d | %d |"):format(name, possible, n.killed + n.explained + n.open, n.killed, n.explained,
    n.open))
end
for _, area in ipairs(areas) do
  local possible, n = count(area)
  row(("`%s`"):format(area.name), possible, n)
  total.possible = total.possible + possible
  for _, kind in ipairs(KINDS) do total[kind] = total[kind] + n[kind] end
end
row("all", total.possible, total)
