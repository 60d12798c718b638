-- Equations of one's own in a mechanism, m:state: values against an integration written by hand, every solver and
-- verb that takes a mechanism, bad input.
local ambit = require "ambit"
local around, number = ambit.around, ambit.number

local N, J, L, GAIN = 50, 0.25, 1e-3, 10

-- A motor with current i drives an arm by a gear; data = { length, mass, torque constant, resistance }.
local function arm(data)
  local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
  local joint = m:revolute { from = m.world, axis = "z", name = "q" }
  local hand = m:rigid_link { from = joint, offset = { data.length, 0, 0 }, name = "rod" }
  m:point_mass { at = hand, mass = data.mass, name = "load" }
  m:armature { joint = joint, inertia = J }
  local i = m:state { "i", unit = "A", rate = function(q, i)
    return (number(GAIN, "V") * (1 - q.q) - data.resistance * i - data.constant * N * q["q'"]) / number(L, "H")
  end }
  m:joint_torque { joint = joint, torque = data.constant * N * i }
  return m, hand, i
end

local function uncertain()
  return arm { length = around("0.5", "1%"), mass = around("2 kg", "5%"), constant = around("0.05 N m/A", "3%"),
    resistance = around("1 ohm", "2%") }
end

-- The same by the classical Runge-Kutta method: q, i, q' at the end.
local function integrate(length, mass, constant, resistance, t, steps)
  local function rates(x)
    local torque = constant * N * x[2] - mass * 9.81 * length * math.cos(x[1])
    return { x[3], (GAIN * (1 - x[1]) - resistance * x[2] - constant * N * x[3]) / L, torque / (J + mass * length ^ 2) }
  end
  local function plus(x, h, k) return { x[1] + h * k[1], x[2] + h * k[2], x[3] + h * k[3] } end
  local x, h = { 0, 0, 0 }, t / steps
  for _ = 1, steps do
    local a = rates(x)
    local b = rates(plus(x, h / 2, a))
    local c = rates(plus(x, h / 2, b))
    local d = rates(plus(x, h, c))
    for k = 1, 3 do x[k] = x[k] + h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]) end
  end
  return x
end

local function expect_error(f, pattern)
  local good, message = pcall(f)
  assert.is_false(good, pattern)
  assert.is_truthy(tostring(message):find(pattern), message)
end

local start = { q = 0, i = 0, ["q'"] = 0 }

