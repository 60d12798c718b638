-- random_mechanism.lua -- mechanisms at random, each twice: as a scene of Ambit with uncertain data, and as the table
-- that the oracle `multibody` integrates with drawn ones. For random_mechanisms.lua.
local ambit = require "ambit"
local multibody = require "multibody"
local linkage = require "random_linkage"
local parts = require "random_parts"
local spatial = require "random_spatial"
local state = require "random_state"

local random_mechanism = {}

local DATA = { "mass", "turn", "scale", "torque", "amplitude", "stiffness", "rest", "damping", "armature",
  "friction", "creep", "proportional", "derivative", "goal", "swing", "tempo" }
local OF_TIES = { "ratio", "offset", "swing", "tempo" }
local LISTS = { "offset", "centre" }
local AXES = { x = { 1, 0, 0 }, y = { 0, 1, 0 }, z = { 0, 0, 1 } }

-- Random numbers that are the same on every machine.
function random_mechanism.source(seed)
  local state = (seed * -7046029254386353131) ~ (seed * 2862933555777941757 >> 29) -- neighbours have nothing in common
  local r = {}
  function r.integer(n) -- 1 .. n
    state = state * 6364136223846793005 + 1442695040888963407
    return (state >> 33) % n + 1
  end
  function r.unit() return r.integer(1 << 30) / (1 << 30) end
  function r.between(lo, hi) return lo + (hi - lo) * r.unit() end
  function r.one_of(list) return list[r.integer(#list)] end
  function r.chance(p) return r.unit() <= p end
  -- Of each datum a number in [-most, most]: corners and points of the inside in turn.
  function r.draw(data, number, most)
    local list = {}
    for k in ipairs(data) do
      local s = r.between(-1, 1)
      list[k] = most * (number % 2 == 0 and s or s > 0 and 1 or -1)
    end
    return list
  end
  for _ = 1, 4 do r.integer(2) end
  return r
end

-- -- what both sides are made of: bodies as the oracle takes them, with what only Ambit needs

local function body(r, parent, name)
  local a, b, c = r.between(0.05, 0.3), r.between(0.05, 0.3), r.between(0.05, 0.3)
  local mass = r.between(0.3, 3)
  local function moment(p, q) return mass * (p * p + q * q) / 12 end
  local x, y, z = moment(b, c), moment(a, c), moment(a, b)
  local off = 0.05 * math.min(x, y, z)
  return {
    name = name, parent = parent, mass = mass, scale = 1,
    centre = { r.between(-0.2, 0.2), r.between(-0.2, 0.2), r.between(-0.2, 0.2) },
    entries = { x, r.between(-off, off), r.between(-off, off), y, r.between(-off, off), z },
    offset = { r.between(-0.4, 0.4), r.between(-0.4, 0.4), r.between(-0.4, 0.4) },
    turn_axis = r.one_of { "x", "y", "z" }, turn = r.chance(0.5) and r.between(-1, 1) or 0,
    torque = 0, amplitude = 0, rate = 0, stiffness = 0, rest = 0, damping = 0, armature = 0,
  }
end

local function massless(parent, name)
  return { name = name, parent = parent, mass = 0, scale = 1, centre = { 0, 0, 0 }, entries = { 0, 0, 0, 0, 0, 0 },
    offset = { 0, 0, 0 }, turn_axis = "z", turn = 0, torque = 0, amplitude = 0, rate = 0, stiffness = 0, rest = 0,
    damping = 0, armature = 0 }
end

local function drive(r, b)
  if r.chance(0.4) then b.stiffness, b.rest = r.between(1, 20), r.between(-0.5, 0.5) end
  if r.chance(0.5) then b.damping = r.between(0.01, 0.3) end
  if r.chance(0.3) then b.armature = r.between(0.01, 0.1) end
  if r.chance(0.4) then b.torque = r.between(-3, 3) end
  if r.chance(0.2) then b.amplitude, b.rate = r.between(-2, 2), r.between(1, 8) end
end

-- Joints of several coordinates, as hinges and slides one after the other.
local COMPOUND = {
  universal = { { "turn", "x" }, { "turn", "y" } },
  cylindrical = { { "slide", "z" }, { "turn", "z" } },
  spherical = { { "turn", "z" }, { "turn", "y" }, { "turn", "x" } },
  spherical_quaternion = { { "turn", "z" }, { "turn", "y" }, { "turn", "x" } },
  free_quaternion = { { "slide", "x" }, { "slide", "y" }, { "slide", "z" }, { "turn", "z" }, { "turn", "y" },
    { "turn", "x" } },
}
local KINDS = { "universal", "cylindrical", "spherical", "spherical_quaternion", "free_quaternion" }

local function add_compound(r, plan, kind, parent, name)
  local last = body(r, parent, name)
  local parts = COMPOUND[kind]
  for k, part in ipairs(parts) do
    local b = k == #parts and last or massless(k == 1 and parent or #plan.bodies, name)
    if k == #parts then b.parent = #plan.bodies end
    b.slides, b.axis, b.state, b.gimbal = part[1] == "slide", part[2], name .. "." .. k, #parts > 2
    plan.bodies[#plan.bodies + 1] = b
  end
  local first = plan.bodies[#plan.bodies - #parts + 1] -- carries what lies before the joint
  first.offset, last.offset = last.offset, { 0, 0, 0 }
  first.turn_axis, first.turn, last.turn = last.turn_axis, last.turn, 0
  first.compound, first.count = kind, #parts
end

-- A tree of n coordinates.
local function tree(r, n)
  local plan = { bodies = {}, loops = {}, gravity = { 0, 0, -9.81 }, name = ("tree of %d"):format(n) }
  while #plan.bodies < n do
    local at = #plan.bodies
    local parent = at == 0 and 0 or r.chance(0.75) and at or r.integer(at)
    while parent > 0 and plan.bodies[parent].mass == 0 do parent = parent + 1 end
    local name, left = "j" .. at + 1, n - at
    local kind = r.chance(0.3) and r.one_of(KINDS)
    if kind and #COMPOUND[kind] <= left then
      add_compound(r, plan, kind, parent, name)
    else
      local b = body(r, parent, name)
      b.axis, b.slides, b.state = r.one_of { "x", "y", "z" }, r.chance(0.2), name
      drive(r, b)
      plan.bodies[at + 1] = b
    end
  end
  plan.q, plan.v = {}, {}
  for i, b in ipairs(plan.bodies) do -- three angles in a row stay away from where they are singular
    plan.q[i] = b.slides and r.between(-0.3, 0.3) or r.between(-1, 1) * (b.gimbal and 0.5 or 1)
    plan.v[i] = r.between(-1, 1)
  end
  return plan
end

-- -- which numbers are uncertain

-- Every number that may be: { table, key }
local function candidates(plan)
  local list, seen = {}, {}
  local function add_list(of) -- a link's length may be that of several bodies
    for k = 1, seen[of] and 0 or #of do if of[k] ~= 0 then list[#list + 1] = { of, k } end end
    seen[of] = true
  end
  for _, b in ipairs(plan.bodies) do
    for _, key in ipairs(DATA) do
      if b[key] ~= 0 and not b.exact and not (key == "scale" and b.mass == 0) then list[#list + 1] = { b, key } end
    end
    for _, key in ipairs(b.exact and {} or LISTS) do add_list(b[key]) end
  end
  for _, t in ipairs(plan.ties) do
    for _, key in ipairs(OF_TIES) do if t[key] ~= 0 then list[#list + 1] = { t, key } end end
  end
  for _, loop in ipairs(plan.loops) do
    add_list(loop.a_length)
    add_list(loop.b_length)
  end
  for _, key in ipairs { "q", "v" } do
    for i = 1, #plan.bodies do
      if parts.is_free(plan, i) then list[#list + 1] = { plan[key], i, true } end
    end
  end
  return list
end

-- What acts in a joint may vary in time.
local ACTING = { torque = true, stiffness = true, rest = true, damping = true }

local function choose_data(r, plan, most, varying)
  local list, data = candidates(plan), {}
  local n = math.min(#list, 4 + r.integer(math.max(1, most - 4)))
  for k = 1, n do
    local pick = k - 1 + r.integer(#list - k + 1)
    list[k], list[pick] = list[pick], list[k]
    local where, key, is_start = list[k][1], list[k][2], list[k][3]
    local tolerance = 1e-4 * 500 ^ r.unit() -- .01 to 5 %
    local middle = where[key]
    data[k] = { where = where, key = key, middle = middle, radius = tolerance * (is_start and 0.2 or math.abs(middle)),
      varies = varying and ACTING[key] and r.chance(0.7) }
  end
  return data
end

-- The expression of a number of the plan: uncertain, or as it is.
local function reader(data)
  local datum = {}
  for k, d in ipairs(data) do
    datum[d.where] = datum[d.where] or {}
    datum[d.where][d.key] = d.varies and ambit.varying(d.middle - d.radius, d.middle + d.radius, "datum " .. k)
      or ambit.around(d.middle, d.radius, "datum " .. k)
  end
  return function(where, key)
    return datum[where] and datum[where][key] or ambit.number(where[key])
  end
end

-- -- the scene

local function list_of(value, where) return { value(where, 1), value(where, 2), value(where, 3) } end

local function add_torque(m, b, value, joint)
  local function law(q, v, t)
    local sum = value(b, "torque") - value(b, "damping") * v
    if b.stiffness ~= 0 then sum = sum - value(b, "stiffness") * (q - value(b, "rest")) end
    if b.amplitude ~= 0 then sum = sum + value(b, "amplitude") * ambit.sin(value(b, "rate") * t) end
    return sum
  end
  if b.torque ~= 0 or b.stiffness ~= 0 or b.damping ~= 0 or b.amplitude ~= 0 then
    m:joint_torque { joint = joint, [b.slides and "force" or "torque"] = law }
  end
  if b.armature ~= 0 then m:armature { joint = joint, [b.slides and "mass" or "inertia"] = value(b, "armature") } end
end

local function add_body(m, b, value, at)
  if b.mass == 0 then return end
  local e, scale = b.entries, value(b, "scale")
  local xx, xy, xz, yy, yz, zz = scale * e[1], scale * e[2], scale * e[3], scale * e[4], scale * e[5], scale * e[6]
  m:rigid_body { at = at, mass = value(b, "mass"), centre = list_of(value, b.centre),
    inertia = { xx, xy, xz, xy, yy, yz, xz, yz, zz } }
end

local function add_joint(m, b, at, t)
  t.from, t.name = at, b.name
  if b.compound and b.compound ~= "cylindrical" then return m[b.compound](m, t) end
  t.axis = b.axis
  if b.compound == "cylindrical" then return m:cylindrical(t) end
  return m[b.slides and "prismatic" or "revolute"](m, t)
end

local function build(plan, value)
  local m = ambit.mechanism { "random", gravity = plan.gravity }
  local frames, joints, i = { [0] = m.world }, {}, 1
  while i <= #plan.bodies do
    local b = plan.bodies[i]
    local at = m:rigid_link { from = frames[b.parent], offset = list_of(value, b.offset) }
    if b.turn ~= 0 then at = m:weld { from = at, axis = b.turn_axis, angle = value(b, "turn") } end
    local frame, joint = add_joint(m, b, at, parts.motion(plan, i, value, joints))
    joints[i] = joint
    local last = i + (b.count or 1) - 1
    if not b.compound then
      add_torque(m, b, value, joint)
      parts.add_to_joint(m, b, value, joint)
    end
    add_body(m, plan.bodies[last], value, frame)
    for k = i, last do frames[k] = frame end
    i = last + 1
  end
  parts.add_gears(m, plan, value, joints)
  return m, frames
end

local function question(plan, data)
  local value = reader(data)
  local m, frames = build(plan, value)
  local initial = {}
  for _, i in ipairs(state.joints(plan)) do
    if parts.is_free(plan, i) then
      state.each(plan, i, ambit, function(k) return value(plan.q, k) end, function(k) return value(plan.v, k) end,
        function(name, x) initial[name] = x end)
    end
  end
  parts.start(plan, value, initial)
  if #plan.loops > 0 then
    (plan.spatial and spatial or linkage).close(m, frames, plan, value, initial,
      parts.angle_of_crank(plan, value, initial))
  end
  parts.choose_independent(m, plan)
  return { m:dynamics(), initial = initial }
end

-- -- the oracle

-- Half of the torques that vary are waves of any frequency: { [body] = { torque, amplitude, rate } }. What else varies
-- has the drawn value at all times.
local function waves_of(data, draw)
  local waves = {}
  for k, d in ipairs(data) do
    local drawn = 997 * (draw[k] or 0) + 331 * (draw[k + 1] or draw[1] or 0) + 57 * k
    local part = drawn - math.floor(drawn)
    if d.varies and d.key == "torque" and d.where.amplitude == 0 and next(draw) and k % 2 == 0 then
      waves[d.where] = { torque = d.middle, amplitude = d.radius * (1 - 1e-9), rate = 100 ^ part }
    end
  end
  return waves
end

-- A copy in which the data have drawn values; not quite the ends, which rounding may put beyond the tolerance.
local function resolved(plan, data, draw)
  local kept = {}
  for k, d in ipairs(data) do
    kept[k] = d.where[d.key]
    d.where[d.key] = d.middle + d.radius * (1 - 1e-9) * (draw[k] or 0)
  end
  local t = { bodies = {}, loops = {}, ties = {}, gravity = plan.gravity, dependent = plan.dependent or {} }
  local waves = waves_of(data, draw)
  for i, b in ipairs(plan.bodies) do
    local c = {}
    for key, x in pairs(b) do c[key] = x end
    c.axis, c.turn_axis, c.inertia = AXES[b.axis], AXES[b.turn_axis], {}
    for k = 1, 6 do c.inertia[k] = b.scale * b.entries[k] end
    for key, x in pairs(waves[b] or {}) do c[key] = x end
    c.offset, c.centre = table.move(b.offset, 1, 3, 1, {}), table.move(b.centre, 1, 3, 1, {})
    t.bodies[i] = c
  end
  t.q, t.v = table.move(plan.q, 1, #plan.bodies, 1, {}), table.move(plan.v, 1, #plan.bodies, 1, {})
  if #plan.loops > 0 then (plan.spatial and spatial or linkage).resolve(plan, t) end
  for k, tie in ipairs(plan.ties) do
    t.ties[k] = {}
    for key, x in pairs(tie) do t.ties[k][key] = x end
  end
  for k, d in ipairs(data) do d.where[d.key] = kept[k] end
  return t
end

local function plan_of(r, n)
  local kind = r.unit()
  if kind < 0.35 then return linkage.new(r, n, body, drive) end
  if kind < 0.5 and n > 3 then return spatial.new(r, n, body, massless, drive) end
  return tree(r, n)
end

-- A mechanism: its name, data, question() for simulate, motion(draw, times, tolerance) of the oracle: a list of the
-- states by name. o: joints, data: at most so many; varying: some of what acts in joints varies in time
function random_mechanism.new(r, o)
  local n = 2 + r.integer(math.max(1, o.joints - 2))
  local plan = plan_of(r, n)
  parts.add(r, plan)
  local data = choose_data(r, plan, o.data, o.varying)
  return {
    name = ("%s, %d data"):format(plan.name, #data), data = data,
    question = function() return question(plan, data) end,
    motion = function(draw, times, tolerance)
      local t = resolved(plan, data, draw)
      t.times, t.tolerance = times, tolerance
      local list, problem = multibody.run(t)
      if not list then return nil, problem end
      for k, found in ipairs(list) do list[k] = state.of(plan, found) end
      return list
    end,
  }
end

return random_mechanism
