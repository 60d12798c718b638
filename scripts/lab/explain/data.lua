-- explain/data.lua -- the data of a scene: which are uncertain and became variables of a verb, which are fixed.
--
-- An unknown is one uncertain number of the graph. Data are the numbers that parts, equations and initial values were
-- given; one unknown may stand in several of them, and a part may make unknowns of its own (the play of a joint).
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"

local explain = {}

local axes = { "x", "y", "z" }

-- "" for one number, ".x" for vectors, "[4]" for longer lists
local function component(i, n)
  if n == 1 then return "" end
  return n == 3 and "." .. axes[i] or ("[%d]"):format(i)
end

-- A flag, an axis, an integer or one of some words chooses the formulas; it is no datum.
local function is_number(param) return param.shape == "" or param.shape:find "^%d" ~= nil end

-- fixed: a number, or an uncertain datum of no width, which is one; uncertain; varying: with time or state
local function kind_of(expression)
  if core.is_constant(expression) then return "fixed", {} end
  local leaves = core.leaves { expression }
  for _, leaf in ipairs(leaves) do
    if leaf.kind ~= "unknown" then return "varying", {} end
  end
  return "uncertain", leaves
end

-- Models that a verb derives from others (by reduction) have data of the same names: these count once. What depends on
-- one uncertain datum is called as this is everywhere.
local function add(found, label, expression)
  local kind, leaves = kind_of(expression)
  local name = #leaves == 1 and core.leaf_names({ leaves[1].expression })[1]
  if name and not found.seen[name] then label = name end
  if found.seen[label] then return end
  found.seen[label] = true
  local datum = { label = label, kind = kind, unknowns = {}, verbs = {} }
  found[#found + 1] = datum
  for i, leaf in ipairs(leaves) do
    datum.unknowns[i] = leaf.number
    found.of[leaf.number] = found.of[leaf.number] or datum
  end
  if kind == "uncertain" then
    local good, range = pcall(core.evaluate, { expressions = { expression } })
    datum.range = good and range[1] or nil
  end
end

local function add_parts(found, m, label)
  for part = 1, core.part_count(m.handle) - 1 do
    local made, name = element.made(m, part), core.part_name(m.handle, part)
    for i, param in ipairs(m.declared[part] and m.declared[part].parameters or {}) do
      local values = is_number(param) and made and made.values[i] or {}
      for k, e in ipairs(values) do add(found, label .. name .. "." .. param.name .. component(k, #values), e) end
    end
  end
end

local function add_ode(found, ode, label)
  for _, name in ipairs(check.sorted(ode.parameters)) do
    local e = ode.parameters[name]
    if check.kind(e) == "expression" then add(found, label .. name, e) end
  end
end

local function add_initial(found, request)
  for i, name in ipairs(request.system.states) do add(found, "initial " .. name, request.initial[i]) end
end

-- What a verb computed with: the unknowns of its expressions, as far as it was asked directly.
local function expressions_of(request)
  local list = {}
  local function all(more) table.move(more, 1, #more, #list + 1, list) end
  if not request then return list end
  if request.expressions then
    all(request.expressions)
    all(request.values)
  else
    all(request.initial)
    all(request.system.rates)
  end
  return list
end

-- The unknowns of every verb: which datum they are of, how many are of none.
local function add_verbs(found, verbs)
  for number, verb in ipairs(verbs) do
    local named, nameless = 0, 0
    for _, leaf in ipairs(core.leaves(expressions_of(verb.request))) do
      local datum = found.of[leaf.number]
      if leaf.kind == "unknown" and leaf.lo < leaf.hi then
        if datum then
          table.insert(datum.verbs, number)
          named = named + 1
        else
          nameless = nameless + 1
        end
      end
    end
    if verb.request then verb.named, verb.nameless = named, nameless end
  end
end

-- { { label, kind, range, verbs = numbers of those that needed it } } with counts = { fixed =, uncertain =, varying =
-- }; each verb is told how many of its unknowns are `named` data and how many `nameless` ones.
function explain.collect(mechanisms, odes, verbs)
  local found = { of = {}, seen = {} }
  for _, m in ipairs(mechanisms) do add_parts(found, m, #mechanisms > 1 and m.name .. ": " or "") end
  for _, ode in ipairs(odes) do
    if not ode.mechanism then add_ode(found, ode, #odes > 1 and ode.name .. ": " or "") end
  end
  for _, verb in ipairs(verbs) do
    if verb.request and verb.request.system then add_initial(found, verb.request) end
  end
  add_verbs(found, verbs)
  found.counts = { fixed = 0, uncertain = 0, varying = 0 }
  for _, datum in ipairs(found) do found.counts[datum.kind] = found.counts[datum.kind] + 1 end
  return found
end

return explain
