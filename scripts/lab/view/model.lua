-- view/model.lua -- what there is to draw of a mechanism: frames, the lines between them, axes of joints, bodies; and
-- the expressions of where they are. Read off the ports of the parts, so that every element plugin is drawn.
--
--   frames in, frames out    a line from the frame it starts at to each that it makes
--   two frames in, none out  a closure (with a constraint port, dashed) or a force element
--   one frame in, and a mass a body, at its centre
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"

local model = {}

local function pose_of(m, part, port) return core.pull(m.handle, part, port, core.POSE, 12) end

-- Connected IN frames as { part, port }, OUT frames as port numbers.
local function ends(d, links)
  local ins, outs, constraint = {}, {}, false
  for i, port in ipairs(d.ports) do
    if port.kind == "constraint" then constraint = true end
    if port.kind == "frame" and port.role == "in" then
      if links[2 * i - 1] >= 0 then ins[#ins + 1] = { part = links[2 * i - 1], port = links[2 * i] } end
    elseif port.kind == "frame" then
      outs[#outs + 1] = { number = i - 1, name = port.name }
    end
  end
  return ins, outs, constraint
end

local function parameter(d, made, wanted)
  for i, param in ipairs(d.parameters) do
    if param.name == wanted then return made.values[i] or nil end
  end
end

-- The one axis of a joint, in the axes of the frame it starts at; nil: no joint, or one with several axes.
local function only_axis(d, made)
  local found, is_joint = nil, parameter(d, made, "play") ~= nil
  for _, port in ipairs(d.ports) do is_joint = is_joint or port.kind == "joint" and port.role == "out" end
  if not is_joint then return nil end
  for i, param in ipairs(d.parameters) do
    if param.shape == "axis" then
      if found then return nil end
      found = made.values[i] or nil
    end
  end
  return found
end

local function turned(pose, v)
  local function row(i) return pose[i] * v[1] + pose[i + 1] * v[2] + pose[i + 2] * v[3] end
  return { row(1), row(4), row(7) }
end

local Model = {}
Model.__index = Model

function Model:frame(part, port, name, kind)
  local place = #self.frames + 1
  self.index[part .. "/" .. port] = place
  self.frames[place] = { name = name, kind = kind, part = part, port = port,
    pose = pose_of(self.mechanism, part, port) }
  return place
end

function Model:place(at) return self.index[at.part .. "/" .. at.port] end

function Model:line(a, b, kind, name) self.lines[#self.lines + 1] = { a = a, b = b, kind = kind, name = name } end

function Model:add_joining(d, made, part, name, ins, outs)
  local start = ins[1] and self:place(ins[1])
  for _, out in ipairs(outs) do
    local place = self:frame(part, out.number, #outs > 1 and name .. "." .. out.name or name, d.name)
    if start then
      self:line(start, place, "link", name)
      self.frames[start].leads_on = true
    end
  end
  local axis = start and only_axis(d, made)
  if axis then
    self.axes[#self.axes + 1] = { frame = start, name = name, kind = d.name,
      direction = turned(self.frames[start].pose, axis) }
  end
end

function Model:add_body(d, made, name, at)
  local mass = parameter(d, made, "mass")
  if not mass then return end
  local place = self:place(at)
  local pose, centre = self.frames[place].pose, parameter(d, made, "centre")
  local position = { pose[10], pose[11], pose[12] }
  if centre then
    local offset = turned(pose, centre)
    for i = 1, 3 do position[i] = position[i] + offset[i] end
  end
  self.bodies[#self.bodies + 1] = { frame = place, name = name, kind = d.name, mass = mass[1], position = position }
end

function Model:add(d, made, part, name)
  local ins, outs, constraint = ends(d, made.links)
  if #outs > 0 then
    self:add_joining(d, made, part, name, ins, outs)
    for i = 2, #ins do self:line(self:place(ins[i]), #self.frames, "closure", name) end
  elseif #ins == 1 then
    self:add_body(d, made, name, ins[1])
  else
    for i = 2, #ins do
      self:line(self:place(ins[1]), self:place(ins[i]), constraint and "closure" or "force", name)
    end
  end
end

-- Where a point moves most: frames that no other frame starts from.
local function tips(self)
  local list = {}
  for i, frame in ipairs(self.frames) do
    if i > 1 and not frame.leads_on then list[#list + 1] = i end
  end
  return list
end

-- Frames of a robot that was loaded are called after their links, not after the joints that move them.
local function name_links(self, links)
  for _, name in ipairs(check.sorted(links)) do
    local place = self:place(links[name])
    if place > 1 then self.frames[place].name = name end
  end
end

function model.of(m)
  local self = setmetatable({ mechanism = m, frames = {}, lines = {}, axes = {}, bodies = {}, index = {} }, Model)
  self:frame(0, 0, "world", "world")
  for part = 1, core.part_count(m.handle) - 1 do
    self:add(m.declared[part], element.made(m, part), part, core.part_name(m.handle, part))
  end
  name_links(self, rawget(m, "links") or {})
  self.tips = tips(self)
  return self
end

-- The acceleration of gravity, world axes.
function model.field(m) return core.pull(m.handle, -1, 0, core.FIELD, 3) end

return model
