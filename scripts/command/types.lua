-- types.lua -- `ambit types`: the interface for editors.
local core = require "ambit.core"
local interface = require "ambit.interface"
local plugin = require "ambit.plugin"

local command = {}

command.usage = [[
usage: ambit types > ambit.lua
       ambit types --markdown NAME
Prints annotations of the whole interface (LuaCATS), with the elements, solvers and arithmetics that are installed: for
the workspace library of a Lua language server. --markdown: the table of keys of docs/, of one class.]]

local out = print

local function typed(text)
  return interface.types(text, function(word) return "ambit." .. word end)
end

local function plain(text) return (text:gsub("%[([^%]]-)%]%([^)]-%)", "%1")) end

local function field(name, type, doc)
  out(plain(("---@field %s %s %s"):format(name, typed(type), doc):gsub(" +$", "")))
end

local function function_of(owner, member)
  if member[3] ~= "" then out("---" .. plain(member[3])) end
  local names = {}
  for i, parameter in ipairs(interface.parameters(member)) do
    out(("---@param %s %s"):format(parameter[1], typed(parameter[2])))
    names[i] = parameter[1]:gsub("%?$", "")
  end
  if member[2] ~= "" then out("---@return " .. typed(member[2])) end
  out(("function %s%s(%s) end"):format(owner, interface.name(member), table.concat(names, ", ")))
end

-- What a parameter of a plugin takes; number: what stands for one.
local function shape(param, number)
  if param.shape:find "|" then return '"' .. param.shape:gsub("|", '"|"') .. '"' end
  return ({ [""] = number, integer = "integer", flag = "boolean", axis = "axis", any = "any", ["3"] = "vector" })[
    param.shape] or number .. "[][]"
end

-- Plugins of a kind that hold for `fits`, loaded.
local function loaded(kind, fits)
  local list = {}
  for _, entry in ipairs(plugin.plugins(kind)) do
    local p = plugin.plugin(kind, entry.name)
    if not fits or fits(p) then list[#list + 1] = p end
  end
  return list
end

-- The options of all solvers of a verb, each once, with who knows it.
local function solver_options(verb)
  local names, first, by, same, usual = {}, {}, {}, {}, {}
  for _, p in ipairs(loaded("solver", function(p) return p.verb == verb end)) do
    for _, param in ipairs(p.parameters) do
      if not first[param.name] then names[#names + 1], first[param.name], by[param.name] = param.name, param, {} end
      table.insert(by[param.name], p.name)
      same[param.name] = first[param.name].shape == param.shape and same[param.name] ~= false
      usual[param.name] = first[param.name].fallback == param.fallback and usual[param.name] ~= false
    end
  end
  for _, name in ipairs(names) do
    field(name .. "?", same[name] and shape(first[name], "number") or "any",
      ("%s: %s%s"):format(table.concat(by[name], ", "), first[name].doc,
        usual[name] and first[name].fallback and (" (default %s)"):format(first[name].fallback) or ""))
  end
end

local function element(p)
  out("---" .. p.doc)
  local keys, gives = { "[integer]: any", "name: string?" }, {}
  local function key(name, type, may_miss) keys[#keys + 1] = ("%s: %s%s"):format(name, type, may_miss and "?" or "") end
  for _, port in ipairs(p.ports) do
    local kind = (port.kind == "frame" or port.kind == "joint") and "ambit." .. port.kind or "any"
    if port.role == "in" then key(port.name, kind, port.optional) elseif kind ~= "any" then gives[#gives + 1] = kind end
  end
  for _, param in ipairs(p.parameters) do
    key(param.name, typed(shape(param, "datum")) .. "|function", param.fallback)
  end
  out(("---@param t { %s }"):format(table.concat(keys, ", ")))
  if gives[1] then out("---@return " .. table.concat(gives, ", ")) end
  out(("function mechanism:%s(t) end"):format(p.name))
end

local function class(entry)
  if entry.doc ~= "" then out("---" .. entry.doc) end
  out(("---@class ambit.%s%s"):format(entry.class, entry.of and ": " .. typed(entry.of) or ""))
  local methods = {}
  for _, member in ipairs(entry) do
    if interface.parameters(member) then methods[#methods + 1] = member else field(table.unpack(member)) end
  end
  if entry.options_of then solver_options(entry.options_of) end
  for _, sign in ipairs(entry.operators and { "add", "sub", "mul", "div", "pow" } or {}) do
    out(("---@operator %s(ambit.datum): ambit.%s"):format(sign, entry.class))
  end
  if entry.operators then out("---@operator unm: ambit." .. entry.class) end
  local owner = entry.class:gsub("%.", "_")
  if methods[1] or entry.elements then out(("local %s = {}"):format(owner)) end
  for _, member in ipairs(methods) do function_of(owner .. ":", member) end
  for _, p in ipairs(entry.elements and loaded "element" or {}) do element(p) end
end

local function print_types()
  out("---@meta ambit")
  out(("-- The Lua interface of Ambit %s for editors, printed by `ambit types`."):format(core.version))
  out "---@class ambit"
  for _, entry in ipairs(interface.list) do
    if not entry.class and entry[1]:find "^%a" and not interface.parameters(entry) then field(table.unpack(entry)) end
  end
  out "local ambit = {}"
  for _, entry in ipairs(interface.list) do
    if entry.class then
      class(entry)
    elseif entry[1]:find "^= " then
      if entry[3] ~= "" then out("---" .. plain(entry[3])) end
      out(("---@alias ambit.%s %s"):format(entry[1]:sub(3), typed(entry[2])))
    elseif interface.parameters(entry) then
      function_of("ambit.", entry)
    end
  end
  out "return ambit"
end

-- A table for a page: the members that have a sentence.
local function print_markdown(entry)
  print(("| %s | |\n|---|---|"):format(entry.class:find "%.request$" and "key" or "of the result"))
  for _, member in ipairs(interface.members(entry)) do
    local name = interface.parameters(member) and ":" .. member[1] or interface.name(member)
    local choices = member[2]:find '^"[^<({]*"$' and "`" .. member[2]:gsub("|", "`, `") .. "`: " or ""
    if member[3] ~= "" then print(("| `%s` | %s%s |"):format(name, choices, member[3])) end
  end
end

function command.run(words)
  if #words == 0 then return print_types() or 0 end
  if words[1] ~= "--markdown" or #words ~= 2 then return 2, ("unexpected `%s`"):format(words[1]) end
  local entry = interface.classes[words[2]]
  if not entry or not entry.class then return 2, ("there is no class `%s`"):format(words[2]) end
  return print_markdown(entry) or 0
end

return command
