-- robot/rbdl.lua -- a Lua table of RBDL's luamodel as a robot (robot.lua).
-- The format: https://rbdl.github.io/d8/d35/addon_luamodel_page.html. A frame is a body with the joint that it hangs
-- on; both are called after the frame. joint_frame: r from the parent's origin to the joint, E turns the parent's axes
-- into those of the joint (a row is an axis of the joint). A joint is a list of axes { wx, wy, wz, vx, vy, vz }, one
-- motion behind the other, or the name of a type. `inertia` is about the centre of mass; absent it is the unit matrix,
-- as in RBDL.
--
-- The file is a program: it is run with nothing at hand but pure functions, and stopped after some seconds. Its numbers
-- are the doubles that it computed.
local check = require "ambit.check"
local core = require "ambit.core"

local rbdl = {}

local PORTION = 1000000 -- instructions between two looks at the clock
local SECONDS = 1

local function copy(t)
  local other = {}
  for key, value in pairs(t) do other[key] = value end
  return other
end

local function environment()
  return { math = copy(math), string = copy(string), table = copy(table), pairs = pairs, ipairs = ipairs, next = next,
    select = select, type = type, tonumber = tonumber, tostring = tostring, error = error, assert = assert,
    print = function() end }
end

-- The line where the text first meets one of the patterns, else the last one: a value does not know where it was made.
local function line_of(text, ...)
  local at = #text
  for _, pattern in ipairs { ... } do
    local found = text:find(pattern)
    if found then
      at = found
      break
    end
  end
  local _, lines = text:sub(1, at):gsub("\n", "")
  return lines + 1
end

local FRAMES = "frames%s*="

local function line_of_frame(text, name)
  return line_of(text, "name%s*=%s*[\"']" .. name:gsub("%W", "%%%0") .. "[\"']", FRAMES)
end

local CHUNK = "a model of RBDL" -- in place of the file's name, which Lua would shorten

local function fail_in(file, message)
  local start, finish = message:find(CHUNK .. ":", 1, true)
  if start then
    check.fail("%s%s:%s", message:sub(1, start - 1), file, message:sub(finish + 1))
  end
  check.fail("%s: %s", file, message)
end

local function run(text, file)
  local chunk, problem = load(text, "=" .. CHUNK, "t", environment())
  if not chunk then fail_in(file, problem) end
  local thread = coroutine.create(chunk)
  local start = core.cpu()
  debug.sethook(thread, function()
    if core.cpu() - start > SECONDS then error(("it ran for more than %d s"):format(SECONDS), 2) end
  end, "", PORTION)
  local good, result = coroutine.resume(thread)
  if not good then fail_in(file, tostring(result)) end
  if type(result) ~= "table" then
    check.fail("%s:%d: expected a file that returns the table of a model, got %s", file, line_of(text),
      check.kind(result))
  end
  return result
end

