-- init.lua -- the module `ambit`: what a scene sees. The code of a verb is read when the verb is first called: most
-- scenes need little of it, and reading all of it takes longer than they do.
local check = require "ambit.check"
local core = require "ambit.core"

local function later(module, name)
  return function(...) return require("ambit." .. module)[name](...) end
end

local ambit = {
  version = core.version,
  pi = core.pi(),
  time = core.time(),
  mechanism = later("mechanism", "new"),
  load = later("robot.load", "load"),
  chain = later("chain", "new"),
  ode = later("ode", "new"),
  varying = later("varying", "new"),
  sampled = later("sampled", "new"),
  network = later("network", "new"),
  lookup = later("network", "lookup"),
  map = later("map", "new"),
  join = later("join", "join"),
  evaluate = later("evaluate", "evaluate"),
  simulate = later("simulate", "simulate"),
  sensitivity = later("sensitivity", "sensitivity"),
  poincare = later("poincare", "poincare"),
  hybrid = later("switch", "hybrid"),
  sample = later("sample", "sample"),
  overestimation = later("sample.overestimation", "overestimation"),
  roots = later("roots", "roots"),
  equilibria = later("equilibria", "equilibria"),
  eigenvalues = later("stability", "eigenvalues"),
  inverse_kinematics = later("inverse_kinematics", "inverse_kinematics"),
  verify = later("verify", "verify"),
  invariant = later("forever.invariant", "invariant"),
  attraction = later("forever.attraction", "attraction"),
  certify = later("reduce.certify", "certify"),
  reduce = later("reduce", "reduce"),
  compare = later("compare", "compare"),
  view = later("view", "view"),
  plot = later("plot", "plot"),
  plugins = later("plugin", "plugins"),
  plugin = later("plugin", "plugin"),
  trust = later("plugin", "trust"),
  provenance = later("provenance", "now"),
  help = function(...) return require "ambit.help"(...) end,
}

-- data, and functions that work on numbers, texts, expressions and enclosures alike
for _, name in ipairs {
  "around", "between", "interval", "derivative", "simplify",
  "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
  "exp", "log", "sqrt", "sqr", "pow", "abs", "min", "max",
} do
  ambit[name] = core[name]
end
for _, name in ipairs(core.described_functions) do ambit[name] = core[name] end

-- A number, or what a text says, as an expression; unit: the SI unit that it must agree with.
function ambit.number(value, unit)
  if unit ~= nil then check.text(unit, "number: unit") end
  local e = core.expression(value, unit, "number")
  return unit and core.in_unit(e, unit, "given") or e
end

-- Whose is arithmetic on texts, "1" / "3"? true: Ambit's, as in the command; false: Lua's, which rounds. Until the host
-- has said, Lua's, but numbers that it may have rounded are refused. Returns whose it was: "ambit", "lua" or "watched".
function ambit.text_arithmetic(is_exact)
  if type(is_exact) ~= "boolean" then
    check.fail("text_arithmetic: expected true or false, got %s", check.kind(is_exact))
  end
  return core.text_arithmetic(is_exact and "ambit" or "lua")
end

core.text_arithmetic("watched")

local degree = ambit.pi / 180

-- A number of degrees, which has no unit, as an angle.
function ambit.degrees(x)
  local _, unit = core.unit_of(x)
  if unit then
    check.fail("degrees: expected a number of degrees without a unit, got %s: a value with a unit is converted already",
      unit)
  end
  local angle = core.mul(x, degree)
  return check.kind(angle) == "expression" and core.in_unit(angle, "rad", "given") or angle
end

return ambit
