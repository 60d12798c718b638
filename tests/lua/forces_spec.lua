-- Force elements: closed forms, the balance of energy and power, every arithmetic, bad input.
local ambit = require "ambit"
local core = require "ambit.core"
local around = ambit.around

local function value(e, at) return ambit.evaluate { e, at = at } end

local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-13), ("%s is not %.17g"):format(tostring(x), y))
  assert.is_true(x:width() <= 1e-11, ("%s is wide"):format(tostring(x)))
end

-- A slider along x with a mass of 2 kg: q'' is the force by half.
local function slider()
  local m = ambit.mechanism "slider"
  local at, joint = m:prismatic { from = m.world, axis = "x", name = "s" }
  m:point_mass { at = at, mass = 2 }
  return m, at, joint
end

-- A bar on a hinge about z: inertia 3 about the hinge.
local function bar()
  local m = ambit.mechanism "bar"
  local at, joint = m:revolute { from = m.world, axis = "z", name = "q" }
  m:rigid_body { at = at, mass = 1, inertia = { { 3, 0, 0 }, { 0, 3, 0 }, { 0, 0, 3 } } }
  return m, at, joint
end

local function force_on_slider(add, state)
  local m, at, joint = slider()
  add(m, at, joint)
  return 2 * value(m:dynamics():rate "s'", state)
end

local function torque_on_bar(add, state)
  local m, at, joint = bar()
  add(m, at, joint)
  return 3 * value(m:dynamics():rate "q'", state)
end

-- d(energy)/dt - power along the motion, as an expression of the states.
local function imbalance(m)
  local system, symbols = m:dynamics(), m:coordinates()
  local energy, leaves, rates = m:energy().total, {}, {}
  local rate = ambit.derivative(energy, ambit.time)
  for _, name in ipairs(system.states) do
    rate = rate + ambit.derivative(energy, symbols[name]) * system:rate(name)
  end
  for i, speed in ipairs(core.speeds(m.handle)) do leaves[i], rates[i] = speed.du, system:rate(speed.name) end
  return rate - core.substitute({ m:power() }, leaves, rates)[1]
end

local function expect_balance(m, state)
  local x = value(imbalance(m), state)
  assert.is_true(x:contains(0), tostring(x))
  assert.is_true(x:width() < 1e-9, tostring(x))
end

describe("a force on a joint", function()
  it("is a spring, with its rest position and its energy", function()
    near(force_on_slider(function(m, _, j) m:joint_spring { joint = j, stiffness = 8, rest = "0.25" } end,
      { s = 1 }), -6)
    near(torque_on_bar(function(m, at) m:joint_spring { joint = at, stiffness = "4 N m/rad" } end, { q = 2 }), -8)
    local m, _, joint = slider()
    m:joint_spring { joint = joint, stiffness = "8 N/m", rest = "25 cm" }
    near(value(m:energy().potential, { s = 1 }), 8 * 0.75 ^ 2 / 2)
    assert.equal("0", tostring(m:power()))
  end)

  it("is a servo where the rest position moves", function()
    local m, _, joint = slider()
    m:joint_spring { joint = joint, stiffness = 8, rest = ambit.sin(ambit.time) }
    near(value(m:power(), { s = 1, t = "0.5" }), -8 * (1 - math.sin(0.5)) * math.cos(0.5))
    expect_balance(m, { s = 1, ["s'"] = "0.3", t = "0.5" })
  end)

  it("is a damper", function()
    local m, at = bar()
    m:joint_damper { joint = at, damping = "1.5" }
    near(3 * value(m:dynamics():rate "q'", { ["q'"] = 2 }), -3)
    near(value(m:power(), { ["q'"] = 2 }), -6)
  end)

  it("is smooth friction: within a per mille of Coulomb's at four times its velocity", function()
    local function friction(v)
      return force_on_slider(function(m, _, j)
        m:joint_friction { joint = j, coulomb = 5, velocity = "0.01", viscous = 3 }
      end, { ["s'"] = v }):mid()
    end
    assert.is_true(math.abs(friction(2) + 11) < 1e-12)
    assert.is_true(math.abs(friction("0.04") + 5 * 0.9993293 + 0.12) < 1e-6)
    assert.is_true(math.abs(friction("-0.04") - 5 * 0.9993293 - 0.12) < 1e-6)
    assert.equal(0, friction(0))
  end)

  it("has Stribeck's peak", function()
    local function friction(v)
      return force_on_slider(function(m, _, j)
        m:joint_friction { joint = j, coulomb = 5, static = 8, stribeck_velocity = "0.1", velocity = "0.001" }
      end, { ["s'"] = v })
    end
    near(friction "0.1", -(5 + 3 * math.exp(-1)), 1e-12)
    near(friction(3), -5, 1e-12)
  end)

  it("takes energy away, never puts it in", function()
    local m, _, joint = slider()
    m:joint_friction { joint = joint, coulomb = 5, static = 8, viscous = 1 }
    local p = ambit.evaluate { m:power(), at = { ["s'"] = ambit.between(-3, 3) } }
    assert.is_true(p.lo < -15)
    local q = ambit.evaluate { m:power(), at = { ["s'"] = ambit.between(1, 3) } }
    assert.is_true(q.hi < 0)
  end)
end)

