-- Intervals with derivatives, and the monotonicity test in evaluate.
local ambit = require "ambit"

local function gradient(e) return ambit.evaluate { e, arithmetic = "gradient" } end

describe("gradient", function()
  it("finds the range of a monotone expression at its corners", function()
    local x, y = ambit.between(1, 2), ambit.between(2, 3)
    local r = gradient(x * y - x)
    assert.equal(1, r.lo)
    assert.equal(4, r.hi)
  end)

  it("uses the mean-value form where nothing is monotone", function()
    local x, y = ambit.between("0.9", "1.1"), ambit.between("0.9", "1.1")
    local e = x * x - 2 * x * y + y * y -- (x - y)^2, expanded: [0, 0.04]
    local natural, mean = ambit.evaluate { e }, gradient(e)
    assert.is_true(natural:contains(mean))
    assert.is_true(mean:contains(0) and mean:contains "0.04")
    assert.is_true(mean:width() < natural:width() / 4)
  end)

  it("keeps to intervals where a path leaves the domain", function()
    local x = ambit.between(-1, 1)
    local r = gradient(ambit.sqrt(x) - x)
    assert.is_true(r.partial)
    assert.is_true(r:contains(0) and r:contains "0.25")
  end)

  it("does not take a jump for a descent", function()
    local r = gradient(ambit.atan2(ambit.between(-1, 1), -1))
    assert.is_true(r:contains(ambit.interval("[-3.1415, 3.1415]")))
  end)

  it("gives the manipulator's hull to all digits", function()
    local arm = ambit.mechanism "arm"
    local at = arm.world
    local lengths, angles = { "6.5", 4, 4, 4, "3.5" }, { 60, -20, -20, -20, -30 }
    for i = 1, 5 do
      local angle = ambit.degrees(ambit.around(angles[i], "0.1"))
      at = arm:sloppy_joint { from = at, axis = "z", angle = angle, play = "0.002" }
      at = arm:rigid_link { from = at, offset = { ambit.around(lengths[i], "0.1%"), 0, 0 } }
    end
    local r = gradient(arm:position(at))
    -- the true hull, by an independent computation to ten digits
    assert.is_true(r.x:contains(ambit.interval("[17.052681643, 17.155373259]")))
    assert.is_true(r.y:contains(ambit.interval("[7.706658141, 7.930200615]")))
    assert.is_true(ambit.interval("[17.052681641, 17.155373261]"):contains(r.x))
    assert.is_true(ambit.interval("[7.706658139, 7.930200617]"):contains(r.y))
  end)
end)
