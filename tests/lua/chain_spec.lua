-- Chains: Lua functions as elements; names, parameters, what they hand out, the tree.
local ambit = require "ambit"

local function value(e, at) return ambit.evaluate { e, at = at } end
local function near(y, x) assert.is_true(math.abs(x:mid() - y) < 1e-14, ("%s is not %s"):format(tostring(x), y)) end

local leg = ambit.chain { "spec_leg", doc = "a thigh and a shank", ports = { from = "frame" },
  parameters = { thigh = { "m", "0.4", "length of the thigh" }, shank = { "m", "0.5" },
    axis = { "1", "z", shape = "axis" } },
  build = function(m, p)
    local hip = m:revolute { from = p.from, axis = p.axis, name = "hip" }
    local knee, joint = m:revolute { from = m:rigid_link { from = hip, offset = { p.thigh, 0, 0 } }, name = "knee" }
    return { foot = m:rigid_link { from = knee, offset = { p.shank, 0, 0 } }, knee = joint }
  end,
}

ambit.chain { "spec_robot", ports = { base = { "frame", "what carries it" } }, parameters = { thigh = { "m", "0.7" } },
  build = function(m, p)
    return { left = m:spec_leg { from = p.base, name = "left" }, right = m:spec_leg { from = p.base, thigh = "0.3" },
      thigh = p.thigh }
  end,
}

