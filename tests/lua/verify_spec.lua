-- The verb verify: conditions proved, refuted by an example, or left open, against closed forms and ordinary
-- integration.
local ambit = require "ambit"
local session = require "ambit.session"

local oscillator = ambit.ode { states = { "x", "v" }, equations = function(s) return { s.v, -s.x } end }
local start = { ambit.around(1, "0.01"), 0 }

local function verify(t)
  t[1], t.initial, t.t = t[1] or oscillator, t.initial or start, t.t or { 0, 10 }
  local r = ambit.verify(t)
  session.worst = "ok"
  return r
end

local function assert_refused(part, t)
  local good, message = pcall(verify, t)
  assert.is_false(good)
  if not tostring(message):find(part, 1, true) then error(("expected %q, got %s"):format(part, message), 2) end
end

-- x(t) by the classical Runge-Kutta method, for rates(x) -> list
local function integrate(rates, x, t, steps)
  local h, n = t / steps, #x
  local function along(a, k, s)
    local y = {}
    for i = 1, n do y[i] = a[i] + s * k[i] end
    return y
  end
  for _ = 1, steps do
    local a = rates(x)
    local b = rates(along(x, a, h / 2))
    local c = rates(along(x, b, h / 2))
    local d = rates(along(x, c, h))
    for i = 1, n do x[i] = x[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
  end
  return x
end

describe("verify", function()
  it("proves what holds for every start and every time", function()
    local r = verify { safe = function(s) return s.x - 1.02 end }
    assert.equal("proved", r.status)
    assert.equal("", r.reason)
    assert.is_true(r.bound.lo <= -0.01 and r.bound.hi >= -0.01 and r.bound.hi <= 0) -- max x is 1.01
    assert.is_nil(r.counterexample)
    assert.truthy(tostring(r):find "^proved after")
  end)

  it("refutes by a start, a time and a value", function()
    local r = verify { safe = function(s) return s.x - 1.005 end }
    assert.equal("refuted", r.status)
    local c = r.counterexample
    assert.is_true(c.g.lo > 0)
    local x0, t = c.initial.x, c.t:mid()
    assert.is_true(x0.lo >= 0.99 and x0.hi <= 1.0100001)
    assert.is_true(math.abs(x0:mid() * math.cos(t) - 1.005 - c.g:mid()) < 1e-9)
    assert.is_true(r.bound.lo > 0 and r.bound.hi >= 0.005)
    assert.truthy(tostring(r):find "refuted, max g in")
  end)

  it("says nothing where a bound is only just touched", function()
    local r = verify { initial = { 1, 0 }, t = { 0, 6 }, safe = function(s) return -s.x - 1 end } -- at t = pi
    assert.equal("undecided", r.status)
    assert.is_true(r.bound.lo <= 0 and r.bound.hi >= 0 and r.bound:width() < 1e-12)
    assert.truthy(r.reason:find("nothing left to refine", 1, true))
    assert.truthy(r.reason:find("worst bound is at t in [3.14159", 1, true))
    r = verify { budget = 12, safe = function(s) return s.x - "1.01" end }
    assert.equal("undecided", r.status)
    assert.is_true(r.refinements >= 12 and r.refinements <= 13)
    assert.truthy(r.reason:find("the budget is spent", 1, true))
  end)

  it("judges each of several conditions", function()
    local r = verify { safe = { wide = function(s) return s.x ^ 2 + s.v ^ 2 - 1.03 end,
      tight = function(s) return s.x ^ 2 + s.v ^ 2 - 1 end }, at_end = { a = function(s) return s.x end,
      b = function(s) return -s.x end } }
    local found = {}
    for name, c in pairs(r.conditions) do found[name] = c.status end
    assert.same({ wide = "proved", tight = "refuted", a = "proved", b = "refuted" }, found)
    assert.equal("refuted", r.status)
    local c = r.conditions.b
    assert.is_true(c.counterexample.t.lo == 10 and c.counterexample.g:contains(-math.cos(10) * 1))
    assert.is_true(c.bound.lo > 0.82 and c.bound.hi < 0.86)
  end)

  it("proves that something is reached, or that it is not", function()
    local function height(h) return function(s) return s.x - h end end
    local r = verify { t = { 0, 4 }, reach = { here = height(-0.9), there = height(-1), nowhere = height(-1.1) } }
    assert.equal("proved", r.conditions.here.status)
    assert.equal("refuted", r.conditions.there.status) -- from 0.99 it is not
    assert.equal("refuted", r.conditions.nowhere.status)
    assert.is_true(r.conditions.there.counterexample.initial.x.hi < 1)
    assert.is_true(r.conditions.nowhere.counterexample.g.lo > 0)
    assert.is_true(r.conditions.nowhere.bound.hi >= 0.11)
  end)

  it("works backwards, with explicit time and kinks", function()
    local square = ambit.ode { states = { "x" }, equations = function(s) return { s.x ^ 2 } end }
    local r = verify { square, initial = { ambit.around(1, "0.05") }, t = { 0, -5 }, -- x = 1 / (1/x0 - t)
      safe = { positive = function(s) return -s.x end, kink = function(s) return ambit.abs(s.x - 1) - 1 end },
      at_end = { late = function(s, _, t) return s.x + t / 20 end } }
    assert.equal("proved", r.status)
    r = verify { square, initial = { ambit.around(1, "0.05") }, t = { 0, -5 },
      safe = function(s) return 0.5 - s.x end }
    assert.equal("refuted", r.status)
    local c = r.counterexample
    assert.is_true(0.5 - 1 / (1 / c.initial.x:mid() - c.t:mid()) > 0)
  end)

  it("refutes before a finite escape, and stays undecided behind it", function()
    local square = ambit.ode { states = { "x" }, equations = function(s) return { s.x ^ 2 } end }
    local r = verify { square, initial = { 1 }, t = { 0, 2 }, safe = function(s) return s.x - 1000 end }
    assert.equal("refuted", r.status)
    assert.is_true(r.bound.hi == math.huge)
    r = verify { square, initial = { 1 }, t = { 0, 2 }, safe = function(s) return -s.x end }
    assert.equal("undecided", r.status)
    assert.is_true(#r.reason > 40)
  end)

  it("cuts the data where one run is not enough", function()
    local vdp = ambit.ode { states = { "x", "y" }, parameters = { mu = ambit.between("0.9", "1.1") },
      equations = function(s, p) return { s.y, p.mu * (1 - s.x ^ 2) * s.y - s.x } end }
    local r = verify { vdp, solver = "lohner", initial = { ambit.around(2, "0.05"), 0 }, t = { 0, 7 },
      safe = { x = function(s) return s.x ^ 2 - "4.6" end, y = function(s) return s.y ^ 2 - 9 end } }
    assert.equal("proved", r.status)
    assert.is_true(r.refinements > 10)
    local again = verify { vdp, solver = "lohner", initial = { ambit.around(2, "0.05"), 0 }, t = { 0, 7 },
      safe = { x = function(s) return s.x ^ 2 - "4.6" end, y = function(s) return s.y ^ 2 - 9 end } }
    assert.equal(r.refinements, again.refinements) -- counted, not timed
    assert.is_true(r.conditions.x.bound == again.conditions.x.bound)
    local worse = verify { vdp, initial = { ambit.around(2, "0.05"), 0 }, t = { 0, 7 },
      safe = { y = function(s) return s.y ^ 2 - "7.5" end } }
    assert.equal("refuted", worse.status)
    local c = worse.counterexample
    local mu = c.parameters.mu:mid()
    local x = integrate(function(u) return { u[2], mu * (1 - u[1] ^ 2) * u[2] - u[1] } end,
      { c.initial.x:mid(), c.initial.y:mid() }, c.t:mid(), 4000)
    assert.is_true(x[2] ^ 2 > 7.5 and math.abs(x[2] ^ 2 - 7.5 - c.g:mid()) < 1e-6)
  end)

  it("cuts the parameter that makes bounds wide, not data that nothing depends on", function()
    local states, initial = { "x", "v" }, { x = 1, v = 0 }
    for i = 1, 4 do
      states[2 + i], initial["y" .. i] = "y" .. i, ambit.between(0, 1)
    end
    local o = ambit.ode { states = states, parameters = { w = ambit.between("0.5", 2) }, equations = function(s, p)
      local rates = { x = s.v, v = -p.w ^ 2 * s.x }
      for i = 1, 4 do rates["y" .. i] = -s["y" .. i] end
      return rates
    end }
    local r = verify { o, initial = initial, t = { 0, 8 }, solver = "lohner", -- x = cos(w t)
      safe = { high = function(s) return s.x - "1.05" end, low = function(s) return "-1.05" - s.x end } }
    assert.equal("proved", r.status)
    assert.is_true(r.refinements < 120)
  end)

  it("agrees with ordinary integration on random systems", function()
    local seed = 4711
    local function draw()
      seed = (seed * 1103515245 + 12345) % 2147483648
      return seed / 1073741824 - 1
    end
    local tally = { proved = 0, refuted = 0, undecided = 0 }
    for n = 1, 12 do
      local a, b, c, d, e, f, w = draw(), draw(), draw(), draw(), draw(), draw(), draw()
      local function rates(x)
        return { a * x[1] + b * x[2] + e * x[1] * x[2], c * x[1] + d * x[2] - x[2] * x[1] * x[1] }
      end
      local function g(x, y) return f * x + w * y + x * y end
      local f1, f2 = draw(), draw()
      local most = -math.huge
      for i = -1, 1 do
        for j = -1, 1 do
          for k = 0, 40 do
            local x = integrate(rates, { f1 + 0.02 * i, f2 + 0.02 * j }, k / 40 * 1.5, 40)
            most = math.max(most, g(x[1], x[2]))
          end
        end
      end
      local level = most + (n % 3 - 1) * 0.02 -- below, at and above what is reached
      local r = verify { ambit.ode { states = { "x", "y" }, equations = function(s) return rates { s.x, s.y } end },
        initial = { ambit.around(f1, 0.02), ambit.around(f2, 0.02) }, t = { 0, 1.5 }, budget = 60,
        safe = function(s) return g(s.x, s.y) - level end }
      tally[r.status] = tally[r.status] + 1
      if r.status == "proved" then assert.is_true(most - level <= 1e-6) end
      if r.status == "refuted" then
        local p = r.counterexample
        local x = integrate(rates, { p.initial.x:mid(), p.initial.y:mid() }, p.t:mid(), 400)
        assert.is_true(math.abs(g(x[1], x[2]) - level - p.g:mid()) < 1e-6 + p.g:width())
      end
      assert.is_true(most - level <= r.bound.hi + 1e-6)
      assert.is_true(n % 3 ~= 2 or r.status == "proved")
      assert.is_true(n % 3 ~= 0 or r.status == "refuted")
    end
    assert.is_true(tally.proved >= 4 and tally.refuted >= 4)
  end)

  it("keeps the hand of the double pendulum within a disc, and knows that it leaves a smaller one", function()
    local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
    local function bar(name, from)
      local at = m:rigid_link { from = m:revolute { from = from, axis = "z", name = name }, offset = { 0, -1, 0 } }
      m:point_mass { at = at, mass = 1 }
      return at
    end
    local hand = m:position(bar("beta2", bar("beta1", m.world)))
    local square = hand.x ^ 2 + hand.y ^ 2
    local r = verify { m:dynamics(), t = { 0, "0.5" }, safe = { large = square - "3.2", small = square - 3 },
      initial = { beta1 = ambit.around(3 * ambit.pi / 4, "1%"), beta2 = -11 * ambit.pi / 20, ["beta1'"] = "0.43",
        ["beta2'"] = "0.67" } }
    assert.equal("proved", r.conditions.large.status)
    assert.equal("refuted", r.conditions.small.status)
    assert.is_true(r.conditions.small.bound.lo > 0.07)
  end)

  it("takes measurements of mechanisms, and says what the data were", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local length = ambit.around(1, "1%")
    local joint = m:revolute { from = m.world, axis = "z", name = "beta" }
    local tip = m:rigid_link { from = joint, offset = { 0, -length, 0 } }
    m:point_mass { at = tip, mass = 1 }
    local function ask(limit)
      return verify { m:dynamics(), t = { 0, 3 },
        initial = { beta = ambit.degrees(ambit.around(60, 1)), ["beta'"] = 0 }, safe = m:position(tip).x - limit }
    end
    assert.equal("proved", ask "0.89".status) -- 1.01 sin 61 deg = 0.8834
    local r = ask "0.88"
    assert.equal("refuted", r.status)
    assert.is_true(r.counterexample:value(length).lo >= 0.99 and r.counterexample:value(length).hi <= 1.0101)
    assert.truthy(tostring(r):find("\n    rigid_link1.offset.y = [1.0", 1, true), tostring(r))
  end)

  it("follows single starts where they meet their constraints, and no others", function()
    local m = ambit.mechanism { "top", gravity = { 0, 0, 0 } }
    local body = m:spherical_quaternion { from = m.world, name = "q" }
    m:rigid_body { at = body, mass = 1, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, 3 } } }
    local speed = "q'.1" -- almost about a principal axis: almost constant
    local initial = { ["q.1"] = 1, ["q.2"] = 0, ["q.3"] = 0, ["q.4"] = 0, [speed] = ambit.around(1, "0.1"),
      ["q'.2"] = "0.1", ["q'.3"] = 0 }
    local function limit(x) return m:coordinates()[speed] - x end
    local r = verify { m:dynamics(), initial = initial, t = { 0, 1 }, safe = { high = limit(1.2), low = limit(1.05) } }
    assert.equal("proved", r.conditions.high.status)
    assert.equal("refuted", r.conditions.low.status)
    initial["q.1"] = ambit.between(1, 2) -- now only a part of the data is a start
    r = verify { m:dynamics(), initial = initial, t = { 0, 1 }, budget = 4,
      safe = { high = limit(1.2), low = limit(1.05) } }
    assert.equal("proved", r.conditions.high.status)
    assert.equal("undecided", r.conditions.low.status)
    initial["q.1"] = 2 -- and none: that is what is proved
    r = verify { m:dynamics(), initial = initial, t = { 0, 1 }, safe = limit(1.2) }
    assert.equal("impossible", r.status)
    assert.equal("domain.constraint", r.code)
    assert.truthy(r.reason:find("constraint", 1, true) or r.reason:find("quaternion", 1, true))
    local a, b = ambit.between("0.72", "1.4"), ambit.between("-0.7", "0.7") -- none, as cutting shows: 2 a^2 + 2 b^2 > 1
    initial["q.1"], initial["q.2"], initial[speed] = a - b, a + b, 1
    r = verify { m:dynamics(), initial = initial, t = { 0, "0.2" },
      safe = ambit.log(-1 - m:coordinates()[speed] ^ 2) } -- never defined
    assert.equal("impossible", r.status)
    assert.truthy(r.reason:find("constraint", 1, true))
  end)

  it("does not refute by values that only rounding put into the range of a datum", function()
    local rest = ambit.ode { states = { "x" }, equations = function(s) return { 0 * s.x } end }
    for _, k in ipairs { 1, 3, 10, 17, 30 } do -- x <= 0.3, and the double above 0.3 is not
      local r = verify { rest, initial = { ambit.between("0.1", "0.3") }, t = 1,
        at_end = function(s) return k * s.x - ambit.number(3 * k) / 10 end }
      assert.equal("undecided", r.status)
      assert.is_true(r.bound.lo <= 0)
    end
    local r = verify { rest, initial = { ambit.around("0.2", "50%") }, t = 1,
      safe = function(s) return s.x - "0.2999999" end }
    assert.equal("refuted", r.status)
    assert.is_true(r.counterexample.initial.x.hi <= 0.3)
  end)

  it("does not take a jumping angle for the integral of its rate", function()
    local f = ambit.ode { states = { "x" }, equations = function() return { 1 } end }
    local r = verify { f, initial = { ambit.around(-0.5, 0.01) }, t = { 0, 0.495 }, -- some cross the cut
      safe = function(s) return ambit.atan2(s.x, -1) - 3 end }
    assert.equal("refuted", r.status)
    assert.is_true(r.counterexample.initial.x.lo > -0.4951)
    assert.equal("proved", verify { f, initial = { ambit.around(-0.5, 0.01) }, t = { 0, 0.48 },
      safe = function(s) return ambit.atan2(s.x, -1) - 3 end }.status)
  end)

  it("keeps to a budget of time", function()
    local r = verify { budget = "50 ms", safe = function(s) return s.x - "1.01" end }
    assert.equal("undecided", r.status)
    assert.is_true(r.cpu_seconds < 5)
    assert.equal(0, verify { budget = 0, safe = function(s) return s.x - "1.01" end }.refinements)
  end)

  it("tells `ambit run` that something is not proved, but not that something is refuted", function()
    session.worst = "ok"
    ambit.verify { oscillator, initial = start, t = 1, safe = function(s) return s.x - 1.005 end }
    assert.equal("ok", session.worst)
    ambit.verify { oscillator, initial = start, t = 1, budget = 0, safe = function(s) return s.x - "1.01" end }
    assert.equal("unable.budget", session.worst)
    session.worst = "ok"
  end)

  it("writes verdicts and bounds into the last record, and exits with 3 if something is undecided", function()
    local command = os.getenv "AMBIT_COMMAND" or "ambit"
    local function run(condition)
      local name = os.tmpname()
      local file = assert(io.open(name, "w"))
      file:write(([[local ambit = require "ambit"
        local f = ambit.ode { states = { "x" }, equations = function(s) return { -s.x } end }
        ambit.verify { f, initial = { ambit.around(1, "0.1") }, t = 1, budget = 9, safe = { c = %s } }]])
        :format(condition))
      file:close()
      local pipe = assert(io.popen(("'%s' run --quiet --json - '%s' 2>&1"):format(command, name)))
      local text = pipe:read "a"
      local _, _, code = pipe:close()
      os.remove(name)
      return code, text
    end
    for condition, expected in pairs { ["f.symbols[1] - 2"] = { 0, "proved" }, ["f.symbols[1] - 1"] = { 0, "refuted" },
      ['f.symbols[1] - "1.1"'] = { 3, "undecided" } } do
      local code, text = run(condition)
      assert.equal(expected[1], code)
      assert.truthy(text:find('"record":"result","verb":"verify","status":"' .. expected[2], 1, true))
      assert.truthy(text:find('"conditions":{"c":{"status":"' .. expected[2] .. '","bound":[', 1, true))
    end
  end)

  it("refuses what it cannot understand, by name", function()
    assert_refused("nothing to prove", {})
    assert_refused("there is no state `y`", { safe = function(s) return s.y end })
    assert_refused("there is no parameter `k`", { safe = function(_, p) return p.k end })
    assert_refused("an empty table", { safe = {} })
    assert_refused("expected an expression, got a table", { safe = { a = { 1 } } })
    assert_refused("two conditions `a`", { safe = { a = 1 }, at_end = { a = 1 } })
    assert_refused("budget: expected a number of runs", { safe = 1, budget = -1 })
    assert_refused("budget", { safe = 1, budget = "3 m" })
    assert_refused("unknown key `save`", { save = 1 })
    local other = ambit.ode { states = { "z" }, equations = function(s) return { s.z } end }
    assert_refused("the condition `safe` depends on `z`", { safe = other.symbols[1] })
    if ambit.plugins("solver").gsl then assert_refused("proves nothing", { safe = 1, solver = "gsl" }) end
  end)
end)
