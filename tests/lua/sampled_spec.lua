-- Controllers that look at their plant at the instants of a clock: ambit.sampled.
local ambit = require "ambit"

local function complete(t)
  local run = ambit.simulate(t)
  assert.equal("complete", run.status, run.reason)
  return run
end

-- x' = f(x, u) from x over `span` by Runge's method, in doubles.
local function advance(f, x, u, span, parts)
  local h, n = span / parts, #x
  local function plus(k, by)
    local y = {}
    for i = 1, n do y[i] = x[i] + by * k[i] end
    return y
  end
  for _ = 1, parts do
    local a = f(x, u)
    local b = f(plus(a, h / 2), u)
    local c = f(plus(b, h / 2), u)
    local d = f(plus(c, h), u)
    local y = {}
    for i = 1, n do y[i] = x[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
    x = y
  end
  return x
end

local function contains(enclosure, value, slack)
  return enclosure.lo - slack <= value and value <= enclosure.hi + slack
end

describe("a sampled controller", function()
  it("holds what it finds until the next sample", function()
    local hold = ambit.sampled { period = 0.125, outputs = { "u" }, law = function(s) return -s.x end }
    local plant = ambit.ode { states = { "x" }, sampled = hold, equations = function(s) return { x = s.u } end }
    local run = complete { plant, initial = { x = 1 }, t = { 0, 0.0625, 1 } }
    assert.equal("zonotope", run.solver)
    assert.is_true(run.x.x:contains(0.875 ^ 8) and run.x.x:width() < 1e-14)
    assert.is_true(run:at(0.0625).x:contains(1 - 0.0625))
    assert.is_true(run.x.u:contains(-0.875 ^ 7)) -- of the last sample, at 0.875
  end)

  it("keeps what the set has in common over many samples", function()
    local hold = ambit.sampled { period = "0.01", outputs = { "u" }, law = function(s) return -20 * s.x - 6 * s.v end }
    local plant = ambit.ode { states = { "x", "v" }, sampled = hold,
      equations = function(s) return { x = s.v, v = s.u } end }
    local run = complete { plant, initial = { x = ambit.around(1, "1%"), v = ambit.around(0, "0.01") }, t = { 0, 10 } }
    assert.is_true(run.x.x:width() < 1e-9, tostring(run.x.x))
    assert.equal(1000, run.step_count)
  end)

  it("has memory, delay, a clock that starts later, and time", function()
    local one = ambit.sampled { period = 0.25, start = 0.125, outputs = { "u" }, memory = { n = 0, last = 7 }, delay = 2,
      law = function(s, m, t) return { u = m.n + t }, { n = m.n + 1, last = s.x } end }
    local plant = ambit.ode { states = { "x" }, sampled = one, equations = function(s) return { x = s.u } end }
    local run = complete { plant, initial = { x = 0 }, t = { 0, 0.625, 1 } }
    -- samples at 0.125, 0.375, 0.625, 0.875: n + t = 0.125, 1.375, 2.625, 3.875, the first acts from 0.625 on
    local x = 0.25 * 0.125 + 0.125 * 1.375
    assert.is_true(run.x.x:contains(x) and run.x.x:width() < 1e-14, tostring(run.x.x))
    assert.is_true(run.x.n:contains(4) and run.x.last:contains(0.25 * 0.125))
    assert.is_true(run:at(0.625).x:contains(0))
    assert.is_true(complete { plant, initial = { x = 0, u = 2 }, t = { 0, 0.625 } }.x.x:contains(1.25))
  end)

  it("may be one of several, each with its clock", function()
    local fast = ambit.sampled { "fast", period = 0.125, outputs = { "a" }, law = function(s) return -s.x end }
    local slow = ambit.sampled { "slow", period = 0.25, outputs = { "b" }, law = function(s) return s.a end }
    local plant = ambit.ode { states = { "x" }, sampled = { fast, slow },
      equations = function(s) return { x = s.a + s.b } end }
    local x, a, b = 1, 0, 0
    for k = 0, 7 do
      a = -x
      if k % 2 == 0 then b = a end -- they were added in this order
      x = x + 0.125 * (a + b)
    end
    local run = complete { plant, initial = { x = 1 }, t = { 0, 1 } }
    assert.is_true(run.x.x:contains(x) and run.x.x:width() < 1e-13)
  end)

  it("takes the decimals of its clock, and those of the horizon", function()
    local hold = ambit.sampled { period = "0.1", outputs = { "u" }, law = function(_, _, t) return t end }
    local plant = ambit.ode { states = { "x" }, sampled = hold, equations = function(s, _, t) return { x = s.u + t } end }
    local run = complete { plant, initial = { x = 0 }, t = { 0, "0.3", 1, "4.2" } }
    assert.is_true(run:at("0.3").x:contains(0.03 + 0.045))
    assert.is_true(run.x.x:contains(0.1 * 0.1 * 41 * 42 / 2 + 4.2 * 4.2 / 2) and run.x.x:width() < 1e-11)
  end)

  it("looks at the instant that was said, not at the double next to it", function()
    local on = ambit.sampled { "on", period = 1024, outputs = { "u" }, memory = { n = 0 },
      law = function(_, m) return { u = m.n }, { n = 1 } end }
    local look = ambit.sampled { "look", period = 4096, start = "1024.1", outputs = { "w" },
      law = function(s) return s.x end }
    local plant = ambit.ode { states = { "x" }, sampled = { on, look },
      equations = function(s) return { x = s.u } end }
    local seen = complete { plant, initial = { x = 0 }, t = { 0, 1025 } }.x.w
    assert.is_true(math.abs(0.1 - (1024.1 - 1024)) > 9e-14) -- by so much x would be off at the double
    assert.is_true(seen:contains "0.1" and seen:width() < 1e-11, tostring(seen))
  end)

  it("has not leapt yet at the instant of a sample, listed or not", function()
    for _, period in ipairs { { 1, 10 }, { 3, 10 }, { 1, 3 }, { 7, 100 } } do
      local function at(k) return ("%d/%d"):format(k * period[1], period[2]) end
      local count = ambit.sampled { period = at(1), outputs = { "u" }, memory = { n = 0 },
        law = function(_, m) return m.n + 1, { n = m.n + 1 } end }
      local plant = ambit.ode { states = { "x" }, sampled = count, equations = function(s) return { x = s.u } end }
      local function holds(states, k)
        local x = period[1] / period[2] * k * (k + 1) / 2
        assert.is_true(states.u:contains(k) and states.u:width() < 1e-9, ("u at %s: %s"):format(at(k), tostring(states.u)))
        assert.is_true(contains(states.x, x, 1e-14 * x) and states.x:width() < 1e-9, tostring(states.x))
      end
      local all = { 0 }
      for k = 1, 30 do all[2 * k], all[2 * k + 1] = at(k), (k + 0.5) * period[1] / period[2] end
      local last = period[1] / period[2] * 31
      for _, t in ipairs { { 0, last }, { 0, at(4), at(30), last }, all } do
        local run = complete { plant, initial = { x = 0 }, t = t, dense = true }
        for k = 1, 30 do holds(run:at(at(k)), k) end
        local both = run:at(ambit.interval(last / 31 * 7.5, last / 31 * 9.5)).u
        assert.is_true(both.lo <= 8 and both.hi >= 10)
      end
      for _, k in ipairs { 1, 3, 6, 7 } do
        holds(complete { plant, initial = { x = 0 }, t = { 0, at(k) } }.x, k)
        local function verdict(limit)
          local g = function(s) return s.u - limit end
          return ambit.verify { plant, initial = { x = 0, u = 1 }, t = at(k), safe = g, at_end = g }.status
        end
        assert.equal("proved", verdict(k + 0.5))
        assert.equal("refuted", verdict(k - 0.5))
      end
    end
  end)

  it("acts through torques of mechanisms", function()
    local arm = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
    local frame, joint = arm:revolute { from = arm.world, axis = "z", name = "q" }
    local tip = arm:rigid_link { from = frame, offset = { 1, 0, 0 } }
    arm:point_mass { at = tip, mass = ambit.around(1, "2%") }
    local pid = ambit.sampled { period = "10 ms", outputs = { torque = "N m" }, memory = { sum = 0 },
      law = function(s, m)
        local off = "0.5" - s.q
        return { torque = 40 * off - 8 * s["q'"] + m.sum }, { sum = m.sum + "0.4" * off }
      end }
    arm:joint_torque { joint = joint, torque = arm:sampled(pid).torque }
    local initial, t = { q = 0, ["q'"] = 0 }, { 0, 2 }
    local run = complete { arm:dynamics(), initial = initial, t = t }
    local inner = ambit.sample { arm:dynamics(), initial = initial, t = t, n = 30 }
    assert.is_true(run.x.q.lo <= inner.x.q.lo and inner.x.q.hi <= run.x.q.hi)
    assert.is_true(run.x.q:width() < 1.01 * (inner.x.q.hi - inner.x.q.lo))
    local one = ambit.sample { arm:dynamics(), initial = initial, t = t, n = 5, solver = "gsl" }
    assert.is_true(inner.x.q.lo <= one.x.q.lo + 1e-7 and one.x.q.hi <= inner.x.q.hi + 1e-7)
    for _, mass in ipairs { 0.98, 1, 1.02 } do
      local x, sum = { 0, 0 }, 0
      for _ = 1, 200 do
        local off = 0.5 - x[1]
        local torque = 40 * off - 8 * x[2] + sum
        sum = sum + 0.4 * off
        x = advance(function(y) return { y[2], torque / mass - 9.81 * math.cos(y[1]) } end, x, 0, 0.01, 4)
      end
      assert.is_true(contains(run.x.q, x[1], 1e-8))
    end
  end)

  it("is verified, and its events are found", function()
    local hold = ambit.sampled { period = 0.125, outputs = { "u" }, law = function(s) return -s.x end }
    local plant = ambit.ode { states = { "x" }, sampled = hold, equations = function(s) return { x = s.u } end }
    local initial = { x = ambit.around(1, "0.01"), u = -1 }
    local run = complete { plant, initial = initial, t = 1,
      events = { { name = "half", g = function(s) return s.x - 0.5 end } } }
    assert.is_true(run.events[1].certain and run.events[1].t.lo > 0.6 and run.events[1].t.hi < 0.7)
    assert.equal("proved", ambit.verify { plant, initial = initial, t = 1,
      safe = function(s) return s.x - "1.02" end }.status)
    assert.equal("refuted", ambit.verify { plant, initial = initial, t = 1,
      safe = function(s) return "0.4" - s.x end }.status)
    assert.equal("proved", ambit.verify { plant, initial = initial, t = 1,
      safe = function(s) return s.u - "-0.3" end, at_end = function(s) return s.u - "-0.35" end }.status)
    -- what is held after a sample, and time, which goes on: u is k + 1 from t = k on
    local count = ambit.sampled { period = 1, outputs = { "u" }, memory = { n = 0 },
      law = function(_, m) return m.n + 1, { n = m.n + 1 } end }
    local counted = ambit.ode { states = { "x" }, sampled = count, equations = function() return { x = 0 } end }
    local function verdict(start, limit)
      return ambit.verify { counted, initial = { x = 0, u = start }, t = 4,
        safe = function(s, _, t) return s.u - t - limit end }.status
    end
    assert.equal("refuted", verdict(0, 0.5))
    assert.equal("refuted", verdict(0, 0.9))
    assert.equal("proved", verdict(0, 1.1))
    assert.equal("refuted", verdict(2, 1.1)) -- before the first sample
    local function reaches(limit)
      return ambit.verify { counted, initial = { x = 0 }, t = 4,
        reach = function(s, _, t) return t - s.u + limit end }.status
    end
    assert.equal("proved", reaches(0.9))
    assert.equal("refuted", reaches(1.1))
    assert.has_error(function()
      ambit.simulate { plant, initial = initial, t = 1, events = { { g = function(s) return s.u end } } }
    end, "simulate: events[1].g: an event is a zero of what moves steadily, but g depends on `u`, which jumps at samples")
  end)
end)

-- -- random plants and controllers against trajectories in doubles, whose sensors round as sensors do

local function random_loop(random)
  local function between(lo, hi) return lo + (hi - lo) * random() end
  local c = { k = between(0.5, 4), d = between(0.1, 1), p = between(1, 8), v = between(0.5, 3), i = between(0, 0.3),
    limit = between(0.5, 4), delay = math.floor(between(0, 3)), step = between(0.001, 0.02), period = between(0.01, 0.08),
    x0 = between(-1, 1), v0 = between(-1, 1), wide = between(0.001, 0.05), stiff = between(0.001, 0.05) }
  c.quantum = random() < 0.5
  return c
end

local function system_of(c)
  local number = ambit.number
  local controller = ambit.sampled { period = c.period, outputs = { "u" }, memory = { sum = 0 }, delay = c.delay,
    quantum = c.quantum and { x = c.step } or nil,
    law = function(s, m)
      local u = -number(c.p) * s.x - number(c.v) * s.v - m.sum
      return { u = ambit.max(-c.limit, ambit.min(c.limit, u)) }, { sum = m.sum + number(c.i) * s.x }
    end }
  return ambit.ode { states = { "x", "v" }, sampled = controller, parameters = { k = ambit.around(c.k, c.stiff * c.k) },
    equations = function(s, p) return { x = s.v, v = -p.k * ambit.sin(s.x) - number(c.d) * s.v + s.u } end }
end

-- The states at the instants, for one choice of the data; share: where in the sensor's steps it rounds, in [0, 1).
local function follow(c, choice, share, samples)
  local x, sum, u, line, seen = { c.x0 + c.wide * choice[1], c.v0 + c.wide * choice[2] }, 0, 0, {}, {}
  local k = c.k * (1 + c.stiff * choice[3])
  for i = 1, c.delay do line[i] = 0 end
  for n = 1, samples do
    local at = x[1]
    if c.quantum then at = (math.floor(x[1] / c.step + share) + 0.5 - share) * c.step end
    local wanted = math.max(-c.limit, math.min(c.limit, -c.p * at - c.v * x[2] - sum))
    sum = sum + c.i * at
    line[#line + 1] = wanted
    u = table.remove(line, 1)
    x = advance(function(y) return { y[2], -k * math.sin(y[1]) - c.d * y[2] + u } end, x, u, c.period, 8)
    seen[n] = { x[1], x[2], u, sum }
  end
  return seen
end

describe("random sampled loops", function()
  it("hold every trajectory", function()
    math.randomseed(7)
    local checks, plain, loosest = 0, 0, 0
    for _ = 1, 25 do
      local c, samples = random_loop(math.random), 40
      local t = { 0 }
      for n = 1, samples do t[n + 1] = n * ambit.number(c.period) end -- exactly
      local run = complete { system_of(c), t = t,
        initial = { x = ambit.around(c.x0, c.wide), v = ambit.around(c.v0, c.wide) } }
      local least, most = math.huge, -math.huge
      for draw = 1, 12 do
        local choice = {}
        for j = 1, 3 do choice[j] = draw <= 8 and ((draw - 1) >> (j - 1) & 1) * 2 - 1 or 2 * math.random() - 1 end
        for n, x in ipairs(follow(c, choice, math.random(), samples)) do
          local at = run:at(t[n + 1])
          local slack = 1e-7 -- of the oracle
          assert.is_true(contains(at.x, x[1], slack) and contains(at.v, x[2], slack) and contains(at.u, x[3], slack)
            and contains(at.sum, x[4], slack), ("t = %s: x %s %s, u %s %s"):format(tostring(t[n + 1]), tostring(at.x), x[1],
              tostring(at.u), x[3]))
          checks = checks + 4
          if n == samples then least, most = math.min(least, x[1]), math.max(most, x[1]) end
        end
      end
      -- in `follow` every sensor rounds in one way, so where they round the true set is wider
      if not c.quantum then
        loosest, plain = math.max(loosest, run.x.x:width() / (most - least)), plain + 1
      end
    end
    assert.equal(25 * 12 * 40 * 4, checks)
    assert.is_true(plain > 5 and loosest < 8, tostring(loosest))
  end)
end)

describe("bad input of a sampled controller", function()
  local function law() return 0 end
  local function refuses(message, f) assert.has_error(f, message) end

  it("is refused with its name", function()
    refuses("sampled: law: expected a function(s, m, t) that returns the outputs and the new memory, got nil",
      function() ambit.sampled { period = 1, outputs = { "u" } } end)
    refuses('sampled: period is missing: a time, such as "1 ms"', function()
      ambit.sampled { outputs = { "u" }, law = law }
    end)
    refuses("sampled: period: expected more than 0 s, got 0", function()
      ambit.sampled { period = 0, outputs = { "u" }, law = law }
    end)
    refuses("sampled: delay: expected a number of samples, 0 to 100, got -1", function()
      ambit.sampled { period = 1, outputs = { "u" }, law = law, delay = -1 }
    end)
    refuses("sampled: outputs: expected at least one name", function()
      ambit.sampled { period = 1, outputs = {}, law = law }
    end)
    local hold = ambit.sampled { period = 1, outputs = { "u" }, memory = { n = 0 }, law = law }
    refuses("sampled `sampled`: law: the function returned no memory: a second table with n", function()
      ambit.ode { states = { "x" }, sampled = hold, equations = function(s) return { x = s.u } end }
    end)
    refuses("ode: sampled: there are two states `u`", function()
      ambit.ode { states = { "u" }, sampled = hold, equations = function(s) return { u = s.u } end }
    end)
  end)

  it("is refused by verbs and solvers that cannot follow it", function()
    local hold = ambit.sampled { period = 1, outputs = { "u" }, law = law }
    local plant = ambit.ode { states = { "x" }, sampled = hold, equations = function(s) return { x = s.u } end }
    assert.equal("unable.sampled", ambit.simulate { plant, initial = { x = 0 }, t = 1, solver = "lohner" }.code)
    for _, call in ipairs {
      function() ambit.sensitivity { plant, initial = { x = 0 }, t = 1, wrt = { "x" } } end,
      function() ambit.poincare { plant, initial = { x = 0 }, t_max = 1, section = function(s) return s.x end } end,
      function() ambit.equilibria { plant, box = { x = { -1, 1 } } } end,
      function() ambit.join { plant, plant } end,
      function() ambit.reduce { plant, initial = { x = 0 }, t = { 0, 1 }, outputs = { "x" }, error = { x = 1 } } end,
      function() plant:modelica() end,
    } do
      local good, message = pcall(call)
      assert.is_true(not good and tostring(message):find("is sampled", 1, true) ~= nil, tostring(message))
    end
    refuses("simulate: t: the start of a sampled system: expected a number that is a double, got 0.1", function()
      ambit.simulate { plant, initial = { x = 0 }, t = { "0.1", 1 } }
    end)
    local back = pcall(ambit.simulate, { plant, initial = { x = 0 }, t = { 1, 0 } })
    assert.is_false(back)
  end)
end)