describe("a state of a mechanism", function()
  it("is a state of its dynamics, in its unit, known to every law", function()
    local m, _, i = uncertain()
    local system = m:dynamics()
    assert.same({ "q", "i", "q'" }, system.states)
    assert.same({ "q" }, m:coordinate_names())
    assert.same({ "q'" }, m:speed_names())
    assert.is_true(m:coordinates().i == i)
    expect_error(function() return i + "1 m" end, "dimensions differ: an electric current %(A%)")
    local x = ambit.evaluate { system:rate "i", at = { q = "0.5", i = 2, ["q'"] = 1 } }
    assert.is_true(x:contains((5 - 2 - 2.5) / L) and x:contains((5 - 2.04 - 0.0515 * N) / L))
  end)

  for _, solver in ipairs { "lohner", "zonotope", "stiff", "valencia" } do
    it("is enclosed by " .. solver .. " for all data", function()
      local m = uncertain()
      local t = solver == "valencia" and 0.01 or 0.05
      local run = ambit.simulate { m:dynamics(), initial = start, t = t, solver = solver }
      assert.equal("complete", run.status)
      for corner = 0, 15 do
        local function at(k, x, tolerance) return x * (1 + tolerance * (corner >> k & 1 == 1 and 0.999 or -0.999)) end
        local x = integrate(at(0, 0.5, 0.01), at(1, 2, 0.05), at(2, 0.05, 0.03), at(3, 1, 0.02), t, 2000)
        for k, name in ipairs { "q", "i", "q'" } do
          assert.is_true(run.x[name]:contains(x[k]), ("%s: %s misses %.17g"):format(name, tostring(run.x[name]), x[k]))
        end
      end
      local hull = ambit.sample { m:dynamics(), initial = start, t = t, n = 64 }
      for _, name in ipairs { "q", "i", "q'" } do
        assert.is_true(run.x[name]:width() < 1.5 * hull.x[name]:width(), name)
      end
    end)
  end

  it("is one joint's business in a long chain, whose accelerations are never written", function()
    local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
    local at, first = m.world, nil
    for k = 1, 12 do
      local frame, joint = m:revolute { from = at, axis = "z", name = "q" .. k }
      first = first or joint
      at = m:rigid_link { from = frame, offset = { 0, "-0.2", 0 } }
      m:point_mass { at = at, mass = around(1, "0.1%") }
    end
    local e = m:state { "e", unit = "rad s", rate = function(q) return q.q1 - "0.1" end }
    m:joint_torque { joint = first, torque = function(q, v) return -200 * (q - "0.1") - 20 * v - 10 * e end }
    local initial = { e = 0 }
    for k = 1, 12 do initial["q" .. k], initial[("q%d'"):format(k)] = k == 1 and "0.1" or 0, 0 end
    local run = ambit.simulate { m:dynamics(), initial = initial, t = "0.05", solver = "zonotope" }
    assert.equal("complete", run.status)
    local other = ambit.simulate { m:dynamics(), initial = initial, t = "0.05", solver = "gsl" }
    for name, x in pairs(run.x) do assert.is_true(x:contains(other.x[name]:mid()) or math.abs(
      x:mid() - other.x[name]:mid()) < 1e-7, name) end
    assert.is_true(run.x.e.hi < 0 or run.x.e.lo > 0)
  end)

  it("may depend on one that comes later", function()
    local m = ambit.mechanism "tanks"
    m:state { "h1", unit = "m", rate = function(q, h) return "0.5 1/s" * (q.h2 - h) end }
    m:state { "h2", unit = "m", rate = function(q, h) return "0.5 1/s" * (q.h1 - h) end }
    local run = ambit.simulate { m, initial = { h1 = around(2, "1%"), h2 = 0 }, t = 3 }
    local e = math.exp(-3)
    assert.equal("complete", run.status)
    assert.is_true(run.x.h1:contains(1.99 * (1 + e) / 2) and run.x.h1:contains(2.01 * (1 + e) / 2))
    assert.is_true(run.x.h2:contains(1.99 * (1 - e) / 2) and run.x.h2:width() < 0.0191)
  end)

  it("moves with closed loops", function()
    local m = ambit.mechanism { "press", gravity = { 0, "-9.81", 0 } }
    local crank, joint = m:revolute { from = m.world, axis = "z", name = "crank" }
    local tip = m:rigid_link { from = crank, offset = { 1, 0, 0 } }
    local slider = m:prismatic { from = m.world, axis = "x", name = "slider" }
    local rod = m:rigid_link { from = m:revolute { from = slider, axis = "z", name = "rod" }, offset = { -2, 0, 0 } }
    m:point_mass { at = tip, mass = 1 }
    m:point_mass { at = slider, mass = 2 }
    m:close_pin { a = tip, b = rod, name = "loop" }
    local i = m:state { "i", unit = "A", rate = function(q, i) return 5 - i - q["slider'"] end }
    m:joint_torque { joint = joint, torque = 2 * i }
    local found = m:assemble { crank = 1, guess = { slider = "2.3", rod = "-0.4" }, within = "0.5" }
    assert.equal("unique", found.status)
    local initial = { i = around(0, "0.01") }
    for name, x in pairs(found.configuration) do initial[name] = x end
    for _, name in ipairs(m:dynamics().states) do initial[name] = initial[name] or 0 end
    local runs = {}
    for k, solver in ipairs { "lohner", "zonotope" } do
      runs[k] = ambit.simulate { m:dynamics(), initial = initial, t = "0.3", solver = solver }
      assert.equal("complete", runs[k].status)
    end
    for name, x in pairs(runs[1].x) do assert.is_true(not x:intersect(runs[2].x[name]):is_empty(), name) end
    assert.is_true(runs[1].x.i:width() < 0.03 and runs[1].x.i.lo > 0.9)
  end)

  it("is verified, watched, kept at rest and reduced", function()
    local m, hand, i = uncertain()
    local safe = ambit.verify { m:dynamics(), initial = start, t = "0.2", safe = i - "10.1 A" }
    assert.equal("proved", safe.status)
    local run = ambit.simulate { m:dynamics(), initial = start, t = "0.05",
      events = { { name = "limit", g = i - "5 A", direction = "rising" } } }
    assert.equal("complete", run.status)
    assert.is_true(run.events[1].certain and run.events[1].t.hi < 0.01)
    local rest = ambit.equilibria { m:dynamics(), box = { q = { "-0.5", "1.5" }, i = { -10, 20 } } }
    assert.equal("complete", rest.status)
    assert.equal(1, #rest.proved)
    assert.is_true(rest.proved[1].i.lo > 2)
    m:point_mass { at = hand, mass = "1e-6", name = "label" }
    local small = ambit.reduce { m:dynamics(), t = { 0, "0.05" }, initial = start, outputs = { "q" },
      error = { q = "1e-3" } }
    assert.is_true(small.status == "complete", tostring(small))
    assert.is_truthy(tostring(small.ode):find("d i/dt", 1, true))
    local tree = m:tree().parts
    assert.same({ "state", "i" }, { tree[6].type, tree[6].path })
    local unit = {}
    for k, name in ipairs(small.ode.states) do unit[name] = small.ode.units[k] end
    assert.equal("A", unit.i)
  end)

  it("refuses what cannot be meant", function()
    local function refused(pattern, t, before)
      local m = arm { length = 1, mass = 1, constant = number "1 N m/A",
        resistance = number "1 ohm" }
      if before then before(m) end
      expect_error(function() m:state(t); return m:dynamics() end, pattern)
    end
    refused("the name is taken by the revolute `q`", { "q", rate = 1 })
    refused("the name is taken by the state `i`", { "i", rate = 1 })
    refused("cannot contain `'`", { "q'", rate = 1 })
    refused("name is that of time", { "t", rate = 1 })
    refused("the name is missing", { rate = 1 })
    refused("the name is given twice", { "x", name = "y", rate = 1 })
    refused("expected text, got number", { "x", unit = 3, rate = 1 })
    refused("unknown unit `foo`", { "x", unit = "foo", rate = 1 })
    refused("state `x`: rate is missing", { "x", unit = "A" })
    refused("state `x`: rate: `3 A` is in A, but A/s is expected", { "x", unit = "A", rate = "3 A" })
    refused("expected a value in A/s, got a length", { "x", unit = "A", rate = number "3 m" })
    refused("the function returned nothing", { "x", rate = function() end })
    refused("got boolean", { "x", rate = function() return true end })
    refused("did you mean `rate`", { "x", rates = 1 })
    refused("`k` cannot be assigned", { "x", rate = function(q) q.k = 1 end })
    refused("plain interval", { "x", rate = function(_, x) return ambit.interval(1, 2) * x end })
    refused("acceleration of `q`", { "x", rate = function(q) return q["q''"] end })
    local m = ambit.mechanism "lost"
    m:state { "x", rate = function(q) return q.y end }
    expect_error(function() return ambit.simulate { m, initial = { x = 0 }, t = 1 } end,
      "right%-hand side of state `x` depends on `y`")
  end)

  it("moves no joint by itself, and closes no loop", function()
    local function guided(rate)
      local m = ambit.mechanism "guide"
      local bar = m:revolute { from = m.world, axis = "z", name = "q" }
      m:rigid_body { at = bar, mass = 1, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
      local s = m:state { "s", unit = "m", rate = rate }
      m:point_mass { at = m:prismatic { from = bar, axis = "x", displacement = s, name = "slide" }, mass = 1 }
      return m
    end
    -- (1 + s^2) q'' + 2 s s' q' = 0 with s' = -s
    local rate = guided(function(_, s) return -s end):dynamics():rate "q'"
    assert.is_true(ambit.evaluate { rate, at = { q = 0, s = 2, ["q'"] = 5 } }:contains(8))
    expect_error(function() return guided(function(q) return q["q'"] end):dynamics().rates end,
      "given motion depends on the state `s`")
    local m = ambit.mechanism "rod"
    local a = m:prismatic { from = m.world, axis = "x", name = "a" }
    m:point_mass { at = a, mass = 1 }
    m:close_distance { a = a, b = m.world, length = m:state { "l", unit = "m", rate = 1 }, name = "rod" }
    expect_error(function() return m:dynamics() end, "constraint `rod` depends on the state `l`")
  end)
end)
