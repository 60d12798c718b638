-- frame.lua -- what an element hands out to connect others to: a frame, or the coordinates of a joint.
local check = require "ambit.check"
local core = require "ambit.core"

local Frame = { __name = "frame" }
Frame.__index = Frame
local Joint = { __name = "joint" }
Joint.__index = Joint

local frame = {}

function frame.new(mechanism, part, port)
  return setmetatable({ mechanism = mechanism, part = part, port = port.index, kind = port.kind },
    port.kind == "joint" and Joint or Frame)
end

local function describe(self)
  return ("%s of %s"):format(self.kind, core.part_name(self.mechanism.handle, self.part))
end

Frame.__tostring, Joint.__tostring = describe, describe

function frame.is(value)
  local meta = getmetatable(value)
  return meta == Frame or meta == Joint
end

-- The only joint of the part that made this frame: `joint = shoulder` may be said with the frame that the joint moves.
local function joint_of(self, what)
  local found
  for _, port in ipairs(self.mechanism.declared[self.part] and self.mechanism.declared[self.part].outs or {}) do
    if port.kind == "joint" then
      if found then check.fail("%s: %s has several joints; say which", what, tostring(self)) end
      found = port
    end
  end
  if not found then check.fail("%s: expected a joint, got the %s, which has none", what, tostring(self)) end
  return self.part, found.index
end

-- place(mechanism, value, kind, what) -> part, port
function frame.place(mechanism, value, kind, what)
  local meta = getmetatable(value)
  if type(meta) == "table" and meta.place then value = meta.place(value, kind, what) end -- a chain stands for its own
  if not frame.is(value) then check.fail("%s: expected a %s, got %s", what, kind, check.kind(value)) end
  if value.mechanism ~= mechanism and mechanism.counterparts then value = mechanism.counterparts(value) end
  if value.mechanism ~= mechanism then
    check.fail('%s: the %s belongs to another mechanism, `%s`', what, tostring(value), value.mechanism.name)
  end
  if value.kind == kind then return value.part, value.port end
  if kind == "joint" then return joint_of(value, what) end
  check.fail("%s: expected a frame, got the %s", what, tostring(value))
end

return frame
