-- Functions of time whose rate of change is bounded: ambit.varying(lo, hi, { rate = ... }).
local ambit = require "ambit"

local function oscillator(push)
  return (ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x + push } end })
end

local function from_rest(push, times)
  return ambit.simulate { oscillator(push), initial = { x = 0, v = 0 }, t = times }
end

-- The highest integral of weight(s) d(s) over [0, t], lo <= d <= hi, d' between -3 up and up: by dynamic programming
-- over d in steps of up h; less than the true one by what the steps leave.
local function highest(weight, t, lo, hi, up, down, cells)
  local h = (hi - lo) / cells / up
  local n = math.floor(t / h)
  local value = {}
  h = t / n
  for j = 0, cells do value[j] = 0 end
  for k = 1, n do
    local now = {}
    local w = weight((k - 0.5) * h) * h
    for j = 0, cells do
      local best = -math.huge -- where it comes from
      for from = math.max(0, j - 1), math.min(cells, j + down) do best = math.max(best, value[from]) end
      now[j] = best + w * (lo + (hi - lo) * j / cells)
    end
    value = now
  end
  local best = -math.huge
  for j = 0, cells do best = math.max(best, value[j]) end
  return best
end

local function fails(f, text)
  local good, why = pcall(f)
  assert.is_false(good)
  assert.is_truthy(tostring(why):find(text, 1, true), tostring(why))
end

-- A function that keeps to bounds and rates, as f(t): slopes at random, often the steepest, turned round at the bounds.
local function any_slow(lo, hi, least, most, t, h)
  local value, d = {}, lo + (hi - lo) * math.random()
  local slope, left = 0, 0
  for k = 0, math.ceil(t / h) + 1 do
    value[k] = d
    if left <= 0 then
      local turn = math.random(1, 4)
      slope = turn == 1 and least or turn == 2 and most or least + (most - least) * math.random()
      left = math.random() * t / 4
    end
    d, left = math.min(hi, math.max(lo, d + slope * h)), left - h
  end
  return function(s)
    local k = math.floor(s / h)
    return value[k] + (value[k + 1] - value[k]) * (s / h - k)
  end
end

