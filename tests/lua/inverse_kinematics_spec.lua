-- ambit.inverse_kinematics: all postures, against closed forms.
local ambit = require "ambit"

local function refused(part, t)
  local good, message = pcall(ambit.inverse_kinematics, t)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

-- A planar arm of hinges a, b, c; `lengths` may be uncertain.
local function planar(lengths)
  local m = ambit.mechanism "arm"
  local at = m.world
  for i, length in ipairs(lengths) do
    at = m:revolute { from = at, axis = "z", name = ("abc"):sub(i, i) }
    at = m:rigid_link { from = at, offset = { length, 0, 0 } }
  end
  return m, at
end

-- Both elbows of a two-link arm: { a, b }.
local function elbows(l1, l2, x, y)
  local list = {}
  local cosine = (x * x + y * y - l1 * l1 - l2 * l2) / (2 * l1 * l2)
  for _, sign in ipairs { 1, -1 } do
    local b = sign * math.acos(cosine)
    list[#list + 1] = { a = math.atan(y, x) - math.atan(l2 * math.sin(b), l1 + l2 * math.cos(b)), b = b }
  end
  return list
end

local turn = 2 * math.pi

-- How many of the postures hold the angles, up to whole turns and rounding of the closed form.
local function count_holding(postures, angles)
  local count = 0
  for _, posture in ipairs(postures) do
    local holds = true
    for name, angle in pairs(angles) do
      local x = posture[name]
      local near = angle - turn * math.floor((angle - x:mid()) / turn + 0.5)
      holds = holds and x.lo - 1e-9 <= near and near <= x.hi + 1e-9
    end
    if holds then count = count + 1 end
  end
  return count
end

describe("inverse kinematics of planar arms", function()
  it("proves both elbows of two links", function()
    local m, tip = planar { 1, 0.75 }
    local r = ambit.inverse_kinematics { m, at = tip, position = { 1, 0.5, 0 } }
    assert.equal("complete", r.status)
    assert.equal(2, #r.proved)
    for _, angles in ipairs(elbows(1, 0.75, 1, 0.5)) do
      assert.equal(1, count_holding(r.proved, angles))
      angles.a = angles.a + 1e-6
      assert.equal(0, count_holding(r.proved, angles)) -- the comparison sees what is none
    end
    for _, p in ipairs(r.proved) do assert.is_true(p.a:width() < 1e-14 and p.b:width() < 1e-14) end
  end)

  it("holds for every length and place within their tolerances", function()
    local m, tip = planar { ambit.around(1, "2%"), ambit.around("0.75", "2%") }
    local r = ambit.inverse_kinematics {
      m, at = tip, position = { ambit.around(1, "0.01"), ambit.around("0.5", "0.01"), 0 },
    }
    assert.equal("complete", r.status)
    assert.equal(2, #r.proved)
    math.randomseed(7)
    local function within(c, t) return c + t * (2 * math.random() - 1) end
    for _ = 1, 300 do
      for _, angles in ipairs(elbows(within(1, 0.02), within(0.75, 0.015), within(1, 0.01), within(0.5, 0.01))) do
        assert.equal(1, count_holding(r.proved, angles))
      end
    end
  end)

  it("takes an orientation for three links", function()
    local m, tip = planar { 1, "0.75", "0.25" }
    for _, orientation in ipairs {
      { axis = "z", angle = "0.5" }, { rpy = { 0, 0, "0.5" } },
      { { ambit.cos "0.5", -ambit.sin "0.5", 0 }, { ambit.sin "0.5", ambit.cos "0.5", 0 }, { 0, 0, 1 } },
    } do
      local r = ambit.inverse_kinematics { m, at = tip, position = { 1, "0.5", 0 }, orientation = orientation }
      assert.equal("complete", r.status)
      assert.equal(2, #r.proved)
      for _, angles in ipairs(elbows(1, 0.75, 1 - 0.25 * math.cos(0.5), 0.5 - 0.25 * math.sin(0.5))) do
        angles.c = 0.5 - angles.a - angles.b
        assert.equal(1, count_holding(r.proved, angles))
      end
    end
  end)

  it("takes rows in doubles or with a few digits as the rotation that they are nearly", function()
    local m, at = ambit.mechanism "wrist", nil
    for _, axis in ipairs { "z", "y", "x" } do
      at = m:rigid_link { from = m:revolute { from = at or m.world, axis = axis, name = axis }, offset = { 1, 0, 0 } }
    end
    for k = 1, 9 do
      local c, s = math.cos(0.3 * k), math.sin(0.3 * k)
      local digits = k % 3 == 0 and function(x) return ("%.8f"):format(x) end or function(x) return x end
      local r = ambit.inverse_kinematics { m, at = at,
        orientation = { { digits(c), digits(-s), 0 }, { digits(s), digits(c), 0 }, { 0, 0, 1 } } }
      assert.equal("complete", r.status)
      local found = 0
      for _, p in ipairs(r.proved) do
        if p.z:contains(0.3 * k) or math.abs(p.z:mid() - 0.3 * k) < 1e-7 then
          found = found + 1
          assert.is_true(p.x:contains(0) and p.y:contains(0))
        end
      end
      assert.equal(1, found)
    end
    local exact = ambit.inverse_kinematics { m, at = at, orientation = { axis = "z", angle = "0.3" } }
    assert.equal("complete", exact.status)
    assert.equal(1, count_holding(exact.proved, { x = 0, y = 0, z = 0.3 }))
    refused("the rows are no rotation", { m, at = at, orientation = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, -1 } } })
  end)

  it("proves that there is none", function()
    local m, tip = planar { 1, "0.75" }
    for _, position in ipairs { { 2, 0, 0 }, { 1, "0.5", "0.1" }, { "0.1", "0.1", 0 } } do
      local r = ambit.inverse_kinematics { m, at = tip, position = position }
      assert.equal("complete", r.status)
      assert.equal(0, #r.proved + #r.undecided)
    end
    local stretched = ambit.inverse_kinematics { m, at = tip, position = { "1.75", 0, 0 } } -- a double root
    assert.equal("unable", stretched.status)
    assert.equal(0, #stretched.proved)
    assert.is_true(count_holding(stretched.undecided, { a = 0, b = 0 }) > 0)
  end)

  it("wants the joints that are too many given, and free components left out", function()
    local m, tip = planar { 1, "0.75", "0.25" }
    refused("redundant: 3 joints (a, b, c) for 2 equations; give 1", { m, at = tip, position = { 1, "0.5", 0 } })
    local r = ambit.inverse_kinematics { m, at = tip, position = { 1, "0.5", 0 }, given = { c = "0.25" } }
    assert.equal(2, #r.proved)
    for _, p in ipairs(r.proved) do
      local a, ab = p.a:mid(), p.a:mid() + p.b:mid()
      assert.is_true(math.abs(math.cos(a) + 0.75 * math.cos(ab) + 0.25 * math.cos(ab + 0.25) - 1) < 1e-13)
      assert.is_true(math.abs(math.sin(a) + 0.75 * math.sin(ab) + 0.25 * math.sin(ab + 0.25) - 0.5) < 1e-13)
    end
    local line = ambit.inverse_kinematics { m, at = tip, position = { x = 1 }, given = { a = 0, b = "1.5" },
      box = { c = { 0, 2 } } }
    assert.equal(1, #line.proved)
  end)

  it("explains bad requests", function()
    local m, tip = planar { 1, "0.75" }
    local p = { 1, "0.5", 0 }
    refused("expected a mechanism", { 3 })
    refused("at: expected a frame", { m, position = p })
    refused("nothing is wanted", { m, at = tip })
    refused("unknown key `postion`; did you mean `position`?", { m, at = tip, postion = p })
    refused("no coordinate `d`", { m, at = tip, position = p, given = { d = 1 } })
    refused("in `box` and in `given`", { m, at = tip, position = p, given = { a = 1 }, box = { a = { 0, 1 } } })
    refused("every joint has a value", { m, at = tip, position = p, given = { a = 1, b = 1 } })
    refused("the rows are no rotation", { m, at = tip, orientation = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, 1 } } })
    refused("expected three numbers", { m, at = tip, orientation = { { 1, 0, 0 }, { 0, 2, 0 } } })
    local slider = ambit.mechanism "slider"
    local s = slider:prismatic { from = slider.world, axis = "x", name = "s" }
    refused("`s` has no limits", { slider, at = s, position = { x = 1 } })
    local r = ambit.inverse_kinematics { slider, at = s, position = { x = 1 }, box = { s = { 0, 3 } } }
    assert.is_true(r.proved[1].s:contains(1))
  end)
end)

-- -- UR5: the closed form of Hawkins (Georgia Tech 2013) in Denavit-Hartenberg's angles

local d1, a2, a3, d4, d5, d6 = 0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823

local function times(a, b)
  local r = {}
  for i = 1, 4 do
    r[i] = {}
    for j = 1, 4 do
      r[i][j] = a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j] + a[i][4] * b[4][j]
    end
  end
  return r
end

local function inverse(t)
  local r = {}
  for i = 1, 3 do
    r[i] = { t[1][i], t[2][i], t[3][i] }
    r[i][4] = -(t[1][i] * t[1][4] + t[2][i] * t[2][4] + t[3][i] * t[3][4])
  end
  r[4] = { 0, 0, 0, 1 }
  return r
end

local function link(theta, d, a, alpha)
  local c, s, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
  return { { c, -s * ca, s * sa, a * c }, { s, c * ca, -c * sa, a * s }, { 0, sa, ca, d }, { 0, 0, 0, 1 } }
end

local quarter = math.pi / 2

local function forward(q)
  local t = link(q[1], d1, 0, quarter)
  for i, row in ipairs { { 0, a2, 0 }, { 0, a3, 0 }, { d4, 0, quarter }, { d5, 0, -quarter }, { d6, 0, 0 } } do
    t = times(t, link(q[i + 1], row[1], row[2], row[3]))
  end
  return t
end

local function postures_of(t)
  local list = {}
  local x, y = t[1][4] - d6 * t[1][3], t[2][4] - d6 * t[2][3]
  for _, s1 in ipairs { 1, -1 } do
    local q1 = math.atan(y, x) + s1 * math.acos(d4 / math.sqrt(x * x + y * y)) + quarter
    local sine, cosine = math.sin(q1), math.cos(q1)
    for _, s5 in ipairs { 1, -1 } do
      local q5 = s5 * math.acos((t[1][4] * sine - t[2][4] * cosine - d4) / d6)
      local q6 = math.atan((-t[1][2] * sine + t[2][2] * cosine) / math.sin(q5),
        (t[1][1] * sine - t[2][1] * cosine) / math.sin(q5))
      local wrist = times(link(q5, d5, 0, -quarter), link(q6, d6, 0, 0))
      local t14 = times(times(inverse(link(q1, d1, 0, quarter)), t), inverse(wrist))
      local px, py = t14[1][4] - d4 * t14[1][2], t14[2][4] - d4 * t14[2][2]
      local length = math.sqrt(px * px + py * py)
      local elbow = (length * length - a2 * a2 - a3 * a3) / (2 * a2 * a3)
      for _, s3 in ipairs(math.abs(elbow) <= 1 and { 1, -1 } or {}) do
        local q3 = s3 * math.acos(elbow)
        local q2 = -math.atan(py, -px) + math.asin(a3 * math.sin(q3) / length)
        local t34 = times(inverse(times(link(q2, 0, a2, 0), link(q3, 0, a3, 0))), t14)
        list[#list + 1] = { q1, q2, q3, math.atan(t34[2][1], t34[1][1]), q5, q6 }
      end
    end
  end
  return list
end

describe("inverse kinematics of a UR5", function()
  local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
    "wrist_3_joint" }

  -- Position and rows of the tool in the axes of base_link, which is turned by pi about z.
  local function target(q)
    local t = forward(q)
    return { -t[1][4], -t[2][4], t[3][4] }, { { -t[1][1], -t[1][2], -t[1][3] }, { -t[2][1], -t[2][2], -t[2][3] },
      { t[3][1], t[3][2], t[3][3] } }, t
  end

  local function named(q)
    local angles = {}
    for i, name in ipairs(joints) do angles[name] = q[i] end
    return angles
  end

  it("proves the eight postures of the closed form", function()
    local arm = ambit.load "scripts/robots/ur5.urdf"
    for _, pose in ipairs { { 0.1, -0.5, 0.9, 0.3, -0.7, 1.1 }, { -2.1, -1.3, 1.7, -0.4, 1.2, 0.6 } } do
      local position, orientation, t = target(pose)
      local r = ambit.inverse_kinematics { arm, at = arm.links.tool0, position = position, orientation = orientation }
      assert.equal("complete", r.status, r.reason)
      local expected = postures_of(t)
      assert.equal(8, #expected)
      assert.equal(8, #r.proved)
      for _, q in ipairs(expected) do assert.equal(1, count_holding(r.proved, named(q))) end
      for _, p in ipairs(r.proved) do
        for _, name in ipairs(joints) do assert.is_true(p[name]:width() < 1e-12) end
      end
    end
  end)

  it("keeps them apart with tolerances on its lengths", function()
    local arm = ambit.load { "scripts/robots/ur5.urdf", tolerances = { ["*_joint.offset"] = "0.1%" } }
    local position, orientation, t = target { 0.1, -0.5, 0.9, 0.3, -0.7, 1.1 }
    local r = ambit.inverse_kinematics { arm, at = arm.links.tool0, position = position, orientation = orientation }
    assert.equal("complete", r.status, r.reason)
    assert.equal(8, #r.proved)
    for _, q in ipairs(postures_of(t)) do assert.equal(1, count_holding(r.proved, named(q))) end
    for _, p in ipairs(r.proved) do assert.is_true(p.elbow_joint:width() > 1e-4) end
  end)
end)
