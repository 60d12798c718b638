-- manual.lua -- the manual of a plugin or a chain, from what it declares about itself.
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"
local parameter = require "ambit.parameter"
local plugin = require "ambit.plugin"

local manual = {}

local shapes = { [""] = "a number", axis = "an axis", flag = "true or false", integer = "an integer",
  any = "anything" }

local function shape_text(param)
  if param.shape:find "|" then return (param.shape:gsub("|", " | ")) end
  return shapes[param.shape] or (param.shape .. " numbers")
end

local function parameter_line(param)
  local default = "required"
  if param.fallback == "" then default = "optional" elseif param.fallback then default = "default " .. param.fallback
    end
  local unit = param.unit ~= "1" and " in " .. parameter.unit_text(param) or ""
  return ("  %-14s %s%s, %s\n%17s%s"):format(param.name, shape_text(param), unit, default, "", param.doc or "")
end

local function port_line(port)
  local role = port.role == "out" and "returned" or port.optional and "optional" or "required"
  return ("  %-14s %s, %s\n%17s%s"):format(port.name, port.kind, role, "", port.doc or "")
end

local function section(lines, title, list, format)
  if not list or #list == 0 then return end
  lines[#lines + 1] = ""
  lines[#lines + 1] = title
  for _, entry in ipairs(list) do lines[#lines + 1] = format(entry) end
end

local function usage(p)
  if p.kind == "element" or p.kind == "chain" then return ("m:%s { ... }"):format(p.name) end
  if p.verb == "reduce" then return "ambit.reduce { ... }, which chooses what to leave out with it" end
  if p.kind == "solver" then return ('ambit.%s { ..., solver = "%s" }'):format(p.verb, p.name) end
  if p.kind == "arithmetic" then return ('arithmetic = "%s"'):format(p.name) end
end

-- What a plugin, or whatever declares itself in the same words, says about itself.
local function text(p)
  local lines = { ("%s %s%s"):format(p.kind, p.name, p.version and ", version " .. p.version or "") }
  if p.doc then lines[#lines + 1] = p.doc end
  if usage(p) then
    lines[#lines + 1] = ""
    lines[#lines + 1] = "use: " .. usage(p)
  end
  if p.verb == "reduce" then
    lines[#lines + 1] = "it proves nothing itself: the verb proves each of its choices"
  elseif p.rigorous ~= nil then
    lines[#lines + 1] = p.rigorous and "its results are proved enclosures" or "its results prove nothing"
  end
  if p.arithmetics then lines[#lines + 1] = "arithmetics that fit: " .. p.arithmetics end
  section(lines, "ports", p.ports, port_line)
  section(lines, (p.kind == "element" or p.kind == "chain") and "parameters" or "options", p.parameters, parameter_line)
  local functions = {}
  for _, key in ipairs(check.sorted(p.functions or {})) do functions[#functions + 1] = { key, p.functions[key] } end
  section(lines, "functions (ambit.plugin(kind, name).fn)", functions, function(f)
    return ("  %-14s %s\n%17s%s"):format(f[1], f[2].signature, "", f[2].doc or "")
  end)
  return table.concat(lines, "\n")
end

-- The manual of one plugin as text; loads it.
function manual.of(kind, name) return text(plugin.plugin(kind, name)) end

-- Of a chain: what its definition declares.
local function of_chain(d)
  local p = { kind = "chain", name = d.name, doc = d.doc, ports = {}, parameters = {} }
  for _, key in ipairs(check.sorted(d.ports)) do
    local port = d.ports[key]
    p.ports[#p.ports + 1] = { name = key, kind = port.kind, role = "in", optional = port.optional, doc = port.doc }
  end
  for _, key in ipairs(check.sorted(d.parameters)) do
    local param = d.parameters[key]
    local default = param.default
    if default == nil and param.optional then default = "" end
    if default ~= nil then default = tostring(default) end
    p.parameters[#p.parameters + 1] = { name = key, unit = param.unit, shape = param.shape, fallback = default,
      doc = param.doc }
  end
  return text(p)
end

-- By name alone: every kind that has one of that name.
function manual.named(name)
  local kind, bare = name:match "^(%a+)%.([%w_]+)$"
  local texts, names = {}, {}
  for _, entry in ipairs(core.list()) do
    names[#names + 1] = entry.name
    if entry.name == (bare or name) and (not kind or entry.kind == kind) then
      texts[#texts + 1] = manual.of(entry.kind, entry.name)
    end
  end
  local definition = (not kind or kind == "chain") and chain.find(bare or name)
  if definition then texts[#texts + 1] = of_chain(definition) end
  table.move(chain.names(), 1, #chain.names(), #names + 1, names)
  if #texts == 0 then return nil, ('there is no plugin `%s`%s'):format(name, check.suggest(name, names)) end
  return table.concat(texts, "\n\n")
end

return manual
