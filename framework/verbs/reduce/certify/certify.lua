-- reduce/certify.lua -- ambit.certify { detailed, reduced, t = ..., initial = ..., outputs = ..., error = ... }: proves
-- how far a given reduced model is off, for all data of all scenarios, at all times. docs/numerics/reduction.md.
local certificate = require "ambit.reduce.report_certificate"
local certify_bound = require "ambit.reduce.certify.bound"
local check = require "ambit.check"
local code = require "ambit.code"
local core = require "ambit.core"
local expect = require "ambit.run.expect"
local model = require "ambit.reduce.certify.model"
local number = require "ambit.report.number"
local proof = require "ambit.reduce.certify.proof"
local scenario = require "ambit.reduce.certify.scenario"
local session = require "ambit.session"
local settings = require "ambit.reduce.certify.settings"
local within = require "ambit.simulate.choice".within

local verb = {}

-- Where bounds shrink as the data are cut, they are cut without being asked for it.
local REFINE, GAIN = 8, 0.8

local keys = { "t", "initial", "parameters", "inputs", "scenarios", "outputs", "reduced_outputs", "error", "expect" }
local VERDICTS = { "proved", "exceeded", "unable" }

-- CPU time of the solvers that are asked after the first: so many times its own, and at least so many s
local MORE, LEAST = 4, 8
local PART = 0.5 -- of what is left of it, for one of them

-- -- the result

local Certificate = { __name = "certificate" }
Certificate.__index = Certificate

