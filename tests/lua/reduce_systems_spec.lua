-- reduce_systems_spec.lua -- systems of the scenes in small, and solver work that they need: states that start from
-- zero and are far from what moves them, stiff systems of more than 32 states, states of very different size.
local ambit = require "ambit"
local number, around = ambit.number, ambit.around

-- A line of stages driven at its start: v_k' = v_(k-1) - 2 v_k + v_(k+1), amplitude known to 10 %.
local function ladder(stages, amplitude, parasite)
  local states, initial = {}, {}
  for k = 1, stages do
    states[k] = "v" .. k
    initial["v" .. k] = 0
  end
  local function equations(s, _, t)
    local rates = {}
    for k = 1, stages do
      local before = k == 1 and amplitude * ambit.sin(t / 2) or s["v" .. k - 1]
      local after = k < stages and s["v" .. k + 1] or 0
      rates["v" .. k] = before - 2 * s["v" .. k] + after - (parasite and number(parasite) or 0)
    end
    return rates
  end
  return ambit.ode { states = states, equations = equations }, initial
end

-- The same in ordinary doubles, by the classical Runge-Kutta method with small steps: everything that was kept.
local function follow(stages, amplitude, parasite, T, steps)
  local function rates(v, t)
    local r = {}
    for k = 1, stages do
      local before = k == 1 and amplitude * math.sin(t / 2) or v[k - 1]
      r[k] = before - 2 * v[k] + (v[k + 1] or 0) - parasite
    end
    return r
  end
  local function shifted(v, h, r)
    local w = {}
    for k = 1, stages do w[k] = v[k] + h * r[k] end
    return w
  end
  local v, h, all = {}, T / steps, {}
  for k = 1, stages do v[k] = 0 end
  for n = 0, steps - 1 do
    local t = n * h
    all[n] = v
    local a = rates(v, t)
    local b = rates(shifted(v, h / 2, a), t + h / 2)
    local c = rates(shifted(v, h / 2, b), t + h / 2)
    local d = rates(shifted(v, h, c), t + h)
    local w = {}
    for k = 1, stages do w[k] = v[k] + h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]) end
    v = w
  end
  all[steps] = v
  return all
end

describe("a line that starts at rest", function()
  it("is followed to its far end, with an uncertain source", function()
    local ode, initial = ladder(40, around(1, "10%"))
    local run = ambit.simulate { ode, initial = initial, t = { 0, 5 }, solver = "lohner" }
    assert.equal("complete", run.status)
    for _, amplitude in ipairs { 0.9, 0.97, 1.1 } do
      local last = follow(40, amplitude, 0, 5, 1000)[1000]
      for _, k in ipairs { 1, 2, 5, 20, 40 } do
        local x = run.x["v" .. k]
        assert.is_true(x.lo - 1e-11 <= last[k] and last[k] <= x.hi + 1e-11, "v" .. k)
      end
    end
    local v5 = follow(40, 0.1, 0, 5, 1000)[1000][5] -- linear: the true half width
    assert.is_true(run.x.v5:width() < 2.02 * v5)
  end)
end)

describe("a ladder's reduction", function()
  local amplitude = around(1, "10%")

  it("is proved within twice its sampled error", function()
    local ode, initial = ladder(8, amplitude, "1e-5")
    local small = ambit.reduce { ode, t = { 0, 3 }, initial = initial, outputs = { "v1" }, error = { v1 = "1e-2" },
      reductions = { "neglect" }, levels = 0 }
    assert.equal("complete", small.status)
    local kept, most = 0, 0
    for _, name in ipairs(small.ode.states) do
      if tostring(small.ode:rate(name)) ~= "0" then kept = kept + 1 end
    end
    assert.is_true(kept < 8 and kept >= 1)
    for _, a in ipairs { 0.9, 1, 1.1 } do
      local full, cut = follow(8, a, 1e-5, 3, 600), follow(kept, a, 1e-5, 3, 600)
      for n = 0, 600 do most = math.max(most, math.abs(full[n][1] - cut[n][1])) end
    end
    assert.is_true(small.error.v1 >= most - 1e-12 and small.error.v1 <= 2 * most, small.error.v1 .. " " .. most)
    assert.is_true(small.error.v1 <= 1e-2)
  end)
end)

describe("an error that begins with a high power of time", function()
  it("is followed from rest", function()
    -- y'' = -y + (z')^2 with z = 1 - cos t from rest: without the square y stays what it is, with it y starts like t^4
    local states = { "y", "u", "z", "w" }
    local function pendulum(factor)
      return ambit.ode { states = states, equations = function(s)
        return { y = s.u, u = -s.y + factor * s.w ^ 2, z = s.w, w = 1 - s.z }
      end }
    end
    local proof = ambit.certify { pendulum(1), pendulum(0), t = { 0, 3 }, initial = { y = around("0.1", "1%"), u = 0,
      z = 0, w = 0 }, outputs = { "y" } }
    assert.equal("proved", proof.status)
    local most = 0 -- y' ' = -y + sin^2 t from rest: y = 1/2 + cos(2t)/6 - 2/3 cos t
    for n = 0, 3000 do
      local t = n / 1000
      most = math.max(most, math.abs(1 / 2 + math.cos(2 * t) / 6 - 2 / 3 * math.cos(t)))
    end
    assert.is_true(proof.error.y >= most - 1e-12 and proof.error.y <= 1.01 * most, proof.error.y .. " " .. most)
  end)
end)

describe("stiff systems", function()
  it("may have more than 32 states", function()
    local n = 33
    local states, initial = {}, {}
    for k = 1, n do
      states[k] = "x" .. k
      initial["x" .. k] = 1
    end
    local rate = function(k) return 1 + 3 * (k - 1) end -- all follow the first
    local ode = ambit.ode { states = states, equations = function(s)
      local rates = { x1 = -s.x1 }
      for k = 2, n do rates["x" .. k] = rate(k) * (s.x1 - s["x" .. k]) end
      return rates
    end }
    local run = ambit.simulate { ode, initial = initial, t = { 0, number "0.02" }, solver = "stiff", tolerance = 1e-8 }
    assert.equal("complete", run.status)
    local slow, fast, share = math.exp(-0.02), math.exp(-0.08), 4 / 3 -- x2' = 4 (x1 - x2)
    local x2 = (1 - share) * fast + share * slow
    assert.is_true(run.x.x1:contains(slow) and run.x.x1:width() < 1e-6)
    assert.is_true(run.x.x2:contains(x2) and run.x.x2:width() < 1e-6)
  end)

  it("may start with states that are small by fifty orders", function()
    -- each is made of the one before, which starts at zero: x_k is about t^k / k!
    local ode = ambit.ode { states = { "a", "b", "c", "d", "e" }, equations = function(s)
      local a, b, c, d = s.a, s.b, s.c, s.d
      return { a = 1 - 1e9 * a, b = 1e-3 * a - b, c = 1e-9 * b * a, d = 1e-9 * c * b, e = 1e-9 * d * c }
    end }
    local run = ambit.simulate { ode, initial = { 0, 0, 0, 0, 0 }, t = { 0, 1 }, solver = "stiff", tolerance = 1e-8 }
    assert.equal("complete", run.status)
    local a, b = 1e-9, 1e-12 * (1 - math.exp(-1)) -- to 1e-9
    assert.is_true(math.abs(run.x.a:mid() / a - 1) < 1e-7 and math.abs(run.x.b:mid() / b - 1) < 1e-7)
    assert.is_true(run.x.e.lo >= -1e-60 and run.x.e.hi < 1e-60)
  end)
end)
