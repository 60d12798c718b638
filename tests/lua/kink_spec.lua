-- Laws with kinks that sets cross, by the solver that the default call takes: widths against sampled hulls. That
-- nothing is lost is tested by random_equations.lua --kinks.
local ambit = require "ambit"
local around, max, min = ambit.around, ambit.max, ambit.min

-- Widths of all states are within `most` of the sampled hull's.
local function expect_tight(q, most)
  local run = ambit.simulate(q)
  assert.equal("complete", run.status, run.reason)
  local hull = ambit.sample { q[1], initial = q.initial, t = q.t, n = 100 }
  for _, name in ipairs(q[1].states) do
    local ratio = run.x[name]:width() / hull.x[name]:width()
    assert.is_true(ratio < most, ("%s: %.3g times the hull"):format(name, ratio))
  end
  return run
end

local function oscillator(force)
  return ambit.ode { states = { "x", "v" }, parameters = { k = around(1, "2%") },
    equations = function(s, p) return { x = s.v, v = -p.k * s.x - force(s) } end }
end

describe("a law with a kink", function()
  it("has two slopes: a damper is crossed twice a period, from a start on its kink", function()
    local soft, hard = around("0.2", "5%"), around(1, "5%")
    local run = expect_tight({ oscillator(function(s) return soft * max(s.v, 0) + hard * min(s.v, 0) end),
      initial = { x = around(1, "0.1"), v = 0 }, t = 6 }, 1.2)
    assert.equal("zonotope", run.solver)
  end)

  it("is a dead zone", function()
    local k = around(50, "1%")
    expect_tight({ oscillator(function(s) return k * (max(s.x - "0.2", 0) + min(s.x + "0.2", 0)) + "0.2" * s.v end),
      initial = { x = around(1, "1e-3"), v = 0 }, t = 2 }, 1.5)
  end)

  it("is a saturation", function()
    expect_tight({ oscillator(function(s) return max(-1, min(1, 8 * s.x + 2 * s.v)) end),
      initial = { x = around(2, "0.02"), v = 0 }, t = 3 }, 1.3)
  end)

  it("is one of time, or of data", function()
    local ramp = ambit.ode { states = { "x" }, parameters = { p = around(0, "0.1") },
      equations = function(s, p, t) return { x = min(max(t - "0.25", 0), "0.5") + max(p.p, 0) - s.x } end }
    local run = expect_tight({ ramp, initial = { x = 0 }, t = 1 }, 1.6) -- max(p, 0) is p / 2 and 0 to p / 2
    -- with p <= 0: x = integral of e^(s - 1) times the ramp
    local function part(a, b) return (b - 1) * math.exp(b) - (a - 1) * math.exp(a) - (math.exp(b) - math.exp(a)) / 4 end
    local x = (part(0.25, 0.75) + (math.exp(1) - math.exp(0.75)) / 2) / math.exp(1)
    assert.is_true(run.x.x:contains(x))
  end)

  it("holds a mechanism at rest on its kink", function()
    local m = ambit.mechanism "stop"
    local at, joint = m:prismatic { from = m.world, axis = "x", name = "x" }
    m:point_mass { at = at, mass = around(1, "5%") }
    m:joint_torque { joint = joint, force = function(x, v) return -100 * max(x, 0) - 10 * x - 5 * max(v, 0) - v end }
    local run = ambit.simulate { m:dynamics(), initial = { x = 0, ["x'"] = 0 }, t = 5, solver = "zonotope" }
    assert.equal("complete", run.status)
    assert.is_true(run.x.x:mag() < 1e-12 and run.x["x'"]:mag() < 1e-12)
  end)

  it("is friction with a straight step, through reversals", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local hinge, joint = m:revolute { from = m.world, axis = "z", name = "a" }
    m:point_mass { at = m:rigid_link { from = hinge, offset = { 0, -1, 0 } }, mass = around(1, "2%") }
    m:joint_friction { joint = joint, coulomb = around("0.1", "5%"), velocity = "0.01", step = "straight" }
    local rate = m:dynamics():rate "a'"
    local function effort(v) return ambit.evaluate { rate, at = { a = 0, ["a'"] = v } } end
    assert.is_true(effort("0.5"):contains(-0.1) and effort("-0.5"):contains(0.1) and effort("0.005"):contains(-0.05))
    expect_tight({ m:dynamics(), initial = { a = ambit.degrees(around(45, "0.5")), ["a'"] = 0 }, t = 3 }, 1.1)
  end)

  it("tells when the set crosses it", function()
    local system = oscillator(function(s) return max(s.x, 0) end)
    local run = ambit.simulate { system, initial = { x = around(1, "1e-3"), v = 0 }, t = 2, solver = "zonotope",
      events = { { name = "kink", g = function(s) return s.x end, direction = "falling" } } }
    assert.equal("complete", run.status)
    local t = run.events[1].t -- a quarter of the period for k + 1 within 1 %
    assert.is_true(run.events[1].certain and t:contains(math.pi / 2 / math.sqrt(2)) and t:width() < 0.013)
  end)
end)
