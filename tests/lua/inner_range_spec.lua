-- Ranges of uncertain data are known from both sides: nothing is refuted, bounded from inside or sampled by a value
-- that the tolerance does not surely allow. True ranges here are worked out by hand.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"

local still = ambit.ode { "still", states = { "x" }, equations = function(s) return { x = 0 * s.x } end }

-- exactly 1 and 1e-6, of which doubles know 5 and 10 digits
local function one() return (ambit.number "0.1" * 1e12 - "1e11") + 1 end
local function gap() return ambit.number "10.000001 m" - "10 m" end

local function leaf(e) return core.leaves { e }[1] end

local function verify(start, safe)
  local r = ambit.verify { still, initial = { start }, t = { 0, 1 }, safe = function(s) return safe(s.x) end }
  session.worst = "ok"
  return r
end

describe("the inner range", function()
  it("is that of the tolerance, where digits of the centre cancel", function()
    local data = leaf(ambit.around(one(), "1e-9"))
    assert.is_true(data.lo <= 1 - 1e-9 and data.hi >= 1 + 1e-9)
    assert.is_true(data.inner_lo > data.lo and data.inner_hi < data.hi)
    assert.is_true(data.hi - data.inner_hi < 1e-15 and data.inner_lo - data.lo < 1e-15)
  end)

  it("refutes nothing that holds for all values of the datum", function()
    local r = verify(ambit.around(one(), "1e-9"), function(x) return ambit.number(1) - "1e-8" - x end)
    assert.are.equal("proved", r.status)
    r = verify(ambit.around(gap(), "0.000001%"), function(x) return x - "1.00000001000001e-6" end)
    assert.are.equal("proved", r.status)
  end)

  it("still refutes by a value of the datum", function()
    local r = verify(ambit.around(gap(), "0.000001%"), function(x) return x - "1.000000009999e-6" end)
    assert.are.equal("refuted", r.status)
    local x = r.counterexample.initial.x
    assert.is_true(ambit.interval("0.99999999e-6", "1.00000001e-6"):contains(x))
  end)

  it("bounds reductions from inside", function()
    local d = ambit.around(one(), "1e-9")
    local detailed = ambit.ode { states = { "x" }, parameters = { d = d },
      equations = function(s, p) return { x = p.d - s.x } end }
    local reduced = ambit.ode { states = { "x" }, equations = function(s) return { x = 1 - s.x } end }
    local r = ambit.certify { detailed, reduced, initial = { x = 0 }, t = { 0, 1 }, outputs = { "x" },
      error = { x = 1 }, criterion = "bounds" }
    local truth = 1e-9 * (1 - math.exp(-1)) -- of (d - 1)(1 - e^-t) at 1
    assert.is_true(r.error.x >= truth and r.error.x < 1.01 * truth, tostring(r.error.x))
  end)

  it("is what is drawn from", function()
    local true_range = ambit.interval("0.99999999e-6", "1.00000001e-6")
    local data = { ambit.around(gap(), "0.000001%") }
    assert.is_true(true_range:contains(ambit.sample { data[1], n = 500 }))
    local drawn = ambit.sample { still, initial = data, t = { 0, 1 }, n = 100 }
    assert.is_true(true_range:contains(drawn:at(0).x))
  end)

  it("leaves out the ends of decimals that are no doubles", function()
    for _, e in ipairs { ambit.between("0.1", "0.3"), core.expression "[0.1, 0.3]", core.expression "0.2?1",
      core.expression(ambit.interval("0.1", "0.3")), core.expression(ambit.interval "[0.1, 0.3]") } do
      local data = leaf(e)
      assert.is_true(data.lo < 0.1 and data.inner_lo == 0.1, tostring(data.inner_lo)) -- the double 0.1 is above 1/10
      assert.is_true(data.inner_hi == 0.3 - 0x1p-54 or data.inner_hi == 0.3, tostring(data.inner_hi))
    end
  end)

  it("is the whole range between doubles", function()
    for _, e in ipairs { ambit.between(1, 2), core.expression "[1, 2]", core.expression(ambit.interval(1, 2)),
      core.expression "[100, 200] mm" } do
      local data = leaf(e)
      assert.are.same({ data.lo, data.hi }, { data.inner_lo, data.inner_hi })
    end
  end)

  it("is empty where no double is known to be allowed, and then nothing is refuted by a value", function()
    local data = leaf(ambit.around("0.1", "1e-20"))
    assert.is_true(data.lo < data.hi and data.inner_lo > data.inner_hi)
    local r = verify(ambit.around("0.1", "1e-20"), function(x) return x - "0.1" end)
    assert.are.equal("undecided", r.status)
  end)

  it("is empty for an enclosure that was computed", function()
    local computed = ambit.evaluate { 2 * ambit.between(1, 2) }
    local data = leaf(core.expression(computed))
    assert.is_true(data.lo < data.hi and data.inner_lo > data.inner_hi)
    local r = verify(computed, function(x) return x - 3 end)
    assert.are.equal("undecided", r.status)
    r = verify(computed, function(x) return 1 - x end) -- whatever value it is
    assert.are.equal("refuted", verify(computed, function(x) return x - 1 end).status)
    assert.are.equal("proved", r.status)
  end)

  it("is a little less than the tolerance where that is no double and the centre an expression", function()
    local centre = ambit.between(1, 2)
    local data = core.leaves { ambit.around(centre, "0.1") }
    local xi = data[1].lo == -1 and data[1] or data[2]
    assert.is_true(xi.inner_hi < 1 and xi.inner_hi > 1 - 1e-15 and xi.inner_lo == -xi.inner_hi)
    data = core.leaves { ambit.around(centre, 0.25) }
    xi = data[1].lo == -1 and data[1] or data[2]
    assert.are.equal(1, xi.inner_hi)
  end)
end)