describe("a force between two points", function()
  local function spring(t)
    local m, at = slider()
    local anchor = m:ground { position = { 0, 3, 0 } }
    t.from, t.to = anchor, at
    t.to_offset = { 0, -1, 0 }
    m:spring_damper(t)
    return m
  end

  it("is a spring and a damper along the line", function()
    local m = spring { stiffness = 10, length = 2, damping = "0.5" } -- from (0, 3) to (s, -1): length 5 at s = 3
    near(2 * value(m:dynamics():rate "s'", { s = 3, ["s'"] = 2 }), -(10 * 3 + 0.5 * 2 * 3 / 5) * 3 / 5)
    near(value(m:energy().potential, { s = 3 }), 45)
    near(value(m:power(), { s = 3, ["s'"] = 2 }), -0.5 * (2 * 3 / 5) ^ 2)
    expect_balance(m, { s = "0.7", ["s'"] = "-1.1" })
  end)

  it("has no singular position without a rest length", function()
    local m, at = slider()
    m:spring_damper { from = m.world, to = at, stiffness = 10 }
    near(2 * value(m:dynamics():rate "s'", { s = 0 }), 0)
    near(2 * value(m:dynamics():rate "s'", { s = -1 }), 10)
  end)

  it("says so where the points may meet", function()
    local m, at = slider()
    m:spring_damper { from = m.world, to = at, stiffness = 10, length = 1 }
    local x = value(m:dynamics():rate "s'", { s = ambit.between(-1, 1) })
    assert.is_true(x.lo == -math.huge and x.hi == math.huge, tostring(x))
    local run = ambit.simulate { m:dynamics(), initial = { s = "0.5", ["s'"] = -4 }, t = { 0, 1 }, solver = "lohner" }
    assert.equal("unable", run.status)
  end)

  it("is any law of length, rate and time", function()
    local m, at = slider()
    local anchor, calls = m:ground { position = { 0, 3, 0 } }, 0
    m:force_law { from = anchor, to = at, to_offset = { 0, -1, 0 }, force = function(l, v, t)
      calls = calls + 1
      return -10 * (l - 2) - v / 2 + 0 * t
    end }
    local other = spring { stiffness = 10, length = 2, damping = "0.5" }
    for _, s in ipairs { "0.3", 3, -2 } do
      local state = { s = s, ["s'"] = "1.25" }
      local x, y = value(m:dynamics():rate "s'", state), value(other:dynamics():rate "s'", state)
      assert.is_true(math.abs(x:mid() - y:mid()) < 1e-13)
    end
    assert.equal(1, calls)
    local p, q = value(m:power(), { s = 3, ["s'"] = 2 }), -(30 + 0.6) * 6 / 5
    near(p, q)
    local pusher, slide = slider()
    pusher:force_law { from = pusher.world, to = slide, force = function(_, _, t) return 4 * t end }
    near(2 * value(pusher:dynamics():rate "s'", { s = 1, t = 3 }), 12) -- positive pushes apart
    near(2 * value(pusher:dynamics():rate "s'", { s = -1, t = 3 }), -12)
  end)
end)

