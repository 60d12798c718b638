-- Reduction of mechanisms by their elements: a mechanism built anew against the same one built by hand, certificates
-- against small-step integration of equations written by hand, and what bad input is told.
local ambit = require "ambit"
local certify = require "ambit.reduce.certify.model"
local core = require "ambit.core"
local proof = require "ambit.reduce.certify.proof"
local reduction = require "ambit.reduce.mechanism"
local scenario = require "ambit.reduce.certify.scenario"
local session = require "ambit.session"
local around, between = ambit.around, ambit.between

local seed = 20261121
local function random(lo, hi) -- reproducible: a linear congruence
  seed = (seed * 1103515245 + 12345) % 2147483648
  return lo + (hi - lo) * seed / 2147483648
end

-- The candidates of a mechanism, by what they are called.
local function candidates(m, elements, outputs)
  outputs = outputs or { m:dynamics().states[1] }
  local detailed = certify.of(m, outputs, "reduce", {})
  local r = reduction.new(detailed, { elements = elements, outputs = outputs }, "reduce")
  local number = {}
  for k, c in ipairs(r.candidates) do number[c.name] = k end
  return r, number, detailed
end

local function without(m, elements, names, outputs)
  local r, number = candidates(m, elements, outputs)
  local cut = {}
  for i, name in ipairs(names) do cut[i] = assert(number[name], name) end
  return r:without(cut)
end

-- Both systems have the same rates, at random states.
local function assert_same(reduced, by_hand)
  local system = by_hand:dynamics()
  assert.same(system.states, reduced.states)
  for _ = 1, 5 do
    local at = {}
    for _, name in ipairs(system.states) do at[name] = core.literal(random(-1, 1)) end
    for i in ipairs(system.states) do
      local x = ambit.evaluate { system.rates[i], at = at, arithmetic = "real" }
      local y = ambit.evaluate { reduced.rates[i], at = at, arithmetic = "real" }
      local size = math.max(1, math.abs(x:mid()))
      assert.is_true(math.abs(x:mid() - y:mid()) <= 1e-11 * size, system.states[i])
    end
  end
end

-- A planar arm with everything in it that can be left out. skip: what is not built; the elbow then may be locked.
local function arm(skip)
  local m = ambit.mechanism { "arm", gravity = not skip.gravity and { 0, "-9.81", 0 } or nil }
  local upper, shoulder = m:revolute { from = m.world, axis = "z", name = "shoulder" }
  local middle = m:rigid_link { from = upper, offset = { 1, 0, 0 }, name = "bone" }
  local fore, elbow = m:revolute { from = middle, axis = "z", name = "elbow", angle = skip.elbow }
  local hand = m:rigid_link { from = fore, offset = { "0.8", 0, 0 } }
  m:rigid_body { at = upper, name = "humerus", mass = 2, centre = { "0.4", "0.1", 0 },
    inertia = not skip.inertia and { { "0.1", 0, 0 }, { 0, "0.2", 0 }, { 0, 0, "0.25" } } or nil }
  m:point_mass { at = hand, mass = "1.5", name = "hand" }
  if not skip.ring then m:point_mass { at = fore, mass = "0.01", name = "ring" } end
  if not skip.spring then m:joint_spring { joint = elbow, stiffness = 40, rest = "0.3", name = "spring" } end
  if not skip.damper then m:joint_damper { joint = shoulder, damping = "0.2", name = "damper" } end
  if skip.carried then
    m:applied_force { at = hand, force = { 0, 1.5 * 9.81, 0 } }
  end
  if not skip.law then
    local angle = skip.elbow and ambit.number(skip.elbow) or m:coordinate(elbow)
    m:joint_torque { joint = shoulder, torque = function(_, u) return -2 * u + angle end, name = "law" }
  end
  return m, hand
end

