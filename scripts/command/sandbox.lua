-- sandbox.lua -- `--sandbox`: the scene is a stranger's. Two walls, each of which holds by itself: the scene sees an
-- environment without files, processes, bytecode and Ambit's inside; and the process is shut in by the system
-- (plugins/service/sandbox), so that what gets through the first wall finds nothing behind it. docs/sandbox.md
local core = require "ambit.core"
local limits = require "ambit.command.limits"
local provenance = require "ambit.provenance"

local sandbox = {}

sandbox.usage = [[
  --sandbox        the scene is a stranger's: no files, processes, network, bytecode, debug library; limits are 10 s,
                   512M and 10M unless given
  --allow-read PATH
                   a file or folder that it may read all the same; may be repeated]]

-- The options of a command, with these and those of limits.lua.
function sandbox.with(known)
  known.sandbox, known["allow-read"] = false, "list"
  return limits.with(known)
end

local defaults = { time = "10", memory = "512M", output = "10M" }

-- -- which files

local function folder_of(file) return file:match "^(.*)/[^/]*$" or "." end

-- What a computation reads: shared libraries and modules, time zones, how many processors there are, and itself.
local system = { "/lib", "/lib32", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache",
  "/usr/share/lua", "/usr/local/share/lua", "/usr/share/zoneinfo", "/etc/localtime", "/dev/urandom",
  "/sys/devices/system/cpu", "/proc/self", "/proc/self/exe", "/proc/meminfo" }

