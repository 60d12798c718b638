-- chain.lua -- a Lua function that assembles elements is itself an element (MOBILE's MoMapChain; Kecskemethy & Hiller
-- 1994).
--
--   ambit.chain { "leg", doc = "...", ports = { from = "frame" },
--     parameters = { thigh = { "m", "0.4", "its length" } },      -- unit, default (none: required), one sentence
--     build = function(m, p) ... return { foot = frame, knee = joint } end }
--   local left = m:leg { name = "left", from = hip, thigh = "0.42" }     -- left.foot, left.knee
--
-- Inside, every part is called after the chain ("left.knee"). A parameter that is not given is that of the same name,
-- unit and shape of the chain around it, then its default.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local parameter = require "ambit.parameter"
local tree = require "ambit.tree"
local Vector = require "ambit.vector"

local chain = {}

local named = {}           -- definitions by name
local Definition = { __name = "chain" }
Definition.__index = Definition

-- What chains cannot be called: filled in by the mechanism.
chain.reserved = {}

-- -- definitions

local kinds = { "frame", "joint" }

-- ports = { from = "frame" } or { from = { "frame", "one sentence", optional = true } }
local function read_port(name, spec, what)
  if type(spec) == "string" then spec = { spec } end
  check.table(spec, what)
  check.keys(spec, { "kind", "doc", "optional" }, what, 2)
  local kind = spec[1] or spec.kind
  if kind ~= "frame" and kind ~= "joint" then
    check.fail('%s: expected "frame" or "joint", got %s%s', what, tostring(kind), check.suggest(kind, kinds))
  end
  return { name = name, kind = kind, doc = spec[2] or spec.doc, optional = spec.optional or false }
end

local shapes = { [""] = true, axis = true, flag = true, integer = true, any = true }

local function read_default(param)
  local value = param.default
  if value == nil or param.shape == "any" then return end
  if value == "" then
    check.fail("%s: the default is an empty text; leave it out, and say optional = true if nothing is to be a value",
      param.what)
  end
  if type(value) == "string" and not param.shape:find "|" and param.shape ~= "integer" then
    param.fallback = value
    parameter.fallback(param, param.what)
  else
    parameter.express(param, value, param.what)
  end
end

-- parameters = { thigh = { "m", "0.4", "one sentence", shape = "3", optional = true } }
local function read_parameter(name, spec, what)
  if type(spec) ~= "table" then spec = { "1", spec } end
  check.keys(spec, { "unit", "default", "doc", "shape", "optional" }, what, 3)
  local param = { name = name, unit = spec[1] or spec.unit or "1", shape = spec.shape or "", what = what,
    doc = spec[3] or spec.doc, optional = spec.optional or false }
  if spec[2] ~= nil then param.default = spec[2] else param.default = spec.default end
  check.text(param.unit, what .. ": unit")
  check.text(param.shape, what .. ": shape")
  if not shapes[param.shape] and not param.shape:find "^%d+x?%d*$" and not param.shape:find "|" then
    check.fail('%s: unknown shape `%s` (there is: "", "3", "3x3", axis, flag, integer, any, one|two)', what,
      param.shape)
  end
  if param.unit ~= "1" then core.expression("1 " .. param.unit, nil, what .. ": unit") end
  read_default(param)
  return param
end