describe("a mechanism built anew", function()
  it("is the one without the part, built by hand", function()
    for _, pair in ipairs { { "ring", "ring" }, { "damper", "damper" }, { "law", "law" }, { "spring", "spring" },
      { "gravity1", "gravity" }, { "humerus: inertia", "inertia" } } do
      assert_same(without(arm {}, true, { pair[1] }), (arm { [pair[2]] = true }))
    end
    assert_same(without(arm {}, true, { "hand: weight" }), (arm { carried = true }))
    assert_same(without(arm {}, true, { "ring", "damper", "spring" }),
      (arm { ring = true, damper = true, spring = true }))
    assert_same(without(arm {}, true, {}), (arm {}))
  end)

  it("locks the joint of a rigid spring, and what laws say of it", function()
    assert_same(without(arm {}, true, { "spring: rigid" }), (arm { elbow = "0.3" }))
    assert_same(without(arm {}, true, { "spring: rigid", "ring", "spring" }), (arm { elbow = "0.3", ring = true }))
    assert_same(without(arm {}, { { "elbow", at = "-0.7" } }, { "elbow: locked" }), (arm { elbow = "-0.7" }))
    assert_same(without(arm {}, { "elbow" }, { "elbow: locked" }), (arm { elbow = 0 }))
    local m = arm {}
    m:reference { elbow = "0.25" }
    assert_same(without(m, { "elbow" }, { "elbow: locked" }), (arm { elbow = "0.25" }))
  end)

  it("shares its unknowns with the original", function()
    local mass, stiffness = around(2, "1%"), between(90, 110)
    local m = ambit.mechanism "slide"
    local at, joint = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = at, mass = mass, name = "big" }
    m:point_mass { at = at, mass = around("0.01", "5%"), name = "small" }
    m:joint_spring { joint = joint, stiffness = stiffness }
    local reduced = without(m, true, { "small" })
    local x = ambit.evaluate { reduced.rates[2] * mass + stiffness * m:coordinate(joint), at = { s = 1 },
      arithmetic = "taylor_model" }
    assert.is_true(x:mag() < 1e-6) -- two fresh unknowns would leave 4
  end)

  it("stands where its spring is slack", function()
    local m = ambit.mechanism "springs"
    local slide, joint = m:prismatic { from = m.world, axis = "x", name = "s" }
    local fore = m:revolute { from = slide, axis = "z", name = "q" }
    local tip = m:rigid_link { from = fore, offset = { 2, 0, 0 } }
    m:point_mass { at = tip, mass = 1 }
    m:spring_damper { from = m.world, from_offset = { "-0.3", "0.4", 0 }, to = slide, stiffness = 5, length = 1,
      name = "rod" }
    m:spring_damper { from = slide, from_offset = { 1, 1, 0 }, to = tip, stiffness = 5, length = "1.5", name = "stay" }
    local r, number = candidates(m, true)
    local function at(name) return core.evaluate { expressions = r.candidates[number[name]].motions }[1] end
    assert.is_true(at("rod: rigid"):contains(-0.3 + math.sqrt(1 - 0.16)))
    local q = at("stay: rigid"):mid() -- the circle about (1, 1) with radius 1.5 and that about 0 with radius 2
    assert.is_true(math.abs((2 * math.cos(q) - 1) ^ 2 + (2 * math.sin(q) - 1) ^ 2 - 2.25) < 1e-12)
    assert.is_true(math.abs(q) < 0.1)
  end)

  it("knows springs that are slack nowhere", function()
    local m = ambit.mechanism "far"
    local arm = m:revolute { from = m.world, axis = "z", name = "q" }
    local tip = m:rigid_link { from = arm, offset = { 1, 0, 0 } }
    m:point_mass { at = tip, mass = 1 }
    m:spring_damper { from = m.world, from_offset = { 3, 0, 0 }, to = tip, stiffness = 5, length = 1, name = "far" }
    m:spring_damper { from = m.world, to = tip, stiffness = 5, length = 1, name = "radius" }
    local _, number = candidates(m, true)
    assert.is_true(number["far"] and number["radius"] and not number["far: rigid"] and not number["radius: rigid"])
    for _, name in ipairs { "far: rigid", "radius: rigid" } do
      local good, message = pcall(candidates, m, { name })
      assert.is_false(good)
      assert.truthy(message:find("it is slack at no position of its joint", 1, true), message)
    end
  end)

  it("welds a free body in its bushing", function()
    local m = ambit.mechanism { "bushing", gravity = { 0, 0, "-9.81" } }
    local beam = m:revolute { from = m.world, axis = "y", name = "beam" }
    local seat = m:rigid_link { from = beam, offset = { 1, 0, 0 } }
    m:point_mass { at = seat, mass = 2 }
    local body = m:free { from = seat, name = "body" }
    m:rigid_body { at = body, mass = 3, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    m:bushing { from = seat, to = body, stiffness = { 1e5, 1e5, 1e5 }, rotational_stiffness = { 1e4, 1e4, 1e4 },
      name = "bush" }
    local hand = ambit.mechanism { "bushing", gravity = { 0, 0, "-9.81" } }
    local at = hand:rigid_link { from = hand:revolute { from = hand.world, axis = "y", name = "beam" },
      offset = { 1, 0, 0 } }
    hand:point_mass { at = at, mass = 2 }
    hand:rigid_body { at = at, mass = 3, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    assert_same(without(m, { "bush: rigid" }, { "bush: rigid" }), hand)
  end)

  it("follows a servo whose spring is rigid", function()
    local function build(rigid)
      local m = ambit.mechanism "servo"
      local wanted = ambit.sin(3 * ambit.time)
      local at, joint = m:prismatic { from = m.world, axis = "x", name = "s", displacement = rigid and wanted or nil }
      local swing = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" }, offset = { 0, -1, 0 } }
      m:point_mass { at = swing, mass = 1 }
      if not rigid then m:joint_spring { joint = joint, stiffness = 1e5, rest = wanted, name = "servo" } end
      return m
    end
    local reduced, by_hand = without(build(false), { "servo" }, { "servo: rigid" }), build(true):dynamics()
    assert.same({ "q", "q'" }, reduced.states)
    for _, t in ipairs { 0, 0.4, 1 } do
      local at = { q = "0.5", ["q'"] = "0.3", t = core.literal(t) }
      local x = ambit.evaluate { reduced.rates[2], at = at }
      local y = ambit.evaluate { by_hand.rates[2], at = at }
      assert.is_true(math.abs(x:mid() - y:mid()) < 1e-13)
    end
  end)

  it("can be built anew itself, and refers to what the first one did", function()
    local m, hand = arm {}
    m:reference { shoulder = "0.5", elbow = "0.25" }
    local outputs = { y = function(_, _, _, at) return at:position(hand).y end }
    local _, first = without(m, true, { "ring" }, outputs)
    assert.equal(0.25, first:reference().elbow)
    local reduced, second = without(first, { "elbow" }, { "elbow: locked" }, outputs)
    assert_same(reduced, (arm { ring = true, elbow = "0.25" }))
    assert.equal(0.5, second:reference().shoulder)
    local y = ambit.evaluate { second:position(hand).y, at = { shoulder = "0.2" } }
    assert.is_true(math.abs(y:mid() - math.sin(0.2) - 0.8 * math.sin(0.45)) < 1e-14)
  end)

  it("takes robots as they were loaded", function()
    local m = ambit.load { "scripts/robots/ur5.urdf" }
    local outputs = { z = function(_, _, _, mechanism) return mechanism:position(mechanism:link "tool0").z end }
    local r = candidates(m, { { m:coordinate_names()[6] } }, outputs)
    local reduced, copy = r:without { 1 }
    assert.equal(10, #reduced.states)
    assert.equal(1, #reduced.outputs)
    assert.equal(core.part_count(m.handle), core.part_count(copy.handle))
  end)
end)

describe("outputs of both mechanisms", function()
  it("are states, expressions, or what a function of the mechanism measures", function()
    local m, hand = arm {}
    local outputs = { "elbow", "elbow''", "shoulder'", x = m:position(hand).x,
      y = function(_, _, _, at) return at:position(hand).y end, sum = function(s) return s.elbow + s.shoulder end }
    local r = candidates(m, true, outputs)
    local reduced = without(m, true, { "spring: rigid" }, outputs)
    local by_name, at = {}, { shoulder = "0.2", ["shoulder'"] = "0.7" }
    for i, output in ipairs(reduced.outputs) do
      assert.equal(r.detailed.outputs[i].name, output.name)
      by_name[output.name] = ambit.evaluate({ output.expression, at = at }):mid()
    end
    local function near(x, y) assert.is_true(math.abs(x - y) < 1e-14, ("%.17g %.17g"):format(x, y)) end
    near(by_name.elbow, 0.3)
    near(by_name["elbow''"], 0)
    near(by_name["shoulder'"], 0.7)
    near(by_name.x, math.cos(0.2) + 0.8 * math.cos(0.5))
    near(by_name.y, math.sin(0.2) + 0.8 * math.sin(0.5))
    near(by_name.sum, 0.5)
  end)

  it("say the rates of what stands still, and see no other states than there were", function()
    local m = ambit.mechanism "tumbling cart"
    local cart, drive = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = cart, mass = 1 }
    m:joint_spring { joint = drive, stiffness = 1e4, rest = ambit.sin(3 * ambit.time), name = "servo" }
    local body = m:spherical_quaternion { from = cart, name = "b" }
    m:rigid_body { at = body, mass = 1, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, 3 } } }
    local function sum(s)
      local total = ambit.number(0)
      for _, value in pairs(s) do total = total + value end
      return total
    end
    local outputs = { "b.1'", "s", "s'", "s''", sum = sum }
    local still = without(m, { "b" }, { "b: locked" }, outputs)
    assert.equal(core.expression(0), still.outputs[1].expression)
    local led, by_name = without(m, { "servo: rigid" }, { "servo: rigid" }, outputs), {}
    local at = { t = "0.4", ["b.1"] = 1, ["b.2"] = 2, ["b.3"] = 3, ["b.4"] = 4, ["b'.1"] = 5, ["b'.2"] = 6,
      ["b'.3"] = 7 }
    for _, output in ipairs(led.outputs) do
      by_name[output.name] = ambit.evaluate({ output.expression, at = at }):mid()
    end
    local x, v = math.sin(1.2), 3 * math.cos(1.2)
    for name, value in pairs { s = x, ["s'"] = v, ["s''"] = -9 * x, sum = 28 + x + v } do
      assert.is_true(math.abs(by_name[name] - value) < 1e-12, name)
    end
  end)

  it("have the accelerations of their own mechanism", function()
    local m, hand = arm {}
    local outputs = { a = function(_, _, _, at) return at:acceleration(hand).y end }
    local reduced = without(m, true, { "ring", "damper" }, outputs)
    local by_hand, own = arm { ring = true, damper = true }
    local wanted = certify.of(by_hand, { a = by_hand:acceleration(own).y }, "reduce", {})
    local at = { shoulder = "0.2", elbow = "-0.4", ["shoulder'"] = "0.7", ["elbow'"] = "0.1" }
    local x = ambit.evaluate { reduced.outputs[1].expression, at = at }
    local y = ambit.evaluate { wanted.outputs[1].expression, at = at }
    assert.is_true(math.abs(x:mid() - y:mid()) < 1e-12)
  end)
end)

