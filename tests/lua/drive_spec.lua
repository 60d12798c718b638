-- Drives and everyday laws as elements: their equations at points, the same by hand, runs, bad input.
local ambit = require "ambit"
local around = ambit.around

local function value(e, at) return ambit.evaluate { e, at = at } end

local function near(x, y)
  assert.is_true(math.abs(x:mid() - y) <= 1e-12 * (1 + math.abs(y)) and x:width() <= 1e-11 * (1 + math.abs(y)),
    ("%s is not %.17g"):format(tostring(x), y))
end

local function bar()
  local m = ambit.mechanism "bar"
  local at, joint = m:revolute { from = m.world, axis = "z", name = "q" }
  m:rigid_body { at = at, mass = 1, inertia = { { 3, 0, 0 }, { 0, 3, 0 }, { 0, 0, 3 } } }
  return m, joint, at
end

local function slider()
  local m = ambit.mechanism "slider"
  local at, joint = m:prismatic { from = m.world, axis = "x", name = "s" }
  m:point_mass { at = at, mass = 2 }
  return m, joint, at
end

local function expect_error(f, pattern)
  local good, message = pcall(f)
  assert.is_false(good, pattern)
  assert.is_truthy(tostring(message):find(pattern), message)
end

describe("a DC motor", function()
  it("is its equations", function()
    local m, joint = bar()
    local motor = m:dc_motor { joint = joint, name = "motor", constant = "0.1 N m/A", resistance = "2 ohm", ratio = 20,
      inductance = "5 mH", rotor = "1e-3", voltage = function(q, v, t) return "12 V" - 3 * q - "0.5 V s" * v + t end }
    assert.same({ "q", "motor.current", "q'" }, m:dynamics().states)
    local at = { q = "0.5", ["q'"] = 2, ["motor.current"] = 3, t = 1 }
    near(value(motor.torque, at), 6)
    near(value(m:dynamics():rate "q'", at), 6 / 3.4)
    near(value(m:dynamics():rate "motor.current", at), (12 - 1.5 - 1 + 1 - 6 - 4) / 0.005)
  end)

  it("runs up as its linear equations say", function()
    local m, joint = bar()
    m:dc_motor { joint = joint, name = "motor", constant = around("0.1", "1%"), resistance = 2, inductance = "5 mH",
      ratio = 20, voltage = 12 }
    local run = ambit.simulate { m, initial = { q = 0, ["q'"] = 0, ["motor.current"] = 0 }, t = "0.2" }
    assert.equal("complete", run.status)
    -- i' = (12 - 2 i - K v) / L, v' = K i / 3: by hand with K = 2
    local a, b, x = -2 / 0.005, -2 / 0.005, { 0, 0 } -- fourth order
    local function f(i, v) return 12 / 0.005 + a * i + b * v, 2 * i / 3 end
    local n, h = 20000, 0.2 / 20000
    for _ = 1, n do
      local k1, l1 = f(x[1], x[2])
      local k2, l2 = f(x[1] + h / 2 * k1, x[2] + h / 2 * l1)
      local k3, l3 = f(x[1] + h / 2 * k2, x[2] + h / 2 * l2)
      local k4, l4 = f(x[1] + h * k3, x[2] + h * l3)
      x = { x[1] + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), x[2] + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4) }
    end
    assert.is_true(run.x["motor.current"]:contains(x[1]) and run.x["q'"]:contains(x[2]))
    assert.is_true(run.x["q'"]:width() < 0.05)
  end)

  it("refuses wrong data", function()
    local m, joint, at = bar()
    local data = { joint = joint, constant = 1, resistance = 1, inductance = 1, voltage = 1 }
    local function with(key, v)
      local t = {}
      for name, datum in pairs(data) do t[name] = datum end
      t[key] = v
      return function() m:dc_motor(t) end
    end
    expect_error(with("voltage", "3 A"), "`3 A` is in A, but V is expected")
    expect_error(with("voltage", function() end), "dc_motor: voltage: the function returned nothing")
    expect_error(with("constant", "3 V"), "is in V")
    local _, slide = m:prismatic { from = at, axis = "x", name = "slide" }
    expect_error(with("joint", slide), "dc_motor: joint: expected a joint that turns")
    local fixed = m:revolute { from = at, axis = "z", angle = ambit.time, name = "fixed" }
    expect_error(with("joint", fixed), "the motion of `fixed` is given")
    expect_error(with("joint", m:spherical { from = at, name = "ball" }), "degrees? of freedom")
  end)
end)

