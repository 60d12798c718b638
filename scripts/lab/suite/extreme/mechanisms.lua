-- suite/extreme/mechanisms.lua -- masses of 1e-300 and 1e300, none, singular mass matrices, joints at their singular
-- poses, loops at dead points, springs of 1e15 N/m.
local over = require "ambit.suite.extreme.over"
local refusal = require "ambit.suite.extreme.refusal"

local NAN, INF = 0 / 0, math.huge

local function hinged(a, masses)
  local m = a.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
  local at = m.world
  for i, mass in ipairs(masses) do
    local joint = m:revolute { from = at, axis = "z", name = "q" .. i }
    at = m:rigid_link { from = joint, offset = { 0, -1, 0 } }
    if mass then m:point_mass { at = at, mass = mass } end
  end
  return m
end

local function start(m, values)
  local d, initial = m:dynamics(), {}
  for _, name in ipairs(d.states) do initial[name] = values[name] or 0 end
  return { d, initial = initial, t = { 0, 1 } }
end

local function of_masses(...)
  local masses = { ... }
  return function(a)
    return start(hinged(a, masses), { q1 = 1 })
  end
end

local function body(mass, inertia)
  return function(a)
    local m = a.mechanism "body"
    m:rigid_body { at = m:free { from = m.world }, mass = mass, inertia = inertia }
    m:dynamics()
  end
end

local function mass(value)
  return function(a) hinged(a, { value }):dynamics() end
end

local unit = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

local bad = {
  { "no mass", mass(0), "mass", "zero", "above 0" },
  { "-0 as a mass", mass(-0.0), "mass", "zero" },
  { "a negative mass", mass(-1), "mass", "negative", "above 0" },
  { "NaN as a mass", mass(NAN), "mass", "NaN" },
  { "an infinite mass", mass(INF), "mass", "infinite" },
  { "a mass that overflows", mass "1e400", "mass", "1e400" },
  { "a joint that moves no mass", mass(false), "`q1`", "no mass" },
  { "NaN in an inertia", body(1, { { NAN, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }), "inertia", "NaN" },
  { "a body without mass", body(0, unit), "mass", "zero" },
  { "an axis of no length", function(a)
    local m = a.mechanism "m"
    m:revolute { from = m.world, axis = { 0, 0, 0 }, name = "q" }
  end, "axis", "zero" },
  { "an axis of NaN", function(a)
    local m = a.mechanism "m"
    m:revolute { from = m.world, axis = { NAN, 0, 1 }, name = "q" }
  end, "axis", "NaN" },
  { "infinite gravity", function(a) a.mechanism { "m", gravity = { 0, INF, 0 } } end, "gravity", "infinite" },
  { "a spring of NaN", function(a)
    local m = a.mechanism "m"
    local joint = m:prismatic { from = m.world, axis = "x", name = "r" }
    m:joint_spring { joint = joint, stiffness = NAN }
  end, "stiffness", "NaN" },
}

local function case(name, title, make, fields)
  return { name = name, group = "extreme", title = title, source = fields.source or "closed form",
    quick = fields.quick ~= false, budget = { cpu = fields.cpu or 10 }, over = over.all(), make = make,
    reference = fields.reference, expected = fields.expected, least = fields.least }
end

local proved = { default = "proved", gsl = "computed" }
local unable = { default = "unable" }

local function at_axis(a)
  local m = a.mechanism { "turntable with a slider", gravity = { 0, "-9.81", 0 } }
  local slider = m:prismatic { from = m:revolute { from = m.world, axis = "z", name = "q" }, axis = "x", name = "r" }
  m:point_mass { at = slider, mass = 1 }
  return start(m, { ["r'"] = 1 })
end

local function spring(a)
  local m = a.mechanism "spring"
  local slider = m:prismatic { from = m.world, axis = "x", name = "r" }
  m:point_mass { at = slider, mass = 1 }
  m:joint_spring { joint = slider, stiffness = 1e15 }
  return { m:dynamics(), initial = { r = "0.001", ["r'"] = 0 }, t = { 0, 1e-6 } }
end

local function gimbal_lock(a)
  local m = a.mechanism { "top", gravity = { 0, 0, "-9.81" } }
  m:rigid_body { at = m:spherical { from = m.world, name = "s" }, mass = 1, centre = { "0.1", 0, "0.2" },
    inertia = { { 1, 0, 0 }, { 0, 2, 0 }, { 0, 0, 3 } } }
  local d = m:dynamics()
  local t = start(m, {})
  t.initial[d.states[2]] = a.pi / 2
  return t
end

-- A universal joint whose second angle has turned the mass onto the first axis: that axis moves nothing.
local function cardan(a, second, rate)
  local m = a.mechanism { "mass on a universal joint", gravity = { 0, 0, 0 } }
  local joint = m:universal { from = m.world, name = "u" }
  m:point_mass { at = m:rigid_link { from = joint, offset = { 0, 0, -1 } }, mass = 1 }
  return start(m, { ["u.2"] = second, ["u.2'"] = rate })
end

local function cardan_at(a) return cardan(a, a.pi / 2, 0) end

local function cardan_into(a)
  local t = cardan(a, 1, 1)
  t.t = { 0, 0.25, 2 }
  return t
end

local function slider_crank(a, gravity)
  local m = a.mechanism { "slider-crank", gravity = gravity }
  local crank = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 1, 0, 0 } }
  local rod = m:rigid_link { from = m:revolute { from = crank, axis = "z", name = "b" }, offset = { 2, 0, 0 } }
  local slider = m:prismatic { from = m.world, axis = "x", name = "s" }
  m:close_pin { a = rod, b = slider }
  m:independent { "s" }
  return m, { crank, rod, slider }
