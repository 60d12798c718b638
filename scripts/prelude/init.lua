-- init.lua -- the module `ambit`: what a scene sees.
local check = require "ambit.check"
local core = require "ambit.core"
local evaluate = require "ambit.evaluate"
local help = require "ambit.help"
local mechanism = require "ambit.mechanism"
local ode = require "ambit.ode"
local plugin = require "ambit.plugin"
local sample = require "ambit.sample"
local simulate = require "ambit.simulate"

local ambit = {
  version = core.version,
  pi = core.pi(),
  time = core.time(),
  number = function(value, unit) return core.expression(value, unit and check.text(unit, "number: unit"), "number") end,
  mechanism = mechanism.new,
  ode = ode.new,
  evaluate = evaluate.evaluate,
  simulate = simulate.simulate,
  sample = sample.sample,
  plugins = plugin.plugins,
  plugin = plugin.plugin,
  help = help,
}

-- data, and functions that work on numbers, texts, expressions and enclosures alike
for _, name in ipairs { "around", "between", "interval", "derivative", "simplify", "sin", "cos", "tan", "asin", "acos",
  "atan",
  "atan2", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "sqr", "pow", "abs", "min", "max" } do
  ambit[name] = core[name]
end

local degree = ambit.pi / 180
function ambit.degrees(x) return core.mul(x, degree) end

return ambit
