-- robot.lua -- a robot as its file says it, whatever the format; checked as a whole, put in order from the root.
--
-- robot: { file, line, name, gravity = nil or { x, y, z }, links = { link ... }, joints = { joint ... } }
-- link:  { name, line, body = nil or { line, mass, centre = { 3 }, rpy = { 3 },
--          inertia = { xx, xy, xz, yy, yz, zz } } }
-- joint: { name, line, kind, parent, child (names of links), offset = { 3 }, rpy = { 3 }, axis = { 3 }, limits = { },
--          mimic = nil or { joint, line, multiplier, offset }, damping, friction; motions: see rbdl.lua }
-- Numbers are decimals (text) or doubles.
local check = require "ambit.check"
local core = require "ambit.core"

local robot = {}

function robot.fail(self, line, who, format, ...)
  local text = select("#", ...) > 0 and format:format(...) or format
  check.fail("%s", ("%s:%d: %s: %s"):format(self.file, line, who, text))
end

local function of_link(link) return ("link `%s`"):format(link.name) end
local function of_joint(joint) return ("joint `%s`"):format(joint.name) end

-- By what the texts say: "1e-400" is not zero, although the double next to it is.
local function is_zero(list)
  for _, value in ipairs(list) do
    if tonumber(value) ~= 0 or core.interval(value):mag() ~= 0 then return false end
  end
  return true
end

-- { name = entry }; names are given once
local function by_name(self, list, describe)
  local found = {}
  for _, entry in ipairs(list) do
    local first = found[entry.name]
    if first then
      robot.fail(self, entry.line, describe(entry), "the name is taken already, in line %d", first.line)
    end
    found[entry.name] = entry
  end
  return found
end

-- Every link has at most one joint above it: joint_above[name of link]
local function joints_above(self, links)
  local above = {}
  for _, joint in ipairs(self.joints) do
    local who = of_joint(joint)
    for _, end_ in ipairs { "parent", "child" } do
      if not links[joint[end_]] then
        robot.fail(self, joint.line, who, "its %s link `%s` is not in the file%s", end_, joint[end_],
          check.suggest(joint[end_], check.sorted(links)))
      end
    end
    local other = above[joint.child]
    if other then
      robot.fail(self, joint.line, who, "link `%s` hangs on a joint already: `%s`, line %d", joint.child, other.name,
        other.line)
    end
    above[joint.child] = joint
  end
  return above
end

