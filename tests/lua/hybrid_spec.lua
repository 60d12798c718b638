-- Models that switch: closed forms of their members tell what the enclosures have to contain.
local ambit = require "ambit"
local pi = math.pi

local G = 9.81
local ball = ambit.ode {
  states = { y = "m", v = "m/s" }, equations = function(s) return { y = s.v, v = -ambit.number("9.81") + 0 * s.y } end,
}

local function bouncing(restitution, height, more)
  local t = {
    modes = { fly = { ball, guards = { { g = function(s) return s.y end, direction = "falling", to = "fly",
      name = "bounce", reset = function(s) return { v = -restitution * s.v } end } } } },
    initial = { y = height, v = 0 }, t = { 0, 2 }, tolerance = 1e-12,
  }
  for key, value in pairs(more or {}) do t[key] = value end
  return ambit.hybrid(t)
end

-- Times and speeds of the bounces of one ball; its height and speed at t.
local function bounces(e, h, n)
  local list, t, v = {}, math.sqrt(2 * h / G), math.sqrt(2 * G * h)
  for i = 1, n do
    list[i] = { t = t, v = v }
    v = e * v
    t = t + 2 * v / G
  end
  return list
end

local function ball_at(e, h, t)
  local from, speed = 0, nil
  for _, b in ipairs(bounces(e, h, 50)) do
    if b.t > t then break end
    from, speed = b.t, e * b.v
  end
  if not speed then return h - G * t * t / 2, -G * t end
  return speed * (t - from) - G * (t - from) ^ 2 / 2, speed - G * (t - from)
end

local function assert_inside(x, value)
  assert.is_true(x.lo <= value + 1e-12 and value - 1e-12 <= x.hi, ("%.17g is not in %s"):format(value, tostring(x)))
end

local function refused(part, t)
  local good, message = pcall(ambit.hybrid, t)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