describe("a bushing", function()
  it("measures a rotation by 2 tan(angle/2), exactly conservative", function()
    local m, at = bar()
    m:bushing { from = m.world, to = at, rotational_stiffness = { 5, 6, 7 }, rotational_damping = { 0, 0, 2 } }
    local phi, h = 0.8, math.tan(0.4)
    near(3 * value(m:dynamics():rate "q'", { q = "0.8", ["q'"] = 0 }), -7 * 2 * h * (1 + h * h), 1e-12)
    near(value(m:energy().potential, { q = "0.8" }), 7 * (2 * h) ^ 2 / 2)
    near(value(m:power(), { q = "0.8", ["q'"] = "0.5" }), -2 * (0.5 * (1 + h * h)) ^ 2)
    near(3 * value(m:dynamics():rate "q'", { q = "1e-4", ["q'"] = 0 }), -7e-4, 1e-11)
    assert.is_true(2 * h / phi < 1.06)
  end)

  it("pushes back along its own axes", function()
    local m = ambit.mechanism "bush"
    local from = m:ground { axis = "z", angle = ambit.pi / 2 } -- its y axis points along -x
    local at = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = at, mass = 2 }
    m:bushing { from = from, to = at, stiffness = { 100, 30, 100 }, damping = { 100, 4, 100 } }
    near(2 * value(m:dynamics():rate "s'", { s = 1, ["s'"] = 2 }), -38, 1e-11)
  end)

  it("keeps the balance of energy in six degrees of freedom", function()
    local m = ambit.mechanism { "bush", gravity = { 1, 2, -9 } }
    local from = m:revolute { from = m.world, axis = { 1, 2, 3 }, name = "q" }
    m:rigid_body { at = from, mass = 2, inertia = { { 3, 0, 0 }, { 0, 4, 0 }, { 0, 0, 5 } } }
    local to = m:free { from = m.world, name = "b" }
    m:rigid_body { at = to, mass = 1, inertia = { { 2, 0, 0 }, { 0, 3, 0 }, { 0, 0, 4 } } }
    m:bushing { from = from, to = to, stiffness = { 10, 20, 30 }, damping = { 1, 2, 3 },
      rotational_stiffness = { 5, 6, 7 }, rotational_damping = { "0.1", "0.2", "0.3" } }
    expect_balance(m, { q = "0.3", ["b.1"] = "0.2", ["b.2"] = "-0.4", ["b.3"] = "0.5", ["b.4"] = "0.1",
      ["b.5"] = "-0.2", ["b.6"] = "0.3", ["q'"] = "0.6", ["b.1'"] = "-0.7", ["b.2'"] = "0.8", ["b.3'"] = "0.9",
      ["b.4'"] = "1.1", ["b.5'"] = "-1.2", ["b.6'"] = "1.3" })
  end)
end)