describe("a chain", function()
  it("is used like an element, by name and as a value", function()
    local m = ambit.mechanism "m"
    local a = m:spec_leg { from = m.world, name = "a" }
    local b = leg(m, { from = a.foot, thigh = 1 })
    near(2.4, value(m:position(b.foot), { ["a.hip"] = 0, ["a.knee"] = 0, ["spec_leg1.hip"] = 0,
      ["spec_leg1.knee"] = 0 }).x)
    assert.equal("spec_leg `a`", tostring(a))
  end)

  it("stands for its only frame and its only joint", function()
    local m = ambit.mechanism "m"
    local a = m:spec_leg { from = m.world }
    m:point_mass { at = a, mass = 1 }
    m:joint_torque { joint = a, torque = 3 }
    local b = m:rigid_link { from = a, offset = { 1, 0, 0 } }
    near(1.9, value(m:position(b), { ["spec_leg1.hip"] = 0, ["spec_leg1.knee"] = 0 }).x)
    near(0.9, value(m:position(a), { ["spec_leg1.hip"] = 0, ["spec_leg1.knee"] = 0 }).x)
  end)

  it("names its parts after itself, also within another one", function()
    local m = ambit.mechanism "m"
    m:spec_robot { base = m.world, name = "robot" }
    m:spec_robot { base = m.world }
    local names = m:coordinates()
    for _, name in ipairs { "robot.left.hip", "robot.left.knee'", "robot.spec_leg1.knee''", "spec_robot1.left.hip" } do
      assert.truthy(names[name], name)
    end
  end)

  it("takes parameters that are not given from the chain around it, then from its own defaults", function()
    local m = ambit.mechanism "m"
    local r = m:spec_robot { base = m.world, name = "r", thigh = "0.6" }
    local at = { ["r.left.hip"] = 0, ["r.left.knee"] = 0, ["r.spec_leg1.hip"] = 0, ["r.spec_leg1.knee"] = 0 }
    local left, right = {}, {}
    for k, v in pairs(at) do (k:find "left" and left or right)[k] = v end
    near(1.1, value(m:position(r.left), left).x)
    near(0.8, value(m:position(r.right), right).x)
    local defaulted = m:spec_robot { base = m.world, name = "s" }
    near(1.2, value(m:position(defaulted.left), { ["s.left.hip"] = 0, ["s.left.knee"] = 0 }).x)
    near(0.7, value(defaulted.thigh))
  end)

  it("keeps an uncertain datum one unknown, whoever inherits it", function()
    local m = ambit.mechanism "m"
    local r = m:spec_robot { base = m.world, name = "r", thigh = ambit.around("0.6", "10%") }
    local knee = m:rigid_link { from = m.world, offset = { r.thigh, 0, 0 } }
    local gap = m:position(r.left) - m:position(knee)
    local x = ambit.evaluate { gap.x, at = { ["r.left.hip"] = 0, ["r.left.knee"] = 0 }, arithmetic = "affine" }
    assert.is_true(x:contains(0.5) and x:width() < 1e-14)
  end)

  it("gives build each shape as Lua likes it", function()
    local seen
    ambit.chain { "spec_shapes", ports = { from = { "frame", "perhaps", optional = true } },
      parameters = { number = { "m", 2 }, vector = { "m", "1,2,3", shape = "3" }, matrix = { "1", "0", shape = "3x3" },
        flag = { "1", true, shape = "flag" }, count = { "1", "3", shape = "integer" },
        word = { "1", "two", shape = "one|two" }, law = { "1", shape = "any", optional = true },
        axis = { "1", "-y", shape = "axis" }, missing = { "m", optional = true } },
      build = function(_, p)
        seen = p
        return {}
      end }
    local m = ambit.mechanism "m"
    m:spec_shapes { law = print, matrix = { { 1, 2, 3 }, { 4, 5, 6 }, { 7, 8, 9 } } }
    assert.equal(2, value(seen.number):mid())
    assert.equal(3, value(seen.vector).z:mid())
    assert.equal(6, value(seen.matrix[2][3]):mid())
    assert.equal(-1, value(seen.axis.y):mid())
    assert.equal(true, seen.flag)
    assert.equal(3, seen.count)
    assert.equal("two", seen.word)
    assert.equal(print, seen.law)
    assert.is_nil(seen.missing)
    assert.is_nil(seen.from)
    m:spec_shapes { word = "one", flag = false, count = 5 }
    assert.equal("one", seen.word)
    assert.equal(false, seen.flag)
    assert.equal(5, seen.count)
  end)

  it("may return a frame and a joint, as an element does", function()
    ambit.chain { "spec_hinge", ports = { from = "frame" },
      build = function(m, p) return m:revolute { from = p.from } end }
    local m = ambit.mechanism "m"
    local h = m:spec_hinge { from = m.world }
    assert.truthy(h.to and h.joint)
    assert.equal("joint of spec_hinge1.revolute1", tostring(h.joint))
    m:point_mass { at = h, mass = 1 }
  end)

  it("may build itself, as deep as it says", function()
    ambit.chain { "spec_twig", ports = { from = "frame" }, parameters = { n = { "1", 3, shape = "integer" } },
      build = function(m, p)
        local to, joint = m:revolute { from = p.from, name = "j" }
        if p.n > 1 then m:spec_twig { from = to, n = p.n - 1, name = "t" } end
        return to, joint
      end }
    local m = ambit.mechanism "m"
    m:spec_twig { from = m.world, name = "t" }
    local names = {}
    for name in pairs(m:coordinates()) do if not name:find "'" then names[#names + 1] = name end end
    table.sort(names)
    assert.same({ "t.j", "t.t.j", "t.t.t.j" }, names)
  end)

  it("may be defined again by the same line", function()
    local function define(length)
      ambit.chain { "spec_again", ports = { from = "frame" },
        build = function(m, p) return m:rigid_link { from = p.from, offset = { length, 0, 0 } } end }
    end
    local m = ambit.mechanism "m"
    define(1)
    local a = m:spec_again { from = m.world }
    define(2)
    local b = m:spec_again { from = m.world }
    assert.equal(1, value(m:position(a)).x:mid())
    assert.equal(2, value(m:position(b)).x:mid())
  end)

  it("leaves an error in build with its own line, and the mechanism usable", function()
    local m = ambit.mechanism "m"
    ambit.chain { "spec_broken", build = function(inner)
      inner:rigid_link { from = inner.world, offset = { 1, 0, 0 } }
      error "it broke"
    end }
    local _, problem = pcall(function() m:spec_broken {} end)
    assert.truthy(problem:find("chain_spec.lua:%d+: it broke"), problem)
    m:revolute { from = m.world, name = "after" }
    assert.truthy(m:coordinates().after) -- not spec_broken1.after
  end)
end)

describe("the tree of a mechanism", function()
  it("shows chains within chains", function()
    local m = ambit.mechanism { "m", gravity = { 0, 0, "-9.81" } }
    m:spec_robot { base = m.world, name = "robot" }
    m:rigid_link { from = m.world, offset = { 1, 0, 0 } }
    local t = m:tree()
    local function text(node)
      local parts = {}
      for i, part in ipairs(node.parts or {}) do parts[i] = text(part) end
      return node.name .. (node.parts and ("(%s)"):format(table.concat(parts, " ")) or "")
    end
    assert.equal("m(gravity1 robot(left(hip rigid_link1 knee rigid_link2) "
      .. "spec_leg1(hip rigid_link1 knee rigid_link2)) rigid_link1)", text(t))
    local knee = t.parts[2].parts[1].parts[3]
    assert.equal("robot.left.knee", knee.path)
    assert.equal("revolute", knee.type)
    assert.truthy(knee.where:find "chain_spec.lua:%d+$")
    assert.equal("spec_leg", t.parts[2].parts[1].type)
    assert.equal("a thigh and a shank", t.parts[2].parts[1].doc)
  end)
end)
