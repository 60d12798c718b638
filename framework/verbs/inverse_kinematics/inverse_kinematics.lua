-- inverse_kinematics.lua -- ambit.inverse_kinematics { m, at = tip, position = { x, y, z }, orientation = R,
-- box = { joint = { lo, hi } }, given = { joint = value } }: every posture that puts the frame there, proved.
--
-- Three equations for the place. Three for the orientation: with R wanted and Q what the joints make, R'Q is symmetric.
-- A symmetric rotation turns by 0 or by pi: its trace is 3 or -1. So the nine entries R'Q = 1 need not be proved: at a
-- root of the three they hold, or its trace is -1; they narrow the search, and the trace is looked at in the end.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local mechanism = require "ambit.mechanism"
local roots = require "ambit.roots"
local rotation = require "ambit.rotation"

local verb = {}
local what = "inverse_kinematics"

-- -- what is wanted

local function number(value, unit, key)
  return core.expression(value, unit, ("%s: %s"):format(what, key))
end

local function triple(value, unit, key)
  if type(value) ~= "table" then check.fail("%s: %s: expected three numbers, got %s", what, key, check.kind(value)) end
  local list = {}
  for i, axis in ipairs { "x", "y", "z" } do
    local entry = value[i]
    if entry == nil then entry = value[axis] end
    if entry == nil then check.fail("%s: %s: expected three numbers, the component %s is missing", what, key, axis) end
    list[i] = number(entry, unit, ("%s.%s"):format(key, axis))
  end
  return list
end

