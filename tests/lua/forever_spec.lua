-- Sets that no solution leaves, and conditions for all times: ambit.invariant, ambit.verify { t = math.huge }.
local ambit = require "ambit"

local function oscillator(damping, push)
  return (ambit.ode { states = { "x", "v" },
    equations = function(s) return { x = s.v, v = -ambit.sin(s.x) - damping * s.v + push } end })
end

local function arm(share)
  local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
  local f1, j1 = m:revolute { from = m.world, axis = "z", name = "a" }
  local elbow = m:rigid_link { from = f1, offset = { ambit.around(1, share), 0, 0 } }
  m:point_mass { at = elbow, mass = ambit.around(1, share) }
  local f2, j2 = m:revolute { from = elbow, axis = "z", name = "b" }
  local tip = m:rigid_link { from = f2, offset = { ambit.around(1, share), 0, 0 } }
  m:point_mass { at = tip, mass = ambit.around(1, share) }
  local k1, k2 = ambit.around(400, share), ambit.around(200, share)
  m:joint_torque { joint = j1, torque = function(q, v) return k1 * ("0.5" - q) - 60 * v end }
  m:joint_torque { joint = j2, torque = function(q, v) return k2 * ("0.7" - q) - 25 * v end }
  return m
end

-- Runge and Kutta's steps, in floats.
local function follow(f, x, t, n)
  local h = t / n
  local function moved(k, by)
    local y = {}
    for i, value in ipairs(x) do y[i] = value + by * k[i] end
    return y
  end
  for step = 1, n do
    local a = f(x, step * h)
    local b = f(moved(a, 0.5 * h), step * h)
    local c = f(moved(b, 0.5 * h), step * h)
    local d = f(moved(c, h), step * h)
    for i = 1, #x do x[i] = x[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
  end
  return x
end

local function random(lo, hi) return lo + (hi - lo) * math.random() end

local function fails(f, text)
  local good, why = pcall(f)
  assert.is_false(good)
  assert.is_truthy(tostring(why):find(text, 1, true), tostring(why))
end