local function plugin_folders(list)
  local known = {}
  for _, entry in ipairs(core.list()) do
    local folder = folder_of(entry.file)
    if not known[folder] then known[folder], list[#list + 1] = true, folder end
  end
end

-- -- the scene's environment

local allowed = {} -- what --allow-read names, and the scene itself

-- May a scene read it? A path that steps back could lead out of a folder that is allowed.
local function is_allowed(path)
  if type(path) ~= "string" or ("/" .. path .. "/"):find("/../", 1, true) or path:find("\0", 1, true) then
    return false
  end
  for _, name in ipairs(allowed) do
    local within = name:sub(-1) == "/" and name or name .. "/"
    if path == name or path:sub(1, #within) == within then return true end
  end
  return false
end

local function refuse(name) error(name .. ": not in a sandbox", 3) end

local function denied(name) return function() refuse(name) end end

-- A copy of a library with the functions named, and a clear error for all others that the library has.
local function only(library, name, names)
  local copy = {}
  for _, key in ipairs(names) do copy[key] = library[key] end
  for key, value in pairs(library) do
    if copy[key] == nil and type(value) == "function" then copy[key] = denied(name .. "." .. key) end
  end
  return copy
end

local function without(library, name, key)
  local copy = {}
  for k, value in pairs(library) do copy[k] = value end
  copy[key] = denied(name .. "." .. key)
  return copy
end

-- The functions of the Lua state's own globals are taken when they are called: a command replaces some of them.
local function later(library, name) return function(...) return library[name](...) end end

local open = io.open

local function open_to_read(name, mode)
  mode = mode or "r"
  if not is_allowed(name) or not tostring(mode):find "^rb?$" then
    return nil, ("%s: not in a sandbox, but for what --allow-read names, to read"):format(tostring(name)), 13
  end
  return open(name, mode)
end

local function read_all(name)
  local file, problem = open_to_read(name, "rb")
  if not file then return nil, problem end
  local text = file:read "a"
  file:close()
  return text
end

local function files()
  local library = only(io, "io", { "write", "type" })
  library.open = open_to_read
  library.lines = function(name, ...)
    local file, problem = open_to_read(name)
    if not file then error(problem, 2) end
    return file:lines(...)
  end
  library.write = later(io, "write")
  return setmetatable(library, { __metatable = false, __index = function(_, key)
    if key == "stdout" or key == "stderr" then return io[key] end
  end })
end

local function process()
  local library = only(os, "os", { "time", "clock", "date", "difftime" })
  library.exit, library.getenv = later(os, "exit"), function() return nil end
  return library
end

-- Ambit's own values keep their metatables to themselves, and the scene's are known.
local function metatables(env)
  local own, get, set = setmetatable({}, { __mode = "k" }), getmetatable, setmetatable
  function env.getmetatable(value)
    local meta = get(value)
    if meta == nil or (type(meta) == "table" and own[meta]) then return meta end
    return false
  end
  function env.setmetatable(value, meta)
    local old = type(value) == "table" and get(value)
    if old and not (type(old) == "table" and own[old]) then error("setmetatable: a value of Ambit's", 2) end
    if type(meta) == "table" then own[meta] = true end
    return set(value, meta)
  end
end

local function loaders(env)
  local compile = load
  function env.load(chunk, name, mode, own)
    if type(chunk) == "function" then
      local parts = {}
      for part in chunk do
        if part == "" then break end
        parts[#parts + 1] = part
      end
      chunk = table.concat(parts)
    end
    if mode ~= nil and mode ~= "t" and mode ~= "bt" then return nil, "load: bytecode: not in a sandbox" end
    -- a chunk is never called as one of Ambit's own (plugins and modules are, by "(ambit)")
    name = "@" .. tostring(name or "load"):gsub("^[@=]", ""):gsub("%(ambit%)", "ambit")
    return compile(chunk, name, "t", own == nil and env or own)
  end
  function env.loadfile(name, mode, own)
    local text, problem = read_all(name)
    if not text then return nil, problem end
    return env.load(text, "@" .. name, mode, own)
  end
  function env.dofile(name)
    local chunk, problem = env.loadfile(name)
    if not chunk then error(problem, 2) end
    return chunk()
  end
end

local function modules(env)
  local ambit
  function env.require(name)
    if name ~= "ambit" then refuse(("require %q"):format(tostring(name))) end
    if not ambit then
      ambit = {}
      for key, value in pairs(require "ambit") do ambit[key] = value end
      ambit.trust, ambit.plugin = denied "ambit.trust", denied "ambit.plugin"
    end
    return ambit
  end
end

local environment

local function make_environment()
  local env = { _VERSION = _VERSION, assert = assert, error = error, ipairs = ipairs, next = next, pairs = pairs,
    pcall = pcall, rawequal = rawequal, rawget = rawget, rawlen = rawlen, rawset = rawset, select = select,
    tonumber = tonumber, tostring = tostring, type = type, xpcall = xpcall, arg = _G.arg, print = later(_G, "print"),
    string = without(string, "string", "dump"), table = only(table, "table", { "concat", "insert", "move", "pack",
      "remove", "sort", "unpack" }), math = without(math, "math", ""), utf8 = without(utf8, "utf8", ""),
    coroutine = without(coroutine, "coroutine", ""), io = files(), os = process(),
    debug = only(debug, "debug", { "traceback" }), warn = denied "warn" }
  env.math[""], env.utf8[""], env.coroutine[""] = nil, nil, nil
  function env.collectgarbage(what)
    if what ~= nil and what ~= "collect" and what ~= "count" and what ~= "step" then refuse "collectgarbage" end
    return collectgarbage(what)
  end
  env._G = env
  metatables(env)
  loaders(env)
  modules(env)
  return env
end

-- What the scene sees as its globals; nil: there is no sandbox. `arg` is the command's by now.
function sandbox.environment()
  if environment then environment.arg = _G.arg end
  return environment
end

-- -- the two walls

local no_landlock = "note: this system has no Landlock: files are kept from the scene by Ambit alone\n"

local no_landlock_at_all = "--sandbox: this system has no Landlock, which this command needs"

local asked -- what sandbox.begin was told, until the process is shut in; nil: there is no sandbox

-- The files of plugins are read by Ambit's own modules (rules beside solvers), robots' files too: through one gate.
local function guard_files(folders)
  _G.io.open = function(name, mode)
    for _, folder in ipairs(folders) do
      if mode == nil and type(name) == "string" and folder_of(name) == folder then return open(name) end
    end
    return open_to_read(name, mode)
  end
end

local outputs = {} -- by name: what the command writes, and the scene does not

-- The command's own files, which may be more than the options name: `--plot` numbers them.
function sandbox.output(name) outputs[name] = true end

-- What verbs write when they are asked to (pictures, results) goes through one function.
local function guard_writing(about)
  for _, file in pairs(not about.is_late and about.outputs or {}) do sandbox.output(file) end
  local write = core.write_file
  core.write_file = function(name, text)
    if not outputs[name] then return ("%s: not in a sandbox"):format(tostring(name)) end
    return write(name, text)
  end
end

-- Shuts the process in, if that was asked for: right before the scene is run, when all that the command itself writes
-- while it runs is open. nil, or what stands in the way.
function sandbox.enter()
  if not asked then return nil end
  local about, folders, write = asked, {}, {}
  asked = nil
  plugin_folders(folders)
  local read = table.move(system, 1, #system, 1, {})
  table.move(folders, 1, #folders, #read + 1, read)
  table.move(allowed, 1, #allowed, #read + 1, read)
  for _, file in pairs(about.outputs or {}) do
    if file ~= "-" then write[#write + 1] = folder_of(file) end
  end
  local files_kept, problem = core.sandbox(read, write, about.children or false)
  if files_kept == nil then return "--sandbox: " .. problem end
  if about.is_open then return not files_kept and no_landlock_at_all or nil end
  if not files_kept then io.stderr:write(no_landlock) end
  environment = make_environment()
  guard_files(folders)
  guard_writing(about)
end

local function check_readable()
  for _, path in ipairs(allowed) do
    local file, problem = open(path)
    if not file then return ("option `--allow-read`: %s"):format(problem) end
    file:close()
  end
end

-- Reads the options, sets the limits; nil, or what is wrong. about: scene = its file, outputs = { files that the
-- command writes when the scene has run }, is_late: it names them by sandbox.output then, children: it forks; is_open:
-- what is run sees Ambit's own environment, so that the system alone keeps files from it.
function sandbox.begin(options, about)
  if not options.sandbox then
    return options["allow-read"] and "option `--allow-read` needs `--sandbox`" or limits.begin(options)
  end
  for name, value in pairs(defaults) do options[name] = options[name] or value end
  table.move(options["allow-read"] or {}, 1, #(options["allow-read"] or {}), 1, allowed)
  local wrong = check_readable()
  if wrong then return wrong end
  if about.scene then
    local text, problem = provenance.read(about.scene)
    if not text then return problem end
    allowed[#allowed + 1] = about.scene
  end
  asked = about
  return limits.begin(options)
end

return sandbox