-- x(t) at equal steps by the classical Runge-Kutta method: rates(x) -> list.
local function integrate(rates, x, t, steps, see)
  local h, n = t / steps, #x
  local function along(a, k, s)
    local y = {}
    for i = 1, n do y[i] = a[i] + s * k[i] end
    return y
  end
  see(x)
  for _ = 1, steps do
    local a = rates(x)
    local b = rates(along(x, a, h / 2))
    local c = rates(along(x, b, h / 2))
    local d = rates(along(x, c, h))
    local y = {}
    for i = 1, n do y[i] = x[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
    x = y
    see(x)
  end
end

local function history(rates, x, t, steps, output)
  local list = {}
  integrate(rates, x, t, steps, function(y) list[#list + 1] = output(y) end)
  return list
end

local function greatest(a, b)
  local most = 0
  for i, x in ipairs(a) do most = math.max(most, math.abs(x - b[i])) end
  return most
end

-- The proved errors of a mechanism without the parts `names`.
local function prove(m, elements, names, outputs, t, initial)
  local r, number, detailed = candidates(m, elements, outputs)
  local cut = {}
  for i, name in ipairs(names) do cut[i] = assert(number[name], name) end
  local scenarios = scenario.list({ t = t, initial = initial }, detailed, "reduce")
  local how = { solver = "lohner", criterion = "difference" }
  local result = proof.prove(detailed, assert(r:without(cut)), scenarios, how)
  session.worst = "ok"
  assert.equal("proved", result.status, result.reason)
  return result.error
end

describe("the certificate of a mechanism without a part", function()
  it("bounds a small mass on a spring, for all data", function()
    local m = ambit.mechanism "slide"
    local at, joint = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = at, mass = around(2, "1%"), name = "big" }
    m:point_mass { at = at, mass = around("0.01", "5%"), name = "small" }
    m:joint_spring { joint = joint, stiffness = between(9, 10), name = "spring" }
    local proved = prove(m, true, { "small" }, { "s" }, { 0, 3 }, { s = around("0.1", "10%"), ["s'"] = 0 }).s
    local most = 0
    for _ = 1, 200 do
      local big, small, k = random(1.98, 2.02), random(0.0095, 0.0105), random(9, 10)
      local start, w, v = random(0.09, 0.11), math.sqrt(k / (big + small)), math.sqrt(k / big)
      for i = 0, 300 do
        most = math.max(most, start * math.abs(math.cos(w * i / 100) - math.cos(v * i / 100)))
      end
    end
    assert.is_true(most > 0.001 and most <= proved and proved <= 2 * most, ("%g %g"):format(most, proved))
  end)

  it("bounds a light damper of a pendulum", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, -10, 0 } }
    local at, joint = m:revolute { from = m.world, axis = "z", name = "q" }
    local bob = m:rigid_link { from = at, offset = { 0, -1, 0 } }
    m:point_mass { at = bob, mass = 2, name = "bob" }
    m:joint_damper { joint = joint, damping = between("0.002", "0.004"), name = "damper" }
    local outputs = { "q", x = function(_, _, _, mechanism) return mechanism:position(bob).x end }
    local proved = prove(m, { "damper" }, { "damper" }, outputs, { 0, 2 },
      { q = around("0.5", "0.01"), ["q'"] = 0 })
    for _ = 1, 10 do
      local q, d = random(0.49, 0.51), random(0.002, 0.004)
      local function motion(c)
        local function of(see)
          return history(function(x) return { x[2], -10 * math.sin(x[1]) - c / 2 * x[2] } end, { q, 0 }, 2, 400, see)
        end
        return of(function(x) return x[1] end), of(function(x) return math.sin(x[1]) end)
      end
      local damped, damped_x = motion(d)
      local free, free_x = motion(0)
      assert.is_true(greatest(damped, free) <= proved.q and greatest(damped_x, free_x) <= proved.x)
      assert.is_true(proved.q <= 4 * greatest(damped, free))
    end
  end)

  it("bounds a stiff spring that is made rigid", function()
    local m = ambit.mechanism "two slides"
    local first, drive = m:prismatic { from = m.world, axis = "x", name = "a" }
    local second, stiff = m:prismatic { from = first, axis = "x", name = "b" }
    m:point_mass { at = first, mass = 1 }
    m:point_mass { at = second, mass = around("0.5", "0.5%") }
    m:joint_spring { joint = drive, stiffness = 4 }
    m:joint_spring { joint = stiff, stiffness = between(990, 1010), rest = "0.2", name = "stiff" }
    m:joint_damper { joint = stiff, damping = 2 }
    local outputs = { "a", tip = function(_, _, _, mechanism) return mechanism:position(second).x end, "b" }
    local initial = { a = "0.5", b = between("0.1995", "0.2005"), ["a'"] = 0, ["b'"] = 0 }
    local proved = prove(m, { "stiff: rigid" }, { "stiff: rigid" }, outputs, { 0, "0.5" }, initial)
    local most = 0
    for _ = 1, 10 do
      local mass, k, b = random(0.4975, 0.5025), random(990, 1010), random(0.1995, 0.2005)
      local function rates(x) -- (1 + m) a'' + m b'' = -4 a, m (a'' + b'') = -k (b - 0.2) - 2 b'
        local f = -k * (x[2] - 0.2) - 2 * x[4]
        local a = -4 * x[1] - f
        return { x[3], x[4], a, f / mass - a }
      end
      local function rigid(x) return { x[2], -4 * x[1] / (1 + mass) } end
      local function of(see) return history(rates, { 0.5, b, 0, 0 }, 0.5, 1000, see) end
      local a, tip, b_list = of(function(x) return x[1] end), of(function(x) return x[1] + x[2] end),
        of(function(x) return x[2] end)
      local still = history(rigid, { 0.5, 0 }, 0.5, 1000, function(x) return x[1] end)
      local still_tip, rest = {}, {}
      for i, x in ipairs(still) do still_tip[i], rest[i] = x + 0.2, 0.2 end
      local error_a, error_tip, error_b = greatest(a, still), greatest(tip, still_tip), greatest(b_list, rest)
      assert.is_true(error_a <= proved.a and error_tip <= proved.tip and error_b <= proved.b)
      most = math.max(most, error_a)
    end
    assert.is_true(most > 1e-4 and proved.a <= 3 * most, ("%g %g"):format(most, proved.a))
  end)
end)

