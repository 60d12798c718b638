-- Times given as text are the instants that they say, in every verb and every place that takes one. x' = 1, x' = c t
-- and x' = -x have closed forms: rational numbers, which are compared exactly, and exp and sin to 40 digits by mpmath.
local ambit = require "ambit"

local one = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }
local ramp = ambit.ode { states = { "x" }, equations = function(_, _, t) return { x = 2 * t } end }
local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
local wave = ambit.ode { states = { "x" }, equations = function(_, _, t) return { x = ambit.cos(t) } end }

local solvers = { "lohner", "taylor_model", "stiff", "valencia" }

-- Is the real number that a text says in the enclosure, which is no wider than so many roundings of it?
local function holds(x, truth, roundings, scale)
  assert.is_true(x:contains(truth), ("%s misses %s"):format(x:text(17), truth))
  local most = (roundings or 64) * 0x1p-52 * (scale or 1)
  assert.is_true(x:width() <= most, ("%s is wider than %g"):format(x:text(17), most))
end

local function run(ode, t, more)
  local q = { ode, initial = { x = 0 }, t = t, solver = "lohner" }
  for key, value in pairs(more or {}) do q[key] = value end
  return ambit.simulate(q)
end

local function refused(part, ...)
  local good, message = pcall(...)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

describe("instants as text: simulate", function()
  it("encloses the states at an end and at listed times that are no doubles", function()
    for _, solver in ipairs(solvers) do
      local r = run(one, { 0, "0.1", "1/7", "1/3" }, { solver = solver })
      assert.equal("complete", r.status)
      holds(r.x.x, "1/3")
      for _, t in ipairs { "0.1", "1/7", "1/3" } do holds(r:at(t).x, t) end
      holds(run(decay, { 0, "1/3" }, { solver = solver, initial = { x = 1 } }).x.x,
        "0.7165313105737892504256040969253796674531", 4096)
      holds(run(one, "1/3", { solver = solver }).x.x, "1/3")
      holds(run(one, { 0, "-1/3" }, { solver = solver }).x.x, "-1/3")
    end
  end)

  it("encloses states between steps, densely and by tubes", function()
    for _, solver in ipairs(solvers) do
      holds(run(one, { 0, 1 }, { solver = solver, dense = true }):at("0.1").x, "0.1", 4096)
      assert.is_true(run(one, { 0, 1 }, { solver = solver }):at("0.1").x:contains "0.1")
    end
  end)

  it("encloses the states of a run whose start is no double, with and without time in the equations", function()
    for _, solver in ipairs(solvers) do
      holds(run(one, { "1000000.1", "1000000.2" }, { solver = solver }).x.x, "0.1")
      holds(run(decay, { "1000000.1", "1000000.3" }, { solver = solver, initial = { x = 1 } }).x.x,
        "0.8187307530779818586699355086036787", 4096)
      holds(run(one, { 1e6, "1000000.1", "1000000.25" }, { solver = solver }):at("1000000.1").x, "0.1")
      holds(run(one, { 1e6, "999999.9" }, { solver = solver }).x.x, "-0.1")
      holds(run(ramp, { "1/3", "2/3" }, { solver = solver }).x.x, "1/3")
      holds(run(ramp, { "1/3", "-2/3" }, { solver = solver }).x.x, "1/3", 128)
      holds(run(ramp, { "1/3", 1 }, { solver = solver }).x.x, "8/9")
      holds(run(wave, { 0, "1/3" }, { solver = solver }).x.x, "0.3271946967961522441733440852676206060643", 4096)
      holds(run(wave, { "1000000.1", "1000000.2" }, { solver = solver }).x.x,
        "0.09781281139603055405658789657458311867554", 4096, 1e6)
    end
  end)

  it("is exact at the start, however it is said", function()
    local r = run(one, { "1/3", 1 }, { initial = { x = "1/7" } })
    holds(r:at("1/3").x, "1/7", 1)
    holds(r:at(1).x, "17/21")
    for step in r:steps() do assert.is_true(step.x.x:intersect(step.t - "1/3" + "1/7"):is_empty() == false) end
  end)

  it("changes nothing where the text is a double", function()
    local a, b = run(decay, { 0, 0.5, 3 }, { initial = { x = 1 } }),
      run(decay, { "0", "0.5", "3000 ms" }, { initial = { x = 1 } })
    assert.equal(a.step_count, b.step_count)
    assert.equal(a.t_reached, b.t_reached)
    for _, t in ipairs { 0.5, 3 } do
      assert.equal(a:at(t).x.lo, b:at(t).x.lo)
      assert.equal(a:at(t).x.hi, b:at(t).x.hi)
    end
    assert.equal("number", type(b.t_start))
    for step in b:steps() do assert.equal("number", type(step.t)) end
  end)

  it("goes on from the true end", function()
    for _, solver in ipairs(solvers) do
      local first = run(one, { 0, "1/3" }, { solver = solver })
      local second = run(one, { "1/3", 1 }, { solver = solver, initial = first:set() })
      holds(second.x.x, 1, 256)
    end
    local big = run(ambit.ode { states = { "x" }, equations = function() return { x = 1e12 } end }, { 0, "1/3" })
    holds(ambit.evaluate { big:set().x, arithmetic = "interval" }, "1000000000000/3", 64, 1e12)
  end)

  it("keeps only the last step where asked, and splits", function()
    holds(run(one, { 0, "1/3" }, { keep = "last" }).x.x, "1/3")
    local r = run(decay, { 0, "1/3" }, { initial = { x = ambit.between(1, 2) }, split = 4 })
    assert.is_true(r.x.x:contains "0.7165313105737892504256040969253796674531")
  end)

  it("tells events by the true time", function()
    local function found(t, g, ode)
      local r = run(ode or one, t, { events = { { g = g, name = "pass" } }, initial = { x = 0 } })
      assert.equal(1, #r.events)
      assert.is_true(r.events[1].certain)
      return r.events[1].t
    end
    assert.is_true(found({ "1000000.1", 1000001 }, function(s) return s.x - "0.5" end):contains "1000000.6")
    assert.is_true(found({ "1/3", 1 }, function(s) return s.x - "1/6" end):contains "1/2")
    assert.is_true(found({ "1/3", 1 }, function(_, _, t) return t - "2/3" end):contains "2/3")
    assert.is_true(found({ "1/3", 1 }, ambit.time - "2/3"):contains "2/3")
    assert.is_true(found({ "1/3", 1 }, function(s) return s.x - "1/3" end, ramp):contains "0.6666666666666666666666667")
  end)

  it("leaves open whether what happens within the last bracket happens before the end", function()
    local fast = ambit.ode { states = { "x" }, equations = function() return { x = 1e12 } end }
    local function found(t, sign, behind, stop)
      local way = t[1] == "0.333333" and "1000000/3" or "-2000000/3"
      if t[1] == "0.333334" then behind = -behind end
      local r = run(fast, t, { events = { { g = function(s) return s.x - way - sign * behind end, name = "pass",
        stop = stop } } })
      assert.equal(1, #r.events)
      return r.events[1], r.status
    end
    for _, start in ipairs { "0.333333", "0.333334" } do
      assert.is_true(found({ start, "1/3" }, -1, 1e-3).certain)
      local pass = found({ start, "1/3" }, 1, 1e-5) -- 1e-17 s behind the end
      assert.is_false(pass.certain)
      assert.is_truthy(pass.reason:find("behind the end", 1, true), pass.reason)
      local _, status = found({ start, "1/3" }, 1, 1e-5, true)
      assert.equal("unable", status)
    end
  end)

  it("may end within the spacing of doubles", function()
    for _, solver in ipairs(solvers) do
      holds(run(one, { "0.1", "0.10000000000000000001" }, { solver = solver }).x.x, "1e-20", 64, 1e-12)
      holds(run(one, { "1000000.1", "1000000.10000000001" }, { solver = solver }).x.x, "1e-11", 64, 1e-8)
      holds(run(one, { "1000000.10000000001", "1000000.1" }, { solver = solver }).x.x, "-1e-11", 64, 1e-8)
    end
    refused("horizon is zero", run, one, { "0.1", "1/10" })
    refused("one way", run, one, { 0, "0.10000000000000000002", "0.10000000000000000001" })
  end)

  it("takes the times of its own steps, and other enclosures", function()
    for _, solver in ipairs(solvers) do
      for _, t in ipairs { { "1/3", 1 }, { "1000000.1", "1000000.2" }, { 1, "1/3" } } do
        local r = run(one, t, { solver = solver, dense = true })
        for step in r:steps() do
          local x = r:at(step.t).x
          assert.is_false(x:intersect(step.x.x):is_empty())
          assert.is_true(x:width() <= 2e-9)
        end
      end
    end
    local r = run(one, { 0, 1 }, { dense = true })
    local x = r:at(ambit.interval("0.25", "0.5")).x
    assert.is_true(x:contains "0.25" and x:contains "0.5" and x:width() < 0.3)
    assert.is_true(r:at(ambit.interval("0.5", 3)).x:contains(1))
    refused("not within the run", r.at, r, ambit.interval(2, 3))
  end)

  it("shows both ends on pages", function()
    local span = require "ambit.run.instant".span
    for _, times in ipairs { { "1/3", "2/3" }, { "2/3", 0.5, "1/3" }, { "0.1", "0.10000000000000000001" } } do
      local ends = span(times, "t")
      local all = ambit.interval(math.min(ends[1], ends[2]), math.max(ends[1], ends[2]))
      assert.is_true(all:contains(times[1]) and all:contains(times[#times]), all:text(17))
      assert.equal(times[1] == "2/3", ends[1] > ends[2])
    end
  end)

  it("refuses what is no instant, or no horizon", function()
    refused("cannot be uncertain", run, one, { 0, "[1, 2]" })
    refused("finite", run, one, { 0, "1e400" })
    refused("horizon is zero", run, one, { "1/3", "1/3" })
    refused("one way", run, one, { 0, "1/3", "1/3", 1 })
    refused("one way", run, one, { 0, 0.1, "0.1" }) -- the double 0.1 is later
    refused("not within the run", run(one, { 0, 0.3 }).at, run(one, { 0, 0.3 }), "0.3") -- the double 0.3 is earlier
  end)
end)

describe("instants as text: other verbs", function()
  local function verify(t, more)
    local q = { one, initial = { x = 0 }, t = t, solver = "lohner" }
    for key, value in pairs(more) do q[key] = value end
    return ambit.verify(q)
  end

  it("verify proves and refutes nothing of the ulp that may lie behind the end", function()
    local short, exact, long = "0.0999999999999", "0.1", "0.100001"
    local function above(limit) return function(s) return s.x - limit end end
    local function below(limit) return function(s) return limit - s.x end end
    assert.not_equal("proved", verify({ "1000000.1", "1000000.2" }, { safe = above(short) }).status)
    assert.equal("proved", verify({ "1000000.1", "1000000.2" }, { safe = above(long) }).status)
    assert.equal("refuted", verify({ "1000000.1", "1000000.2" }, { safe = above "0.0999" }).status)
    for _, kind in ipairs { "safe", "at_end" } do
      assert.not_equal("refuted", verify({ 0, "0.1" }, { [kind] = above(exact) }).status)
      assert.equal("refuted", verify({ 0, "0.1" }, { [kind] = above "0.09999" }).status)
      assert.equal("proved", verify({ 0, "0.1" }, { [kind] = above(long) }).status)
    end
    assert.not_equal("refuted", verify({ 0, "0.1" }, { reach = below(exact) }).status)
    assert.equal("proved", verify({ 0, "0.1" }, { reach = below(short) }).status)
    assert.equal("refuted", verify({ 0, "0.1" }, { reach = below(long) }).status)
    -- 0.3 lies between two doubles, and this bound between 0.3 and the upper one: false for the double, true for "0.3"
    local between = ambit.number "0.30000000000000002"
    assert.not_equal("refuted", verify({ 0, "0.3" }, { safe = above(between) }).status)
    assert.not_equal("proved", verify({ 0, "0.3" }, { reach = below(between) }).status)
  end)

  it("verify takes time in conditions and equations by the true start", function()
    local v = ambit.verify { ramp, initial = { x = 0 }, t = { "1/3", 1 }, solver = "lohner",
      safe = function(s, _, t) return s.x - t ^ 2 + "1/9" - "1e-12" end }
    assert.equal("proved", v.status)
    v = ambit.verify { ramp, initial = { x = 0 }, t = { "1/3", 1 }, solver = "lohner",
      safe = function(s, _, t) return s.x - t ^ 2 + "1/9" + "1e-12" end }
    assert.equal("refuted", v.status)
  end)

  it("sensitivity", function()
    local s = ambit.sensitivity { decay, initial = { x = 1 }, t = { 0, "0.1", "1/3" }, solver = "lohner" }
    holds(s:d("x", "x"), "0.7165313105737892504256040969253796674531", 4096)
    holds(s:d_at("0.1", "x", "x"), "0.9048374180359595731642490594464366211947", 4096)
    holds(s:at("0.1").x, "0.9048374180359595731642490594464366211947", 4096)
    s = ambit.sensitivity { decay, initial = { x = 1 }, t = { "1/3", "2/3" }, solver = "lohner" }
    holds(s:d("x", "x"), "0.7165313105737892504256040969253796674531", 4096)
  end)

  it("sample takes a double next to each", function()
    local s = ambit.sample { one, initial = { x = 0 }, t = { 0, "0.1", "1/3" }, n = 2 }
    assert.is_true(math.abs(s:at("0.1").x.lo - 0.1) < 1e-9)
    assert.is_true(math.abs(s:at("1/3").x.hi - 1 / 3) < 1e-9)
    assert.is_true(math.abs(s.x.x.hi - 1 / 3) < 1e-9)
    local r = run(one, { 0, "0.1", "1/3" })
    assert.is_nil(r:overestimation(s).contradiction)
    s = ambit.sample { ramp, initial = { x = 0 }, t = { "1/3", "0.5", "2/3" }, n = 2 }
    for t, x in pairs { ["1/3"] = 0, ["0.5"] = 5 / 36, ["2/3"] = 1 / 3 } do
      assert.is_true(math.abs(s:at(t).x.lo - x) < 1e-9)
    end
    assert.is_true(math.abs(ambit.sample { one, initial = { x = 0 }, t = { 0, "0.1" }, n = 2 }:at(0.1).x.lo - 0.1) < 1e-9)
  end)

  it("poincare", function()
    local circle = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }
    local function returns(start, most, more)
      local q = { circle, section = function(s) return s.x end, direction = "rising", initial = { x = 0, v = 1 },
        t_start = start, t_max = most }
      for key, value in pairs(more or {}) do q[key] = value end
      return ambit.poincare(q)
    end
    local two_pi = 2 * ambit.pi
    local late = returns("1000000.1", 1000010)
    assert.equal("complete", late.status)
    assert.is_true(late.returns[1].t:contains(two_pi + ambit.number "1000000.1"))
    local orbit = returns("1/3", "100/3", { initial = { x = 0, v = ambit.around(1, "1e-6") } })
    assert.is_true(orbit.returns[1].t:contains(two_pi + ambit.number "1/3"))
    local forced = ambit.ode { states = { "x", "v" },
      equations = function(s, _, t) return { x = s.v, v = -s.x + 0 * t } end }
    assert.is_true(returns("1/3", 10, { forced }).returns[1].t:contains(two_pi + ambit.number "1/3"))
  end)

  it("hybrid", function()
    local function saw(t, ode, limit)
      return ambit.hybrid { modes = { up = { ode, guards = { { name = "top", direction = "rising", to = "up",
        g = function(s) return s.x - limit end, reset = function() return { x = 0 } end } } } },
        initial = { x = 0 }, t = t }
    end
    local h = saw({ 0, "0.1", "4/3" }, one, 1)
    assert.equal("complete", h.status)
    holds(h.x.x, "1/3", 1024)
    holds(h:at("0.1").x, "0.1", 1024)
    h = saw({ "1/3", 1, "5/3" }, one, 1)
    assert.equal("complete", h.status)
    holds(h.x.x, "1/3", 1024)
    holds(h:at(1).x, "2/3", 1024)
    assert.is_true(h.events[1].t:contains "4/3")
    assert.is_true(h:at("1/3").x:contains(0))
    h = saw({ "1/3", 1 }, ramp, "5/36") -- x = t^2 - 1/9 until t = 1/2, then t^2 - 1/4 until (7/18)^(1/2)
    assert.equal("complete", h.status)
    assert.is_true(h.events[1].t:contains "1/2")
  end)

  it("certify, by both criteria", function()
    local zero = ambit.ode { states = { "x" }, equations = function() return { x = 0 } end }
    for _, ode in ipairs { one, ramp } do
      for _, criterion in ipairs { "difference", "bounds" } do
        local c = ambit.certify { ode, zero, t = { "1/3", "2/3" }, initial = { x = 0 }, outputs = { "x" },
          criterion = criterion, solver = "lohner" }
        assert.equal("proved", c.status)
        assert.is_true(c.error.x >= 1 / 3 and c.error.x < 1 / 3 + 1e-12) -- the truth is 1/3, which is above the double
        assert.is_true(ambit.interval(0, c.error.x):contains "1/3")
      end
    end
  end)

  it("reduce says the instants as they were given", function()
    local two = ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = 2 * t - "0.001" * s.x } end }
    local small = ambit.reduce { two, t = { "1/3", "2/3" }, initial = { x = 0 }, outputs = { "x" }, error = { x = "0.01" } }
    assert.equal("complete", small.status)
    assert.is_truthy(tostring(small):find("t from 1/3 to 2/3 s", 1, true))
    assert.is_truthy(small:json():find('"times":["1/3","2/3"]', 1, true))
    assert.is_truthy(small.ode)
  end)

  it("compare holds a reference against the enclosures at its own time", function()
    local big = ambit.ode { states = { "x" }, equations = function() return { x = 1e12 } end }
    local c = ambit.compare { big, initial = { x = 0 }, t = { 0, "1/3" }, solvers = { "lohner" },
      reference = { t = "1/3", x = { x = "1000000000000/3" } } }
    assert.is_truthy(c)
    assert.is_nil(c.missed)
    assert.is_true(c.rows[1].error > 0 and c.rows[1].error < 1e-3)
  end)
end)

describe("instants as text, drawn at random", function()
  -- t0 = a/d, t1 = b/d: x' = 1 gives (b - a)/d, x' = 2 t gives (b^2 - a^2)/d^2
  it("agree with exact rationals", function()
    local seed = 1
    local function draw(most)
      seed = (seed * 1103515245 + 12345) & 0x7fffffff
      return (seed >> 8) % most + 1
    end
    for n = 1, tonumber(os.getenv "AMBIT_TRIES" or 60) do
      local a, d, solver = draw(3000), draw(2000), solvers[n % #solvers + 1]
      local b = a + (draw(2) == 1 and 1 or -1) * draw(a)
      local t = { ("%d/%d"):format(a, d), ("%d/%d"):format(b, d) }
      local scale = 1 + math.max(a, b) / d
      holds(run(one, t, { solver = solver }).x.x, ("%d/%d"):format(b - a, d), 1e4, scale)
      holds(run(ramp, t, { solver = solver }).x.x, ("%d/%d"):format(b * b - a * a, d * d), 1e4, scale ^ 2)
    end
  end)

  it("is reached by every method of a solver that proves nothing", function()
    local fall = ambit.ode { states = { "x" }, equations = function(st) return { x = -st.x } end }
    for _, method in ipairs { "rk4", "rk8pd" } do -- others allocate within a run
      local run = ambit.simulate { fall, initial = { 1 }, t = { 0, "3.1" }, solver = "gsl", method = method }
      assert.equal("complete", run.status)
      assert.is_true(math.abs(run.x.x:mid() - math.exp(-3.1)) < 1e-5)
    end
  end)
end)