end

-- Crank and rod in one line: the slider cannot say where the crank goes.
local function dead_point(a)
  local m, frames = slider_crank(a, { 0, "-9.81", 0 })
  for _, frame in ipairs(frames) do m:point_mass { at = frame, mass = 1 } end
  return { m:dynamics(), initial = { s = 3, ["s'"] = 0, a = 0, b = 0 }, t = { 0, 1 } }
end

-- Only the slider has mass: it moves freely, until crank and rod are stretched at s = 3.
local function into_dead_point(a)
  local m, frames = slider_crank(a, { 0, 0, 0 })
  m:point_mass { at = frames[3], mass = 1 }
  local initial = m:assemble { s = "2.875", guess = { a = "0.3", b = "-0.5" } }.configuration
  initial["s'"] = 1
  return { m:dynamics(), initial = initial, t = { 0, 0.0625, 0.5 } }
end

return {
  refusal.case("bad_masses", "Masses, inertias and axes that are none", bad),
  case("mass_1e_300", "A pendulum of 1e-300 kg", of_masses(1e-300), { expected = proved }),
  case("mass_1e300", "A pendulum of 1e300 kg", of_masses(1e300), { expected = proved }),
  case("masses_apart", "1e-300 kg hang from 1e300 kg", of_masses(1e300, 1e-300),
    { expected = { default = "proved", stiff = "unable", gsl = "computed" } }),
  case("masses_far_apart", "1e300 kg hang from 1e-300 kg", of_masses(1e-300, 1e300), { expected = unable }),
  case("mass_from_zero", "A mass somewhere in [0, 1] kg", function(a)
    return start(hinged(a, { a.between(0, 1) }), { q1 = 1 })
  end, { expected = { default = "unable", gsl = "computed" } }),
  case("singular_mass_matrix", "A slider on the axis it turns about", at_axis, { expected = unable }),
  case("spring_1e15", "A spring of 1e15 N/m, five turns", spring, { cpu = 3, source = "r = 0.001 cos(omega t)",
    reference = { t = 1e-6, x = { r = "[0.0009786826965598925712, 0.0009786826965598925732]" } },
    expected = { default = "proved", taylor_model = "late", gsl = "computed" }, quick = false }),
  case("gimbal_lock", "A spherical joint at its singular pose", gimbal_lock,
    { expected = { default = "unable", gsl = "computed" } }),
  case("universal_singular", "A universal joint at its singular pose", cardan_at, {
    expected = { default = "unable", gsl = "computed" } }),
  case("universal_into_singular", "A universal joint turns into its singular pose at t = pi/2 - 1", cardan_into, {
    expected = { default = "unable", gsl = "computed" }, least = { default = { t_reached = 0.57 } },
    reference = { t = 0.25, x = { ["u.2"] = "1.25", ["u.2'"] = "1" } } }),
  case("into_dead_point", "A slider-crank runs into its dead point at t = 1/8", into_dead_point, {
    cpu = 20, expected = unable, least = { default = { t_reached = 0.12 } },
    reference = { t = 0.0625, x = { s = "2.9375", ["s'"] = "1" } } }),
  case("dead_point", "A slider-crank led by its slider at the dead point", dead_point,
    { expected = { default = "refused" } }),
}
