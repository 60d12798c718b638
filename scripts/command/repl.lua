-- repl.lua -- `ambit repl`: an interval calculator and a place to build mechanisms, with the module `ambit` at hand.
local ambit = require "ambit"
local code = require "ambit.code"
local core = require "ambit.core"
local scene = require "ambit.command.scene"
local session = require "ambit.session"

local command = {}

command.usage = [[
usage: ambit repl
Reads Lua. An expression prints its value, with or without `=` in front: `= ambit.sin(ambit.interval(0, 1))`. The
functions of `ambit` are also known without its name: `sqrt(interval "[2, 3]")`. Line editing works if the rock
`readline` is installed. Ctrl-D leaves.
exit: 0; if the input is not a terminal 1 after an error, else as `ambit run`.]]

-- Globals first, then the functions of ambit.
local function environment()
  return setmetatable({ ambit = ambit }, { __index = function(_, key)
    local value = _G[key]
    if value == nil then value = ambit[key] end
    return value
  end })
end

local function reader()
  local readline = require "ambit.foreign".find "readline"
  if readline and core.terminal "stdin" then return function(prompt) return readline.readline(prompt) end end
  local interactive = core.terminal "stdin"
  return function(prompt)
    if interactive then io.stdout:write(prompt) io.stdout:flush() end
    return io.read "L"
  end
end

-- An expression that depends on nothing unknown is also shown as the set it is.
local function show(value)
  local text = tostring(value)
  if getmetatable(value) == "ambit.expression" then
    local before = session.worst -- what is only shown was no question
    local good, x = pcall(function() return ambit.evaluate { value } end)
    session.worst = before
    if good and tostring(x) ~= text then text = text .. "  in " .. tostring(x) end
  end
  return text
end

local function print_results(results)
  if results.n == 0 then return end
  local list = {}
  for i = 1, results.n do list[i] = show(results[i]) end
  print(table.concat(list, "\t"))
end

local function compile(text, env)
  local chunk = load("return " .. text:gsub("^%s*=", ""), "=stdin", "t", env)
  if chunk then return chunk end
  return load(text, "=stdin", "t", env)
end

local function is_unfinished(problem) return problem and problem:find("<eof>", 1, true) ~= nil end

local function run(chunk)
  local results = table.pack(xpcall(chunk, scene.explain))
  if not results[1] then
    io.stderr:write(tostring(results[2]), "\n")
    return false
  end
  print_results { n = results.n - 1, table.unpack(results, 2, results.n) }
  return true
end

-- One chunk, over several lines if needed: nil at the end of the input.
local function read_chunk(read, env)
  local text = read "> "
  if not text then return nil end
  while true do
    local chunk, problem = compile(text, env)
    if chunk then return chunk end
    if not is_unfinished(problem) then return function() error(problem, 0) end end
    local more = read ">> "
    if not more then return function() error(problem, 0) end end
    text = text .. "\n" .. more
  end
end

function command.run(words)
  if words[1] then return 2, ("unexpected `%s`"):format(words[1]) end
  local env, read = environment(), reader()
  local interactive = core.terminal "stdin"
  local failed = false
  local function exit()
    if interactive then return 0 end
    if not failed then
      scene.watch_finalisers(code.exit(session.worst), session.worst, function(_, ended)
        io.stderr:write("ambit: ", ended, " in a finaliser at the end\n")
      end)
    end
    return failed and 1 or code.exit(session.worst)
  end
  _G.os.exit = scene.leave_by(function(asked) return asked ~= 0 and asked or exit() end)
  if interactive then print(("ambit %s; Ctrl-D leaves"):format(ambit.version)) end
  for chunk in function() return read_chunk(read, env) end do
    if not run(chunk) then failed = true end
  end
  if interactive then print() end
  return exit()
end

return command
