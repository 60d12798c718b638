-- Functions of time of which only bounds are known: ambit.varying.
local ambit = require "ambit"

local function oscillator(damping, push)
  return (ambit.ode { states = { "x", "v" },
    equations = function(s) return { x = s.v, v = -s.x - damping * s.v + push } end })
end

describe("what varies in time", function()
  it("reaches what the worst function reaches, and hardly more", function()
    local run = ambit.simulate { oscillator(0, ambit.varying(-1, 1)), initial = { x = 0, v = 0 }, t = { 0, 20 } }
    assert.equal("complete", run.status)
    local reach = 12 + 1 - math.cos(20 - 6 * math.pi) -- the integral of |sin| over 20 s
    assert.is_true(run.x.x.hi >= reach and run.x.x.lo <= -reach)
    assert.is_true(run.x.x.hi < 1.02 * reach, tostring(run.x.x))
  end)

  it("settles where damping takes back what it feeds", function()
    local run = ambit.simulate { oscillator(ambit.number "0.2", ambit.varying("-0.1", "0.1")),
      initial = { x = 0, v = 0 }, t = { 0, 60 } }
    local q = math.exp(-math.pi * 0.1 / math.sqrt(0.99))
    local reach = 0.1 * (1 + q) / (1 - q)
    assert.is_true(run.x.x.hi >= 0.999 * reach and run.x.x.hi < 1.03 * reach, tostring(run.x.x))
  end)

  it("is far more than a constant that nobody knows", function()
    local constant = ambit.simulate { oscillator(0, ambit.between(-1, 1)), initial = { x = 0, v = 0 }, t = { 0, 20 } }
    assert.is_true(constant.x.x.hi < 2.1)
  end)

  it("is one function wherever it stands, and two are independent", function()
    local function run(a, b)
      local system = ambit.ode { states = { "x" }, equations = function(s) return { x = a - b } end }
      return ambit.simulate { system, initial = { x = 0 }, t = { 0, 1 } }.x.x
    end
    local w = ambit.varying(-1, 1)
    assert.is_true(run(w, w):width() < 1e-9)
    local two = run(w, ambit.varying(-1, 1))
    assert.is_true(two.lo <= -2 and two.hi >= 2 and two.hi < 2.01)
  end)

  it("acts through torques of mechanisms, with data beside it", function()
    local arm = ambit.mechanism { "arm", gravity = { 0, 0, "-9.81" } }
    local frame, joint = arm:revolute { from = arm.world, axis = "y", name = "q" }
    arm:rigid_body { at = frame, mass = ambit.around(2, "1%"), centre = { "0.3", 0, 0 },
      inertia = { "0.1", 0, 0, 0, "0.1", 0, 0, 0, "0.1" } }
    local noise = ambit.varying("-0.001", "0.001", "noise")
    arm:joint_torque { joint = joint, torque = function(q, v) return 80 * ("0.5" - (q + noise)) - 12 * v end }
    local run = ambit.simulate { arm:dynamics(), initial = { q = 0, ["q'"] = 0 }, t = { 0, 1 } }
    assert.equal("complete", run.status)
    assert.equal("zonotope", run.solver)
    local inner = ambit.sample { arm:dynamics(), initial = { q = 0, ["q'"] = 0 }, t = { 0, 1 }, n = 40 }
    assert.is_true(run.x.q.lo <= inner.x.q.lo and inner.x.q.hi <= run.x.q.hi)
    assert.is_true(inner.x.q.hi - inner.x.q.lo > 0.001)
    assert.is_true(run.x.q:width() < 1.6 * (inner.x.q.hi - inner.x.q.lo))
  end)

  it("may stand in conditions and at single moments", function()
    local w = ambit.varying(1, 2, "w")
    local x = ambit.evaluate { 2 * w, arithmetic = "interval" }
    assert.is_true(x:contains(2) and x:contains(4))
    local system = ambit.ode { states = { "x" }, equations = function(s) return { x = w - s.x } end }
    local answer = ambit.verify { system, initial = { x = 1 }, t = { 0, 3 }, safe = function(s) return s.x - "2.1" end }
    assert.equal("proved", answer.status)
  end)

  it("finds events of what it moves", function()
    local system = ambit.ode { states = { "x" }, equations = function() return { x = ambit.varying(1, 2) } end }
    local run = ambit.simulate { system, initial = { x = -1 }, t = { 0, 2 },
      events = { { name = "zero", g = function(s) return s.x end, stop = true } } }
    local event = run.events[1]
    assert.is_true(event.t.lo <= 0.5 and event.t.hi >= 1)
  end)

  it("has no periodic orbit, and nothing rests under it", function()
    local w = ambit.varying("-0.001", "0.001", "wind")
    local system = ambit.ode { states = { "x", "y" },
      equations = function(s) return { x = s.y, y = (1 - s.x ^ 2) * s.y - s.x + w } end }
    local map = ambit.poincare { system, section = function(s) return s.y end, direction = "falling",
      initial = { x = ambit.around("2.00862", "0.02"), y = 0 }, t_max = 8 }
    assert.equal("complete", map.status) -- every solution returns, into the initial set, and no two alike
    local orbit = map:orbit()
    assert.is_false(orbit.proved)
    assert.is_truthy(orbit.reason:find("`wind` varies in time", 1, true))
    local good, problem = pcall(ambit.equilibria, { system, box = { x = { -3, 3 } } })
    assert.is_false(good)
    assert.is_truthy(tostring(problem):find("`wind` varies in time", 1, true))
  end)

  it("is refused where it makes no sense, with the reason", function()
    local w = ambit.varying(-1, 1, "w")
    local function refused(f, text)
      local good, problem = pcall(f)
      assert.is_false(good)
      assert.is_truthy(tostring(problem):find(text, 1, true), problem)
    end
    local system = oscillator(0, 0)
    refused(function() ambit.simulate { system, initial = { x = w, v = 0 }, t = { 0, 1 } } end, "varies in time")
    refused(function() ambit.varying(2, 1) end, "reversed")
    refused(function() ambit.varying(0, w) end, "known numbers")
    local m = ambit.mechanism { "m", gravity = { 0, 0, "-9.81" } }
    refused(function()
      local frame = m:rigid_link { from = m.world, offset = { w, 0, 0 } }
      local tip = m:revolute { from = frame, axis = "y", name = "q" }
      m:rigid_body { at = tip, mass = 1, centre = { 1, 0, 0 }, inertia = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } }
      ambit.simulate { m:dynamics(), initial = { q = 0, ["q'"] = 0 }, t = { 0, 1 } }
    end, "differentiated by time")
  end)

  it("is not given to solvers that take data for constants", function()
    for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff", "gsl" } do
      local run = ambit.simulate { oscillator(0, ambit.varying(-1, 1, "push")), initial = { x = 0, v = 0 }, t = { 0, 1 },
        solver = solver }
      assert.equal("unable", run.status)
      assert.equal("unable.varying", run.code)
      assert.is_truthy(run.reason:find("`push` varies in time", 1, true))
      assert.equal(0, run.step_count)
    end
  end)
end)