-- n finite numbers at t[key]
local function list_of(place, t, key, n)
  local list = t[key]
  if type(list) ~= "table" or #list ~= n then
    place.fail("%s: expected a list of %d numbers, got %s", key, n,
      type(list) == "table" and ("a list of %d"):format(#list) or check.kind(list))
  end
  for i = 1, n do
    local value = list[i]
    if type(value) ~= "number" or value ~= value or math.abs(value) == math.huge then
      place.fail("%s[%d]: expected a number, got %s", key, i, tostring(value))
    end
  end
  return list
end

local function matrix_of(place, t, key)
  if type(t[key]) ~= "table" or #t[key] ~= 3 then place.fail("%s: expected three rows of three numbers", key) end
  local rows = {}
  local inside = { fail = function(format, ...) place.fail(key .. ": row " .. format, ...) end }
  for i = 1, 3 do rows[i] = list_of(inside, t[key], i, 3) end
  return rows
end

-- -- rotations

-- atan2(y, x), exact where the angle is a multiple of a right angle
local function angle(y, x)
  local pi = core.pi()
  if y == 0 then return x < 0 and pi or 0 end
  if x == 0 then return y > 0 and pi / 2 or -pi / 2 end
  return core.atan2(y, x)
end

-- Roll, pitch, yaw of the rotation whose rows are the axes of the joint: E = (Rz Ry Rx)^T. Where the matrix is only
-- near to a rotation this is the rotation of its first row and the rest of its last column.
local function angles_of(place, rows)
  local function dot(a, b) return a[1] * b[1] + a[2] * b[2] + a[3] * b[3] end
  for i = 1, 3 do
    for j = i, 3 do
      if math.abs(dot(rows[i], rows[j]) - (i == j and 1 or 0)) > 1e-6 then
        place.fail("joint_frame: E is not a rotation: rows %d and %d do not fit", i, j)
      end
    end
  end
  local a, b, c = rows[1], rows[2], rows[3]
  local n = { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
  if dot(n, c) < 0 then place.fail("joint_frame: E is a reflection, not a rotation") end
  if a[1] == 0 and a[2] == 0 then -- looking along z: the yaw can be 0
    return { angle(-c[2], b[2]), angle(-a[3], 0), 0 }
  end
  local level = a[2] == 0 and math.abs(a[1]) or a[1] == 0 and math.abs(a[2])
    or core.sqrt(core.sqr(core.expression(a[1])) + core.sqr(core.expression(a[2])))
  local pitch = a[3] == 0 and 0 or core.atan2(-a[3], level)
  return { angle(b[3], c[3]), pitch, angle(a[2], a[1]) }
end

-- -- joints

local function slide(axis) return { kind = core.default.slide, axis = axis } end
local function turn(axis) return { kind = core.default.hinge, axis = axis } end
local x, y, z = { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }

local types = {
  JointTypeFixed = {}, JointTypeRevoluteX = { turn(x) }, JointTypeRevoluteY = { turn(y) },
  JointTypeRevoluteZ = { turn(z) }, JointTypeTranslationXYZ = { slide(x), slide(y), slide(z) },
  JointTypeSpherical = { { kind = core.default.ball } },
  JointTypeFloatingBase = { { kind = core.default.floating } }, JointTypeEulerZYX = { turn(z), turn(y), turn(x) },
  JointTypeEulerXYZ = { turn(x), turn(y), turn(z) }, JointTypeEulerYXZ = { turn(y), turn(x), turn(z) },
  JointTypeEulerZXY = { turn(z), turn(x), turn(y) },
}

local function motion_of(place, axes, i)
  local what = ("joint[%d]"):format(i)
  local v = list_of(place, { [what] = axes[i] }, what, 6)
  local rotation, shift = { v[1], v[2], v[3] }, { v[4], v[5], v[6] }
  local w = math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
  local s = math.sqrt(v[4] ^ 2 + v[5] ^ 2 + v[6] ^ 2)
  if w == 0 and s == 0 then place.fail("%s: the axis is zero: expected a direction", what) end
  if math.abs((w > 0 and w or s) - 1) > 1e-6 then
    place.fail("%s: the axis has length %g: a coordinate counts rad or m only along an axis of length 1", what,
      w > 0 and w or s)
  end
  if s == 0 then return turn(rotation) end
  if w == 0 then return slide(shift) end
  local along = v[1] * v[4] + v[2] * v[5] + v[3] * v[6]
  if math.abs(math.abs(along) - w * s) > 1e-9 * s then
    place.fail("%s: turns about one axis and slides along another: expected one axis", what)
  end
  return { kind = core.default.screw, axis = rotation, pitch = (along > 0 and 2 or -2) * core.pi() * s }
end

local function motions_of(place, joint)
  if joint == nil then return {} end
  if type(joint) == "string" then joint = { joint } end
  if type(joint) ~= "table" then place.fail("joint: expected a list of axes or a type, got %s", check.kind(joint)) end
  if type(joint[1]) == "string" then
    local known = #joint == 1 and types[joint[1]]
    if not known then
      place.fail("joint: unknown type `%s`%s", joint[1], check.suggest(joint[1], check.sorted(types)))
    end
    return known
  end
  if type(joint[1]) == "number" then place.fail("joint: expected a list of axes, got one axis: write { { ... } }") end
  local list = {}
  for i = 1, #joint do list[i] = motion_of(place, joint, i) end
  return list
end

-- -- frames

local matters = { "name", "parent", "joint", "joint_frame", "body" }
local others = { visuals = true, markers = true, points = true }

local function body_of(place, frame, line)
  local body = frame.body
  if body == nil then return nil end
  if type(body) ~= "table" then place.fail("body: expected a table, got %s", check.kind(body)) end
  if type(body.mass) ~= "number" or body.mass ~= body.mass or math.abs(body.mass) == math.huge then
    place.fail("body: mass: expected a number, got %s", tostring(body.mass))
  end
  local rows = body.inertia == nil and { x, y, z } or matrix_of(place, body, "inertia")
  for i = 1, 3 do
    for j = 1, i - 1 do
      if math.abs(rows[i][j] - rows[j][i]) > 1e-9 * math.abs(rows[1][1] + rows[2][2] + rows[3][3]) then
        place.fail("body: the inertia is not symmetric: [%d][%d] is %g, [%d][%d] is %g", i, j, rows[i][j], j, i,
          rows[j][i])
      end
    end
  end
  return { line = line, mass = body.mass, centre = body.com == nil and { 0, 0, 0 } or list_of(place, body, "com", 3),
    rpy = { 0, 0, 0 },
    inertia = { rows[1][1], rows[1][2], rows[1][3], rows[2][2], rows[2][3], rows[3][3] } }
end

local function read_frame(robot, frame, i, text)
  if type(frame) ~= "table" then
    check.fail("%s:%d: frames[%d]: expected a table, got %s", robot.file, line_of(text, FRAMES), i, check.kind(frame))
  end
  local name = frame.name
  if type(name) ~= "string" or name == "" then
    check.fail("%s:%d: frames[%d]: expected a name, got %s", robot.file, line_of(text, FRAMES), i, tostring(name))
  end
  local line = line_of_frame(text, name)
  local place = { fail = function(format, ...)
    check.fail("%s", ("%s:%d: frame `%s`: %s"):format(robot.file, line, name, format:format(...)))
  end }
  if type(frame.parent) ~= "string" then
    place.fail('parent: expected the name of a frame or "ROOT", got %s', tostring(frame.parent))
  end
  for _, key in ipairs(check.sorted(frame)) do
    local near = type(key) == "string" and not others[key] and core.nearest(key, matters)
    if near and near ~= key then place.fail("unknown key `%s`; did you mean `%s`?", key, near) end
  end
  local at = frame.joint_frame or {}
  if type(at) ~= "table" then place.fail("joint_frame: expected a table, got %s", check.kind(at)) end
  local motions = motions_of(place, frame.joint)
  robot.links[#robot.links + 1] = { name = name, line = line, body = body_of(place, frame, line) }
  robot.joints[#robot.joints + 1] = { name = name, line = line, kind = #motions > 0 and "motions" or "fixed",
    parent = frame.parent, child = name, motions = motions, limits = {},
    offset = at.r == nil and { 0, 0, 0 } or list_of(place, at, "r", 3),
    rpy = at.E == nil and { 0, 0, 0 } or angles_of(place, matrix_of(place, at, "E")) }
end

-- read(text, file) -> robot, not yet checked as a whole
function rbdl.read(text, file)
  local model = run(text, file)
  local robot = { file = file, line = 1, links = { { name = "ROOT", line = 1 } }, joints = {} }
  if type(model.frames) ~= "table" or #model.frames == 0 then
    check.fail("%s:%d: expected a model with a list `frames`%s", file, line_of(text, "return"),
      check.suggest("frames", check.sorted(model)))
  end
  local place = { fail = function(format, ...)
    check.fail("%s:%d: " .. format, file, line_of(text, "gravity%s*="), ...)
  end }
  if model.gravity ~= nil then robot.gravity = list_of(place, model, "gravity", 3) end
  for i = 1, #model.frames do read_frame(robot, model.frames[i], i, text) end
  return robot
end

return rbdl
