-- The criterion `bounds` where nothing is uncertain: each range is one number, and two runs are the proof. Against the
-- closed form of a stiff chain; how many runs there are; whose option `nodes` is.
local ambit = require "ambit"
local core = require "ambit.core"

local exp, abs, max = math.exp, math.abs, math.max

local fast, loss = 400, 2 ^ -10 -- exact in binary; references of stiffer chains are by methods of GSL that allocate

-- a decays and drives b, which follows 400 times faster; c collects b and drives nothing
local function chain(decay)
  return ambit.ode { states = { "a", "b", "c" }, equations = function(s)
    return { a = -s.a - decay * s.a, b = fast * (s.a - s.b), c = s.b }
  end }
end

local start = { a = 1, b = 0, c = 0 }

-- b(t) for the whole decay rate k of a, and its integral
local function b_of(k, t) return fast / (fast - k) * (exp(-k * t) - exp(-fast * t)) end
local function c_of(k, t) return fast / (fast - k) * ((1 - exp(-k * t)) / k - (1 - exp(-fast * t)) / fast) end

-- max over n + 1 nodes of [0, 2] of how far f is off without the loss
local function deviation(f, n)
  local most, at = 0, 0
  for j = 0, n do
    local t = 2 * j / n
    local d = abs(f(1 + loss, t) - f(1, t))
    if d > most then most, at = d, t end
  end
  return most, at
end

local function certify(t)
  local q = { chain(loss), chain(0), t = { 0, 2 }, initial = start, outputs = { "b", "c" }, criterion = "bounds",
    solver = "stiff", nodes = 8 }
  for key, value in pairs(t) do q[key] = value end
  return ambit.certify(q)
end

local function assert_close(proved, truth)
  assert.is_true(proved >= truth * (1 - 1e-10))
  assert.is_true(proved <= truth * (1 + 1e-5))
end

-- The rigorous runs that work() makes.
local function runs_of(work)
  local simulate, count = core.simulate, 0
  core.simulate = function(flow, ...)
    if flow.solver ~= "gsl" then count = count + 1 end
    return simulate(flow, ...)
  end
  local good, result = pcall(work)
  core.simulate = simulate
  if not good then error(result, 0) end
  return count, result
end

describe("bounds of models without uncertain data", function()
  it("are the deviation at the nodes", function()
    for _, solver in ipairs { "stiff", "lohner" } do
      local r = certify { solver = solver, t = { 0, 2 }, tolerance = 1e-12 }
      local b, at = deviation(b_of, 8)
      assert.equal("proved", r.status)
      assert_close(r.error.b, b)
      assert_close(r.error.c, (deviation(c_of, 8)))
      assert.is_true(abs(r.when.b - at) < 1e-12)
    end
  end)

  it("do not hold for less than the truth", function()
    local truth = deviation(b_of, 8)
    assert.equal("proved", certify { error = { b = 1.001 * truth } }.status)
    local spoilt = certify { error = { b = 0.999 * truth } }
    assert.equal("exceeded", spoilt.status)
    assert.is_true(spoilt.error.b > 0.999 * truth)
  end)

  it("follow the signs and start of the reduced model, too", function()
    local other = ambit.ode { states = { "b" }, equations = function(s, _, t) return { b = 0 * t - s.b } end }
    local r = ambit.certify { chain(0), other, t = { 0, 1 }, initial = start, outputs = { "b" }, criterion = "bounds",
      solver = "stiff", nodes = 4 }
    local most = 0
    for j = 1, 4 do most = max(most, b_of(1, j / 4)) end -- the reduced b stays 0
    assert_close(r.error.b, most)
  end)

  it("cost two runs, and the detailed model one run for all proofs", function()
    assert.equal(2, (runs_of(function() return certify {} end)))
    local leak = 2 ^ -10
    local leaking = ambit.ode { states = { "a", "b", "c" }, equations = function(s)
      return { a = -s.a, b = fast * (s.a - s.b), c = s.b - leak * s.c }
    end }
    local runs, small = runs_of(function()
      return ambit.reduce { leaking, t = { 0, 2 }, initial = start, outputs = { "b", "c" },
        error = { b = "2e-3", c = "2e-3" }, criterion = "bounds", solver = "stiff", nodes = 8,
        reductions = { "neglect" }, levels = 1 }
    end)
    assert.equal("complete", small.status)
    assert.equal(small.terms_before - 1, small.terms_after)
    assert.is_true(small.proofs > 2)
    assert.equal(1 + small.proofs, runs)
    local truth = 0
    for j = 1, 8 do
      local t = j / 4
      local c = fast / (fast - 1) * ((exp(-t) - exp(-leak * t)) / (leak - 1)
        - (exp(-fast * t) - exp(-leak * t)) / (leak - fast))
      truth = max(truth, abs(c - c_of(1, t)))
    end
    assert_close(small.error.c, truth)
    assert.is_true(small.error.b < 1e-9)
  end)

  it("are asked for at `nodes` that are not those of the solver `stiff`", function()
    assert_close(certify { nodes = 2 }.error.b, (deviation(b_of, 2)))   -- stiff wants 4 to 20 of its own
    assert_close(certify { nodes = 64 }.error.b, (deviation(b_of, 64)))
  end)
end)