describe("a set that no solution leaves", function()
  it("is about the state of rest of each of the data", function()
    local k = ambit.around(4, "10%", "k")
    local system = ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = 1 - k * s.x - 2 * s.v }
    end }
    local set = ambit.invariant { system, about = { x = "0.2" }, within = { x = { -1, 2 } } }
    assert.equal("proved", set.status)
    for _, stiffness in ipairs { 3.6, 4, 4.4 } do assert.is_true(set.settles.x:contains(1 / stiffness)) end
    assert.is_true(set.settles.x:width() < 0.07 and set.box.x.lo >= -1 and set.box.x.hi <= 2)
    assert.is_true(set:contains { x = "0.25", v = 0 })
    assert.is_false(set:contains { x = 3, v = 0 })
  end)

  it("holds whatever varies in time", function()
    local set = ambit.invariant { oscillator(1, ambit.varying("-0.1", "0.1")), about = { x = 0 },
      within = { x = { "-0.6", "0.6" } } }
    assert.equal("proved", set.status)
    local reach = 0 -- a push that always goes with the motion: the oscillator's own largest amplitude
    local x = { 0, 0 }
    for step = 1, 4000 do
      x = follow(function(y) return { y[2], -math.sin(y[1]) - y[2] + (y[2] >= 0 and 0.1 or -0.1) } end, x, 0.01, 1)
      if step > 2000 then reach = math.max(reach, math.abs(x[1])) end
    end
    assert.is_true(reach > 0.1 and set.settles.x.hi >= reach)
  end)

  it("is left by none of 300 motions of random nonlinear systems", function()
    math.randomseed(19)
    local proved = 0
    for _ = 1, 30 do
      local a, b, c, d, e = random(-2, 1), random(-3, 3), random(-3, 3), random(-2, 1), random(-2, 2)
      local function rates(x, y, p, cos, sin)
        return a * x + b * sin(y) + p * x * y, c * x + d * y + e * y * y + p * (cos(x) - 1)
      end
      local p = ambit.between(-1, 1)
      local system = ambit.ode { states = { "x", "y" }, equations = function(s)
        local f, g = rates(s.x, s.y, p, ambit.cos, ambit.sin)
        return { x = f, y = g }
      end }
      local set = ambit.invariant { system, about = { x = 0, y = 0 }, within = { x = { -2, 2 } } }
      if set.status == "proved" then proved = proved + 1 end
      for _ = 1, set.status == "proved" and 10 or 0 do
        local angle, value, size = random(0, 2 * math.pi), random(-1, 1), 2
        while not set:contains { x = size * math.cos(angle), y = size * math.sin(angle) } do size = 0.9 * size end
        local x = { size * math.cos(angle), size * math.sin(angle) }
        for _ = 1, 40 do
          x = follow(function(z) return { rates(z[1], z[2], value, math.cos, math.sin) } end, x, 0.25, 25)
          assert.is_true(set.box.x:contains(x[1]) and set.box.y:contains(x[2]))
        end
      end
    end
    assert.is_true(proved >= 5 and proved < 30, tostring(proved))
  end)

  it("is never claimed where something escapes", function()
    local function status(rate, within)
      local system = ambit.ode { states = { "x" }, equations = function(s) return { x = rate(s.x) } end }
      return ambit.invariant { system, about = { x = 0 }, within = within }
    end
    assert.equal("undecided", status(function(x) return x * ambit.between("-1", "0.01") end).status)
    assert.equal("undecided", status(function(x) return ambit.between(-2, -1) * x + ambit.varying(-1, 1) end,
      { x = { "-0.9", "0.9" } }).status)
    local bistable = status(function(x) return x ^ 3 - x end, { x = { -3, 3 } }) -- leaves beyond 1
    assert.is_true(bistable.status == "undecided" or bistable.box.x.hi < 1 and bistable.box.x.lo > -1)
    assert.is_false(bistable.status == "proved" and bistable:contains { x = "1.0001" })
  end)

  it("is that of a mechanism's energy, and its motions stay in it", function()
    local m = arm "5%"
    local set = ambit.invariant { m, about = { a = "0.5", b = "0.7" },
      within = { a = { "0.35", "0.55" }, b = { "0.5", "0.85" } } }
    assert.equal("proved", set.status)
    assert.is_not_nil(set.set.by.decay.moving)
    assert.is_true(set:contains { a = "0.445", b = "0.679", ["a'"] = ambit.between("-0.05", "0.05"), ["b'"] = 0 })
    local run = ambit.sample { m:dynamics(), t = { 0, 1, 2 }, n = 50,
      initial = { a = "0.445", b = "0.679", ["a'"] = ambit.between("-0.05", "0.05"), ["b'"] = 0 } }
    for _, name in ipairs { "a", "b" } do
      assert.is_true(run.x[name].lo >= set.box[name].lo and run.x[name].hi <= set.box[name].hi)
      assert.is_true(set.settles[name].lo <= run:at(2)[name].lo + 1e-3)
    end
  end)

  -- a joint of inertia 1 with a law of torque
  local function turning(law)
    local m = ambit.mechanism {}
    local frame, joint = m:revolute { from = m.world, axis = "z", name = "q" }
    m:rigid_body { at = frame, mass = 1, inertia = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } }
    if law then m:joint_torque { joint = joint, torque = function(q, v) return law(q, v, m:coordinates()["q''"]) end } end
    return m, joint
  end

  it("takes no energy whose masses vary or depend on speeds", function()
    local u = ambit.varying(0, 2) -- 3 outwards and 1 inwards pumps the swing up: 110 rad after 5 s
    local pumped = turning(function(q, v, a) return -100 * q - v / 2 - u * a end)
    local set = ambit.invariant { pumped, about = { q = 0 }, within = { q = { -1, 1 } } }
    assert.is_false(set:contains { q = "0.5", ["q'"] = 0 })
    local by_speed = turning(function(q, v, a) return -1000 * q - v - "0.3" * (1 - ambit.cos(2 * ambit.pi * v)) * a end)
    set = ambit.invariant { by_speed, about = { q = 0 }, within = { ["q'"] = { "-1.005", "1.005" } }, budget = 3000 }
    assert.is_false(set:contains { q = 0, ["q'"] = "0.9999" }) -- from there q comes to .0351
  end)

  it("is that of the system it was asked about, not of what its mechanism became", function()
    local m, joint = turning()
    local free = m:dynamics()
    m:joint_torque { joint = joint, torque = function(q, v) return -100 * q - 5 * v end }
    local drifting = ambit.verify { free, initial = { q = 0, ["q'"] = "0.1" }, t = math.huge,
      safe = function(s) return s.q - 1 end }
    assert.not_equal("proved", drifting.status)
    assert.equal("proved", ambit.invariant { m, about = { q = 0 }, within = { q = { -1, 1 } } }.status)
  end)

  it("says what it lacks where data are wide or a formula has kinks", function()
    local wide = ambit.ode { states = { "x" }, parameters = { p = ambit.between(-9, 9) },
      equations = function(s, p) return { x = p.p - s.x - s.x ^ 3 } end }
    assert.equal("undecided", ambit.invariant { wide, about = { x = 0 }, within = { x = { -1, 1 } } }.status)
    local kinked = ambit.ode { states = { "x" }, equations = function(s) return { x = ambit.abs(s.x) } end }
    local set = ambit.invariant { kinked, about = { x = 0 }, within = { x = { -1, 1 } } }
    assert.equal("undecided", set.status)
    assert.is_true(#set.reason > 10)
  end)

  it("says what it was asked wrongly", function()
    local system = oscillator(1, 0)
    local function refuses(t, text) fails(function() ambit.invariant(t) end, text) end
    refuses({ system }, "about is missing")
    refuses({ system, about = { y = 1 } }, "unknown key `y`")
    refuses({ system, about = { v = 1 } }, "the state `x` has no value")
    refuses({ system, about = { x = 0 }, within = {} }, "within is empty")
    refuses({ system, about = { x = 0 }, within = { x = { 1, -1 } } }, "the range is empty")
    refuses({ system, about = { x = 0 }, budget = -1 }, "budget")
    local driven = ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = t - s.x } end }
    refuses({ driven, about = { x = 0 } }, "depends on time")
  end)
