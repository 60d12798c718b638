-- Everything that stands on a flow, with the solver `zonotope`: each answer is compared with a formula, not with
-- another solver of Ambit.
local ambit = require "ambit"
local core = require "ambit.core"
local multibody = require "multibody"
local between = ambit.between

local function oscillator(w)
  return ambit.ode { "oscillator", states = { "x", "v" }, parameters = { w = w },
    equations = function(s, p) return { x = s.v, v = -p.w * p.w * s.x } end }
end

-- every x0 cos(w t), -x0 w sin(w t) is inside, and the box is at most `share` wider than their hull
local function check(x, x0s, ws, t, share)
  local lo, hi = math.huge, -math.huge
  for _, x0 in ipairs(x0s) do
    for _, w in ipairs(ws) do
      local value = x0 * math.cos(w * t)
      lo, hi = math.min(lo, value), math.max(hi, value)
      assert.is_true(x.x.lo <= value + 1e-14 and value - 1e-14 <= x.x.hi)
      local speed = -x0 * w * math.sin(w * t)
      assert.is_true(x.v.lo <= speed + 1e-14 and speed - 1e-14 <= x.v.hi)
    end
  end
  if share then assert.is_true(x.x:width() <= (1 + share) * (hi - lo) + 1e-12) end
end

describe("zonotope", function()
  local x0s, ws = { 0.99, 1, 1.01 }, { 0.98, 0.99, 1, 1.01, 1.02 }
  local function question(more)
    local q = { oscillator(between("0.98", "1.02")), initial = { x = between("0.99", "1.01"), v = 0 }, t = { 0, 1, 3 },
      solver = "zonotope" }
    for k, v in pairs(more or {}) do q[k] = v end
    return q
  end

  it("holds every solution, at instants and between them, forwards and backwards", function()
    for _, ending in ipairs { 3, -3 } do
      local run = ambit.simulate(question { t = { 0, ending }, dense = true })
      assert.equal("complete", run.status)
      for k = 0, 30 do check(run:at(ending * k / 30), x0s, ws, ending * k / 30) end
      check(run:at(ending), x0s, ws, ending, 0.01)
    end
  end)

  it("is as exact as doubles allow where nothing is uncertain", function()
    local run = ambit.simulate(question { oscillator(1), initial = { x = 1, v = 0 }, t = { 0, 10 } })
    check(run.x, { 1 }, { 1 }, 10)
    assert.is_true(run.x.x:width() < 1e-10)
  end)

  it("goes on from its own set as if it had not stopped", function()
    local w, x0 = between("0.98", "1.02"), between("0.99", "1.01")
    local first = ambit.simulate(question { oscillator(w), initial = { x = x0, v = 0 }, t = { 0, 1 } })
    local second = ambit.simulate { oscillator(w), initial = first:set(), t = { 1, 3 }, solver = "zonotope" }
    check(second.x, x0s, ws, 3, 0.02)
  end)

  it("reaches what it keeps besides the sums of terms of degree 4", function()
    -- in one step; most of the set of w is what products leave out, and some data reach its end
    local function follow(rates, t, order)
      local p, q = ambit.between(-0.5, "0.50000001"), ambit.between(-0.02, 0.02)
      local run = ambit.simulate { ambit.ode { states = { "u", "v", "w" }, parameters = { p = p, q = q },
        equations = rates }, initial = { u = 0, v = 0, w = 1 }, t = { 0, t }, solver = "zonotope", tolerance = 1e6,
        time_order = order }
      assert.equal("complete", run.status)
      assert.equal(1, run.step_count)
      return run.x.w
    end
    local function integral(f, t) -- of e^(-k (t - s)) s^8 from 0 to t, by Simpson's rule
      local n, sum = 2000, 0
      for j = 0, n do sum = sum + (j % n == 0 and 1 or j % 2 == 1 and 4 or 2) * f(t * j / n) end
      return sum * t / n / 3
    end
    for _, t in ipairs { 0.5, -0.5 } do
      local w = follow(function(s, d) return { u = 1, v = d.p * d.p, w = s.v * s.v } end, t)
      assert.is_true(w.lo <= math.min(1, 1 + t ^ 3 / 48) and w.hi >= math.max(1, 1 + t ^ 3 / 48), "mean")
      assert.is_true(w:width() < 2.1 * math.abs(t) ^ 3 / 48)
    end
    for _, case in ipairs { { 0.5, 0.5 }, { 0.5, -0.5 }, { -0.5, 0.5 }, { -0.5, -0.5 } } do
      local t, k = case[1], case[2]
      local w = follow(function(s, d) return { u = 1, v = d.p * d.p * 4 * s.u ^ 3, w = s.v * s.v - k * (s.w - 1) } end,
        t, 12)
      local last = 1 + integral(function(s) return math.exp(-k * (t - s)) * s ^ 8 end, t) / 16
      assert.is_true(w.lo <= math.min(1, last) and w.hi >= math.max(1, last), "rest")
    end
    for _, t in ipairs { 1, -1 } do
      local w = follow(function(s, d)
        return { u = 1, v = d.p * d.p * 4 * s.u ^ 3, w = s.v * s.v - d.q * (s.w - 1) }
      end, t, 12)
      for _, q in ipairs { -0.02, 0, 0.02 } do
        local last = 1 + integral(function(s) return math.exp(-q * (t - s)) * s ^ 8 end, t) / 16
        assert.is_true(w.lo <= math.min(1, last) and w.hi >= math.max(1, last), "path")
      end
    end
  end)

  it("holds terms of degree 4 in the data, which cancel between products and change within a step", function()
    local function hold(rates, initial, exact, t)
      local names = {}
      for name in pairs(initial) do names[#names + 1] = name end
      table.sort(names)
      local run = ambit.simulate { ambit.ode { states = names, parameters = { p = between("0.5", "1.5") },
        equations = rates }, initial = initial, t = { 0, t }, solver = "zonotope" }
      assert.equal("complete", run.status)
      local lo, hi = math.huge, -math.huge
      for k = 0, 20 do
        local value = exact(0.5 + k / 20)
        lo, hi = math.min(lo, value), math.max(hi, value)
        assert.is_true(run.x.w.lo <= value + 1e-13 and value - 1e-13 <= run.x.w.hi)
      end
      return run.x.w:width() / (hi - lo)
    end
    for _, t in ipairs { 1, -1 } do
      local wider = hold(function(_, q)
        local a = q.p * q.p
        return { w = a * a - (0.5 - a * q.p) * q.p }
      end, { w = 0 }, function(p) return (2 * p ^ 4 - 0.5 * p) * t end, t)
      assert.is_true(wider < 1.1)
      hold(function(s, q)
        local u = s.u * s.u
        return { u = q.p, w = u * u }
      end, { u = 1, w = 0 }, function(p) return ((1 + p * t) ^ 5 - 1) / (5 * p) end, t)
      hold(function(s, q)
        local u = s.u * s.u
        return { u = -q.p * s.u, w = u * u - s.w }
      end, { u = 1, w = 0 }, function(p) return (math.exp(-t) - math.exp(-4 * p * t)) / (4 * p - 1) end, t)
      wider = hold(function(s, q) return { u = 1, w = q.p * (s.u * s.w) * q.p } end, { u = 0, w = 1 },
        function(p) return math.exp(p * p * t * t / 2) end, t)
      assert.is_true(wider < 1.1)
    end
  end)

  it("finds events in time", function()
    local run = ambit.simulate(question { events = { { name = "zero", g = function(s) return s.x end } } })
    assert.equal(1, #run.events)
    assert.is_true(run.events[1].certain)
    for _, w in ipairs(ws) do
      assert.is_true(run.events[1].t.lo <= math.pi / 2 / w and math.pi / 2 / w <= run.events[1].t.hi)
    end
    assert.is_true(run.events[1].t:width() < 0.07) -- 0.0629 for the data
  end)

  it("verifies and refutes", function()
    local safe = ambit.verify(question { t = 3, safe = function(s) return s.x - "1.02" end })
    assert.equal("proved", safe.status)
    local refuted = ambit.verify(question { t = 3, safe = function(s) return s.x - "1.005" end })
    assert.equal("refuted", refuted.status)
  end)

  it("splits", function()
    local run = ambit.simulate(question { split = 4, threads = 1 })
    assert.equal("complete", run.status)
    check(run.x, x0s, ws, 3, 0.05)
  end)

  it("returns to a section", function()
    local map = ambit.poincare { oscillator(1), section = function(s) return s.v end, direction = "rising", t_max = 8,
      solver = "zonotope", initial = { x = between("-1.5", -1), v = 0 } }
    assert.equal("complete", map.status)
    local back = map.returns[1]
    assert.is_true(back.t:contains(2 * math.pi) and back.t:width() < 1e-4)
    assert.is_true(back.x.x.lo <= -1.5 and -1 <= back.x.x.hi and back.x.x:width() < 0.501)
  end)

  it("switches between modes", function()
    local function mode(goal)
      return ambit.ode { states = { T = "K" }, equations = function(s) return { T = -(s.T - goal) / 5 } end }
    end
    local run = ambit.hybrid {
      modes = {
        off = { mode(10), guards = { { g = function(s) return s.T - 18 end, direction = "falling", to = "on" } } },
        on = { mode(30), guards = { { g = function(s) return s.T - 22 end, direction = "rising", to = "off" } } },
      },
      mode = "off", initial = { T = between("19.4", "19.6") }, t = { 0, 10 }, solver = "zonotope",
    }
    assert.equal("complete", run.status)
    local first, last = 5 * math.log(9.4 / 8), 5 * math.log(9.6 / 8)
    for n, e in ipairs(run.events) do
      local later = (n - 1) * 5 * math.log(12 / 8)
      assert.is_true(e.t.lo <= first + later and last + later <= e.t.hi)
      assert.is_true(e.t:width() < 1.1 * (last - first))
    end
    assert.is_true(#run.events >= 5)
  end)

  it("certifies a smaller model", function()
    local full = ambit.ode { states = { "x" }, parameters = { d = between("-0.01", "0.01") },
      equations = function(s, p) return { x = 1 - s.x + p.d * s.x } end }
    local less = ambit.ode { states = { "x" }, equations = function(s) return { x = 1 - s.x } end }
    local r = ambit.certify { full, less, t = { 0, 2 }, solver = "zonotope", outputs = { "x" }, initial = { x = 0 },
      error = { x = "0.02" } }
    assert.equal("proved", r.status)
  end)

  it("bounds sensitivities, hardly wider than they are", function()
    local r = ambit.sensitivity(question { t = { 0, 1 } })
    local lo, hi = math.huge, -math.huge
    for _, x0 in ipairs(x0s) do
      for _, w in ipairs(ws) do
        local by_w = -x0 * math.sin(w)
        lo, hi = math.min(lo, by_w), math.max(hi, by_w)
        assert.is_true(r:d("x", "w"):contains(by_w) and r:d("x", "x"):contains(math.cos(w)))
        assert.is_true(r:d("v", "w"):contains(-x0 * (math.sin(w) + w * math.cos(w))))
      end
    end
    assert.is_true(r:d("x", "w"):width() <= 1.02 * (hi - lo))
    assert.is_true(r:d("x", "x"):width() <= 1.02 * (math.cos(0.98) - math.cos(1.02)))
  end)

  it("bounds sensitivities of a mechanism, those that start at zero and stay small for long among them", function()
    local function chain(length, mass) -- three links from horizontal rest
      local bodies = {}
      for i = 1, 3 do
        bodies[i] = { parent = i - 1, slides = false, axis = { 0, 1, 0 }, offset = { i > 1 and 1 or 0, 0, 0 },
          turn_axis = { 0, 0, 1 }, mass = 1, centre = { 1, 0, 0 }, inertia = { 0, 0, 0, 0, 0, 0 } }
      end
      bodies[2].offset[1], bodies[1].centre[1], bodies[3].mass = length, length, mass
      local t = { bodies = bodies, gravity = { 0, 0, -9.81 }, q = { 0, 0, 0 }, v = { 0, 0, 0 }, times = { 0.3 },
        tolerance = 1e-16 }
      return multibody.run(t)[1]
    end
    local m = ambit.mechanism { "chain", gravity = { 0, 0, "-9.81" } }
    local frame, initial = m.world, {}
    local length, mass = ambit.around(1, "0.1%", "length"), ambit.around(1, "0.1%", "mass")
    for i = 1, 3 do
      local joint = m:revolute { from = frame, axis = "y", name = "q" .. i }
      frame = m:rigid_link { from = joint, offset = { i == 1 and length or 1, 0, 0 } }
      m:point_mass { at = frame, mass = i == 3 and mass or 1 }
      initial["q" .. i], initial["q" .. i .. "'"] = 0, 0
    end
    local r = ambit.sensitivity { m:dynamics(), initial = initial, t = { 0, "0.3" }, solver = "zonotope",
      wrt = { "length", "mass" } }
    assert.equal("complete", r.status)
    local step = 1e-4
    local longer, shorter = chain(1 + step, 1), chain(1 - step, 1)
    local heavier, lighter = chain(1, 1 + step), chain(1, 1 - step)
    for i = 1, 3 do
      local name = "q" .. i
      local by_length, by_mass = (longer[i] - shorter[i]) / (2 * step), (heavier[i] - lighter[i]) / (2 * step)
      for by, truth in pairs { length = by_length, mass = by_mass } do
        local d = r:d(name, by)
        assert.is_true(d.lo - 1e-7 <= truth and truth <= d.hi + 1e-7, ("%s by %s: %s, %g"):format(name, by, d, truth))
        assert.is_true(d:width() < 0.02 * math.abs(truth) + 1e-4, ("%s by %s: %s"):format(name, by, d))
      end
    end
  end)

  it("reduces", function()
    local o = ambit.ode { states = { "x", "y" }, parameters = { a = between("-0.01", "0.01") },
      equations = function(s, p) return { x = s.y, y = -s.x - s.y / 5 + p.a * s.x + ambit.sin(s.x) / 1000 } end }
    local small = ambit.reduce { o, t = { 0, 3 }, initial = { x = between("0.9", "1.1"), y = 0 }, outputs = { "x" },
      error = { x = "0.02" }, solver = "zonotope" }
    assert.equal("complete", small.status)
    assert.equal("y", tostring(small.ode.rates[1]))
    assert.equal("-(x + y/5)", tostring(small.ode.rates[2]))
    -- the greatest difference at the ends of the data: y'' + y'/5 + k y = 0 in closed form, sin x / 1000 about x / 1000
    local function x(k, t)
      local w = math.sqrt(k - 0.01)
      return 1.1 * math.exp(-t / 10) * (math.cos(w * t) + math.sin(w * t) / (10 * w))
    end
    local most = 0
    for k = 0, 300 do most = math.max(most, math.abs(x(1 + 0.01 - 0.0007, k / 100) - x(1, k / 100))) end
    assert.is_true(small.error.x >= most and small.error.x < 1.5 * most, ("%g, %g"):format(small.error.x, most))
  end)

  it("is compared with other solvers", function()
    local q = question { solvers = { "zonotope", "lohner" }, repeats = 1, n = 500 }
    q.solver = nil
    local row = ambit.compare(q).rows[1]
    assert.equal("zonotope", row.label)
    assert.equal("complete", row.status)
    check(row.values, x0s, ws, 3, 0.02)
    assert.is_true(row.over_sample >= 1 and row.over_sample < 1.05)
  end)

  it("has its time told by a profile, chosen by itself for many data", function()
    local scene, out = os.tmpname(), os.tmpname()
    local file = assert(io.open(scene, "w"))
    file:write [[
local ambit = require "ambit"
local names, k, initial = {}, {}, {}
for i = 1, 6 do names[i], k[i], initial["x" .. i] = "x" .. i, ambit.around(1, "5%"), ambit.around(1, "5%") end
ambit.simulate { t = { 0, 1 }, initial = initial, ambit.ode { states = names, equations = function(s)
  local rates = {}
  for i = 1, 6 do rates["x" .. i] = ambit.sin(s["x" .. i % 6 + 1]) * k[i] end
  return rates
end } }
]]
    file:close()
    local command = os.getenv "AMBIT_COMMAND" or "ambit"
    assert.is_true(os.execute(("%s profile %s >%s 2>&1 </dev/null"):format(command, scene, out)))
    local text = assert(io.open(out)):read "a"
    assert.matches("\n +solver zonotope +[%d.]+ +[%d.]+ %% +[%d.]+ +%d+\n", text)
    assert.matches("simulate zonotope, " .. scene:gsub("%p", "%%%0"), text)
    os.remove(scene)
    os.remove(out)
  end)

  it("says why it ends, and where the width comes from", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function(s) return { x = s.x * s.x } end },
      initial = { x = between("0.9", "1.1") }, t = 2, solver = "zonotope" }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached > 0.6 and run.t_reached < 1 / 1.1)
    assert.matches("t = ", run.reason)
    assert.matches("of `x` %d+ %% are errors of the method: %a", run.reason)
    assert.matches("most of the width comes from `initial x`", run.reason)
    local wide = ambit.simulate { oscillator(between("0.9", "1.1", "frequency")), initial = { x = x0s[3], v = 0 },
      t = { 0, 9 }, solver = "zonotope", width_max = 1 }
    assert.equal("unable.width", wide.code)
    assert.matches("comes from `frequency` %(100 %%%)", wide.reason)
  end)

  it("crosses a kink", function()
    local o = ambit.ode { states = { "x" }, equations = function(s) return { x = -ambit.abs(s.x) - 1 } end }
    local run = ambit.simulate { o, initial = { x = between("0.9", "1.1") }, t = 2, solver = "zonotope" }
    assert.equal("complete", run.status)
    local function x(x0) return 1 - math.exp(2) / (x0 + 1) end -- zero at t = log(x0 + 1)
    assert.is_true(run.x.x:contains(x(0.9)) and run.x.x:contains(x(1)) and run.x.x:contains(x(1.1)))
    assert.is_true(run.x.x:width() < 1.5 * (x(1.1) - x(0.9)), tostring(run.x.x))
  end)

  it("takes no short steps for the least of two that are the same", function()
    local p = between("0.45", "0.55")
    local o = ambit.ode { states = { "x", "y" }, parameters = { p = p }, equations = function(s, q)
      return { x = s.y, y = -ambit.min(s.x * (1 + q.p) * s.y, s.x * s.y + q.p * s.x * s.y) - s.x }
    end }
    local run = ambit.simulate { o, initial = { x = 1, y = between("0.09", "0.11") }, t = "0.001", solver = "zonotope" }
    assert.equal("complete", run.status)
    assert.is_true(run.step_count < 10, run.step_count)
  end)

  it("takes a mechanism in implicit form, closed loops included", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local joint = m:revolute { from = m.world, axis = "z", name = "angle" }
    m:point_mass { at = m:rigid_link { from = joint, offset = { 0, -1, 0 } }, mass = between("0.99", "1.01") }
    local run = ambit.simulate { m:dynamics(), initial = { angle = "0.01", ["angle'"] = 0 }, t = { 0, 1 },
      solver = "zonotope" }
    assert.equal("complete", run.status)
    assert.is_true(run.x.angle:width() < 1e-12) -- the mass cancels
    assert.is_true(math.abs(run.x.angle:mid() - 0.01 * math.cos(math.sqrt(9.81))) < 1e-6)
  end)

  local function fall(n, t, damping)
    local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
    local at, initial = m.world, {}
    for i = 1, n do
      local turned, joint = m:revolute { from = at, axis = "z", name = "q" .. i }
      at = m:rigid_link { from = turned, offset = { "0.5", 0, 0 } }
      m:point_mass { at = at, mass = 1 }
      if damping then m:joint_damper { joint = joint, damping = damping } end
      initial["q" .. i], initial["q" .. i .. "'"] = 0, 0
    end
    local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, t }, solver = "zonotope" }
    assert.equal("complete", run.status)
    return run
  end

  it("lets go a chain of 50 links from rest, most of which is at 0 but for rounding", function()
    fall(50, "0.01", "0.1")
  end)

  it("keeps nine digits of a chain of 20 links where nothing is uncertain", function()
    local run = fall(20, 1)
    -- tests/oracle/multibody_digits.c
    local truth = { q1 = "-1.0856778753269035104", ["q1'"] = "-0.69864659480300503029",
      q9 = "0.08523475213177738194", ["q9'"] = "-0.86922207981243767638", q17 = "0.0023883198605256454779" }
    for name, digits in pairs(truth) do assert.is_true(run.x[name]:contains(ambit.interval(digits)), name) end
    for _, name in ipairs(run.states) do assert.is_true(run.x[name]:width() < 1e-9 * math.max(1, run.x[name]:mag())) end
  end)

  it("takes elements in C that are not Ambit's own, in implicit form", function()
    -- pressed against the stop of tests/kit/kink_element.c all the time, its drag 0: m x'' = -k (x + 1)
    local m = ambit.mechanism { "slide" }
    local at, joint = m:prismatic { from = m.world, axis = "x", name = "x" }
    m:point_mass { at = at, mass = between("0.9", "1.1") }
    m:kink { joint = joint, stiffness = "0.01", stop = -1, drag = 0 }
    local run = ambit.simulate { m:dynamics(), initial = { x = between("0.99", "1.01"), ["x'"] = "0.3" }, t = { 0, 2 },
      solver = "zonotope" }
    assert.equal("complete", run.status)
    local lo, hi = math.huge, -math.huge
    for _, x0 in ipairs { 0.99, 1.01 } do
      for k = 0, 20 do
        local w = math.sqrt(0.01 / (0.9 + 0.01 * k))
        local x = (x0 + 1) * math.cos(2 * w) + 0.3 / w * math.sin(2 * w) - 1
        lo, hi = math.min(lo, x), math.max(hi, x)
        assert.is_true(run.x.x:contains(x))
      end
    end
    assert.is_true(run.x.x:width() <= 1.02 * (hi - lo))
  end)

  it("follows lightly damped oscillators whose springs are known worse than their damping allows", function()
    -- two masses 1 between walls: x1 + x2 and x1 - x2 oscillate alone, with k and k + 2 c
    local k, c, d = between(97, 103), between(39, 41), between("0.95", "1.05")
    local pair = ambit.ode { states = { "x", "v", "y", "w" }, equations = function(s)
      local pull = c * (s.x - s.y)
      return { x = s.v, v = -k * s.x - pull - d * s.v, y = s.w, w = -k * s.y + pull - d * s.w }
    end }
    local function mode(stiffness, damping, t)
      local w = math.sqrt(stiffness - damping ^ 2 / 4)
      return math.exp(-damping * t / 2) * (math.cos(w * t) + damping / (2 * w) * math.sin(w * t))
    end
    local times = { 0, 2, 5, 10, 20 }
    local run = ambit.simulate { pair, initial = { x = 1, v = 0, y = 0, w = 0 }, t = times, solver = "zonotope" }
    assert.equal("complete", run.status)
    for a = 0, 6 do
      for b = 0, 2 do
        for n = 2, #times do
          local k1, c1, t = 97 + a, 39 + b, times[n]
          local d1 = (a + b) % 2 == 0 and 0.95 or 1.05
          local sum, difference = mode(k1, d1, t), mode(k1 + 2 * c1, d1, t)
          local set = run:at(t)
          assert.is_true(set.x:contains((sum + difference) / 2), t)
          assert.is_true(set.y:contains((sum - difference) / 2), t)
        end
      end
    end
    assert.is_true(run.x.x:width() < 0.01) -- in generators alone: 0.024
  end)

  -- Nothing moves: what the run ends with is how its start was read. Sets are held against the polynomials themselves
  -- at drawn data, small rests included.
  local function still(random, n, terms)
    local data, rest, initial = {}, {}, {}
    for k = 1, n do data[k] = ambit.between(-1 - k / 8, 1 + k / 7, "u" .. k) end
    for i, name in ipairs { "a", "b" } do
      rest[i] = ambit.between(-0.01, 0.02, "rest " .. name)
      local sum = rest[i]
      for _ = 1, terms do
        local term = ambit.number(random(-100, 100) / 8)
        for _ = 1, random(0, 3 + i // 2) do term = term * data[random(n)] end -- b: also of degree 4, which no row holds
        sum = random(2) == 1 and sum + term or term - sum
      end
      initial[name] = sum
    end
    local product = data[1] * data[2] / 3
    initial.b = initial.b - initial.b * "0.125" + product * product
    local system = ambit.ode { states = { "a", "b" }, equations = function() return { a = 0, b = 0 } end }
    return { system, initial = initial, t = { 0, 1 }, solver = "zonotope" }, data, rest
  end

  it("reads starts with thousands of terms, and with data that are little more than errors", function()
    math.randomseed(5)
    for _, size in ipairs { { 4, 20 }, { 29, 60 }, { 8, 1500 }, { 31, 900 } } do
      local question, data, rest = still(math.random, size[1], size[2])
      local run = ambit.simulate(question)
      assert.equal("complete", run.status)
      local set = run:set()
      for draw = 1, 30 do
        local leaves, values = table.move(data, 1, #data, 1, {}), {}
        for k = 1, #data do
          local lo, hi, share = -1 - k / 8, 1 + k / 7, math.random()
          if draw % 2 == 0 then share = share < 0.5 and 0 or 1 end
          values[k] = core.expression(share == 1 and hi or lo + (hi - lo) * share)
        end
        for i in ipairs(rest) do
          leaves[#leaves + 1], values[#values + 1] = rest[i], core.expression(math.random(2) == 1 and -0.01 or 0.02)
        end
        local found = core.evaluate { expressions = { set.a, set.b }, leaves = leaves, values = values }
        local truth = core.evaluate { expressions = { question.initial.a, question.initial.b }, leaves = leaves,
          values = values }
        for i in ipairs(found) do
          assert.is_true(found[i].lo <= truth[i].hi and truth[i].lo <= found[i].hi, #data .. " data")
        end
        assert.is_true(found[1]:width() <= 0.0301) -- at most the rest and rounding
      end
    end
  end)

  it("has nearly all digits of long damped chains without data", function()
    local n, initial = 10, {}
    local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
    local at = m.world
    for i = 1, n do
      local turned, joint = m:revolute { from = at, axis = "z", name = "q" .. i }
      at = m:rigid_link { from = turned, offset = { "0.5", 0, 0 } }
      m:point_mass { at = at, mass = 1 }
      m:joint_damper { joint = joint, damping = "0.1" }
      initial["q" .. i], initial["q" .. i .. "'"] = 0, 0
    end
    local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, "0.5", 1, "1.001" }, solver = "zonotope",
      dense = true }
    assert.equal("complete", run.status)
    -- tests/oracle/multibody_digits.c, in quadruple precision
    local digits = { q1 = "-1.380912060116434688", ["q1'"] = "-1.129885907183028410", q3 = "0.004503079564193700739",
      q5 = "0.003703427283805575133", ["q5'"] = "-0.09755995390300081396", q9 = "-0.006804958623728171645",
      ["q9'"] = "-5.558623804774830015" }
    for name, text in pairs(digits) do
      local truth = ambit.number(text)
      for _, x in ipairs { run:at(1)[name], run:at("1")[name] } do
        local off = ambit.evaluate { x - truth, arithmetic = "interval" }
        assert.is_true(off.lo <= 1e-17 and off.hi >= -1e-17, name)
        assert.is_true(x:width() < 1e-12 * math.max(1, x:mag()), name)
      end
    end
    local coarse = ambit.simulate { m:dynamics(), initial = initial, t = { 0, 1 }, solver = "zonotope", time_order = 12,
      tolerance = 1e-11 }
    for name in pairs(digits) do -- another road to the same numbers
      assert.is_true(coarse.x[name].lo <= run:at(1)[name].hi and coarse.x[name].hi >= run:at(1)[name].lo, name)
    end
  end)

  it("takes no short steps where states rest until a kink is passed", function()
    local k, low, high = ambit.around(2e5, "5%"), ambit.around(900, "5%"), ambit.around(2200, "5%")
    local car = ambit.ode { states = { z = "m", v = "m/s" }, equations = function(x, _, t)
      local road = "0.03" * (1 - ambit.cos(2 * ambit.pi * ambit.min(ambit.max((t - "0.1") / "0.15", 0), 1)))
      return { z = x.v, v = (-k * (x.z - road) - high * ambit.max(x.v, 0) - low * ambit.min(x.v, 0)) / 45 }
    end, check_units = false }
    local run = ambit.simulate { car, initial = { z = 0, v = 0 }, t = { 0, "0.1", "0.25" }, solver = "zonotope" }
    assert.equal("complete", run.status)
    assert.is_true(run.step_count < 500)
    assert.is_true(run.overestimate < 1.5)
  end)

  it("takes no short steps because rates have parts that states lack", function()
    local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
    local at, initial = m.world, {}
    for i, stiffness in ipairs { 400, 100 } do
      local turned, joint = m:revolute { from = at, axis = "z", name = "q" .. i }
      at = m:rigid_link { from = turned, offset = { ambit.around("0.4", "1%"), 0, 0 } }
      m:point_mass { at = at, mass = ambit.around(2, "1%") }
      m:joint_torque { joint = joint, torque = function(q, v) return stiffness * ("0.3" - q - v / 7) end }
      initial["q" .. i], initial["q" .. i .. "'"] = 0, 0
    end
    local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, 4 }, solver = "zonotope" }
    assert.equal("complete", run.status)
    assert.is_true(run.step_count < 950, run.step_count) -- 779; else 1166
  end)
end)
