-- The arithmetic affine, as a scene uses it.
local ambit = require "ambit"

local function affine(e, options)
  options = options or {}
  options[1] = "affine"
  return ambit.evaluate { e, arithmetic = options }
end

-- five arms with sloppy joints (SmartMOBILE 2007, table 1)
local function hand(tolerance)
  local lengths, angles = { "6.5", 4, 4, 4, "3.5" }, { 60, -20, -20, -20, -30 }
  local arm = ambit.mechanism "five-arm manipulator"
  local at = arm.world
  for i = 1, 5 do
    at = arm:sloppy_joint { from = at, axis = "z", angle = ambit.degrees(ambit.around(angles[i], "0.1")),
      play = "0.002" }
    at = arm:rigid_link { from = at, offset = { ambit.around(lengths[i], tolerance), 0, 0 } }
  end
  return arm:position(at)
end

-- `true_*`: the hulls, cut inward to nine decimals
local function check_hand(tolerance, options, room, true_x, true_y)
  local tip = affine(hand(tolerance), options)
  for name, hull in pairs { x = true_x, y = true_y } do
    assert.is_true(tip[name]:contains(ambit.interval(hull[1], hull[2])))
    assert.is_true(tip[name]:width() < room * (hull[2] - hull[1]))
  end
end

describe("affine", function()
  it("encloses the hand of the manipulator within 1 percent of the true hull", function()
    local x, y = { 17.052681642, 17.155373260 }, { 7.706658141, 7.930200615 }
    check_hand("0.1%", {}, 1.01, x, y)
    check_hand("0.1%", { linearisation = "min_range", product = "tight", symbols = 0 }, 1.01, x, y)
    check_hand("1%", {}, 1.01, { 16.898963790, 17.309527464 }, { 7.604628621, 8.032402902 })
  end)

  it("knows what quantities have in common", function()
    local a = ambit.between(1, 2)
    local e = ambit.exp(a)
    assert.equal(0, affine(2 * e - e - e):width())
    assert.is_true(affine(ambit.sin(a) ^ 2 + ambit.cos(a) ^ 2):width() < 0.2)
    assert.is_true(affine(a / (a + 1)):width() < 0.2)
  end)

  it("is never wider than interval", function()
    local a, b = ambit.between("-0.5", 3), ambit.between("-0.1", "0.2")
    for _, e in ipairs { ambit.exp(a) * b, ambit.sqr(a + b), ambit.atan2(b, a + 1), ambit.max(a, b), ambit.abs(a),
      ambit.sqrt(a + 1) / (b + 1), ambit.sin(5 * a) } do
      assert.is_true(ambit.evaluate({ e }):contains(affine(e)))
    end
  end)

  it("repays symbols for errors", function()
    local x, y = ambit.between("1.9", 2), ambit.between(0, "0.1")
    for _ = 1, 60 do x, y = x + 0.05 * y, y + 0.05 * ((1 - x * x) * y - x) end
    local none, some, many = affine(x, { symbols = 0 }), affine(x, { symbols = 8 }), affine(x)
    assert.is_true(some:width() < 0.2 * none:width() and many:width() < 0.8 * some:width())
  end)

  it("marks what left the domain", function()
    assert.is_true(affine(ambit.sqrt(ambit.between(-1, 1))).partial)
    assert.is_false(affine(ambit.sqrt(ambit.between(0, 1))).partial)
  end)

  it("refuses what does not fit into memory, with the size needed", function()
    assert.has_error(function() affine(ambit.between(0, 1), { symbols = 1000000000000000 }) end)
    local ok, message = pcall(affine, ambit.between(0, 1), { symbols = 1000000000000000 })
    assert.is_false(ok)
    assert.truthy(tostring(message):find("`affine`: 1000000000000000 symbols and 1 uncertain data need %S+ bytes"))
    ok, message = pcall(affine, ambit.between(0, 1), { symbols = -3 })
    assert.is_false(ok)
    assert.truthy(tostring(message):find("`symbols` must not be negative", 1, true))
  end)
end)
