-- Poincare maps: sets that return to a section, when, and what follows about periodic orbits.
local ambit = require "ambit"

local van_der_pol = ambit.ode {
  states = { "x", "y" }, equations = function(s) return { x = s.y, y = (1 - s.x ^ 2) * s.y - s.x } end,
}
local PERIOD = 6.6632868593231301897 -- of the limit cycle for mu = 1 (Bourke, Mathematical Gazette 1974, and others)

local oscillator = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }

local function refused(part, t)
  local good, message = pcall(ambit.poincare, t)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

local function limit_cycle(radius, more)
  local t = {
    van_der_pol, section = function(s) return s.y end, direction = "falling", t_max = 8, tolerance = 1e-14,
    initial = { x = ambit.around(2.008619860874843, radius), y = 0 },
  }
  for key, value in pairs(more or {}) do t[key] = value end
  return ambit.poincare(t)
end

describe("poincare", function()
  it("chooses a solver that crosses kinks, where the equations have some", function()
    local bilinear = ambit.ode { states = { "x", "v" },
      equations = function(s) return { x = s.v, v = -s.x - ambit.max(s.x, 0) } end }
    local map = ambit.poincare { bilinear, initial = { x = 0, v = ambit.around(1, "1%") }, direction = "rising",
      section = function(s) return s.x end, t_max = 20, returns = 2 }
    assert.equal("complete", map.status)
    for i, found in ipairs(map.returns) do
      local t = i * (math.pi + math.pi / math.sqrt(2)) -- half a swing of each stiffness, whatever the amplitude
      assert.is_true(found.t.lo <= t and t <= found.t.hi and found.t:width() < 1e-2, tostring(found.t))
    end
  end)

  it("proves the limit cycle of Van der Pol and encloses its period", function()
    for _, radius in ipairs { 1e-3, 1e-6, 1e-11 } do
      local map = limit_cycle(radius)
      assert.equal("complete", map.status)
      local orbit = map:orbit()
      assert.is_true(orbit.proved)
      assert.is_true(orbit.period:contains(PERIOD))
      assert.is_true(orbit.period:width() < 4 * radius)
      assert.is_true(orbit.x.x:contains(2.0086198608748431365))
      assert.is_true(map.returns[1].certain)
      assert.equal("falling", map.returns[1].direction)
    end
  end)

  it("proves that it attracts, and bounds its multiplier", function()
    -- of the periodic orbit: exp of the integral of 1 - x^2, by Runge and Kutta's steps
    local x, y, sum, n = 2.008619860874843, 0, 0, 20000
    local h = PERIOD / n
    local function f(a, b) return b, (1 - a * a) * b - a end
    for _ = 1, n do
      local a1, b1 = f(x, y)
      local a2, b2 = f(x + h / 2 * a1, y + h / 2 * b1)
      local a3, b3 = f(x + h / 2 * a2, y + h / 2 * b2)
      local a4, b4 = f(x + h * a3, y + h * b3)
      local before = 1 - x * x
      local middle = x + h / 4 * (a1 + a2)
      x, y = x + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4), y + h / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
      sum = sum + h / 6 * (before + 4 * (1 - middle * middle) + 1 - x * x)
    end
    local multiplier = math.exp(sum)
    for _, radius in ipairs { 1e-2, 1e-4, 1e-6 } do
      local orbit = limit_cycle(radius):orbit()
      assert.is_true(orbit.proved and orbit.attracting, orbit.reason)
      local found = orbit.derivative.x.x
      assert.is_true(found.lo - 1e-8 <= multiplier and multiplier <= found.hi + 1e-8, tostring(found))
      assert.is_true(orbit.multiplier < (radius < 1e-3 and 1.2 * multiplier or 0.5))
    end
  end)

  it("knows multipliers in closed form, for all data, and orbits that attract nothing", function()
    local a = ambit.around("0.05", "1%", "a")
    local function circle(rate, box)
      local system = ambit.ode { states = { "x", "y", "z" }, equations = function(s)
        local r = s.x ^ 2 + s.y ^ 2
        return { x = rate(r) * s.x - s.y, y = rate(r) * s.y + s.x, z = "-0.1" * s.z + "0.3" * (r - 1) }
      end }
      return ambit.poincare { system, section = function(s) return s.y end, direction = "rising", t_max = 8,
        initial = { x = ambit.around(1, box), y = 0, z = ambit.around(0, 8 * box) } }
    end
    local orbit = circle(function(r) return a * (1 - r) end, 1e-4):orbit()
    assert.is_true(orbit.proved and orbit.attracting, orbit.reason)
    local d = orbit.derivative
    for _, value in ipairs { 0.0495, 0.05, 0.0505 } do assert.is_true(d.x.x:contains(math.exp(-4 * math.pi * value))) end
    assert.is_true(d.x.x:width() < 0.02)
    local slow = math.exp(-0.2 * math.pi)
    assert.is_true(d.z.z.lo <= slow + 1e-12 and slow - 1e-12 <= d.z.z.hi and d.z.z:width() < 0.01)
    assert.is_true(d.x.z:mag() < 1e-9)
    assert.is_true(orbit.multiplier > slow * (1 - 1e-9) and orbit.multiplier < 1)
    -- on a section along which solutions move as well
    local oblique = ambit.poincare { ambit.ode { states = { "x", "y" }, equations = function(s)
      local r = s.x ^ 2 + s.y ^ 2
      return { x = a * (1 - r) * s.x - s.y, y = a * (1 - r) * s.y + s.x }
    end }, section = function(s) return s.x - "0.5" end, direction = "falling", t_max = 8,
      initial = { x = "0.5", y = ambit.around(math.sqrt(0.75), 1e-4) } }:orbit()
    assert.is_true(oblique.attracting, oblique.reason)
    assert.is_true(oblique.derivative.y.y:contains(math.exp(-0.2 * math.pi)))
    assert.is_true(oblique.derivative.y.y:width() < 0.02)
    -- one that repels is not proved at all; nor does its map contract
    local repelling = circle(function(r) return a * (r - 1) end, 1e-4)
    assert.is_false(repelling:orbit().proved)
    local judged = require "ambit.poincare.attract".judge(repelling, 2)
    assert.is_false(judged.attracting)
    assert.is_true(judged.derivative.x.x:contains(math.exp(0.2 * math.pi)) and judged.multiplier > 1)
  end)

  it("does not prove an orbit that is not there", function()
    local map = limit_cycle(1e-3, { initial = { x = ambit.around(2.1, 1e-3), y = 0 } })
    assert.equal("complete", map.status)
    local orbit = map:orbit()
    assert.is_false(orbit.proved)
    assert.is_truthy(orbit.reason:find "not inside")
    local off = limit_cycle(1e-3, { initial = { x = ambit.around(2.0086, 1e-3), y = "0.01" } }):orbit()
    assert.is_false(off.proved)
    local same = ambit.around(2.0086, 1e-3)
    local tied = limit_cycle(1e-3, { initial = { x = same, y = same - same } }):orbit()
    assert.is_true(tied.proved or tied.reason ~= nil)
  end)

  it("follows several returns without losing what the states have in common", function()
    local map = ambit.poincare {
      oscillator, section = function(s) return s.v end, direction = "rising", returns = 4, t_max = 30,
      initial = { x = ambit.between("-1.0001", -1), v = 0 },
    }
    assert.equal(4, #map.returns)
    for i, r in ipairs(map.returns) do
      assert.is_true(r.t.lo <= 2 * math.pi * i + 1e-14 and 2 * math.pi * i - 1e-14 <= r.t.hi)
      assert.is_true(r.t:width() < 1e-6)
      assert.is_true(r.x.x.lo <= -1.0001 and -1 <= r.x.x.hi and r.x.x:width() < 1.1e-4)
      assert.is_true(r.x.v:contains(0) and r.x.v:width() < 1e-7)
    end
  end)

  it("cuts steps where a wide set leaves a crossing undecided", function()
    local map = ambit.poincare {
      oscillator, section = function(s) return s.v end, direction = "rising", t_max = 8,
      initial = { x = ambit.between(-2, -1), v = 0 },
    }
    assert.equal("complete", map.status)
    assert.is_true(map.returns[1].t:contains(2 * math.pi) and map.returns[1].t:width() < 0.1)
    assert.is_true(map.returns[1].x.x.lo <= -2 and -1 <= map.returns[1].x.x.hi and map.returns[1].x.x:width() < 1.1)
  end)

  it("is sharp for wide sets with a solver of high order in the data", function()
    local map = ambit.poincare {
      oscillator, section = function(s) return s.v end, direction = "rising", t_max = 8, solver = "taylor_model",
      initial = { x = ambit.between("-1.5", -1), v = 0 },
    }
    assert.equal("complete", map.status)
    assert.is_true(map.returns[1].t:contains(2 * math.pi) and map.returns[1].t:width() < 1e-5)
    assert.is_true(map.returns[1].x.x.lo <= -1.5 and -1 <= map.returns[1].x.x.hi)
    assert.is_true(map.returns[1].x.x:width() < 0.501)
  end)

  it("knows systems and sections that depend on time", function()
    local forced = ambit.ode { states = { "x" }, equations = function(_, _, t) return { x = ambit.cos(t) } end }
    local map = ambit.poincare {
      forced, section = function(s, _, t) return 2 * s.x - 1 + 0 * t end, returns = 3, t_max = 10, initial = { x = 0 },
    }
    for i, k in ipairs { 1, 5, 13 } do
      local t = k * math.pi / 6
      assert.is_true(map.returns[i].t.lo <= t + 1e-14 and t - 1e-14 <= map.returns[i].t.hi)
      assert.is_true(map.returns[i].t:width() < 1e-10)
    end
    assert.is_truthy(map:orbit().reason:find "depends on time")
    local later = ambit.poincare { forced, section = function(s) return 2 * s.x - 1 end, t_start = math.pi, t_max = 10,
      initial = { x = 0 } }
    assert.is_true(math.abs(later.returns[1].t:mid() - 13 * math.pi / 6) < 1e-12)
  end)

  it("follows a section that moves, of a system that does not depend on time", function()
    -- x = cos t, v = -sin t: g = (sin t - t / 200) / 5
    local map = ambit.poincare {
      oscillator, section = function(s, _, t) return ambit.sin(t) / 10 - s.v / 10 - t / 1000 end, direction = "rising",
      returns = 3, t_start = 1, t_max = 30, initial = { x = math.cos(1), v = -math.sin(1) },
    }
    assert.equal(3, #map.returns)
    for k, r in ipairs(map.returns) do
      local t = 2 * math.pi * k
      for _ = 1, 50 do t = 2 * math.pi * k + math.asin(t / 200) end
      assert.is_true(r.t.lo <= t + 1e-12 and t - 1e-12 <= r.t.hi)
      assert.is_true(r.t:width() < 1e-9)
    end
  end)

  it("keeps unknowns of next to no width", function()
    local forced = ambit.ode { states = { "x", "v" }, equations = function(s, _, t)
      return { x = s.v, v = -2.16 * s.x - 0.227 * s.v + 0.1 * s.x ^ 2 + 0.072 * ambit.cos(2.877 * t) } end }
    local map = ambit.poincare {
      forced, section = function(s, _, t) return s.v - 0.1 * s.x ^ 2 + 0.02 * ambit.sin(t) end, returns = 3,
      t_max = 25, initial = { x = 0.567, v = 0 },
    }
    assert.equal("complete", map.status)
    for _, r in ipairs(map.returns) do assert.is_true(r.t:width() < 1e-8) end
  end)

  it("proves no orbit where constraints leave no box of states", function()
    local m = ambit.mechanism { "strut", gravity = { 0, "-9.81", 0 } }
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
    m:point_mass { at = tip, mass = 2 }
    local post = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "r" }, offset = { 0, 1, 0 } }
    m:point_mass { at = post, mass = 1 }
    m:close_distance { a = post, b = tip, length = ambit.sqrt(2) }
    local map = ambit.poincare { m:dynamics(), section = m:position(tip).x, t_max = "0.1",
      initial = { q = 0, r = 0, ["q'"] = 0 } }
    assert.is_truthy(map:orbit().reason:find "constraints")
  end)

  it("says which return it cannot prove", function()
    local graze = ambit.poincare { oscillator, section = function(s) return s.x + 1 end, initial = { x = 1, v = 0 },
      t_max = 5 }
    assert.equal("unable", graze.status)
    assert.is_truthy(graze.reason:find "return 1: event `section` in t = .*graze")
    local late = ambit.poincare { oscillator, section = function(s) return s.v end, direction = "rising", returns = 2,
      initial = { x = -1, v = 0 }, t_max = 10 }
    assert.equal("unable", late.status)
    assert.equal(1, #late.returns)
    assert.is_truthy(late.reason:find "return 2: some solutions do not return")
  end)

  it("gives the image as a set to go on from", function()
    local map = limit_cycle(1e-6)
    local next_one = ambit.poincare { van_der_pol, section = function(s) return s.y end, direction = "falling",
      t_max = 8, initial = map:set(), tolerance = 1e-14 }
    assert.is_true(next_one.returns[1].t:contains(PERIOD))
    assert.is_true(next_one.returns[1].x.x:width() < map.returns[1].x.x:width())
  end)

  it("refuses what it cannot use", function()
    local function section(s) return s.v end
    refused("t_max is missing", { oscillator, section = section, initial = { x = 1, v = 0 } })
    refused("section: expected a formula", { oscillator, initial = { x = 1, v = 0 }, t_max = 1 })
    refused("did you mean `t_max`", { oscillator, section = section, initial = { x = 1, v = 0 }, t = 1, t_max = 1 })
    refused("later than the start", { oscillator, section = section, initial = { x = 1, v = 0 }, t_max = -1 })
    refused("returns: expected a positive integer", { oscillator, section = section, initial = { x = 1, v = 0 },
      t_max = 1, returns = 0 })
  end)
end)
