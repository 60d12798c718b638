-- From the scene to the proof, against numbers that are not ours. Sources: SmartMOBILE paper (2007), table 1, for the
-- manipulator, its true range by search over the vertices; double pendulum (ValEncIA-IVP paper, 2006, equations 23 to
-- 25) in quadruple precision by Gragg-Bulirsch-Stoer with two tolerances; Lorenz: VNODE-LP's manual. References were
-- rounded: half a unit of their last place is added where that matters.
local ambit = require "ambit"
local around, degrees, pi = ambit.around, ambit.degrees, ambit.pi

describe("the manipulator", function()
  it("contains the true range and is at most as wide as required", function()
    local arm = ambit.mechanism "five-arm manipulator"
    local at = arm.world
    local lengths, angles = { "6.5", 4, 4, 4, "3.5" }, { 60, -20, -20, -20, -30 }
    for i = 1, 5 do
      at = arm:sloppy_joint { from = at, axis = "z", angle = degrees(around(angles[i], "0.1")), play = "0.002" }
      at = arm:rigid_link { from = at, offset = { around(lengths[i], "0.1%"), 0, 0 } }
    end
    local tip = ambit.evaluate { arm:position(at) }
    local half = 5e-10
    assert.is_true(tip.x:contains(ambit.interval(17.052681642 + half, 17.155373260 - half)))
    assert.is_true(tip.y:contains(ambit.interval(7.706658140 + half, 7.930200616 - half)))
    assert.is_true(tip.x:width() <= 0.306 and tip.y:width() <= 0.286)
    local inner = ambit.sample { arm:position(at), n = 2000 }
    assert.is_true(tip.x:contains(inner.x) and tip.y:contains(inner.y))
    local nominal = ambit.evaluate { arm:position(at), arithmetic = "real" }
    assert.is_true(math.abs(nominal.x.lo - 17.10403717) < 1e-8 and math.abs(nominal.y.lo - 7.81839614) < 1e-8)
  end)
end)

describe("the double pendulum", function()
  local states = { "beta1", "beta2", "beta1'", "beta2'" }
  local function simulate(first, t)
    local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
    local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1,
      0 } }
    local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
    m:point_mass { at = elbow, mass = 1 }
    m:point_mass { at = hand, mass = 1 }
    return ambit.simulate {
      m:dynamics(), t = t,
      initial = { beta1 = first, beta2 = -11 * pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" },
    }
  end

  it("from a point contains the reference digits", function()
    local reference = {
      [0.1] = { "2.3605206206822492638356", "-1.657117266024173045183", "-0.3302783220417166603230",
        "0.73176457106421326609531" },
      [0.3] = { "2.1470716844612488637524", "-1.480263371068746708183", "-1.840084656925489736893",
        "1.2338170813092113669301" },
      [0.5] = { "1.5907483260442350923970", "-1.001250959273464265600", "-3.890608637676138586123",
        "4.2683224500661727099201" },
    }
    local run = simulate(3 * pi / 4, { 0, 0.1, 0.3, 0.5 })
    assert.equal("complete", run.status)
    for t, digits in pairs(reference) do
      for i, name in ipairs(states) do
        local x = run:at(t)[name]
        assert.is_true(x:contains(digits[i]), ("%s at %g"):format(name, t))
        assert.is_true(x:width() < 1e-12)
      end
    end
  end)

  it("from an angle known to 1 % contains the sampled hulls", function()
    local hull = {
      [0.1] = { 2.336179171099, 2.384881903659, -1.658717509945, -1.655516950176, -0.346075429565, -0.314091925496,
        0.699313497203,
        0.764230698440 },
      [0.4] = { 1.883570840705, 1.955060928000, -1.344345127047, -1.283223028491, -2.802284137059, -2.683524308532,
        2.040420984605,
        2.406171890995 },
      [0.504] = { 1.531408293948, 1.618714298828, -1.039114608316, -0.928120625332, -4.051160797340, -3.847003037260,
        4.074271600607, 4.704271974574 },
    }
    local run = simulate(around(3 * pi / 4, "1%"), { 0, 0.1, 0.4, 0.504, 0.62 })
    assert.equal("complete", run.status)
    for t, bounds in pairs(hull) do
      for i, name in ipairs(states) do
        local inner = ambit.interval(bounds[2 * i - 1] + 1e-12, bounds[2 * i] - 1e-12)
        assert.is_true(run:at(t)[name]:contains(inner), ("%s at %g"):format(name, t))
      end
    end
  end)
end)

describe("the Lorenz system", function()
  it("contains VNODE-LP's digits at t = 1", function()
    local lorenz = ambit.ode {
      states = { "x", "y", "z" },
      equations = function(s)
        return { x = 10 * (s.y - s.x), y = s.x * (28 - s.z) - s.y, z = s.x * s.y - ambit.number "8/3" * s.z }
      end,
    }
    local run = ambit.simulate { lorenz, initial = { 15, 15, 36 }, t = 1 }
    assert.is_true(run.x.x:contains "-6.9453541599034593196")
    assert.is_true(run.x.y:contains "2.9971546266290307395")
    assert.is_true(run.x.z:contains "35.144350305722419178")
  end)
end)

describe("the pendulum", function()
  it("keeps its energy for 100 s", function()
    local pendulum = ambit.ode {
      states = { "phi", "omega" },
      equations = function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) } end,
    }
    local run = ambit.simulate { pendulum, initial = { phi = 1, omega = 0 }, t = { 0, 100 } }
    assert.equal("complete", run.status)
    local energy = ambit.sqr(run.x.omega) / 2 - ambit.cos(run.x.phi)
    assert.is_true(energy:contains(-ambit.cos(ambit.interval(1))))
    assert.is_true(run.x.phi:width() < 3.3e-12)
  end)
end)
