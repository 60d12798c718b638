-- Equations of motion as Lua values: a double pendulum with known formulas, shapes, forms, messages.
local ambit = require "ambit"

local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-12) and x:width() <= 1e-11,
    ("%s is not %s"):format(tostring(x), y))
end

local function double_pendulum()
  local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
  local shoulder = m:revolute { from = m.world, name = "a" }
  local elbow = m:rigid_link { from = shoulder, offset = { 0, -1, 0 } }
  local hand = m:rigid_link { from = m:revolute { from = elbow, name = "b" }, offset = { 0, -1, 0 } }
  m:point_mass { at = elbow, mass = 1 }
  m:point_mass { at = hand, mass = 1 }
  return m, hand, shoulder
end

local function chain(n)
  local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
  local at = m.world
  for i = 1, n do
    at = m:rigid_link { from = m:revolute { from = at, name = "q" .. i }, offset = { 0, -1, 0 } }
    m:point_mass { at = at, mass = 1 }
  end
  return m
end

local at = { a = "0.3", b = "-0.7", ["a'"] = "1.1", ["b'"] = "0.4" }
local function with(t)
  local all = {}
  for _, source in ipairs { at, t } do
    for key, value in pairs(source) do all[key] = value end
  end
  return all
end
local function value(e, more) return ambit.evaluate { e, at = with(more or {}) } end

-- by hand, relative angles
local a, b, da, db, g = 0.3, -0.7, 1.1, 0.4, 9.81
local m11, m12 = 3 + 2 * math.cos(b), 1 + math.cos(b)
local weight = { g * (2 * math.sin(a) + math.sin(a + b)), g * math.sin(a + b) }
local bias = { -math.sin(b) * db * (2 * da + db) + weight[1], math.sin(b) * da * da + weight[2] }

