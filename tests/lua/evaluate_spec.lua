-- The verb evaluate.
local ambit = require "ambit"

describe("evaluate", function()
  local a = ambit.between(1, 2)

  it("gives back the shape that it was given", function()
    local r = ambit.evaluate { { p = a, list = { a + 1, { deep = 3 } } } }
    assert.equal(1, r.p.lo)
    assert.equal(3, r.list[1].hi)
    assert.equal(3, r.list[2].deep.lo)
    assert.equal("complete", r.status)
    local keys = 0
    for _ in pairs(r) do keys = keys + 1 end
    assert.equal(2, keys)
  end)

  it("takes one expression, or several as a list", function()
    assert.equal(2, ambit.evaluate({ a }).hi)
    local r = ambit.evaluate { a, a * 2 }
    assert.equal(2, #r)
    assert.equal(4, r[2].hi)
  end)

  it("takes an arithmetic by name", function()
    local r = ambit.evaluate { a, arithmetic = "real" }
    assert.equal(1.5, r.lo)
    assert.equal(0, r:width())
  end)

  it("marks what left the domain", function()
    assert.is_true(ambit.evaluate({ ambit.sqrt(a - 1.5) }).partial)
    assert.is_false(ambit.evaluate({ ambit.sqrt(a) }).partial)
  end)

  it("gives values to variables by name", function()
    local d = ambit.ode { states = { "x", "v" }, equations = function(s, _, t) return { x = s.v, v = -s.x + t } end }
    local r = ambit.evaluate { d:rate "v", at = { x = "0.5", t = 2, v = 1 } }
    assert.equal(1.5, r.lo)
    assert.equal(1.5, r.hi)
  end)
end)

describe("sample", function()
  it("stays inside the enclosure and finds most of it", function()
    local a = ambit.between(0, 1)
    local e = ambit.sin(3 * a)
    local inner, outer = ambit.sample { e, n = 500 }, ambit.evaluate { e }
    assert.is_true(outer:contains(inner))
    assert.is_true(inner:width() > 0.9)
  end)
  it("repeats itself for the same seed", function()
    local a = ambit.between(0, 1)
    local wave = ambit.sin(7 * a) -- its extremes are inside
    assert.equal(ambit.sample { wave, n = 10, seed = 3 }, ambit.sample { wave, n = 10, seed = 3 })
    assert.is_false(ambit.sample { wave, n = 10, seed = 3 } == ambit.sample { wave, n = 10, seed = 4 })
  end)
  it("reaches the corners, which inner points miss in many dimensions", function()
    local sum = 0
    for _ = 1, 8 do sum = sum + ambit.between(0, 1) end
    local hull = ambit.sample { sum, n = 4000 }
    assert.equal(0, hull.lo)
    assert.equal(8, hull.hi)
  end)
end)
