-- profile/sums.lua -- what the frames of a profile add up to: stages, calls, opcodes, equations. Each sum is over the
-- frames' own times, so that parts never count twice and stages make the whole.
local core = require "ambit.core"

local sums = {}

local WAITING = "waiting for threads"

-- frame.total: own time and that of all frames inside; frames by falling total; the cost of measuring, all in all
local function add_up(frame)
  local total, cost = frame.self, frame.cost
  for _, inner in ipairs(frame.frames) do
    local t, c = add_up(inner)
    total, cost = total + t, cost + c
  end
  table.sort(frame.frames, function(a, b)
    if a.total ~= b.total then return a.total > b.total end
    return a.kind .. a.name < b.kind .. b.name
  end)
  frame.total, frame.cost_total = total, cost
  return total, cost
end

-- Entries { name, ..., self } by name, in order of falling time.
local function collector()
  local list, by_name = {}, {}
  local function entry(key, fields)
    local found = by_name[key]
    if not found then
      fields.self, fields.total, fields.count = 0, 0, 0
      found, by_name[key] = fields, fields
      list[#list + 1] = found
    end
    return found
  end
  local function sorted()
    table.sort(list, function(a, b)
      if a.self ~= b.self then return a.self > b.self end
      return a.name < b.name
    end)
    return list
  end
  return entry, sorted
end

-- The stage that a frame belongs to, inside a frame of stage `outer`.
local function stage_of(frame, outer)
  if frame.kind == "script" then return "script" end
  if frame.kind == "thread" then return frame.name == WAITING and WAITING or outer end
  if frame.kind == "stage" then return frame.name end
  if frame.kind == "load" then return "load" end
  if frame.kind == "verb" then return "verb" end
  if frame.kind == "core" and (outer == "script" or outer == "model") then return "model" end
  return outer
end

local about_stage = {
  script = "Lua itself", model = "elements and expressions of the script", load = "plugins found and loaded",
  verb = "requests and results between Lua and the kernel", graph = "values put in, derivatives",
  tape = "sealing of tapes", context = "opening of arithmetics", open = "opening of solvers",
  run = "the computation itself", split = "pieces put together", records = "results handed on as they come",
  proof = "proofs of reductions", [WAITING] = "this thread, while others work",
}

local function walk_stages(frame, outer, entry)
  local stage = stage_of(frame, outer)
  local sum = entry(stage, { name = stage, about = about_stage[stage] })
  sum.self, sum.count = sum.self + frame.self, sum.count + frame.count
  for _, inner in ipairs(frame.frames) do walk_stages(inner, frame.kind == "thread" and outer or stage, entry) end
end

-- Solvers, arithmetics, services, elements, plugins, functions: own time, and total of the outermost frames of each.
local function walk_calls(frame, inside, entry)
  local key = frame.kind .. " " .. frame.name
  if frame.kind ~= "operation" and frame.kind ~= "script" then
    local sum = entry(key, { kind = frame.kind, name = frame.name })
    sum.self, sum.count = sum.self + frame.self, sum.count + frame.count
    if not inside[key] then sum.total = sum.total + frame.total end
  end
  local again = inside[key]
  inside[key] = true
  for _, inner in ipairs(frame.frames) do walk_calls(inner, inside, entry) end
  inside[key] = again
end

-- "interval MUL" -> "mul"; the arithmetic, if it is named
local function opcode_of(name)
  return (name:match "(%S+)$" or name):lower(), name:match "^(.+) %S+$"
end

-- An opcode has the time of everything inside: a sine's product belongs to the sine.
local function walk_operations(frame, entry)
  if frame.kind == "operation" then
    local op = opcode_of(frame.name)
    local sum = entry(op, { name = op })
    sum.self, sum.count = sum.self + frame.total, sum.count + frame.count
    return
  end
  for _, inner in ipairs(frame.frames) do walk_operations(inner, entry) end
end

-- -- equations

local function each_frame(frame, f)
  f(frame)
  for _, inner in ipairs(frame.frames) do each_frame(inner, f) end
end

-- { op = seconds } below a verb; and their sum
local function measured(verb)
  local entry, sorted = collector()
  walk_operations(verb, entry)
  local seconds, sum = {}, 0
  for _, op in ipairs(sorted()) do
    seconds[op.name] = op.self
    sum = sum + op.self
  end
  return seconds, sum
end

-- How many instructions of each opcode there are in all tapes of a verb.
local function population(tables, names)
  local count = {}
  for _, t in ipairs(tables) do
    for _, row in ipairs(t.rows) do
      for k, name in ipairs(names) do count[name] = (count[name] or 0) + row[#names + k] end
    end
  end
  return count
end

-- Seconds that `count` instructions of each opcode cost, counted from column `from` of a row.
local function price(row, from, names, each)
  local seconds = 0
  for k, name in ipairs(names) do
    if row[from + k] > 0 then seconds = seconds + row[from + k] * (each[name] or 0) end
  end
  return seconds
end

local function shared_with(t, i, first)
  local list = {}
  for k, other in ipairs(t.rows) do
    local common = t.rows[i][first + k]
    if k ~= i and common > 0 then list[#list + 1] = { name = other.name, instructions = common } end
  end
  table.sort(list, function(a, b)
    if a.instructions ~= b.instructions then return a.instructions > b.instructions end
    return a.name < b.name
  end)
  return list
end

local function equations_of(verb, tables)
  local names = {}
  for k, name in ipairs(core.opcodes) do names[k] = name:lower() end
  local seconds, sum = measured(verb)
  local count, each = population(tables, names), {}
  for name, n in pairs(count) do each[name] = n > 0 and (seconds[name] or 0) / n or 0 end
  local all = {}
  for _, t in ipairs(tables) do
    for i, row in ipairs(t.rows) do
      local own, part = price(row, 0, names, each), price(row, #names, names, each)
      all[#all + 1] = { tape = t.title, name = row.name, own = own, shared = math.max(0, part - own), self = part,
        with = shared_with(t, i, 2 * #names) }
    end
  end
  return { name = verb.name, total = verb.total, operations = sum, equations = all }
end

-- Tapes of the same title and equations, of calls at the same place, are one.
local function add_table(tables, t)
  for _, known in ipairs(tables) do
    local same = known.title == t.title and #known.rows == #t.rows
    for i, row in ipairs(t.rows) do same = same and row.name == known.rows[i].name end
    if same then
      for i, row in ipairs(t.rows) do
        for k, value in ipairs(row) do known.rows[i][k] = known.rows[i][k] + value end
      end
      return
    end
  end
  tables[#tables + 1] = t
end

local function equations(root)
  local list = {}
  each_frame(root, function(verb)
    if verb.kind ~= "verb" then return end
    local tables = {}
    each_frame(verb, function(frame)
      for _, t in ipairs(frame.tables) do add_table(tables, t) end
    end)
    table.sort(tables, function(a, b) return a.title > b.title end) -- the right-hand side before its Jacobian
    if tables[1] then list[#list + 1] = equations_of(verb, tables) end
  end)
  table.sort(list, function(a, b)
    if a.total ~= b.total then return a.total > b.total end
    return a.name < b.name
  end)
  return list
end

-- of(root) -> { total, cost, waiting, others, stages, calls, operations, verbs }; others: what threads of pools did;
-- every frame gets its `total`
function sums.of(root)
  local total, cost = add_up(root)
  local stage, stages = collector()
  walk_stages(root, "script", stage)
  local call, calls = collector()
  walk_calls(root, {}, call)
  local operation, operations = collector()
  walk_operations(root, operation)
  local verbs, waiting, others = equations(root), 0, 0
  each_frame(root, function(frame)
    frame.tables = nil
    local item, waits = 0, false
    for _, inner in ipairs(frame.frames) do
      if inner.name == WAITING then
        waiting, waits = waiting + inner.self, true
      elseif inner.kind == "thread" then
        item = item + inner.total + inner.cost_total
      end
    end
    if waits then others = others + item end -- without workers, items are done by the thread itself
  end)
  return { total = total, cost = cost, waiting = waiting, others = others, stages = stages(), calls = calls(),
    operations = operations(), verbs = verbs }
end

return sums
