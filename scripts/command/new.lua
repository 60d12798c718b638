-- new.lua -- `ambit new`: a directory with a plugin to start from. The texts are scripts/skeleton.
local check = require "ambit.check"
local core = require "ambit.core"
local skeletons = require "ambit.command.skeletons"

local command = {}

command.usage = [[
usage: ambit new arithmetic|element|solver NAME [DIR]
Writes NAME.c, a small plugin that works, CMakeLists.txt, Makefile and README.md into DIR (default NAME). It builds with
nothing but an installed Ambit, and passes `ambit check`. Files that are there already are never overwritten.
exit: 0 written, 1 nothing written]]

local kinds = { "arithmetic", "element", "solver" }

local function complain(format, ...)
  io.stderr:write("ambit: ", format:format(...), "\n")
  return 1
end

-- nil, or what is wrong with the name of a new plugin
local function problem_of(kind, name)
  if not name:find "^%l[%l%d_]*$" or #name > 63 then
    return ("`%s` cannot be the name of a plugin: small letters, digits and `_`, a letter first, at most 63")
      :format(name)
  end
  for _, entry in ipairs(core.list()) do
    if entry.kind == kind and entry.name == name then
      return ("there is a plugin %s.%s already: %s"):format(kind, name, entry.file)
    end
  end
end

local uses = {
  arithmetic = ": `arithmetic = \"@NAME@\"`",
  element = ": `m:@NAME@ { ... }`",
  solver = ": `solver = \"@NAME@\"`",
}

local function fill(text, kind, name)
  text = text:gsub("@USE@", uses[kind]):gsub("@KIND@", kind):gsub("@NAME@", name)
  return (text:gsub("%f[%w_]skeleton%f[^%w_]", name))
end

-- { { file name, text }, ... }
local function files_of(kind, name)
  local files = {}
  for _, path in ipairs(check.sorted(skeletons)) do
    local folder, file = path:match "^(%w+)/(.+)$"
    if folder == kind or folder == "any" then
      files[#files + 1] = { (file:gsub("^skeleton%.", name .. ".")), fill(skeletons[path], kind, name) }
    end
  end
  return files
end

local function exists(path)
  local file = io.open(path)
  if file then file:close() end
  return file ~= nil
end

local function make_directory(path) return os.execute("mkdir -p -- '" .. path:gsub("'", "'\\''") .. "'") end

local function write(path, text)
  local file, problem = io.open(path, "w")
  local good = file
  if file then
    good, problem = file:write(text)
    local closed, late = file:close()
    if good and not closed then good, problem = nil, late end
  end
  return good ~= nil, problem
end

function command.run(words)
  for _, word in ipairs(words) do
    if word:sub(1, 1) == "-" then return 2, ("unknown option `%s`"):format(word) end
  end
  local kind, name, directory = words[1], words[2], words[3]
  if not kind or not name or words[4] then return 2, "expected a kind, a name and perhaps a directory" end
  if not skeletons[kind .. "/skeleton.c"] then
    return 2, ("there is no skeleton of kind `%s`%s"):format(kind, check.suggest(kind, kinds))
  end
  local problem = problem_of(kind, name)
  if problem then return complain("%s", problem) end
  directory = directory or name
  local files = files_of(kind, name)
  for _, file in ipairs(files) do
    local path = directory .. "/" .. file[1]
    if exists(path) then return complain("%s exists already; nothing was written", path) end
  end
  if not make_directory(directory) then return complain("cannot make the directory %s", directory) end
  for _, file in ipairs(files) do
    local good, why = write(directory .. "/" .. file[1], file[2])
    if not good then return complain("%s", why) end
    print(directory .. "/" .. file[1])
  end
  print(("next: cd %s && make && make check"):format(directory))
  return 0
end

return command
