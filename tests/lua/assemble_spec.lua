-- m:assemble: configurations of closed loops, proved to be the only ones, or to be none.
local ambit = require "ambit"

local function hinge(m, from, name) return m:revolute { from = from, axis = "z", name = name } end
local function link(m, from, x, y) return m:rigid_link { from = from, offset = { x, y, 0 } } end

local function slider_crank()
  local m = ambit.mechanism "slider-crank"
  local pin = link(m, hinge(m, m.world, "phi"), 1, 0)
  local tip = link(m, hinge(m, pin, "psi"), 3, 0)
  m:close_point { a = tip, b = m:prismatic { from = m.world, axis = "x", name = "s" }, name = "loop" }
  return m
end

-- Andrews' squeezer (IVP test set, problem 8): lengths in m, angles in rad.
local squeezer_at = {
  beta = "-0.0617138900142764496358948458001", theta = "0", gamma = "0.455279819163070380255912382449",
  phi = "0.222668390165885884674473185609", delta = "0.487364979543842550225598953530",
  omega = "-0.222668390165885884674473185609", epsilon = "1.23054744454982119249735015568",
}

local function squeezer()
  local m = ambit.mechanism "squeezer"
  local E = link(m, hinge(m, link(m, hinge(m, m.world, "beta"), "0.007", 0), "theta"), "-0.028", 0)
  local B, A = link(m, m.world, "-0.03635", "0.03273"), link(m, m.world, "-0.06934", "-0.00227")
  m:close_point { a = E, b = link(m, hinge(m, B, "gamma"), 0, "-0.035"), name = "loop1" }
  local arm = link(m, hinge(m, A, "delta"), "0.04", 0)
  m:close_point { a = E, b = link(m, hinge(m, arm, "phi"), 0, "-0.02"), name = "loop2" }
  arm = link(m, hinge(m, A, "epsilon"), 0, "-0.04")
  m:close_point { a = E, b = link(m, hinge(m, arm, "omega"), "0.02", 0), name = "loop3" }
  return m
end

-- { name = box } of +-r about the published start
local function squeezer_box(r)
  local box = {}
  for name, text in pairs(squeezer_at) do
    local x = ambit.interval(text)
    if name ~= "beta" then box[name] = { x.lo - r, x.hi + r } end
  end
  return box
end

-- N cranks of length 1 side by side, joined at their tips
local function four_bars(n)
  local m = ambit.mechanism "N four-bar"
  local top = link(m, hinge(m, m.world, "a0"), 0, 1)
  for i = 1, n do
    local tip = link(m, hinge(m, top, "c" .. i), 1, 0)
    m:close_point { a = tip, b = link(m, hinge(m, link(m, m.world, i, 0), "a" .. i), 0, 1), name = "loop" .. i }
    top = tip
  end
  return m
end

local function refused(part, m, t)
  local good, message = pcall(m.assemble, m, t)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

