-- simulate/suggest.lua -- which solver suits a run, and why. Each solver says so itself: beside NAME.so lies NAME.lua,
-- a function of the facts that core.look finds in well under a millisecond for small systems
-- (framework/verbs/simulate/suggest.h). It returns a score from 0 to 1 and a reason, or nil where the solver cannot be
-- used; docs/plugins.md has the scale. No solver is loaded to be asked.
local check = require "ambit.check"
local core = require "ambit.core"
local flow = require "ambit.run.flow"
local option = require "ambit.option"

local suggest = {}

local TRIED = 0.15 -- score from which on a solver is tried where better ones failed

local known = {} -- rules by file, read once; false: there is none

-- The rule of the solver whose shared library is `file`, or nil. It sees numbers and texts only, and as one of Ambit's
-- own modules (by the name of its chunk) methods of strings that a scene cannot change.
local function rule_of(file)
  local path = file:gsub("%.so$", "") .. ".lua"
  if known[path] ~= nil then return known[path] or nil end
  known[path] = false
  local source = io.open(path)
  if not source then return nil end
  local text = source:read "a"
  source:close()
  local problem = core.distrusted(path)
  if problem then check.fail("%s: %s", path, problem) end
  local chunk, wrong = load(text, "=(ambit) " .. path, "t", { math = math })
  if not chunk then check.fail("%s", wrong) end
  local suits = chunk()
  if type(suits) ~= "function" then check.fail("%s: expected a file that returns a function of the facts", path) end
  known[path] = suits
  return suits
end

-- { name, suits } of each installed solver that says when it suits, in alphabetic order.
local function rules()
  local list = {}
  for _, entry in ipairs(core.list()) do
    local suits = entry.kind == "solver" and rule_of(entry.file)
    if suits and not list[entry.name] then
      list[#list + 1] = { name = entry.name, suits = suits }
      list[entry.name] = suits
    end
  end
  table.sort(list, function(a, b) return a.name < b.name end)
  return list
end

local function knows(declaration, keys)
  local known = {}
  for _, name in ipairs(option.names(declaration)) do known[name] = true end
  for _, key in ipairs(keys) do
    if not known[key] then return false end
  end
  return true
end

local function works_with(declaration, arithmetic)
  if not arithmetic or not declaration.arithmetics then return true end
  return (" " .. declaration.arithmetics .. " "):find(" " .. arithmetic .. " ", 1, true) ~= nil
end

-- What is wrong with options of which no candidate knows all; others: keys that are no options.
local function refuse(keys, others, names, what)
  local owners, union = {}, table.move(others, 1, #others, 1, {})
  for _, name in ipairs(names) do
    for _, key in ipairs(option.names(option.declaration("solver", name))) do
      if not owners[key] then union[#union + 1] = key end
      owners[key] = owners[key] and owners[key] .. ", " .. name or name
    end
  end
  local said = {}
  for i, key in ipairs(keys) do
    if not owners[key] then check.fail("%s: unknown key `%s`%s", what, key, check.suggest(key, union)) end
    said[i] = ("`%s` is one of %s"):format(key, owners[key])
  end
  check.fail("%s: no solver has all these options: %s; name the solver", what, table.concat(said, ", "))
end

-- The solvers that are installed, have all options of `keys` and work with the arithmetic (nil: any); plugins are
-- loaded only if there is something to ask them. others: the keys that are no options, for messages.
function suggest.candidates(keys, others, arithmetic, what)
  local names, fitting, list = {}, {}, rules()
  for i, rule in ipairs(list) do names[i] = rule.name end
  if #names == 0 then check.fail("%s: no solver is installed that proves its results", what) end
  for _, name in ipairs(names) do
    local declaration = (#keys > 0 or arithmetic) and option.declaration("solver", name)
    if not declaration or (knows(declaration, keys) and works_with(declaration, arithmetic)) then
      fitting[#fitting + 1] = name
      fitting[name] = list[name]
    end
  end
  if #fitting > 0 then return fitting end
  if #keys > 0 then refuse(keys, others, names, what) end
  check.fail("%s: none of the solvers %s works with arithmetic `%s`; name the solver", what, table.concat(names, ", "),
    arithmetic)
end

-- The fitting solvers that these facts suit, best first: { { solver, reason, score }, ... }.
local function ranked(facts, fitting)
  local list = {}
  for _, name in ipairs(fitting) do
    local score, reason
    if facts.varying == 0 or option.declaration("solver", name).varying then score, reason = fitting[name](facts) end
    if score ~= nil and not (math.type(score) and score >= 0 and score <= 1 and type(reason) == "string") then
      check.fail("solver `%s`: its rule gave %s, %s: expected a score from 0 to 1 and a reason, or nil", name,
        check.shown(score), check.shown(reason))
    end
    if score then list[#list + 1] = { solver = name, reason = reason, score = score } end
  end
  table.sort(list, function(a, b)
    if a.score ~= b.score then return a.score > b.score end
    return a.solver < b.solver
  end)
  return list
end

-- q: system, initial, times of a request; fitting: of candidates(); task: the verb that asks -> { solver, reason,
-- facts, others }: `others` are the next best ones, in order.
function suggest.solver(q, fitting, task)
  local facts, problem = core.look(flow(q, { solver = "" }))
  if facts then facts.task = task end
  if not facts then return { solver = fitting[1], reason = problem, others = {} } end -- the run itself will say so
  local list = ranked(facts, fitting)
  local first, others = list[1], {}
  if not first then return { solver = fitting[1], reason = "none suits", facts = facts, others = others } end
  for i = 2, #list do
    if list[i].score >= TRIED then others[#others + 1] = list[i] end
  end
  local reason = #fitting > 1 and first.reason or "the only one that fits the given options and arithmetic"
  return { solver = first.solver, reason = reason, facts = facts, others = others }
end

-- The suggestion, or the best of its others that proves its results; loads those that are looked at.
function suggest.proving(suggestion)
  local others = suggestion.others
  if option.declaration("solver", suggestion.solver).rigorous or #others == 0 then return suggestion end
  return suggest.proving { solver = others[1].solver, reason = others[1].reason, facts = suggestion.facts,
    others = table.move(others, 2, #others, 1, {}) }
end

-- The arithmetic that a solver takes unless another is named.
function suggest.arithmetic(solver)
  return (option.declaration("solver", solver).arithmetics or core.default.ranges):match "%S+"
end

-- For a request that named its solver: what would have been chosen without.
function suggest.advice(q)
  return suggest.solver(q, suggest.candidates({}, {}, nil, "simulate"), "simulate")
end

return suggest
