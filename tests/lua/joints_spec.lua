-- Joints: quaternions against Euler angles and against integrals of the free body; gears, mimic joints, play.
local ambit = require "ambit"
local core = require "ambit.core"

local function value(e, at) return ambit.evaluate { e, at = at, arithmetic = "interval" } end

local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-12) * (1 + math.abs(y)),
    ("%s is not %.17g"):format(tostring(x), y))
end

-- -- an oracle of its own: rotations in ordinary floating point

local function product(p, q)
  local r = {}
  for i = 1, 3 do
    r[i] = {}
    for j = 1, 3 do r[i][j] = p[i][1] * q[1][j] + p[i][2] * q[2][j] + p[i][3] * q[3][j] end
  end
  return r
end

local function elementary(axis, a)
  local c, s = math.cos(a), math.sin(a)
  if axis == 1 then return { { 1, 0, 0 }, { 0, c, -s }, { 0, s, c } } end
  if axis == 2 then return { { c, 0, s }, { 0, 1, 0 }, { -s, 0, c } } end
  return { { c, -s, 0 }, { s, c, 0 }, { 0, 0, 1 } }
end

-- the unit quaternion of three rotations, in the order z, y, x
local function quaternion(a)
  local q = { 1, 0, 0, 0 }
  for i, axis in ipairs { 3, 2, 1 } do
    local r = { math.cos(a[i] / 2), 0, 0, 0 }
    r[axis + 1] = math.sin(a[i] / 2)
    q = {
      q[1] * r[1] - q[2] * r[2] - q[3] * r[3] - q[4] * r[4],
      q[1] * r[2] + q[2] * r[1] + q[3] * r[4] - q[4] * r[3],
      q[1] * r[3] + q[3] * r[1] + q[4] * r[2] - q[2] * r[4],
      q[1] * r[4] + q[4] * r[1] + q[2] * r[3] - q[3] * r[2],
    }
  end
  return q
end

local function numbers(state, key, list)
  for i, x in ipairs(list) do state[key:format(i)] = x end
end