end)

describe("a condition for all times", function()
  local function verify(t, initial, safe)
    return ambit.verify { oscillator(1, ambit.varying("-0.05", "0.05")), initial = initial, t = t, safe = safe }
  end

  it("is proved by a run into a set that nothing leaves", function()
    local answer = verify(math.huge, { x = ambit.around("0.8", "0.01"), v = 0 }, function(s) return s.x - "0.82" end)
    assert.equal("proved", answer.status, answer.reason)
    assert.is_true(answer.followed > 0)
    local inside = verify(math.huge, { x = 0, v = 0 }, function(s) return s.x - "0.5" end)
    assert.equal("proved", inside.status)
    assert.is_nil(inside.followed)
  end)

  it("is not proved where it fails at last, and refuted where it fails before", function()
    local last = verify(math.huge, { x = "0", v = 0 }, function(s) return s.x - "0.05" end)
    assert.equal("undecided", last.status)
    local before = verify({ 0, math.huge }, { x = 1, v = 0 }, function(s) return "-0.05" - s.v end)
    assert.equal("refuted", before.status)
    assert.is_not_nil(before.conditions.safe.counterexample)
    -- without any set, too: rest at 0 repels
    local away = ambit.ode { states = { "x" }, equations = function(s) return { x = 2 * s.x - s.x ^ 3 } end }
    local leaves = { away, initial = { x = ambit.between("0.1", "0.2") }, t = math.huge, about = { x = 0 },
      safe = function(s) return s.x - "0.5" end }
    assert.equal("refuted", ambit.verify(leaves).status)
  end)

  it("says what it was asked wrongly before anything is computed", function()
    local asked = { oscillator(1, 0), initial = { x = 0, v = 0 }, t = math.huge, safe = function(s) return s.x - 1 end }
    for key, part in pairs { expct = "did you mean `expect`", expect = "expected one of proved, refuted, undecided",
      budget = "verify: budget: " } do
      local wrong = { [key] = "x" }
      for k, value in pairs(asked) do wrong[k] = value end
      fails(function() ambit.verify(wrong) end, part)
    end
  end)

  it("may be reached later than solutions are followed", function()
    local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local function reach(system, g)
      return ambit.verify { system, initial = { x = 1 }, t = math.huge, reach = g }
    end
    local soon = reach(decay, function(s) return s.x - "0.5" end)
    assert.is_true(soon.status == "undecided" or soon.status == "proved", soon.status)
    local grows = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x } end }
    assert.equal("undecided", reach(grows, function(s) return 1000 - s.x end).status)
    fails(function() reach(decay, function(s, _, t) return s.x - t end) end, "may not depend on time")
  end)

  it("has no last time", function()
    fails(function()
      ambit.verify { oscillator(1, 0), initial = { x = 0, v = 0 }, t = math.huge, at_end = function(s) return s.x end }
    end, "there is no last time")
  end)
end)
