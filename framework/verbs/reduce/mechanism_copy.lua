-- reduce/mechanism_copy.lua -- a mechanism built anew with some of its parts left out or changed.
--
-- Parts are copied one by one, in order, from what they were made of: their plugin, checked parameters (expressions)
-- and connections. Expressions are shared: an uncertain datum of a part that stays is the same unknown in both
-- mechanisms, and coordinates are symbols found by their names, so that the coordinates and speeds of joints that stay
-- are the same symbols too. Both mechanisms can therefore be compared state by state on the same data.
--
-- change = {
--   left = { [part] = true },                          parts that nothing hangs on: not copied
--   locked = { [part] = { motion, ... } },             joints with a given motion of time for each coordinate
--   point = { [part] = true },                         rigid bodies without their moments of inertia
--   weightless = { [part] = true },                    bodies that gravity does not pull
-- }
-- A law that was recorded with the coordinate of a locked joint gets the given motion and its derivatives in its place.
-- A weightless body is carried by a force at its centre that is the opposite of its weight.
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"
local mechanism = require "ambit.mechanism"

local copy = {}

-- Entries of expressions by the name of the parameter.
function copy.values(m, part)
  local named, made = {}, element.made(m, part)
  for i, param in ipairs(m.declared[part].parameters) do named[param.name] = made.values[i] end
  return named
end

-- The parameter that gives a joint of that declaration its motion, as a place in the list; nil: it has none.
local function motion_place(d)
  for i, param in ipairs(d.parameters) do
    if param.name == "angle" or param.name == "displacement" then return i end
  end
end

-- Can a joint with one coordinate be given a motion?
function copy.can_follow(m, joint) return motion_place(m.declared[joint]) ~= nil end

-- Coordinates and speeds of locked joints, and what they are instead: leaves and values of core.substitute.
local function locked_variables(m, locked)
  local leaves, values = {}, {}
  local function enter(leaf, value)
    leaves[#leaves + 1], values[#values + 1] = leaf, value
  end
  local count = {}
  for _, c in ipairs(core.coordinates(m.handle)) do
    count[c.part] = (count[c.part] or 0) + 1
    if locked[c.part] then enter(c.q, locked[c.part][count[c.part]]) end
  end
  count = {}
  for _, s in ipairs(core.speeds(m.handle)) do
    local motions = locked[s.part]
    if motions then
      count[s.part] = (count[s.part] or 0) + 1
      local u = #motions == 1 and core.derivative(motions[1], core.time()) or core.expression(0)
      enter(s.u, u)
      enter(s.du, core.derivative(u, core.time()))
    end
  end
  return leaves, values
end

local Copy = {}
Copy.__index = Copy

function Copy:still(list)
  if not list or #self.leaves == 0 then return list end
  return core.substitute(list, self.leaves, self.motions)
end

-- The number of an OUT port of a part of the copy that is called like that port of the original; nil: there is none.
local function port_like(d, own, port)
  for _, other in ipairs(own.outs) do
    if other.index == port then
      for _, twin in ipairs(d.outs) do
        if twin.name == other.name then return twin.index end
      end
    end
  end
end

function Copy:place(part, port)
  if part <= 0 then return part, port end
  local to = self.part[part]
  return to, to and port_like(self.to.declared[to], self.from.declared[part], port)
end

-- Part and port of the copy; what was left out or lost its port has none, and nothing that stays asks for it.
function Copy:links(list)
  local links = {}
  for i = 1, #list, 2 do links[i], links[i + 1] = self:place(list[i], list[i + 1]) end
  return links
end

function Copy:enter(part, d, values, links)
  local new = element.enter(self.to, d, core.part_name(self.from.handle, part), self.from.places[part] or "", values,
    links, element.made(self.from, part).unit)
  self.part[part], self.to.places[new] = new, self.from.places[part]
end

-- A joint of several coordinates, each of them locked at 0: its frames coincide.
function Copy:weld(part, links)
  local d = element.declaration(core.default.fixed)
  local values = {}
  for i, param in ipairs(d.parameters) do
    values[i] = param.name == "offset" and { core.expression(0), core.expression(0), core.expression(0) }
      or param.name == "axis" and { core.expression(0), core.expression(0), core.expression(1) } or false
  end
  self:enter(part, d, values, { links[1], links[2], -1, 0 })
end

function Copy:add(part)
  local d, made = self.from.declared[part], element.made(self.from, part)
  local values, links = {}, self:links(made.links)
  for i, list in ipairs(made.values) do values[i] = self:still(list) end
  local motions = self.change.locked[part]
  if motions then
    local place = motion_place(d)
    if not place then return self:weld(part, links) end
    values[place] = { motions[1] }
  end
  if self.change.point[part] then
    for i, param in ipairs(d.parameters) do
      if param.name == "inertia" then values[i] = false end
    end
  end
  self:enter(part, d, values, links)
end

-- The force that carries a body, at its centre of mass.
function Copy:carry(part, field)
  local values = copy.values(self.from, part)
  local mass, weight = values.mass[1], {}
  for i = 1, 3 do weight[i] = -mass * field[i] end
  local made = element.made(self.from, part)
  local at, port = self:place(made.links[1], made.links[2])
  element.add(self.to, core.default.force, { at = frame.new(self.to, at, { index = port, kind = "frame" }),
    offset = values.centre, force = weight, name = core.part_name(self.from.handle, part) .. ": weight" })
end

-- The frame or joint of the copy that stands for one of the mechanism it was made from, or of one that this is a copy
-- of.
function Copy:counterpart(value)
  if value.mechanism ~= self.from and self.from.counterparts then value = self.from.counterparts(value) end
  if value.mechanism ~= self.from then return value end
  local part, port = self:place(value.part, value.port)
  if not part or not port then
    check.fail("%s is not there in the reduced mechanism", tostring(value))
  end
  return frame.new(self.to, part, { index = port, kind = value.kind })
end

-- What ambit.load leaves with a mechanism: names of frames, joints and limits; as frames of the original.
local loaded = { "links", "joints", "limits_of", "laid" }

-- The coordinates that stay have the reference that the user gave them.
function Copy:refer()
  local given, values = self.from:reference(), {}
  for _, c in ipairs(core.coordinates(self.to.handle)) do values[c.name] = given[c.name] end
  self.to:reference(values)
end

-- build(m, change) -> the copy, and what stands for the variables of the joints that were locked: leaves, values.
function copy.build(m, change)
  local self = setmetatable({ from = m, to = mechanism.blank(m.name), change = change, part = {} }, Copy)
  self.leaves, self.motions = locked_variables(m, change.locked)
  for part = 1, core.part_count(m.handle) - 1 do
    if not change.left[part] then self:add(part) end
  end
  local field = core.pull(self.to.handle, -1, 0, core.FIELD, 3)
  for part = 1, core.part_count(m.handle) - 1 do
    if change.weightless[part] and not change.left[part] then self:carry(part, field) end
  end
  for _, key in ipairs(loaded) do rawset(self.to, key, rawget(m, key)) end
  if rawget(m, "has_reference") then self:refer() end
  self.to.counterparts = function(value) return self:counterpart(value) end
  return self.to, self.leaves, self.motions
end

return copy
