-- compare/asked.lua -- what a scene asked that can be compared, each question once: a loop over arithmetics or solvers
-- asks the same question several times.
local core = require "ambit.core"
local session = require "ambit.session"

local asked = {}

local function same_list(a, b)
  if #a ~= #b then return false end
  for i, e in ipairs(a) do if e ~= b[i] then return false end end
  return true
end

local function same_evaluation(a, b)
  return same_list(a.expressions, b.expressions) and same_list(a.paths, b.paths) and same_list(a.leaves, b.leaves)
    and same_list(a.values, b.values)
end

-- The one uncertain datum that an expression is, or nil.
local function datum(expression)
  local leaves = core.leaves { expression }
  local leaf = #leaves == 1 and leaves[1]
  if leaf and leaf.kind == "unknown" and leaf.expression == expression then return leaf end
end

-- Equal initial values: the same expressions, or data with the same bounds where those of a are those of b throughout
-- (a text or ambit.between makes a new datum each time that it is evaluated).
local function same_initial(a, b)
  local there, back = {}, {}
  for i, e in ipairs(a) do
    local other = b[i]
    local x, y = datum(e), datum(other)
    if e ~= other then
      if not (x and y and x.lo == y.lo and x.hi == y.hi) then return false end
    end
    if x or y then
      local known, unknown
      for k, pair in ipairs(there) do
        known = known or pair == e and k
        unknown = unknown or back[k] == other and k
      end
      if known ~= unknown then return false end
      if not known then there[#there + 1], back[#back + 1] = e, other end
    end
  end
  return true
end

local function same_events(a, b)
  if (a == nil) ~= (b == nil) then return false end
  if not a then return true end
  if #a ~= #b then return false end
  for i, x in ipairs(a) do
    local y = b[i]
    if x.g ~= y.g or x.name ~= y.name or x.direction ~= y.direction or x.stop ~= y.stop then return false end
  end
  return true
end

local function same_simulation(a, b)
  a, b = a.question, b.question
  return a.system.system == b.system.system and same_list(a.times, b.times) and same_initial(a.initial, b.initial)
    and same_events(a.events, b.events)
end

local function distinct(requests, same)
  local list = {}
  for _, request in ipairs(requests) do
    local known
    for _, other in ipairs(list) do known = known or same(other, request) and other end
    if known then
      known.times = known.times + 1
    else
      request.times = 1
      list[#list + 1] = request
    end
  end
  return list
end

-- From now on the scene's questions are remembered.
function asked.begin() session.asked, session.simulations, session.verbs = {}, {}, {} end

-- The questions since then, evaluations first.
function asked.requests()
  local evaluations, simulations = distinct(session.asked, same_evaluation),
    distinct(session.simulations, same_simulation)
  session.asked, session.simulations = nil, nil
  for _, request in ipairs(evaluations) do request.verb = "evaluate" end
  for _, request in ipairs(simulations) do request.verb = "simulate" end
  return table.move(simulations, 1, #simulations, #evaluations + 1, evaluations)
end

-- "equilibria (1), sample (2)": the verbs of the scene that are not compared; nil: there are none.
function asked.others()
  local count, names = {}, {}
  for _, entry in ipairs(session.verbs) do
    local verb = entry.verb
    if verb ~= "evaluate" and verb ~= "simulate" and verb ~= "compare" then
      if not count[verb] then names[#names + 1] = verb end
      count[verb] = (count[verb] or 0) + 1
    end
  end
  for i, name in ipairs(names) do names[i] = ("%s (%d)"):format(name, count[name]) end
  return #names > 0 and table.concat(names, ", ") or nil
end

return asked