describe("a PID controller", function()
  it("is its torque and its integral", function()
    local m, joint = bar()
    local servo = m:pid { joint = joint, name = "servo", proportional = 100, integral = 40, derivative = 10,
      goal = function(t) return ambit.sin(t) end }
    local at = { q = "0.25", ["q'"] = 2, ["servo.integral"] = "0.5", t = 0 }
    near(value(servo.torque, at), -25 + 20 + 10 * (1 - 2))
    near(value(m:dynamics():rate "servo.integral", at), -0.25)
    near(value(servo.error, at), -0.25)
  end)

  it("has a limit, at which the integral is led back", function()
    local m, joint = slider()
    local servo = m:pid { joint = joint, name = "servo", proportional = "100 N/m", integral = 40, goal = 1, limit = 30 }
    local at = { s = 0, ["s'"] = 0, ["servo.integral"] = 1 }
    near(value(servo.torque, at), 30)
    near(value(m:dynamics():rate "servo.integral", at), 1 - (140 - 30) / 100)
    at.s = "1.3"
    near(value(servo.torque, at), 10)
    near(value(m:dynamics():rate "servo.integral", at), -0.3)
    m:joint_damper { joint = joint, damping = 20 }
    local run = ambit.simulate { m:dynamics(), t = 2,
      initial = { s = around(0, "0.01"), ["s'"] = 0, ["servo.integral"] = 0 } }
    assert.equal("complete", run.status)
    assert.is_true(run.x.s:width() < 0.05 and math.abs(run.x.s:mid() - 1) < 0.2)
  end)

  it("without a proportional part leads the integral back in a time of its own", function()
    local function servo(m, joint, proportional, tracking)
      return m:pid { joint = joint, name = "servo", proportional = proportional, integral = 40, goal = 1, limit = 30,
        tracking = tracking }
    end
    local m, joint = slider()
    expect_error(function() servo(m, joint, 0) end, "`tracking` is needed")
    m, joint = slider()
    expect_error(function() servo(m, joint, around("0.5 N/m", "100%")) end, "`tracking` is needed")
    m, joint = slider()
    expect_error(function() servo(m, joint, 0, 0) end, "tracking: expected a time above 0 s")
    m, joint = slider()
    servo(m, joint, 0, "0.5 s")
    near(value(m:dynamics():rate "servo.integral", { s = 0, ["s'"] = 0, ["servo.integral"] = 1 }), 1 - (40 - 30) / 20)
  end)

  it("has no state without an integral, and refuses a goal that moves with the mechanism", function()
    local m, joint = bar()
    m:pid { joint = joint, goal = "0.5", proportional = 10 }
    assert.same({ "q", "q'" }, m:dynamics().states)
    expect_error(function() m:pid { joint = joint, goal = m:coordinates().q, proportional = 10 } end,
      "expected a function of time only, got `q`")
    expect_error(function() m:pid { joint = joint, goal = "1 m", proportional = 10 } end, "is in m")
    expect_error(function() m:pid { joint = joint, goal = 1, proportional = "10 N/m" } end, "is in N/m")
  end)
end)

describe("laws between two points", function()
  it("are dampers with two slopes", function()
    local m, _, at = slider()
    m:two_slope_damper { from = m:ground { position = { -1, 0, 0 } }, to = at, compression = 4, rebound = 10 }
    near(value(m:dynamics():rate "s'", { s = 0, ["s'"] = 3 }), -15)
    near(value(m:dynamics():rate "s'", { s = 0, ["s'"] = -3 }), 6)
  end)

  it("are cables, which pull only", function()
    local m, _, at = slider()
    m:cable { from = m:ground { position = { -1, 0, 0 } }, to = at, length = "1.5", stiffness = 100, damping = "0.1" }
    near(value(m:dynamics():rate "s'", { s = "0.4", ["s'"] = 3 }), 0)
    near(value(m:dynamics():rate "s'", { s = "0.75", ["s'"] = 2 }), -15)
    local run = ambit.simulate { m, initial = { s = around("0.4", "1e-3"), ["s'"] = 2 }, t = "0.3" }
    assert.equal("complete", run.status)
    local hull = ambit.sample { m:dynamics(), initial = { s = around("0.4", "1e-3"), ["s'"] = 2 }, t = "0.3" }
    assert.is_true(run.x.s:width() < 2 * hull.x.s:width())
  end)
end)