describe("an applied load", function()
  it("acts in world or body axes, at a point", function()
    local state = { q = "0.5" }
    local function torque(t)
      return torque_on_bar(function(m, at)
        t.at = at
        m:applied_force(t)
      end, state)
    end
    near(torque { force = { 0, 3, 0 }, offset = { 2, 0, 0 } }, 6 * math.cos(0.5))
    near(torque { force = { 0, 3, 0 }, offset = { 2, 0, 0 }, axes = "body" }, 6)
    near(torque { force = { 3, 0, 0 }, axes = "world" }, 0)
    near(torque_on_bar(function(m, at) m:applied_torque { at = at, torque = { 1, 2, 3 } } end, state), 3)
  end)

  it("may be a function of position and velocity", function()
    local m, at = bar()
    m:applied_force { at = at, offset = { 2, 0, 0 }, force = function(p, v, t) return -3 * v + p * t end }
    near(3 * value(m:dynamics():rate "q'", { q = "0.7", ["q'"] = "0.5", t = 9 }), -3 * 4 * 0.5)
    near(value(m:power(), { q = "0.7", ["q'"] = "0.5", t = 9 }), -3 * 1)
    local other, body = bar()
    other:applied_torque { at = body, axes = "body", torque = function(w) return { 0, 0, -2 * w.z } end }
    near(3 * value(other:dynamics():rate "q'", { ["q'"] = "0.5" }), -1)
    local drag, wing = bar()
    drag:applied_force { at = wing, offset = { 2, 0, 0 }, axes = "body", force = function(_, v)
      return { 0, -v.y, 0 } -- across the bar
    end }
    near(3 * value(drag:dynamics():rate "q'", { q = 2, ["q'"] = "0.5" }), -2)
  end)
end)

describe("a driven joint", function()
  it("puts in what gravity takes", function()
    local m = ambit.mechanism { "crane", gravity = { 0, -10, 0 } }
    local at = m:revolute { from = m.world, axis = "z", angle = 2 * ambit.time }
    m:point_mass { at = m:rigid_link { from = at, offset = { 3, 0, 0 } }, mass = 4 }
    near(value(m:power(), { t = "0.3" }), 4 * 10 * 3 * 2 * math.cos(0.6), 1e-11)
  end)

  it("slides, and screws", function()
    local m = ambit.mechanism { "lift", gravity = { 0, 0, -10 } }
    local at = m:prismatic { from = m.world, axis = "z", displacement = ambit.time ^ 2 }
    m:point_mass { at = at, mass = 3 }
    near(value(m:power(), { t = 2 }), 3 * (10 + 2) * 4, 1e-11)
    local n = ambit.mechanism { "jack", gravity = { 0, 0, -10 } }
    local nut = n:screw { from = n.world, axis = "z", pitch = "0.1", angle = ambit.time * 2 * ambit.pi }
    n:point_mass { at = nut, mass = 3 }
    near(value(n:position(nut).z, { t = 5 }), 0.5, 1e-12)
    near(value(n:power(), { t = 2 }), 3, 1e-11)
  end)

  it("keeps the balance of energy with a load that swings", function()
    local m = ambit.mechanism { "crane", gravity = { 0, -10, 0 } }
    local cart = m:prismatic { from = m.world, axis = "x", displacement = ambit.sin(3 * ambit.time) }
    m:point_mass { at = cart, mass = 5 }
    local hook = m:revolute { from = cart, axis = "z", name = "q" }
    m:point_mass { at = m:rigid_link { from = hook, offset = { 0, -2, 0 } }, mass = 1 }
    expect_balance(m, { q = "0.4", ["q'"] = "-0.8", t = "0.7" })
  end)

  it("does no work of its own where it follows another joint", function()
    local m = ambit.mechanism { "gears", gravity = { 0, -10, 0 } }
    local first, joint = m:revolute { from = m.world, axis = "z", name = "q" }
    m:point_mass { at = m:rigid_link { from = first, offset = { 1, 0, 0 } }, mass = 1 }
    local q = m:coordinates().q
    local second = m:revolute { from = m.world, axis = "z", angle = ambit.time / 2 - 2 * q }
    m:point_mass { at = m:rigid_link { from = second, offset = { 0, 2, 0 } }, mass = 3 }
    m:joint_torque { joint = joint, torque = 5 * ambit.time }
    expect_balance(m, { q = "0.4", ["q'"] = "-0.8", t = "0.7" })
  end)
end)

