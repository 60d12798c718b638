-- suggest.lua -- which solver suits a run, and why: rules over facts that core.look finds in well under a millisecond
-- for small systems (framework/model/suggest.h). The thresholds are measured; docs/choosing.md says how.
local check = require "ambit.check"
local core = require "ambit.core"
local option = require "ambit.option"

local suggest = {}

local STIFF_PER_STEP = 100 -- e-folds of the fastest decay in one step of an ordinary stiff method
local STIFF_IN_ALL = 1000  -- and over the run: below, a series solver needs a few hundred steps at most
local BEND = 1e-4          -- part of a state's size by which one datum bends the solution away from a linear map
local MANY = 5             -- data ...
local LARGE = 12           -- ... or states from which on polynomials without generators are too large, and linear maps
local BENT = 1e-7          -- with so much bend, or width where the bend was not seen, lose what the data share
local LOOPS = 0.015        -- width of data up to which closed loops are as good without their constraints at each step
local SEEN = 0.5           -- part of the run up to which ordinary runs must come to tell the bend

-- In order; each names its solver and says why, or nil.
local rules = {
  { "valencia", function(f)
    return f.kink and ("the solution crosses the kink of `%s`, and Taylor series need smooth equations"):format(f.kink)
  end },
  { "stiff", function(f) -- it needs derivatives of the equations
    local per_step = f.decay / math.max(f.steps, 1)
    return f.kinks == 0 and per_step > STIFF_PER_STEP and f.decay > STIFF_IN_ALL and
      ("stiff: the fastest motion decays by a factor of e %.2g times, where %d steps follow the solution"):format(
        f.decay, f.steps)
  end },
  { "zonotope", function(f)
    local bent = f.bend > BENT or f.seen < SEEN and f.width > BENT
    if f.unknowns == 0 and f.states >= 2 * LARGE and f.seen < SEEN then
      return ("%d states with large equations"):format(f.states)
    end
    if f.invariants > 0 and f.width > LOOPS then return nil end
    return bent and (f.unknowns >= MANY or f.unknowns > 0 and f.states >= LARGE) and
      ("%d uncertain data and %d states: what they have in common is kept"):format(f.unknowns, f.states)
  end },
  { "taylor_model", function(f)
    return f.bend > BEND * f.unknowns ^ 2 and f.invariants == 0 and -- polynomials grow with the number of data
      ("wide data: they spread the solution by %.2g %% of its size and bend it by %.2g %%, which a linear map does \z
        not follow"):format(100 * f.spread, 100 * f.bend)
  end },
  { "lohner", function(f)
    if f.invariants > 0 then return "closed loops: it narrows the enclosure by their constraints at each step" end
    if f.unknowns == 0 then return "not stiff, and no uncertain data" end
    return "not stiff, and the solution is close to linear in the uncertain data"
  end },
}

local function installed()
  local list = {}
  for _, entry in ipairs(core.list()) do
    if entry.kind == "solver" then list[entry.name] = true end
  end
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
  local there, names, fitting = installed(), {}, {}
  for _, rule in ipairs(rules) do
    if there[rule[1]] then names[#names + 1] = rule[1] end
  end
  if #names == 0 then check.fail("%s: no solver is installed that proves its results", what) end
  for _, name in ipairs(names) do
    local declaration = (#keys > 0 or arithmetic) and option.declaration("solver", name)
    if not declaration or (knows(declaration, keys) and works_with(declaration, arithmetic)) then
      fitting[#fitting + 1] = name
      fitting[name] = true
    end
  end
  if #fitting > 0 then return fitting end
  if #keys > 0 then refuse(keys, others, names, what) end
  check.fail("%s: none of the solvers %s works with arithmetic `%s`; name the solver", what, table.concat(names, ", "),
    arithmetic)
end

-- q: system, initial, times of a request; fitting: of candidates() -> { solver, reason, facts }
function suggest.solver(q, fitting)
  local facts, problem = core.look(q.system.system, "", nil, {}, {}, q.initial, q.times)
  local last = fitting.lohner and "lohner" or fitting[#fitting]
  if not facts then return { solver = last, reason = problem } end -- the run itself will say so
  for _, rule in ipairs(rules) do
    local reason = fitting[rule[1]] and rule[2](facts)
    if reason then return { solver = rule[1], reason = reason, facts = facts } end
  end
  return { solver = last, reason = "the only one that fits the given options and arithmetic", facts = facts }
end

-- The arithmetic that a solver takes unless another is named.
function suggest.arithmetic(solver)
  return (option.declaration("solver", solver).arithmetics or "interval"):match "%S+"
end

-- For a request that named its solver: what would have been chosen without.
function suggest.advice(q)
  return suggest.solver(q, suggest.candidates({}, {}, nil, "simulate"))
end

return suggest
