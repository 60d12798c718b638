-- reduce/element.lua -- what may be left out of a mechanism: the candidates behind elements = true or { "name", ... }.
--
--   NAME           the part itself, where nothing hangs on it: a mass, a body, a spring, a damper, friction, gravity
--   NAME: rigid    a joint_spring, spring_damper or bushing whose joint stands still where it is slack
--                  (reduce/element_rest.lua)
--   NAME: locked   a joint that stands still at its reference coordinate: `at` in { "NAME", at = 0.3 }, else that of
--                  m:reference, else 0
--   NAME: inertia  a rigid_body without its moments of inertia: a point mass at its centre
--   NAME: weight   a mass that gravity does not pull
-- elements = true means all of these but locked joints. In a list a name alone means the part itself and, of a spring,
-- the rigid one too; of a joint, that it is locked.
local check = require "ambit.check"
local copy = require "ambit.reduce.mechanism_copy"
local core = require "ambit.core"
local rest = require "ambit.reduce.element_rest"

local candidate = {}

local WHAT = "reduce: elements"

local zero = core.expression(0)

local function part_name(m, part) return core.part_name(m.handle, part) end

local function is_free(m, part) return #m.declared[part].outs == 0 end

local names = core.default
local masses = { [names.point_mass] = true, [names.body] = true }

local function new(m, part, kind, more)
  local own = part_name(m, part)
  local c = { part = part, kind = kind, element = own, type = m.declared[part].name,
    name = kind == "left" and own or ("%s: %s"):format(own, kind) }
  for key, value in pairs(more or {}) do c[key] = value end
  return c
end

local function motion_text(m, joint, motions)
  local list = {}
  for i, c in ipairs(rest.coordinates(m, joint)) do list[i] = ("%s = %s"):format(c.name, tostring(motions[i])) end
  return table.concat(list, ", ")
end

-- -- of each kind: the candidate, or nil and why there is none

local makers = {}

function makers.left(m, part)
  if is_free(m, part) then return new(m, part, "left") end
  return nil, "other parts hang on it"
end

local function locked(m, part, kind, joint, motions)
  return new(m, part, kind, { joint = joint, motions = motions, replacement = motion_text(m, joint, motions) })
end

function makers.rigid(m, part)
  if not rest.is_spring(m, part) then
    return nil, ("it is a %s: expected a %s, %s or %s"):format(m.declared[part].name, names.spring, names.strut,
      names.bushing)
  end
  local joint, motions = rest.of(m, part)
  if not joint then return nil, motions end
  return locked(m, part, "rigid", joint, motions)
end

-- The coordinate at which a joint is to stand still.
local function reference_of(m, c, at)
  if at ~= nil then
    local what = ("%s: `%s`: at"):format(WHAT, c.name)
    local e = core.expression(at, nil, what)
    return rest.moves(e) and e or core.expression(at, c.unit, what) -- what moves is refused whatever its unit
  end
  local given = rawget(m, "has_reference") and m:reference()[c.name]
  return given and core.expression(given) or zero
end