describe("every force element", function()
  local k = around(8, "5%")
  local add = {
    joint_spring = function(m, _, j) m:joint_spring { joint = j, stiffness = k, rest = "0.1" } end,
    joint_damper = function(m, _, j) m:joint_damper { joint = j, damping = k } end,
    joint_friction = function(m, _, j) m:joint_friction { joint = j, coulomb = k, static = 10, velocity = "0.5" } end,
    spring_damper = function(m, at)
      m:spring_damper { from = m.world, to = at, from_offset = { 0, 2, 0 }, to_offset = { 1, 0, 0 },
        stiffness = k, length = 1, damping = 1 }
    end,
    force_law = function(m, at)
      m:force_law { from = m.world, to = at, from_offset = { 0, 2, 0 }, to_offset = { 1, 0, 0 },
        force = function(l, v) return k / l - v end }
    end,
    bushing = function(m, at)
      m:bushing { from = m.world, to = at, rotational_stiffness = { 1, 1, k }, rotational_damping = { 1, 1, 1 } }
    end,
    applied_force = function(m, at) m:applied_force { at = at, offset = { 1, 0, 0 }, force = { k, k, 0 } } end,
    applied_torque = function(m, at) m:applied_torque { at = at, torque = { 0, k, k } } end,
  }

  for name, build in pairs(add) do
    it(name .. " works in every arithmetic", function()
      local m, at, joint = bar()
      build(m, at, joint)
      local asked = { m:dynamics():rate "q'", m:energy().potential, m:power() }
      local state = { q = around("0.6", "0.05"), ["q'"] = around("0.4", "0.05") }
      local inner = ambit.sample { asked, at = state, n = 200 }
      for _, arithmetic in ipairs { "interval", "affine", "taylor_model" } do
        local x = ambit.evaluate { asked, at = state, arithmetic = arithmetic }
        for i = 1, 3 do
          assert.is_true(x[i].lo <= inner[i].lo and x[i].hi >= inner[i].hi,
            ("%s: %s does not contain %s"):format(arithmetic, tostring(x[i]), tostring(inner[i])))
          assert.is_true(x[i]:width() < 20, ("%s: %s"):format(arithmetic, tostring(x[i])))
        end
      end
      local real = ambit.evaluate { asked, at = { q = "0.6", ["q'"] = "0.4" }, arithmetic = "real" }
      for i = 1, 3 do assert.is_true(real[i].lo == real[i].hi and real[i].lo == real[i].lo) end
    end)

    it(name .. " keeps the balance of energy, and simulates", function()
      local m, at, joint = bar()
      build(m, at, joint)
      local state = { q = "0.6", ["q'"] = "0.4" }
      local x = value(imbalance(m), state)
      assert.is_true(x:contains(0) and x:width() < 20, tostring(x))
      local run = ambit.simulate { m:dynamics(), initial = state, t = { 0, "0.05" }, solver = "lohner" }
      assert.equal("complete", run.status)
    end)
  end
end)