function Certificate.__tostring(self)
  local lines = { ("%s: the reduced model over %d scenario%s, criterion %s"):format(self.status, #self.scenarios,
    #self.scenarios == 1 and "" or "s", self.criterion) }
  if self.reason ~= "" then lines[1] = lines[1] .. ": " .. self.reason end
  local more = certificate.lines(self)
  table.move(more, 1, #more, 2, lines)
  return table.concat(lines, "\n")
end

-- The error over time, for pictures: { t = {}, error = { [name] = {} } }
function Certificate:curve() return proof.curve(self.detailed, self.reduced, self.given, self.settings) end

certificate.install(Certificate)
check.methods(Certificate, Certificate)

-- "proved": every output within its bound (if it has one); "exceeded": proved, but a bound is above what is allowed
local function verdict(result, names, bounds)
  if result.status ~= "proved" then return result.status, result.code, result.reason end
  for _, name in ipairs(names) do
    if bounds[name] and not (result.error[name] <= bounds[name]) then
      return "exceeded", "unable.bound",
        ("`%s` is only proved to be within %s"):format(name, number.up(result.error[name]))
    end
  end
  return "proved", "ok", ""
end

-- -- the verb

-- The parameters that scenarios vary and the reduced model has under the same name.
local function known_to(system, symbols)
  local own = {}
  for key, symbol in pairs(symbols) do
    if type(key) ~= "string" or system.parameters[key] then own[key] = symbol end
  end
  return own
end

-- The outputs of the reduced model: the same, or its own under the same names.
local function reduced_outputs(t, detailed)
  local list, names, known = {}, {}, {}
  for k, output in ipairs(detailed.outputs) do names[k], known[output.name] = output.name, true end
  local replaced = check.table(t.reduced_outputs or {}, "certify: reduced_outputs")
  for _, name in ipairs(check.sorted(replaced)) do
    if not known[name] then
      check.fail("certify: reduced_outputs: `%s` is no output%s", tostring(name), check.suggest(name, names))
    end
    list[name] = replaced[name]
  end
  for _, key in ipairs(check.sorted(t.outputs)) do
    local name = type(key) == "string" and key or t.outputs[key]
    if replaced[name] == nil and type(key) == "string" then list[key] = t.outputs[key] end
    if replaced[name] == nil and type(key) ~= "string" then list[#list + 1] = name end
  end
  return list
end

-- With its outputs in the order of the detailed model's.
local function reduced_model(t, detailed, symbols)
  local system = model.system(t[2], "certify: the second entry, the reduced model")
  local m = model.of(system, reduced_outputs(t, detailed), "certify: the reduced model", known_to(system, symbols))
  local by_name = {}
  for _, output in ipairs(m.outputs) do by_name[output.name] = output end
  for k, output in ipairs(detailed.outputs) do m.outputs[k] = by_name[output.name] end
  return m
end

-- { name, number, name, number, ... } for the result's record
local function fields(names, values)
  local list = {}
  for _, name in ipairs(names) do
    if values[name] then list[#list + 1], list[#list + 2] = name, values[name] end
  end
  return list
end

local function prove(detailed, reduced, scenarios, how)
  proof.detailed(detailed, scenarios, how)
  return proof.prove(detailed, reduced, scenarios, how)
end

-- One solver's certificate: solver nil: the one that suits.
local function attempt(t, asked, solver)
  local how = settings.read(t, keys, "certify", 2)
  how.solver = how.solver or solver
  settings.choose(how, t, asked.detailed, asked.scenarios)
  how.report = {} -- of all runs together
  how.all, how.goal = true, asked.bounds
  if t.refine == nil then how.refine, how.gain = REFINE, GAIN end
  local ended, result = code.until_given_up(prove, asked.detailed, asked.reduced, asked.scenarios, how)
  result = result or proof.none(ended)
  result.error_status, result.settings = result.status, how
  result.status, result.code, result.reason = verdict(result, asked.names, asked.bounds)
  return result
end

-- The largest part of its bound that an output may be off by.
local function excess(result, asked)
  local most = 0
  for _, name in ipairs(asked.names) do
    local bound = asked.bounds[name]
    if bound then most = math.max(most, (result.error[name] or math.huge) / bound) end
  end
  return most
end

local RANK = { proved = 2, exceeded = 1 }

local function is_better(result, best, asked)
  local a, b = RANK[result.status] or 0, RANK[best.status] or 0
  return a > b or a == b and a == 1 and excess(result, asked) < excess(best, asked)
end

-- Where nobody named a solver and a bound was not proved, the next best ones are asked. Each may take half of the time
-- that is left, the last one all of it.
local function best_of(t, asked)
  local began = core.cpu()
  local best = attempt(t, asked, nil)
  local function may_go_on() return best.status == "exceeded" or best.status == "unable" end
  local others = may_go_on() and settings.rigorous(best.settings.others) or {}
  local ends = core.cpu() + math.max(LEAST, MORE * (core.cpu() - began))
  for i, solver in ipairs(others) do
    local left = ends - core.cpu()
    if not may_go_on() or left <= 0 then break end
    local result
    local was_limit = within(i < #others and PART * left or left, function() result = attempt(t, asked, solver) end)
    if result.status == "stopped" and not was_limit then return result end
    if is_better(result, best, asked) then best = result end
  end
  return best
end

function verb.certify(t)
  check.table(t, "certify")
  if t[1] == nil or t[2] == nil then
    check.fail "certify: expected { detailed, reduced, ... }: two ambit.ode or m:dynamics()"
  end
  local expected = expect.read(t, "certify", VERDICTS)
  settings.read(t, keys, "certify", 2)
  local symbols = scenario.symbols(t, "certify")
  local detailed = model.of(t[1], t.outputs, "certify", symbols)
  local reduced = reduced_model(t, detailed, symbols)
  local names, bounds = certify_bound.read(t.error, detailed.outputs, "certify", true)
  local scenarios = scenario.list(t, detailed, "certify", reduced)
  local result = best_of(t, { detailed = detailed, reduced = reduced, names = names, bounds = bounds,
    scenarios = scenarios })
  local how = result.settings
  expect.judge(result, expected)
  result.outputs, result.bounds, result.criterion = names, bounds, how.criterion
  result.detailed, result.reduced, result.given = detailed, reduced, scenarios
  session.finish("certify", { status = result.status, code = result.code, reason = result.reason,
    t_reached = result.t_reached, cpu_seconds = result.cpu_seconds }, how.report, { "criterion", how.criterion,
    "solver", how.solver, "options", how.shown,
    "error", fields(names, result.error), "bounds", fields(names, bounds) })
  return setmetatable(result, Certificate)
end

return verb
