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
