-- Mechanisms: elements, kinematics, equations of motion.
local ambit = require "ambit"
local around = ambit.around

local function value(e, at) return ambit.evaluate({ e, at = at }) end
local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-14), ("%s is not %s"):format(tostring(x), y))
end

describe("a mechanism", function()
  it("places frames", function()
    local m = ambit.mechanism "arm"
    local at = m:revolute { from = m.world, axis = "z", name = "q" }
    at = m:rigid_link { from = at, offset = { 2, 0, 0 } }
    local p = value(m:position(at), { q = ambit.pi / 6 })
    near(p.x, math.sqrt(3))
    near(p.y, 1)
    assert.equal(p.x, p[1])
    local r = value(m:orientation(at), { q = ambit.pi / 2 })
    near(r[1][2], -1)
    near(r[3][3], 1)
  end)

  it("gives velocity and acceleration in world axes", function()
    local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
    local at = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 2, 0, 0 } }
    local state = { q = ambit.pi / 2, ["q'"] = 3, ["q''"] = 5 }
    local v = value(m:velocity(at), state)
    near(v.x, -6)
    near(v.y, 0)
    near(value(m:angular_velocity(at), state).z, 3)
    local a = value(m:acceleration(at), state)
    near(a.x, -10, 1e-13)
    near(a.y, -18, 1e-13)
  end)

  it("writes equations of motion", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, -10, 0 } }
    local hand = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 0, -2, 0 } }
    m:point_mass { at = hand, mass = 3 }
    local d = m:dynamics()
    assert.same({ "q", "q'" }, d.states)
    near(value(d:rate "q'", { q = "0.5" }), -5 * math.sin(0.5))
    near(value(m:mass_matrix()[1][1], { q = 1 }), 12)
    local e = value(m:energy(), { q = 0, ["q'"] = 1 })
    near(e.kinetic, 6)
    assert.equal(d, m:dynamics())
  end)

  it("records a Lua function as a law of force", function()
    local m = ambit.mechanism "spring"
    local at = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = at, mass = 2 }
    m:joint_torque { joint = at, force = function(s, v) return -8 * s - 2 * v end }
    near(value(m:dynamics():rate "s'", { s = 1, ["s'"] = 3 }), -7)
  end)

  it("an error in a law keeps its own line", function()
    local m = ambit.mechanism "spring"
    local at = m:prismatic { from = m.world, axis = "x", name = "s" }
    local _, problem = pcall(function()
      m:joint_torque { joint = at, force = function() error "the law broke" end }
    end)
    assert.truthy(problem:find "mechanism_spec.lua:%d+: the law broke")
  end)

  it("knows every method of the modules that it reads later", function()
    local check = require "ambit.check"
    for home, names in pairs(require "ambit.mechanism".homes) do
      local listed = {}
      for name in names:gmatch "%S+" do listed[name] = true end
      assert.are.same(check.sorted(require("ambit." .. home).methods), check.sorted(listed), home)
    end
  end)

  it("builds only what is asked for", function()
    local core = require "ambit.core"
    local m = ambit.mechanism "arm"
    local at = m:revolute { from = m.world, axis = "z" }
    m:point_mass { at = m:rigid_link { from = at, offset = { 1, 0, 0 } }, mass = 1 }
    assert.equal(0, (core.pulled(m.handle)))
    m:position(at)
    local some, all = core.pulled(m.handle)
    assert.is_true(some > 0 and some < all)
  end)

  it("builds and evaluates a chain of 1000 links in under two seconds", function()
    local start = os.clock()
    local m = ambit.mechanism "chain"
    local at = m.world
    for i = 1, 1000 do
      at = m:sloppy_joint { from = at, axis = "z", angle = around(0.001 * (i % 7), "0.001"), play = "0.0001" }
      at = m:rigid_link { from = at, offset = { around("0.01", "1%"), 0, 0 } }
    end
    local p = m:position(at)
    local real, interval = ambit.evaluate { p, arithmetic = "real" }, ambit.evaluate { p, arithmetic = "interval" }
    local seconds = os.clock() - start
    assert.is_true(interval.x:contains(real.x.lo))
    assert.is_true(seconds < 2, ("%.2f s"):format(seconds))
  end)
end)
