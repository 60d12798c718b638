-- Everything that stands on a flow, with the solver `zonotope`: each answer is compared with a formula, not with
-- another solver of Ambit.
local ambit = require "ambit"
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

  it("tells sensitivities", function()
    local r = ambit.sensitivity(question { t = { 0, 1 } })
    assert.is_not_nil(r)
  end)

  it("says why it ends, and where the width comes from", function()
    local run = ambit.simulate { ambit.ode { states = { "x" }, equations = function(s) return { x = s.x * s.x } end },
      initial = { x = between("0.9", "1.1") }, t = 2, solver = "zonotope" }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached > 0.6 and run.t_reached < 1 / 1.1)
    assert.matches("t = ", run.reason)
    local kink = ambit.simulate { ambit.ode { states = { "x" }, equations = function(s) return { x = -ambit.abs(s.x) - 1 } end },
      initial = { x = between("0.9", "1.1") }, t = 2, solver = "zonotope" }
    assert.equal("unable.kink", kink.code)
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
end)