-- Going up from the link: "a, b, a", or nil if that ends at a root.
local function cycle_from(name, above, safe)
  local path, seen = {}, {}
  while above[name] and not safe[name] do
    path[#path + 1] = "`" .. name .. "`"
    if seen[name] then return table.concat(path, ", ", seen[name]) end
    seen[name] = #path
    name = above[name].parent
  end
  for visited in pairs(seen) do safe[visited] = true end
  return nil
end

local function find_root(self, above)
  local root, safe = nil, {}
  for _, link in ipairs(self.links) do
    local cycle = cycle_from(link.name, above, safe)
    if cycle then
      robot.fail(self, above[link.name].line, of_joint(above[link.name]), "the links hang on each other in a cycle: %s",
        cycle)
    end
  end
  for _, link in ipairs(self.links) do
    if not above[link.name] then
      if root then
        robot.fail(self, link.line, of_link(link),
          "hangs on no joint, like link `%s` in line %d: a robot has one root", root.name, root.line)
      end
      root = link
    end
  end
  return root
end

-- The second moments of mass tr(I)/2 1 - I of a body are positive semidefinite [Traversaro et al. 2016]; that
-- contains the triangle inequality of the principal moments. Slack for numbers rounded to nine digits.
local function is_physical(inertia)
  local v = {}
  for i = 1, 6 do v[i] = tonumber(inertia[i]) end
  local half = (v[1] + v[4] + v[6]) / 2
  local slack = 2e-9 * math.abs(half)
  local a, b, c, d, e, f = half - v[1], -v[2], -v[3], half - v[4], -v[5], half - v[6]
  local minors = math.min(a * d - b * b, d * f - e * e, a * f - c * c)
  local determinant = a * (d * f - e * e) - b * (b * f - e * c) + c * (b * e - d * c)
  return half >= 0 and math.min(a, d, f) >= -slack and minors >= -slack * half
    and determinant >= -slack * half * half
end

local function check_body(self, link, physical)
  local body, who = link.body, of_link(link)
  if not body then return end
  local mass = tonumber(body.mass)
  if mass < 0 then robot.fail(self, body.line, who, "the mass is negative: %s kg", body.mass) end
  local massless = is_zero { body.mass }
  if massless and not is_zero(body.inertia) then
    robot.fail(self, body.line, who, "has moments of inertia but no mass: its mass is zero")
  end
  if physical and not is_physical(body.inertia) then
    robot.fail(self, body.line, who, "no body has this inertia: of its principal moments one is negative, or larger "
      .. "than the sum of the other two; `physical = false` takes it as it is")
  end
  if massless then body.massless = true end
end

local moving = { revolute = true, continuous = true, prismatic = true, floating = true, planar = true, motions = true }
local single = { revolute = true, continuous = true, prismatic = true }

-- A link that is said to weigh nothing must not be moved by a joint with nothing behind it that weighs something.
local function check_masses(self, links, order)
  local heavy, empty = {}, {} -- by link: it or what hangs on it has mass; a massless body rigidly part of it
  for _, link in ipairs(self.links) do
    heavy[link.name] = link.body and not link.body.massless or false
    empty[link.name] = link.body and link.body.massless and link or nil
  end
  for i = #order, 1, -1 do
    local joint = order[i]
    local child = joint.child
    if moving[joint.kind] and empty[child] and not heavy[child] then
      robot.fail(self, empty[child].body.line, of_link(links[empty[child].name]),
        "the mass is zero, and joint `%s` (line %d) moves nothing else: give a mass, or leave the body out", joint.name,
        joint.line)
    end
    heavy[joint.parent] = heavy[joint.parent] or heavy[child]
    if not moving[joint.kind] then empty[joint.parent] = empty[joint.parent] or empty[child] end
  end
end

local function check_mimic(self, joint, joints)
  local mimic, who = joint.mimic, of_joint(joint)
  if not mimic then return end
  local leader = joints[mimic.joint]
  if not leader then
    robot.fail(self, mimic.line, who, "mimics joint `%s`, which is not in the file%s", mimic.joint,
      check.suggest(mimic.joint, check.sorted(joints)))
  end
  for _, one in ipairs { joint, leader } do
    if not single[one.kind] then
      robot.fail(self, mimic.line, who, "cannot mimic `%s`: %s is %s, which has not one coordinate", leader.name,
        one == joint and "it" or "that", one.kind)
    end
  end
  local seen, path = { [joint.name] = true }, { "`" .. joint.name .. "`" }
  while leader do
    path[#path + 1] = "`" .. leader.name .. "`"
    if seen[leader.name] then
      robot.fail(self, mimic.line, who, "joints mimic each other in a cycle: %s", table.concat(path, ", "))
    end
    seen[leader.name] = true
    leader = leader.mimic and joints[leader.mimic.joint]
  end
end

-- The joints in the order of the file, but each behind the joint that it hangs on and the one that it mimics.
local function in_order(self, root)
  local order, has_link, has_joint, waiting = {}, { [root.name] = true }, {}, {}
  local function wait(key, joint)
    waiting[key] = waiting[key] or {}
    table.insert(waiting[key], joint)
  end
  for _, first in ipairs(self.joints) do
    local stack = { first }
    while #stack > 0 do
      local joint = table.remove(stack)
      if not has_link[joint.parent] then
        wait("link " .. joint.parent, joint)
      elseif joint.mimic and not has_joint[joint.mimic.joint] then
        wait("joint " .. joint.mimic.joint, joint)
      else
        order[#order + 1] = joint
        has_link[joint.child], has_joint[joint.name] = true, true
        for _, key in ipairs { "joint " .. joint.name, "link " .. joint.child } do
          for i = #(waiting[key] or {}), 1, -1 do stack[#stack + 1] = waiting[key][i] end
          waiting[key] = nil
        end
      end
    end
  end
  for _, joint in ipairs(self.joints) do
    if joint.mimic and not has_joint[joint.name] and has_link[joint.parent] then
      robot.fail(self, joint.mimic.line, of_joint(joint), "mimics joint `%s`, which hangs on it", joint.mimic.joint)
    end
  end
  return order
end

-- Raises what is wrong with it; sets .root (a link) and .order (its joints), .link and .joint (by name). physical: must
-- there be bodies that have these inertias?
function robot.check(self, physical)
  if #self.links == 0 then check.fail("%s:%d: there is no link in the file", self.file, self.line) end
  self.link = by_name(self, self.links, of_link)
  self.joint = by_name(self, self.joints, of_joint)
  for _, link in ipairs(self.links) do check_body(self, link, physical) end
  local above = joints_above(self, self.link)
  self.root = find_root(self, above)
  for _, joint in ipairs(self.joints) do
    if single[joint.kind] or joint.kind == "planar" then
      if is_zero(joint.axis) then
        robot.fail(self, joint.line, of_joint(joint), "the axis is zero: expected a direction")
      end
    end
    check_mimic(self, joint, self.joint)
  end
  self.order = in_order(self, self.root)
  check_masses(self, self.link, self.order)
  return self
end

robot.of_link, robot.of_joint = of_link, of_joint

return robot
