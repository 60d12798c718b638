-- Stability of equilibria, and eigenvalues of matrices.
local ambit = require "ambit"

local function pendulum(t)
  local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
  local shoulder = m:revolute { from = m.world, axis = "z", name = "beta1" }
  local link = m:rigid_link { from = shoulder, offset = { 0, -1, 0 } }
  local elbow = m:revolute { from = link, axis = "z", name = "beta2" }
  m:point_mass { at = link, mass = t.mass or 1 }
  m:point_mass { at = m:rigid_link { from = elbow, offset = { 0, -1, 0 } }, mass = 1 }
  for _, joint in ipairs(t.damping and { shoulder, elbow } or {}) do
    m:joint_damper { joint = joint, damping = t.damping }
  end
  return m
end

local box = { beta1 = { "-3.15", 1 }, beta2 = { "-3.15", 1 } }

local function by_place(rest)
  local found = {}
  for _, p in ipairs(rest.proved) do
    found[(p.beta1:contains(0) and "down" or "up") .. " " .. (p.beta2:contains(0) and "straight" or "bent")] = p
  end
  return found
end

-- The eigenvalue boxes that hold re + i im.
local function holding(list, re, im)
  local count = 0
  for _, e in ipairs(list) do
    if e.re.lo <= re + 1e-12 and e.re.hi >= re - 1e-12 and e.im.lo <= im + 1e-12 and e.im.hi >= im - 1e-12 then
      count = count + 1
    end
  end
  return count
end

