-- reduce/element_rest.lua -- where a joint stands if the spring that holds it were rigid: the coordinate at which the
-- spring is slack, as an expression of the data.
--
--   joint_spring   its rest position; if that moves in time (a servo), so does the joint
--   spring_damper  the squared length l^2 between its points is a function of one coordinate q:
--                  on a slide  q^2 + 2 b q + c, so  q = -b +- sqrt(b^2 - c + l0^2);
--                  on a hinge  A + B cos q + C sin q, so  q = atan2(C, B) +- acos((l0^2 - A)/sqrt(B^2 + C^2));
--                  of the two the one that is nearer to 0 (the greater one, where both are as near)
--   bushing        0 on every coordinate, where its frames have to coincide
-- Which position is taken is a choice of the reduced model: whatever it is, the certificate compares with the mechanism
-- as it is. Limits: a spring_damper or a bushing spans exactly one joint that moves.
local copy = require "ambit.reduce.mechanism_copy"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"
local measure = require "ambit.measure"
local rotation = require "ambit.rotation"
local Vector = require "ambit.vector"

local rest = {}

local NEAR = 1e-9 -- m and rad: frames that coincide

-- The coordinates of a part: { { name, unit, q }, ... }.
function rest.coordinates(m, part)
  local list = {}
  for _, c in ipairs(core.coordinates(m.handle)) do
    if c.part == part then list[#list + 1] = c end
  end
  return list
end

-- The frame that an IN port of a part is connected to.
local function connected(m, part, name)
  local links = element.made(m, part).links
  for i, port in ipairs(m.declared[part].ports) do
    if port.name == name then return links[2 * i - 1], links[2 * i] end
  end
end

-- Parts from a frame's own to the world, the nearest first.
local function road(m, part)
  local list = {}
  while part and part > 0 do
    list[#list + 1] = part
    part = connected(m, part, "from")
  end
  return list
end

-- The joint that alone lets two frames move against each other; nil and why not.
local function joint_between(m, first, second)
  local seen, moving = {}, {}
  local a, b = road(m, first), road(m, second)
  for _, part in ipairs(a) do seen[part] = (seen[part] or 0) + 1 end
  for _, part in ipairs(b) do seen[part] = (seen[part] or 0) + 1 end
  table.move(b, 1, #b, #a + 1, a)
  for _, part in ipairs(a) do
    if seen[part] == 1 and #rest.coordinates(m, part) > 0 then moving[#moving + 1] = part end
  end
  if #moving == 1 then return moving[1] end
  return nil, #moving == 0 and "no joint moves between its two frames" or
    ("%d joints move between its two frames: expected one"):format(#moving)
end

-- Expressions at given values of the coordinate q; the other coordinates do not matter and are 0.
local function at_values(m, e, q, values)
  local leaves, others = {}, {}
  for _, c in ipairs(core.coordinates(m.handle)) do leaves[#leaves + 1] = c.q end
  local list = {}
  for k, value in ipairs(values) do
    for i, leaf in ipairs(leaves) do others[i] = leaf == q and value or core.expression(0) end
    list[k] = core.substitute({ e }, leaves, others)[1]
  end
  return list
end

-- Over all data; nil: it is not defined there, or not bounded.
local function enclose(e)
  local good, x = pcall(core.evaluate, { expressions = { e } })
  return good and x[1]:is_bounded() and not x[1]:is_empty() and x[1] or nil
end

-- Of a - s and a + s the one that is nearer to 0.
local function nearer(a, s)
  local less, more = enclose(a - s), enclose(a + s)
  if not less or not more then return nil end
  return math.abs(less:mid()) < math.abs(more:mid()) and a - s or a + s
end

local function on_slide(m, square, q, length)
  local l = at_values(m, square, q, { core.expression(0), core.expression(1), core.expression(-1) })
  local b = (l[2] - l[3]) / 4
  return -b, core.sqrt(b * b - l[1] + length * length)
end

local function on_hinge(m, square, q, length)
  local l = at_values(m, square, q, { core.expression(0), core.pi(), core.pi() / 2 })
  local a, b = (l[1] + l[2]) / 2, (l[1] - l[2]) / 2
  local c = l[3] - a
  return core.atan2(c, b), core.acos((length * length - a) / core.sqrt(b * b + c * c))
end

local kinds = {}

kinds[core.default.spring] = function(m, part)
  local joint = connected(m, part, "joint")
  if #rest.coordinates(m, joint) == 0 then return nil, "its joint does not move" end
  return joint, { copy.values(m, part).rest[1] }
end

local function frame_at(m, part, name)
  local at, port = connected(m, part, name)
  return frame.new(m, at, { index = port, kind = "frame" })
end

local function point_of(m, part, values, name)
  local o = values[name .. "_offset"]
  return (measure.point(m, frame_at(m, part, name), Vector.new(o[1], o[2], o[3]), "reduce"))
end

local slides, hinges = { [core.default.slide] = true }, { [core.default.hinge] = true }

kinds[core.default.strut] = function(m, part)
  local joint, problem = joint_between(m, (connected(m, part, "from")), (connected(m, part, "to")))
  if not joint then return nil, problem end
  local type, values = m.declared[joint].name, copy.values(m, part)
  if not slides[type] and not hinges[type] then
    return nil, ("the joint between its points is a %s: expected %s or %s"):format(type, core.default.hinge,
      core.default.slide)
  end
  local d = point_of(m, part, values, "to") - point_of(m, part, values, "from")
  local q = rest.coordinates(m, joint)[1].q
  local middle, half = (slides[type] and on_slide or on_hinge)(m, rotation.dot(d, d), q, values.length[1])
  local found = nearer(middle, half)
  if not found then return nil, "it is slack at no position of its joint" end
  return joint, { found }
end

kinds[core.default.bushing] = function(m, part)
  local joint, problem = joint_between(m, (connected(m, part, "from")), (connected(m, part, "to")))
  if not joint then return nil, problem end
  local zero, leaves = rest.zero(m, joint), {}
  local from, to = frame_at(m, part, "from"), frame_at(m, part, "to")
  local list, zeros = { m:distance(from, to), m:angle(from, to) }, {}
  for i, c in ipairs(core.coordinates(m.handle)) do leaves[i], zeros[i] = c.q, core.expression(0) end
  for i, c in ipairs(rest.coordinates(m, joint)) do
    for k, leaf in ipairs(leaves) do zeros[k] = leaf == c.q and zero[i] or zeros[k] end
  end
  for _, e in ipairs(core.substitute(list, leaves, zeros)) do
    local x = enclose(e)
    if not x or not (x:mid() <= NEAR) then return nil, "its frames do not coincide where its joint is at 0" end
  end
  return joint, zero
end

-- The coordinates of a joint at 0: of a quaternion the one that turns nothing.
function rest.zero(m, joint)
  local type, list = m.declared[joint].name, {}
  for i in ipairs(rest.coordinates(m, joint)) do
    list[i] = core.expression(type:find "quaternion" and i == 1 and 1 or 0)
  end
  return list
end

-- Can the part be made rigid at all?
function rest.is_spring(m, part) return kinds[m.declared[part].name] ~= nil end

-- Does an expression depend on anything but data and time?
function rest.moves(e)
  for _, leaf in ipairs(core.leaves { e }) do
    if leaf.kind == "symbol" then return leaf.name end
  end
end

-- of(m, part) -> the joint, its motions (one expression for each coordinate); nil and why there are none.
function rest.of(m, part)
  local joint, motions = kinds[m.declared[part].name](m, part)
  if not joint then return nil, motions end
  local name = rest.moves(motions[1])
  if name then return nil, ("its rest position moves with `%s`"):format(name) end
  if #motions == 1 and not copy.can_follow(m, joint) then
    return nil, ("a %s cannot be given a motion"):format(m.declared[joint].name)
  end
  return joint, motions
end

return rest
