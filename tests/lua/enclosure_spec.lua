-- Enclosures as values: an interval calculator.
local ambit = require "ambit"
local interval = ambit.interval

describe("an enclosure", function()
  it("has exact bounds, width, middle and radius", function()
    local x = interval(1, 3)
    assert.equal(2, x:width())
    assert.equal(2, x:mid())
    assert.equal(1, x:rad())
    assert.equal(3, interval(-3, 2):mag())
    assert.equal(0, interval(-3, 2):mig())
  end)

  it("calculates with numbers, texts, constants and its like", function()
    local x = interval(1, 2)
    assert.equal(interval(2, 4), x * 2)
    assert.equal(interval(2, 4), 2 * x)
    assert.equal(interval(-2, -1), -x)
    assert.equal(interval(-1, 1), x - x)
    assert.equal(interval(1, 4), x ^ 2)
    assert.equal(interval(0, 4), interval(-1, 2) ^ 2)
    assert.equal(interval(0.5, 1), 1 / x)
    assert.is_true((x + "0.1"):contains "1.1")
    assert.is_true(("0.1" + x):contains "1.1")
    assert.is_true((x * ambit.pi):contains(ambit.pi))
    assert.equal(interval(1, 2), ambit.min(x, 5))
    assert.equal(interval(2, 3), ambit.max(x, interval(0, 3), 2))
    assert.equal(interval(0, 2), ambit.abs(interval(-2, 1)))
    assert.is_true((x ^ "0.5"):contains(ambit.sqrt(interval(2))))
  end)

  it("encloses every elementary function", function()
    local cases = {
      { "sin", 1, 0.8414709848078965 }, { "cos", 1, 0.5403023058681398 }, { "tan", 1, 1.5574077246549023 },
      { "asin", 0.5, 0.5235987755982989 }, { "acos", 0.5, 1.0471975511965979 }, { "atan", 1, 0.7853981633974483 },
      { "sinh", 1, 1.1752011936438014 }, { "cosh", 1, 1.5430806348152437 }, { "tanh", 1, 0.7615941559557649 },
      { "exp", 1, 2.718281828459045 }, { "log", 2, 0.6931471805599453 }, { "sqrt", 2, 1.4142135623730951 }, { "sqr", 3,
        9 },
      { "abs", -3, 3 },
    }
    for _, case in ipairs(cases) do
      local y = ambit[case[1]](interval(case[2]))
      assert.is_true(y.lo <= case[3] + 1e-15 and y.hi >= case[3] - 1e-15, case[1])
      assert.is_true(y:width() < 1e-14, case[1])
    end
    assert.is_true(ambit.atan2(interval(1), interval(-1)):contains(3 * ambit.pi / 4))
  end)

  it("says when an operation left its domain", function()
    local y = ambit.sqrt(interval(-1, 4))
    assert.equal(interval(0, 2), y)
    assert.is_true(y.partial)
    assert.is_true((y + 1).partial)
    assert.is_false(ambit.sqrt(interval(1, 4)).partial)
    assert.is_true(ambit.log(interval(-2, -1)):is_empty())
  end)

  it("compares only what is certain", function()
    assert.is_true(interval(1, 2) < interval(3, 4))
    assert.is_false(interval(1, 2) < interval(2, 4))
    assert.is_true(interval(1, 2) <= interval(2, 4))
    assert.is_true(interval(1, 2) < 3)
    assert.is_false(interval(1, 3) > 2)
    assert.is_true(interval(1, 3) > 0)
  end)

  it("joins and meets", function()
    assert.equal(interval(1, 5), interval(1, 2):hull(interval(4, 5), 3))
    assert.equal(interval(2, 3), interval(1, 3):intersect(interval(2, 5)))
    assert.is_true(interval(1, 2):intersect(interval(3, 4)):is_empty())
  end)

  it("prints outward", function()
    local text = tostring(interval "[0.123456, 0.234567]")
    local lo, hi = text:match "%[(.-), (.-)%]"
    assert.is_true(interval(lo).lo <= 0.123456 and interval(hi).hi >= 0.234567, text)
    assert.equal("2.5", tostring(interval(2.5)))
    assert.equal("[empty]", tostring(interval "[empty]"))
    local many = interval("[0.123456, 0.234567]"):text(10)
    assert.is_true(#many > #text)
  end)

  it("is contained in its print-out for many random bounds", function()
    math.randomseed(7)
    for _ = 1, 2000 do
      local a = (math.random() - 0.5) * 10 ^ math.random(-20, 20)
      local b = a + math.random() * 10 ^ math.random(-20, 20)
      local x = interval(a, b)
      for digits = 1, 5 do
        local text = x:text(digits)
        local back = interval(text:sub(1, 1) == "[" and text or "[" .. text .. ", " .. text .. "]")
        assert.is_true(back:contains(x), text)
      end
    end
  end)
end)
