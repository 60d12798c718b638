-- ambit.roots and ambit.equilibria: every root, proved, or an honest word.
local ambit = require "ambit"

local function refused(part, t, verb)
  local good, message = pcall(verb or ambit.roots, t)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

describe("roots", function()
  it("finds all roots of polynomials with integer roots", function()
    local r = ambit.roots {
      function(s) return (s.x + 7) * (s.x - 1) * (s.x - 2) * (s.x - 3) * (s.x - 40) end,
      box = { x = { -math.huge, math.huge } },
    }
    assert.equal("complete", r.status)
    assert.equal("", r.reason)
    local expected = { -7, 1, 2, 3, 40 }
    assert.equal(#expected, #r.proved)
    for i, x in ipairs(expected) do
      assert.is_true(r.proved[i].x:contains(x))
      assert.is_true(r.proved[i].x:width() < 1e-13)
      assert.is_true(r.proved[i].inside)
    end
    assert.is_true(r.boxes > 0 and r.cpu_seconds >= 0 and r.rigorous)
  end)

  it("is about an ulp wide for point data", function()
    local r = ambit.roots { function(s) return s.x ^ 2 - 2 end, box = { x = { 1, 2 } } }
    assert.is_true(r.proved[1].x:width() <= 4.5e-16)
    assert.is_true((r.proved[1].x ^ 2):contains(2))
  end)

  -- digits by mpmath.findroot with 30 digits
  it("agrees with other people's digits", function()
    local omega = ambit.roots { function(s) return s.x * ambit.exp(s.x) - 1 end, box = { x = { -10, 10 } } }
    assert.is_true(omega.proved[1].x:contains(0.56714329040978387300))
    local dottie = ambit.roots { function(s) return ambit.cos(s.x) - s.x end, box = { x = { -100, 100 } } }
    assert.equal(1, #dottie.proved)
    assert.is_true(dottie.proved[1].x:contains(0.73908513321516064166))
    local pair = ambit.roots {
      function(s) return { s.x ^ 2 + s.y ^ 2 - 4, ambit.exp(s.x) - s.y - 2 } end,
      box = { x = { -3, 3 }, y = { -3, 3 } },
    }
    assert.equal(2, #pair.proved)
    assert.is_true(pair.proved[1].x:contains(-1.1032253126626885) and pair.proved[1].y:contains(-1.6682008001137972))
    assert.is_true(pair.proved[2].x:contains(1.2663816528256687) and pair.proved[2].y:contains(1.5479914435766522))
    for _, p in ipairs(pair.proved) do
      local check = ambit.evaluate { p.x ^ 2 + p.y ^ 2 - 4, ambit.exp(p.x) - p.y - 2 }
      assert.is_true(check[1]:contains(0) and check[2]:contains(0))
    end
  end)

  it("counts the roots of a sine, pi in its enclosures", function()
    local r = ambit.roots { function(s) return ambit.sin(s.x) end, box = { x = { -20, 20 } } }
    assert.equal(13, #r.proved)
    local pi = ambit.evaluate { ambit.pi }
    assert.is_true(r.proved[8].x.lo <= pi.lo and r.proved[8].x.hi >= pi.hi)
  end)

  it("takes roots on the edge, and tells when an enclosure reaches out", function()
    local r = ambit.roots { function(s) return s.x ^ 2 - 2 end, box = { x = { 0, math.sqrt(2) } } }
    assert.equal("complete", r.status)
    for _, p in ipairs(r.proved) do assert.equal(p.x.hi <= math.sqrt(2), p.inside) end
    for _, root in ipairs { "0.10000000000000000000001", "0.1" } do -- behind the end that is text, and at it
      local edge = ambit.roots { function(s) return s.x - root end, box = { x = { 0, "0.1" } } }
      assert.is_true(#edge.proved == 1 and not edge.proved[1].inside)
    end
    assert.is_true(ambit.roots({ function(s) return s.x - "0.0999" end, box = { x = { 0, "0.1" } } }).proved[1].inside)
    local zero = ambit.roots { function(s) return s.x * (s.x - 1) end, box = { x = { 0, 1 } } }
    assert.equal(2, #zero.proved)
    local none = ambit.roots { function(s) return s.x * (s.x - 1) end, box = { x = { "0.001", "0.999" } } }
    assert.equal("complete", none.status)
    assert.equal(0, #none.proved + #none.undecided)
  end)

  it("cuts an unknown without bounds, whatever the others are", function()
    local line = { -math.huge, math.huge }
    local function system(s) return { s.x - 0.5, (s.y - 1) * (s.y - 3) * (s.y + 5) - s.x } end
    for _, x in ipairs { { 0, 1 }, line } do
      local r = ambit.roots { system, box = { x = x, y = line } }
      assert.equal("complete", r.status)
      assert.equal(3, #r.proved)
    end
    local far = ambit.roots {
      function(s) return { s.x ^ 2 - s.y, s.y ^ 2 - 2 * s.x } end, box = { x = line, y = line },
    }
    assert.equal(2, #far.proved)
    assert.equal("unable", far.status) -- of numbers beyond the largest double nothing is known
    assert.is_truthy(far.reason:find("reach out to infinity", 1, true))
  end)

  it("is honest about double roots and about curves of roots", function()
    local double = ambit.roots { function(s) return s.x ^ 2 - 2 * s.x + 1 end, box = { x = { -9, 9 } } }
    assert.equal("unable", double.status)
    assert.equal(0, #double.proved)
    local covered = false
    for _, p in ipairs(double.undecided) do covered = covered or p.x:contains(1) end
    assert.is_true(covered)
    assert.is_truthy(double.reason:find("tolerance", 1, true))
    local curve = ambit.roots {
      function(s) return { s.x + s.y, 3 * s.x + 3 * s.y } end, box = { x = { -1, 1 }, y = { -1, 1 } }, boxes_max = 200,
    }
    assert.equal("unable", curve.status)
    assert.equal(0, #curve.proved)
    assert.is_truthy(curve.reason:find("boxes_max", 1, true))
  end)

  it("stays inside the domain of logarithms, roots and quotients", function()
    local log = ambit.roots { function(s) return ambit.log(s.x) + s.x end, box = { x = { -5, 5 } } }
    assert.equal(1, #log.proved)
    local root = ambit.roots { function(s) return ambit.sqrt(s.x) - 2 end, box = { x = { -5, 5 } } }
    assert.equal("complete", root.status)
    assert.is_true(root.proved[1].x:contains(4))
    local pole = ambit.roots { function(s) return 1 / s.x - s.x end, box = { x = { -5, 5 } } }
    assert.equal(2, #pole.proved)
    local never = ambit.roots { function(s) return 1 / s.x end, box = { x = { -5, 5 } } }
    assert.equal("complete", never.status)
    assert.equal(0, #never.proved)
  end)

  it("proves roots for every value of uncertain data", function()
    local l = { ambit.around(1, "1%"), ambit.around("0.8", "1%"), ambit.around("0.5", "1%") }
    local r = ambit.roots {
      function(s)
        local a, b, c = s.a, s.a + s.b, s.a + s.b + s.c
        return {
          l[1] * ambit.cos(a) + l[2] * ambit.cos(b) + l[3] * ambit.cos(c) - 1.2,
          l[1] * ambit.sin(a) + l[2] * ambit.sin(b) + l[3] * ambit.sin(c) - 0.9,
          c - 1,
        }
      end,
      box = { a = { -3, 3 }, b = { -3, 3 }, c = { -6, 6 } },
    }
    assert.equal("complete", r.status)
    assert.equal(2, #r.proved)
    local x, y = 1.2 - 0.5 * math.cos(1), 0.9 - 0.5 * math.sin(1)
    for i, sign in ipairs { 1, -1 } do -- the two elbows of the nominal arm, in closed form
      local elbow = sign * math.acos((x * x + y * y - 1 - 0.64) / 1.6)
      local shoulder = math.atan(y, x) - math.atan(0.8 * math.sin(elbow), 1 + 0.8 * math.cos(elbow))
      assert.is_true(r.proved[i].a:contains(shoulder) and r.proved[i].b:contains(elbow))
      assert.is_true(r.proved[i].a:width() < 0.06)
    end
    local wide = ambit.roots { function(s) return s.x - ambit.between(-2, 2) end, box = { x = { -1, 1 } } }
    assert.equal(1, #wide.proved)
    assert.is_false(wide.proved[1].inside)
    assert.equal("partial", wide.status) -- for some data no root is in the box
    assert.equal("unable.partial", wide.code)
    assert.is_true(wide.proved[1].x:contains(2) and wide.proved[1].x:contains(-2))
  end)

  it("solves in any order of the box and with values from `at`", function()
    local m = ambit.mechanism "arm"
    local tip = m:rigid_link {
      from = m:revolute { from = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" },
        offset = { 1, 0, 0 } }, axis = "z", name = "b" }, offset = { 1, 0, 0 },
    }
    local r = ambit.roots { { m:position(tip).x - 1, m:position(tip).y - 1 }, box = { b = { 0, 3 }, a = { -2, 2 } } }
    assert.equal(1, #r.proved)
    assert.is_true(r.proved[1].b:contains(math.pi / 2))
    local one = ambit.roots { m:position(tip).x - 1, box = { b = { 0, 3 } }, at = { a = 0 } }
    assert.is_true(one.proved[1].b:contains(math.pi / 2))
    local at = ambit.evaluate { m:position(tip), at = r.proved[1] }
    assert.is_true(at.x:contains(1) and at.y:contains(1))
  end)

  it("uses equations beyond the unknowns to exclude, and does not pretend that they hold", function()
    local box = { x = { -3, 3 } }
    local none = ambit.roots { function(s) return { s.x ^ 2 - 1, s.x ^ 3 - 2 } end, box = box }
    assert.equal("complete", none.status)
    assert.equal(0, #none.proved)
    local maybe = ambit.roots { function(s) return { s.x ^ 2 - 1, s.x ^ 3 - 1 } end, box = box }
    assert.equal("unable", maybe.status)
    assert.equal(1, #maybe.undecided)
    assert.is_true(maybe.undecided[1].x:contains(1))
    assert.is_truthy(maybe.reason:find("more equations than unknowns", 1, true))
  end)

  it("writes itself down", function()
    local text = tostring(ambit.roots { function(s) return s.x - 1 end, box = { x = { 0, 3 } } })
    assert.is_truthy(text:find("complete: 1 root proved, 0 boxes undecided\n  x = 1", 1, true))
  end)

  it("explains bad requests", function()
    local function x(s) return s.x end
    local unit = { 0, 1 }
    refused("expected a table", 3)
    refused("box is missing", { x })
    refused("expected an expression", { box = { x = unit } })
    refused("did you mean `x`", { function(s) return s.y end, box = { x = unit } })
    refused("range is empty: 1 is greater than 0", { x, box = { x = { 1, 0 } } })
    refused("expected { lo, hi }", { x, box = { x = { 1 } } })
    refused("NaN", { x, box = { x = { 0, 0 / 0 } } })
    refused("box.x: interval: the interval is empty", { x, box = { x = { math.huge, math.huge } } })
    refused('box.x: interval: "abc" is no number', { x, box = { x = "abc" } })
    refused("the box is empty: `x`", { x, box = { x = "[empty]" } })
    refused("not uncertain", { x, box = { x = { 0, ambit.between(1, 2) } } })
    refused("no equation depends on `y`", { x, box = { x = unit, y = unit } })
    refused("1 equation cannot fix 2 unknowns", { function(s) return s.x + s.y end, box = { x = unit, y = unit } })
    refused("there is no variable `q`", { x, box = { x = unit }, at = { q = 1 } })
    refused("in `box` and in `at`", { x, box = { x = unit }, at = { x = 1 } })
    refused("unknown key `tolerence`; did you mean `tolerance`?", { x, box = { x = unit }, tolerence = 1 })
    refused("it does not find roots", { x, box = { x = unit }, solver = "lohner" })
    refused("does not work with arithmetic `real`", { x, box = { x = unit }, arithmetic = "real" })
    refused("`boxes_max` must be", { x, box = { x = unit }, boxes_max = 0 })
    refused("has no derivative", { function(s) return ambit.abs(s.x) end, box = { x = unit } })
    refused("`v` has no value", {
      { ambit.ode { states = { "v", "w" }, equations = function(s) return { s.w, s.v + s.w } end }:rate "w" },
      box = { w = unit },
    })
    refused("finds roots; it does not advance in time", {
      ambit.ode { states = { "x" }, equations = function(s) return { -s.x } end }, initial = { x = 1 }, t = 1,
      solver = "krawczyk",
    }, ambit.simulate)
  end)
end)

describe("equilibria", function()
  it("proves the four of the double pendulum", function()
    local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
    local shoulder = m:revolute { from = m.world, axis = "z", name = "beta1" }
    local elbow = m:rigid_link { from = shoulder, offset = { 0, -1, 0 } }
    local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
    m:point_mass { at = elbow, mass = 1 }
    m:point_mass { at = hand, mass = 1 }
    local rest = ambit.equilibria {
      m:dynamics(), box = { beta1 = { "-3.15", 1 }, beta2 = { "-3.15", 1 } },
    }
    assert.equal("complete", rest.status)
    assert.equal(4, #rest.proved)
    local minus_pi = ambit.evaluate { -ambit.pi }
    local function is_at(x, turned)
      if not turned then return x:contains(0) and x:width() < 1e-14 end
      return x.lo <= minus_pi.lo and x.hi >= minus_pi.hi and x:width() < 1e-14
    end
    for i, turned in ipairs { { true, false }, { true, true }, { false, true }, { false, false } } do
      local met = 0
      for _, p in ipairs(rest.proved) do
        if is_at(p.beta1, turned[1]) and is_at(p.beta2, turned[2]) then met = met + 1 end
      end
      assert.equal(1, met, "equilibrium " .. i)
    end
    refused("the speed `beta1'` is 0 at rest", { m:dynamics(), box = { ["beta1'"] = { 0, 1 } } }, ambit.equilibria)
    refused("did you mean `beta1`", { m:dynamics(), box = { beta = { 0, 1 } } }, ambit.equilibria)
    refused("`beta2` has no value", { m:dynamics(), box = { beta1 = { 0, 1 } } }, ambit.equilibria)
  end)

  it("keeps closed loops closed", function()
    local m = ambit.mechanism { "four-bar", gravity = { 0, "-9.81", 0 } }
    local function hinge(from, name) return m:revolute { from = from, axis = "z", name = name } end
    local function link(from, x) return m:rigid_link { from = from, offset = { x, 0, 0 } } end
    local pin = link(hinge(m.world, "a"), 1)
    local tip = link(hinge(pin, "c"), 3)
    m:close_point { a = tip, b = link(hinge(link(m.world, 2.5), "b"), 2), name = "loop" }
    m:point_mass { at = pin, mass = 1 }
    m:point_mass { at = tip, mass = 1 }
    m:reference { a = 1, c = "-0.5", b = "1.5" }
    local rest = ambit.equilibria {
      m:dynamics(), box = { a = { "-3.2", "3.1" }, b = { "-3.2", "3.1" }, c = { "-3.2", "3.1" } },
    }
    assert.equal("complete", rest.status)
    assert.equal(4, #rest.proved)
    for _, p in ipairs(rest.proved) do -- closed, and the masses' height is stationary along the loop
      local a, b, c = p.a:mid(), p.b:mid(), p.c:mid()
      assert.is_true(math.abs(2.5 + 2 * math.cos(b) - math.cos(a) - 3 * math.cos(a + c)) < 1e-13)
      assert.is_true(math.abs(2 * math.sin(b) - math.sin(a) - 3 * math.sin(a + c)) < 1e-13)
      local turn = -math.sin(b - a) / (3 * math.sin(b - a - c)) -- d(a + c)/da
      assert.is_true(math.abs(2 * math.cos(a) + 3 * math.cos(a + c) * turn) < 1e-12)
    end
  end)

  it("finds where an arm from a file comes to rest under its controllers", function()
    local names = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
      "wrist_3_joint" }
    local stiffness, goal = { 400, 400, 300, 40, 40, 20 }, { "0.3", "-0.9", "1.2", "0.1", "-0.4", "0.8" }
    local function arm(payload, tolerances)
      local m = ambit.load { "scripts/robots/ur5.urdf", gravity = { 0, 0, "-9.81" }, tolerances = tolerances }
      m:rigid_body { at = m.links.tool0, mass = payload, inertia = { "0.004", 0, 0, 0, "0.004", 0, 0, 0, "0.003" } }
      for i, name in ipairs(names) do
        m:joint_torque { joint = m.joints[name],
          torque = function(q, v) return stiffness[i] * (goal[i] - q) - stiffness[i] / 8 * v end }
      end
      return m
    end
    local box = {}
    for i, name in ipairs(names) do box[name] = { ambit.number(goal[i]) - 1, ambit.number(goal[i]) + 1 } end
    local rest = ambit.equilibria {
      arm(ambit.between(1, 2), { mass = "1%", offset = "1%" }), box = box,
    }
    assert.equal("complete", rest.status)
    assert.equal(1, #rest.proved)
    for _, payload in ipairs { 1, "1.37", 2 } do -- an ordinary run from the goal, until nothing moves
      local initial = {}
      for i, name in ipairs(names) do initial[name], initial[name .. "'"] = goal[i], 0 end
      local run = ambit.simulate { arm(payload):dynamics(), initial = initial, t = 30, solver = "gsl",
        relative = 1e-10, absolute = 1e-12 }
      for _, name in ipairs(names) do
        local place, x = rest.proved[1][name], run.x[name]:mid()
        assert.is_true(math.abs(run.x[name .. "'"]:mid()) < 1e-8)
        assert.is_true(place.lo - 1e-8 < x and x < place.hi + 1e-8, name)
        assert.is_true(place:width() < 0.1)
      end
    end
  end)

  it("takes an ode, with uncertain parameters", function()
    local system = ambit.ode {
      states = { "n", "m" }, parameters = { a = ambit.between("1.98", "2.02") },
      equations = function(s, p) return { n = s.n * (p.a - s.n - s.m), m = s.m * (1 - s.n / 4 - s.m) } end,
    }
    local rest = ambit.equilibria { system, box = { n = { "0.1", 4 }, m = { "0.1", 4 } } }
    assert.equal("complete", rest.status)
    assert.equal(1, #rest.proved)
    assert.is_true(rest.proved[1].n:contains(4 / 3) and rest.proved[1].m:contains(2 / 3))
  end)
end)
