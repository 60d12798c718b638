-- reduce/candidate_merge.lua -- variables that are similar along all references: one is replaced by the other, its
-- equation is dropped, and outputs refer to the survivor.
--
-- Similar: they differ by less than a tenth of what they move, in the same unit. Of the two ways to merge a pair the
-- one with the smaller error along the first reference is a candidate. Each state has one candidate at most, and none
-- leads in a circle: any choice of them can be made at once.
local core = require "ambit.core"
local model = require "ambit.reduce.model"
local reference = require "ambit.reduce.reference"

local merge = {}

local SIMILAR = 0.1

-- Greatest difference of two columns of the references, in parts of how far the two range.
local function distance(tables, i, j)
  local apart, least, most = 0, math.huge, -math.huge
  for _, rows in ipairs(tables) do
    for _, row in ipairs(rows) do
      apart = math.max(apart, math.abs(row[i] - row[j]))
      least, most = math.min(least, row[i], row[j]), math.max(most, row[i], row[j])
    end
  end
  return most > least and apart / (most - least) or apart == apart and 0 or math.huge
end

-- Pairs of states that are similar, the most similar first: { i, j, distance }.
local function pairs_of(m, references, stays)
  local tables, list = {}, {}
  for k, r in ipairs(references) do tables[k] = reference.values(r, m.symbols) end
  for i = 1, #m.states do
    for j = i + 1, #m.states do
      local d = m.units[i] == m.units[j] and distance(tables, i, j) or math.huge
      local free = not (stays[m.states[i]] and stays[m.states[j]])
      if d <= SIMILAR and free then list[#list + 1] = { i, j, d } end
    end
  end
  table.sort(list, function(a, b)
    if a[3] ~= b[3] then return a[3] < b[3] end
    if a[1] ~= b[1] then return a[1] < b[1] end
    return a[2] < b[2]
  end)
  return list
end

-- The greatest error of an output in parts of its bound when state i is replaced by j, along one reference.
local function error_of(job, m, i, j)
  local merged = model.live(model.merged(m, { [i] = true }, { m.symbols[i] }, { m.symbols[j] }), job.stays)
  local r = reference.again(job.references[1], merged, job.scenarios, job.apply)
  if not r then return math.huge end
  local detailed, reduced, worst = {}, {}, 0
  for k, output in ipairs(job.detailed.outputs) do
    detailed[k], reduced[k] = output.expression, merged.outputs[k].expression
  end
  local a, b = reference.values(job.references[1], detailed), reference.values(r, reduced)
  for n, row in ipairs(a) do
    for k, y in ipairs(row) do worst = math.max(worst, math.abs(y - b[n][k]) / job.bounds[k]) end
  end
  return worst
end

-- { i, j } with state i to be replaced by j.
local function chosen(job, m, i, j)
  if job.stays[m.states[i]] then return j, i end
  if job.stays[m.states[j]] then return i, j end
  if error_of(job, m, j, i) < error_of(job, m, i, j) then return j, i end
  return i, j
end

-- Where a state ends up.
local function survivor(into, i)
  while into[i] do i = into[i] end
  return i
end

-- One merger for each state at most, without circles: { { i, j } }.
local function mergers(job, m)
  local into, list = {}, {}
  for _, pair in ipairs(pairs_of(m, job.references, job.stays)) do
    if survivor(into, pair[1]) ~= survivor(into, pair[2]) then
      local i, j = chosen(job, m, pair[1], pair[2])
      if not into[i] then
        into[i] = j
        list[#list + 1] = { i, j }
      end
    end
  end
  return list
end

-- How far apart the rates are, and the states over the whole time: what is wrong at the start is wrong for long.
local function change_of(job, m, i, j)
  local times = job.scenarios[1].times
  return m.rates[j] - m.rates[i] + (m.symbols[j] - m.symbols[i]) / math.abs(times[#times] - times[1])
end

-- Candidates as those of reduce/candidate.lua.
function merge.list(job, m)
  local list, found = mergers(job, m), {}
  for k, pair in ipairs(list) do
    local i, j = pair[1], pair[2]
    found[k] = { equation = m.states[i], level = 0, text = m.states[i], replacement = m.states[j],
      effects = { { i, change_of(job, m, i, j) } } }
  end
  function found.build(cut)
    local from, to, into, gone = {}, {}, {}, {}
    for _, k in ipairs(cut) do into[list[k][1]] = list[k][2] end
    for _, k in ipairs(cut) do
      local i = list[k][1]
      from[#from + 1], to[#to + 1], gone[i] = m.symbols[i], m.symbols[survivor(into, i)], true
    end
    return model.live(model.merged(m, gone, from, to), job.stays)
  end
  return found
end

return merge