describe("what varies at a bounded rate", function()
  it("reaches what the worst function reaches, and far less than without that bound", function()
    local run = from_rest(ambit.varying(-1, 1, { rate = "0.1" }), { 0, 20 })
    assert.equal("complete", run.status)
    local reach = highest(function(s) return math.sin(20 - s) end, 20, -1, 1, 0.1, 1, 400)
    assert.is_true(reach > 1.85 and reach < 1.9, reach)
    assert.is_true(run.x.x.hi >= reach and run.x.x.lo <= -reach, tostring(run.x.x))
    assert.is_true(run.x.x.hi < 1.2 * reach, tostring(run.x.x))
  end)

  it("may rise and fall at different rates, between bounds on one side of 0", function()
    for _, t in ipairs { 3, 8, 15 } do
      local push = ambit.varying("0.2", 1, { rate = { "-0.15", "0.05" }, name = "push" })
      local x = from_rest(push, { 0, t }).x.x
      local function weight(s) return math.sin(t - s) end
      local most = highest(weight, t, 0.2, 1, 0.05, 3, 300)
      local least = -highest(function(s) return -weight(s) end, t, 0.2, 1, 0.05, 3, 300)
      assert.is_true(x.lo <= least and most <= x.hi, tostring(x))
      assert.is_true(x:width() < 1.45 * (most - least), (x:width() / (most - least)) .. ": " .. tostring(x))
    end
  end)

  it("is a state that stays within its bounds, also of long runs and from a start of one's own", function()
    local push = ambit.varying("0.2", 1, { rate = "0.5", name = "push" })
    local run = from_rest(push, { 0, 1, 30 })
    assert.is_true(run.x.push.lo >= 0.199999 and run.x.push.hi <= 1.000001)
    local own = ambit.simulate { oscillator(push), initial = { x = 0, v = 0, push = "0.5" }, t = { 0, "0.5" } }
    assert.is_true(own.x.push:contains "0.25" and own.x.push:contains "0.75" and own.x.push:width() < 0.51)
    fails(function()
      ambit.simulate { oscillator(push), initial = { x = 0, v = 0, push = 2 }, t = { 0, 1 } }
    end, "initial.push")
    -- 1 / push is defined for ever
    local inverse = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x / push } end }
    assert.equal("complete", ambit.simulate { inverse, initial = { x = 1 }, t = { 0, 20 } }.status)
  end)

  it("makes no set wider than it is without the bound", function()
    for _, rate in ipairs { 1, 3, 10 } do
      local slow = ambit.varying(-1, 1, { rate = rate })
      local free = from_rest(ambit.varying(-1, 1), { 0, 5 }).x.x
      local run = from_rest(slow, { 0, 5 })
      assert.is_true(run.x.x:width() < 1.002 * free:width(), tostring(run.x.x))
      -- one is slow and one is fast
      local push = ambit.varying(-1, 1, { rate = "0.1" })
      local both = from_rest(push + slow, { 0, 5 }).x.x
      assert.is_true(both:width() < 1.01 * (free:width() + from_rest(push, { 0, 5 }).x.x:width()), tostring(both))
      local oscillation = oscillator(slow)
      assert.equal("proved", ambit.verify { oscillation, initial = { x = 0, v = 0 }, t = 5,
        at_end = function(s) return s.x - 1.002 * free.hi end }.status)
    end
  end)

  it("holds every motion of a pendulum that such a function moves", function()
    math.randomseed(194)
    local torque, damping = ambit.varying("-0.5", "1.5", { rate = { "-0.2", "0.4" } }), ambit.around("0.3", "20%")
    local pendulum = ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = -9.81 * ambit.sin(s.x) - damping * s.v + torque }
    end }
    local start = ambit.around("0.2", "0.1")
    local run = ambit.simulate { pendulum, initial = { x = start, v = 0 }, t = { 0, 0.5, 1, 2, 4 } }
    assert.equal("complete", run.status)
    local hull = {}
    for _ = 1, 300 do
      local d, c = any_slow(-0.5, 1.5, -0.2, 0.4, 4, 0.01), 0.24 + 0.12 * math.random()
      local x, v, h = 0.1 + 0.2 * math.random(), 0, 0.01
      local function rate(t, a, b) return b, -9.81 * math.sin(a) - c * b + d(t) end
      for k = 0, 399 do
        local t = k * h
        local a1, b1 = rate(t, x, v)
        local a2, b2 = rate(t + h / 2, x + h / 2 * a1, v + h / 2 * b1)
        local a3, b3 = rate(t + h / 2, x + h / 2 * a2, v + h / 2 * b2)
        local a4, b4 = rate(t + h * (1 - 1e-12), x + h * a3, v + h * b3)
        x, v = x + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4), v + h / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
        for _, at in ipairs { 0.5, 1, 2, 4 } do
          if k + 1 == math.floor(at / h + 0.5) then
            local box = run:at(at)
            assert.is_true(box.x:contains(x) and box.v:contains(v))
            hull[at] = { math.min((hull[at] or { x, x })[1], x), math.max((hull[at] or { x, x })[2], x) }
          end
        end
      end
    end
    assert.is_true(run:at(1).x:width() < 2 * (hull[1][2] - hull[1][1]))
  end)

  it("is drawn by samples, which lie inside and come near", function()
    local push = ambit.varying(-1, 1, { rate = "0.1" })
    local inner = ambit.sample { oscillator(push), initial = { x = 0, v = 0 }, t = { 0, 20 }, n = 300 }
    assert.is_true(inner.x.x.hi <= 1.9 and inner.x.x.hi > 1.3, tostring(inner.x.x.hi))
    local run = from_rest(push, { 0, 20 })
    assert.is_true(run.overestimate >= 1 and run.overestimate < 6, run.overestimate)
  end)

  it("acts through torques of mechanisms, and controllers that sample read it", function()
    local function arm(noise)
      local m = ambit.mechanism { "arm", gravity = { 0, 0, "-9.81" } }
      local frame, joint = m:revolute { from = m.world, axis = "y", name = "q" }
      m:rigid_body { at = frame, mass = ambit.around(2, "1%"), centre = { "0.3", 0, 0 },
        inertia = { "0.1", 0, 0, 0, "0.1", 0, 0, 0, "0.1" } }
      m:joint_torque { joint = joint, torque = function(q, v) return 80 * ("0.5" - (q + noise)) - 12 * v end }
      return m:dynamics()
    end
    local start = { q = 0, ["q'"] = 0 }
    local slow = ambit.varying("-0.01", "0.01", { rate = "0.002", name = "noise" })
    local run = ambit.simulate { arm(slow), initial = start, t = { 0, 1 } }
    assert.equal("complete", run.status)
    local inner = ambit.sample { arm(slow), initial = start, t = { 0, 1 }, n = 40 }
    assert.is_true(run.x.q.lo <= inner.x.q.lo and inner.x.q.hi <= run.x.q.hi)
    assert.is_true(run.x.q:width() < 1.2 * (inner.x.q.hi - inner.x.q.lo))
    local clock = ambit.sampled { period = "0.1", outputs = { "u" }, law = function(s) return -s.x + slow end }
    local held = ambit.ode { states = { "x" }, sampled = clock, equations = function(s) return { x = s.u } end }
    local looped = ambit.simulate { held, initial = { x = 1 }, t = { 0, 1 } }
    local drawn = ambit.sample { held, initial = { x = 1 }, t = { 0, 1 }, n = 40 }
    assert.is_true(looped.x.x.lo <= drawn.x.x.lo and drawn.x.x.hi <= looped.x.x.hi)
    assert.is_true(looped.x.x:width() < 1.2 * (drawn.x.x.hi - drawn.x.x.lo))
  end)

  it("is known to verify; other verbs forget the rate", function()
    local push = ambit.varying(-1, 1, { rate = "0.1", name = "push" })
    local function ask(most)
      return ambit.verify { oscillator(push), initial = { x = 0, v = 0 }, t = { 0, 20 }, budget = 20,
        safe = function(s) return s.x - most end }
    end
    assert.equal("proved", ask("3.4").status)
    assert.equal("refuted", ask("1.5").status) -- a constant comes to 2
    assert.is_true(ask("2.7").status ~= "refuted") -- nothing that is constant comes there
    local damped = ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = -s.x - s.v + "0.1" * push }
    end }
    assert.equal("proved", ambit.invariant { damped, about = { x = 0 } }.status)
  end)

  it("has units", function()
    -- x' = d, from 0: in SI, the same whatever the units are
    for _, case in ipairs { { "-1 N", "1 N", "0.1 N/s", 1 }, { "-1 mm", "1 mm", "0.1 mm/s", 1e-3 },
      { "-1 deg", "1 deg", "0.1 deg/s", math.pi / 180 } } do
      local d = ambit.varying(case[1], case[2], { rate = case[3], name = "d" })
      local system = ambit.ode { states = { "x" }, check_units = false,
        equations = function() return { x = d } end }
      local run = ambit.simulate { system, initial = { x = 0, d = 0 }, t = { 0, 2 } }
      local most = 0.2 * case[4] -- rate t^2 / 2
      assert.equal("complete", run.status)
      assert.is_true(run.x.x.hi >= most and run.x.x.hi < 1.2 * most, tostring(run.x.x))
    end
  end)

  it("goes on from a set that reaches beyond the bounds", function()
    local d = ambit.varying(-1, 1, { rate = 0.5, name = "d" })
    local system = ambit.ode { states = { "x", "v" }, equations = function(x) return { x = x.v, v = -x.x + d } end }
    local run = ambit.simulate { system, initial = { x = 0, v = 0 }, t = { 0, 3 } }
    local on = ambit.simulate { system, initial = run:set(), t = { 3, 4 } }
    local whole = ambit.simulate { system, initial = { x = 0, v = 0 }, t = { 0, 4 } }
    assert.equal("complete", on.status)
    assert.is_true(on.x.x.hi >= 0.9 * whole.x.x.hi and on.x.x.hi < 1.3 * whole.x.x.hi)
    fails(function() ambit.simulate { system, initial = { x = 0, v = 0, d = 2 }, t = { 0, 1 } } end, "stays between")
  end)

  it("keeps what events of a run were found", function()
    local d = ambit.varying(-1, 1, { rate = 10, name = "d" })
    local system = ambit.ode { states = { "x" }, equations = function() return { x = d } end }
    local run = ambit.simulate { system, initial = { x = 0 }, t = { 0, 0.125, 10 },
      events = { { g = function(_, _, t) return t - 5 end, name = "bell", stop = true } } }
    assert.equal("bell", run.ended_by)
    assert.is_true(run.t_reached >= 5 and run.x.x.hi >= 4.8 and run.x.x.lo <= -4.8, tostring(run.x.x))
  end)

  it("loses no verdict that the rate proves", function()
    local push = ambit.varying(-1, 1, { rate = 0.1, name = "push" })
    local system = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x + push } end }
    local report = ambit.verify { system, initial = { x = 0, v = 0 }, t = 20, budget = 0, at_end = {
      a = function(s) return s.x - 2.5 end, b = function(s) return s.x - 1.9 end } }
    assert.equal("proved", report.conditions.a.status)
    assert.equal("undecided", report.status)
  end)

  it("says what is missing", function()
    fails(function() ambit.varying(0, 1, { rate = -1 }) end, "rate")
    fails(function() ambit.varying(0, 1, { rate = { 1, 2 } }) end, "rate")
    fails(function() ambit.varying(0, 1, { speed = 1 }) end, "speed")
    fails(function() ambit.varying("0 m", "1 m", { rate = "1 m" }) end, "m/s")
    local fixed = from_rest(ambit.varying(0, 1, { rate = 0 }), { 0, 3 })
    assert.is_true(fixed.x.x:contains(1 - math.cos(3)) and fixed.x.x.hi < 2.01)
  end)
end)
