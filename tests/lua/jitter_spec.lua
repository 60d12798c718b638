-- Controllers whose clocks jitter, held against motions that another program integrates with instants of its own.
local ambit = require "ambit"

local TRIES = tonumber(os.getenv "AMBIT_TRIES" or 24)

-- x' = f(x, u, t) from x at t over `span`, by Runge and Kutta's method, in doubles.
local function advance(f, x, u, t, span)
  local parts = math.max(1, math.ceil(span / 0.004))
  local h = span / parts
  local function plus(k, by)
    local y = {}
    for i = 1, #x do y[i] = x[i] + by * k[i] end
    return y
  end
  for _ = 1, parts do
    local a = f(x, u, t)
    local b = f(plus(a, h / 2), u, t + h / 2)
    local c = f(plus(b, h / 2), u, t + h / 2)
    local d = f(plus(c, h), u, t + h)
    local y = {}
    for i = 1, #x do y[i] = x[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
    x, t = y, t + h
  end
  return x
end

-- How late the sample k is, in parts of the jitter: constants, alternating, in blocks, random signs, random.
local function lateness(n)
  if n == 1 then return function() return 1 end end
  if n == 2 then return function() return -1 end end
  if n == 3 then return function(k) return k % 2 == 0 and 1 or -1 end end
  if n == 4 then return function(k) return k % 10 < 5 and 1 or -1 end end
  if n % 3 == 0 then return function() return 2 * math.random() - 1 end end
  return function() return math.random() < 0.5 and -1 or 1 end
end

-- { { x, u, memory }, ... } at the times; case: f, law(x, memory, t, k) -> u, memory; period, jitter, start, x, u,
-- memory
local function follow(case, late, times)
  local x, u, memory, t, found, k = case.x, case.u, case.memory, 0, {}, 0
  local sample
  local function instant() return math.max(0, (case.start or 0) + k * case.period + case.jitter * late(k)) end
  sample = instant()
  for i, stop in ipairs(times) do
    while sample < stop do
      x, t = advance(case.f, x, u, t, sample - t), sample
      u, memory = case.law(x, memory, t, k)
      k = k + 1
      sample = instant()
    end
    x, t = advance(case.f, x, u, t, stop - t), stop
    found[i] = { x = x, u = u, memory = memory }
  end
  return found
end

local function holds(enclosure, value, slack, what)
  assert.is_true(enclosure.lo - slack <= value and value <= enclosure.hi + slack,
    ("%s: %.17g is not in %s"):format(what, value, enclosure:text(17)))
end

-- Every motion of the case is in the run, at all times; changes: what further motions start from.
local function check(run, case, times, names, again)
  local at = {}
  for i, t in ipairs(times) do at[i] = run:at(t) end
  for n = 1, TRIES do
    local own = again and again(n) or case
    for i, found in ipairs(follow(own, lateness(n), times)) do
      local what = ("motion %d at %g"):format(n, times[i])
      for k, name in ipairs(names) do holds(at[i][name], found.x[k], 1e-9, name .. " of " .. what) end
      holds(at[i].u, found.u, 1e-9, "u of " .. what)
      if found.memory then holds(at[i].sum, found.memory, 1e-9, "sum of " .. what) end
    end
  end
end

local function complete(t)
  local run = ambit.simulate(t)
  assert.equal("complete", run.status, run.reason)
  return run
end

