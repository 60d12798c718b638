-- What a stranger's scene may try in a sandbox: { name, code }, where the code must not return a true value; and bombs,
-- which must end by a limit. CANARY is a file with a secret, FOLDER its folder, ALLOWED a file that may be read.
local escapes = { attempts = {}, bombs = {} }

local function add(name, code, ...)
  escapes.attempts[#escapes.attempts + 1] = { name, select("#", ...) > 0 and code:format(...) or code }
end

-- -- files

local paths = { "CANARY", "FOLDER/x/../canary", "/etc/passwd", "/etc/shadow", "/proc/self/environ", "/proc/self/mem",
  "/proc/self/maps", "/proc/self/fd/0", "/dev/stdin", "/dev/fd/0", "FOLDER/link", "ALLOWED/../canary", "ALLOWED\\0x",
  "ALLOWEDx", "//etc/passwd", "/./etc/passwd" }
for _, path in ipairs(paths) do
  add("open " .. path, 'return io.open("%s")', path)
  add("lines of " .. path, 'for _ in io.lines("%s") do return true end', path)
  add("loadfile " .. path, 'return loadfile("%s")', path)
  add("dofile " .. path, 'dofile("%s") return true', path)
end
for _, mode in ipairs { "w", "a", "r+", "w+", "a+", "wb", "r+b" } do
  add("open a new file, " .. mode, 'return io.open("FOLDER/made", "%s")', mode)
  add("open what may be read, " .. mode, 'return io.open("ALLOWED", "%s")', mode)
end
add("open a name that is none", 'return io.open({})')
add("a name that changes its mind", [[local n = 0
  return io.open(setmetatable({}, { __tostring = function() n = n + 1 return n > 1 and "CANARY" or "ALLOWED" end }))]])
add("write by a file that may be read", 'local f = io.open("ALLOWED") return f:write "x" and f:flush()')
add("standard input", "return io.read and io.read(0)")
add("io.input", 'return io.input "CANARY"')
add("io.output", 'return io.output "FOLDER/made"')
add("another standard stream", "return io.stdin")

-- -- functions and libraries

for _, call in ipairs { 'io.popen "id"', "io.tmpfile()", 'os.execute "id"', "os.execute()", 'os.remove "CANARY"',
  'os.rename("CANARY", "FOLDER/made")', "os.tmpname()", 'os.setlocale "C"', 'os.getenv "HOME"', 'os.getenv "PATH"',
  'string.dump(print)', 'debug.getregistry()', 'debug.getinfo(1, "f")', "debug.getlocal(1, 1)",
  "debug.getupvalue(require, 1)", "debug.setupvalue(require, 1, 1)", "debug.sethook(print, '', 1)", "debug.gethook()",
  'debug.getmetatable ""', 'debug.setmetatable("", {})', "debug.getuservalue(io.stdout, 1)",
  "debug.upvalueid(require, 1)", "debug.upvaluejoin(require, 1, print, 1)", "debug.debug()", "package.loaded",
  'package.loadlib("libc.so.6", "*")', "package.searchers", "package.preload", 'warn "@on"', 'collectgarbage "stop"',
  'collectgarbage("setpause", 1000)', 'collectgarbage("generational")' } do
  add(call, "return %s", call)
end
for _, name in ipairs { "ambit.core", "ambit.session", "ambit.foreign", "ambit.check", "ambit.command.main",
  "ambit.command.sandbox", "ambit.provenance", "os", "io", "debug", "package", "string", "_G", "lxp", "cjson", "posix",
  "ffi", "busted", "hostile", "ambit.run" } do
  add("require " .. name, 'return require "%s"', name)
end
add("require a name that changes its mind", [[
  return require(setmetatable({}, { __eq = function() return true end, __tostring = function() return "ambit" end }))]])

-- -- bytecode

add("load of bytecode", 'return load("\\27Lua" .. ("x"):rep(100))')
add("load of bytecode, mode b", 'return load("\\27Lua", "x", "b")')
add("load of a dumped function", "return load(string.dump(function() return 1 end))")
add("load of a function dumped by a method", 'return load((""):dump(function() return 1 end))')
add("load of bytecode in parts", [[local n, parts = 0, { "\27", "Lua", "T" }
  return load(function() n = n + 1 return parts[n] end)]])
add("loadfile of bytecode", 'return loadfile("FOLDER/bytecode")')

-- -- globals and environments

add("globals through load", 'return load "return package or debug.getregistry or io.popen"() == io.popen and package')
add("globals through an environment", "return load('return _ENV', 'x', 't', nil)().package")
add("globals through a function's environment", "return (function() return _ENV end)().package")
add("globals through a coroutine", "return coroutine.wrap(function() return _G.package end)()")
add("globals through xpcall", 'return select(2, xpcall(error, function() return _G.package end, "x"))')
add("globals through a finaliser", [[local found
  setmetatable({}, { __gc = function() found = _G.package end }) collectgarbage() return found]])
add("globals through __index", "return setmetatable({}, { __index = _G }).package")
add("globals of Ambit through a law", [[local ambit, found = require "ambit", nil
  ambit.ode { states = { "x" }, equations = function(s) found = _ENV.package return { x = -s.x } end } return found]])
add("globals of Ambit through a chunk called as its own",
  "return load('return package', '=(ambit) x')() or load('return package', '(ambit) x')()")
add("the name of a chunk", [[local _, problem = pcall(load('error("x", 1)', "=(ambit) x"))
  return problem:find("(ambit)", 1, true) == 1]])

-- -- metatables, and what Ambit's modules use

add("the metatable of texts", 'return getmetatable("")')
add("methods of texts", 'getmetatable("").__index.format = print return true')
add("methods of texts, by assignment", 'local s = "x" s.format = print return true')
add("a metatable of Ambit's run", [[local ambit = require "ambit"
  local o = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
  return getmetatable(ambit.simulate { o, initial = { 1 }, t = 1 })]])
for _, value in ipairs { 'ambit.mechanism "m"', 'ambit.number "1"', "ambit.interval(0, 1)", "ambit.mechanism().world",
  'ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }' } do
  add("the metatable of " .. value, 'local ambit = require "ambit" return getmetatable(%s)', value)
  add("another metatable for " .. value, 'local ambit = require "ambit" return setmetatable(%s, {})', value)
end
add("the metatable of a file", "return getmetatable(io.stdout)")
add("the metatable of io", "return getmetatable(io)")
add("another metatable of io", "return setmetatable(io, {})")
add("Ambit's own table.move", [[local ambit, seen = require "ambit", false
  table.move = function() seen = true end
  ambit.evaluate { { ambit.number "1", ambit.number "2" } } return seen]])
add("Ambit's own string.format", [[local ambit, seen = require "ambit", false
  string.format = function() seen = true return "" end
  tostring(ambit.interval(0, 1)) pcall(ambit.evaluate, {}) return seen]])
add("Ambit's own pairs", [[local ambit, seen = require "ambit", false
  pairs = function() seen = true end -- luacheck: ignore
  ambit.mechanism "m" return seen]])

-- -- files and plugins through Ambit

add("trust", 'return require "ambit".trust { "FOLDER" } == nil')
add("a plugin's functions", 'return require "ambit".plugin("service", "digest")')
add("load of a robot", 'return require "ambit".load { "/etc/passwd" }')
add("load of a robot that is Lua", 'return require "ambit".load { "FOLDER/canary.lua" }')
add("load into a mechanism", 'return require "ambit".mechanism "m":load { "CANARY" }')
add("where a robot's error quotes the file", [[local _, problem = pcall(require "ambit".load, { "CANARY" })
  return tostring(problem):find("secret", 1, true)]])
local model = [[local ambit = require "ambit"
  local o = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = -s.x, y = s.x - s.y } end }
  local r = ambit.reduce { o, t = { 0, 1 }, initial = { x = 1, y = 0 }, outputs = { "y" }, error = { y = 1 } }
  ]]
