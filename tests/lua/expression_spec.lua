-- Expressions: operators, functions, derivative.
local ambit = require "ambit"

describe("an expression", function()
  local x = ambit.between(1, 2)

  it("is built by operators and functions from numbers and texts", function()
    local e = 2 * x + "0.5" - x / 4 + (-x) ^ 3
    local y = ambit.evaluate { e }
    assert.is_true(y:contains(2 + 0.5 - 0.25 - 1))
    assert.is_true(y:contains(4 + 0.5 - 0.5 - 8))
  end)

  it("keeps correlation and identities", function()
    assert.equal(x - x, 0 * x)
    assert.equal(0, ambit.evaluate({ x - x }):width())
    assert.equal(ambit.sin(x) * ambit.sin(x) + ambit.cos(x) * ambit.cos(x), ambit.around(1, 0))
  end)

  it("refuses whole exponents that are too large to be whole, instead of taking logarithms", function()
    for _, n in ipairs { 1000000001, 9007199254740993, -4294967296, 2^31, 1e300, "4294967297" } do
      for _, x in ipairs { ambit.number(-1), ambit.between(-1, 1), ambit.interval(-1, 1) } do
        local good, message = pcall(function() return x ^ n end)
        assert.is_false(good)
        assert.truthy(message:find("a whole exponent is at most 1e9", 1, true), message)
      end
    end
    assert.equal(-1, ambit.evaluate({ ambit.number(-1) ^ 999999999 }).hi)
    assert.equal(1, (ambit.interval(-1, -1) ^ 1000000000).lo)
  end)

  it("takes integer powers for every base and others for positive ones", function()
    local y = ambit.between(-2, 3)
    assert.equal(0, ambit.evaluate({ y ^ 2 }).lo)
    assert.equal(9, ambit.evaluate({ y ^ 2 }).hi)
    assert.is_true(ambit.evaluate({ x ^ "1.5" }):contains(2 * math.sqrt(2)))
    assert.is_true(ambit.evaluate({ x ^ 0.5 }):contains(math.sqrt(2)))
    assert.is_true(ambit.evaluate({ x ^ -1 }):contains(0.5))
    assert.equal(4, ambit.evaluate({ x ^ "2" }).hi)
    local nearly = ambit.evaluate { x ^ "2.00000000000000000001" } -- not the square
    assert.is_true(nearly.hi > 4)
  end)

  it("takes no digit from a large integer", function()
    local n = 9007199254740993 -- 2^53 + 1
    local y = ambit.evaluate { ambit.around(n, 0) - 9007199254740992 }
    assert.is_true(y:contains(1))
  end)

  it("has derivatives", function()
    local d = ambit.derivative(x ^ 3 + 2 * x, x)
    assert.is_true(ambit.evaluate({ d }):contains(ambit.interval(5, 14)))
  end)

  it("uses an enclosure as a fresh unknown each time", function()
    local e = ambit.interval(0, 1)
    assert.equal(2, ambit.evaluate({ (x + e) - (x + e) }):width())
  end)

  it("has no order", function()
    assert.has_error(function() return x < 1 end)
  end)
end)
