-- Measurements on mechanisms, against closed forms.
local ambit = require "ambit"
local core = require "ambit.core"

local function value(e, at) return ambit.evaluate { e, at = at } end

local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-13), ("%s is not %.17g"):format(tostring(x), y))
  assert.is_true(x:width() <= 1e-11, ("%s is wide"):format(tostring(x)))
end

local function near_vector(v, x, y, z)
  near(v.x, x)
  near(v.y, y)
  near(v.z, z)
end

-- Two hinges about z, arms of 2 and 1 along x, masses 3 and 4 at their ends.
local function arm()
  local m = ambit.mechanism { "arm", gravity = { 0, -10, 0 } }
  local shoulder, first = m:revolute { from = m.world, axis = "z", name = "a" }
  local elbow = m:rigid_link { from = shoulder, offset = { 2, 0, 0 } }
  local forearm, second = m:revolute { from = elbow, axis = "z", name = "b" }
  local hand = m:rigid_link { from = forearm, offset = { 1, 0, 0 } }
  m:point_mass { at = elbow, mass = 3 }
  m:point_mass { at = hand, mass = 4 }
  return m, { shoulder = shoulder, elbow = elbow, forearm = forearm, hand = hand, first = first, second = second }
end

describe("between two frames", function()
  it("a distance", function()
    local m, p = arm()
    near(value(m:distance(p.elbow, p.hand)), 1, 1e-15)
    near(value(m:distance(m.world, p.hand), { a = "0.2", b = "0.5" }), math.sqrt(5 + 4 * math.cos(0.5)))
  end)

  it("a pose and a velocity as one sees the other", function()
    local m, p = arm()
    local state = { a = "0.3", b = "0.5", ["a'"] = "0.7", ["b'"] = "1.1" }
    local pose = value(m:relative_pose(p.shoulder, p.hand), state)
    near_vector(pose.position, 2 + math.cos(0.5), math.sin(0.5), 0)
    near(pose.rotation[1][2], -math.sin(0.5))
    near(pose.rotation[3][3], 1)
    local v = value(m:relative_velocity(p.shoulder, p.hand), state)
    near_vector(v.linear, -1.1 * math.sin(0.5), 1.1 * math.cos(0.5), 0)
    near_vector(v.angular, 0, 0, 1.1)
    local w = value(m:relative_velocity(m.world, p.elbow), state)
    near_vector(w.linear, -1.4 * math.sin(0.3), 1.4 * math.cos(0.3), 0)
  end)

  it("the velocity is the derivative of the position", function()
    local m = ambit.mechanism "two bodies"
    local a, b = m:free { from = m.world, name = "a" }, m:free { from = m.world, name = "b" }
    local symbols = m:coordinates()
    local position, velocity = m:relative_pose(a, b).position, m:relative_velocity(a, b).linear
    local state = {}
    for i, name in ipairs { "a", "b" } do
      for k = 1, 6 do
        state[name .. "." .. k] = 0.1 * k - 0.2 * i
        state[name .. "." .. k .. "'"] = 0.3 * i - 0.15 * k
      end
    end
    for _, axis in ipairs { "x", "y", "z" } do
      local rate = ambit.number(0)
      for name in pairs(state) do
        if not name:find "'" then
          rate = rate + ambit.derivative(position[axis], symbols[name]) * symbols[name .. "'"]
        end
      end
      local gap = value(rate - velocity[axis], state)
      assert.is_true(gap:contains(0) and gap:width() < 1e-12, tostring(gap))
    end
  end)

  it("the angle of a rotation, from 0 to pi", function()
    local m, p = arm()
    for _, b in ipairs { 0.5, -0.5, 3, -3, 1e-3 } do
      near(value(m:angle(p.elbow, p.forearm), { b = b }), math.abs(b))
    end
    near(value(m:angle(m.world, p.forearm), { a = 1, b = "0.5" }), 1.5)
  end)

  it("the angle about an axis, signed, and across the cut of atan2", function()
    local m, p = arm()
    for _, b in ipairs { 0.5, -0.5, 3, -3, 0, 1e-3 } do
      near(value(m:angle(p.elbow, p.forearm, "z"), { b = b }), b)
      near(value(m:angle(p.elbow, p.forearm, "-z"), { b = b }), -b)
      near(value(m:angle(p.elbow, p.forearm, { 0, 0, 3 }), { b = b }), b)
      near(value(m:angle(p.elbow, p.forearm, "x"), { b = b }), 0)
    end
    for _, b in ipairs { 3, 3.3, 6 } do
      near(value(m:angle(p.elbow, p.forearm, "z", ambit.pi), { b = b }), b)
    end
    local wide = value(m:angle(p.elbow, p.forearm, "z", ambit.pi), { b = ambit.between(3, "3.3") })
    assert.is_true(wide.lo > 2.5 and wide.hi < 3.8 and wide:contains(3.1), tostring(wide))
  end)

  it("no angle is near another without an axis", function()
    local m, p = arm()
    local fine, problem = pcall(m.angle, m, p.elbow, p.forearm, nil, 3)
    assert.is_false(fine)
    assert.truthy(tostring(problem):find("angle: `near` .* say which axis"), tostring(problem))
  end)

  it("the part of a rotation about an axis: Euler's angles first and last", function()
    local m = ambit.mechanism "ball"
    local at = m:spherical { from = m.world, name = "q", order = "zyx" }
    local q = value(m:angle(m.world, at, "z"), { ["q.1"] = "0.4", ["q.2"] = 0, ["q.3"] = 0 })
    near(q, 0.4)
    -- swing about y by pi/2 leaves a twist about z of 0
    near(value(m:angle(m.world, at, "z"), { ["q.1"] = 0, ["q.2"] = ambit.pi / 2, ["q.3"] = 0 }), 0)
  end)
end)