describe("bad input of a force element", function()
  local function refuses(pattern, act)
    local fine, problem = pcall(act)
    assert.is_false(fine)
    assert.truthy(tostring(problem):find(pattern), tostring(problem))
    assert.truthy(tostring(problem):find "forces_spec.lua:%d+")
  end

  it("is one message that names the element and the line", function()
    local m, at, joint = slider()
    refuses("joint_damper `d` .*forces_spec.lua:%d+.*`damping` is negative",
      function() m:joint_damper { joint = joint, damping = -1, name = "d" } end)
    refuses("`damping` is negative", function()
      m:spring_damper { from = m.world, to = at, stiffness = 1, damping = ambit.between(-2, -1) }
    end)
    refuses("rest length is negative", function() m:spring_damper { from = m.world, to = at, length = -1 } end)
    refuses("`coulomb` is negative", function() m:joint_friction { joint = joint, coulomb = -1 } end)
    refuses("`velocity` is 0: expected a speed above 0",
      function() m:joint_friction { joint = joint, coulomb = 1, velocity = 0 } end)
    refuses("`rotational_damping` is negative",
      function() m:bushing { from = m.world, to = at, rotational_damping = { 0, 0, -1 } } end)
    refuses("N/m", function() m:joint_spring { joint = joint, stiffness = "4 N m/rad" } end)
    refuses("did you mean `stiffness`", function() m:joint_spring { joint = joint, stifness = 4 } end)
    refuses("expected one of world, body",
      function() m:applied_force { at = at, force = { 1, 0, 0 }, axes = "wrld" } end)
    refuses("expected 3 numbers, got 2", function() m:applied_force { at = at, force = { 1, 0 } } end)
    refuses("returned nothing", function() m:force_law { from = m.world, to = at, force = function() end } end)
    refuses("one and the same", function()
      m:spring_damper { from = at, to = at, stiffness = 1, length = 1 }
      m:energy()
    end)
  end)

  it("is found when the element is added, not when something is asked", function()
    local m, at, joint = slider()
    local moving = { ambit.time, 1, 0 }
    local _, hinge = m:revolute { from = m.world, axis = "z", name = "hinge" }
    refuses("armature `a` .*the inertia is negative: %-1",
      function() m:armature { joint = hinge, inertia = -1, name = "a" } end)
    refuses("the mass is negative: %-2", function() m:armature { joint = joint, mass = -2 } end)
    refuses("expected either `inertia` .* or `mass`", function() m:armature { joint = joint } end)
    refuses("it is in kg m%^2, but the joint `s` slides",
      function() m:armature { joint = joint, inertia = 1, mass = 1 } end)
    refuses("`mass` moves in time", function() m:armature { joint = joint, mass = ambit.time } end)
    refuses("`rotational_stiffness` moves in time",
      function() m:bushing { from = m.world, to = at, rotational_stiffness = moving } end)
    assert.equal("0", tostring(m:power()))
  end)

  it("a point that moves in its frame, with or without a damper: its power would be missing", function()
    local m, at = slider()
    local moving = { ambit.time, 1, 0 }
    refuses("spring_damper `p` .*`from_offset` moves in time", function()
      m:spring_damper { from = m.world, to = at, from_offset = moving, stiffness = 1, name = "p" }
    end)
    refuses("`to_offset` moves in time", function()
      m:spring_damper { from = m.world, to = at, to_offset = moving, stiffness = 1, length = 1, damping = 1 }
    end)
    refuses("force_law `l` .*`to_offset` moves in time", function()
      m:force_law { from = m.world, to = at, to_offset = moving, force = function(_, v) return -v end, name = "l" }
    end)
  end)

  it("a function that yields, in the middle of which others would write formulas", function()
    local m, at = slider()
    local add = coroutine.wrap(function()
      m:force_law { from = m.world, to = at, force = function(l) coroutine.yield() return -l end }
    end)
    refuses("force_law: a function that writes a formula cannot yield", add)
  end)

  it("a function that returns more than one value, or where none can be", function()
    local m, at, joint = slider()
    refuses("joint_spring: stiffness: the function returned 2 values",
      function() m:joint_spring { joint = joint, stiffness = function() return 1, 2 end } end)
    refuses("applied_force: force: the function returned 3 values: .* a list",
      function() m:applied_force { at = at, force = function() return 1, 2, 3 end } end)
    refuses("returned nothing", function() m:joint_damper { joint = joint, damping = function() return nil end } end)
    refuses("applied_force: axes: cannot be a function",
      function() m:applied_force { at = at, force = { 1, 0, 0 }, axes = function() return "body" end } end)
    refuses("rigid_body: physical: cannot be a function",
      function() m:rigid_body { at = at, mass = 1, physical = function() return true end } end)
  end)

  it("leaves nothing behind", function()
    local m, at, joint = slider()
    pcall(m.joint_damper, m, { joint = joint, damping = -1, name = "d" })
    pcall(m.point_mass, m, { at = at, mass = 0 })
    m:joint_damper { joint = joint, damping = 1, name = "d" }
    near(2 * value(m:dynamics():rate "s'", { ["s'"] = 3 }), -3)
  end)

  it("a spring may be negative: over its dead centre", function()
    near(force_on_slider(function(m, _, j) m:joint_spring { joint = j, stiffness = -8 } end, { s = 1 }), 8)
  end)

  it("a mass of nothing, or less, is refused as it is added", function()
    local m, at = slider()
    refuses("point_mass `p` .*the mass is zero", function() m:point_mass { at = at, mass = 0, name = "p" } end)
    refuses("rigid_body `r` .*the mass is negative: %-1 kg",
      function() m:rigid_body { at = at, mass = ambit.between(-2, -1), name = "r" } end)
    m:point_mass { at = at, mass = ambit.between(0, 1) } -- may be one
  end)

  it("an inertia that no body can have is refused, uncertain as it may be", function()
    local m, at = slider()
    local between = ambit.between
    local function inertia(xx, yy, zz, xy, yx)
      return { at = at, mass = 1, inertia = { { xx, xy or 0, 0 }, { yx or xy or 0, yy, 0 }, { 0, 0, zz } } }
    end
    for _, t in ipairs { inertia(1, 1, between("2.1", 3)), inertia(between(1, "1.1"), 1, between("2.2", 3)),
      inertia(1, between("-0.5", "-0.1"), 1), inertia(1, 1, 1, between("0.9", 1)), inertia(1, 1, 3) } do
      refuses("no body has this inertia", function() m:rigid_body(t) end)
    end
    local lopsided = inertia(1, 1, 1, between("0.1", "0.2"), "0.3")
    for _, physical in ipairs { true, false } do -- published parameters need not be a body's, but symmetric they are
      lopsided.physical = physical
      refuses("not symmetric: row 1, column 2 is 0.1, row 2, column 1 is 0.3", function() m:rigid_body(lopsided) end)
    end
    for _, t in ipairs { inertia(1, 1, between("1.9", 3)), inertia(1, 1, 2), inertia(1, 1, 1, between("0.2", 1)),
      inertia(between(0, 1), between(0, 1), between(0, 1)), inertia("0.1", "0.7", "0.8"), inertia(0, 0, 0) } do
      m:rigid_body(t)
    end
  end)
end)

