-- The verb sensitivity against closed forms, digits of others' making and differences of runs.
local ambit = require "ambit"

local exp, cos, sin, sqrt = math.exp, math.cos, math.sin, math.sqrt

-- The enclosure holds the number, up to what the double arithmetic of the closed form loses.
local function assert_near(x, truth, slack)
  slack = slack or 1e-11 * (1 + math.abs(truth))
  if x.lo > truth + slack or x.hi < truth - slack then
    error(("%s does not hold %.17g"):format(tostring(x), truth), 2)
  end
end

local function assert_refused(part, t)
  local good, message = pcall(ambit.sensitivity, t)
  assert.is_false(good)
  if not tostring(message):find(part, 1, true) then error(("expected %q, got %s"):format(part, message), 2) end
end

local oscillator = ambit.ode { states = { x = "m", v = "m/s" }, parameters = { k = ambit.between(4, "4.41") },
  equations = function(s, p) return { x = s.v, v = -p.k * s.x } end }

describe("sensitivity", function()
  it("holds the derivatives of an oscillator for every point of the initial set and every stiffness", function()
    for _, span in ipairs { { 0, 2 }, { 2, 0 } } do
      local s = ambit.sensitivity { oscillator, initial = { x = ambit.around(1, "0.01"), v = 0 }, t = span,
        dense = true }
      assert.equal("complete", s.status)
      for i = 0, 20 do
        local t = i / 10
        local tau = t - span[1]
        for _, k in ipairs { 4, 4.2, 4.41 } do
          for _, x0 in ipairs { 0.99, 1, 1.01 } do
            local w = sqrt(k)
            assert_near(s:d_at(t, "x", "x"), cos(w * tau))
            assert_near(s:d_at(t, "x", "v"), sin(w * tau) / w)
            assert_near(s:d_at(t, "v", "x"), -w * sin(w * tau))
            assert_near(s:d_at(t, "x", "k"), -x0 * tau * sin(w * tau) / (2 * w))
            assert_near(s:d_at(t, "v", "k"), -x0 * (sin(w * tau) + w * tau * cos(w * tau)) / (2 * w))
          end
        end
      end
    end
  end)

  it("is tight for points, so that a wrong derivative would be noticed", function()
    local f = ambit.ode { states = { "x", "v" }, equations = function(u) return { u.v, -4 * u.x } end }
    local s = ambit.sensitivity { f, initial = { 1, 0 }, t = { 0, 2 } }
    assert_near(s:d("x", "x"), cos(4))
    assert.is_true(s:d("x", "x"):width() < 1e-12)
    assert.has_error(function() assert_near(s:d("x", "x"), cos(4) + 1e-9) end)
    assert.has_error(function() assert_near(s:d("x", "v"), sin(4.000001) / 2) end)
  end)

  it("knows the logistic equation", function()
    local r = ambit.between("0.9", "1.1")
    local growth = ambit.ode { states = { "x" }, parameters = { r = r },
      equations = function(s, p) return { x = p.r * s.x * (1 - s.x) } end }
    local s = ambit.sensitivity { growth, initial = { x = ambit.around("0.1", "0.005") }, t = { 0, 1, 3 } }
    assert.same({ "x", "r" }, s.wrt)
    for _, t in ipairs { 1, 3 } do
      for _, rate in ipairs { 0.9, 1, 1.1 } do
        for _, x0 in ipairs { 0.095, 0.1, 0.105 } do
          local e = exp(rate * t)
          local below = 1 + x0 * (e - 1)
          local x = x0 * e / below
          assert_near(s:d_at(t, "x", "x"), e / below ^ 2)
          assert_near(s:d_at(t, "x", r), t * x * (1 - x))
        end
      end
    end
  end)

  it("differentiates initial values that depend on the same datum, and explicit time", function()
    local p = ambit.between("0.5", "0.6")
    local f = ambit.ode { states = { "x" }, parameters = { p = p },
      equations = function(s, q, t) return { x = q.p * s.x + t } end }
    local s = ambit.sensitivity { f, initial = { x = p * p }, t = { 0, 1 }, wrt = { "x", "p" } }
    for _, a in ipairs { 0.5, 0.55, 0.6 } do -- x = (a^2 + a^-2) e^(a t) - t/a - a^-2
      local e = exp(a)
      assert_near(s:d("x", "x"), e)
      assert_near(s:d("x", "p"), (2 * a - 2 / a ^ 3) * e + (a ^ 2 + a ^ -2) * e + 1 / a ^ 2 + 2 / a ^ 3)
    end
  end)

  it("takes a datum as it was written: by degrees or by radians", function()
    local angle = ambit.around(30, 1)
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local s = ambit.sensitivity { f, initial = { ambit.degrees(angle) }, t = { 0, 1 },
      wrt = { degrees = angle, radians = ambit.degrees(angle) } }
    assert_near(s:d("x", "degrees"), exp(-1) * math.pi / 180)
    assert_near(s:d("x", "radians"), exp(-1))
    local length = ambit.sensitivity { oscillator, initial = { x = ambit.around("10 mm", "1 mm"), v = 0 }, t = 1,
      wrt = { "x", "k" } }
    assert.equal("1", length:unit("x", "x"))
    assert.equal("m/s/(m)", length:unit("v", "x"))
  end)

  it("agrees with the exponentials of random matrices", function()
    local seed = 12345
    local function draw()
      seed = (seed * 1103515245 + 12345) % 2147483648
      return seed / 1073741824 - 1
    end
    for n = 1, 4 do
      local a, names = {}, {}
      for i = 1, n do
        names[i], a[i] = "x" .. i, {}
        for j = 1, n do a[i][j] = draw() end
      end
      local f = ambit.ode { states = names, equations = function(s)
        local rates = {}
        for i = 1, n do
          rates[i] = ambit.number(0)
          for j = 1, n do rates[i] = rates[i] + a[i][j] * s["x" .. j] end
        end
        return rates
      end }
      local initial = {}
      for i = 1, n do initial[i] = ambit.around(draw(), "0.1") end
      local s = ambit.sensitivity { f, initial = initial, t = { 0, 1 } }
      for j = 1, n do -- column j of e^A by its series
        local term, sum = {}, {}
        for i = 1, n do term[i], sum[i] = i == j and 1 or 0, i == j and 1 or 0 end
        for k = 1, 40 do
          local next_term = {}
          for i = 1, n do
            next_term[i] = 0
            for l = 1, n do next_term[i] = next_term[i] + a[i][l] * term[l] / k end
          end
          term = next_term
          for i = 1, n do sum[i] = sum[i] + term[i] end
        end
        for i = 1, n do
          assert_near(s:d("x" .. i, "x" .. j), sum[i])
          assert.is_true(s:d("x" .. i, "x" .. j):width() < 1e-10) -- linear: the initial set does not matter
        end
      end
    end
  end)

  -- Digits: mpmath 1.3, odefun with 30 digits, central differences with a step of 1e-9.
  it("holds mpmath's digits of the double pendulum", function()
    local g, m2 = ambit.between("9.81", "9.8100000001"), ambit.between(1, "1.0000000001")
    local m = ambit.mechanism { "double pendulum", gravity = { 0, -g, 0 } }
    local function bar(name, from)
      return m:rigid_link { from = m:revolute { from = from, axis = "z", name = name }, offset = { 0, -1, 0 } }
    end
    local elbow = bar("beta1", m.world)
    local hand = bar("beta2", elbow)
    m:point_mass { at = elbow, mass = 1 }
    m:point_mass { at = hand, mass = m2 }
    local s = ambit.sensitivity { m:dynamics(), t = { 0, "0.4" }, wrt = { "beta1", "beta2'", g = g, m2 = m2 },
      initial = { beta1 = 3 * ambit.pi / 4, beta2 = -11 * ambit.pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" } }
    local digits = {
      beta1 = { 1.5170477648289, -1.2971349723829, 2.5196229680941, -7.7612269649762 },
      ["beta2'"] = { 0.00352788142461, 0.39459929665046, 0.11333720384529, 0.84188871977961 },
      g = { -0.065713017763792, 0.03684914793647, -0.37714924794532, 0.41987526775375 },
      m2 = { -0.017497358588997, 0.023065768153647, -0.075808602938814, 0.14532878505078 },
    }
    for by, column in pairs(digits) do
      for i, state in ipairs { "beta1", "beta2", "beta1'", "beta2'" } do
        assert_near(s:d(state, by), column[i], 1e-13)
        assert.is_true(s:d(state, by):width() < 1e-8)
      end
    end
  end)

  it("holds mpmath's digits of a Kepler orbit", function()
    local orbit = ambit.ode { states = { "x", "y", "u", "v" }, parameters = { mu = ambit.between(1, "1.0000000001") },
      equations = function(s, p)
        local r3 = ambit.sqrt(s.x ^ 2 + s.y ^ 2) ^ 3
        return { x = s.u, y = s.v, u = -p.mu * s.x / r3, v = -p.mu * s.y / r3 }
      end }
    local s = ambit.sensitivity { orbit, initial = { 1, 0, 0, "1.1" }, t = { 0, 3 }, wrt = { "v", "mu" } }
    local digits = { mu = { -1.0644833293053, -4.6763288666309, 1.4008008696642, -3.3534605634743 },
      v = { 0.29713928987068, 7.1621249583854, -2.1008711795226, 4.7770140806032 } }
    for by, column in pairs(digits) do
      for i, state in ipairs { "x", "y", "u", "v" } do
        assert_near(s:d(state, by), column[i], 1e-13)
        assert.is_true(s:d(state, by):width() < 1e-7)
      end
    end
  end)

  it("builds no state for a derivative that is identically zero", function()
    local apart = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = -s.x, y = s.x * s.y } end }
    local s = ambit.sensitivity { apart, initial = { 1, 2 }, t = { 0, 1 } }
    assert.equal(5, s.report.states) -- d x/d y is left out
    assert.is_true(s:d("x", "y").lo == 0 and s:d("x", "y").hi == 0)
    assert_near(s:d("y", "x"), 2 * (1 - exp(-1)) * exp(1 - exp(-1)))
    assert.falsy(tostring(s):find("d x/d y", 1, true))
    assert.truthy(tostring(s):find("d y/d x", 1, true))
  end)

  it("tells the derivatives of every step", function()
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local last
    for step in ambit.sensitivity({ f, initial = { 1 }, t = { 0, 3 } }):steps() do
      assert_near(step.d("x", "x"), exp(-step.t))
      last = step.t
    end
    assert.equal(3, last)
  end)

  it("differentiates closed loops by data that the loop does not know, and refuses the others", function()
    local function crank(mass)
      local m = ambit.mechanism { "crank", gravity = { 0, "-9.81", 0 } }
      local function bar(name, from, length)
        return m:rigid_link { from = m:revolute { from = from, axis = "z", name = name }, offset = { length, 0, 0 } }
      end
      local pin = bar("crank", m.world, 1)
      local tip = bar("rod", pin, 2)
      m:point_mass { at = pin, mass = mass }
      m:point_mass { at = tip, mass = 2 }
      m:point_on_line { a = m.world, b = tip, axis = "x" }
      m:independent { "crank" }
      return m
    end
    local angle, mass = ambit.number "0.5", ambit.between(1, "1.01")
    local initial = { crank = angle, rod = -angle - ambit.asin(ambit.sin(angle) / 2), ["crank'"] = 0 }
    local m = crank(mass)
    local s = ambit.sensitivity { m:dynamics(), initial = initial, t = { 0, "0.5" }, wrt = { m = mass } }
    assert.equal("complete", s.status)
    local ends = {}
    for i, value in ipairs { "1", "1.01" } do
      ends[i] = ambit.simulate { crank(ambit.number(value)):dynamics(), initial = initial, t = { 0, "0.5" } }
    end
    for _, state in ipairs { "crank", "rod" } do -- mean value theorem
      local quotient = (ends[2].x[state] - ends[1].x[state]) / ambit.interval "0.01"
      assert.is_false(s:d(state, "m"):intersect(quotient):is_empty())
      assert.is_true(s:d(state, "m").hi < 0 or s:d(state, "m").lo > 0)
    end
    assert_refused("moves the start off the constraint",
      { m:dynamics(), initial = initial, t = { 0, 1 }, wrt = { "crank" } })
  end)

  it("refuses what cannot be differentiated, by name", function()
    local f = ambit.ode { states = { "x" }, parameters = { a = ambit.between(1, 2), c = 3 },
      equations = function(s, p) return { x = -p.a * p.c * s.x } end }
    local function try(wrt) return { f, initial = { 1 }, t = { 0, 1 }, wrt = wrt } end
    assert_refused("there is no state, parameter or datum `b`; did you mean", try { "b" })
    assert_refused("`c` is not uncertain", try { "c" })
    assert_refused("`x` is given twice", try { "x", "x" })
    assert_refused("expected a state, a parameter or an uncertain datum", try {})
    local y, z = ambit.between(1, 2), ambit.between(1, 2)
    assert_refused("`yz` is not one uncertain datum", try { yz = y * z })
    assert_refused("`y2` is not an uncertain datum or a constant times one", try { y2 = y ^ 2 })
    local kink = ambit.ode { states = { "x" }, equations = function(s) return { x = ambit.abs(s.x) } end }
    assert_refused("abs", { kink, initial = { 1 }, t = { 0, 1 } })
    local s = ambit.sensitivity(try { "x" })
    assert.has_error(function() return s:d("y", "x") end)
    assert.has_error(function() return s:d("x", "a") end)
  end)

  it("ends with the run it rides on", function()
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
    local s = ambit.sensitivity { f, initial = { 1 }, t = { 0, 2 } }
    assert.equal("unable", s.status)
    assert.is_true(s.t_reached > 0.9 and s.t_reached < 1)
    assert.is_true(s:d("x", "x"):contains(1 / (1 - s.t_reached) ^ 2))
    require("ambit.session").unable = false
  end)

  it("takes the solver that suits, and none whose cost the many states forbid", function()
    local function solver_of(k, wide)
      local o = ambit.ode { states = { "x", "y" }, parameters = { k = k },
        equations = function(s, p) return { x = -p.k * s.x * s.y, y = -s.y } end }
      return ambit.sensitivity { o, initial = { x = 1, y = wide }, t = { 0, "0.1" } }.run.solver
    end
    assert.equal("lohner", solver_of(1, 1))
    assert.equal("zonotope", solver_of(ambit.around(1, "20%"), ambit.around(1, "20%")))
    assert.equal("lohner", solver_of(1e5, 1)) -- `stiff` for the system itself
  end)

  -- Five links and more are differentiated in implicit form; formulas for the accelerations are written for solvers
  -- that ask for them. Against differences of ordinary runs, which the mean value theorem puts between the derivatives.
  it("differentiates balances instead of formulas for accelerations", function()
    local function ask(mass, start, more)
      local m, initial = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }, {}
      local at = m.world
      for i = 1, 5 do
        local turned, joint = m:revolute { from = at, axis = i % 2 == 0 and "x" or "z", name = "q" .. i }
        at = m:rigid_link { from = turned, offset = { "0.4", "0.1", 0 } }
        m:rigid_body { at = turned, mass = i == 3 and mass or 1, centre = { "0.2", 0, 0 },
          inertia = { "0.01", 0, 0, 0, "0.02", 0, 0, 0, "0.02" } }
        m:joint_damper { joint = joint, damping = "0.1" }
        initial["q" .. i], initial["q" .. i .. "'"] = 0.1 * i, 0
      end
      initial.q1 = start
      local t = { m:dynamics(), initial = initial, t = { 0, 0.1, 0.2 } }
      for key, value in pairs(more) do t[key] = value end
      return t
    end
    local mass, start = ambit.around(2, 0.001), ambit.around(0.1, 0.001)
    local found = ambit.sensitivity(ask(mass, start, { wrt = { "q1", mass = mass }, solver = "zonotope" }))
    assert.equal("complete", found.run.status)
    local by_formulas = ambit.sensitivity(ask(mass, start, { wrt = { mass = mass }, solver = "lohner", t = { 0, 0.01 } }))
    assert.equal("complete", by_formulas.run.status)
    local function ordinary(m, q) return ambit.simulate(ask(m, q, { solver = "gsl", relative = 1e-13, absolute = 1e-15 })) end
    local light, heavy = ordinary(1.999, 0.1), ordinary(2.001, 0.1)
    local low, high = ordinary(2, 0.099), ordinary(2, 0.101)
    local function holds(x, quotient, name)
      assert.is_true(x.lo - 1e-8 <= quotient and quotient <= x.hi + 1e-8, name)
      assert.is_true(x:width() < 0.02 * (1 + x:mag()), name)
    end
    for _, t in ipairs { 0.1, 0.2 } do
      for _, name in ipairs(found.of) do
        holds(found:d_at(t, name, "mass"), (heavy:at(t)[name]:mid() - light:at(t)[name]:mid()) / 0.002, name)
        holds(found:d_at(t, name, "q1"), (high:at(t)[name]:mid() - low:at(t)[name]:mid()) / 0.002, name)
      end
    end
  end)
end)