describe("of the masses", function()
  it("their sum and their centre", function()
    local m, p = arm()
    assert.equal("7", tostring(m:total_mass()))
    local c = value(m:centre_of_mass(), { a = "0.3", b = "0.5" })
    near(c.x, 2 * math.cos(0.3) + 4 / 7 * math.cos(0.8))
    near(c.y, 2 * math.sin(0.3) + 4 / 7 * math.sin(0.8))
    near(c.z, 0)
    m:rigid_body { at = p.elbow, mass = 7, centre = { 0, 0, 2 } }
    near(value(m:centre_of_mass(), { a = 0, b = 0 }).z, 1)
  end)

  it("their momentum, about any point", function()
    local m = ambit.mechanism "top"
    local at = m:revolute { from = m.world, axis = "z", name = "q" }
    m:rigid_body { at = at, mass = 2, centre = { 3, 0, 0 }, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, "2.5" } } }
    local p = value(m:momentum(), { q = "0.5", ["q'"] = 2 })
    near_vector(p.linear, -12 * math.sin(0.5), 12 * math.cos(0.5), 0)
    near_vector(p.angular, 0, 0, 2 * (18 + 2.5))
    local centre = m:frame { from = at, offset = { 3, 0, 0 } }
    near_vector(value(m:momentum(centre), { q = "0.5", ["q'"] = 2 }).angular, 0, 0, 5)
  end)

  it("the momentum is that of the centre, and changes by the forces from outside alone", function()
    local m, p = arm()
    m:spring_damper { from = m.world, to = p.hand, from_offset = { 5, 1, 0 }, stiffness = 20, length = 2, damping = 1 }
    m:joint_damper { joint = p.second, damping = 3 }
    local system, symbols = m:dynamics(), m:coordinates()
    local function rate(e)
      local d = ambit.number(0)
      for _, name in ipairs(system.states) do d = d + ambit.derivative(e, symbols[name]) * system:rate(name) end
      return d
    end
    local state = { a = "0.3", b = "0.5", ["a'"] = "0.7", ["b'"] = "1.1" }
    local momentum, centre, mass = m:momentum(), m:centre_of_mass(), m:total_mass()
    -- the spring pulls at the hand, the hinge bears the rest: m:reaction gives it
    local hinge, hand = m:reaction(p.first, "motion"), m:position(p.hand)
    local angle, r = symbols.a, m:distance(p.hand, m:ground { position = { 5, 1, 0 } })
    local v = m:velocity(p.hand)
    local d = { x = hand.x - 5, y = hand.y - 1 }
    local along = (d.x * v.x + d.y * v.y) / r
    local pull = -(20 * (r - 2) + along) / r
    local x = ambit.cos(angle) * hinge.force.x - ambit.sin(angle) * hinge.force.y
    local y = ambit.sin(angle) * hinge.force.x + ambit.cos(angle) * hinge.force.y
    local gaps = { rate(mass * centre.x) - momentum.linear.x, rate(momentum.linear.x) - x - pull * d.x,
      rate(momentum.linear.y) - y - pull * d.y + 70,
      rate(momentum.angular.z) + 70 * centre.x - (hand.x * pull * d.y - hand.y * pull * d.x) }
    for i, gap in ipairs(value(gaps, state)) do
      assert.is_true(gap:contains(0) and gap:width() < 1e-10, ("%d: %s"):format(i, tostring(gap)))
    end
  end)

  it("is nothing where there is none", function()
    local m = ambit.mechanism "empty"
    assert.equal("0", tostring(m:total_mass()))
    assert.is_false(pcall(m.centre_of_mass, m))
  end)