-- a joint `kind` named "ball" at the end of a moving arm, with a load on an offset
local function swinging(kind)
  local m = ambit.mechanism { "arm", gravity = { "0.3", "-9.81", "0.7" } }
  local at = m:revolute { from = m.world, axis = { 1, 2, 2 }, name = "base" }
  local arm = m:rigid_link { from = at, offset = { "0.3", "-0.5", "0.2" } }
  local ball = m[kind](m, { from = arm, name = "ball" })
  m:rigid_body { at = ball, mass = 2, centre = { "0.1", "0.2", "-0.3" },
    inertia = { { "0.5", "0.05", 0 }, { "0.05", "0.4", "0.02" }, { 0, "0.02", "0.6" } } }
  m:point_mass { at = at, mass = 3 }
  m:rigid_body { at = at, mass = 1, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
  return m, ball, m:rigid_link { from = ball, offset = { "0.7", "0.1", "-0.4" } }, arm
end

local base = { base = 0.4, ["base'"] = 1.3, ["base''"] = -0.8 }

-- r^T s: from the axes s to those of r
local function between(r, s)
  local t = { {}, {}, {} }
  for i = 1, 3 do
    for j = 1, 3 do
      t[i][j] = 0
      for k = 1, 3 do t[i][j] = t[i][j] + r[k][i]:mid() * s[k][j]:mid() end
    end
  end
  return t
end

local function turn(r, v)
  local w = { 0, 0, 0 }
  for i = 1, 3 do
    for j = 1, 3 do w[i] = w[i] + r[i][j] * v[j]:mid() end
  end
  return w
end

-- The state of the Euler mechanism, and the same motion for the one with a quaternion: u and u' of the ball against
-- the arm from their twists and accelerations (alpha_ball = R^T alpha_arm + u' + (R^T w_arm) x u).
local function states(motion, m, ball, arm, displaced)
  local e, q = {}, {}
  for k, v in pairs(base) do e[k], q[k] = v, v end
  for i = 1, displaced and 6 or 3 do
    e["ball." .. i], e[("ball.%d'"):format(i)], e[("ball.%d''"):format(i)] = motion[1][i], motion[2][i], motion[3][i]
  end
  local function of(frame, quantity) return core.pull(m.handle, frame.part, frame.port, quantity, 6) end
  local x = value({ ball = m:orientation(ball), arm = m:orientation(arm), w = of(ball, core.TWIST),
    w_arm = of(arm, core.TWIST), alpha = of(ball, core.ACCEL), alpha_arm = of(arm, core.ACCEL) }, e)
  local r = between(x.ball, x.arm)
  local w, alpha, u = turn(r, x.w_arm), turn(r, x.alpha_arm), {}
  for i = 1, 3 do u[i] = x.w[i]:mid() - w[i] end
  for i = 1, 3 do
    local j, k = i % 3 + 1, (i + 1) % 3 + 1
    q["ball'." .. i] = u[i]
    q["ball''." .. i] = x.alpha[i]:mid() - alpha[i] - (w[j] * u[k] - w[k] * u[j])
    if displaced then
      q["ball." .. 4 + i], q["ball'." .. 3 + i], q["ball''." .. 3 + i] = motion[1][3 + i], motion[2][3 + i],
        motion[3][3 + i]
    end
  end
  numbers(q, "ball.%d", quaternion(motion[1]))
  return e, q
end

local motions = {
  { { 0.3, -0.7, 1.1, 0.2, -0.4, 0.9 }, { 1.2, 0.4, -0.9, 0.3, 0.7, -1.1 }, { -0.5, 2.1, 0.6, 1.5, -0.2, 0.8 } },
  { { -2.9, 1.2, 0.1, -1, 2, 0.5 }, { -0.3, 2.2, 1.7, 1, 0.1, 0.2 }, { 3, -1, 0.4, -0.6, 0.9, 1.3 } },
  { { 0, 0, 0, 0, 0, 0 }, { 0.5, -0.25, 1, 2, 0, -1 }, { 1, 1, 1, 0, 0, 0 } },
}

local function compare(kinds, displaced)
  local m1, ball1, tip1, arm = swinging(kinds[1])
  local m2, _, tip2 = swinging(kinds[2])
  for _, motion in ipairs(motions) do
    local e, q = states(motion, m1, ball1, arm, displaced)
    for _, measure in ipairs { "position", "velocity", "acceleration", "angular_velocity" } do
      local x, y = value(m1[measure](m1, tip1), e), value(m2[measure](m2, tip2), q)
      for _, c in ipairs { "x", "y", "z" } do near(y[c], x[c]:mid()) end
    end
    local r1, r2 = value(m1:orientation(tip1), e), value(m2:orientation(tip2), q)
    for i = 1, 3 do
      for j = 1, 3 do near(r2[i][j], r1[i][j]:mid()) end
    end
    near(value(m2:energy(), q).total, value(m1:energy(), e).total:mid())
    near(value(m2:dynamics():rate "base'", q), value(m1:dynamics():rate "base'", e):mid(), 1e-11)
  end
end

describe("a quaternion joint", function()
  it("turns as the three angles do", function()
    local m = ambit.mechanism "ball"
    local at = m:spherical_quaternion { from = m.world, name = "ball" }
    for _, angles in ipairs { { 0.3, -0.7, 1.1 }, { -3, 1.4, 2 }, { 0, 0, 0 } } do
      local state = {}
      numbers(state, "ball.%d", quaternion(angles))
      local want = product(product(elementary(3, angles[1]), elementary(2, angles[2])), elementary(1, angles[3]))
      local got = value(m:orientation(at), state)
      for i = 1, 3 do for j = 1, 3 do near(got[i][j], want[i][j], 1e-15) end end
    end
  end)

  it("moves, on a moving arm, as three Euler angles do", function()
    compare({ "spherical", "spherical_quaternion" }, false)
  end)

  it("moves, with displacements, as a free joint does", function()
    compare({ "free", "free_quaternion" }, true)
  end)

  it("has coordinates and speeds of its own names, and q' keeps the norm", function()
    local m = ambit.mechanism "ball"
    local at = m:spherical_quaternion { from = m.world, name = "ball" }
    m:rigid_body { at = at, mass = 1, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, "2.5" } } }
    local d = m:dynamics()
    assert.same({ "ball.1", "ball.2", "ball.3", "ball.4", "ball'.1", "ball'.2", "ball'.3" }, d.states)
    local drift = 0
    for i = 1, 4 do drift = drift + m:coordinate(at)[i] * d:rate("ball." .. i) end
    local state = { ["ball'.1"] = 3, ["ball'.2"] = -1, ["ball'.3"] = 2 }
    numbers(state, "ball.%d", { 3, 1, -4, 1.5 }) -- whatever the norm is
    local x = value(drift, state)
    assert.is_true(x:contains(0) and x:width() < 1e-13)
  end)

  it("accelerates a free body by Euler's equations", function()
    local m = ambit.mechanism "body"
    local at = m:free_quaternion { from = m.world, name = "b" }
    m:rigid_body { at = at, mass = 2, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, "2.5" } } }
    local d, w = m:dynamics(), { 0.7, -1.1, 0.4 }
    local state = {}
    numbers(state, "b.%d", { 0.5, -0.5, 0.5, 0.5, 1, 2, 3 })
    numbers(state, "b'.%d", { w[1], w[2], w[3], 5, 6, 7 })
    near(value(d:rate "b'.1", state), (2 - 2.5) * w[2] * w[3] / 1)
    near(value(d:rate "b'.2", state), (2.5 - 1) * w[3] * w[1] / 2)
    near(value(d:rate "b'.3", state), (1 - 2) * w[1] * w[2] / 2.5)
    for i = 4, 6 do near(value(d:rate("b'." .. i), state), 0) end
    near(value(d:rate "b.5", state), 5)
  end)

  it("keeps energy and angular momentum of a free body while it tumbles", function()
    local m = ambit.mechanism "body"
    local at = m:spherical_quaternion { from = m.world, name = "b" }
    local inertia = { 1, 2, 2.5 }
    m:rigid_body { at = at, mass = 1, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, "2.5" } } }
    local initial = { ["b.1"] = 1, ["b.2"] = 0, ["b.3"] = 0, ["b.4"] = 0, ["b'.1"] = "0.01", ["b'.2"] = 2,
      ["b'.3"] = "0.02" } -- about the middle axis: it turns over
    local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, "1.5" }, solver = "lohner" }
    assert.equal("complete", run.status)
    local x, momentum = run.x, {}
    local state, energy = {}, 0
    for i = 1, 3 do
      local w = x["b'." .. i]
      energy = energy + 0.5 * inertia[i] * w * w
      momentum[i] = inertia[i] * w
      state["b." .. i] = x["b." .. i]:mid()
    end
    state["b.4"] = x["b.4"]:mid()
    assert.is_true(energy:contains(0.5 * (0.01 ^ 2 + 2 * 4 + 2.5 * 0.02 ^ 2)) and energy:width() < 1e-6)
    local r, w0 = value(m:orientation(at), state), { 0.01, 4, 0.05 }
    for i = 1, 3 do
      local h = 0
      for j = 1, 3 do h = h + r[i][j]:mid() * momentum[j]:mid() end
      assert.is_true(math.abs(h - w0[i]) < 1e-7)
    end
    local norm = 0
    for i = 1, 4 do norm = norm + x["b." .. i] * x["b." .. i] end
    assert.is_true(norm:contains(1) and norm:width() < 1e-6)
    assert.is_true(math.abs(x["b'.2"]:mid() - 2) > 1e-4) -- it moved
  end)
