-- The verb sample against closed forms, and overestimation factors against widths that are known.
local ambit = require "ambit"
local core = require "ambit.core"
local over = require "ambit.sample.overestimation"
local sample = require "ambit.sample"
local between, around = ambit.between, ambit.around

local function fails(pattern, t)
  local good, message = pcall(ambit.sample, t)
  assert.is_false(good)
  assert.truthy(tostring(message):find(pattern), tostring(message))
end

-- What a fresh process that runs this scene prints.
local function printed(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  local pipe = assert(io.popen(("%s run --quiet %s 2>&1"):format(os.getenv "AMBIT_COMMAND", name)))
  local output = pipe:read "a"
  pipe:close()
  os.remove(name)
  return output
end

describe("sample of expressions", function()
  it("loads the sequences when something is drawn, and never GSL", function()
    local scene = [[
local ambit, core = require "ambit", require "ambit.core"
local function has(name)
  for _, file in ipairs(core.libraries()) do if file:find(name) then return "yes" end end
  return "no"
end
local x = ambit.between(1, 2)
local o = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
ambit.evaluate { x }
ambit.sample { x, n = 5, points = "random" }
ambit.sample { o, initial = { x = x }, t = 1, n = 5, points = "random" }
io.write(has "quasi_random", " ", has "libgsl%.", " ")
ambit.sample { x, n = 5 }
io.write(has "quasi_random", " ", has "libgsl%.")
]]
    assert.equal("no no yes no", printed(scene))
  end)

  it("finds the range of a product and of a sine over a box", function()
    local x, y = between(-1, 2), between(1, 3)
    local hull = ambit.sample { { product = x * y, sine = ambit.sin(2 * x * y) }, n = 500 }
    assert.equal(-3, hull.product.lo)
    assert.equal(6, hull.product.hi)
    assert.truthy(hull.sine.lo >= -1 and hull.sine.lo < -1 + 1e-9)
    assert.truthy(hull.sine.hi <= 1 and hull.sine.hi > 1 - 1e-9)
    assert.truthy(hull.error.product <= 1e-14 and hull.error.sine <= 1e-14)
    assert.equal(500, hull.draws)
    assert.equal("sobol", hull.points)
    assert.truthy(hull.polished > 0)
  end)

  it("is the same for any number of threads, and another for another seed", function()
    local x, y = between(-1, 2), between(1, 3)
    for _, points in ipairs { "sobol", "niederreiter", "halton", "reverse_halton", "random" } do
      local function draw(threads, seed)
        return ambit.sample { { ambit.sin(x * y) + x }, n = 5000, threads = threads, seed = seed, points = points,
          polish = false, corners = false }
      end
      local one, three, other = draw(1, 1), draw(3, 1), draw(1, 2)
      assert.equal(points, one.points)
      assert.equal(one[1].lo, three[1].lo)
      assert.equal(one[1].hi, three[1].hi)
      assert.are_not.equal(one[1].hi, other[1].hi)
    end
  end)

  it("draws one point, the middle", function()
    local hull = ambit.sample { { between(1, 2) }, n = 1 }
    assert.equal(1.5, hull[1].lo)
    assert.equal(1.5, hull[1].hi)
  end)

  it("says what is wrong", function()
    local x = between(1, 2)
    fails("points: expected one of .*; did you mean `sobol`?", { x, points = "sobl" })
    fails("sample: n: expected a positive integer", { x, n = 0 })
    fails("sample: seed: expected an integer", { x, seed = "one" })
    fails("sample: polish: expected true or false", { x, polish = 1 })
    fails("unknown key `sed`; did you mean `seed`", { x, sed = 1 })
    local many = {}
    for i = 1, 257 do many[i] = between(0, 1) end
    fails("257 data, and a sequence has at most 256 dimensions", { many, points = "sobol" })
    assert.equal("reverse_halton", ambit.sample({ many, n = 20 }).points)
  end)
end)

describe("sample of a system", function()
  -- x' = -k x: x0 exp(-k t)
  local decay = ambit.ode { states = { "x" }, parameters = { k = between(1, "1.5") },
    equations = function(s, p) return { x = -p.k * s.x } end }

  local function draw(t)
    local q = { decay, initial = { x = between(1, 2) }, t = { 0, "0.5", 2 }, n = 200 }
    for key, value in pairs(t or {}) do q[key] = value end
    return ambit.sample(q)
  end

  it("finds the range of a linear flow, in lanes and by a solver", function()
    for _, solver in ipairs { "", "gsl" } do
      local s = draw { solver = solver ~= "" and solver or nil }
      assert.equal("complete", s.status)
      for _, t in ipairs { 0, 0.5, 2 } do
        local x, error = s:at(t).x, s:error_at(t).x
        assert.truthy(error >= 0 and error < 1e-8)
        assert.truthy(math.abs(x.lo - math.exp(-1.5 * t)) <= 2 * error + 1e-15)
        assert.truthy(math.abs(x.hi - 2 * math.exp(-t)) <= 2 * error + 1e-15)
      end
      assert.equal(s.x.x.hi, s:at(2).x.hi)
    end
  end)

  it("ends where doubles are seconds apart", function()
    local from = -2^53 - 64
    local slow = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x / -1000 } end }
    local question = { slow, initial = { x = between(1, 2) }, t = { from, from + 66, from + 1000 }, n = 100 }
    local s = ambit.sample(question)
    assert.equal("complete", s.status)
    local x, off = s.x.x, 1e-15 + s:error_at(from + 1000).x
    assert.truthy(math.abs(x.lo - math.exp(-1)) <= 2 * off and math.abs(x.hi - 2 * math.exp(-1)) <= 2 * off)
    assert.truthy(off < 1e-8)
    question[1], question.t, question.partial = decay, { from, from + 64 }, true
    local lost = ambit.sample(question)
    assert.equal("unable", lost.status) -- no step is short enough
  end)

  it("goes backwards in time, takes tolerances, and options of gsl", function()
    local back = draw { t = { 2, 0 } }
    assert.truthy(math.abs(back.x.x.hi - 2 * math.exp(3)) <= 2 * back.error.x)
    local loose = draw { relative = 1e-4, absolute = "1e-6" }
    assert.truthy(loose.error.x > draw().error.x)
    assert.equal("gsl", draw { method = "rkf45" }.method)
    fails("unknown key `relatve`", { decay, initial = { x = 1 }, t = 1, relatve = 1 })
    fails("arithmetic `affine` .* draws are made in `real`", { decay, initial = { x = 1 }, t = 1,
      arithmetic = "affine" })
    fails("relative: expected a number", { decay, initial = { x = 1 }, t = 1, relative = "much" })
  end)

  it("is the same for any number of threads", function()
    local one, three = draw { threads = 1, n = 1000 }, draw { threads = 3, n = 1000 }
    assert.equal(one.x.x.lo, three.x.x.lo)
    assert.equal(one.x.x.hi, three.x.x.hi)
    assert.equal(one.error.x, three.error.x)
  end)

  -- What is printed, too: all digits are known.
  it("claims no more than it knows", function()
    for _, relative in ipairs { 1e-3, 1e-6, 1e-10 } do
      local s = draw { relative = relative, absolute = relative }
      for _, t in ipairs { 0, 0.5, 2 } do
        local x, lo, hi = s:at(t).x, math.exp(-1.5 * t), 2 * math.exp(-t)
        assert.truthy(x.lo >= lo and x.hi <= hi and x.error == s:error_at(t).x)
        for _, digits in ipairs { 3, 17 } do
          local from, to = x:text(digits):match "^%[(%S+), (%S+)%]$"
          assert.truthy(tonumber(from) >= lo and tonumber(to) <= hi, x:text(digits))
        end
      end
      local one = draw { initial = { x = 1 }, relative = relative, absolute = relative, t = { 0, 2 },
        ambit.ode { states = { "x" }, equations = function(st) return { x = -st.x } end } }
      for _, digits in ipairs { 3, 17 } do
        local value, error = one.x.x:text(digits):match "^(%S+) %+%- (%S+)$"
        assert.truthy(math.abs(tonumber(value) - math.exp(-2)) <= tonumber(error), one.x.x:text(digits))
        assert.truthy(tonumber(error) <= 2.5 * one.error.x)
      end
    end
    assert.is_nil(ambit.interval(0, 1).error)
  end)

  it("says of one draw that its error is all there is to it", function()
    local q = { decay, initial = { x = 1 }, t = { 0, 1 }, n = 20, threads = 1 }
    q[1] = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local run, seen = ambit.simulate { q[1], initial = q.initial, t = q.t }, ambit.sample(q)
    assert.is_nil(run:overestimation(seen).x)
    assert.is_nil(run:overestimation(seen).contradiction)
  end)

  -- The true range of x at the last time lies within lo, hi: does the hull, made smaller by its error, too?
  local function is_inner(lo, hi, s, t)
    local x, error = s:at(t).x, s:error_at(t).x
    assert.truthy(error == error, "the error is not known")
    assert.truthy(x.lo + error >= lo and x.hi - error <= hi,
      ("[%.17g, %.17g] off by %g, truly [%.17g, %.17g]"):format(x.lo, x.hi, error, lo, hi))
  end

  it("owns up to a pulse that its steps went over", function()
    local pulse = ambit.ode { states = { "x" },
      equations = function(s, _, t) return { x = s.x * ambit.exp(-((t - 50) * 20) ^ 2) } end }
    local grown = math.exp(math.sqrt(math.pi) / 20)
    for _, method in ipairs { "lanes", "gsl" } do
      local s = ambit.sample { pulse, initial = { x = between(1, 2) }, t = { 0, 100 }, n = 50,
        solver = method == "gsl" and "gsl" or nil }
      is_inner(grown, 2 * grown, s, 100)
    end
  end)

  it("knows its error where all is below the absolute tolerance", function()
    is_inner(1e-20 * math.exp(-1.5), 2e-20 * math.exp(-1), draw { initial = { x = between(1e-20, 2e-20) }, t = 1 }, 1)
  end)

  it("knows its error where draws were made one by one, and where none reached the end", function()
    local drain = ambit.ode { states = { "x" }, equations = function(s) return { x = -ambit.sqrt(s.x) } end }
    local s = ambit.sample { drain, initial = { x = between(1, 4) }, t = { 0, 1, "1.9", 3, 5 }, n = 200 }
    assert.equal(200, s.failed)
    assert.equal(200, s.one_by_one)
    for _, t in ipairs { 1, 1.9, 3 } do is_inner(math.max(0, 1 - t / 2) ^ 2, (2 - t / 2) ^ 2, s, t) end
  end)

  it("samples a mechanism", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" },
      offset = { 0, around(-1, "1%"), 0 } }
    m:point_mass { at = tip, mass = around(1, "1%") }
    local s = ambit.sample { m, initial = { q = around("0.5", "0.01"), ["q'"] = 0 }, t = { 0, 1 }, n = 100 }
    local run = ambit.simulate { m, initial = { q = around("0.5", "0.01"), ["q'"] = 0 }, t = { 0, 1 } }
    local factor = run:overestimation(s)
    assert.is_nil(factor.contradiction)
    assert.truthy(factor.q >= 1 - 1e-6 and factor.q < 3)
  end)
