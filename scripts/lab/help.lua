-- help.lua -- ambit.help(name): the manual of a function, of what it gives, or of a plugin.
local check = require "ambit.check"
local interface = require "ambit.interface"
local manual = require "ambit.manual"

local WIDTH = 118

local function plain(text) return (text:gsub("%[([^%]]-)%]%([^)]-%)", "%1")) end -- links are for pages

local function wrapped(text, indent)
  local lines, line = {}, ""
  for word in plain(text):gmatch "%S+" do
    if #indent + #line + #word >= WIDTH then lines[#lines + 1], line = line, "" end
    line = line == "" and word or line .. " " .. word
  end
  lines[#lines + 1] = line
  return indent .. table.concat(lines, "\n" .. indent)
end

local function signature(member)
  local gives = member[2] ~= "" and member[1]:find "%(" and " -> " .. member[2] or ""
  return member[1] .. gives
end

local function describe(lines, members)
  for _, member in ipairs(members) do
    local is_function = member[1]:find "%("
    lines[#lines + 1] = is_function and "  :" .. signature(member) or ("  %-14s %s"):format(member[1], member[2])
    if member[3] ~= "" then lines[#lines + 1] = wrapped(member[3], (" "):rep(17)) end
  end
end

-- The class that a type names, if it is one.
local function class_of(text)
  local found
  interface.types(text or "", function(word)
    local class = interface.classes[word]
    if class.class and #class > 0 then found = found or class end
  end)
  return found
end

local function describe_class(lines, title, class)
  lines[#lines + 1] = ""
  lines[#lines + 1] = title
  if class.doc ~= "" then lines[#lines + 1] = wrapped(class.doc, "  ") end
  describe(lines, interface.members(class))
  local verb = interface.options_of(class)
  if not verb then return end
  lines[#lines + 1] = ('  and the options of its solver: help "%s"'):format(verb == "roots" and "krawczyk" or "lohner")
end

local function of_function(entry)
  local lines = { "ambit." .. signature(entry) }
  if entry[3] ~= "" then lines[#lines + 1] = wrapped(entry[3], "") end
  local given, asked = class_of(entry[2]), nil
  for _, parameter in ipairs(interface.parameters(entry) or {}) do
    local class = class_of(parameter[2])
    if class and class.class:find "%.request$" then asked = class end
    if parameter[2]:find "layer" then asked = class end
  end
  if asked then describe_class(lines, "keys", asked) end
  if given then describe_class(lines, ("what it gives (%s)"):format(entry[2]), given) end
  return table.concat(lines, "\n")
end

local function of_class(name, class)
  if not class.class then return ("ambit.%s: %s\n%s"):format(name, class[2], wrapped(class[3], "")) end
  local lines = {}
  describe_class(lines, "ambit." .. name, class)
  return table.concat(lines, "\n", 2)
end

-- help() lists the topics, help(name) returns a text.
return function(name)
  if name == nil then
    return "topics: " .. table.concat(check.sorted(interface.functions), ", ")
      .. "\nand what they are given and give: " .. table.concat(check.sorted(interface.classes), ", ")
      .. "\nand every plugin: see ambit.plugins()"
  end
  check.text(name, "help: name")
  if interface.functions[name] then return of_function(interface.functions[name]) end
  local text, problem = manual.named(name)
  if text then return text end
  if interface.classes[name] then return of_class(name, interface.classes[name]) end
  check.fail("help: there is no topic and no plugin of that name: %s", problem)
end