add("the picture of a reduction", model .. 'r:picture("FOLDER/made") return true')
add("the JSON of a reduction", model .. 'r:json("FOLDER/made") return true')
add("a list of plugins that is believed", [[local ambit = require "ambit"
  for _, entry in ipairs(ambit.plugins()) do entry.file = "FOLDER/canary.so" end
  local o = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
  return ambit.simulate { o, initial = { 1 }, t = 1 }.solver == "canary"]])

-- -- bombs

for name, code in pairs {
  ["a loop"] = "while true do end",
  ["a loop in pcall"] = "while true do pcall(error) end",
  ["a loop in a coroutine"] = "while true do coroutine.wrap(function() end)() end",
  ["a loop in a finaliser"] = "setmetatable({}, { __gc = function() while true do end end }) collectgarbage()",
  ["an error that is a loop"] = "error(setmetatable({}, { __tostring = function() while true do end end }))",
  ["a pattern"] = 'string.find(("a"):rep(40), ("a?"):rep(40) .. ("a"):rep(40)) while true do end',
  ["a pattern that backs off"] = 'return string.find(("a"):rep(30000), ".-.-.-.-b")',
  ["a sort"] = "local t = {} for i = 1, 1e6 do t[i] = i end while true do table.sort(t, function() return math.random() < .5 end) end",
  ["a sort that never agrees"] = "while true do pcall(table.sort, { 3, 2, 1, 4, 5, 6, 7, 8, 9 }, function() return true end) end",
  ["a move"] = "return table.move({}, 1, 1e12, 2)",
  ["a concatenation"] = 'local s = "x" while true do s = s .. s end',
  ["a repetition"] = 'local t = {} for i = 1, 1e9 do t[i] = ("x"):rep(1e6) .. i end',
  ["a table"] = "local t = {} for i = 1, 1e12 do t[i] = i end",
  ["a table of tables"] = "local t = {} while true do t = { t, {} , {} } end",
  ["coroutines"] = "local t = {} while true do t[#t + 1] = coroutine.create(function() end) end",
  ["closures"] = "local f = print while true do local g = f f = function() return g end end",
  ["a line that is printed for ever"] = 'while true do print(("x"):rep(1000)) end',
  ["a word that is written for ever"] = 'while true do io.write "x" end',
  ["errors that are written for ever"] = 'while true do io.stderr:write(("y"):rep(1000)) end',
  ["an expression that grows"] = [[local ambit = require "ambit" local e = ambit.between(1, 2)
    while true do e = ambit.sin(e) + ambit.cos(e * e) end]],
  ["an expression of all levels"] = [[local ambit = require "ambit" local e = ambit.between(1, 2)
    while true do local t = ambit.evaluate { e, arithmetic = { "mpfr", precision = 4000 } } e = e * e + 1 end]],
  ["draws"] = [[local ambit = require "ambit" ambit.sample { ambit.sin(ambit.between(0, 1)), n = 2 ^ 31 - 1 }]],
  ["a run that does not end"] = [[local ambit = require "ambit"
    local o = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -ambit.sin(s.x) } end }
    ambit.simulate { o, initial = { 1, 0 }, t = 1e12, solver = "lohner", step_max = 1e-3 }]],
  ["a run that keeps everything"] = [[local ambit = require "ambit"
    local o = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }
    while true do ambit.simulate { o, initial = { 1, 0 }, t = { 0, 100 }, dense = true, solver = "lohner" } end]],
  ["roots"] = [[local ambit = require "ambit" while true do
    ambit.roots { function(s) return { ambit.sin(s.x * 100) - s.y, s.x ^ 2 - s.y ^ 3 } end, box = { x = { -50, 50 }, y = { -50, 50 } } } end]],
  ["a decimal"] = 'local ambit = require "ambit" while true do ambit.number(("1"):rep(1e5) .. "e-" .. ("9"):rep(8)) end',
} do
  escapes.bombs[#escapes.bombs + 1] = { name, code }
end
table.sort(escapes.bombs, function(a, b) return a[1] < b[1] end)

return escapes