describe("dynamics", function()
  it("names its variables", function()
    local m = double_pendulum()
    assert.same({ "a", "b" }, m:coordinate_names())
    assert.same({ "a'", "b'" }, m:speed_names())
  end)

  it("M q'' + bias = tau", function()
    local m = double_pendulum()
    local mass = value(m:mass_matrix())
    near(mass[1][1], m11)
    near(mass[1][2], m12)
    near(mass[2][1], m12)
    near(mass[2][2], 1)
    local c, w, h = value(m:bias()), value(m:gravity_torque()), value(m:generalised_forces())
    for i = 1, 2 do
      near(c[i], bias[i])
      near(w[i], weight[i])
      near(h[i], -bias[i])
    end
    local tau = value(m:inverse_dynamics(), { ["a''"] = 2, ["b''"] = -3 })
    near(tau[1], 2 * m11 - 3 * m12 + bias[1])
    near(tau[2], 2 * m12 - 3 + bias[2])
  end)

  it("springs are part of the bias, not of gravity", function()
    local m, _, shoulder = double_pendulum()
    m:joint_spring { joint = shoulder, stiffness = 5 }
    near(value(m:gravity_torque())[1], weight[1])
    near(value(m:bias())[1], bias[1] + 5 * a)
    near(value(m:bias())[2], bias[2])
  end)

  it("both forms of forward dynamics give the accelerations", function()
    local m = double_pendulum()
    local tau = { tau_a = "0.5", tau_b = "-0.25" }
    local det = m11 - m12 * m12
    local r1, r2 = 0.5 - bias[1], -0.25 - bias[2]
    for _, form in ipairs { "mass_matrix", "articulated", "auto" } do
      local q = value(m:forward_dynamics { form = form }, tau)
      near(q[1], (r1 - m12 * r2) / det)
      near(q[2], (m11 * r2 - m12 * r1) / det)
      local d = m:dynamics { form = form }
      assert.same({ "a", "b", "a'", "b'" }, d.states)
    end
    near(value(m:forward_dynamics "articulated", tau)[1], (r1 - m12 * r2) / det)
    assert.equal(m:dynamics(), m:dynamics())
    assert.not_equal(m:dynamics(), m:dynamics "articulated")
  end)

  it("forward undoes inverse", function()
    local m = chain(7)
    local forward, inverse = m:forward_dynamics(), m:inverse_dynamics()
    local state, motion = {}, {}
    for i = 1, 7 do
      local q = "q" .. i
      state[q], state[q .. "'"] = i / 8, 1 - i / 4
      motion[q .. "''"] = i - 3
    end
    for key, x in pairs(state) do motion[key] = x end
    local tau = ambit.evaluate { inverse, at = motion, arithmetic = "real" }
    for i = 1, 7 do state["tau_q" .. i] = tau[i]:mid() end
    local q = ambit.evaluate { forward, at = state, arithmetic = "real" }
    for i = 1, 7 do assert.is_true(math.abs(q[i]:mid() - (i - 3)) < 1e-10) end
  end)

  it("gives the Jacobian of a frame and of a point", function()
    local m, hand = double_pendulum()
    local j = value(m:jacobian(hand))
    assert.equal(6, #j)
    near(j[3][1], 1)
    near(j[3][2], 1)
    near(j[4][1], math.cos(a) + math.cos(a + b))
    near(j[5][2], math.sin(a + b))
    near(j[1][1], 0)
    local p = value(m:jacobian { hand, { 0, "0.5", 0 } })
    near(p[4][2], 0.5 * math.cos(a + b))
    local v = m:velocity(hand)
    near(value(v.x), (math.cos(a) + math.cos(a + b)) * da + math.cos(a + b) * db)
  end)

  it("knows energy and power", function()
    local m = ambit.mechanism "damped"
    local at_slider = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = at_slider, mass = 2 }
    m:joint_damper { joint = at_slider, damping = 3 }
    local e = ambit.evaluate { { m:energy(), m:power() }, at = { s = 0, ["s'"] = 2 } }
    near(e[1].kinetic, 4)
    near(e[1].total, 4)
    near(e[2], -12)
  end)

  it("keeps shapes through evaluate", function()
    local m = double_pendulum()
    local all = value { m = m:mass_matrix(), tau = m:bias() }
    near(all.m[1][2], m12)
    near(all.tau[2], bias[2])
  end)

  it("costs what the mechanism costs, whatever else there is", function()
    local core = require "ambit.core"
    local function arm(name, links)
      local m = ambit.mechanism { name, gravity = { 0, "-9.81", 0 } }
      local at = m.world
      for i = 1, links do
        local hinge = m:revolute { from = at, axis = "z", name = "q" .. i }
        at = m:rigid_link { from = hinge, offset = { ambit.around(1, "1%"), 0, 0 } }
        m:point_mass { at = at, mass = ambit.around(1, "1%") }
      end
      return m
    end
    local function cost(name)
      local m, before = arm(name, 3), core.answers()
      m:dynamics()
      local after = core.answers()
      return after.asked - before.asked, after.nodes - before.nodes
    end
    local asked, nodes = cost "alone"
    local datum, kept = ambit.around(1, "1%"), {}
    for i = 1, 100000 do kept[i] = datum * i + i end
    arm("chain", 40):dynamics()
    local asked_beside, nodes_beside = cost "beside"
    assert.is_true(asked > 1000 and asked_beside < 1.01 * asked and nodes_beside < 1.05 * nodes,
      ("%d operations for %d, %d nodes for %d"):format(asked_beside, asked, nodes_beside, nodes))
    assert.equal(100000, #kept)
  end)

  it("refuses with a reason", function()
    local function message(f, ...)
      local ok, text = pcall(f, ...)
      assert.is_false(ok)
      return text
    end
    local still = ambit.mechanism "stone"
    local questions = { "mass_matrix", "bias", "gravity_torque", "inverse_dynamics", "forward_dynamics", "dynamics" }
    for _, name in ipairs(questions) do
      assert.matches("dynamics_spec.lua:%d+: .*no coordinates", message(function() return still[name](still) end))
    end
    assert.matches("no coordinates", message(function() return still:jacobian(still.world) end))
    local m, hand = double_pendulum()
    assert.matches("there is no form `articulate`; did you mean `articulated`",
      message(m.dynamics, m, { form = "articulate" }))
    assert.matches("unknown key `from`", message(m.forward_dynamics, m, { from = "articulated" }))
    assert.matches("expected { frame, { x, y, z } }", message(m.jacobian, m, { hand, 3 }))
    assert.matches("expected a frame", message(m.jacobian, m, 3))
  end)
end)
