-- Requests of the core are tables of declared fields (framework/script/fields.h): one that does not fit is refused by
-- name, and nothing is taken for something else.
local ambit = require "ambit"
local core = require "ambit.core"

local function fails(f, request, expected)
  local good, message = pcall(f, request)
  assert.is_false(good, expected)
  assert.is_truthy(message:find(expected, 1, true), message .. "\nshould say " .. expected)
end

local ode = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }

-- A request for a run that is complete, with one field changed (false: without it).
local function flow(key, value)
  local q = { system = ode.system, solver = "lohner", times = { 0, 1 },
    initial = { core.expression(1), core.expression(0) } }
  if key then q[key] = value or nil end
  return q
end

describe("a request of the core", function()
  it("is refused where a field is missing, unknown or of another type", function()
    fails(core.simulate, flow("solver", false), "core.simulate: `solver` is missing")
    fails(core.simulate, flow("solver", 3), "core.simulate: `solver`: expected a text, got number")
    fails(core.simulate, flow("sover", "lohner"), "core.simulate: there is no field `sover`")
    fails(core.simulate, flow("times", "soon"), "core.simulate: `times`: expected a list, got string")
    fails(core.simulate, flow("initial", { core.expression(1) }), "core.simulate: `initial` has 1 entries, not 2")
    fails(core.simulate, 7, "table expected, got number")
    fails(core.evaluate, "interval", "core.evaluate: expected a table of fields, got string")
    fails(core.evaluate, { expressions = { core.expression(1) }, leaves = ode.symbols }, "`values` is missing")
    fails(core.events, { system = ode.system, initial = flow().initial, start = 0, list = { { g = 1, size = 2 } } },
      "core.events: there is no field `size`")
    fails(core.sample_system, flow(), "core.sample_system: expected a table of fields, got no value")
  end)

  it("says which words and numbers fit", function()
    local function watching(settings) return function(q) return core.watch(q, settings) end end
    fails(watching { conditions = { { g = core.expression(1), kind = "never" } } }, flow(),
      "core.watch: `kind`: expected one of its words, got string")
    fails(watching { cuts = -1 }, flow(), "core.watch: `cuts`: expected a whole number that is not negative")
    fails(watching { cuts = 2 ^ 40 }, flow(), "core.watch: `cuts`: expected a smaller number")
    fails(watching { unknowns = {}, lo = { 1 } }, flow(), "core.watch: `lo` has 1 entries, not 0")
    local findings, outcome = core.watch(flow(), { cuts = 4,
      conditions = { { g = ode.symbols[1] - 2, kind = "always", name = "far" } } })
    assert.equal("complete", outcome.status)
    assert.is_true(findings[1].holds)
  end)
end)
