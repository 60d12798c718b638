-- What happens where the solver that suits best fails, and who may be chosen at all.
local ambit = require "ambit"
local core = require "ambit.core"

local function chain(n, tolerance)
  local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
  local at, initial = m.world, {}
  for i = 1, n do
    at = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" .. i }, offset = { 1, 0, 0 } }
    m:point_mass { at = at, mass = 1 }
    initial["q" .. i] = ambit.around(1, tolerance)
    initial["q" .. i .. "'"] = ambit.around("0.5", tolerance)
  end
  return m:dynamics(), initial
end

local function hull(question)
  question.n = 100
  return ambit.sample(question)
end

describe("a run of the solver that suits", function()
  it("is done again by another where it gets too wide, and says so", function()
    local system, initial = chain(2, "0.1%")
    local first = ambit.simulate { system, initial = initial, t = { 0, 1 }, solver = "lohner" }
    local run = ambit.simulate { system, initial = initial, t = { 0, 1 } }
    assert.equal("complete", run.status)
    assert.is_true(#run.tried >= 2 and run.tried[1].solver == "lohner")
    assert.matches("times as wide as sampled", run.tried[1].outcome)
    assert.equal(run.tried[#run.tried].solver, run.solver)
    assert.is_true(first.overestimate > 2 and run.overestimate < 1.5, first.overestimate)
    local seen = hull { system, initial = initial, t = { 0, 1 } }
    local factor = run:overestimation(seen)
    assert.is_nil(factor.contradiction)
    assert.is_true(factor.max["q2'"] < 1.5)
  end)

  it("is done again by another where it ends", function()
    local system, initial = chain(2, "0.1%")
    local alone = ambit.simulate { system, initial = initial, t = { 0, 2 }, solver = "lohner" }
    assert.equal("unable", alone.status)
    assert.equal("complete", ambit.simulate { system, initial = initial, t = { 0, 2 } }.status)
  end)

  it("stays as it is where it is tight, and nothing is drawn", function()
    local drawn, own = 0, core.sample_system
    core.sample_system = function(...) -- luacheck: ignore
      drawn = drawn + 1
      return own(...)
    end
    local o = ambit.ode { states = { "x", "v" }, equations = function(s) return { s.v, -s.x } end }
    local run = ambit.simulate { o, initial = { ambit.around(1, "1%"), ambit.around(0, "0.01") }, t = { 0, 10 } }
    core.sample_system = own
    assert.equal(0, drawn)
    assert.is_nil(run.tried)
    assert.same({ { solver = run.solver, t_from = 0, t = 10 } }, run.parts)
    assert.is_true(run.overestimate >= 1 - 1e-3 and run.overestimate < 1.1, run.overestimate)
  end)

  it("that has no uncertain data has nothing to be held against", function()
    local o = ambit.ode { states = { "x" }, equations = function(s) return { -s.x } end }
    assert.is_nil(ambit.simulate { o, initial = { 1 }, t = 1 }.overestimate)
  end)

  it("ends where the solution does, and nobody else is asked", function()
    local o = ambit.ode { states = { "x" }, equations = function(s) return { s.x ^ 2 } end }
    local run = ambit.simulate { o, initial = { ambit.around(1, "1%") }, t = 3 }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 1 / 0.99)
    assert.is_nil(run.tried)
  end)

  it("keeps its events when another goes on", function()
    local system, initial = chain(2, "0.1%")
    local run = ambit.simulate { system, initial = initial, t = { 0, 2 },
      events = { { name = "low", g = function(s) return s.q1 end } } }
    assert.equal("complete", run.status)
    assert.is_true(#run.events >= 1 and run.events[1].name == "low")
  end)
end)