local function read_all(d, t, into, what, read)
  check.table(t or {}, what)
  for _, key in ipairs(check.sorted(t or {})) do
    if type(key) ~= "string" then check.fail("%s: unexpected entry [%s]", what, tostring(key)) end
    if key == "name" or d.ports[key] then check.fail("%s: the name `%s` is taken", what, key) end
    into[key] = read(key, t[key], ("%s: %s"):format(d.name, key))
    d.known[#d.known + 1] = key
  end
end

local function check_name(name, place, shipped)
  if not name:find "^[%a_][%w_]*$" then check.fail("chain: `%s` is no name that m:NAME { ... } could use", name) end
  if chain.reserved[name] then check.fail("chain `%s`: a mechanism has a method of that name", name) end
  for _, entry in ipairs(core.list()) do
    if entry.kind == "element" and entry.name == name then
      check.fail("chain `%s`: there is an element of that name", name)
    end
  end
  if not shipped and package.preload["ambit.chain." .. name] then
    check.fail("chain `%s`: Ambit has a chain of that name", name)
  end
  local other = named[name]
  if other and other.place ~= place then
    check.fail("chain `%s`: the name is taken by the chain of %s", name, other.place)
  end
end

-- ambit.chain { ... } -> the definition, also usable as leg(m, { ... }); shipped: Ambit's own.
function chain.new(t, shipped)
  check.table(t, "chain")
  check.keys(t, { "name", "doc", "ports", "parameters", "build" }, "chain", 1)
  local name = check.text(t[1] or t.name, "chain: name")
  local place = core.where():gsub(": $", "")
  check_name(name, place, shipped == true)
  if type(t.build) ~= "function" then
    check.fail("chain `%s`: build: expected a function(m, p) that adds the parts and returns frames and joints, got %s",
      name, check.kind(t.build))
  end
  local d = setmetatable({ name = name, doc = t.doc, place = place, build = t.build, known = { "name" }, ports = {},
    parameters = {} }, Definition)
  read_all(d, t.ports, d.ports, ("chain `%s`: ports"):format(name), read_port)
  read_all(d, t.parameters, d.parameters, ("chain `%s`: parameters"):format(name), read_parameter)
  named[name] = d
  return d
end

-- The chain of that name, loaded if it is Ambit's own; nil if there is none.
function chain.find(name)
  if not named[name] and package.preload["ambit.chain." .. name] then require("ambit.chain." .. name) end
  return named[name]
end

function chain.names()
  local list = check.sorted(named)
  for module in pairs(package.preload) do
    local name = type(module) == "string" and module:match "^ambit%.chain%.([%w_]+)$"
    if name and not named[name] then list[#list + 1] = name end
  end
  return list
end

-- -- what a chain hands out

-- The only value of that kind, or the one called `usual`.
local function only(outs, kind, usual, path, what)
  if frame.is(rawget(outs, usual)) and outs[usual].kind == kind then return outs[usual] end
  local names = {}
  for _, key in ipairs(check.sorted(outs)) do
    if frame.is(outs[key]) and outs[key].kind == kind then names[#names + 1] = key end
  end
  if #names == 1 then return outs[names[1]] end
  if #names == 0 then check.fail("%s: expected a %s, got chain `%s`, which has none", what, kind, path) end
  check.fail("%s: chain `%s` has several: say which, as in chain.%s (there is: %s)", what, path, names[1],
    table.concat(names, ", "))
end

local usual = { frame = "to", joint = "joint" }

local function hand_out(d, path, outs)
  local meta = { __name = "chain" }
  function meta.__tostring() return ("%s `%s`"):format(d.name, path) end
  function meta.__index(_, key)
    check.fail("%s `%s` has no `%s`%s", d.name, path, tostring(key), check.suggest(key, check.sorted(outs)))
  end
  function meta.place(_, kind, what) return only(outs, kind, usual[kind], path, what) end
  return setmetatable(outs, meta)
end

-- What build returned as a table of its own: `return frame, joint` is { to = frame, joint = joint }.
local function read_outs(self, d, path, first, second)
  if first == nil then
    check.fail("%s `%s`: build (%s) returned nothing: return its frames and joints, as in return { to = frame }, or {}",
      d.name, path, d.place)
  end
  local outs = {}
  if frame.is(first) then
    outs[usual[first.kind]] = first
    if frame.is(second) then outs[usual[second.kind]] = second end
  elseif type(first) == "table" then
    for key, value in pairs(first) do outs[key] = value end
  else
    check.fail("%s `%s`: build (%s) returned a %s: expected a table of frames and joints", d.name, path, d.place,
      check.kind(first))
  end
  for _, key in ipairs(check.sorted(outs)) do
    local value = outs[key]
    if frame.is(value) and value.mechanism ~= self then
      check.fail("%s `%s`: build returned a %s of another mechanism, `%s`, as `%s`", d.name, path, value.kind,
        value.mechanism.name, tostring(key))
    end
  end
  return outs
end

-- -- building

-- The checked expressions in the shape that Lua likes best.
local function value_of(param, list, given)
  if param.shape == "" then return list[1] end
  if param.shape == "flag" or param.shape:find "|" then return given end
  if param.shape == "integer" then return math.tointeger(tonumber(given)) end
  if #list == 3 then return Vector.new(list[1], list[2], list[3]) end
  local columns = tonumber(param.shape:match "x(%d+)")
  if not columns then return list end
  local rows = {}
  for i = 0, #list - 1 do
    local row = i // columns + 1
    rows[row] = rows[row] or {}
    rows[row][i % columns + 1] = list[i + 1]
  end
  return rows
end

-- The value of the same parameter in the chains around, the innermost first.
local function inherited(scope, param)
  while scope do
    local other = scope.definition and scope.definition.parameters[param.name]
    local value = other and scope.values[param.name]
    if value ~= nil and other.unit == param.unit and other.shape == param.shape then return value end
    scope = scope.parent
  end
end

local function read_value(self, param, given)
  if given == nil then
    local value = inherited(tree.scope(self), param)
    if value ~= nil then return value end
    given = param.default
    if given == nil and not param.optional then
      check.fail("%s is required (%s)", param.what, param.doc or "no description")
    end
  end
  if given == nil or param.shape == "any" then return given end
  if param.fallback and given == param.default then
    return value_of(param, parameter.fallback(param, param.what), given == "true")
  end
  return value_of(param, parameter.express(param, given, param.what), given)
end

-- The frame or joint that stands for a port: a chain that has only one of them may stand for it.
local function read_port_value(self, d, port, given)
  local what = ("%s: %s"):format(d.name, port.name)
  if given ~= nil then
    frame.place(self, given, port.kind, what)
    return given
  end
  if not port.optional then
    check.fail("%s: port `%s` is not connected (%s)", d.name, port.name, port.doc or port.kind)
  end
end

-- p.thigh, p.from; a wrong name is an error, not nil.
local function strict(d, values)
  return setmetatable({}, {
    __index = function(_, key)
      if values[key] == nil and not d.parameters[key] and not d.ports[key] then
        check.fail("%s: there is no parameter `%s`%s", d.name, tostring(key), check.suggest(key, d.known))
      end
      return values[key]
    end,
    __newindex = function(_, key) check.fail("%s: the parameter `%s` cannot be assigned", d.name, tostring(key)) end,
    __pairs = function() return next, values end,
  })
end

-- Adds the parts of a chain to a mechanism; returns what it hands out.
function chain.add(self, d, t)
  check.table(t, d.name)
  check.keys(t, d.known, d.name)
  local values = {}
  for _, key in ipairs(check.sorted(d.ports)) do values[key] = read_port_value(self, d, d.ports[key], t[key]) end
  for _, key in ipairs(check.sorted(d.parameters)) do values[key] = read_value(self, d.parameters[key], t[key]) end
  local scope <close> = tree.enter(self, d.name, t.name, d.doc)
  scope.definition, scope.values = d, values
  local path = scope.node.path
  return hand_out(d, path, read_outs(self, d, path, d.build(self, strict(d, values))))
end

function Definition.__call(d, self, t)
  if check.kind(self) ~= "mechanism" then
    check.fail("%s: expected a mechanism, as in %s(m, { ... }), got %s", d.name, d.name, check.kind(self))
  end
  return chain.add(self, d, t)
end

function Definition.__tostring(d) return ("chain `%s` (%s)"):format(d.name, d.place) end

return chain