describe("stability of equilibria", function()
  it("proves the double pendulum's by energy and by eigenvalues", function()
    local rest = ambit.equilibria { pendulum {}, box = box }
    local at = by_place(rest)
    assert.equal("stable", at["down straight"].stability)
    assert.equal("energy", at["down straight"].stability_by)
    for _, place in ipairs { "down bent", "up straight", "up bent" } do
      assert.equal("unstable", at[place].stability)
      assert.equal("eigenvalues", at[place].stability_by)
    end
    -- absolute angles t1, t2 hanging: 2 t1'' + t2'' = -2 g t1, t1'' + t2'' = -g t2: omega^2 = g (2 +- sqrt 2)
    for _, square in ipairs { 9.81 * (2 + math.sqrt(2)), 9.81 * (2 - math.sqrt(2)) } do
      local omega = math.sqrt(square)
      assert.equal(1, holding(at["down straight"].eigenvalues, 0, omega))
      assert.equal(1, holding(at["down straight"].eigenvalues, 0, -omega))
      assert.equal(1, holding(at["up straight"].eigenvalues, omega, 0)) -- gravity turned round
      assert.equal(0, holding(at["up straight"].eigenvalues, omega + 1e-6, 0))
    end
    for _, e in ipairs(at["up straight"].eigenvalues) do
      assert.is_true(e.re:width() < 1e-11 and e.im:width() == 0 and e.count == 1)
    end
  end)

  it("sees damping, for every value of the data", function()
    local rest = ambit.equilibria {
      pendulum { damping = ambit.around("0.5", "2%"), mass = ambit.around(1, "2%") }, box = box, stability = true,
    }
    local at = by_place(rest)
    assert.equal("stable", at["down straight"].stability)
    assert.is_truthy(at["down straight"].stability_by:find("eigenvalues", 1, true))
    for _, place in ipairs { "down bent", "up straight", "up bent" } do
      assert.equal("unstable", at[place].stability)
    end
  end)

  it("does not take what feeds in energy for harmless", function()
    local m = ambit.mechanism "driven"
    local joint = m:revolute { from = m.world, axis = "z", name = "a" }
    m:point_mass { at = m:rigid_link { from = joint, offset = { 0, -1, 0 } }, mass = 1 }
    m:joint_spring { joint = joint, stiffness = 4 }
    m:joint_torque { joint = joint, torque = "0.5" } -- a dead load: its power has no sign
    local p = ambit.equilibria { m, box = { a = { -1, 1 } } }.proved[1]
    assert.equal("undecided", p.stability)
    assert.is_truthy(p.stability_reason:find("imaginary axis", 1, true))
  end)

  it("decides systems by their eigenvalues, and Lyapunov's equation for sets", function()
    local function focus(a, b)
      return ambit.equilibria {
        ambit.ode { states = { "x", "y" }, equations = function(s)
          return { x = a * s.x - b * s.y + s.x ^ 3, y = b * s.x + a * s.y }
        end }, box = { x = { "-0.1", "0.1" }, y = { "-0.1", "0.1" } },
      }.proved[1]
    end
    assert.equal("stable", focus(ambit.between(-2, "-0.1"), 3).stability)
    assert.equal("unstable", focus(ambit.between("0.1", 2), 3).stability)
    assert.equal("undecided", focus(ambit.between("-0.1", "0.1"), 3).stability)
    assert.equal("undecided", focus(0, 3).stability)
    local node = focus("-0.5", 0)
    assert.equal("stable", node.stability)
    assert.equal(2, node.eigenvalues[1].count)
    assert.is_true(node.eigenvalues[1].re:contains(-0.5))
  end)

  it("says why it says nothing", function()
    local m = ambit.mechanism { "four-bar", gravity = { 0, "-9.81", 0 } }
    local function link(from, x, name)
      return m:rigid_link { from = m:revolute { from = from, axis = "z", name = name }, offset = { x, 0, 0 } }
    end
    local pin = link(m.world, 1, "a")
    local tip = link(pin, 3, "c")
    m:close_point { a = tip, b = link(m:rigid_link { from = m.world, offset = { "2.5", 0, 0 } }, 2, "b") }
    m:point_mass { at = pin, mass = 1 }
    m:point_mass { at = tip, mass = 1 }
    m:reference { a = 1, c = "-0.5", b = "1.5" }
    local all = { "-3.2", "3.1" }
    local rest = ambit.equilibria { m, box = { a = all, b = all, c = all } }
    assert.equal("undecided", rest.proved[1].stability)
    assert.is_truthy(rest.proved[1].stability_reason:find("closed loops", 1, true))
    local forced = ambit.equilibria {
      ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = t - s.x } end },
      box = { x = { -2, 2 } }, at = { t = 1 },
    }
    assert.equal("undecided", forced.proved[1].stability)
    assert.is_truthy(forced.proved[1].stability_reason:find("depends on time", 1, true))
    local function damped(extra) -- whose derivatives are bounded at rest, though the equations jump or end there
      local jump = ambit.equilibria {
        ambit.ode { states = { "x", "v" },
          equations = function(s) return { x = s.v, v = -s.x - s.v / 4 + extra(s.v) } end },
        box = { x = { -1, 1 } },
      }
      assert.equal(1, #jump.proved)
      return jump.proved[1]
    end
    assert.equal("stable", damped(function() return 0 end).stability)
    for _, extra in ipairs {
      function(v) return ambit.atan2(v, -1) - ambit.pi end, function(v) return v ^ 3 * ambit.atan2(v, -1) / 100 end,
    } do
      local p = damped(extra)
      assert.equal("undecided", p.stability)
      assert.is_truthy(p.stability_reason:find("jump", 1, true))
    end
    local good, message = pcall(ambit.equilibria, { pendulum {}, box = box, stability = "yes" })
    assert.is_false(good)
    assert.is_truthy(message:find("stability: expected true or false", 1, true))
  end)
end)

describe("eigenvalues", function()
  it("encloses those of numbers, texts, enclosures and data", function()
    local list = ambit.eigenvalues { { 1, 2 }, { 3, 4 } } -- (5 +- sqrt 33) / 2
    assert.equal("complete", list.status)
    assert.equal(2, #list)
    for _, x in ipairs { (5 + math.sqrt(33)) / 2, (5 - math.sqrt(33)) / 2 } do assert.equal(1, holding(list, x, 0)) end
    local a = ambit.around("0.1", "1%")
    local turning = ambit.eigenvalues { { -a, 1 }, { ambit.interval(-1, -1), -a } }
    assert.equal(1, holding(turning, -0.1005, 1))
    assert.equal(0, holding(turning, -0.12, 1))
    assert.equal("stable", turning.stability)
  end)

  it("refuses what is no matrix", function()
    for _, t in ipairs { {}, { { 1, 2 } }, { 1, 2 }, { { 1, 2 }, { 3 } }, { { 1 }, x = 2 } } do
      assert.is_false((pcall(ambit.eigenvalues, t)))
    end
  end)
end)