function makers.locked(m, part, at)
  local coordinates = rest.coordinates(m, part)
  if #coordinates == 0 then return nil, "it is no joint with a coordinate" end
  if #coordinates > 1 then
    if at ~= nil then
      return nil, ("it has %d coordinates: it can be locked at 0 only, leave out `at`"):format(#coordinates)
    end
    return locked(m, part, "locked", part, rest.zero(m, part))
  end
  if not copy.can_follow(m, part) then
    return nil, ("a %s cannot be given a motion"):format(m.declared[part].name)
  end
  local motion = reference_of(m, coordinates[1], at)
  local moves = rest.moves(motion)
  if moves then return nil, ("`at` moves with `%s`"):format(moves) end
  return locked(m, part, "locked", part, { motion })
end

function makers.inertia(m, part)
  if m.declared[part].name ~= names.body then return nil, "it is no " .. names.body end
  if not copy.values(m, part).inertia then return nil, "it has no moments of inertia" end
  return new(m, part, "inertia")
end

function makers.weight(m, part)
  if not masses[m.declared[part].name] then return nil, "it is no mass" end
  local field = core.pull(m.handle, -1, 0, core.FIELD, 3)
  if field[1] == zero and field[2] == zero and field[3] == zero then return nil, "there is no gravity" end
  return new(m, part, "weight")
end

local order = { "left", "rigid", "inertia", "weight" }
local kinds = { "rigid", "locked", "inertia", "weight" }

-- -- elements = true

local function every(m)
  local list = {}
  for part = 1, core.part_count(m.handle) - 1 do
    for _, kind in ipairs(order) do list[#list + 1] = makers[kind](m, part) end
  end
  return list
end

-- -- elements = { "name", "name: rigid", { "joint", at = 0.3 } }

local function parts_by_name(m)
  local by_name, names = {}, {}
  for part = 1, core.part_count(m.handle) - 1 do
    local name = part_name(m, part)
    by_name[name], names[part] = part, name
  end
  return by_name, names
end

local function refuse(entry, reason) check.fail("%s: `%s`: %s", WHAT, entry, reason) end

local function made(m, part, kind, entry, at)
  local c, reason = makers[kind](m, part, at)
  if not c then refuse(entry, (kind == "left" and "it cannot be left out, " or "") .. reason) end
  return c
end

-- The candidates of one name without a kind.
local function plain(m, part, entry, at)
  if #rest.coordinates(m, part) > 0 then return { made(m, part, "locked", entry, at) } end
  if at ~= nil then refuse(entry, "`at` is of a joint with a coordinate") end
  local list = { made(m, part, "left", entry) }
  if rest.is_spring(m, part) then list[2] = makers.rigid(m, part) end
  return list
end

local function read_entry(m, by_name, names, entry)
  local at
  if type(entry) == "table" and getmetatable(entry) == nil then
    check.keys(entry, { "at" }, WHAT, 1)
    entry, at = entry[1], entry.at
  end
  if type(entry) ~= "string" then
    check.fail('%s: expected names of parts, as in { "mass", "spring: rigid", { "joint", at = 0.3 } }, got %s', WHAT,
      check.shown(entry))
  end
  if by_name[entry] then return plain(m, by_name[entry], entry, at) end
  local name, kind = entry:match "^(.*): (.-)$"
  local part = name and by_name[name]
  if not part then
    check.fail("%s: the mechanism `%s` has no part `%s`%s", WHAT, m.name, name or entry,
      check.suggest(name or entry, names))
  end
  if not makers[kind] or kind == "left" then
    check.fail("%s: `%s`: there is no `%s`%s", WHAT, entry, kind, check.suggest(kind, kinds))
  end
  if at ~= nil and kind ~= "locked" then refuse(entry, "`at` is of a joint that is locked") end
  return { made(m, part, kind, entry, at) }
end

local function listed(m, elements)
  local by_name, names = parts_by_name(m)
  local list, seen = {}, {}
  check.keys(elements, {}, WHAT, #elements)
  for _, entry in ipairs(elements) do
    for _, c in ipairs(read_entry(m, by_name, names, entry)) do
      if seen[c.name] then check.fail("%s: `%s` is named twice", WHAT, c.name) end
      seen[c.name] = true
      list[#list + 1] = c
    end
  end
  return list
end

-- list(m, elements, keep) -> { { name, element, type, part, kind, joint, motions, replacement }, ... }; keep: names of
-- parts that are never to be touched.
function candidate.list(m, elements, keep)
  if elements ~= true then check.table(elements, WHAT .. ': expected true or { "name of a part", ... }') end
  local list, kept = {}, {}
  for _, name in ipairs(keep or {}) do kept[name] = true end
  for _, c in ipairs(elements == true and every(m) or listed(m, elements)) do
    if not kept[c.element] and not kept[c.name] then list[#list + 1] = c end
  end
  if #list == 0 then
    check.fail("%s: the mechanism `%s` has no part that could be left out", WHAT, m.name)
  end
  return list
end

-- What reduce/mechanism_copy.lua is to change for a choice of candidates. Of two that lock one joint the first counts.
function candidate.change(chosen)
  local change = { left = {}, locked = {}, point = {}, weightless = {} }
  for _, c in ipairs(chosen) do
    if c.kind == "left" then change.left[c.part] = true end
    if c.joint and not change.locked[c.joint] then change.locked[c.joint] = c.motions end
    if c.kind == "inertia" then change.point[c.part] = true end
    if c.kind == "weight" then change.weightless[c.part] = true end
  end
  return change
end

-- Does a joint lose inertia with it?
function candidate.is_mass(c)
  return c.kind == "inertia" or (c.kind == "left" and (masses[c.type] or c.type == names.rotor))
end

return candidate
