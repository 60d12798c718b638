-- element.lua -- m:rigid_link { from = frame, offset = { 1, 0, 0 } }: a declared element, checked and added to a
-- mechanism.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local law = require "ambit.law"
local parameter = require "ambit.parameter"

local element = {}

-- The declaration of an element plugin, with what is looked up often; loads the plugin on first use.
local declarations = {}

function element.declaration(name)
  if declarations[name] then return declarations[name] end
  local d = core.plugin("element", name)
  d.known, d.outs = { "name" }, {}
  for i, port in ipairs(d.ports) do
    port.index = i - 1
    if port.role == "in" then d.known[#d.known + 1] = port.name else d.outs[#d.outs + 1] = port end
  end
  for _, param in ipairs(d.parameters) do
    d.known[#d.known + 1] = param.name
    param.what = name .. ": " .. param.name
  end
  declarations[name] = d
  return d
end

-- A list in the table is the first parameter: m:gravity { 0, "-9.81", 0 }.
local function take_positional(d, t)
  local list = {}
  for i, value in ipairs(t) do list[i] = value end
  if #list == 0 then return nil end
  local first = d.parameters[1]
  if not first then check.fail("%s: takes no list", d.name) end
  if t[first.name] ~= nil then check.fail("%s: %s is given twice, by name and as a list", d.name, first.name) end
  return #list == 1 and list[1] or list
end

-- { part, port, ... } for every port in order; -1: not connected
local function connections(self, d, t)
  local list = {}
  for i, port in ipairs(d.ports) do
    local part, number = -1, 0
    if port.role == "in" then
      local value = t[port.name]
      if value ~= nil then
        part, number = frame.place(self, value, port.kind, d.name .. ": " .. port.name)
      elseif not port.optional then
        check.fail('%s: port `%s` is not connected (%s)', d.name, port.name, port.doc or port.kind)
      end
    end
    list[2 * i - 1], list[2 * i] = part, number
  end
  return list
end

-- Data of a joint have one unit if it turns and another if it slides ("N m/rad|N/m"): that of the joint at hand, where
-- it can be told. "N m|" is for one that turns only.
local function fitting(self, d, t, param)
  if not param.unit:find "|" then return param end
  local turning, sliding = param.unit:match "^(.-)|(.*)$"
  for _, port in ipairs(d.ports) do
    if port.kind == "joint" and port.role == "in" and t[port.name] ~= nil then
      local part, number = frame.place(self, t[port.name], "joint", param.what)
      local q = core.pull(self.handle, part, number, core.COORDINATE, 1)[1]
      local of_joint = core.coordinate_unit(self.handle, q) -- the graph's may be that of a namesake elsewhere
      if of_joint then -- else a given motion
        local turns = of_joint == "rad"
        local unit = turns and turning or sliding
        if unit == "" then
          check.fail("%s: it is in %s, but the joint `%s` %s", param.what, parameter.unit_text(param),
            core.part_name(self.handle, part), turns and "turns" or "slides")
        end
        return setmetatable({ unit = unit }, { __index = param })
      end
    end
  end
  return param
end

local function parameters(self, d, t)
  local first = take_positional(d, t)
  local list, values, laws = {}, {}, {}
  local function express(i, param, value)
    list[i] = parameter.express(fitting(self, d, t, param), value, param.what)
    core.refuse_plain(list[i], param.what, laws[i] ~= nil)
    values[param.name] = list[i]
  end
  for i, param in ipairs(d.parameters) do
    local value = t[param.name]
    if i == 1 and first ~= nil then value = first end
    if type(value) == "function" then
      laws[i], list[i] = value, false
    elseif value ~= nil then
      express(i, param, value)
    else
      list[i] = parameter.fallback(param, param.what) or false
    end
  end
  for i, param in ipairs(d.parameters) do
    if laws[i] then express(i, param, law.record(self, d, t, values, param, laws[i])) end
  end
  return list
end

-- What a part was made of: its connections and parameters, as core.add takes them.
local made = setmetatable({}, { __mode = "k" })

function element.made(m, part) return made[m][part] end

-- Adds a part whose connections and parameters are checked already; unit: of a state. Returns its number.
function element.enter(self, d, name, where, values, links, unit)
  local part = core.add(self.handle, d.name, name, where, values, links, unit)
  self.declared[part] = d
  made[self] = made[self] or {}
  made[self][part] = { links = links, values = values, unit = unit }
  return part
end

-- Adds one element; returns its OUT frames and joints, in the order of their declaration.
function element.add(self, name, t)
  local d = element.declaration(name)
  check.table(t, name)
  check.keys(t, d.known, name, #t)
  if t.name ~= nil then check.text(t.name, name .. ": name") end
  local where = core.where():gsub(": $", "")
  local links = connections(self, d, t)
  local part = element.enter(self, d, t.name, where, parameters(self, d, t), links)
  local outs = {}
  for i, port in ipairs(d.outs) do outs[i] = frame.new(self, part, port) end
  return table.unpack(outs)
end

return element
