-- robot/parts.lua -- a checked robot (robot.lua) as the parts of a mechanism: a joint is called after itself, its
-- origin "NAME.origin" ("NAME.pitch", "NAME.roll" where it turns about several axes), a body after its link.
--
-- The rotation of an origin is Rz(yaw) Ry(pitch) Rx(roll), one rigid link for each angle that is not 0: turning a
-- vector about an axis of coordinates costs four products, so that two of them cost less than one general rotation.
local core = require "ambit.core"
local robot = require "ambit.robot"
local tolerance = require "ambit.robot.tolerance"

local parts = {}

local names = core.default

local zero = core.expression(0)

-- One build: the robot, the mechanism, its tolerances, frames by link and joint objects by joint.
local Build = {}
Build.__index = Build

-- Runs f(...); an error says where in the file it comes from.
function Build:at(line, who, f, ...)
  local results = table.pack(pcall(f, ...))
  if results[1] then return table.unpack(results, 2, results.n) end
  local message = tostring(results[2])
  local place = core.where()
  if message:sub(1, #place) == place then message = message:sub(#place + 1) end
  robot.fail(self.robot, line, who, "%s", message)
end

function Build:add(line, who, kind, t)
  return self:at(line, who, self.mechanism[kind], self.mechanism, t)
end

function Build:names(name) return { name, self.prefix .. name } end

-- The numbers of a datum as expressions with their tolerances.
function Build:laid(line, who, name, datum, numbers)
  local list, unit = {}, tolerance.data[datum].unit
  for i, number in ipairs(numbers) do
    local e = self:at(line, who, core.expression, number, unit, datum)
    list[i] = self.tolerances:lay(self:names(name), datum, i, e)
  end
  return list
end

local turns = { { "yaw", "z", 3 }, { "pitch", "y", 2 }, { "roll", "x", 1 } }

local function is_zero(list) return list[1] == zero and list[2] == zero and list[3] == zero end

-- The frame in which the joint stands; a fixed joint is the last link of its origin itself.
function Build:origin(joint)
  local who = robot.of_joint(joint)
  local offset = self:laid(joint.line, who, joint.name, "offset", joint.offset)
  local rpy = self:laid(joint.line, who, joint.name, "angle", joint.rpy)
  local links = {}
  if not is_zero(offset) then links[1] = { "origin", offset = offset } end
  for _, turn in ipairs(turns) do
    local angle = rpy[turn[3]]
    if angle ~= zero then
      local last = links[#links]
      if not last or last.angle then
        last = { #links == 0 and "origin" or turn[1] }
        links[#links + 1] = last
      end
      last.axis, last.angle = turn[2], angle
    end
  end
  if joint.kind == "fixed" and #links == 0 then links[1] = {} end
  local at = self.frame[joint.parent]
  for i, link in ipairs(links) do
    local is_joint = joint.kind == "fixed" and i == #links
    at = self:add(joint.line, who, is_joint and names.fixed or names.link, { from = at,
      name = is_joint and joint.name or joint.name .. "." .. link[1],
      offset = link.offset, axis = link.axis, angle = link.angle })
  end
  return at
end

-- Two directions across the axis n that make a right-handed frame with it: e_(k+2) x n and n x (e_(k+2) x n), where
-- n_k is the largest component; x and y for z.
local function across(axis)
  local n, k = {}, 1
  for i = 1, 3 do
    n[i] = core.expression(axis[i])
    if math.abs(tonumber(axis[i])) > math.abs(tonumber(axis[k])) then k = i end
  end
  local first, next_ = { 0, 0, 0 }, k % 3 + 1
  first[k], first[next_] = -n[next_], n[k]
  local second = {}
  for i = 1, 3 do
    local a, b = i % 3 + 1, (i + 1) % 3 + 1
    second[i] = n[a] * first[b] - n[b] * first[a]
  end
  return first, second
end

local function add_motion(self, joint, at, motion, name, rest)
  local t = { from = at, name = name, axis = motion.axis, pitch = motion.pitch }
  for key, value in pairs(rest or {}) do t[key] = value end
  return self:add(joint.line, robot.of_joint(joint), motion.kind, t)
end

-- Each adds the moving part of a joint; returns the frame that moves, and the joint.
local kinds = {}

function kinds.revolute(self, joint, at, rest)
  return add_motion(self, joint, at, { kind = names.hinge, axis = joint.axis }, joint.name, rest)
end

kinds.continuous = kinds.revolute

function kinds.prismatic(self, joint, at, rest)
  return add_motion(self, joint, at, { kind = names.slide, axis = joint.axis }, joint.name, rest)
end

function kinds.planar(self, joint, at)
  local first, second = across(joint.axis)
  return self:add(joint.line, robot.of_joint(joint), names.plane, { from = at, name = joint.name, first = first,
    second = second })
end

function kinds.floating(self, joint, at)
  return self:add(joint.line, robot.of_joint(joint), names.floating, { from = at, name = joint.name })
end

-- One motion behind the other: NAME, or NAME.1, NAME.2, ...
function kinds.motions(self, joint, at)
  local moved
  for i, motion in ipairs(joint.motions) do
    at, moved = add_motion(self, joint, at, motion, #joint.motions == 1 and joint.name or joint.name .. "." .. i)
  end
  return at, #joint.motions == 1 and moved or nil
end

local function mimic_of(self, joint)
  local mimic = joint.mimic
  if not mimic then return nil end
  return { mimic = { joint = self.joint[mimic.joint], multiplier = mimic.multiplier, offset = mimic.offset } }
end

-- What a file says about friction is added on request only: few other programs do.
local function add_friction(self, joint, moved)
  local who = robot.of_joint(joint)
  if moved and self.options.damping and joint.damping then
    self:add(joint.line, who, names.damper, { joint = moved, name = joint.name .. ".damping",
      damping = joint.damping })
  end
  if moved and self.options.friction and joint.friction then
    self:add(joint.line, who, names.friction, { joint = moved, name = joint.name .. ".friction",
      coulomb = joint.friction })
  end
end

function Build:add_joint(joint)
  local at = self:origin(joint)
  local moved
  if joint.kind ~= "fixed" then at, moved = kinds[joint.kind](self, joint, at, mimic_of(self, joint)) end
  self.joint[joint.name], self.frame[joint.child] = moved, at
  add_friction(self, joint, moved)
end

-- R I R^T in the axes of the link, with R = Rz(yaw) Ry(pitch) Rx(roll); the upper triangle decides.
local function turned(inertia, rpy)
  local xx, xy, xz, yy, yz, zz = table.unpack(inertia)
  local m = { { xx, xy, xz }, { xy, yy, yz }, { xz, yz, zz } }
  for axis, angle in ipairs(rpy) do -- x first: the inner rotation
    if angle ~= zero then
      local j, k = axis % 3 + 1, (axis + 1) % 3 + 1
      local c, s = core.cos(angle), core.sin(angle)
      local i, jj, kk, jk, ij, ik = axis, m[j][j], m[k][k], m[j][k], m[axis][j], m[axis][k]
      local cc, ss, cs = core.sqr(c), core.sqr(s), c * s
      m[j][j] = cc * jj - 2 * cs * jk + ss * kk
      m[k][k] = ss * jj + 2 * cs * jk + cc * kk
      m[j][k] = cs * (jj - kk) + (cc - ss) * jk
      m[i][j], m[i][k] = c * ij - s * ik, s * ij + c * ik
      m[k][j], m[j][i], m[k][i] = m[j][k], m[i][j], m[i][k]
    end
  end
  return m
end

function Build:add_body(link)
  local body = link.body
  if not body or body.massless then return end
  local who = robot.of_link(link)
  local mass = self:laid(body.line, who, link.name, "mass", { body.mass })[1]
  local centre = self:laid(body.line, who, link.name, "centre", body.centre)
  local entries, rpy = {}, {}
  for i, number in ipairs(body.inertia) do
    entries[i] = self:at(body.line, who, core.expression, number, "kg m^2", "inertia")
  end
  for i, number in ipairs(body.rpy) do rpy[i] = self:at(body.line, who, core.expression, number, "rad", "rpy") end
  entries = self.tolerances:lay_inertia(self:names(link.name), entries)
  local is_point = true
  for _, entry in ipairs(entries) do is_point = is_point and entry == zero end
  self:add(body.line, who, names.body, { at = self.frame[link.name], mass = mass, centre = centre,
    name = (self.robot.joint[link.name] or link.name == "world") and link.name .. ".body" or link.name,
    inertia = not is_point and turned(entries, rpy) or nil, physical = self.options.physical })
end

-- Tolerances can be laid on what there is: all joints, and the links that have a body.
local function check_tolerances(self)
  local names = { link = {}, joint = {} }
  for _, link in ipairs(self.robot.links) do
    if link.body and not link.body.massless then table.insert(names.link, link.name) end
  end
  for _, joint in ipairs(self.robot.joints) do table.insert(names.joint, joint.name) end
  self.tolerances:finish(names)
end

-- add(robot, mechanism, base, tolerances, prefix, options) -> frames by name of link, joints by name of joint
function parts.add(self, mechanism, base, tolerances, prefix, options)
  local build = setmetatable({ robot = self, mechanism = mechanism, tolerances = tolerances, prefix = prefix,
    options = options, frame = { [self.root.name] = base }, joint = {} }, Build)
  build:add_body(self.root)
  for _, joint in ipairs(self.order) do
    build:add_joint(joint)
    build:add_body(self.link[joint.child])
  end
  check_tolerances(build)
  return build.frame, build.joint
end

return parts