end)

describe("a reaction", function()
  it("holds a hanging mass, and turns with the frame", function()
    local m, p = arm()
    local rest = { a = -ambit.pi / 2, b = 0, ["a'"] = 0, ["b'"] = 0, ["a''"] = 0, ["b''"] = 0 }
    local r = value(m:reaction(p.first), rest)
    near(r.force.x, -70) -- the frame's x axis points down: the hinge pulls up
    near(r.force.y, 0)
    near(value(m:reaction(p.second), rest).force.x, -40)
  end)

  it("of a pendulum: tension m (g cos + l w^2), no force along the motion", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, -10, 0 } }
    local at, joint = m:revolute { from = m.world, axis = "z", name = "q" }
    m:point_mass { at = m:rigid_link { from = at, offset = { 0, -2, 0 } }, mass = 3 }
    local state = { q = "0.4", ["q'"] = "1.5" }
    local r = value(m:reaction(joint, "motion"), state)
    near(r.force.y, 3 * (10 * math.cos(0.4) + 2 * 1.5 ^ 2))
    near(r.force.x, 0)
    near(r.torque.z, 0)
    local free = value(m:reaction(at), { q = "0.4", ["q'"] = "1.5", ["q''"] = 0 })
    near(free.force.x, 3 * 10 * math.sin(0.4))
    near(free.torque.z, 60 * math.sin(0.4))
  end)

  it("of a driven joint has the drive's effort in it", function()
    local m = ambit.mechanism { "crane", gravity = { 0, -10, 0 } }
    local at, joint = m:revolute { from = m.world, axis = "z", angle = 2 * ambit.time }
    m:point_mass { at = m:rigid_link { from = at, offset = { 3, 0, 0 } }, mass = 4 }
    near(value(m:reaction(joint).torque.z, { t = "0.3" }), 120 * math.cos(0.6))
  end)

  it("of a weld or a link is no reaction of a joint: it says so", function()
    local m = ambit.mechanism "stiff"
    local link = m:rigid_link { from = m.world }
    local fine, problem = pcall(m.reaction, m, link)
    assert.is_false(fine)
    assert.truthy(problem:find "reaction: .*has none")
    local at = m:revolute { from = link, axis = "z" }
    fine, problem = pcall(m.reaction, m, at, "moving")
    assert.is_false(fine)
    assert.truthy(problem:find 'expected nothing or "motion", got moving')
  end)
end)

it("nothing is measured that is not asked for", function()
  local m, p = arm()
  m:distance(p.elbow, p.hand)
  local before = core.pulled(m.handle)
  m:distance(p.elbow, p.hand)
  assert.equal(before, (core.pulled(m.handle)))
  m:total_mass()
  assert.is_true(core.pulled(m.handle) - before <= core.part_count(m.handle))
end)

it("a frame of another mechanism, or none at all, is refused by name", function()
  local m, p = arm()
  local other = ambit.mechanism "other"
  for _, act in ipairs { function() m:distance(p.hand, other.world) end, function() m:angle(p.hand, 3) end,
    function() m:relative_pose() end, function() m:momentum(1) end, function() m:position "hand" end } do
    local fine, problem = pcall(act)
    assert.is_false(fine)
    assert.truthy(problem:find "measure_spec.lua:%d+: %a+")
    assert.truthy(problem:find "expected a frame" or problem:find "another mechanism", problem)
  end
end)
