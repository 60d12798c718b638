-- Intervals of high precision: the constants of a script reach them with all their digits.
local ambit = require "ambit"

local function with_bits(e, bits) return ambit.evaluate { e, arithmetic = { "mpfr", precision = bits } } end

-- Rump 1988: single, double and extended precision agree on a value with the wrong sign; a = 77617, b = 33096.
local function rump()
  local a, b = ambit.number "77617", ambit.number "33096"
  return "333.75" * b ^ 6 + a ^ 2 * (11 * a ^ 2 * b ^ 2 - b ^ 6 - 121 * b ^ 4 - 2) + "5.5" * b ^ 8 + a / (2 * b)
end

describe("mpfr", function()
  it("rescues Rump's expression, where doubles say nothing", function()
    assert.is_true(ambit.evaluate({ rump() }):width() > 1e20)
    local r = ambit.evaluate { rump(), arithmetic = "mpfr" } -- 128 bits
    assert.is_true(r:contains "-0.82739605994682136814")
    assert.is_true(r:width() <= 0x1p-52)
    assert.is_true(with_bits(rump(), 100):width() > 1)
    assert.is_true(with_bits(rump(), 100):contains(with_bits(rump(), 1000)))
  end)

  it("reads decimals, fractions and pi to its own precision", function()
    local tenth, third = ambit.number "0.1", ambit.number "1/3"
    local rest = with_bits(tenth * 3 - "0.3", 300)
    assert.is_true(rest:contains(0) and rest:width() < 1e-88)
    rest = with_bits(third * third - "1/9", 300)
    assert.is_true(rest:contains(0) and rest:width() < 1e-88)
    -- pi beyond a double: the difference to 30 digits is the next digits
    rest = with_bits((ambit.pi - "3.14159265358979323846264338327") * 1e30, 300)
    assert.is_true(rest:contains "9.50288419716939937510582097494459230781640628620899")
    assert.is_true(rest:width() < 1e-14)
    rest = with_bits(ambit.sqr(ambit.sin(ambit.number "1/7")) + ambit.sqr(ambit.cos(ambit.number "2/14")) - 1, 300)
    assert.is_true(rest:contains(0) and rest:width() < 1e-85)
  end)

  it("takes uncertain data like the others", function()
    local length = ambit.around("6.5", "0.1%")
    local r, plain = with_bits(length * 2, 128), ambit.evaluate { length * 2 }
    assert.is_true(r:contains "12.987" and r:contains "13.013")
    assert.equal(plain.lo, r.lo)
    assert.equal(plain.hi, r.hi)
  end)

  it("is sound beyond the range of doubles", function()
    local big = ambit.exp(ambit.number(1000))
    assert.equal(math.huge, with_bits(big, 128).hi)
    assert.is_true(with_bits(big, 128).lo > 1e308)
    local r = with_bits(ambit.log(big) - "1000", 128)
    assert.is_true(r:contains(0) and r:width() < 1e-30)
  end)

  it("refuses a precision that makes no sense", function()
    for _, bits in ipairs { 1, 0, -1, 1000001 } do
      assert.has_error(function() with_bits(rump(), bits) end)
      local _, message = pcall(with_bits, rump(), bits)
      assert.is_truthy(tostring(message):find("expected 2 to 1000000", 1, true))
    end
    assert.has_error(function() with_bits(rump(), "many") end)
    assert.has_error(function() with_bits(rump(), 2.5) end)
  end)
end)
