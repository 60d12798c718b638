-- The implicit form of mechanisms against the explicit one, which is written in another way: residuals at the explicit
-- accelerations, speeds and multipliers; linearity; stages; and the solution in the order that is handed on.
local ambit = require "ambit"
local core = require "ambit.core"

-- -- mechanisms

local inertia = { { "0.31", "0.02", "-0.01" }, { "0.02", "0.4", "0.03" }, { "-0.01", "0.03", "0.35" } }

local function body(m, at)
  m:rigid_body { at = at, mass = "1.7", centre = { "0.11", "-0.07", "0.23" }, inertia = inertia }
end

-- One body on each joint, all in a chain, each joint with another axis.
local function chain(kinds)
  local m = ambit.mechanism { table.concat(kinds, ", "), gravity = { "0.4", "-1.1", "-9.81" } }
  local axes, at, joints = { "x", { 1, 2, 2 }, "z", { "-0.6", 0, "0.8" } }, m.world, {}
  for i, kind in ipairs(kinds) do
    local t = { from = m:rigid_link { from = at, offset = { "0.3", "-0.2", "0.5" } }, name = "j" .. i }
    if kind == "revolute" or kind == "prismatic" or kind == "cylindrical" then t.axis = axes[i % 4 + 1] end
    if kind == "screw" then t.axis, t.pitch = axes[i % 4 + 1], "0.05" end
    if kind == "universal" or kind == "planar" then t.first, t.second = "x", "y" end
    if kind == "follower" then
      kind, t.axis, t.mimic = "revolute", "y", { joint = joints[1], multiplier = "-1.5", offset = "0.2" }
    elseif kind == "driven" then
      kind, t.axis, t.angle = "revolute", "y", ambit.sin(ambit.time) / 2
    elseif kind == "linked" then
      kind, t.axis, t.angle = "revolute", "y", ambit.sin(m:coordinate(joints[1])) * ambit.time
    end
    at, joints[i] = m[kind](m, t)
    body(m, at)
  end
  return m, joints, at
end

local trees = {}

for i, kinds in ipairs {
  { "revolute", "revolute" }, { "prismatic", "screw", "cylindrical" }, { "universal", "planar" },
  { "spherical", "revolute" }, { "free", "prismatic" }, { "spherical_quaternion", "revolute", "spherical_quaternion" },
  { "free_quaternion", "universal" }, { "revolute", "follower", "prismatic" }, { "revolute", "driven", "revolute" },
  { "revolute", "linked", "screw" },
} do
  trees[i] = function() return (chain(kinds)) end
end

