-- init.lua -- the module `ambit`: what a scene sees.
local certify = require "ambit.certify"
local chain = require "ambit.chain"
local check = require "ambit.check"
local compare = require "ambit.compare"
local core = require "ambit.core"
local equilibria = require "ambit.equilibria"
local evaluate = require "ambit.evaluate"
local help = require "ambit.help"
local inverse_kinematics = require "ambit.inverse_kinematics"
local load = require "ambit.load"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local plugin = require "ambit.plugin"
local poincare = require "ambit.poincare"
local reduce = require "ambit.reduce"
local roots = require "ambit.roots"
local sample = require "ambit.sample"
local sensitivity = require "ambit.sensitivity"
local simulate = require "ambit.simulate"
local stability = require "ambit.stability"
local verify = require "ambit.verify"
local switch = require "ambit.switch"
local view = require "ambit.view"

local ambit = {
  version = core.version,
  pi = core.pi(),
  time = core.time(),
  mechanism = mechanism.new,
  load = load.load,
  chain = function(t) return chain.new(t) end,
  ode = ode.new,
  evaluate = evaluate.evaluate,
  simulate = simulate.simulate,
  sensitivity = sensitivity.sensitivity,
  poincare = poincare.poincare,
  hybrid = switch.hybrid,
  sample = sample.sample,
  roots = roots.roots,
  equilibria = equilibria.equilibria,
  eigenvalues = stability.eigenvalues,
  inverse_kinematics = inverse_kinematics.inverse_kinematics,
  verify = verify.verify,
  certify = certify.certify,
  reduce = reduce.reduce,
  compare = compare.compare,
  view = view.view,
  plugins = plugin.plugins,
  plugin = plugin.plugin,
  help = help,
}

-- data, and functions that work on numbers, texts, expressions and enclosures alike
for _, name in ipairs {
  "around", "between", "interval", "derivative", "simplify",
  "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
  "exp", "log", "sqrt", "sqr", "pow", "abs", "min", "max",
} do
  ambit[name] = core[name]
end

-- A number, or what a text says, as an expression; unit: the SI unit that it must agree with.
function ambit.number(value, unit)
  if unit ~= nil then check.text(unit, "number: unit") end
  return core.expression(value, unit, "number")
end

local degree = ambit.pi / 180
function ambit.degrees(x) return core.mul(x, degree) end

return ambit
