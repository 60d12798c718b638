-- Closed loops: mechanisms with published or independently computed numbers, choices, certificates, messages.
local ambit = require "ambit"
local pi = ambit.pi

-- The enclosure holds the decimal to its last digit and is narrow.
local function holds(x, text, width)
  local truth = ambit.interval(text)
  assert.is_true(x.lo <= truth.hi and x.hi >= truth.lo, ("%s does not hold %s"):format(tostring(x), text))
  assert.is_true(x:width() <= width, ("%s is too wide"):format(tostring(x)))
end

local function message_of(f, ...)
  local ok, message = pcall(f, ...)
  assert.is_false(ok)
  return message
end

local function zero_states(system, values)
  local at = {}
  for _, name in ipairs(system.states) do at[name] = values[name] or 0 end
  return at
end

-- -- Andrews' squeezer (IVP Test Set; reference numbers computed with other formulas in 36 digits)

local angles = {
  beta = "-0.0617138900142764496358948458001", theta = 0, gamma = "0.455279819163070380255912382449",
  phi = "0.222668390165885884674473185609", delta = "0.487364979543842550225598953530",
  omega = "-0.222668390165885884674473185609", epsilon = "1.23054744454982119249735015568",
}

local function andrews()
  local m = ambit.mechanism "Andrews' squeezer"
  local function point(at, x, y) return m:rigid_link { from = at, offset = { x, y, 0 } } end
  local function hinge(name, from, x, y) return m:revolute { from = point(from, x, y), axis = "z", name = name } end
  local function body(at, mass, x, y, i)
    m:rigid_body { at = at, mass = mass, centre = { x, y, 0 }, inertia = { i, 0, 0, 0, i, 0, 0, 0, i } }
  end
  local k1 = hinge("beta", m.world, 0, 0)
  local k2 = hinge("theta", k1, "0.007", 0)
  local k3 = hinge("gamma", m.world, "-0.03635", "0.03273")
  local k5 = hinge("delta", m.world, "-0.06934", "-0.00227")
  local k4 = hinge("phi", k5, "0.04", 0)
  local k7 = hinge("epsilon", m.world, "-0.06934", "-0.00227")
  local k6 = hinge("omega", k7, 0, "-0.04")
  body(k1, "0.04325", "0.00092", 0, "2.194e-6")
  body(k2, "0.00365", "-0.0115", 0, "4.41e-7")
  body(k3, "0.02373", "0.01043", "-0.01874", "5.255e-6")
  body(k4, "0.00706", 0, "-0.00579", "5.667e-7")
  body(k5, "0.0705", "-0.00916", "-0.02308", "1.169e-5")
  body(k6, "0.00706", "0.00579", 0, "5.667e-7")
  body(k7, "0.05498", "-0.00449", "-0.01228", "1.912e-5")
  local e = point(k2, "-0.028", 0)
  m:close_point { a = point(k3, 0, "-0.035"), b = e, name = "loop3" }
  m:close_point { a = point(k4, 0, "-0.02"), b = e, name = "loop4" }
  m:close_point { a = point(k6, "0.02", 0), b = e, name = "loop6" }
  m:spring_damper { from = point(m.world, "0.014", "0.072"), to = point(k3, "0.02", "-0.018"), stiffness = 4530,
    length = "0.07785" }
  m:joint_torque { joint = k1, torque = "0.033" }
  m:reference(angles)
  m:independent { "beta" }
  return m
end

