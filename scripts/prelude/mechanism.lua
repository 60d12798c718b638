-- mechanism.lua -- m = ambit.mechanism "arm"; m:<element> { ... }; m:position(frame); m:dynamics().
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"
local session = require "ambit.session"

local Mechanism = { __name = "mechanism" }
local methods = {}
local constructors = {}

-- A method, else an element plugin of that name.
function Mechanism.__index(_, key)
  if methods[key] then return methods[key] end
  if type(key) ~= "string" then check.fail("a mechanism has no entry [%s]", tostring(key)) end
  if not constructors[key] then
    local near = core.nearest(key, check.sorted(methods))
    local exists = false
    for _, entry in ipairs(near and core.list() or {}) do
      exists = exists or entry.kind == "element" and entry.name == key
    end
    if near and not exists then check.fail('a mechanism has no `%s`; did you mean `%s`?', key, near) end
    element.declaration(key)
    constructors[key] = function(self, t)
      if getmetatable(self) ~= Mechanism then check.fail("%s: write m:%s { ... }, with a colon", key, key) end
      return element.add(self, key, t)
    end
  end
  return constructors[key]
end

function Mechanism.__tostring(self) return ('mechanism "%s" (%d parts)'):format(self.name,
  core.part_count(self.handle)) end

for _, part in ipairs { "measure", "dynamics", "loops", "assemble" } do require("ambit." .. part).install(methods) end

check.methods(methods, Mechanism)

local mechanism = {}

-- mechanism "name" or mechanism { "name", gravity = { 0, "-9.81", 0 } }
function mechanism.new(t)
  if type(t) == "string" or t == nil then t = { t } end
  check.table(t, "mechanism")
  check.keys(t, { "name", "gravity" }, "mechanism", 1)
  local name = check.text(t[1] or t.name or "mechanism", "mechanism: name")
  local self = setmetatable({ name = name, handle = core.mechanism(name), declared = {}, cached = false,
    cached_parts = false },
    Mechanism)
  self.world = frame.new(self, 0, { index = 0, kind = "frame" })
  session.add(session.mechanisms, self)
  if t.gravity ~= nil then element.add(self, "gravity", type(t.gravity) == "table" and t.gravity or { t.gravity }) end
  return self
end

function mechanism.is(value) return getmetatable(value) == Mechanism end

return mechanism