-- Every force there is, on everything it may depend on.
trees[#trees + 1] = function()
  local m, joints, tip = chain { "revolute", "prismatic", "revolute" }
  m:joint_spring { joint = joints[1], stiffness = 12, rest = "0.1" }
  m:joint_damper { joint = joints[2], damping = "0.7" }
  m:joint_friction { joint = joints[3], coulomb = 2, viscous = "0.1", static = 3 }
  m:armature { joint = joints[1], inertia = "0.2" }
  m:armature { joint = joints[2], mass = "0.4" }
  local q = m:coordinate(joints[2])
  m:joint_torque { joint = joints[3], torque = function(x, rate, t) return -x * q - rate ^ 3 + ambit.sin(t) end }
  m:spring_damper { from = m.world, to = tip, from_offset = { 2, 1, 0 }, stiffness = 30, length = "0.5", damping = 2 }
  m:force_law { from = m.world, to = tip, from_offset = { -2, 1, 3 },
    force = function(length, rate, t) return ambit.exp(-length) * rate + t / (1 + length ^ 2) end }
  m:applied_force { at = tip, force = { 1, ambit.time, q }, axes = "body", offset = { 0, "0.1", 0 } }
  m:applied_torque { at = tip, torque = function(w, t) return { -w[1], -w[2] * t, 0 } end }
  m:bushing { from = m.world, to = tip, stiffness = { 3, 4, 5 }, damping = { 1, 1, 1 },
    rotational_stiffness = { 1, 2, 3 } }
  return m
end

-- A branching tree.
trees[#trees + 1] = function()
  local m = ambit.mechanism { "tree", gravity = { 0, 0, "-9.81" } }
  local trunk = m:revolute { from = m.world, axis = "x", name = "trunk" }
  body(m, trunk)
  for i = 1, 3 do
    local at = m:rigid_link { from = trunk, offset = { i, "0.5", 0 } }
    for k = 1, i do
      at = m:revolute { from = at, axis = k % 2 == 0 and "y" or "z", name = ("b%d%d"):format(i, k) }
      body(m, at)
    end
  end
  return m
end

trees[#trees + 1] = function()
  return ambit.load { "scripts/robots/ur5.urdf", gravity = { 0, 0, "-9.81" } }
end

local loops = {}

-- A slider-crank; heavy: does the rod have a mass of its own, besides the slider's?
local function slider_crank(heavy)
  local m = ambit.mechanism { "slider-crank", gravity = { 0, "-9.81", 0 } }
  local crank, joint = m:revolute { from = m.world, axis = "z", name = "crank" }
  local tip = m:rigid_link { from = crank, offset = { 1, 0, 0 } }
  local slider = m:prismatic { from = m.world, axis = "x", name = "slider" }
  local hinge = m:revolute { from = slider, axis = "z", name = "rod" }
  m:point_mass { at = tip, mass = 1 }
  m:point_mass { at = slider, mass = 2 }
  if heavy then body(m, hinge) end
  m:joint_friction { joint = joint, coulomb = "0.3", viscous = "0.1" }
  m:close_pin { a = tip, b = m:rigid_link { from = hinge, offset = { -2, 0, 0 } }, name = "loop" }
  m:reference { crank = 1, slider = "2.3", rod = "-0.4" }
  m:independent { "crank" }
  return m
end

loops[1] = function() return slider_crank(true) end
loops[2] = function() return slider_crank(false) end -- a rod without mass has no pivot of its own

-- Two loops in space, with redundant rows, a hinge, a distance that is driven, and a spring across.
loops[3] = function()
  local m = ambit.mechanism { "four-bars", gravity = { 0, "-9.81", "0.3" } }
  local function bar(from, name, length)
    local at = m:revolute { from = from, axis = "z", name = name }
    body(m, at)
    return m:rigid_link { from = at, offset = { length, 0, 0 } }
  end
  local a = bar(m.world, "a", "0.5")
  local b = bar(a, "b", 2)
  local c = bar(m:rigid_link { from = m.world, offset = { "1.8", 0, 0 } }, "c", "1.2")
  m:close_revolute { a = b, b = c, axis = "z", name = "first" }
  local d = bar(m:rigid_link { from = c, offset = { "0.1", "0.2", 0 } }, "d", "0.7")
  m:close_distance { a = d, b = m:rigid_link { from = m.world, offset = { 3, 1, 0 } }, name = "rod",
    length = "1.3" + ambit.sin(ambit.time) / 10 }
  m:spring_damper { from = a, to = d, stiffness = 20, length = "0.8", damping = 1 }
  m:reference { a = 1, b = "-0.3", c = 1, d = "-0.5" }
  return m
end

-- Gears and a rack: constraints between joints; one of them is turned by a given motion.
loops[4] = function()
  local m = ambit.mechanism "gears"
  local joints = {}
  for i = 1, 3 do
    local at
    at, joints[i] = m:revolute { from = m.world, axis = "z", name = "wheel" .. i }
    body(m, at)
  end
  local at, rack = m:prismatic { from = m.world, axis = "x", name = "rack" }
  m:point_mass { at = at, mass = 3 }
  m:gear { driver = joints[1], driven = joints[2], ratio = "-1.5" }
  m:gear { driver = joints[2], driven = joints[3], ratio = "0.4", offset = "0.1" }
  m:rack_and_pinion { pinion = joints[3], rack = rack, radius = "0.2" }
  m:joint_spring { joint = joints[3], stiffness = 5 }
  return m
end

-- Nothing is free: a drive moves the loop.
loops[5] = function()
  local m = ambit.mechanism "driven slider"
  local crank = m:revolute { from = m.world, axis = "z", angle = 1 + ambit.time, name = "crank" }
  local slider = m:prismatic { from = m.world, axis = "x", name = "slider" }
  local rod = m:revolute { from = slider, axis = "z", name = "rod" }
  body(m, rod)
  m:close_pin { a = m:rigid_link { from = crank, offset = { 1, 0, 0 } },
    b = m:rigid_link { from = rod, offset = { -2, 0, 0 } }, name = "loop" }
  m:reference { slider = "2.3", rod = "-0.4" }
  return m
end

-- A ball on a bar whose end stays on a plane: a quaternion within a loop.
loops[6] = function()
  local m = ambit.mechanism { "caster", gravity = { 0, 0, "-9.81" } }
  local arm = m:revolute { from = m.world, axis = "z", name = "arm" }
  body(m, arm)
  local ball = m:spherical_quaternion { from = m:rigid_link { from = arm, offset = { 1, 0, 1 } }, name = "ball" }
  body(m, ball)
  m:point_on_plane { a = m:rigid_link { from = m.world, offset = { 0, 0, "0.3" } },
    b = m:rigid_link { from = ball, offset = { 0, "0.2", -1 } }, name = "ground" }
  return m
end

-- -- points

-- Which component of a quaternion the state is: ball, j1, ... of that kind; nil: it is none.
local function has_quaternion(system, i)
  local owner, k = system.states[i]:match "^([^'.]+)%.(%d)$"
  for _, part in ipairs(owner and system.mechanism:tree().parts or {}) do
    if part.name == owner and part.type:find "quaternion" and tonumber(k) <= 4 then return tonumber(k) end
  end
end

-- The symbols of states, time, and everything else at random, exact in binary; quaternions of norm 1, without which a
-- closed loop's forces are not those of its velocities.
local function point(system, implicit)
  local values = { core.expression(math.random(1, 1000) / 1024) }
  local leaves = { core.time() }
  local quaternion = { { "2/9", "-4/9", "5/9", "6/9" }, { "-1/3", 0, "2/3", "2/3" }, { "0.1", "0.5", "-0.5", "0.7" } }
  local turn = quaternion[math.random(#quaternion)]
  for i, symbol in ipairs(system.symbols) do
    local value = math.random(-1000, 1000) / 1024
    local k = has_quaternion(system, i)
    leaves[#leaves + 1], values[#values + 1] = symbol, core.expression(k and turn[k] or value)
  end
  for _, symbol in ipairs(implicit.unknowns) do
    leaves[#leaves + 1], values[#values + 1] = symbol, core.expression(math.random(-1000, 1000) / 1024)
  end
  return leaves, values
end

local function exact(list, leaves, values) return core.evaluate { arithmetic = "mpfr", expressions = list, leaves = leaves, values = values } end

local function expect_zero(list, what)
  for i, x in ipairs(list) do
    assert.is_true(x:contains(0) and x:width() < 1e-18, ("%s: %d: %s, %.2g wide"):format(what, i, tostring(x), x:width()))
  end
end

-- The unknowns in terms of the states.
local function explicit_unknowns(m, system, implicit)
  local list = core.of_states and core.has_constraints(m.handle) and core.of_states(m.handle, implicit.unknowns)
  if list then return list end
  local n = #system.states - #implicit.unknowns
  return table.move(system.rates, n + 1, #system.rates, 1, {})
end

local function each_stage(implicit, visit)
  local first = 1
  for _, last in ipairs(implicit.stage_end) do
    visit(first, last)
    first = last + 1
  end
end

-- -- what is promised

-- R(a) = 0 and F(a) = f at the explicit a.
local function expect_agreement(m, system, implicit)
  local found = explicit_unknowns(m, system, implicit)
  local both = core.substitute(table.move(implicit.rates, 1, #implicit.rates, #implicit.residuals + 1,
    table.move(implicit.residuals, 1, #implicit.residuals, 1, {})), implicit.unknowns, found)
  for i, rate in ipairs(system.rates) do
    both[#implicit.residuals + i] = both[#implicit.residuals + i] - rate
  end
  for _ = 1, 3 do
    local leaves, values = point(system, implicit)
    expect_zero(exact(both, leaves, values), m.name)
  end
end

local function with_unknowns(implicit, values, change)
  local copy, first = table.move(values, 1, #values, 1, {}), #values - #implicit.unknowns
  for k, x in pairs(change) do copy[first + k] = copy[first + k] + x end
  return copy
end

-- Second differences by the unknowns of a stage vanish; those of later stages do not act.
local function expect_stages(m, system, implicit)
  local leaves, values = point(system, implicit)
  local all = table.move(implicit.rates, 1, #implicit.rates, #implicit.residuals + 1,
    table.move(implicit.residuals, 1, #implicit.residuals, 1, {}))
  local base = exact(all, leaves, values)
  each_stage(implicit, function(first, last)
    local one, other, both = {}, {}, {}
    for k = first, last do
      one[k], other[k] = math.random(-99, 99), math.random(-99, 99)
      both[k] = one[k] + other[k]
    end
    local a, b = exact(all, leaves, with_unknowns(implicit, values, one)), exact(all, leaves,
      with_unknowns(implicit, values, other))
    local c, rest, early = exact(all, leaves, with_unknowns(implicit, values, both)), {}, {}
    for i = 1, #all do
      if i <= last or i > #implicit.residuals then rest[#rest + 1] = (c[i] - a[i]) - (b[i] - base[i]) end
      if i < first then early[#early + 1] = c[i] - base[i] end
    end
    for _, x in ipairs(rest) do assert.is_true(math.abs(x:mid()) < 1e-9 * (1 + math.abs(c[1]:mid())) or x:contains(0), tostring(x)) end
    for _, x in ipairs(early) do assert.is_true(x:mag() == 0 or x:contains(0)) end
  end)
end

local function numbers(list, leaves, values)
  local out = {}
  for i, x in ipairs(core.evaluate { arithmetic = "real", expressions = list, leaves = leaves, values = values }) do out[i] = x:mid() end
  return out
end

-- Solved stage by stage in doubles, unknown pivot[k] by equation pivot[k], without looking for other pivots.
local function expect_solution(m, system, implicit)
  local leaves, values = point(system, implicit)
  local nx, at = #system.states, table.move(values, 1, #values, 1, {})
  local truth = numbers(explicit_unknowns(m, system, implicit), leaves, values)
  each_stage(implicit, function(first, last)
    local n, a, r = last - first + 1, {}, nil
    for k = first, last do at[1 + nx + k] = core.expression(0) end
    r = numbers(implicit.residuals, leaves, at)
    for k = first, last do
      at[1 + nx + k] = core.expression(1)
      a[k] = numbers(implicit.residuals, leaves, at)
      at[1 + nx + k] = core.expression(0)
      for i = first, last do a[k][i] = a[k][i] - r[i] end -- column k
    end
    for step = first, last do
      local p = implicit.pivot[step]
      assert.is_true(p >= first and p <= last)
      assert.is_true(math.abs(a[p][p]) > 1e-12, ("%s: pivot %d of %d is %g"):format(m.name, step, n, a[p][p]))
      for later = step + 1, last do
        local i = implicit.pivot[later]
        local factor = a[p][i] / a[p][p]
        for k = first, last do a[k][i] = a[k][i] - factor * a[k][p] end
        r[i] = r[i] - factor * r[p]
      end
    end
    for step = last, first, -1 do
      local p, sum = implicit.pivot[step], nil
      sum = -r[p]
      for later = step + 1, last do
        local k = implicit.pivot[later]
        sum = sum - a[k][p] * truth[k]
      end
      local x = sum / a[p][p]
      assert.is_true(math.abs(x - truth[p]) < 1e-7 * (1 + math.abs(truth[p])),
        ("%s: unknown %d is %.17g instead of %.17g"):format(m.name, p, x, truth[p]))
    end
    for k = first, last do at[1 + nx + k] = core.expression(truth[k]) end
  end)
end

local function expect_all(m)
  local system = m:dynamics()
  local implicit = core.system_implicit(system.system)
  assert.is_truthy(implicit, m.name)
  assert.equal(#implicit.unknowns, #implicit.residuals)
  assert.equal(#system.states, #implicit.rates)
  assert.equal(#implicit.unknowns, implicit.stage_end[#implicit.stage_end])
  expect_agreement(m, system, implicit)
  expect_stages(m, system, implicit)
  expect_solution(m, system, implicit)
end

-- -- systems that are made of others

local ode = require "ambit.ode"
local carry = require "ambit.verify.carry"

local function arm()
  local m, joints, tip = chain { "revolute", "prismatic", "revolute" }
  local load = ambit.around("0.5", "10%")
  m:point_mass { at = tip, mass = load }
  m:joint_torque { joint = joints[1], torque = function(q, rate, t) return ambit.sin(t) - rate - q * load end }
  return m, load
end

-- F and R of a changed system at the accelerations of the changed rates.
local function expect_followed(system)
  local implicit = core.system_implicit(system.system)
  assert.is_truthy(implicit)
  local n, na = #system.rates, #implicit.unknowns
  local found = table.move(system.rates, na + 1, 2 * na, 1, {})
  local both = core.substitute(table.move(implicit.residuals, 1, na, n + 1, table.move(implicit.rates, 1, n, 1, {})),
    implicit.unknowns, found)
  for i, rate in ipairs(system.rates) do both[i] = both[i] - rate end
  for _, leaf in ipairs(core.leaves(both)) do -- data at a point
    if leaf.kind == "unknown" then both = core.substitute(both, { leaf.expression }, { core.expression "0.123" }) end
  end
  expect_zero(exact(both, point(system, implicit)), "changed")
  return implicit
end

local function depends(list, leaf)
  for _, l in ipairs(core.leaves(list)) do
    if l.expression == leaf then return true end
  end
  return false
end

describe("a system made of one in implicit form", function()
  setup(function() math.randomseed(18) end)

  it("has it with other data", function()
    local m, load = arm()
    local d = m:dynamics()
    local u = core.leaves({ load })[1].expression
    local implicit = expect_followed(ode.instance(d, { [load] = "0.7" }))
    assert.is_true(depends(core.system_implicit(d.system).residuals, u))
    assert.is_false(depends(implicit.residuals, u))
  end)

  it("has it on another clock", function()
    local d = arm():dynamics()
    local simulate = require "ambit.simulate"
    expect_followed(simulate.on_clock(d, core.expression "0.3"))
  end)

  it("has it with further states", function()
    local m = arm()
    local d = m:dynamics()
    local q = { system = d, initial = {}, times = { 0, 1 } }
    for i = 1, #d.states do q.initial[i] = core.expression(0) end
    local x, v = d.symbols[1], d.symbols[4]
    local carried = carry.of(q, { { name = "g", g = x * v + ambit.sin(core.time()) } })
    assert.equal(7, #carried.system.states)
    expect_followed(carried.system)
  end)

  it("does without where more has changed", function()
    local m = arm()
    local d = m:dynamics()
    assert.is_nil(core.system_implicit(core.system(d.states, d.units, d.symbols, d.rates)))
    local zero = core.expression(0)
    local varied = core.variation(d.system, { zero, zero, zero, zero, zero, zero }, { "q" }, { 1 }, { zero })
    assert.is_nil(core.system_implicit(varied))
    local late = arm()
    local before = late:dynamics()
    late:point_mass { at = late.world, mass = 1 }
    assert.is_nil(core.system_implicit(before.system))
    assert.is_truthy(core.system_implicit(late:dynamics().system))
  end)

  it("keeps what it needs through collections", function()
    for _, make in ipairs { loops[3], function() return (arm()) end } do
      local d = make():dynamics()
      local name = d.name
      d = ode.replaced(d, {}, {})
      for _ = 1, 3 do
        collectgarbage()
        local z = core.symbol("z", "1")
        for i = 1, 20000 do local _ = z + i end
      end
      assert.is_truthy(core.system_implicit(d), name)
    end
  end)

  it("is linear and solvable for random trees", function()
    local kinds = { "revolute", "prismatic", "screw", "cylindrical", "universal", "planar", "spherical", "follower",
      "driven", "spherical_quaternion" }
    for _ = 1, 12 do
      local list = { "revolute" }
      for i = 2, math.random(2, 6) do list[i] = kinds[math.random(#kinds)] end
      expect_all((chain(list)))
    end
    local long = {}
    for i = 1, 14 do long[i] = i % 3 == 0 and "prismatic" or "revolute" end
    expect_all((chain(long))) -- accelerations by articulated bodies
  end)
end)

-- -- right-hand sides that wait

local function long_chain(n, load)
  local m = ambit.mechanism { "long", gravity = { 0, "-9.81", 0 } }
  local at = m.world
  for i = 1, n do
    at = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" .. i }, offset = { 1, 0, 0 } }
    if i < n or load then m:point_mass { at = at, mass = 1 } end
  end
  return m
end

-- n crossed four-bars on top of each other: 3 n speeds, 2 n rows.
local function tower(n)
  local m = ambit.mechanism { "tower", gravity = { 0, "-9.81", 0 } }
  local reference, at = {}, m.world
  local function bar(from, name)
    local hinge = m:revolute { from = from, axis = "z", name = name }
    body(m, hinge)
    return m:rigid_link { from = hinge, offset = { 1, "0.1", 0 } }
  end
  for i = 1, n do
    local a = bar(at, "a" .. i)
    local b = bar(a, "b" .. i)
    local c = bar(m:rigid_link { from = at, offset = { "0.9", 0, 0 } }, "c" .. i)
    m:close_pin { a = b, b = c, name = "l" .. i }
    reference["a" .. i], reference["b" .. i], reference["c" .. i] = 1, -1, 1
    at = m:rigid_link { from = b, offset = { 1, 0, 0 } }
  end
  m:reference(reference)
  return m
end

local function at_rest(d)
  local initial = {}
  for _, name in ipairs(d.states) do initial[name] = name:find "'" and 0 or "0.1" end
  return initial
end

describe("the right-hand sides of many joints", function()
  setup(function() math.randomseed(19) end)

  it("are not written for a solver that takes the implicit form", function()
    local function made() return select(2, core.evaluate { expressions = { core.expression(1) } }).graph_nodes end
    local d, before = long_chain(14, true):dynamics(), made()
    local run = ambit.simulate { d, initial = at_rest(d), t = { 0, "0.01" }, solver = "zonotope" }
    assert.equal("complete", run.status)
    local implicit = made() - before
    assert.equal(28, #d.rates)
    assert.is_true(made() - before > 2 * implicit)
  end)

  it("agree with it when they are asked for, also after collections", function()
    expect_all(tower(4))
    local m = tower(4)
    local d = m:dynamics()
    m:independent { "a1", "a2", "a3", "a4" } -- for later equations
    for _ = 1, 3 do
      collectgarbage()
      local z = core.symbol("z", "1")
      for i = 1, 20000 do local _ = z + i end
    end
    assert.equal(16, #d.rates)
    assert.is_truthy(core.system_implicit(d.system))
  end)

  it("tell mistakes when they are written", function()
    local d = long_chain(14, false):dynamics()
    local good, message = pcall(function() return d.rates end)
    assert.is_false(good)
    assert.is_truthy(message:find("q14", 1, true), message)
    local m = long_chain(12, true)
    d = m:dynamics()
    m:point_mass { at = m.world, mass = 1 }
    good, message = pcall(ambit.simulate, { d, initial = at_rest(d), t = { 0, 1 }, solver = "lohner" })
    assert.is_false(good)
    assert.is_truthy(message:find("has got further parts", 1, true), message)
    assert.equal(24, #m:dynamics().rates)
  end)
end)

describe("the implicit form", function()
  setup(function() math.randomseed(17) end)

  for i, make in ipairs(trees) do
    it("of open chain " .. i .. " is that of the explicit formulas", function() expect_all(make()) end)
  end

  for i, make in ipairs(loops) do
    it("of closed loop " .. i .. " is that of the explicit formulas", function() expect_all(make()) end)
  end
end)