end)

-- -- gears

local function geared(kind)
  local m = ambit.mechanism { "gear", gravity = { 0, "-9.81", 0 } }
  local a, ja = m:revolute { from = m.world, name = "a" }
  local b, jb
  local frame = m:rigid_link { from = m.world, offset = { 3, 0, 0 } }
  if kind == "gear" then
    b, jb = m:revolute { from = frame, name = "b" }
  elseif kind == "mimic" then
    b, jb = m:revolute { from = frame, name = "b", mimic = { joint = a, multiplier = "-2", offset = "0.5" } }
  else
    b, jb = m:prismatic { from = frame, axis = "y", name = "b" }
  end
  m:point_mass { at = m:rigid_link { from = a, offset = { 1, 0, 0 } }, mass = 2 }
  m:point_mass { at = m:rigid_link { from = b, offset = { "0.5", 0, 0 } }, mass = 1 }
  return m, ja, jb
end

local function constraint(m, part)
  local d = m.declared[part]
  for _, port in ipairs(d.ports) do
    if port.kind == "constraint" then return core.pull(m.handle, part, port.index, core.RESIDUAL, 1)[1] end
  end
end

describe("a gear", function()
  it("writes the residual and efforts whose power is that of the residual", function()
    local cases = { { "gear", "ratio", "driver", "driven" }, { "rack_and_pinion", "radius", "pinion", "rack" } }
    for _, case in ipairs(cases) do
      local m, a, b = geared(case[1])
      m[case[1]](m, { [case[3]] = a, [case[4]] = b, [case[2]] = "-0.25", offset = "0.5", name = "mesh" })
      local part = core.part_count(m.handle) - 1
      near(value(constraint(m, part), { a = 2, b = 1 }), 1 + 0.25 * 2 - 0.5)
      local effort = value({ core.pull(m.handle, a.part, a.port, core.EFFORT, 1)[1],
        core.pull(m.handle, b.part, b.port, core.EFFORT, 1)[1] }, { lambda_mesh = 8 })
      near(effort[1], 0.25 * 8)
      near(effort[2], 8)
    end
  end)

  it("moves as a joint that mimics the other does", function()
    local m, a, b = geared "gear"
    m:gear { driver = a, driven = b, ratio = "-2", offset = "0.5", name = "mesh" }
    local follower = geared "mimic"
    local state = { a = 0.3, ["a'"] = 0.7 }
    local want = value(follower:dynamics():rate "a'", state):mid()
    state.b = 0.5 - 2 * 0.3
    near(value(m:dynamics():rate "a'", state), want, 1e-11)
    near(value(m:dynamics():rate "b", state), -1.4)
  end)

  it("mimics by the closed form", function()
    local m = geared "mimic"
    local q, w = 0.3, 0.7
    -- 2 (2 g cos q) ... : (2 + 4 * 0.25) q'' = -2 g cos q + 2 * 0.5 g cos(0.5 - 2 q), both masses at their arms
    local want = (-2 * 9.81 * math.cos(q) + 2 * 0.5 * 9.81 * math.cos(0.5 - 2 * q)) / (2 + 4 * 0.25)
    near(value(m:dynamics():rate "a'", { a = q, ["a'"] = w }), want)
  end)

  it("refuses data that move, and mimics of joints that cannot be followed", function()
    local m, a, b = geared "gear"
    local _, problem = pcall(function() m:gear { driver = a, driven = b, ratio = ambit.time } end)
    assert.truthy(problem:find("joints_spec.lua:%d+: gear `gear1` .*: `ratio` moves in time"), problem)
    local ball = m:spherical { from = m.world }
    _, problem = pcall(function() m:revolute { from = m.world, mimic = ball } end)
    assert.truthy(problem:find("mimic: expected a joint with one coordinate", 1, true), problem)
    _, problem = pcall(function() m:revolute { from = m.world, mimic = { joint = a }, angle = 1 } end)
    assert.truthy(problem:find("the joint has `angle` already", 1, true), problem)
    _, problem = pcall(function() m:revolute { from = m.world, mimic = { joint = a, multiplyer = 1 } } end)
    assert.truthy(problem:find("did you mean `multiplier`", 1, true), problem)
    _, problem = pcall(function() m:prismatic { from = m.world, mimic = { joint = a, offset = "1 kg" } } end)
    assert.truthy(problem:find("mimic: offset", 1, true), problem)
    _, problem = pcall(function() m:spherical { from = m.world, mimic = { joint = a } } end)
    assert.truthy(problem:find("unknown key `mimic`", 1, true), problem)
  end)
end)

