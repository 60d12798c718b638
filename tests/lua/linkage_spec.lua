-- Explicit loops: the four-bar and the slider-crank close, and move as the closed form and as the loop with multipliers
-- say.
local ambit = require "ambit"

local function value(e, at) return ambit.evaluate { e, at = at } end

local function closes(gap, name, tolerance)
  for i = 0, 60 do
    local x = value(gap, { [name] = -3 + 0.1 * i })
    for _, c in ipairs { "x", "y", "z" } do
      assert.is_true(x[c]:contains(0) and x[c]:width() < (tolerance or 1e-12), tostring(x))
    end
  end
end

-- -- an oracle: the pin from the intersection of two circles, in ordinary floating point

local function pin_of(l, t, left)
  local bx, by = l.crank * math.cos(t), l.crank * math.sin(t)
  local ex, ey = l.ground - bx, -by
  local d = math.sqrt(ex * ex + ey * ey)
  local along = (l.coupler ^ 2 - l.rocker ^ 2 + d * d) / (2 * d)
  local h = left * math.sqrt(l.coupler ^ 2 - along * along)
  return bx + (along * ex - h * ey) / d, by + (along * ey + h * ex) / d, bx, by
end

-- a fifth-order difference
local function slope(f, x)
  local h = 1e-3
  return (8 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12 * h)
end

-- M q'' = -M' w^2 / 2 - V' for points of mass m at p(t), gravity along -y
local function acceleration(points, t, w, gravity)
  local function inertia(s)
    local sum = 0
    for _, p in ipairs(points) do
      sum = sum + p.mass * (slope(function(r) return (p.at(r)) end, s) ^ 2 + slope(function(r)
        return (select(2, p.at(r)))
      end, s) ^ 2)
    end
    return sum
  end
  local function potential(s)
    local sum = 0
    for _, p in ipairs(points) do sum = sum + p.mass * gravity * select(2, p.at(s)) end
    return sum
  end
  return (-slope(inertia, t) * w * w / 2 - slope(potential, t)) / inertia(t)
end

local function four_bar(l, more)
  local m = ambit.mechanism { "four-bar", gravity = { 0, "-9.81", 0 } }
  local t = { from = m.world, name = "f" }
  for k, v in pairs(l) do t[k] = v end
  for k, v in pairs(more or {}) do t[k] = v end
  return m, m:four_bar(t)
end

local lengths = {
  { ground = 4, crank = 1, coupler = 3.5, rocker = 3 },     -- crank and rocker
  { ground = 1, crank = 2, coupler = 1.75, rocker = 2 },    -- two cranks: the crank is longer than the ground
  { ground = 4, crank = 2, coupler = 3, rocker = 2, full_turn = false }, -- two rockers
}

