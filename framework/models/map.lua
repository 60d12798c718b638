-- map.lua -- ambit.map { states = { "x" }, parameters = { a = 1 }, next = function(s, p, k) return { x = p.a * s.x }
-- end }: a system that steps, x+ = f(x, p, k), by the verbs of systems that move: t counts its steps.
local check = require "ambit.check"
local core = require "ambit.core"
local ode = require "ambit.ode"
local sampled = require "ambit.sampled"

local map = {}

function map.new(t)
  check.table(t, "map")
  check.keys(t, { "states", "parameters", "next", "name", "check_units" }, "map", 1)
  if type(t.next) ~= "function" then
    check.fail("map: next: expected a function(s, p, k) that returns the next state, got %s", check.kind(t.next))
  end
  local rest = ode.new { t[1] or t.name or "map", states = t.states or {}, parameters = t.parameters,
    check_units = t.check_units, equations = function(s)
      local rates = {}
      for name in pairs(s) do rates[name] = core.expression(0) end
      return rates
    end }
  sampled.step(rest, t.next)
  return rest
end

return map
