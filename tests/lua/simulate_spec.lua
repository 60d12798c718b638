-- The verb simulate and its run.
local ambit = require "ambit"

local decay = ambit.ode { states = { "x" }, parameters = { k = 1 }, equations = function(s,
  p) return { x = -p.k * s.x } end }

describe("simulate", function()
  it("encloses the solution at listed times exactly there, and between them", function()
    local run = ambit.simulate { decay, initial = { x = 1 }, t = { 0, "0.5", 1 } }
    assert.equal("complete", run.status)
    assert.equal("", run.reason)
    assert.equal(1, run.t_reached)
    assert.is_true(run.rigorous)
    assert.is_true(run.x.x:contains(ambit.exp(ambit.interval(-1))))
    assert.is_true(run:at(1).x == run.x.x)
    local half = run:at "0.5"
    assert.is_true(half.x:hull(math.exp(-0.5)):width() < 1e-12)
    assert.is_true(half.x:width() < 1e-12)
    assert.equal(1, run:at(0).x.lo)
    for i = 0, 50 do
      local t = i / 50
      local truth = ambit.exp(ambit.interval(-t))
      assert.is_false(run:at(t).x:intersect(truth):is_empty())
    end
    assert.truthy(tostring(run):find "^complete")
  end)

  it("lists its steps, each with a tube that holds both ends", function()
    local run = ambit.simulate { decay, initial = { x = ambit.around(1, "10%") }, t = { 0, 3 } }
    local count, last = 0, 0
    for step in run:steps() do
      count = count + 1
      assert.equal(last, step.t_from)
      assert.is_true(step.t > step.t_from)
      assert.is_true(step.tube.x:contains(step.x.x:intersect(step.tube.x)))
      last = step.t
    end
    assert.equal(run.step_count, count)
    assert.equal(3, last)
  end)

  it("integrates backwards", function()
    local run = ambit.simulate { decay, initial = { x = 1 }, t = { 1, 0 } }
    assert.equal("complete", run.status)
    assert.is_true(run.x.x:contains(ambit.exp(ambit.interval(1))))
    assert.is_false(run:at(0.5).x:intersect(ambit.exp(ambit.interval(0.5))):is_empty())
  end)

  it("takes uncertain parameters and explicit time", function()
    local f = ambit.ode { states = { "x" }, parameters = { a = ambit.between(1, 2) },
      equations = function(_, p, t) return { x = p.a * t } end }
    local run = ambit.simulate { f, initial = { x = 0 }, t = { 0, 2 } }
    assert.is_true(run.x.x:contains(ambit.interval(2, 4)))
    assert.is_true(run.x.x:width() < 2.001)
  end)

  it("ends `unable` before a solution that escapes in finite time", function()
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
    local run = ambit.simulate { f, initial = { x = 1 }, t = { 0, 2 } }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 1)
    assert.is_true(#run.reason > 10)
    require("ambit.session").unable = false
  end)

  it("passes options to the solver", function()
    local few = ambit.simulate { decay, initial = { 1 }, t = { 0, 5 }, order = 30 }
    local many = ambit.simulate { decay, initial = { 1 }, t = { 0, 5 }, order = 6 }
    assert.is_true(few.step_count < many.step_count)
  end)

  it("refuses reference solvers where they prove nothing, and says so otherwise", function()
    if not ambit.plugins("solver").gsl then return end
    local run = ambit.simulate { decay, initial = { x = 1 }, t = { 0, 1 }, solver = "gsl" }
    assert.is_false(run.rigorous)
    assert.is_true(math.abs(run.x.x:mid() - math.exp(-1)) < 1e-6)
  end)
end)

describe("sample of a system", function()
  it("stays inside the enclosure", function()
    if not ambit.plugins("solver").gsl then return end
    local t = { decay, initial = { x = ambit.around(1, "10%") }, t = { 0, 1, 2 } }
    local outer = ambit.simulate(t)
    t.n = 50
    local inner = ambit.sample(t)
    assert.equal("complete", inner.status)
    for _, time in ipairs { 1, 2 } do
      local hull = inner:at(time).x
      local wide = outer:at(time).x
      assert.is_true(hull.lo > wide.lo - 1e-6 and hull.hi < wide.hi + 1e-6)
      assert.is_true(hull:width() > 0.5 * wide:width())
    end
  end)
end)
