-- reduce/certify.lua -- ambit.certify { detailed, reduced, t = ..., initial = ..., outputs = ..., error = ... }: proves
-- how far a given reduced model is off, for all data of all scenarios, at all times. docs/numerics/reduction.md.
local certificate = require "ambit.reduce.report_certificate"
local certify_bound = require "ambit.reduce.certify.bound"
local check = require "ambit.check"
local code = require "ambit.code"
local model = require "ambit.reduce.certify.model"
local number = require "ambit.report.number"
local proof = require "ambit.reduce.certify.proof"
local scenario = require "ambit.reduce.certify.scenario"
local session = require "ambit.session"
local settings = require "ambit.reduce.certify.settings"

local verb = {}

-- Where bounds shrink as the data are cut, they are cut without being asked for it.
local REFINE, GAIN = 8, 0.8

local keys = { "t", "initial", "parameters", "inputs", "scenarios", "outputs", "reduced_outputs", "error" }

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

function verb.certify(t)
  check.table(t, "certify")
  if t[1] == nil or t[2] == nil then
    check.fail "certify: expected { detailed, reduced, ... }: two ambit.ode or m:dynamics()"
  end
  local how = settings.read(t, keys, "certify", 2)
  local symbols = scenario.symbols(t, "certify")
  local detailed = model.of(t[1], t.outputs, "certify", symbols)
  local reduced = reduced_model(t, detailed, symbols)
  local names, bounds = certify_bound.read(t.error, detailed.outputs, "certify", true)
  local scenarios = scenario.list(t, detailed, "certify", reduced)
  settings.choose(how, t, detailed, scenarios)
  how.report = {} -- of all runs together
  how.all, how.goal = true, bounds
  if t.refine == nil then how.refine, how.gain = REFINE, GAIN end
  local ended, result = code.until_given_up(prove, detailed, reduced, scenarios, how)
  result = result or proof.none(ended)
  result.error_status = result.status
  result.status, result.code, result.reason = verdict(result, names, bounds)
  result.outputs, result.bounds, result.criterion, result.settings = names, bounds, how.criterion, how
  result.detailed, result.reduced, result.given = detailed, reduced, scenarios
  session.finish("certify", { status = result.status, code = result.code, reason = result.reason,
    t_reached = result.t_reached, cpu_seconds = result.cpu_seconds }, how.report, { "criterion", how.criterion,
    "solver", how.solver, "options", how.shown,
    "error", fields(names, result.error), "bounds", fields(names, bounds) })
  return setmetatable(result, Certificate)
end

return verb
