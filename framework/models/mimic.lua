-- mimic.lua -- m:revolute { from = f, mimic = { joint = drive, multiplier = 2, offset = 0 } }: a joint that follows
-- another one, q = multiplier q_drive + offset; it has no coordinate of its own (equations of motion: the balance of a
-- follower enters that of its drive, docs/numerics/mechanics.md).
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"
local Matrix = require "ambit.matrix"

local mimic = {}

local motions = { angle = true, displacement = true }

-- The parameter of a declared joint that is its given motion, or nil.
local function given_motion(d)
  for _, param in ipairs(d.parameters) do
    if motions[param.name] and param.fallback == "" then return param end
  end
end

-- Is there a joint that follows nothing? Then `mimic` is a key of it.
function mimic.declare(type)
  local d = element.declaration(type)
  local joint = false
  for _, port in ipairs(d.outs) do joint = joint or port.kind == "joint" end
  d.mimics = joint and given_motion(d) or nil
  if d.mimics then d.known[#d.known + 1] = "mimic" end
end

-- The coordinates of a joint, each an expression.
local function coordinates(self, joint, what)
  local part, port = frame.place(self, joint, "joint", what)
  for _, out in ipairs(self.declared[part].outs) do
    if out.index == port then return core.pull(self.handle, part, port, core.COORDINATE, out.coordinates or out.dof) end
  end
end

-- t with the motion that `mimic` says in place of it.
function mimic.resolve(self, type, t)
  local param = element.declaration(type).mimics
  if not param or check.kind(t) ~= "table" or t.mimic == nil then return t end
  local what = type .. ": mimic"
  local spec = check.table(t.mimic, what) or t.mimic
  if frame.is(spec) then spec = { joint = spec } end
  check.keys(spec, { "joint", "multiplier", "offset" }, what)
  if spec.joint == nil then check.fail("%s: `joint` is missing: the joint that is followed", what) end
  if t[param.name] ~= nil then check.fail("%s: the joint has `%s` already; give one of the two", what, param.name) end
  local list = coordinates(self, spec.joint, what .. ": joint")
  if #list ~= 1 then
    check.fail("%s: expected a joint with one coordinate, got the %s, which has %d", what, tostring(spec.joint), #list)
  end
  local multiplier = core.expression(spec.multiplier == nil and 1 or spec.multiplier, nil, what .. ": multiplier")
  local offset = core.expression(spec.offset == nil and 0 or spec.offset, param.unit, what .. ": offset")
  local copy = {}
  for key, value in pairs(t) do copy[key] = value end
  copy.mimic, copy[param.name] = nil, multiplier * list[1] + offset
  return copy
end

-- m:coordinate(joint): its coordinate as an expression; several as a list.
mimic.methods = {}

function mimic.methods:coordinate(joint)
  local list = coordinates(self, joint, "coordinate")
  return #list == 1 and list[1] or setmetatable(list, Matrix)
end

return mimic
