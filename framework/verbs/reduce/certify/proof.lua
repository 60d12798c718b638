-- reduce/certify/proof.lua -- the proof of a reduced model: a bound of the error of every output, for all data of all
-- scenarios, at all times. docs/numerics/reduction.md.
local bounds = require "ambit.reduce.certify.bounds"
local check = require "ambit.check"
local code = require "ambit.code"
local core = require "ambit.core"
local couple = require "ambit.reduce.certify.couple"
local curve = require "ambit.reduce.certify.curve"
local option = require "ambit.option"
local run = require "ambit.reduce.certify.run"

local proof = {}

local ZERO = core.expression(0)

-- -- cheaper, for rankings

-- The settings with the options that the solver declares for proofs that need not be tight.
local function lowered(settings)
  local options, lower = {}, {}
  local declared = option.declared(option.declaration("solver", settings.solver).cheap or "")
  for _, entry in ipairs(declared) do lower[entry[1]] = entry[2][1] end
  for i = 1, #(settings.options or {}), 2 do
    local name = settings.options[i]
    if not lower[name] then options[#options + 1], options[#options + 2] = name, settings.options[i + 1] end
  end
  for _, name in ipairs(check.sorted(lower)) do options[#options + 1], options[#options + 2] = name, lower[name] end
  return setmetatable({ options = options }, { __index = settings })
end

-- What the bounds should come down to, in the order of the outputs, 0: nothing is said.
local function goals_of(detailed, settings)
  local wanted = settings.stop_above or settings.goal
  if not wanted or next(wanted) == nil then return nil end
  local goals = {}
  for k, output in ipairs(detailed.outputs) do goals[k] = wanted[output.name] or 0 end
  return goals
end

-- -- one scenario

-- Outputs whose error is identically zero need no run.
local function is_exact(q)
  for _, g in ipairs(q.outputs) do
    if g ~= ZERO then return false end
  end
  return true
end

local function exact(q, settings)
  local result = { status = "proved", reason = "", t_reached = q.times[#q.times], bound = {}, when = {}, steps = 0,
    cpu_seconds = 0, exceeded = false, solver = settings.solver, arithmetic = settings.arithmetic }
  for k in ipairs(q.outputs) do result.bound[k], result.when[k] = 0, q.times[1] end
  return result
end

local function is_within(result, goals)
  if result.status ~= "proved" or not goals then return false end
  for k, bound in ipairs(result.bound) do
    if not (bound <= goals[k]) then return false end
  end
  return true
end

-- Two bounds of the same errors: both hold.
local function tighter(a, b)
  local best = a.status == "proved" and a or b
  local other = best == a and b or a
  if other.status == "stopped" then best = other end
  best.steps, best.cpu_seconds = a.steps + b.steps, a.cpu_seconds + b.cpu_seconds
  if best.status ~= "proved" or other.status ~= "proved" then return best end
  for k, bound in ipairs(other.bound) do
    if bound < best.bound[k] then best.bound[k], best.when[k] = bound, other.when[k] end
  end
  return best
end

-- About the reduced model, and, unless this is good enough already, about the detailed one.
local function by_difference(detailed, reduced, s, settings)
  local goals, first = goals_of(detailed, settings), nil
  for _, about in ipairs { "reduced", "detailed" } do
    local q = couple.of(detailed, reduced, s, about)
    if is_exact(q) then return exact(q, settings) end
    local result = run.bounds(q, settings, goals, settings.stop_above ~= nil)
    first = first and tighter(first, result) or result
    if settings.lowered or first.status == "stopped" then break end
    if settings.stop_above and is_within(first, goals) then break end
  end
  return first
end

local criteria = { difference = by_difference, bounds = bounds.prove }

-- By name of the output.
local function named(detailed, values)
  local t = {}
  for k, output in ipairs(detailed.outputs) do t[output.name] = values[k] end
  return t
end

local function one(detailed, reduced, s, settings)
  local r = criteria[settings.criterion or "difference"](detailed, reduced, s, settings)
  local proved = r.status == "proved"
  return { name = s.name, status = r.status, code = r.code, reason = r.reason, t_reached = r.t_reached,
    exceeded = r.exceeded,
    error = proved and named(detailed, r.bound) or {}, when = proved and named(detailed, r.when) or {},
    cpu_seconds = r.cpu_seconds, steps = r.steps, solver = r.solver, arithmetic = r.arithmetic }
end

-- -- all of them

local function join(total, part)
  for name, bound in pairs(part.error) do
    if not total.error[name] or bound > total.error[name] then
      total.error[name], total.when[name] = bound, part.when[name]
    end
  end
  total.cpu_seconds = total.cpu_seconds + part.cpu_seconds
end

-- settings: { criterion, solver, arithmetic, arithmetic_options, options, run_options, lowered, nodes, refine = further
-- runs over parts of the data, stop_above = { [output] = bound }: give up as soon as one is surely not met, or goal =
-- the same without giving up, all: go on behind a scenario that could not be proved }
-- -> { status, reason, t_reached, error = { [output] = bound }, when = { [output] = time of the worst }, scenarios,
-- cpu_seconds, exceeded: an output is known to be off by more than stop_above allows, or no bound below was found }
function proof.prove(detailed, reduced, scenarios, settings)
  if settings.lowered then settings = lowered(settings) end
  local total = { status = "proved", reason = "", error = {}, when = {}, scenarios = {}, cpu_seconds = 0 }
  for i, s in ipairs(scenarios) do
    local part = one(detailed, reduced, s, settings)
    total.scenarios[i] = part
    join(total, part)
    if part.status ~= "proved" and total.status == "proved" then
      total.status, total.code = part.status, part.code
      total.t_reached, total.exceeded = part.t_reached, part.exceeded
      total.reason = ("scenario `%s`: t = %s, %s"):format(s.name, core.literal(part.t_reached), part.reason)
      if not settings.all or part.status == "stopped" then break end
    end
  end
  if total.status ~= "proved" then total.error, total.when = {}, {} end
  total.t_reached = total.t_reached or (#scenarios > 0 and scenarios[#scenarios].times[#scenarios[#scenarios].times])
  return total
end

-- What is left of a proof that was given up with this outcome.
function proof.none(outcome)
  return { status = outcome.status, code = outcome.code, reason = outcome.reason, t_reached = outcome.t_reached,
    error = {}, when = {}, scenarios = {}, cpu_seconds = 0 }
end

-- The detailed model alone over one scenario, box by box of the data: { name, status, cpu_seconds, steps }; gives up
-- where it cannot be proved.
local function alone(detailed, s, settings)
  local q, start = couple.alone(detailed, s), core.cpu()
  local part = { name = s.name, status = "complete", steps = 0 }
  local steps = settings.criterion == "bounds" and bounds.alone(detailed, s, settings)
  if steps then
    part.steps, part.cpu_seconds = steps, core.cpu() - start
    return part
  end
  local unknowns, boxes = run.boxes(q)
  local possible, outcome, report = 0, nil, nil
  for _, box in ipairs(boxes) do
    outcome, report = run.alone(q, settings, unknowns, box)
    part.steps, part.status = part.steps + report.steps, outcome.status
    code.refuse_broken(outcome)
    if outcome.status == "unable" then
      outcome.reason = ("the detailed model itself cannot be proved over scenario `%s`: reached t = %s, %s"):format(
        s.name, core.literal(outcome.t_reached), outcome.reason)
      code.give_up(outcome)
    end
    if not outcome.impossible then possible = possible + 1 end
    if outcome.status == "stopped" then break end
  end
  if possible == 0 then -- whatever is said about no solution is true
    outcome.status = "impossible"
    outcome.reason = ("the detailed model has no solution over scenario `%s`: %s"):format(s.name, outcome.reason)
    code.give_up(outcome)
  end
  part.cpu_seconds = core.cpu() - start
  return part
end

-- The detailed model alone, over every scenario; gives up with the first that cannot be proved.
-- -> { { name, status, cpu_seconds, steps } }, "complete", or "stopped" if the user interrupted
function proof.detailed(detailed, scenarios, settings)
  local list = {}
  for i, s in ipairs(scenarios) do
    list[i] = alone(detailed, s, settings)
    if list[i].status == "stopped" then return list, "stopped" end
  end
  return list, "complete"
end

-- The error over time: certify/curve.lua.
proof.curve = curve.of

return proof
