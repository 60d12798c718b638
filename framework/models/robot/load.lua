-- robot/load.lua -- ambit.load "robot.urdf": a mechanism from a file; m:load { "arm.urdf", from = flange, name = "left"
-- }: the same into a mechanism that there is already.
--
-- .urdf and .xml are URDF (urdf.lua), .lua is a table of RBDL (rbdl.lua); any other file is URDF if it starts as XML.
-- Every link becomes a frame in m.links, every joint with one motion a joint in m.joints.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local parts = require "ambit.robot.parts"
local rbdl = require "ambit.robot.rbdl"
local robot = require "ambit.robot"
local tolerance = require "ambit.robot.tolerance"
local tree = require "ambit.tree"
local urdf = require "ambit.robot.urdf"

local load = {}

-- -- the file

local function open(path)
  local file, problem = io.open(path, "rb")
  if not file then return nil, problem end
  local text, failure = file:read "a"
  file:close()
  return text, text == nil and ("%s: %s"):format(path, failure) or nil
end

-- A path is taken from where the command runs, else from where the scene is.
local function read_file(path)
  local text, problem = open(path)
  local words = _G.arg -- the scene's own
  local beside = type(words) == "table" and type(words[0]) == "string" and words[0]:match "^(.*/)[^/]*$"
  if not text and beside and path:sub(1, 1) ~= "/" then text = open(beside .. path) end
  if not text then check.fail("load: cannot read the file: %s", problem) end
  return text
end

local readers = { urdf = urdf.read, xml = urdf.read, lua = rbdl.read }

-- A robot, checked.
local function read(path, physical)
  local text = read_file(path)
  local suffix = (path:match "%.(%w+)$" or ""):lower()
  local reader = readers[suffix] or text:find "^[%s\xEF\xBB\xBF]*<" and urdf.read
  if not reader then
    check.fail("load: %s: expected a URDF file (.urdf, .xml) or a Lua table of RBDL (.lua)", path)
  end
  return robot.check(reader(text, path), physical ~= false)
end

-- -- the mechanism

local function named_table(kind)
  local t = {}
  return setmetatable(t, { __index = function(_, key)
    check.fail("there is no %s `%s`%s", kind, tostring(key), check.suggest(key, check.sorted(t)))
  end })
end

local function collections(m)
  if rawget(m, "links") then return end
  m.links, m.joints, m.limits_of, m.laid = named_table "link", named_table "joint", {}, {}
end

local function value_of_limit(text) return text and core.expression(text) or nil end

-- Limits and what else the file says about a joint, as exact numbers in SI units.
local function remember_limits(m, self, prefix)
  for _, joint in ipairs(self.joints) do
    local limits = { damping = value_of_limit(joint.damping), friction = value_of_limit(joint.friction) }
    for key, text in pairs(joint.limits) do limits[key] = value_of_limit(text) end
    if joint.kind ~= "fixed" then m.limits_of[prefix .. joint.name] = limits end
  end
end

-- Two robots in one mechanism need names of their own.
local function check_names(m, self, prefix)
  for _, link in ipairs(self.links) do
    local name = prefix .. link.name
    if rawget(m.links, name) then
      check.fail("load: %s: the mechanism has a link `%s` already: say with `name` which robot is which", self.file,
        name)
    end
  end
end

local function place(m, self, base, t)
  collections(m)
  local prefix = tree.scope(m).path
  check_names(m, self, prefix)
  local set = tolerance.new(rawget(m, "patterns") or {}, t.tolerances or {})
  local frames, joints = parts.add(self, m, base, set, prefix, t)
  local links = named_table "link"
  for name, at in pairs(frames) do links[name], m.links[prefix .. name] = at, at end
  for name, joint in pairs(joints) do m.joints[prefix .. name] = joint end
  for _, datum in ipairs(set.data) do m.laid[#m.laid + 1] = datum end
  remember_limits(m, self, prefix)
  return links
end

local flags = { "damping", "friction", "physical" }
local keys = { "tolerances", "gravity", "base", "name", table.unpack(flags) }

local function request(t, known)
  if type(t) == "string" then t = { t } end
  check.table(t, "load")
  check.keys(t, known, "load", 1)
  check.text(t[1], "load: the file")
  for _, key in ipairs(flags) do
    if t[key] ~= nil and type(t[key]) ~= "boolean" then
      check.fail("load: %s: expected true or false, got %s", key, check.kind(t[key]))
    end
  end
  return t
end

local function base_name(path) return (path:match "([^/]+)$" or path):gsub("%.%w+$", "") end

-- load "file" or load { "file", tolerances = { ... }, gravity = { ... }, base = frame, name = } -> mechanism
function load.load(t)
  t = request(t, keys)
  local mechanism = require "ambit.mechanism"
  local self = read(t[1], t.physical)
  local m, base
  if mechanism.is(t.base) then
    m, base = t.base, t.base.world
  elseif frame.is(t.base) then
    m, base = t.base.mechanism, t.base
  elseif t.base ~= nil then
    check.fail("load: base: expected a frame or a mechanism, got %s", check.kind(t.base))
  end
  if m then
    if t.gravity ~= nil then check.fail("load: gravity: say it with m:gravity: the mechanism is there already") end
    m:load { t[1], from = base, tolerances = t.tolerances, name = t.name, damping = t.damping, friction = t.friction,
      physical = t.physical }
    return m
  end
  m = mechanism.new { t.name or self.name or base_name(t[1]), gravity = t.gravity or self.gravity }
  place(m, self, m.world, t)
  return m
end

local methods = {}

-- m:load { "arm.urdf", from = frame, name = "left" } -> its frames by name of link
function methods:load(t)
  t = request(t, { "from", "tolerances", "name", table.unpack(flags) })
  local base = t.from == nil and self.world or t.from
  frame.place(self, base, "frame", "load: from")
  local model = read(t[1], t.physical)
  if t.name == nil then return place(self, model, base, t) end
  local scope <close> = tree.enter(self, "robot", t.name, t[1])
  return place(self, model, base, t)
end

local function loaded(self, what)
  if not rawget(self, "links") then check.fail("%s: nothing has been loaded into this mechanism", what) end
end

-- The frame of a link that was loaded.
function methods:link(name)
  loaded(self, "link")
  return self.links[check.text(name, "link: name")]
end

-- { name of joint = { lower, upper, velocity, effort, damping, friction } }, as far as the file says
function methods:limits()
  loaded(self, "limits")
  return self.limits_of
end

-- m:tolerances { pattern = tolerance }: for everything that is loaded from now on. m:tolerances(): what was laid so
-- far, { { name = "elbow_joint.offset.x", tolerance = "1 mm", value = expression }, ... }
function methods:tolerances(t)
  if t == nil then return rawget(self, "laid") or {} end
  tolerance.new(t)
  local patterns = rawget(self, "patterns") or {}
  for key, value in pairs(t) do patterns[key] = value end
  self.patterns = patterns
end

load.methods = methods

return load