-- Inside of windows, at their edges, between them.
local function times_of(last, period, jitter)
  local list = {}
  for k = 1, 200 do
    local off = ({ 0, -0.999 * jitter, 1.001 * jitter, 0.3 * period, jitter / 3 })[k % 5 + 1]
    local t = k * period + off
    if k % 7 == 1 and t < last then list[#list + 1] = t end
  end
  list[#list + 1] = last
  return list
end

local function pendulum_of(control)
  return (ambit.ode { states = { "x", "v" }, sampled = control,
    equations = function(s) return { x = s.v, v = ambit.sin(s.x) + s.u } end })
end

local function falls(x, u) return { x[2], math.sin(x[1]) + u } end

describe("a clock that jitters", function()
  it("holds every motion, whenever its samples are", function()
    for _, jitter in ipairs { 0.0001, 0.001, 0.004 } do
      local control = ambit.sampled { period = 0.01, jitter = jitter, outputs = { "u" },
        law = function(s) return -8 * s.x - 3 * s.v end }
      local run = complete { pendulum_of(control), initial = { x = ambit.around(1, "1%"), v = 0 }, t = { 0, 1 },
        dense = true }
      check(run, nil, times_of(1, 0.01, jitter), { "x", "v" }, function(n)
        return { f = falls, period = 0.01, jitter = jitter, x = { 1 + 0.01 * (n % 3 - 1), 0 }, u = 0,
          law = function(x) return -8 * x[1] - 3 * x[2] end }
      end)
      assert.is_true(jitter > 0.0001 or run.x.x:width() < 0.0007, tostring(run.x.x))
    end
  end)

  it("takes memory, delays, a later start, readings in steps, laws with kinks and of time", function()
    for _, kinked in ipairs { false, true } do
      for _, start in ipairs { 0, 0.0125, 0.0004 } do
        local control = ambit.sampled { period = 0.02, jitter = 0.001, start = start, outputs = { "u" }, delay = 1,
          memory = { sum = 0.5 }, quantum = { x = 0.002 }, law = function(s, m, t)
            local u = -8 * s.x - 3 * s.v + m.sum + 0.25 * t
            if kinked then u = ambit.max(-2, ambit.min(2, u)) end
            return u, { sum = m.sum - 0.1 * s.x }
          end }
        local run = complete { pendulum_of(control), initial = { x = 0.4, v = 0, u = -1 }, t = { 0, 0.5 },
          dense = true }
        check(run, nil, times_of(0.5, 0.02, 0.001), { "x", "v" }, function(n)
          local waiting, off = -1, n % 2 == 0 and 0.001 or -0.001
          return { f = falls, period = 0.02, jitter = 0.001, start = start, x = { 0.4, 0 }, u = -1, memory = 0.5,
            law = function(x, sum, t, k)
              local read = x[1] + (k % 3 == 0 and off or -off)
              local u, acts = -8 * read - 3 * x[2] + sum + 0.25 * t, waiting
              waiting = kinked and math.max(-2, math.min(2, u)) or u
              return acts, sum - 0.1 * read
            end }
        end)
      end
    end
  end)

  it("acts through torques of mechanisms", function()
    local arm = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
    local frame, joint = arm:revolute { from = arm.world, axis = "z", name = "q" }
    arm:point_mass { at = arm:rigid_link { from = frame, offset = { 1, 0, 0 } }, mass = ambit.around(1, "2%") }
    local pid = ambit.sampled { period = "10 ms", jitter = "0.5 ms", outputs = { u = "N m" }, memory = { sum = 0 },
      law = function(s, m)
        local off = 0.5 - s.q
        return { u = 40 * off - 8 * s["q'"] + m.sum }, { sum = m.sum + 0.25 * off }
      end }
    arm:joint_torque { joint = joint, torque = arm:sampled(pid).u }
    local start = { q = 0, ["q'"] = 0 }
    local run = complete { arm:dynamics(), initial = start, t = { 0, 1 }, dense = true }
    check(run, nil, times_of(1, 0.01, 0.0005), { "q", "q'" }, function(n)
      local mass = 1 + 0.02 * (n % 3 - 1)
      return { f = function(x, u) return { x[2], u / mass - 9.81 * math.cos(x[1]) } end, period = 0.01, jitter = 0.0005,
        x = { 0, 0 }, u = 0, memory = 0, law = function(x, sum)
          return 40 * (0.5 - x[1]) - 8 * x[2] + sum, sum + 0.25 * (0.5 - x[1])
        end }
    end)
    local inner = ambit.sample { arm:dynamics(), initial = start, t = { 0, 0.5, 1 }, n = 50 }
    assert.is_true(run.x.q.lo <= inner.x.q.lo and inner.x.q.hi <= run.x.q.hi)
    assert.is_true(run.x.q:width() < 1.3 * (inner.x.q.hi - inner.x.q.lo), tostring(run.x.q))
    assert.is_nil(run:overestimation(inner).contradiction)
    assert.is_true(run.overestimate < 2.5)
    local function verdict(limit)
      return ambit.verify { arm:dynamics(), initial = start, t = 1, safe = function(s) return s.q - limit end }.status
    end
    assert.equal("proved", verdict(0.6))
    assert.equal("refuted", verdict(0.1))
  end)

  it("has what is held change at any time of a window, in conditions, too", function()
    local one = ambit.sampled { period = 1, jitter = 0.25, start = 0.5, outputs = { "u" }, memory = { n = 0 },
      law = function(_, m) return m.n + 1, { n = m.n + 1 } end }
    local plant = ambit.ode { states = { "x" }, sampled = one, equations = function(s) return { x = s.u } end }
    local run = complete { plant, initial = { x = 0 }, t = { 0, 0.2, 0.5, 1, 1.5, 2 } }
    assert.is_true(run:at(0.2).u:contains(0) and run:at(0.2).u:width() < 1e-200)
    assert.is_true(run:at(0.5).u:contains(0) and run:at(0.5).u:contains(1))
    assert.is_true(run:at(1).u:contains(1) and run:at(1).u:width() < 1e-12)
    assert.is_true(run:at(1).x:contains(0.25) and run:at(1).x:contains(0.75))
    assert.is_true(run:at(1).x.lo > 0.2499 and run:at(1).x.hi < 0.7501)
    local function safe(limit)
      return ambit.verify { plant, initial = { x = 0 }, t = 1.3, safe = function(s) return s.u - limit end }.status
    end
    assert.equal("proved", safe(2.001))
    assert.equal("undecided", safe(1.5))
    assert.equal("refuted", safe(0.5))
  end)

  it("reads the time when the sample is", function()
    for _, law in ipairs { function(_, _, t) return 50 * t end, function(_, _, t) return ambit.max(0, 50 * t) end } do
      local control = ambit.sampled { period = 0.25, jitter = 0.0625, start = 0.125, outputs = { "u" }, law = law }
      local plant = ambit.ode { states = { "x" }, sampled = control, equations = function(s) return { x = s.u } end }
      local run = complete { plant, initial = { x = 0 }, t = { 0, 0.5, 1 } }
      for _, t in ipairs { 0.5, 1 } do
        local u = run:at(t).u -- of the sample at t - 0.125
        assert.is_true(u.lo <= 50 * (t - 0.1875) and u.hi >= 50 * (t - 0.0625))
        assert.is_true(u:width() < 50 * 0.125 + 1e-6, tostring(u:width()))
      end
      assert.is_true(run:at(0.5).x.hi >= (0.4375 - 0.1875) * 50 * 0.1875)
    end
  end)

  it("may be one of several", function()
    local a = ambit.sampled { "a", period = 0.02, jitter = 0.001, outputs = { "u" },
      law = function(s) return -8 * s.x - 3 * s.v end }
    local b = ambit.sampled { "b", period = 0.05, outputs = { "w" }, law = function(s) return s.u end }
    local plant = ambit.ode { states = { "x", "v" }, sampled = { a, b },
      equations = function(s) return { x = s.v, v = ambit.sin(s.x) + s.u } end }
    local run = complete { plant, initial = { x = 0.5, v = 0 }, t = { 0, 0.51 }, dense = true }
    check(run, { f = falls, period = 0.02, jitter = 0.001, x = { 0.5, 0 }, u = 0,
      law = function(x) return -8 * x[1] - 3 * x[2] end }, { 0.11, 0.25, 0.51 }, { "x", "v" })
    -- at 0.5 `b` reads the u that was found at 0.48 or, if that comes early, at 0.5
    for _, t in ipairs { 0.48, 0.5 } do
      local x = run:at(t)
      assert.is_true(run.x.w:contains(-8 * x.x:mid() - 3 * x.v:mid()), tostring(run.x.w))
    end
    assert.is_true(run.x.w:width() < 0.3)
    local both = ambit.ode { states = { "x" }, equations = function(s) return { x = s.u + s.w } end,
      sampled = { ambit.sampled { "b", period = 0.05, outputs = { "w" }, law = function(s) return -s.x end },
        ambit.sampled { "a", period = 0.02, jitter = 0.001, outputs = { "u" }, law = function(s) return -s.w end } } }
    assert.has_error(function() ambit.simulate { both, initial = { x = 1 }, t = 1 } end,
      "sampled `a`: jitter: its law reads `w`, which `b` changes at samples of its own")
  end)

  it("refuses what is no jitter", function()
    for _, jitter in ipairs { "5 ms", 1, -0.001, "0.1 m" } do
      assert.has_error(function()
        ambit.sampled { period = "10 ms", jitter = jitter, outputs = { "u" }, law = function() return 0 end }
      end)
    end
  end)
end)