-- A carriage with a swinging load: everything that a report can say.
local function crane()
  local m = ambit.mechanism { "crane", gravity = { 0, "-9.81", 0 } }
  local at, drive = m:prismatic { from = m.world, axis = "x", name = "s" }
  local rope, pin = m:revolute { from = at, axis = "z", name = "q" }
  local load = m:rigid_link { from = rope, offset = { 0, -2, 0 }, name = "rope" }
  m:point_mass { at = at, mass = 5, name = "carriage" }
  m:point_mass { at = load, mass = around(3, "1%"), name = "load" }
  m:point_mass { at = load, mass = "0.002", name = "label" }
  m:joint_spring { joint = drive, stiffness = 300, name = "buffer" }
  m:joint_damper { joint = pin, damping = "0.0005", name = "pin" }
  return m, load
end

local start = { s = 0, q = around("0.2", "0.005"), ["s'"] = 0, ["q'"] = 0 }

local function reduce(t)
  local m, load = crane()
  local request = { m, t = { 0, "0.5" }, initial = start, reductions = {},
    outputs = { x = function(_, _, _, at) return at:position(load).x end }, error = { x = "5 mm" } }
  for key, value in pairs(t) do request[key] = value end
  local result = ambit.reduce(request)
  session.worst = "ok"
  return result, m