end)

describe("overestimation", function()
  local x, y = between(0, 1), between(0, 1)

  it("is the ratio of widths, in the shape of the result", function()
    local q = { a = x - x * y, deep = { b = x + y } }
    local seen = ambit.sample { q, n = 200 }
    local proved = ambit.evaluate { q, arithmetic = "interval" }
    local factor = ambit.overestimation(proved, seen)
    assert.truthy(math.abs(factor.a - 2) < 1e-9) -- [-1, 1] for [0, 1]
    assert.truthy(math.abs(factor.deep.b - 1) < 1e-9)
    assert.is_nil(over.contradiction(proved, seen))
  end)

  it("counts only what is sure of the hull's width", function()
    local e = ambit.sqrt(between(0, 1) + 1e16) - 1e8 -- from 0 to 5e-9; doubles there are 1.5e-8 apart
    local seen = ambit.sample { { e } }
    assert.is_nil(ambit.overestimation(ambit.evaluate { { e } }, seen)[1])
    assert.is_nil(over.factor(ambit.interval(0, 1), { lo = 0.5, hi = 0.5, error = 1 }))
    assert.equal(2, over.factor(ambit.interval(0, 1), { lo = 0.25, hi = 0.75, error = 0.25 }))
    assert.is_false(over.misses(ambit.interval(0, 1), { lo = 1.5, hi = 1.5, error = 0.75 }))
    assert.is_true(over.misses(ambit.interval(0, 1), { lo = 1.5, hi = 1.5, error = 0.25 }))
    assert.is_true(over.misses(ambit.interval(0, 1), { lo = 0.5, hi = 1.5, error = 0.75 })) -- made smaller already
    assert.is_false(over.misses(ambit.interval(0, 1), { lo = 0.5, hi = 1.5, error = 0 / 0 }))
  end)

  it("says what it cannot compare", function()
    local seen = ambit.sample { { x } }
    for _, case in ipairs { { 3, seen, "expected what ambit.evaluate .* got number" },
      { { x }, seen, "expected what ambit.evaluate .* at 1, got expression" },
      { ambit.evaluate { { x } }, { 3 }, "expected what ambit.sample made of the same at 1, got number" },
      { ambit.evaluate { x }, nil, "expected what ambit.sample made of the same, got nil" },
      { ambit.evaluate { { x } }, nil, "the sample has nothing at 1" } } do
      local good, message = pcall(ambit.overestimation, case[1], case[2])
      assert.is_false(good)
      assert.truthy(tostring(message):find(case[3]), tostring(message))
    end
  end)

  it("shouts when an enclosure misses what was seen", function()
    local seen = ambit.sample { { a = x + y }, n = 50 }
    local short = { a = ambit.interval(0, 1.999) }
    local text = over.contradiction(short, seen)
    assert.truthy(text:find "a: the enclosure .0, 1%.999.* misses sampled values from 0 to 2")
    assert.is_nil(over.contradiction({ a = ambit.interval(0, 2) }, seen))
  end)

  local o = ambit.ode { states = { "x", "n" }, parameters = { k = between(1, "1.5") },
    equations = function(s, p) return { x = -p.k * s.x, n = 0 } end }
  local function initial() return { x = between(1, 2), n = 1 } end

  it("of a run goes over the common times", function()
    local run = ambit.simulate { o, initial = initial(), t = { 0, 1, 2 }, solver = "lohner" }
    local seen = ambit.sample { o, initial = initial(), t = { 0, 0.123, 1, 2 }, n = 200 }
    local factor = run:overestimation(seen)
    local truth = 2 * math.exp(-2) - math.exp(-3)
    assert.truthy(math.abs(factor.x - run.x.x:width() / truth) < 1e-6)
    assert.is_nil(factor.n) -- a hull without width says nothing
    assert.truthy(factor.max.x >= factor.x and math.abs(factor:at(0).x - 1) < 1e-12)
    assert.equal(2, factor.t)
    assert.is_nil(factor.contradiction)
    assert.is_false(pcall(factor.at, factor, 0.123))
    assert.truthy(tostring(factor):find "^x: %d")
  end)

  it("of a run that is wrong finds the contradiction", function()
    local run = ambit.simulate { o, initial = { x = between(1, "1.5"), n = 1 }, t = { 0, 1 }, solver = "lohner" }
    local seen = ambit.sample { o, initial = initial(), t = { 0, 1 }, n = 50 }
    assert.truthy(run:overestimation(seen).contradiction:find "x at t = 0")
  end)

  it("wants a sample of the same states", function()
    local run = ambit.simulate { o, initial = initial(), t = 1, solver = "lohner" }
    assert.is_false(pcall(run.overestimation, run, {}))
  end)
end)

