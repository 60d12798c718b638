-- mechanism.lua -- m = ambit.mechanism "arm"; m:<element> { ... }; m:<chain> { ... }; m:position(frame); m:dynamics().
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local frame = require "ambit.frame"
local mimic = require "ambit.mimic"
local session = require "ambit.session"
local structure = require "ambit.structure"
local tree = require "ambit.tree"

local Mechanism = { __name = "mechanism" }
local methods = {}
local constructors = {}

local function check_self(self, key)
  if getmetatable(self) ~= Mechanism then check.fail("%s: write m:%s { ... }, with a colon", key, key) end
end

local function is_element(name)
  for _, entry in ipairs(core.list()) do
    if entry.kind == "element" and entry.name == name then return true end
  end
  return false
end

-- The function behind m:<element>.
local function element_constructor(key)
  element.declaration(key)
  mimic.declare(key)
  return function(self, t)
    check_self(self, key)
    t = mimic.resolve(self, key, tree.named(self, key, t))
    local closure, part = structure.check(self, key, t), core.part_count(self.handle)
    self.places[part] = core.where():gsub(": $", "")
    return structure.enter(self, closure, part, element.add(self, key, t))
  end
end

local function chain_constructor(definition)
  return function(self, t)
    check_self(self, definition.name)
    return chain.add(self, definition, t)
  end
end

local function check_known(key)
  if is_element(key) then return end
  local others = check.sorted(methods)
  table.move(chain.names(), 1, #chain.names(), #others + 1, others)
  local near = core.nearest(key, others)
  if near then check.fail("a mechanism has no `%s`; did you mean `%s`?", key, near) end
end

-- A method, else a chain, else an element plugin of that name.
function Mechanism.__index(_, key)
  if methods[key] then return methods[key] end
  if type(key) ~= "string" then check.fail("a mechanism has no entry [%s]", tostring(key)) end
  local definition = not constructors[key] and chain.find(key)
  if definition then return chain_constructor(definition) end
  if not constructors[key] then
    check_known(key)
    constructors[key] = element_constructor(key)
  end
  return constructors[key]
end

function Mechanism.__tostring(self) return ('mechanism "%s" (%d parts)'):format(self.name,
  core.part_count(self.handle)) end

-- Which module has which methods: it is read when one of them is first called.
local homes = {
  assemble = "assemble",
  dynamics = [[energy power coordinate_names speed_names coordinates mass_matrix generalised_forces bias gravity_torque
    inverse_dynamics forward_dynamics jacobian dynamics]],
  ["robot.limit"] = "limit_excess limit_events limit_stops",
  ["robot.load"] = "load link limits tolerances",
  loops = "constraints independent reference redundant multipliers of_states rank",
  measure = [[position orientation velocity angular_velocity acceleration distance relative_pose relative_velocity angle
    total_mass centre_of_mass momentum reaction]],
  mimic = "coordinate",
  sampled = "sampled",
  state = "state",
  tree = "tree",
}

for home, names in pairs(homes) do
  for name in names:gmatch "%S+" do
    methods[name] = function(...) return require("ambit." .. home).methods[name](...) end
  end
end

check.methods(methods, Mechanism)
chain.reserved = methods

local mechanism = { homes = homes }

-- A mechanism without parts that nobody has been told of. counterparts: of a copy, a function from the frames and
-- joints of the mechanism that it was made from to its own (reduce/mechanism_copy.lua).
function mechanism.blank(name)
  local self = setmetatable({ name = name, handle = core.mechanism(name), declared = {}, places = {}, closures = {},
    scope = false,
    cached = false, cached_parts = false, counterparts = false },
    Mechanism)
  self.world = frame.new(self, 0, { index = 0, kind = "frame" })
  return self
end

-- mechanism "name" or mechanism { "name", gravity = { 0, "-9.81", 0 } }
function mechanism.new(t)
  if type(t) == "string" or t == nil then t = { t } end
  check.table(t, "mechanism")
  check.keys(t, { "name", "gravity" }, "mechanism", 1)
  local name = check.text(t[1] or t.name or "mechanism", "mechanism: name")
  local self = mechanism.blank(name)
  session.add(session.mechanisms, self)
  if t.gravity ~= nil then self:gravity(type(t.gravity) == "table" and t.gravity or { t.gravity }) end
  return self
end

function mechanism.is(value) return getmetatable(value) == Mechanism end

return mechanism