describe("assemble", function()
  it("proves both assemblies of a slider-crank, and each alone", function()
    local m, pi = slider_crank(), ambit.pi
    local both = m:assemble { phi = "0.7", box = { psi = { -pi, pi }, s = { -5, 5 } } }
    assert.equal("several", both.status)
    assert.equal(2, #both.configurations)
    local reach = math.sqrt(9 - math.sin(0.7) ^ 2)
    for _, c in ipairs(both.configurations) do
      local sign = c.s.lo > 0 and 1 or -1
      assert.is_true(math.abs(c.s:mid() - (math.cos(0.7) + sign * reach)) < 1e-14)
      assert.is_true(c.s:width() < 5e-15 and c.phi:contains(0.7))
    end
    local right = m:assemble { phi = "0.7", box = { psi = { -pi / 2, pi / 2 }, s = { 0, 5 } } }
    assert.equal("unique", right.status)
    assert.equal("", right.reason)
    local near = m:assemble { phi = "0.7", guess = { psi = -1, s = 3 }, within = "1e-2" }
    assert.equal("unique", near.status)
    assert.is_true(math.abs(near.configuration.s:mid() - (math.cos(0.7) + reach)) < 1e-14)
    assert.is_true(near.box.s:width() > 0.0199 and near.box.s:width() < 0.0201)
    for _, r in pairs(near.residuals) do assert.is_true(r:contains(0) and r:width() < 1e-13) end
  end)

  it("holds for every value of uncertain data", function()
    local m = slider_crank()
    local c = m:assemble { phi = ambit.between("0.65", "0.75"), box = { psi = { -1.5, 1.5 }, s = { 0, 5 } } }
    assert.equal("unique", c.status)
    for i = 0, 20 do
      local phi = 0.65 + 0.1 * i / 20
      local s = math.cos(phi) + math.sqrt(9 - math.sin(phi) ^ 2)
      assert.is_true(c.configuration.s.lo <= s + 1e-14 and c.configuration.s.hi >= s - 1e-14)
    end
    assert.is_true(c.configuration.s:width() < 0.2)
  end)

  it("gives values that other verbs take", function()
    local m = slider_crank()
    local c = m:assemble { phi = "0.7", guess = { psi = -1, s = 3 } }.configuration
    for _, r in pairs(ambit.evaluate { m:constraints(), at = c }) do assert.is_true(r:contains(0)) end
  end)

  it("names the loop that cannot be closed", function()
    local m = slider_crank()
    local none = m:assemble { phi = "0.7", box = { psi = { -3, 3 }, s = { "4.5", 5 } } }
    assert.equal("none", none.status)
    assert.is_nil(none.configuration)
    assert.is_truthy(none.reason:find("`loop`", 1, true))
    local long = m:assemble { s = "4.1", box = { psi = { -4, 4 }, phi = { -4, 4 } } }
    assert.equal("none", long.status)
    assert.is_truthy(tostring(long):find("none: no configuration", 1, true))
    local bars = four_bars(3)
    local box = { a1 = { -1, 1 }, a2 = { 2, 3 }, a3 = { -1, 1 }, c1 = { -1, 1 }, c2 = { -4, 4 }, c3 = { -4, 4 } }
    local third = bars:assemble { a0 = 0, box = box }
    assert.equal("none", third.status)
    assert.is_truthy(third.reason:find("loop", 1, true))
  end)

  it("does not decide where two assemblies meet", function()
    local m = slider_crank()
    local dead = m:assemble { s = 4, box = { psi = { -2, 2 }, phi = { -2, 2 } } }
    assert.equal("undecided", dead.status)
    assert.is_true(#dead.reason > 20)
    local covered = false
    for _, c in ipairs(dead.undecided) do covered = covered or c.phi:contains(0) and c.psi:contains(0) end
    assert.is_true(covered)
  end)

  it("tells when a configuration may lie outside the box", function()
    local m, phi = slider_crank(), ambit.between("0.6", "0.8") -- at 0.7 the slider is at the edge, s = 3.695
    local c = m:assemble { phi = phi, box = { psi = { -1.5, 1.5 }, s = { 3, "3.695" } } }
    assert.equal("partial", c.status)
    assert.equal("unable.partial", c.code)
    assert.is_false(c.configuration.inside)
    assert.is_truthy(c.reason:find("1 root may lie outside the box, which could be larger, for a part of the data", 1, true))
    local known = m:assemble { phi = phi, box = { psi = { -1.5, 1.5 }, s = { 3, "3.695" } }, partial = true }
    assert.equal("ok.partial", known.code)
    local whole = m:assemble { phi = phi, box = { psi = { -1.5, 1.5 }, s = { 3, 5 } } }
    assert.is_true(whole.configuration.inside)
    assert.equal("", whole.reason)
  end)

  it("takes no configuration from outside the box", function()
    local m = slider_crank() -- the iteration ends at phi = 2 pi - 0.56
    local c = m:assemble { s = "3.8", box = { psi = { -3, 3 }, phi = { "0.5", 3 } }, boxes_max = 1 }
    assert.equal("undecided", c.status)
    assert.is_nil(c.configuration)
  end)

  it("proves Andrews' squeezer in a box of +-1e-3 around the published start", function()
    local c = squeezer():assemble { beta = squeezer_at.beta, box = squeezer_box(1e-3) }
    assert.equal("unique", c.status)
    for name, text in pairs(squeezer_at) do
      local x, truth = c.configuration[name], ambit.interval(text)
      assert.is_true(x.lo <= truth.lo and x.hi >= truth.hi, name)
      assert.is_true(x:width() < 1e-14, name)
    end
    assert.is_true(c.cpu_seconds < 0.1)
  end)

  it("finds every assembly of the squeezer: as many as circles have common points", function()
    local pi = math.pi
    local box = {}
    for name in pairs(squeezer_at) do if name ~= "beta" then box[name] = { -pi, pi } end end
    local all = squeezer():assemble { beta = squeezer_at.beta, box = box }
    -- E lies on circles about the crank's pin F and about B; each two-bar arm from A reaches it in two ways or none
    local beta = -0.0617138900142764496
    local fx, fy, bx, by = 0.007 * math.cos(beta), 0.007 * math.sin(beta), -0.03635, 0.03273
    local dx, dy = bx - fx, by - fy
    local d = math.sqrt(dx * dx + dy * dy)
    local a = (0.028 ^ 2 - 0.035 ^ 2 + d * d) / (2 * d)
    local h = math.sqrt(0.028 ^ 2 - a * a)
    local expected = 0
    for sign = -1, 1, 2 do
      local ex, ey = fx + (a * dx - sign * h * dy) / d, fy + (a * dy + sign * h * dx) / d
      local r = math.sqrt((ex + 0.06934) ^ 2 + (ey + 0.00227) ^ 2)
      if r > 0.02 and r < 0.06 then expected = expected + 4 end -- 2 ways for each of the two arms
    end
    assert.equal(expected, #all.configurations)
    assert.equal(expected == 1 and "unique" or "several", all.status)
  end)

  it("assembles ten four-bars, 21 coordinates", function()
    local m = four_bars(10)
    local c = m:assemble { a0 = "0.3", guess = {}, within = "0.1" }
    assert.equal("unique", c.status)
    local crank = ambit.interval "0.3"
    for i = 1, 10 do
      assert.is_true(c.configuration["a" .. i].lo <= crank.lo and c.configuration["a" .. i].hi >= crank.hi)
      assert.is_true(c.configuration["a" .. i]:width() < 1e-13)
    end
  end)

  it("proves the pose of a Stewart platform from its legs", function()
    local m = ambit.mechanism "platform"
    local top = m:free { from = m.world, name = "p" }
    local pose = { 0.05, -0.03, 1.1 }
    local base, plate = { 10, 110, 130, 230, 250, 350 }, { 50, 70, 170, 190, 290, 310 }
    for i = 1, 6 do
      local b, p = math.rad(base[i]), math.rad(plate[i])
      local foot, head = { math.cos(b), math.sin(b), 0 }, { 0.6 * math.cos(p), 0.6 * math.sin(p), 0 }
      local square = 0
      for k = 1, 3 do square = square + (pose[k] + head[k] - foot[k]) ^ 2 end
      m:close_distance {
        a = m:rigid_link { from = m.world, offset = foot }, b = m:rigid_link { from = top, offset = head },
        length = math.sqrt(square), name = "leg" .. i,
      }
    end
    local c = m:assemble { guess = { ["p.6"] = 1 }, within = "0.5" }
    assert.equal("unique", c.status)
    for i, x in ipairs { 0, 0, 0, 0.05, -0.03, 1.1 } do -- up to the rounding of the legs' lengths
      assert.is_true(math.abs(c.configuration["p." .. i]:mid() - x) < 1e-14)
      assert.is_true(c.configuration["p." .. i]:width() < 1e-14)
    end
  end)

  it("says which rows it took where one follows from the others", function()
    local m = ambit.mechanism "three cranks"
    local bar = hinge(m, link(m, hinge(m, m.world, "a0"), 0, 1), "c")
    for i = 1, 2 do
      local tip = link(m, hinge(m, link(m, m.world, i, 0), "a" .. i), 0, 1)
      m:close_point { a = link(m, bar, i, 0), b = tip, name = "loop" .. i }
    end
    local c = m:assemble { a0 = "0.3", guess = { a1 = "0.25", a2 = "0.25", c = "-0.25" }, within = "0.05" }
    assert.equal("undecided", c.status) -- that the row left over vanishes is beyond enclosures
    assert.is_truthy(c.reason:find("more equations than unknowns", 1, true))
    assert.is_true(c.configuration.a2:contains(0.3) and c.configuration.c:contains(-0.3))
    for _, r in pairs(c.residuals) do assert.is_true(r:contains(0)) end
  end)

  it("explains bad requests", function()
    local m = slider_crank()
    refused("`psi` has neither a value nor a range", m, { phi = 1, box = { s = { 0, 5 } } })
    refused("unknown key `psy`; did you mean `psi`?", m, { phi = 1, guess = { psy = 0 } })
    refused("unknown key `fi`", m, { fi = 1, guess = {} })
    refused("has a value and is in `guess`", m, { phi = 1, guess = { phi = 1 } })
    refused("expected a positive radius", m, { phi = 1, guess = {}, within = 0 })
    refused("equations cannot fix 3 unknowns", m, { guess = {} })
    refused("every coordinate of the loops has a value", m, { phi = 0, psi = 0, s = 4 })
    refused("range is empty", m, { phi = 0, box = { psi = { 1, 0 }, s = { 0, 1 } } })
    refused("no closed loops", ambit.mechanism "open", {})
  end)
end)

-- -- how a configuration depends on the data

local core = require "ambit.core"

-- Data within `tolerance`; a load on the slider.
local function tolerated(tolerance)
  local m = ambit.mechanism { "slider-crank", gravity = { 0, "-9.81", 0 } }
  local crank, rod = ambit.around(1, tolerance), ambit.around(3, tolerance)
  local pin = link(m, hinge(m, m.world, "phi"), crank, 0)
  local tip = link(m, hinge(m, pin, "psi"), rod, 0)
  local slider = m:prismatic { from = m.world, axis = "x", name = "s" }
  m:point_mass { at = pin, mass = ambit.around(1, tolerance) }
  m:point_mass { at = slider, mass = 2 }
  m:close_pin { a = tip, b = slider, name = "loop" }
  m:independent { "phi" }
  local found = m:assemble { phi = "0.7", guess = { psi = "-0.9", s = "3.6" }, within = "0.5" }
  return m, found, crank, rod
end

-- Closed forms for given lengths, as doubles.
local function true_position(crank, rod)
  local y = crank * math.sin(0.7)
  return { s = crank * math.cos(0.7) + math.sqrt(rod ^ 2 - y ^ 2), psi = -math.asin(y / rod) - 0.7, phi = 0.7 }
end

local function from_rest(configuration)
  local start = { ["phi'"] = 0 }
  for name, x in pairs(configuration) do start[name] = x end
  return start
end

describe("a configuration of uncertain data", function()
  it("is known as a function of them, up to terms of the third degree", function()
    local widths = {}
    for i, tolerance in ipairs { "0.1%", "1%" } do
      local _, found, crank, rod = tolerated(tolerance)
      local of, radius = found:of_data(), i == 1 and 1e-3 or 1e-2
      for _, corner in ipairs { { 1, 1 }, { 1, -1 }, { -1, 1 }, { -1, -1 }, { 0, 0 }, { 0.25, -0.75 } } do
        local a, b = 1 + radius * corner[1], 3 * (1 + radius * corner[2])
        for name, x in pairs(true_position(a, b)) do
          local at = core.substitute({ of[name] }, { crank, rod }, { core.expression(a), core.expression(b) })[1]
          local e = ambit.evaluate { at }
          assert.is_true(e.lo <= x + 1e-14 and e.hi >= x - 1e-14, name)
          widths[i] = math.max(widths[i] or 0, e:width())
        end
      end
    end
    assert.is_true(widths[1] < 1e-7 and widths[2] < 1e-4 and widths[2] > 100 * widths[1])
  end)

  it("starts a run correlated", function()
    local m, found = tolerated "1%"
    local run = ambit.simulate { m:dynamics(), initial = from_rest(found.configuration), t = { 0, "0.1" } }
    assert.equal("complete", run.status)
    assert.equal(5, run.report.unknowns) -- two lengths, a mass, and what is left of psi and s
    local again = m:assemble { phi = "0.7", guess = { psi = "-0.9", s = "3.6" }, within = "0.5" }
    local boxes = from_rest(again.configuration)
    for _, name in ipairs { "phi", "psi", "s" } do boxes[name] = core.interval(boxes[name].lo, boxes[name].hi) end
    local apart = ambit.simulate { m:dynamics(), initial = boxes, t = { 0, "0.1" } }
    assert.equal(6, apart.report.unknowns) -- 0.7 is no double
    for _, name in ipairs { "phi", "psi", "s" } do
      assert.is_true(run.x[name]:width() <= apart.x[name]:width() * (1 + 1e-6), name)
    end
  end)

  it("is a box where anything else was changed", function()
    local m, found = tolerated "1%"
    local data = require "ambit.assemble.data"
    local system, plain = m:dynamics(), {}
    for i in ipairs(system.states) do plain[i] = core.expression(i) end
    local function taken(start) return data.correlate(plain, start, system, { 0, 1 }) ~= plain end
    assert.is_true(taken(from_rest(found.configuration)))
    local other = from_rest(found.configuration)
    other.phi = "0.7"
    assert.is_false(taken(other)) -- another value of what was given
    other = from_rest(found.configuration)
    other.s, other.psi = other.psi, other.s
    assert.is_false(taken(other))
    local second = m:assemble { phi = "0.7", guess = { psi = "-0.9", s = "3.6" }, within = "0.5" }
    other = from_rest(found.configuration)
    other.s = second.configuration.s
    assert.is_false(taken(other)) -- of two assemblies
    local foreign = tolerated "1%"
    assert.is_true(data.correlate(plain, from_rest(found.configuration), foreign:dynamics(), { 0, 1 }) == plain)
  end)

  it("is a box where the data are exact or far too wide", function()
    assert.is_nil((select(2, tolerated(0))):of_data())
    local m = slider_crank()
    local two = m:assemble { phi = "0.7", box = { psi = { -4, 1 }, s = { -5, 5 } } }
    assert.is_nil(two:of_data()) -- exact, and one of several
  end)

  it("knows when the loops depend on time", function()
    local m = ambit.mechanism "driven"
    local rod = ambit.around(3, "1%")
    local pin = link(m, m:revolute { from = m.world, axis = "z", name = "phi", angle = ambit.time / 2 }, 1, 0)
    m:close_pin { a = link(m, hinge(m, pin, "psi"), rod, 0), b = m:prismatic { from = m.world, axis = "x", name = "s" } }
    local found = m:assemble { t = 1, guess = { psi = "-0.6", s = "3.8" }, within = "0.5" }
    assert.equal("unique", found.status)
    local data, system = require "ambit.assemble.data", m:dynamics()
    local plain = { core.expression(0), core.expression(0) }
    assert.is_true(data.correlate(plain, found.configuration, system, { 1, 2 }) ~= plain)
    assert.is_true(data.correlate(plain, found.configuration, system, { 0, 2 }) == plain)
  end)
end)