describe("the inner hull of another verb's request", function()
  local simulate = require "ambit.simulate"
  local o = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
  local function request()
    return simulate.request({ o, initial = { x = between(1, 2) }, t = { 0, 1, 3 }, solver = "lohner" }, "simulate", nil,
      {})
  end

  it("is dense in time, with the request's own times", function()
    local inner = assert(sample.inner(request(), 100, 1))
    assert.truthy(#inner.t >= 51)
    local own = {}
    for k, t in ipairs(inner.t) do
      own[t] = k
      assert.truthy(math.abs(inner.lo[1][k] - math.exp(-t)) <= 2 * inner.error[1][k])
      assert.truthy(math.abs(inner.hi[1][k] - 2 * math.exp(-t)) <= 2 * inner.error[1][k])
    end
    assert.truthy(own[0.0] and own[1.0] and own[3.0])
    assert.equal(100, inner.draws)
    local factor, miss = over.of_inner(inner, 1, own[1.0], ambit.interval("0.3", 2), "x")
    assert.truthy(factor > 1)
    assert.is_nil(miss)
    factor, miss = over.of_inner(inner, 1, own[1.0], ambit.interval("0.4", 2), "x")
    assert.truthy(factor > 1 and miss:find "misses")
  end)

  it("ends with what it has when its budget is used up", function()
    local inner = assert(sample.inner(request(), 10000000, 1, { cpu = 0.05 }))
    assert.equal("stopped", inner.status)
    assert.truthy(inner.draws < 10000000 and inner.hi[1][1] > inner.lo[1][1])
  end)

  it("says why there is none", function()
    local none, reason = sample.inner(simulate.request({ o, initial = { x = between(1, 2) }, t = 1, solver = "lohner" },
      "simulate", nil, {}), 0, 1)
    assert.is_nil(none)
    assert.truthy(reason:find "at least one draw")
  end)
end)
