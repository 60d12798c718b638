-- Uncertain data: around, between, interval, degrees.
local ambit = require "ambit"
local function range(e) return ambit.evaluate { e } end

describe("around", function()
  it("takes a number as the exact double and text as the decimal it says", function()
    local x = range(ambit.around(2, 0.5))
    assert.equal(1.5, x.lo)
    assert.equal(2.5, x.hi)
    local y = range(ambit.around("0.1", "0.01"))
    assert.is_true(y:contains "0.09" and y:contains "0.11")
    assert.is_true(y.lo <= 0.09 and y.hi >= 0.11)
    assert.is_true(y:width() < 0.02 + 1e-16)
  end)

  it("says of a value that is not defined that it is no number", function()
    for _, value in ipairs { ambit.sqrt "-1", ambit.log "-1", ambit.log "0", ambit.number(1) / 0 } do
      for message, f in pairs { ["around: the value is no number"] = function() return ambit.around(value, 1) end,
        ["between: the lower end is no number"] = function() return ambit.between(value, 1) end,
        ["between: the upper end is no number"] = function() return ambit.between(1, value) end } do
        local good, problem = pcall(f)
        assert.is_false(good)
        assert.truthy(problem:find(message, 1, true), problem)
        assert.truthy(problem:find("data_spec.lua:", 1, true), problem)
      end
    end
  end)

  it("takes relative tolerances of either sign", function()
    for _, c in ipairs { 4, -4 } do
      local x = range(ambit.around(c, "25%"))
      assert.equal(c - 1, x.lo)
      assert.equal(c + 1, x.hi)
    end
    local general = ambit.around(ambit.around(-4, "0.5") * 1, "50%")
    assert.is_true(range(general):contains(ambit.interval(-6.75, -1.75)))
  end)

  it("encloses the tolerance around a constant such as 3 pi/4", function()
    local x = range(ambit.around(3 * ambit.pi / 4, "1%"))
    assert.is_true(x.lo <= 2.356194490192345 * 0.99 and x.hi >= 2.356194490192345 * 1.01)
    assert.is_true(x:width() < 0.0471239)
  end)

  it("is the same unknown where it is the same value, and a fresh one at each call", function()
    local a, b = ambit.around(1, "0.1"), ambit.around(1, "0.1")
    assert.equal(0, range(a - a):width())
    assert.is_true(range(a - b):width() > 0.39)
  end)

  it("without tolerance is the number itself", function()
    assert.equal(0, range(ambit.around(3, 0)):width())
  end)
end)

describe("between", function()
  it("covers both ends, outward", function()
    local x = range(ambit.between("0.1", "0.3"))
    assert.is_true(x:contains "0.1" and x:contains "0.3")
    assert.is_true(range(ambit.between(1, ambit.pi)):contains(ambit.pi))
  end)
  it("with equal ends is a number", function()
    local x = ambit.between(2, 2)
    assert.equal(2, range(x).lo)
    assert.equal(0, range(x):width())
  end)
end)

describe("interval", function()
  it("takes bounds, literals, and points", function()
    local x = ambit.interval(1, 2)
    assert.equal(1, x.lo)
    assert.equal(2, x.hi)
    assert.is_true(ambit.interval("[0.1, 0.2]"):contains "0.1")
    assert.equal(ambit.interval "0.1", ambit.interval("0.1", "0.1"))
    assert.equal(math.huge, ambit.interval(1, math.huge).hi)
    assert.is_true(ambit.interval("[empty]"):is_empty())
  end)
end)

describe("units", function()
  it("convert to SI", function()
    assert.is_true(range(ambit.around("35 mm", "1 mm")):contains "0.034")
    assert.is_true(range(ambit.around("35 mm", "1 mm")).hi < 0.0361)
    assert.is_true(range(ambit.between("10 deg", "20 deg")):contains(ambit.degrees(15)))
  end)
end)

describe("degrees", function()
  it("works on every kind of value", function()
    local right = ambit.pi / 2
    assert.is_true(ambit.interval(ambit.degrees(90)):contains(1.5707963267948966))
    assert.is_true(ambit.interval(ambit.degrees("90")):contains(1.5707963267948966))
    assert.equal("enclosure", getmetatable(ambit.degrees(ambit.interval(0, 90))):match "%.(%a+)")
    assert.is_true(ambit.degrees(ambit.interval(0, 90)):contains(right))
  end)
end)
