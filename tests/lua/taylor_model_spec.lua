-- The Taylor-model arithmetic from a script: options, and the manipulator's true ranges.
local ambit = require "ambit"

local function manipulator(tolerance)
  local lengths, angles = { "6.5", 4, 4, 4, "3.5" }, { 60, -20, -20, -20, -30 }
  local arm = ambit.mechanism "five-arm manipulator"
  local at = arm.world
  for i = 1, 5 do
    local angle = ambit.degrees(ambit.around(angles[i], "0.1"))
    at = arm:sloppy_joint { from = at, axis = "z", angle = angle, play = "0.002" }
    at = arm:rigid_link { from = at, offset = { ambit.around(lengths[i], tolerance), 0, 0 } }
  end
  return arm:position(at)
end

-- contains [lo, hi], known to 9 decimals, and is at most `share` wider
local function is_near(x, lo, hi, share)
  assert.is_true(x.lo <= lo + 5e-10 and hi - 5e-10 <= x.hi)
  assert.is_true(x:width() <= (1 + share) * (hi - lo))
end

describe("taylor_model", function()
  it("stays near the true range of the manipulator", function()
    local tip = ambit.evaluate { manipulator "0.1%", arithmetic = "taylor_model" }
    is_near(tip.x, 17.052681642, 17.155373260, 1e-3)
    is_near(tip.y, 7.706658140, 7.930200616, 1e-3)
    tip = ambit.evaluate { manipulator "1%", arithmetic = "taylor_model" }
    is_near(tip.x, 16.898963790, 17.309527465, 1e-3)
    is_near(tip.y, 7.604628620, 8.032402903, 1e-3)
  end)

  it("narrows with the order", function()
    local x, y = ambit.around(1, "0.2"), ambit.around(2, "0.2")
    local f = ambit.sin(x * y) / y - ambit.exp(x) * y
    local last = math.huge
    for order = 0, 8, 2 do
      local r = ambit.evaluate { f, arithmetic = { "taylor_model", order = order } }
      assert.is_true(r:width() <= last)
      last = r:width()
    end
    local inner = ambit.sample { f, n = 2000 }
    assert.is_true(ambit.evaluate({ f, arithmetic = { "taylor_model", order = 8 } }):contains(inner))
    assert.is_true(last < 1.5 * inner:width())
  end)

  it("is never wider than intervals", function()
    local x = ambit.between("-0.5", 3)
    for _, f in ipairs { x * x - x, ambit.exp(x) / (x + 1), ambit.atan(x) * ambit.cos(x), ambit.abs(x) - x } do
      local wide, narrow = ambit.evaluate { f }, ambit.evaluate { f, arithmetic = "taylor_model" }
      assert.is_true(wide:contains(narrow))
    end
  end)

  it("refuses what does not fit into memory, with its size", function()
    local sum = 0
    for i = 1, 60 do sum = sum + ambit.between(i, i + 1) end
    local done, message = pcall(ambit.evaluate, { sum, arithmetic = { "taylor_model", order = 20 } })
    assert.is_false(done)
    assert.is_truthy(tostring(message):find "monomials")
    assert.is_truthy(tostring(message):find "bytes")
  end)

  it("checks its options", function()
    assert.has_error(function() ambit.evaluate { 1, arithmetic = { "taylor_model", order = 99 } } end)
    assert.has_error(function() ambit.evaluate { 1, arithmetic = { "taylor_model", orders = 3 } } end)
  end)
end)