-- Components that are left out, as in { x = 1, y = 2 }, are free.
local function read_position(value, at, list)
  check.table(value, what .. ": position")
  check.keys(value, { "x", "y", "z" }, what .. ": position", 3)
  for i, axis in ipairs { "x", "y", "z" } do
    local entry = value[i]
    if entry == nil then entry = value[axis] end
    if entry ~= nil then list[#list + 1] = at[axis] - number(entry, "m", "position." .. axis) end
  end
end

-- Rows of a rotation; or { axis = "z", angle = a }; or { rpy = { r, p, y } }: about fixed x, y, z in this order.
local function read_orientation(t)
  check.table(t, what .. ": orientation")
  if t.axis ~= nil or t.angle ~= nil then
    check.keys(t, { "axis", "angle" }, what .. ": orientation", 0)
    if t.axis == nil or t.angle == nil then check.fail("%s: orientation: expected axis and angle", what) end
    return rotation.about(rotation.direction(t.axis, what .. ": orientation: axis"), number(t.angle, "rad", "angle"))
  end
  if t.rpy ~= nil then
    check.keys(t, { "rpy" }, what .. ": orientation", 0)
    local a = triple(t.rpy, "rad", "orientation: rpy")
    local turns = {}
    for i, axis in ipairs { "x", "y", "z" } do turns[i] = rotation.about(rotation.direction(axis, what), a[i]) end
    local function back(r) return { r[1], r[4], r[7], r[2], r[5], r[8], r[3], r[6], r[9] } end
    return rotation.product_back(back(turns[3]), rotation.product_back(back(turns[2]), turns[1]))
  end
  local list = {}
  for i = 1, 3 do
    local row = triple(t[i], "1", ("orientation: row %d"):format(i))
    table.move(row, 1, 3, #list + 1, list)
  end
  return list
end

-- The rotation whose rows are r's, made orthonormal one after the other (Gram, Schmidt): for a rotation r itself.
-- Entries in doubles or with a few digits are none, exactly, and no posture would have them.
local function orthonormal(r)
  local function row(i) return { x = r[i], y = r[i + 1], z = r[i + 2] } end
  local function unit(v)
    local length = core.sqrt(rotation.dot(v, v))
    return { x = v.x / length, y = v.y / length, z = v.z / length }
  end
  local first, second = unit(row(1)), row(4)
  local along = rotation.dot(first, second)
  second = unit { x = second.x - along * first.x, y = second.y - along * first.y, z = second.z - along * first.z }
  local third = rotation.cross(first, second)
  return { first.x, first.y, first.z, second.x, second.y, second.z, third.x, third.y, third.z }
end

-- Rows that are no rotation have no posture, which would be a misleading answer.
local function check_rotation(r, nearest)
  local off = {}
  for i = 1, 9 do off[i] = r[i] - nearest[i] end
  for i, x in ipairs(core.evaluate { expressions = off }) do
    if x:is_empty() or x:mig() > 1e-6 then
      check.fail("%s: orientation: the rows are no rotation: entry %d of row %d is off by %s", what, (i - 1) % 3 + 1,
        (i + 2) // 3, x)
    end
  end
end

local function is_certain(list)
  for _, leaf in ipairs(core.leaves(list)) do if leaf.kind == "unknown" then return false end end
  return true
end

-- The equations: those that are solved, then those that they imply; and the trace of R'Q, or nil.
local function equations(m, t)
  local at = m:position(t.at)
  local list, implied, trace = {}, {}, nil
  if t.position ~= nil then read_position(t.position, at, list) end
  if t.orientation ~= nil then
    local r = read_orientation(t.orientation)
    local nearest = orthonormal(r)
    check_rotation(r, nearest)
    if is_certain(r) then r = nearest end -- uncertain rows would be blurred by it: they are to be rotations as formulas
    local q, rows = {}, m:orientation(t.at)
    for i = 1, 9 do q[i] = rows[(i + 2) // 3][(i - 1) % 3 + 1] end
    local off = rotation.product_back(r, q)
    local skew = rotation.vee(off)
    table.move({ skew.x, skew.y, skew.z }, 1, 3, #list + 1, list)
    for i = 1, 9 do implied[i] = q[i] - r[i] end
    trace = rotation.trace(off)
  end
  if #list == 0 then check.fail("%s: nothing is wanted: expected position = { x, y, z } or orientation = ...", what) end
  return list, implied, trace
end

-- -- where to look

local function turn() return core.interval(core.expression(-core.pi())):hull(core.interval(core.pi())) end

-- The range of a coordinate: what `box` says, else its limits; a joint that turns by 2 pi or more, or without end,
-- takes each place within (-pi, pi].
local function range_of(m, t, c)
  if t.box and t.box[c.name] ~= nil then
    return roots.range(t.box[c.name], ("%s: box.%s"):format(what, c.name), c.unit)
  end
  local limits = rawget(m, "limits_of") and m.limits_of[c.name] or {}
  local lower, upper = limits.lower and core.interval(limits.lower).lo, limits.upper and core.interval(limits.upper).hi
  local whole = turn()
  if c.unit == "rad" then
    if lower and upper and upper - lower < whole.hi - whole.lo then return core.interval(lower, upper) end
    return whole
  end
  if lower and upper then return core.interval(lower, upper) end
  check.fail("%s: `%s` has no limits: say where to look, box = { [\"%s\"] = { lo, hi } }", what, c.name, c.name)
end

local function check_names(list, key, of, others)
  check.table(list, ("%s: %s"):format(what, key))
  for name in pairs(list) do
    if not of[name] then
      check.fail("%s: %s: there is no coordinate `%s`%s", what, key, tostring(name),
        check.suggest(name, check.sorted(of)))
    end
    if others and others[name] ~= nil then check.fail("%s: `%s` is in `box` and in `given`", what, name) end
  end
end

-- The unknowns and the bindings.
local function place(m, t, q, symbols)
  local of = {}
  for _, c in ipairs(core.coordinates(m.handle)) do of[c.name] = c end
  if t.given ~= nil then check_names(t.given, "given", of) end
  if t.box ~= nil then check_names(t.box, "box", of, t.given) end
  q.names, q.symbols, q.ranges, q.leaves, q.values = {}, {}, {}, {}, {}
  for _, c in ipairs(core.coordinates(m.handle)) do
    local value = t.given and t.given[c.name]
    if value ~= nil then
      q.leaves[#q.leaves + 1] = c.q
      q.values[#q.values + 1] = core.expression(value, c.unit, ("%s: given.%s"):format(what, c.name))
    elseif symbols[c.name] then
      q.names[#q.names + 1], q.symbols[#q.symbols + 1] = c.name, c.q
      q.ranges[#q.ranges + 1] = range_of(m, t, c)
    elseif t.box and t.box[c.name] ~= nil then
      check.fail("%s: box: the frame does not move with `%s`", what, c.name)
    end
  end
end

-- Equations that are not 0 = 0 with what is given put in.
local function count_equations(list, leaves, values)
  local count = 0
  for _, f in ipairs(core.substitute(list, leaves, values)) do
    if not core.is_constant(f) or core.interval(f):mag() > 0 then count = count + 1 end
  end
  return count
end

local function check_count(q, list)
  local count = count_equations(list, q.leaves, q.values)
  if #q.names > count then
    check.fail("%s: the mechanism is redundant: %d joints (%s) for %d equations; give %d of them values in `given`",
      what, #q.names, table.concat(q.names, ", "), count, #q.names - count)
  end
  if #q.names == 0 then check.fail("%s: the frame does not move: every joint has a value", what) end
end

-- -- what is found

-- Roots at which R'Q turns by pi instead of 0 are none of the wanted orientation.
local function drop_turned(found, q, trace)
  if not trace then return end
  local function is_turned(point)
    local leaves, values = table.move(q.leaves, 1, #q.leaves, 1, {}), table.move(q.values, 1, #q.values, 1, {})
    for i, name in ipairs(q.names) do
      leaves[#leaves + 1], values[#values + 1] = q.symbols[i], core.expression(rawget(point, name))
    end
    local x = core.evaluate { expressions = { trace }, leaves = leaves, values = values }[1]
    return x.hi < 3, x.lo > -1
  end
  for _, key in ipairs { "proved", "partly", "undecided" } do
    local kept = {}
    for _, point in ipairs(found[key]) do
      local cannot, sure = is_turned(point)
      if not cannot and (sure or key == "undecided") then
        kept[#kept + 1] = point
      elseif not cannot then
        found.undecided[#found.undecided + 1] = point
        if found.status == "complete" then
          found.status, found.code = "unable", "unable.orientation"
          found.reason = "the data are too uncertain to tell an orientation from its opposite"
        end
      end
    end
    found[key] = kept
  end
end

function verb.inverse_kinematics(t)
  check.table(t, what)
  local m = t[1]
  if not mechanism.is(m) then check.fail("%s: expected a mechanism as the first entry, got %s", what, check.kind(m)) end
  local q = roots.settings(t, what, { "at", "position", "orientation", "box", "given" }, 1)
  frame.place(m, t.at, "frame", what .. ": at")
  if core.has_constraints(m.handle) then
    check.fail("%s: the mechanism `%s` has closed loops; m:assemble { ... } closes them", what, m.name)
  end
  local list, implied, trace = equations(m, t)
  place(m, t, q, roots.symbols(table.move(implied, 1, #implied, #list + 1, table.move(list, 1, #list, 1, {}))))
  check_count(q, list)
  q.leading = #list
  q.expressions = table.move(implied, 1, #implied, #list + 1, list)
  local found = roots.run(q)
  drop_turned(found, q, trace)
  return roots.finish(q, what, found)
end

return verb