describe("units of joint forces", function()
  it("fit the joint", function()
    local m = ambit.mechanism "units"
    local _, turns = m:revolute { from = m.world, axis = "z", name = "hinge" }
    local _, slides = m:prismatic { from = m.world, axis = "x", name = "slider" }
    local function said(text, f)
      local good, message = pcall(f)
      assert.is_false(good)
      assert.is_truthy(tostring(message):find(text, 1, true), message)
    end
    said("joint_torque: torque: it is in N m, but the joint `slider` slides", function()
      m:joint_torque { joint = slides, torque = 1 }
    end)
    said("joint_torque: force: it is in N, but the joint `hinge` turns", function()
      m:joint_torque { joint = turns, force = function(q) return -q end }
    end)
    said("armature: inertia: it is in kg m^2, but the joint `slider` slides", function()
      m:armature { joint = slides, inertia = 1 }
    end)
    said("N m", function() m:joint_torque { joint = turns, torque = "3 kg" } end)
    m:joint_torque { joint = turns, torque = "3 N m" }
    m:joint_torque { joint = slides, force = "3 N" }
    m:armature { joint = slides, mass = "3 kg" }
  end)
end)

describe("the unit of a joint's data", function()
  it("is that of the joint, whatever else has its name", function()
    ambit.ode { states = { "shared" }, equations = function(s) return { shared = -s.shared } end }
    local m = ambit.mechanism { "hinge", gravity = { 0, 0, 0 } }
    local at, joint = m:revolute { from = m.world, axis = "z", name = "shared" }
    m:rigid_body { at = at, mass = 1, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    m:joint_spring { joint = joint, stiffness = "4 N m/rad" }
    m:joint_torque { joint = joint, torque = "1 N m" }
    assert.equal("complete", ambit.simulate { m:dynamics(), initial = { shared = 0, ["shared'"] = 0 }, t = "0.1",
      solver = "lohner" }.status)
  end)
end)