describe("a hydraulic cylinder", function()
  local function boom(p, start)
    local m, joint = slider()
    local cylinder = m:hydraulic_cylinder { joint = joint, name = "c", area = "20 cm^2", rod_area = "10 cm^2",
      stroke = "0.5", dead_volume = "1e-4", start = start,
      head_flow = function(pressure) return 1e-4 - p * pressure end, rod_flow = function(pressure) return -p * pressure end }
    return m, cylinder
  end

  it("is its equations", function()
    local m, cylinder = boom(ambit.number "1e-12 m^3/(s Pa)", "-0.1")
    local at = { s = "0.1", ["s'"] = "0.02", ["c.head"] = 4e6, ["c.rod"] = 1e6 }
    near(value(cylinder.force, at), 8000 - 1000)
    near(value(m:dynamics():rate "s'", at), 3500)
    near(value(m:dynamics():rate "c.head", at), 1.4e9 * (1e-4 - 4e-6 - 4e-5) / (1e-4 + 4e-4))
    near(value(m:dynamics():rate "c.rod", at), 1.4e9 * (-1e-6 + 2e-5) / (1e-4 + 3e-4))
  end)

  it("refuses a joint that turns", function()
    local m, joint = bar()
    expect_error(function()
      m:hydraulic_cylinder { joint = joint, area = 1, rod_area = 1, stroke = 1, dead_volume = 1, head_flow = 0,
        rod_flow = 0 }
    end, "expected a joint that slides")
  end)
end)

describe("a linear-quadratic regulator", function()
  local function upright(mass)
    local m = ambit.mechanism { "upright", gravity = { 0, "-9.81", 0 } }
    local at, joint = m:revolute { from = m.world, axis = "z", name = "q" }
    m:point_mass { at = m:rigid_link { from = at, offset = { 0, 2, 0 } }, mass = mass }
    return m, joint
  end

  it("has the gains of the closed form", function()
    local m, joint = upright(3) -- 12 q'' = 6 g q + u
    local c = m:lqr { joints = joint, weights = { q = 5, ["q'"] = 7 }, effort = 2 }
    local a = 6 * 9.81
    local k = a + math.sqrt(a * a + 5 / 2)
    assert.is_true(math.abs(c.gains[1][1] / k - 1) < 1e-9)
    assert.is_true(math.abs(c.gains[1][2] / math.sqrt(2 * 12 * k + 7 / 2) - 1) < 1e-9)
  end)

  it("holds a goal, and the law is what it hands out", function()
    local m, joint = upright(3)
    local c = m:lqr { joints = { joint }, goal = { q = "0.5" }, weights = { q = 5, ["q'"] = 7 } }
    near(value(c.efforts.q, { q = "0.5", ["q'"] = 0 }), -6 * 9.81 * math.sin(0.5))
    near(value(c.efforts.q, { q = 1, ["q'"] = 2 }),
      -6 * 9.81 * math.sin(0.5) - c.gains[1][1] * 0.5 - 2 * c.gains[1][2])
  end)

  it("brings every cart and pole within the tolerances upright", function()
    local m = ambit.mechanism { "cart and pole", gravity = { 0, "-9.81", 0 } }
    local cart, rail = m:prismatic { from = m.world, axis = "x", name = "x" }
    m:point_mass { at = cart, mass = 1 }
    local pole = m:revolute { from = cart, axis = "z", name = "q" }
    m:point_mass { at = m:rigid_link { from = pole, offset = { 0, 1, 0 } }, mass = around("0.1", "2%") }
    m:lqr { joints = rail, weights = { x = 1, q = 1, ["x'"] = 1, ["q'"] = 1 } }
    local run = ambit.simulate { m, t = 10,
      initial = { x = "0.5", q = around("0.1", "5%"), ["x'"] = 0, ["q'"] = 0 } }
    assert.equal("complete", run.status)
    assert.is_true(run.x.q:mag() < 1e-3 and run.x.x:mag() < 1e-2)
  end)

  it("refuses what is no question", function()
    local m, joint = upright(1)
    expect_error(function() m:lqr { joints = {}, weights = {} } end, "lqr: joints: expected a joint or a list")
    expect_error(function() m:lqr { joints = joint, weights = { p = 1 } } end, "lqr: weights.*`p`")
    local far = m:revolute { from = m.world, axis = "z", name = "arm" }
    m:point_mass { at = m:rigid_link { from = far, offset = { 1, 0, 0 } }, mass = 1 }
    expect_error(function() m:lqr { joints = joint, weights = { q = 1 } } end,
      "no state of rest: joint `arm`, which is not driven, would have to hold")
  end)
end)