describe("hybrid", function()
  it("may have guards with kinks", function() -- in a box of 2 m: |y - 1| = 1
    local run = ambit.hybrid { initial = { y = 1, v = 5 }, t = { 0, 0.9 }, modes = { fly = { ball, guards = { {
      g = function(s) return ambit.abs(s.y - 1) - 1 end, direction = "rising", to = "fly",
      reset = function(s) return { v = -s.v } end } } } } }
    assert.equal("complete", run.status, run.reason)
    local speed = math.sqrt(25 - 2 * G)
    local up, down = (5 - speed) / G, (math.sqrt(speed ^ 2 + 4 * G) - speed) / G
    assert.equal(2, #run.events)
    for i, t in ipairs { up, up + down } do
      assert.is_true(run.events[i].t.lo <= t + 1e-14 and t - 1e-14 <= run.events[i].t.hi)
    end
  end)

  it("follows a ball of uncertain restitution and height", function()
    local run = bouncing(ambit.around("0.8", "0.002"), ambit.around(1, "0.002"))
    assert.equal("complete", run.status)
    assert.equal(3, #run.events)
    assert.same({ "fly", "fly", "fly", "fly" }, run.modes)
    for i = 0, 4 do
      for k = 0, 4 do
        local e, h = 0.798 + 0.001 * i, 0.998 + 0.001 * k
        for n, b in ipairs(bounces(e, h, 3)) do
          assert_inside(run.events[n].t, b.t)
          assert_inside(run.events[n].x.v, -b.v)
          assert_inside(run.events[n].x.y, 0)
        end
        for t = 0.1, 2, 0.1 do
          local y, v = ball_at(e, h, t)
          local x = run:at(t)
          assert_inside(x.y, y)
          assert_inside(x.v, v)
        end
        local y = ball_at(e, h, 2)
        assert_inside(run.x.y, y)
      end
    end
    local outside = bounces(0.81, 1.01, 3)
    assert.is_false(run.events[3].t:contains(outside[3].t))
    assert.is_true(run.events[3].t:width() < 0.03 and run.events[3].certain)
  end)

  it("is sharp for point data, close to the accumulation of bounces", function()
    local run = bouncing(0.8, 1, { t = { 0, 4 } })
    assert.equal("complete", run.status)
    local exact = bounces(0.8, 1, #run.events)
    assert.is_true(#run.events > 15)
    for n, b in ipairs(exact) do
      assert_inside(run.events[n].t, b.t)
      assert.is_true(run.events[n].t:width() < 1e-9)
    end
  end)

  it("ends with a reason where infinitely many switches accumulate", function()
    local run = bouncing(0.8, 1, { t = { 0, 5 } })
    assert.equal("unable", run.status)
    assert.is_truthy(run.reason:find "switch `bounce` of mode `fly`")
    assert.is_true(run.t_reached > 4.06 and run.t_reached < 4.0640692)
    local few = bouncing(0.8, 1, { t = { 0, 4 }, switches_max = 3 })
    assert.equal("unable", few.status)
    assert.equal(3, #few.events)
    assert.is_truthy(few.reason:find "more than 3 switches")
  end)

  it("steps in the order of time, without gaps", function()
    local run, last, n = bouncing(ambit.around("0.8", "0.001"), 1), 0, 0
    for step in run:steps() do
      assert.equal(last, step.t_from)
      assert.is_true(step.t > last)
      assert.equal("fly", step.mode)
      assert.is_false(step.x.y:intersect(step.tube.y):is_empty())
      last, n = step.t, n + 1
    end
    assert.equal(2, last)
    assert.equal(n, run.step_count)
    assert.equal(2, run.t_reached)
  end)

  it("meets the instants that are asked for", function()
    local run, seen = bouncing(0.8, 1, { t = { 0, 0.46, 1, 2 } }), {}
    for step in run:steps() do seen[step.t] = step.x.y end
    for _, t in ipairs { 0.46, 1, 2 } do
      assert.is_truthy(seen[t])
      assert_inside(seen[t], (ball_at(0.8, 1, t)))
    end
  end)

  it("knows a thermostat of two modes", function()
    local off = ambit.ode { states = { T = "K" }, equations = function(s) return { T = -(s.T - 10) / 5 } end }
    local on = ambit.ode { states = { T = "K" }, equations = function(s) return { T = -(s.T - 30) / 5 } end }
    local run = ambit.hybrid {
      modes = {
        off = { off, guards = { { g = function(s) return s.T - 18 end, direction = "falling", to = "on" } } },
        on = { on, guards = { { g = function(s) return s.T - 22 end, direction = "rising", to = "off" } } },
      },
      mode = "off", initial = { T = ambit.between("19.4", "19.6") }, t = { 0, 10 }, tolerance = 1e-12,
    }
    assert.equal("complete", run.status)
    assert.same({ "off", "on", "off", "on", "off", "on" }, run.modes)
    for i = 0, 10 do
      local t = 5 * math.log((9.4 + 0.02 * i) / 8)
      for n, e in ipairs(run.events) do
        assert_inside(e.t, t)
        assert_inside(e.x.T, n % 2 == 1 and 18 or 22)
        t = t + 5 * math.log(12 / 8)
      end
    end
    assert.is_true(run.events[5].t:width() < 0.2)
  end)

  it("carries a wide set through many switches with a solver of high order in the data", function()
    local function mode(goal) return ambit.ode { states = { T = "K" },
      equations = function(s) return { T = -(s.T - goal) / 5 } end } end
    local run = ambit.hybrid {
      modes = {
        off = { mode(10), guards = { { g = function(s) return s.T - 18 end, direction = "falling", to = "on" } } },
        on = { mode(30), guards = { { g = function(s) return s.T - 22 end, direction = "rising", to = "off" } } },
      },
      mode = "off", initial = { T = ambit.between(19, 20) }, t = { 0, 20 }, solver = "taylor_model",
    }
    assert.equal("complete", run.status)
    assert.equal(10, #run.events)
    local first, last = 5 * math.log(9 / 8), 5 * math.log(10 / 8)
    for n, e in ipairs(run.events) do
      local later = (n - 1) * 5 * math.log(12 / 8)
      assert_inside(e.t, first + later)
      assert_inside(e.t, last + later)
      assert.is_true(e.t:width() < 1.01 * (last - first))
    end
  end)

  it("solves a system that is not smooth", function()
    -- x'' = -x - |x|/2: half periods of 1.5 and of 0.5
    local function mode(k) return ambit.ode { states = { "x", "v" },
      equations = function(s) return { x = s.v, v = -k * s.x } end } end
    local function x(s) return s.x end
    local run = ambit.hybrid {
      modes = { right = { mode(1.5), guards = { { g = x, to = "left" } } },
        left = { mode(0.5), guards = { { g = x, to = "right" } } } },
      mode = "right", initial = { x = ambit.around(1, "1%"), v = 0 }, t = { 0, 10 },
    }
    assert.equal("complete", run.status)
    local a, b = math.sqrt(1.5), math.sqrt(0.5)
    local times = { pi / 2 / a, pi / 2 / a + pi / b, 3 * pi / 2 / a + pi / b }
    assert.equal(#times, #run.events)
    for n, t in ipairs(times) do
      assert_inside(run.events[n].t, t)
      assert.is_true(run.events[n].t:width() < 1e-3)
    end
    for _, x0 in ipairs { 0.99, 1, 1.01 } do
      assert_inside(run.x.x, -x0 * a / b * math.sin(b * (10 - times[3])))
    end
  end)

  it("changes the states with the mode", function()
    local slide = ambit.ode { states = { x = "m", v = "m/s" }, parameters = { mu = ambit.around("0.3", "0.01") },
      equations = function(s, p) return { x = s.v, v = -p.mu * ambit.number("9.81") } end }
    local stick = ambit.ode { states = { x = "m" }, equations = function(s) return { x = 0 * s.x } end }
    local run = ambit.hybrid {
      modes = { slide = { slide, guards = { { g = function(s) return s.v end, direction = "falling", to = "stick" } } },
        stick = { stick } },
      mode = "slide", initial = { x = 0, v = ambit.around(2, "0.01") }, t = { 0, 2 },
    }
    assert.equal("complete", run.status)
    assert.same({ "slide", "stick" }, run.modes)
    for _, mu in ipairs { 0.29, 0.3, 0.31 } do
      for _, v in ipairs { 1.99, 2, 2.01 } do
        assert_inside(run.events[1].t, v / mu / G)
        assert_inside(run.x.x, v * v / (2 * mu * G))
      end
    end
    assert.is_nil(rawget(run.x, "v"))
  end)

  it("lets a pendulum hit an elastic wall", function()
    local function mode(k) return ambit.ode { states = { phi = "rad", w = "rad/s" },
      equations = function(s) return { phi = s.w, w = -ambit.number("9.81") * ambit.sin(s.phi) - k * s.phi } end } end
    local function phi(s) return s.phi end
    local run = ambit.hybrid {
      modes = { free = { mode(0), guards = { { g = phi, direction = "falling", to = "wall" } } },
        wall = { mode(400), guards = { { g = phi, direction = "rising", to = "free" } } } },
      mode = "free", initial = { phi = ambit.around(1, "0.001"), w = 0 }, t = { 0, "2.5" },
    }
    assert.equal("complete", run.status)
    assert.same({ "free", "wall", "free", "wall", "free" }, run.modes)
    for _, phi0 in ipairs { 0.999, 1, 1.001 } do
      local w, a, b = math.sqrt(2 * G * (1 - math.cos(phi0))), 1, math.cos(phi0 / 2)
      for _ = 1, 30 do a, b = (a + b) / 2, math.sqrt(a * b) end
      assert_inside(run.events[1].t, pi / 2 / a / math.sqrt(G))
      assert_inside(run.events[1].x.w, -w)
      assert_inside(run.events[2].x.w, w)          -- energy
      assert_inside(run.events[4].x.w, w)
      assert_inside(run.events[3].t - run.events[2].t, pi / a / math.sqrt(G))
    end
  end)

  it("is unable where a solution only grazes the guard", function()
    local function throw(v) return ambit.hybrid {
      modes = { fly = { ambit.ode { states = { "y", "v" }, equations = function(s) return { y = s.v, v = -10 } end },
        guards = { { g = function(s) return s.y - 5 end, direction = "rising", to = "fly", name = "ceiling",
          reset = function(s) return { v = -s.v } end } } } },
      initial = { y = 0, v = v }, t = { 0, 1.5 },
    } end
    local exactly = throw(10)
    assert.equal("unable", exactly.status)
    assert.is_truthy(exactly.reason:find "event `ceiling` in t = .*graze")
    assert.is_true(exactly.t_reached > 0.9 and exactly.t_reached <= 1)
    local perhaps = throw(ambit.between("9.9", "10.1"))
    assert.equal("unable", perhaps.status)
    assert.is_true(perhaps.t_reached <= 0.99)
    assert.equal(0, #throw(ambit.between("9.8", "9.9")).events)
    assert.equal(1, #throw(ambit.between("10.1", "10.2")).events)
  end)

  it("is unable where both modes point at the surface", function()
    local function mode(rate) return ambit.ode { states = { "x", "n" },
      equations = function(s) return { x = rate, n = 0 * s.x } end } end
    local function slide(first, second, reset)
      local function x(s) return s.x end
      return ambit.hybrid {
        modes = { down = { mode(-1), guards = { { g = x, direction = first, to = "up", reset = reset } } },
          up = { mode(1), guards = { { g = x, direction = second, to = "down", reset = reset } } } },
        mode = "down", initial = { x = ambit.around(1, "0.01"), n = 0 }, t = { 0, 3 },
      }
    end
    local function count(s) return { n = s.n + 1 } end
    local directions = { { "falling", "rising" }, { "both", "both" }, { "falling", "both" }, { "both", "rising" } }
    for _, d in ipairs(directions) do
      for _, reset in ipairs { {}, count, { x = 0 } } do
        local run = slide(d[1], d[2], reset)
        assert.equal("unable", run.status)
        assert.is_truthy(run.reason:find("guard `down` of mode `up` may be met", 1, true))
        assert.is_true(run.t_reached <= 1.01)
      end
    end
    assert.equal("complete", slide("falling", "falling").status) -- `up` is left downwards only
  end)

  it("is unable where a reset leaves its domain", function()
    for _, reset in ipairs {
      function(s) return { v = ambit.sqrt(s.v) } end,
      function(s) return { v = 1 / s.y } end,
      function(_, _, t) return { v = ambit.sqrt(t - math.sqrt(2 / G)) } end, -- of some solutions only
    } do
      local run = ambit.hybrid {
        modes = { fly = { ball, guards = { { g = function(s) return s.y end, direction = "falling", to = "fly",
          reset = reset } } } },
        initial = { y = ambit.around(1, "0.01"), v = 0 }, t = { 0, 2 },
      }
      assert.equal("unable", run.status)
      assert.is_truthy(run.reason:find("reset gives the state `v` no finite value", 1, true))
      assert.is_true(run.t_reached > 0.4)
    end
  end)

  it("may switch by the same guard again, once it has been left", function()
    local swing = ambit.ode { states = { "x", "v", "n" },
      equations = function(s) return { x = s.v, v = -s.x, n = 0 * s.x } end }
    for direction, n in pairs { rising = 3, both = 6 } do
      local run = ambit.hybrid {
        modes = { swing = { swing, guards = { { g = function(s) return s.x end, direction = direction, to = "swing",
          reset = function(s) return { n = s.n + 1 } end } } } },
        initial = { x = ambit.around(1, "0.01"), v = 0, n = 0 }, t = { 0, 20 },
      }
      assert.equal("complete", run.status)
      assert_inside(run.x.n, n)
    end
  end)

  it("chooses a solver that crosses kinks, where the first mode has some", function()
    local bilinear = ambit.ode { states = { "x", "v" },
      equations = function(s) return { x = s.v, v = -s.x - ambit.max(s.x, 0) } end }
    local run = ambit.hybrid {
      modes = { go = { bilinear, guards = { { g = function(s) return s.x + "0.3" end, to = "go", name = "stop",
        direction = "falling", reset = function(s) return { x = s.x, v = -s.v / 2 } end } } } },
      initial = { x = ambit.around(1, "1%"), v = 0 }, t = { 0, 2 },
    }
    assert.equal("complete", run.status)
    for _, x in ipairs { 0.99, 1, 1.01 } do
      local speed = math.sqrt(2 * x ^ 2 - 0.09) / 2 -- behind the stop
      local most = math.sqrt(speed ^ 2 + 0.09)      -- of the speed, at x = 0
      local t = math.pi / 2 / math.sqrt(2) + math.asin(0.3 / (math.sqrt(2) * x)) + math.asin(0.3 / most)
      local exact = most / math.sqrt(2) * math.sin(math.sqrt(2) * (2 - t))
      assert.is_true(run.x.x.lo <= exact and exact <= run.x.x.hi and run.x.x:width() < 0.1, tostring(run.x.x))
    end
  end)

  it("is unable where the data decide which guard comes first", function()
    local run = ambit.hybrid {
      modes = { go = { ambit.ode { states = { "x", "y" }, equations = { x = 1, y = 1 } },
        guards = { { g = function(s) return s.x - 1 end, to = "go", name = "a", reset = { x = 0 } },
          { g = function(s) return s.y - 1 end, to = "go", name = "b", reset = { y = 0 } } } } },
      initial = { x = ambit.between(0, "0.2"), y = "0.1" }, t = { 0, 2 },
    }
    assert.equal("unable", run.status)
    assert.is_truthy(run.reason:find "which comes first")
    assert.is_truthy(run.reason:find "`a`" and run.reason:find "`b`")
  end)

  it("refuses what it cannot use", function()
    local function with(t)
      t.initial, t.t = t.initial or { y = 1, v = 0 }, t.t or { 0, 1 }
      return t
    end
    local function y(s) return s.y end
    refused("hybrid: modes are missing", with {})
    refused("hybrid: modes: expected at least one", with { modes = {} })
    refused("hybrid: mode is missing: the one to start in (a, b)", with { modes = { a = { ball }, b = { ball } } })
    refused("there is no mode `c`", with { modes = { a = { ball } }, mode = "c" })
    refused("modes.a.guards[1].to: there is no mode `b`",
      with { modes = { a = { ball, guards = { { g = y, to = "b" } } } } })
    refused("unknown key `guard`; did you mean `guards`", with { modes = { a = { ball, guard = {} } } })
    refused("modes.a: expected m:dynamics() or an ambit.ode", with { modes = { a = { 1 } } })
    refused("unknown key `q`", with { modes = { a = { ball, guards = { { g = y, to = "a", reset = { q = 1 } } } } } })
    refused("t must ascend", with { modes = { a = { ball } }, t = { 1, 0 } })
    local other = ambit.ode { states = { "q" }, equations = function(s) return { q = s.q } end }
    refused("the state `q` of mode `b` gets no value",
      with { modes = { a = { ball, guards = { { g = y, to = "b" } } }, b = { other } }, mode = "a" })
  end)
end)