end

local function by_name(result)
  local rows = {}
  for _, row in ipairs(result.terms) do rows[("%s: %s"):format(row.equation, row.technique)] = row end
  return rows
end

describe("reduce with elements", function()
  it("names the parts that went and those that stay", function()
    local result, m = reduce { elements = true }
    assert.equal("complete", result.status)
    local rows = by_name(result)
    assert.equal("cut", rows["label: left out"].status)
    assert.equal("cut", rows["pin: left out"].status)
    assert.equal("removed", rows["label: without weight"].status)
    assert.equal("kept", rows["gravity1: left out"].status)
    for _, row in ipairs(result.terms) do assert.equal("element", row.level) end
    assert.is_true(result.error.x <= 0.005 and result.error.x > 0)
    assert.truthy(tostring(result):find("label", 1, true))
    local gone = 0
    for _, row in ipairs(result.terms) do
      if row.status == "cut" and row.technique == "left out" then gone = gone + 1 end
      if row.status == "cut" and row.technique == "without weight" then gone = gone - 1 end -- a force carries it
    end
    assert.equal(#m:tree().parts - gone, #result.mechanism:tree().parts)
    -- both mechanisms, integrated at random data
    for _ = 1, 5 do
      local q, most = core.literal(random(0.196, 0.204)), 0
      local ends = {}
      for k, subject in ipairs { m:dynamics(), result.ode } do
        local run = ambit.simulate { subject, t = { 0, "0.1", "0.2", "0.3", "0.4", "0.5" }, solver = "gsl",
          initial = (function()
            local all, own = { s = 0, q = q, ["s'"] = 0, ["q'"] = 0 }, {}
            for _, name in ipairs(subject.states) do own[name] = all[name] end
            return own
          end)() }
        ends[k] = {}
        for i = 1, 5 do
          local x = run:at(i / 10)
          ends[k][i] = (x.s and x.s:mid() or 0) + 2 * math.sin(x.q:mid())
        end
      end
      for i = 1, 5 do most = math.max(most, math.abs(ends[1][i] - ends[2][i])) end
      assert.is_true(most <= result.error.x, ("%g %g"):format(most, result.error.x))
    end
  end)

  it("takes joints with quaternions", function()
    local m = ambit.mechanism "tumbling"
    local body = m:spherical_quaternion { from = m.world, name = "body" }
    m:rigid_body { at = body, mass = 1, inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, 3 } } }
    m:rigid_body { at = body, name = "tag", mass = 1,
      inertia = { { "0.001", 0, 0 }, { 0, "0.001", 0 }, { 0, 0, "0.001" } } }
    local initial = { ["body.1"] = 1, ["body.2"] = 0, ["body.3"] = 0, ["body.4"] = 0, ["body'.1"] = "0.3",
      ["body'.2"] = 2, ["body'.3"] = "0.1" }
    local result = ambit.reduce { m, t = { 0, 1 }, initial = initial, outputs = { "body'.1" },
      error = { ["body'.1"] = "0.05" }, elements = { "tag" }, reductions = {} }
    local function spin(more) -- Euler's equations
      local a, b, c = 1 + more, 2 + more, 3 + more
      return history(function(w)
        return { (b - c) / a * w[2] * w[3], (c - a) / b * w[3] * w[1], (a - b) / c * w[1] * w[2] }
      end, { 0.3, 2, 0.1 }, 1, 500, function(w) return w[1] end)
    end
    local most = greatest(spin(0.001), spin(0))
    assert.equal("cut", result.terms[1].status)
    local proved = result.error["body'.1"]
    assert.is_true(most <= proved and proved <= 1.5 * most, ("%g %g"):format(most, proved))
  end)

  it("leaves what is named in keep, and undoes what is over the bound", function()
    local result = reduce { elements = { "label", "pin", "buffer: rigid" }, keep = { "pin" },
      error = { x = "1e-3 mm" } }
    local rows = by_name(result)
    assert.is_nil(rows["pin: left out"])
    assert.equal("kept", rows["buffer: rigid"].status) -- the carriage moves by millimetres
    assert.is_true(result.error.x <= 1e-6)
    assert.equal(4, #result.ode.states)
  end)

  it("says of two springs of a joint which one it follows", function()
    local m = ambit.mechanism "two springs"
    local first = m:prismatic { from = m.world, axis = "x", name = "a" }
    local second, joint = m:prismatic { from = first, axis = "x", name = "b" }
    m:point_mass { at = first, mass = 1 }
    m:point_mass { at = second, mass = 1 }
    m:joint_spring { joint = joint, stiffness = 4, rest = "0.1", name = "soft" }
    m:joint_spring { joint = joint, stiffness = 9, rest = "0.3", name = "hard" }
    local result = ambit.reduce { m, t = { 0, "0.1" }, initial = { a = 0, b = "0.2", ["a'"] = 1, ["b'"] = 0 },
      outputs = { "b" }, error = { b = 1 }, elements = { "soft: rigid", "hard: rigid" }, reductions = {} }
    local rows = by_name(result)
    assert.equal("cut", rows["soft: rigid"].status)
    assert.equal("removed", rows["hard: rigid"].status)
    assert.is_true(ambit.evaluate { result.model.outputs[1].expression }:contains("0.1"))
  end)

  it("goes on with the terms of what is left", function()
    local result = reduce { elements = { "label", "pin" }, reductions = { "neglect" }, levels = 1,
      error = { x = "2 cm" } }
    local passes = {}
    for _, row in ipairs(result.terms) do passes[row.level] = true end
    assert.is_true(passes.element and passes[1])
    assert.is_true(result.error.x <= 0.02)
  end)

  it("measures with the data of the scenario", function()
    local length = around(2, "1%")
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local arm, pin = m:revolute { from = m.world, axis = "z", name = "q" }
    local bob = m:rigid_link { from = arm, offset = { 0, -length, 0 } }
    m:point_mass { at = bob, mass = 1 }
    m:joint_damper { joint = pin, damping = "0.001", name = "pin" }
    local result = ambit.reduce { m, t = { 0, 1 }, initial = { q = "0.2", ["q'"] = 0 }, reductions = {},
      elements = { "pin" }, outputs = { x = function(_, _, _, at) return at:position(bob).x end }, error = { x = 1 },
      parameters = { [length] = "0.5" } }
    for _, leaf in ipairs(core.leaves { result.model.outputs[1].expression }) do assert.equal("symbol", leaf.kind) end
    local function swing(damping) -- q'' = -g/l sin q - d/(m l^2) q'
      return history(function(x) return { x[2], -19.62 * math.sin(x[1]) - 4 * damping * x[2] } end, { 0.2, 0 }, 1, 500,
        function(x) return 0.5 * math.sin(x[1]) end)
    end
    local most = greatest(swing(0.001), swing(0))
    assert.is_true(most <= result.error.x and result.error.x <= 1.5 * most, ("%g %g"):format(most, result.error.x))
  end)

  it("says what cannot be left out, and which names there are", function()
    local function refused(part, t)
      local good, message = pcall(reduce, t)
      assert.is_false(good, part)
      if not tostring(message):find(part, 1, true) then error(("expected %q, got %s"):format(part, message), 2) end
    end
    refused("has no part `lable`; did you mean `label`?", { elements = { "lable" } })
    refused("`rope`: it cannot be left out, other parts hang on it", { elements = { "rope" } })
    refused("it is a joint_damper: expected a joint_spring", { elements = { "pin: rigid" } })
    refused("there is no `ridig`; did you mean `rigid`?", { elements = { "buffer: ridig" } })
    refused("it is no rigid_body", { elements = { "load: inertia" } })
    refused("`label` is named twice", { elements = { "label", "label" } })
    refused("expected names of parts", { elements = { 3 } })
    refused("expected true or", { elements = "label" })
    refused("`at` is of a joint", { elements = { { "label", at = 1 } } })
    refused("`at` moves with `s`", { elements = { { "q", at = crane():coordinates().s } } })
  end)

  it("wants an inertia for every motion", function()
    local m = ambit.mechanism "slide"
    m:point_mass { at = m:prismatic { from = m.world, axis = "x", name = "s" }, mass = 1, name = "carriage" }
    local good, message = pcall(ambit.reduce, { m, t = { 0, 1 }, initial = { s = 0, ["s'"] = 1 }, outputs = { "s" },
      error = { s = 1 }, elements = { "carriage" } })
    assert.is_false(good)
    assert.truthy(message:find("`carriage` cannot be left out: the motion of `s` would have no inertia", 1, true))
    good, message = pcall(ambit.reduce, { m, t = { 0, 1 }, initial = { s = 0, ["s'"] = 1 }, outputs = { "s" },
      error = { s = 1 }, elements = { "s" } })
    assert.is_false(good)
    assert.truthy(message:find("nothing would be left that moves", 1, true))
  end)

  it("refuses closed loops and systems that are no mechanism", function()
    local m = ambit.mechanism "loop"
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 1, 0, 0 } }
    local slider = m:prismatic { from = m.world, axis = "x", name = "b" }
    m:point_mass { at = tip, mass = 1 }
    m:point_mass { at = slider, mass = 1 }
    m:close_distance { a = tip, b = slider, length = 2 }
    m:reference { a = 1, b = "2.3" }
    local good, message = pcall(ambit.reduce, { m, t = { 0, "0.1" }, initial = { a = 1, b = "2.34", ["a'"] = 0 },
      outputs = { "a" }, error = { a = 1 }, elements = true })
    assert.is_false(good)
    assert.truthy(message:find("closed loops or gears", 1, true), message)
    local system = ambit.ode { states = { "x" }, equations = function(s) return { -s.x + 0.01 * s.x ^ 2 } end }
    good, message = pcall(ambit.reduce, { system, t = { 0, 1 }, initial = { 1 }, outputs = { "x" }, error = { x = 1 },
      elements = true })
    assert.is_false(good)
    assert.truthy(message:find("is no mechanism", 1, true), message)
  end)

  -- Formulas for accelerations of six links with tolerances divide by what may be 0; balances do not. The error is held
  -- against ordinary runs of both mechanisms at corners of the data.
  it("proves chains by balances of forces", function()
    local function chain(labelled, length, mass)
      local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
      local at = m.world
      for k = 1, 6 do
        at = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" .. k }, offset = { length, 0, 0 } }
        m:point_mass { at = at, mass = mass, name = "mass" .. k }
      end
      if labelled then m:point_mass { at = at, mass = "0.01", name = "label" } end
      return m
    end
    local initial, times, far = {}, {}, { q2 = 0, q6 = 0 }
    for k = 1, 6 do initial["q" .. k], initial["q" .. k .. "'"] = k == 1 and "-0.5" or "0.1", 0 end
    for k = 1, 11 do times[k] = (k - 1) / 50 end
    local small = ambit.reduce { chain(true, ambit.around(1, "0.1%"), ambit.around(1, "0.1%")), t = { 0, "0.2" },
      initial = initial, outputs = { "q2", "q6" }, error = { q2 = 1, q6 = 1 }, elements = { "label" }, reductions = {},
      solver = "zonotope" }
    assert.equal("complete", small.status)
    for corner = 0, 3 do
      local length, mass = corner & 1 == 0 and 0.999 or 1.001, corner & 2 == 0 and 0.999 or 1.001
      local a = ambit.simulate { chain(true, length, mass), t = times, initial = initial, solver = "gsl" }
      local b = ambit.simulate { chain(false, length, mass), t = times, initial = initial, solver = "gsl" }
      for k = 2, #times do
        for name in pairs(far) do
          far[name] = math.max(far[name], math.abs(a:at(times[k])[name]:mid() - b:at(times[k])[name]:mid()))
        end
      end
    end
    for name, most in pairs(far) do
      assert.is_true(most > 1e-5 and small.error[name] >= most * (1 - 1e-6) and small.error[name] <= 1.05 * most)
    end
  end)
end)