describe("a four-bar", function()
  it("closes on both branches, all the way round", function()
    for i, l in ipairs(lengths) do
      for _, branch in ipairs { "open", "crossed" } do
        local m, f = four_bar(l, { branch = branch })
        local gap = m:position(f.pin) - m:position(f.rocker_pin)
        if i < 3 then closes(gap, "f.crank") end
        local x = value({ m:position(f.pin), gap }, { ["f.crank"] = 0.4 })
        local px, py = pin_of(l, 0.4, branch == "open" and 1 or -1)
        assert.is_true(math.abs(x[1].x:mid() - px) < 1e-13 and math.abs(x[1].y:mid() - py) < 1e-13)
        assert.is_true(x[2].x:contains(0) and x[2].y:contains(0))
      end
    end
  end)

  it("lies in the plane across its axis", function()
    local m = ambit.mechanism "planes"
    for _, axis in ipairs { "x", "y", "z", "-x", "-y", "-z" } do
      local f = m:four_bar { from = m.world, ground = 4, crank = 1, coupler = 3.5, rocker = 3, axis = axis, angle = 1 }
      local letter = axis:sub(-1)
      local p = value { m:position(f.pin), m:position(f.rocker_pin) }
      local px, py = pin_of(lengths[1], 1, 1)
      local first = ({ x = "y", y = "z", z = "x" })[letter]
      local second = ({ x = "z", y = "x", z = "y" })[letter]
      assert.is_true(math.abs(p[1][first]:mid() - px) < 1e-13)
      assert.is_true(math.abs(p[1][second]:mid() - (axis:find "-" and -py or py)) < 1e-13)
      assert.equal(0, p[1][letter]:mag())
      assert.is_true((p[1][second] - p[2][second]):contains(0))
    end
  end)

  it("is exact as a parallelogram, also at its dead centres", function()
    local m = ambit.mechanism "parallel"
    local short, long = ambit.around(1, "1%"), ambit.around(3, "1%")
    local f = m:four_bar { from = m.world, ground = long, crank = short, coupler = long, rocker = short, name = "f",
      branch = "parallelogram" }
    local gap = m:position(f.pin) - m:position(f.rocker_pin)
    for _, t in ipairs { 0, 1, ambit.pi } do
      local x = ambit.evaluate { gap, at = { ["f.crank"] = t }, arithmetic = "affine" }
      assert.is_true(x.x:width() < 1e-14 and x.y:width() < 1e-14)
    end
  end)

  it("accelerates as its closed form says", function()
    for i, l in ipairs(lengths) do
      local m, f = four_bar(l)
      m:point_mass { at = f.pin, mass = 2 }
      m:point_mass { at = f.tip, mass = 1 }
      m:point_mass { at = m:frame { from = f.coupler, offset = { 1, "0.5", 0 } }, mass = 3 }
      local function at(part)
        return function(t)
          local px, py, bx, by = pin_of(l, t, 1)
          if part == "pin" then return px, py end
          if part == "tip" then return bx, by end
          local c, s = (px - bx) / l.coupler, (py - by) / l.coupler
          return bx + c - 0.5 * s, by + s + 0.5 * c
        end
      end
      local points = { { mass = 2, at = at "pin" }, { mass = 1, at = at "tip" }, { mass = 3, at = at "point" } }
      for _, state in ipairs { { 0.4, 0.7 }, { i < 3 and 2 or 0.6, -1.5 } } do
        local x = value(m:dynamics():rate "f.crank'", { ["f.crank"] = state[1], ["f.crank'"] = state[2] })
        local want = acceleration(points, state[1], state[2], 9.81)
        assert.is_true(math.abs(x:mid() - want) < 1e-7 * (1 + math.abs(want)), ("%s %.17g"):format(tostring(x), want))
      end
    end
  end)

  it("accelerates as the same loop with multipliers does", function()
    local l = lengths[1]
    local m, f = four_bar(l)
    m:rigid_body { at = f.coupler, mass = 2, centre = { 1, 0, 0 }, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    m:point_mass { at = f.rocker_pin, mass = 1 }
    local loop = ambit.mechanism { "loop", gravity = { 0, "-9.81", 0 } }
    local crank = loop:revolute { from = loop.world, name = "crank" }
    local coupler = loop:revolute { from = loop:rigid_link { from = crank, offset = { 1, 0, 0 } }, name = "coupler" }
    local rocker = loop:revolute { from = loop:rigid_link { from = loop.world, offset = { 4, 0, 0 } }, name = "rocker" }
    local pin = loop:rigid_link { from = rocker, offset = { 3, 0, 0 } }
    loop:rigid_body { at = coupler, mass = 2, centre = { 1, 0, 0 },
      inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    loop:point_mass { at = pin, mass = 1 }
    loop:close_pin { a = loop:rigid_link { from = coupler, offset = { 3.5, 0, 0 } }, b = pin, normal = "z" }
    loop:independent { "crank" }
    local t = 1
    local q = value({ m:coordinate(f.coupler_joint), m:coordinate(f.rocker_joint) }, { ["f.crank"] = t })
    local at = { crank = t, ["crank'"] = 0.5, coupler = q[1]:mid(), rocker = q[2]:mid() }
    local x = value(m:dynamics():rate "f.crank'", { ["f.crank"] = t, ["f.crank'"] = 0.5 })
    local y = value(loop:dynamics():rate "crank'", at)
    assert.is_true(math.abs(x:mid() - y:mid()) < 1e-11 * math.abs(x:mid()))
  end)
end)

describe("a slider-crank", function()
  it("closes on both branches", function()
    for _, branch in ipairs { "out", "in" } do
      local m = ambit.mechanism "engine"
      local s = m:slider_crank { from = m.world, crank = 1, rod = "2.5", offset = "0.3", branch = branch, name = "s" }
      closes(m:position(s.pin) - m:position(s.slider), "s.crank")
      local p = value(m:position(s.slider), { ["s.crank"] = 0.4 })
      local y = 0.3 - math.sin(0.4)
      local reach = math.sqrt(2.5 ^ 2 - y * y)
      assert.is_true(math.abs(p.x:mid() - math.cos(0.4) - (branch == "out" and reach or -reach)) < 1e-14)
      assert.is_true(p.y:contains(0.3))
    end
  end)

  it("accelerates as its closed form says", function()
    local m = ambit.mechanism { "engine", gravity = { 0, "-9.81", 0 } }
    local s = m:slider_crank { from = m.world, crank = 1, rod = "2.5", name = "s" }
    m:point_mass { at = s.slider, mass = 2 }
    m:point_mass { at = s.tip, mass = 1 }
    local points = {
      { mass = 2, at = function(t) return math.cos(t) + math.sqrt(2.5 ^ 2 - math.sin(t) ^ 2), 0 end },
      { mass = 1, at = function(t) return math.cos(t), math.sin(t) end },
    }
    for _, state in ipairs { { 0.4, 0.7 }, { 2, -1.5 } } do
      local x = value(m:dynamics():rate "s.crank'", { ["s.crank"] = state[1], ["s.crank'"] = state[2] })
      local want = acceleration(points, state[1], state[2], 9.81)
      assert.is_true(math.abs(x:mid() - want) < 1e-7 * (1 + math.abs(want)))
    end
  end)

  it("may be driven", function()
    local m = ambit.mechanism "pump"
    local s = m:slider_crank { from = m.world, crank = 1, rod = 3, angle = 2 * ambit.time }
    local x = value(m:velocity(s.slider), { t = ambit.pi / 4 }) -- the crank upright: x' = -a w
    assert.is_true(math.abs(x.x:mid() + 2) < 1e-14)
  end)
end)

describe("bad linkages", function()
  local m = ambit.mechanism "bad"
  local function fails(f, ...)
    local good, problem = pcall(f)
    assert.is_false(good)
    assert.truthy(problem:find "linkage_spec%.lua:%d+: ", problem)
    for _, text in ipairs { ... } do assert.truthy(problem:find(text, 1, true), problem) end
  end
  local function bar(g, a, b, c, more)
    local t = { from = m.world, ground = g, crank = a, coupler = b, rocker = c }
    for k, v in pairs(more or {}) do t[k] = v end
    return function() m:four_bar(t) end
  end
  it("that cannot turn or be assembled", function()
    fails(bar(4, 2, 3, 2), "four_bar", "ground + crank = 6", "coupler + rocker = 5", "full_turn = false")
    fails(bar(4, 3, 5, 2.5), "four_bar", "ground - crank")
    fails(bar(4, 1, 4, 1), "Grashof", "parallelogram")
    fails(bar(9, 2, 3, 2), "ground = 9", "other three together, 7")
    fails(bar(2, 2, 3, 9, { full_turn = false }), "rocker = 9", "cannot be assembled")
    fails(bar(4, ambit.between("0.9", "1.6"), 3, 2.5), "not proved")
    fails(function() m:slider_crank { from = m.world, crank = 2, rod = 1 } end, "rod = 1", "crank + offset = 2")
    fails(function() m:slider_crank { from = m.world, crank = 2, rod = 1, offset = -4, full_turn = false } end,
      "do not reach over the offset")
  end)
  it("with lengths that move", function()
    local m = ambit.mechanism "m"
    local q = m:coordinate(m:revolute { from = m.world, name = "q" })
    local function message(f) return select(2, pcall(f)) end
    assert.truthy(message(function()
      m:four_bar { from = m.world, ground = 3, crank = 1, coupler = 3, rocker = 2 + q }
    end):find "four_bar: rocker must be fixed, but it depends on `q`")
    assert.truthy(message(function()
      m:slider_crank { from = m.world, crank = 1, rod = 3, offset = ambit.time }
    end):find "slider_crank: offset must be fixed, but it depends on `t`")
  end)

  it("with lengths that are none", function()
    fails(bar(4, -1, 3, 3), "crank must be positive", "-1")
    fails(bar(4, ambit.between(0, 1), 3, 3), "crank must be positive")
    fails(bar(4, 1, 3, nil), "rocker is required")
    fails(bar(4, 1, 3, "3 kg"), "rocker", "kg")
    fails(bar(4, 1, 3.5, 3, { branch = "opn" }), "`open`")
    fails(bar(4, 1, 3.5, 3, { axis = "w" }), "axis")
    fails(bar(4, 1, 4, 1.5, { branch = "parallelogram" }), "same datum", "rocker = 1.5")
    fails(bar(4, ambit.around(1, "1%"), 4, ambit.around(1, "1%"), { branch = "parallelogram" }), "same datum")
  end)
  it("beyond a dead centre are partial", function()
    local swing = ambit.mechanism "swing"
    local f = swing:four_bar { from = swing.world, ground = 4, crank = 2, coupler = 3, rocker = 2, full_turn = false,
      name = "f" }
    assert.is_true(value(swing:position(f.rocker_pin), { ["f.crank"] = 3 }).x.partial)
    assert.is_false(value(swing:position(f.rocker_pin), { ["f.crank"] = 1 }).x.partial)
  end)
end)