-- -- play

describe("play", function()
  it("of a slider is a disc across it", function()
    local m = ambit.mechanism "slider"
    local at = m:sloppy_prismatic { from = m.world, axis = { 3, 4, 0 }, displacement = 5, play = "0.01" }
    local p = value(m:position(at))
    near(p.x, 3, 1e-14)
    near(p.y, 4, 1e-14)
    assert.is_true(math.abs(p.x:width() - 2 * 0.01 * 0.8) < 1e-15 and math.abs(p.y:width() - 2 * 0.01 * 0.6) < 1e-15)
    assert.is_true(math.abs(p.z:width() - 0.02) < 1e-15)
    for i = 0, 100 do -- every displacement across the axis is inside
      local a = i * 0.0628
      local c, s = 0.00999999 * math.cos(a), 0.00999999 * math.sin(a)
      assert.is_true(p.x:contains(3 - 0.8 * c) and p.y:contains(4 + 0.6 * c) and p.z:contains(s))
    end
  end)

  it("of a ball is a ball, and turns nothing", function()
    local m = ambit.mechanism "ball"
    local at = m:sloppy_spherical { from = m.world, angles = { "0.3", "-0.7", "1.1" }, play = "0.01" }
    local p, r = value(m:position(at)), value(m:orientation(at))
    for _, c in ipairs { "x", "y", "z" } do
      assert.is_true(math.abs(p[c]:width() - 0.02) < 1e-15 and p[c]:contains(0))
    end
    local want = product(product(elementary(3, 0.3), elementary(2, -0.7)), elementary(1, 1.1))
    for i = 1, 3 do for j = 1, 3 do near(r[i][j], want[i][j], 1e-15) end end
  end)

  it("is a fresh unknown at each joint, and has no velocity", function()
    local m = ambit.mechanism "two"
    local a = m:sloppy_spherical { from = m.world, angles = { 0, 0, 0 }, play = "0.01" }
    local b = m:sloppy_spherical { from = a, angles = { 0, 0, 0 }, play = "0.01" }
    local x = ambit.evaluate { (m:position(b) - m:position(a)).x, arithmetic = "affine" }
    assert.is_true(math.abs(x:width() - 0.02) < 1e-15)
    assert.is_true(math.abs(ambit.evaluate { m:position(b), arithmetic = "affine" }.x:width() - 0.04) < 1e-15)
    local _, problem = pcall(m.velocity, m, b)
    assert.truthy(problem:find("the play may jump", 1, true), problem)
    _, problem = pcall(function() m:sloppy_spherical { from = a, angles = { 0, 0, 0 }, play = -1 } end)
    assert.truthy(problem:find("the play is negative: -1 m", 1, true), problem)
  end)
end)