describe("Andrews' squeezer", function()
  local m, d, start
  setup(function()
    m = andrews()
    d = m:dynamics()
    start = zero_states(d, angles)
  end)

  it("has seven angles and one speed", function()
    assert.same({ "beta", "theta", "gamma", "delta", "phi", "epsilon", "omega", "beta'" }, d.states)
    assert.same({ "beta" }, m:independent())
    assert.same({ "loop3.3", "loop4.3", "loop6.3" }, m:redundant())
  end)

  it("starts with the published accelerations and multipliers", function()
    local u = m:coordinates()
    local a = ambit.evaluate { m:of_states { u["beta''"], u["theta''"], u["gamma''"], u["omega''"] }, at = start }
    holds(a[1], "14222.4439199541138705911625887", 1e-9)
    holds(a[2], "-10666.8329399655854029433719415", 1e-9)
    holds(a[3], "0", 1e-9)
    holds(a[4], "0", 1e-9)
    local lambda = ambit.evaluate { m:multipliers(), at = start } -- the test set has them on the other side
    holds(lambda["loop3.1"], "-98.5668703962410896057655", 1e-11)
    holds(lambda["loop3.2"], "6.122688344255662655031144", 1e-11)
    for _, row in ipairs { "loop4.1", "loop4.2", "loop6.1", "loop6.2" } do holds(lambda[row], "0", 1e-11) end
  end)

  it("encloses the motion, the loops and the balance of energy at t = 0.01", function()
    local run = ambit.simulate { d, initial = start, t = { 0, "0.01" } }
    assert.equal("complete", run.status)
    local truth = {
      beta = "2.160113131531526506184739469", theta = "-1.88336423110704431930339038",
      gamma = "0.158516758001226693254796624", phi = "-0.3286410751746703065828222343",
      delta = "0.5251547747977294611021105834", omega = "0.3286410751746703065828222343",
      epsilon = "1.068427204632401148733882823", ["beta'"] = "711.9231528311039790635821475",
    }
    for name, text in pairs(truth) do holds(run.x[name], text, name == "beta'" and 1e-8 or 1e-11) end
    local at = {}
    for _, name in ipairs(d.states) do at[name] = run.x[name] end
    for _, gap in pairs(ambit.evaluate { m:constraints(), at = at }) do holds(gap, "0", 1e-13) end
    local u = ambit.evaluate { m:of_states { m:coordinates()["theta'"], m:coordinates()["omega'"] }, at = at }
    holds(u[1], "-786.7700808599397566624635329", 1e-7)
    holds(u[2], "240.2930292678645514714639834", 1e-7)
    local lambda = ambit.evaluate { m:multipliers(), at = at }
    holds(lambda["loop3.1"], "-57.0252904375025831120336", 1e-6)
    holds(lambda["loop4.2"], "18.17926986794035693791808", 1e-6)
    holds(lambda["loop6.2"], "-34.24011729160660839589623", 1e-6)
    local energy = m:of_states { m:energy().total }[1]
    local growth = ambit.evaluate { energy, at = at } - ambit.evaluate { energy, at = start }
    holds(growth - ambit.interval "0.033" * (run.x.beta - ambit.interval(angles.beta)), "0", 1e-9)
  end)

  it("encloses the motion at t = 0.03, and not the published digits that are wrong", function()
    local run = ambit.simulate { d, initial = start, t = { 0, "0.03" } }
    assert.equal("complete", run.status)
    local truth = {
      beta = "15.8107711951537070971193873", theta = "-15.75637105841183946972775284",
      gamma = "0.0408222401196458048582823196", phi = "-0.5347301163420795937701850311",
      delta = "0.5244099658799540693716557999", epsilon = "1.048080741041937873068515472",
      ["beta'"] = "1139.920302259106064198096848",
    }
    for name, text in pairs(truth) do holds(run.x[name], text, name == "beta'" and 1e-7 or 1e-9) end
    assert.is_false(run.x.beta:contains(15.81077119629904))
  end)

  it("is regular about its start", function()
    local box = {}
    for name, value in pairs(angles) do box[name] = { tonumber(value) - 1e-3, tonumber(value) + 1e-3 } end
    local r = m:rank { box = box }
    assert.equal("proved", r.status)
    assert.same({ "beta" }, r.independent)
    assert.equal(6, #r.dependent)
  end)
end)

-- -- N-four-bar (IFToMM A02)

local function rods(n, parallelogram)
  local m = ambit.mechanism { "N-four-bar", gravity = { 0, "-9.81", 0 } }
  local function rod(name, from, angle)
    local at = m:revolute { from = from, axis = "z", name = name, angle = angle }
    m:rigid_body { at = at, mass = 1, centre = { 0.5, 0, 0 }, inertia = { 0, 0, 0, 0, "1/12", 0, 0, 0, "1/12" } }
    return m:rigid_link { from = at, offset = { 1, 0, 0 } }
  end
  local top = rod("theta", m.world)
  local theta = parallelogram and m:coordinates().theta or nil
  for k = 1, n do
    local over = rod("coupler" .. k, top, theta and -theta)
    top = rod("rod" .. k, m:rigid_link { from = m.world, offset = { k, 0, 0 } }, theta)
    m:close_point { a = top, b = over, name = "loop" .. k }
  end
  return m
end

local function at_angle(n, angle, speed)
  local at = { theta = angle, ["theta'"] = speed }
  for k = 1, n do at["coupler" .. k], at["rod" .. k] = -angle, angle end
  return at
end

local function gap(m, run, t)
  local x, at, worst = run:at(t), {}, 0
  for _, name in ipairs(m:coordinate_names()) do at[name] = x[name] end
  for _, g in pairs(ambit.evaluate { m:constraints(), at = at }) do
    assert.is_true(g:contains(0))
    worst = math.max(worst, g:mag())
  end
  return worst
end

describe("N-four-bar", function()
  for _, n in ipairs { 2, 10 } do
    it(("keeps %d loops closed where it stays regular"):format(n), function()
      local m = rods(n)
      m:independent { "theta" }
      m:reference { theta = 1, coupler1 = -1, rod1 = 1 }
      local hanging = ambit.simulate { m, initial = at_angle(n, -pi / 2, 1), t = { 0, "0.5", 1 } }
      assert.equal("complete", hanging.status)
      assert.is_true(gap(m, hanging, 1) < 1e-10)
      local falling = ambit.simulate { m, initial = at_angle(n, pi / 2, -1), t = { 0, "0.3", "0.6" } }
      assert.equal("complete", falling.status)
      assert.is_true(gap(m, falling, "0.6") < 1e-10)
    end)

    it(("closes %d parallelograms identically"):format(n), function()
      local m = rods(n, true)
      assert.equal(3 * n, #m:redundant())
      local run = ambit.simulate { m, initial = { theta = pi / 2, ["theta'"] = -1 }, t = { 0, "0.3", "0.6", 1 } }
      if n == 2 then
        holds(run.x.theta, "-1.76707447631020111258", 1e-12)
        holds(run.x["theta'"], "-6.80738524086944553673", 1e-11)
      end
      -- the loops closed by constraints, on the way down, go the same way
      local loose = rods(n)
      loose:reference { theta = 1, coupler1 = -1, rod1 = 1 }
      loose:independent { "theta" }
      local other = ambit.simulate { loose, initial = at_angle(n, pi / 2, -1), t = { 0, "0.3", "0.6" } }
      for _, t in ipairs { "0.3", "0.6" } do
        local x, y = run:at(t).theta, other:at(t).theta
        assert.is_true(x.lo <= y.hi and y.lo <= x.hi and y:width() < 1e-10)
      end
    end)
  end

  it("reports the flat position as singular", function()
    local m = rods(1)
    local run = ambit.simulate { m, initial = at_angle(1, pi / 2, -1), t = { 0, 1 }, step_min = 1e-6 }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached > 0.70 and run.t_reached < 0.7085)
    assert.truthy(run.reason:find "the constraint Jacobian of `loop1` may lose rank")
    local flat = { theta = 0, coupler1 = 0, rod1 = 0 }
    local r = m:rank { box = flat }
    assert.equal("singular", r.status)
    assert.same({ "loop1" }, r.loops)
    m:reference(flat)
    assert.truthy(message_of(m.dynamics, m):find "the loop of `loop1` is singular at the reference configuration")
  end)
end)

-- -- Bricard's linkage (IFToMM A04)

describe("Bricard's linkage", function()
  it("moves with one freedom although counting says that it is rigid", function()
    local m = ambit.mechanism { "Bricard", gravity = { 0, "-9.81", 0 } }
    local long, thick = "1.01/12", "1/600"
    local at = m.world
    local edges = { { "y", 1, 0, 0 }, { "z", 0, -1, 0 }, { "x", 0, 0, 1 }, { "y", -1, 0, 0 }, { "z", 0, 1, 0 } }
    for i, e in ipairs(edges) do
      local joint = m:revolute { from = at, axis = e[1], name = "q" .. i }
      m:rigid_body { at = joint, mass = 1, centre = { e[2] / 2, e[3] / 2, e[4] / 2 },
        inertia = { e[2] ~= 0 and thick or long, 0, 0, 0, e[3] ~= 0 and thick or long, 0, 0, 0,
          e[4] ~= 0 and thick or long } }
      at = m:rigid_link { from = joint, offset = { e[2], e[3], e[4] } }
    end
    m:close_revolute { a = m:rigid_link { from = m.world, offset = { 0, 0, 1 } }, b = at, axis = "x", name = "ring" }
    assert.equal(1, #m:redundant())
    assert.truthy(m:redundant()[1]:find "^ring%.%d$")
    assert.equal(1, #m:independent())
    local d = m:dynamics()
    local start = zero_states(d, {})
    local u = m:coordinates()
    for i = 1, 5 do
      local a = ambit.evaluate { m:of_states { u[("q%d''"):format(i)] }[1], at = start }
      holds(i % 2 == 1 and a or -a, "1.958083832335329341317365", 1e-13)
    end
    local run = ambit.simulate { d, initial = start, t = { 0, "0.5" } }
    assert.equal("complete", run.status)
    assert.is_true(gap(m, run, "0.5") < 1e-10) -- all five rows, also the one that was left out
  end)
end)

-- -- slider-crank: closed by a point on a line, and by its formula

describe("a slider-crank", function()
  local function build(closed)
    local m = ambit.mechanism { "slider-crank", gravity = { 0, "-9.81", 0 } }
    local crank = m:revolute { from = m.world, axis = "z", name = "crank" }
    m:point_mass { at = m:rigid_link { from = crank, offset = { "0.05", 0, 0 } }, mass = 1 }
    local alpha = not closed and m:coordinates().crank or nil
    local rod = m:revolute { from = m:rigid_link { from = crank, offset = { "0.1", 0, 0 } }, axis = "z", name = "rod",
      angle = alpha and -alpha - ambit.asin(ambit.sin(alpha) / 3) }
    m:point_mass { at = m:rigid_link { from = rod, offset = { "0.15", 0, 0 } }, mass = 2 }
    local pin = m:rigid_link { from = rod, offset = { "0.3", 0, 0 } }
    m:point_mass { at = pin, mass = "0.5" }
    if closed then m:point_on_line { a = m.world, b = pin, axis = "x", name = "guide" } end
    return m
  end

  it("moves as its formula says", function()
    local closed, explicit = build(true), build(false)
    closed:independent "crank"
    local a = ambit.number "0.5"
    local start = { crank = a, rod = -a - ambit.asin(ambit.sin(a) / 3), ["crank'"] = 10 }
    local x = ambit.simulate { closed, initial = start, t = { 0, "0.2", "0.4" } }
    local y = ambit.simulate { explicit, initial = { crank = a, ["crank'"] = 10 }, t = { 0, "0.2", "0.4" } }
    for _, name in ipairs { "crank", "crank'" } do
      local p, q = x.x[name], y.x[name]
      assert.is_true(p.lo <= q.hi and q.lo <= p.hi and p:width() < 1e-8 and q:width() < 1e-8)
    end
  end)

  it("goes on from the set of a run", function()
    local closed, explicit = build(true), build(false)
    closed:independent "crank"
    local a = ambit.around("0.5", "0.1%")
    local start = { crank = a, rod = -a - ambit.asin(ambit.sin(a) / 3), ["crank'"] = 10 }
    local half = ambit.simulate { closed, initial = start, t = { 0, "0.2" }, solver = "zonotope" }
    local x = ambit.simulate { closed, initial = half:set(), t = { "0.2", "0.4" }, solver = "zonotope" }
    local y = ambit.simulate { explicit, initial = { crank = a, ["crank'"] = 10 }, t = { 0, "0.4" },
      solver = "zonotope" }
    assert.equal("complete", x.status)
    local p, q = x.x.crank, y.x.crank
    assert.is_true(p.lo <= q.hi and q.lo <= p.hi and p:width() < 1.05 * q:width() and q:width() < 1.05 * p:width())
  end)

  it("takes an assembled configuration as its reference", function()
    local m = build(true)
    local found = m:assemble { crank = 2, box = { rod = { -4, -1 } } }
    assert.equal("unique", found.status)
    assert.equal(2, m:reference().crank)
    assert.is_true(math.abs(m:reference().rod - found.configuration.rod:mid()) < 1e-12)
    m:reference { crank = 1, rod = -1.3 }
    m:assemble { crank = 2, box = { rod = { -4, -1 } } }
    assert.is_true(math.abs(m:reference().crank - 1) < 0.1)
  end)

  it("is proved regular over the whole turn", function()
    local m = build(true)
    assert.equal("proved", m:rank { box = { crank = { 0, "6.3" }, rod = { -7, "0.5" } } }.status)
    assert.equal("empty", m:rank { box = { crank = { "1.5", "1.6" }, rod = { 0, "0.5" } } }.status)
  end)
end)

-- -- Stewart platform

local function stewart(massless)
  local m = ambit.mechanism { "Stewart platform", gravity = { 0, 0, "-9.81" } }
  local plate = m:free { from = m.world, name = "plate" }
  m:rigid_body { at = plate, mass = 20, inertia = { "0.5", 0, 0, 0, "0.5", 0, 0, 0, 1 } }
  local height, home = ambit.number "0.8", { ["plate.6"] = ambit.number "0.8" }
  for i = 1, 5 do home["plate." .. i] = 0 end
  local function on(radius, angle)
    return radius * ambit.cos(ambit.degrees(angle)), radius * ambit.sin(ambit.degrees(angle))
  end
  for i = 1, 6 do
    local third, side = 120 * ((i - 1) // 2), i % 2 == 0 and 1 or -1
    local bx, by = on(ambit.number "0.5", third + 10 * side)
    local px, py = on(ambit.number "0.3", third + 50 * side)
    local swivel = m:universal { from = m:rigid_link { from = m.world, offset = { bx, by, 0 } }, name = "foot" .. i }
    local rod = m:prismatic { from = swivel, axis = "z", name = "leg" .. i }
    if not massless then m:point_mass { at = rod, mass = 1 } end
    m:close_point { a = rod, b = m:rigid_link { from = plate, offset = { px, py, 0 } }, name = "ball" .. i }
    local x, y = px - bx, py - by
    local length = ambit.sqrt(x ^ 2 + y ^ 2 + height ^ 2)
    home["leg" .. i], home["foot" .. i .. ".1"] = length, -ambit.atan(y / height)
    home["foot" .. i .. ".2"] = ambit.asin(x / length)
  end
  m:reference(home)
  m:independent { "plate.1", "plate.2", "plate.3", "plate.4", "plate.5", "plate.6" }
  return m, home
end

describe("a Stewart platform", function()
  it("is closed at home and regular in its workspace", function()
    local m, home = stewart()
    for _, g in pairs(ambit.evaluate { m:constraints(), at = home }) do holds(g, "0", 1e-14) end
    local box = {}
    for name, value in pairs(home) do
      local x = ambit.evaluate { value }:mid()
      local reach = name:find "plate.[456]" and 0.05 or name:find "plate" and 0.1 or 0.25
      box[name] = { x - reach, x + reach }
    end
    local r = m:rank { box = box }
    assert.equal("proved", r.status)
    assert.equal(18, #r.dependent)
    -- a leg of no length says nothing about its direction
    box.leg1 = { -0.1, 0.1 }
    assert.equal("empty", m:rank { box = box }.status)
  end)

  it("falls freely on legs without mass and force", function()
    local m, home = stewart(true)
    local d = m:dynamics()
    local at = {}
    for _, name in ipairs(d.states) do at[name] = home[name] or 0 end
    holds(ambit.evaluate { d:rate "plate.6'", at = at }, "-9.81", 1e-10)
    holds(ambit.evaluate { d:rate "plate.1'", at = at }, "0", 1e-10)
  end)
end)

-- -- two ways to say the same

it("a ball that is closed moves as a ball joint does", function()
  local body = { mass = 1, inertia = { "0.01", 0, 0, 0, "0.02", 0, 0, 0, "0.03" } }
  local function inertia(m, at, z)
    m:rigid_body { at = at, mass = body.mass, inertia = body.inertia, centre = { 0, 0, z } }
  end
  local open = ambit.mechanism { "ball", gravity = { 0, 0, "-9.81" } }
  inertia(open, open:spherical_quaternion { from = open.world, name = "q" }, -1)
  local loop = ambit.mechanism { "loop", gravity = { 0, 0, "-9.81" } }
  local free = loop:free_quaternion { from = loop.world, name = "q" }
  inertia(loop, free, 0)
  loop:close_point { a = loop.world, b = loop:rigid_link { from = free, offset = { 0, 0, 1 } }, name = "ball" }
  local half = ambit.number "0.5"
  local s, c = ambit.sin(half), ambit.cos(half)
  local at = { ["q.1"] = c, ["q.2"] = s, ["q.6"] = 2 * c * s, ["q.7"] = 2 * s ^ 2 - 1, ["q'.2"] = 1, ["q'.3"] = 2 }
  loop:reference { ["q.1"] = c, ["q.2"] = s, ["q.6"] = 2 * c * s, ["q.7"] = 2 * s ^ 2 - 1 }
  loop:independent { "q'.1", "q'.2", "q'.3" }
  local p = ambit.simulate { open, initial = zero_states(open:dynamics(), at), t = { 0, "0.5" } }
  local q = ambit.simulate { loop, initial = zero_states(loop:dynamics(), at), t = { 0, "0.5" } }
  for _, name in ipairs(open:dynamics().states) do
    local x, y = p.x[name], q.x[name]
    assert.is_true(x.lo <= y.hi and y.lo <= x.hi and x:width() < 1e-11 and y:width() < 1e-11)
  end
end)

-- -- a drive: a strut whose length is a function of time

it("a driven strut moves its crank, and its work is in the balance of power", function()
  local m = ambit.mechanism { "strut", gravity = { 0, "-9.81", 0 } }
  local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
  m:point_mass { at = tip, mass = 2 }
  m:close_distance { a = m:rigid_link { from = m.world, offset = { 0, -1, 0 } }, b = tip, name = "strut",
    length = ambit.sqrt(2 + 2 * ambit.sin(ambit.time)) } -- then q = t
  m:reference { q = 0 }
  local run = ambit.simulate { m, initial = { q = 0 }, t = { 0, "0.5", 1 } }
  assert.equal("complete", run.status)
  holds(run.x.q, "1", 1e-10)
  local power = m:of_states { m:power() }[1]
  local p = ambit.evaluate { power, at = { q = "0.5", t = "0.5" } }
  holds(p, ("%.17g"):format(2 * 9.81 * math.cos(0.5)), 1e-10) -- lifting 2 kg at q' = 1
end)

-- -- a dead point of the chosen pivots is no singular position

it("a rank is proved where other speeds are independent than those that were asked for", function()
  local m = ambit.mechanism "dead point"
  local crank = m:revolute { from = m.world, name = "crank" }
  local coupler = m:revolute { from = m:rigid_link { from = crank, offset = { 0, 1, 0 } }, name = "coupler" }
  local rocker = m:revolute { from = m:rigid_link { from = m.world, offset = { 2, 1, 0 } }, name = "rocker" }
  m:point_mass { at = coupler, mass = 1 }
  m:close_pin { a = m:rigid_link { from = rocker, offset = { -1, 0, 0 } },
    b = m:rigid_link { from = coupler, offset = { 1, 0, 0 } } }
  m:independent "crank"
  m:reference { crank = "0.3", coupler = "0.5", rocker = "0.2" }
  local r = m:rank { box = { crank = 0, coupler = 0, rocker = 0 } } -- coupler and rocker on one line, the crank across
  assert.equal("proved", r.status)
  table.sort(r.dependent)
  assert.equal("crank", r.dependent[1])
end)

-- -- motions that contradict each other

describe("a loop between given motions", function()
  local function driven(second)
    local m = ambit.mechanism "driven twice"
    local a = m:revolute { from = m.world, angle = ambit.time }
    local b = m:revolute { from = m.world, angle = second }
    local free = m:revolute { from = m.world, name = "free" }
    local function arm(at) return m:rigid_link { from = at, offset = { 1, 0, 0 } } end
    m:point_mass { at = arm(free), mass = 1 }
    m:close_point { a = arm(a), b = arm(b), name = "loop" }
    return m
  end

  it("is refused where no speeds of the joints keep it closed", function()
    local m = driven(2 * ambit.time)
    assert.truthy(message_of(m.dynamics, m):find "the given motions pull the loop of `loop` apart")
  end)

  it("is redundant where they agree", function()
    local m = driven(ambit.time * ambit.cos(0))
    assert.same(3, #m:redundant())
    m:dynamics()
  end)
end)

-- -- messages

describe("bad use of loops", function()
  it("is named", function()
    local m = ambit.mechanism "open"
    local at = m:revolute { from = m.world, axis = "z", name = "q" }
    m:point_mass { at = m:rigid_link { from = at, offset = { 1, 0, 0 } }, mass = 1 }
    assert.truthy(message_of(m.redundant, m):find "redundant: the mechanism `open` has no closed loops")
    assert.truthy(message_of(m.rank, m, { box = {} }):find "rank: the mechanism `open` has no closed loops")
    assert.truthy(message_of(m.independent, m, { "p" }):find "independent: there is no coordinate `p`")
    assert.truthy(message_of(m.reference, m, { qq = 1 }):find "reference: unknown key `qq`; did you mean `q`%?")
    assert.same({}, m:constraints())
  end)

  it("in a certificate is named", function()
    local m = rods(1)
    assert.truthy(message_of(m.rank, m, {}):find "rank: box: expected a table")
    assert.truthy(message_of(m.rank, m, { box = { theta = { 0, 1 } } }):find "says nothing about the coordinate")
    assert.truthy(message_of(m.rank, m, { box = { theta = { 1 } } }):find "expected { lo, hi }, got a list of 1")
    assert.truthy(message_of(m.rank, m, { box = {}, boxes = 0 }):find "rank: boxes: expected a positive integer")
  end)

  it("a speed that follows from others is named", function()
    local m = rods(1)
    m:independent { "rod1" }
    local start = at_angle(1, 1, 1)
    local message = message_of(ambit.simulate, { m, initial = start, t = 1 })
    assert.truthy(message:find "simulate: initial: the speed `theta'` follows from rod1', because loops are closed")
  end)

  it("a choice that leaves a loop open is named", function()
    local m = rods(2)
    m:independent { "theta", "rod1" }
    assert.truthy(message_of(m.dynamics, m):find "2 coordinates were named, but the loops leave 1 degree of freedom")
    m:independent {}
    assert.equal(1, #m:independent())
  end)
end)

describe("a solver that proves nothing", function()
  it("does not start from an open loop", function()
    local m = ambit.mechanism "rod"
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 1, 0, 0 } }
    local slider = m:prismatic { from = m.world, axis = "x", name = "s" }
    local pin = m:rigid_link { from = m:revolute { from = slider, axis = "z", name = "b" }, offset = { -2, 0, 0 } }
    m:point_mass { at = tip, mass = 1 }
    m:point_mass { at = slider, mass = 1 }
    m:close_pin { a = tip, b = pin, name = "close" }
    m:independent { "a" }
    local start = m:assemble { a = 1, guess = { s = 2.3, b = -0.4 }, within = 0.5 }
    assert.equal("unique", start.status)
    local at = start.configuration
    at["a'"] = 1
    assert.equal("complete", ambit.simulate({ m:dynamics(), initial = at, t = { 0, 0.1 }, solver = "gsl" }).status)
    at.s = 2
    local good, message = pcall(ambit.simulate, { m:dynamics(), initial = at, t = { 0, 0.1 }, solver = "gsl" })
    assert.is_false(good)
    assert.matches("simulate: initial: the constraint `close", message, 1, true)
  end)
end)