describe("Hertz's contact", function()
  local function force_of(depth, modulus, radius) return 4 / 3 * modulus * math.sqrt(radius) * depth ^ 1.5 end

  it("is its law between balls, nothing apart, and Hertz's but for its rounding", function()
    local m = ambit.mechanism "balls"
    local a = m:prismatic { from = m.world, axis = "x", name = "a" }
    m:point_mass { at = a, mass = 1 }
    local b = m:prismatic { from = m.world, axis = "x", name = "b" }
    m:point_mass { at = b, mass = 2 }
    local c = m:hertz_contact { from = a, to = b, reach = "0.25", radius = "0.0625", modulus = 1e6, damping = "0.5" }
    near(value(c.force, { a = 0, b = "0.5", ["a'"] = 0, ["b'"] = 0 }), 0)
    local touching = value(c.force, { a = 0, b = "0.24", ["a'"] = 1, ["b'"] = "0.5" })
    local depth = 0.01
    near(touching, force_of(depth, 1e6, 0.0625) * math.sqrt(depth / (depth + 1e-6)) * 1.25)
    assert.is_true(math.abs(touching:mid() / (1.25 * force_of(depth, 1e6, 0.0625)) - 1) < 1e-6 / (2 * depth))
    near(value(m:dynamics():rate "b'", { a = 0, b = "0.24", ["a'"] = 1, ["b'"] = "0.5" }), touching:mid() / 2)
  end)

  it("throws a ball back as high as it fell, without damping", function()
    local m = ambit.mechanism { "ball", gravity = { 0, 0, "-9.81" } }
    local at = m:prismatic { from = m.world, axis = "z", name = "z" }
    m:point_mass { at = at, mass = around(1, "1%") }
    m:hertz_contact { to = at, normal = { 0, 0, 1 }, reach = "0.05", radius = "0.05", modulus = 1e6,
      rounding = "1e-4" }
    local run = ambit.simulate { m, initial = { z = "0.15", ["z'"] = 0 }, t = "0.3" }
    assert.equal("complete", run.status)
    -- fourth order, 3e-6 s
    local z, v, h, k = 0.15, 0, 3e-6, 4 / 3 * 1e6 * math.sqrt(0.05)
    local least, most = 1, 0
    local function f(x, mass)
      local depth = math.max(0.05 - x, 0)
      return -9.81 + k * depth ^ 2 / math.sqrt(depth + 1e-4) / mass
    end
    for n = 1, 100000 do
      local a1 = f(z, 1)
      local a2 = f(z + h / 2 * v, 1)
      local a3 = f(z + h / 2 * (v + h / 2 * a1), 1)
      local a4 = f(z + h * (v + h / 2 * a2), 1)
      z, v = z + h * (v + h / 6 * (a1 + a2 + a3)), v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
      if n < 60000 then least = math.min(least, z) else most = math.max(most, z) end
    end
    assert.is_true(run.x.z:contains(z) and run.x["z'"]:contains(v))
    assert.is_true(least < 0.05 and run.x.z:width() < 0.02)
  end)

  it("asks for the other ball or a plane", function()
    local m, _, at = slider()
    expect_error(function() m:hertz_contact { to = at, reach = 1, radius = 1, modulus = 1 } end,
      "expected either `from`, the other ball, or `normal`, of a plane")
  end)
end)

describe("a tyre", function()
  it("is Pacejka's formula in the axes of its hub", function()
    local m = ambit.mechanism "hub"
    local hub = m:planar { from = m.world, name = "car" }
    m:rigid_body { at = hub, mass = 2, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    local tyre = m:tyre { at = hub, load = 4000, friction = "0.9", stiffness = 60000, drive = 100 }
    local at, names = {}, m:coordinate_names()
    for i, name in ipairs(names) do at[name] = 0; at[m:speed_names()[i]] = 0 end
    local s = m:speed_names()
    at[s[1]], at[s[2]] = 20, 1
    local v = ambit.evaluate { m:velocity(hub), at = at }
    local peak, slip = 0.9 * 4000, v.y:mid() / math.sqrt(v.x:mid() ^ 2 + 0.01)
    near(value(tyre.lateral, at), -peak * math.sin(1.3 * math.atan(60000 / (1.3 * peak) * slip)))
    near(value(tyre.drive, at), 100)
  end)

  it("is its stiffness times the slip angle where that is small, and at most friction by load", function()
    local m = ambit.mechanism "wheel"
    local hub = m:prismatic { from = m:prismatic { from = m.world, axis = "x", name = "x" }, axis = "y", name = "y" }
    m:point_mass { at = hub, mass = 2 }
    local tyre = m:tyre { at = hub, load = 4000, stiffness = 60000 }
    local function lateral(vx, vy) return value(tyre.lateral, { x = 0, y = 0, ["x'"] = vx, ["y'"] = vy }) end
    assert.is_true(math.abs(lateral(20, 1e-3):mid() + 60000 * 1e-3 / 20) < 1e-4)
    for _, vy in ipairs { -30, -1, 2, 50 } do assert.is_true(lateral(10, vy):mag() <= 4000) end
    assert.is_true(lateral(0, 0):mag() == 0 and lateral(-20, 1).hi < 0)
    local run = ambit.simulate { m, initial = { x = 0, y = 0, ["x'"] = 20, ["y'"] = around("0.5", "2%") }, t = "0.1" }
    assert.equal("complete", run.status)
    assert.is_true(run.x["y'"]:mag() < 0.5)
  end)
end)
