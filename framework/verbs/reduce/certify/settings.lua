-- reduce/certify/settings.lua -- how proofs are to be made: criterion, solver with its options, arithmetic, threads,
-- split.
local check = require "ambit.check"
local couple = require "ambit.reduce.certify.couple"
local option = require "ambit.option"
local simulate = require "ambit.simulate"
local split = require "ambit.split"
local suggest = require "ambit.simulate.suggest"

local settings = {}

settings.keys = { "criterion", "solver", "arithmetic", "threads", "split", "nodes", "refine" }

local criteria = { "difference", "bounds" }
local WIDEST = "1e9" -- scenarios may be wide: the solver's own limit is for sets that should be narrow
local NODES = 100    -- instants at which `bounds` and the error over time are looked at

local function criterion_of(value, what)
  if value == nil then return "difference" end
  for _, name in ipairs(criteria) do
    if value == name then return name end
  end
  check.fail("%s: criterion: there is no `%s`%s", what, tostring(value), check.suggest(value, criteria))
end

-- The keys of t that are the verb's own (own) or say how to prove; those of the solver follow in settings.choose.
-- -> { criterion, solver or nil, arithmetic, arithmetic_options, nodes, refine, run_options = { threads }, memory: what
-- proofs with the same settings have in common }
function settings.read(t, own, what, positional)
  local how = { criterion = criterion_of(t.criterion, what), arithmetic_options = {}, options = {}, own = own,
    positional = positional, what = what, memory = {} }
  if t.arithmetic ~= nil then
    how.arithmetic, how.arithmetic_options = option.arithmetic(t.arithmetic, what .. ": arithmetic")
  end
  if t.solver ~= nil then how.solver = check.text(t.solver, what .. ": solver") end
  how.nodes = t.nodes == nil and NODES or check.count(t.nodes, what .. ": nodes")
  how.refine = t.refine ~= nil and t.refine ~= 0 and check.count(t.refine, what .. ": refine") or 0
  how.run_options = { threads = simulate.threads(t, what) }
  return how
end

-- Those of some solvers that prove their results; loads all of them.
function settings.rigorous(solvers)
  local list = {}
  for _, name in ipairs(solvers) do
    if option.declaration("solver", name).rigorous then list[#list + 1] = name end
  end
  return list
end

-- The solver that suits, and the others, the next best ones first.
local function suggested(detailed, s)
  local fitting = suggest.candidates({}, {}, nil, "certify")
  local best = suggest.proving(suggest.solver(couple.alone(detailed, s), fitting, "certify"))
  local others, known = {}, { [best.solver] = true }
  local function add(solver)
    if not known[solver] then others[#others + 1] = solver end
    known[solver] = true
  end
  for _, other in ipairs(best.others) do add(other.solver) end
  for _, solver in ipairs(fitting) do add(solver) end -- where ordinary runs told nothing
  return best.solver, others
end

local function check_options(t, how)
  local declaration, known = option.declaration("solver", how.solver), {}
  if not declaration.rigorous then check.fail("%s: solver `%s` proves nothing", how.what, how.solver) end
  for _, list in ipairs { how.own, settings.keys, option.names(declaration) } do
    table.move(list, 1, #list, #known + 1, known)
  end
  check.keys(t, known, ("%s with solver %s"):format(how.what, how.solver), how.positional)
  local others = {} -- `outputs` and `nodes` are the verb's, although solvers have options of these names
  for key, value in pairs(t) do others[key] = value end
  for _, own in ipairs { how.own, settings.keys } do
    for _, key in ipairs(own) do others[key] = nil end
  end
  how.options, how.shown = option.collect(others, declaration)
  how.given = #how.options
  for _, name in ipairs(option.names(declaration)) do
    if name == "width_max" and t.width_max == nil then
      how.options[#how.options + 1], how.options[#how.options + 2] = name, WIDEST
    end
  end
end

-- Names of states and parameters mean their data in each scenario.
local function read_split(t, detailed, s, what)
  local initial, parameters = {}, {}
  for i, name in ipairs(detailed.states) do initial[i] = s.initial[name] end
  for name, value in pairs(detailed.parameters) do parameters[name] = value end
  for key, value in pairs(s.by_key) do
    if type(key) == "string" then parameters[key] = value end
  end
  local system = { states = detailed.states, parameters = parameters }
  return split.read(t.split, { system = system, initial = initial }, what .. ": split")
end

-- The solver (if none is named) and its options; how the data of each scenario are cut.
function settings.choose(how, t, detailed, scenarios)
  local others
  if not how.solver then how.solver, others = suggested(detailed, scenarios[1]) end
  check_options(t, how)
  local is_plain = not how.arithmetic and (how.given or 0) == 0 -- others may not know its options
  how.others = is_plain and others or {}
  for _, s in ipairs(scenarios) do s.split = read_split(t, detailed, s, how.what) end
  return how
end

return settings
