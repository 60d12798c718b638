-- robot/urdf.lua -- a URDF file as a robot (robot.lua): links with their bodies, joints with their data.
-- The format: https://wiki.ros.org/urdf/XML. Numbers stay the decimals that they are written as.
--
-- Strict with what moves or weighs something; whatever else the file says (visual, collision, material, transmission,
-- gazebo, tags of other programs) is passed over.
local check = require "ambit.check"
local xml = require "ambit.robot.xml"

local urdf = {}

local kinds = { "revolute", "continuous", "prismatic", "fixed", "floating", "planar" }
local is_kind = {}
for _, kind in ipairs(kinds) do is_kind[kind] = true end
-- these would change the mechanics: they must not be passed over
local refused = { loop_joint = "a joint that closes a loop", ["drake:joint"] = "a joint",
  ["drake:linear_bushing_rpy"] = "a force", force_element = "a force" }

local function fail(file, node, who, format, ...)
  local prefix = ("%s:%d: %s: "):format(file, node.line, who)
  check.fail("%s", prefix .. (select("#", ...) > 0 and format:format(...) or format))
end

local function attribute(file, node, who, name)
  local text = node.attr[name]
  if text == nil then fail(file, node, who, "<%s> needs the attribute `%s`", node.tag, name) end
  return text
end

local function is_decimal(text)
  return text:match "^[+-]?%d+%.?%d*$" or text:match "^[+-]?%.%d+$"
    or text:match "^[+-]?%d+%.?%d*[eE][+-]?%d+$" or text:match "^[+-]?%.%d+[eE][+-]?%d+$"
end

-- One decimal that a double can come near to, without its `+`.
local function decimal(file, node, who, name, text)
  local what = ('%s of <%s>'):format(name, node.tag)
  if text:find("${", 1, true) then
    fail(file, node, who, "%s: `%s` is an expression of xacro: expand the file with xacro first", what, text)
  end
  if not is_decimal(text) then fail(file, node, who, "%s: expected a number, got `%s`", what, text) end
  if math.abs(tonumber(text)) == math.huge then fail(file, node, who, "%s: %s is too large", what, text) end
  return (text:gsub("^%+", ""))
end

local function words(text)
  local list = {}
  for word in text:gmatch "%S+" do list[#list + 1] = word end
  return list
end

local function number(file, node, who, name)
  local list = words(attribute(file, node, who, name))
  if #list ~= 1 then fail(file, node, who, "%s of <%s>: expected one number, got %d", name, node.tag, #list) end
  return decimal(file, node, who, name, list[1])
end

-- Three numbers; the fallback where there is no such attribute.
local function triple(file, node, who, name, fallback)
  local text = node and node.attr[name]
  if text == nil then return fallback end
  local list = words(text)
  if #list ~= 3 then fail(file, node, who, "%s of <%s>: expected three numbers, got %d", name, node.tag, #list) end
  for i, word in ipairs(list) do list[i] = decimal(file, node, who, name, word) end
  return list
end

-- The only child with that tag; nil if there is none.
local function only(file, node, who, tag)
  local list = xml.all(node, tag)
  if #list > 1 then
    fail(file, list[2], who, "a second <%s>; the first is in line %d", tag, list[1].line)
  end
  return list[1]
end

local function needed(file, node, who, tag)
  return only(file, node, who, tag) or fail(file, node, who, "<%s> has no <%s>", node.tag, tag)
end

local entries = { "ixx", "ixy", "ixz", "iyy", "iyz", "izz" }

local function read_body(file, link, who)
  local node = only(file, link, who, "inertial")
  if not node then return nil end
  local origin, inertia = only(file, node, who, "origin"), needed(file, node, who, "inertia")
  local body = { line = node.line, mass = number(file, needed(file, node, who, "mass"), who, "value"),
    centre = triple(file, origin, who, "xyz", { 0, 0, 0 }), rpy = triple(file, origin, who, "rpy", { 0, 0, 0 }),
    inertia = {} }
  for i, name in ipairs(entries) do body.inertia[i] = number(file, inertia, who, name) end
  return body
end

local function name_of(file, node)
  local name = node.attr.name
  if name == nil or name == "" then
    check.fail("%s:%d: a <%s> without a name: it needs the attribute `name`", file, node.line, node.tag)
  end
  return name
end

local function read_link(file, node)
  local name = name_of(file, node)
  return { name = name, line = node.line, body = read_body(file, node, ("link `%s`"):format(name)) }
end

-- Limits are data for whoever asks; infinite ones are none.
local function read_limits(file, joint, who, kind)
  local node, limits = only(file, joint, who, "limit"), {}
  for _, name in ipairs { "lower", "upper", "velocity", "effort" } do
    local text = node and node.attr[name]
    if text and not text:lower():match "^%s*[+-]?inf" then limits[name] = number(file, node, who, name) end
  end
  if kind == "continuous" then limits.lower, limits.upper = nil, nil end
  return limits
end

local function optional(file, node, who, name, fallback)
  if node and node.attr[name] then return number(file, node, who, name) end
  return fallback
end

local function read_mimic(file, joint, who)
  local node = only(file, joint, who, "mimic")
  if not node then return nil end
  return { joint = attribute(file, node, who, "joint"), line = node.line,
    multiplier = optional(file, node, who, "multiplier", 1), offset = optional(file, node, who, "offset", 0) }
end

local function read_joint(file, node)
  local name = name_of(file, node)
  local who = ("joint `%s`"):format(name)
  local kind = attribute(file, node, who, "type")
  if not is_kind[kind] then fail(file, node, who, "unknown type `%s`%s", kind, check.suggest(kind, kinds)) end
  local origin, dynamics = only(file, node, who, "origin"), only(file, node, who, "dynamics")
  local axis = only(file, node, who, "axis")
  if axis and kind ~= "fixed" and kind ~= "floating" then attribute(file, axis, who, "xyz") end
  return { name = name, line = node.line, kind = kind,
    parent = attribute(file, needed(file, node, who, "parent"), who, "link"),
    child = attribute(file, needed(file, node, who, "child"), who, "link"),
    offset = triple(file, origin, who, "xyz", { 0, 0, 0 }), rpy = triple(file, origin, who, "rpy", { 0, 0, 0 }),
    axis = triple(file, axis, who, "xyz", { 1, 0, 0 }),
    limits = read_limits(file, node, who, kind), mimic = read_mimic(file, node, who),
    damping = optional(file, dynamics, who, "damping"), friction = optional(file, dynamics, who, "friction") }
end

-- read(text, file) -> robot, not yet checked as a whole
function urdf.read(text, file)
  local root = xml.parse(text, file, "load")
  if root.tag ~= "robot" then
    check.fail("%s:%d: expected a URDF, whose outermost tag is <robot>, got <%s>", file, root.line, root.tag)
  end
  local robot = { file = file, line = root.line, name = root.attr.name, links = {}, joints = {} }
  for _, node in ipairs(root) do
    if node.tag == "link" then
      robot.links[#robot.links + 1] = read_link(file, node)
    elseif node.tag == "joint" then
      robot.joints[#robot.joints + 1] = read_joint(file, node)
    elseif node.tag:find "^xacro:" then
      check.fail("%s:%d: <%s> is a command of xacro: expand the file with xacro first", file, node.line, node.tag)
    elseif refused[node.tag] then
      check.fail("%s:%d: <%s> is %s that Ambit cannot read from files: take it out and add it in the scene", file,
        node.line, node.tag, refused[node.tag])
    end
  end
  return robot
end

return urdf
