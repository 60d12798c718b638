-- scene.lua -- running a script the way `lua` would: its words in `arg`, errors with a traceback of the script's own
-- lines.
local code = require "ambit.code"
local core = require "ambit.core"
local provenance = require "ambit.provenance"
local sandbox = require "ambit.command.sandbox"
local session = require "ambit.session"

local scene = {
  leave = {}, -- raised where os.exit may not end the process
}

-- Lines of the traceback that a user can do something about: not Ambit's own, not the command's.
local function readable(trace)
  local lines = {}
  for line in trace:gmatch "[^\n]+" do
    if not line:find("(ambit) ", 1, true) and not line:find("[C]: in", 1, true) and not line:find("^%s*%[C%]") then
      lines[#lines + 1] = line
    end
  end
  return #lines > 1 and table.concat(lines, "\n") or nil
end

local function explain(message)
  if message == scene.leave then return message end
  if type(message) ~= "string" then
    local meta = getmetatable(message)
    message = meta and meta.__tostring and tostring(message) or ("error object: " .. type(message))
  end
  local found, hint = pcall(function() return require "ambit.command.hint"(message) end)
  if found and hint then message = message:gsub("^[^\n]*", function(line) return line .. ": " .. hint end) end
  local trace = readable(debug.traceback("", 2))
  return trace and message .. "\n" .. trace or message
end

-- Is this the error of an allocation that failed, of Lua's or of Ambit's?
local function is_memory(problem)
  return type(problem) == "string" and (problem:find "^not enough memory" or problem:find "^[^\n]*out of memory")
end

-- Loads and runs file with the given words; false and the message with traceback if that fails.
function scene.run(file, words)
  _G.arg = table.move(words, 1, #words, 1, { [0] = file })
  local wall = sandbox.enter()
  if wall then return false, wall end
  local chunk, problem = provenance.load(file, sandbox.environment())
  if not chunk then return false, problem end
  local good
  good, problem = xpcall(chunk, explain, table.unpack(words))
  if not good and is_memory(problem) then core.blame_memory() end
  return good, problem
end

scene.explain = explain

-- os.exit for a command: the exit code is what finish(asked) says, asked being what was asked for. The system keeps 8
-- bits: a multiple of 256 would become 0, which nobody asked for.
function scene.leave_by(finish)
  return function(asked)
    if asked == nil or asked == true then asked = 0 elseif asked == false then asked = 1 end
    if math.type(asked) ~= "integer" then error("os.exit: expected true, false or a whole number", 2) end
    if asked ~= 0 and asked % 256 == 0 then asked = 1 end
    core.leave(finish(asked))
  end
end

-- Verbs may still run in finalisers while Lua closes: they can make the exit code worse, too. tell(exit, code): it is.
function scene.watch_finalisers(exit, worst, tell)
  function session.closing(ended)
    if exit ~= code.exit(worst) or not code.is_worse(ended, worst) then return end
    exit, worst = code.exit(ended), ended
    tell(exit, ended)
    core.leave_with(exit)
  end
end

-- With the records on stdout, what the scene prints must not get between them.
function scene.print_to_stderr()
  io.output(io.stderr)
  function _G.print(...)
    local words = table.pack(...)
    for i = 1, words.n do words[i] = tostring(words[i]) end
    io.stderr:write(table.concat(words, "\t"), "\n")
  end
end

-- What every command does before it runs a scene: nil, or what is wrong with the options. about: as sandbox.begin.
function scene.prepare(options, about) return sandbox.begin(options, about) end

-- For a scene that is only looked at: what it prints goes nowhere, and os.exit ends the scene, not the command, with
-- the error scene.leave. Returns a function that gives the command its output back.
function scene.discard_output()
  local null = io.open("/dev/null", "w")
  local stdout = io.stdout
  local library = _G.io -- the scene's
  io.output(null)
  _G.print = function() end
  library.stdout = null
  _G.os.exit = function() error(scene.leave, 0) end
  return function() library.stdout = stdout io.output(stdout) end
end

local function unknown_option(word, name, known)
  local names = {}
  for key in pairs(known) do names[#names + 1] = key end
  table.sort(names)
  local near = name and core.nearest(name, names)
  return ("unknown option `%s`%s"):format(word, near and ("; did you mean `--%s`?"):format(near) or "")
end

-- Reads the option at list[i]: its name, its value (true if it takes none), the next i; or nil and a message. `known`
-- says which options take a value; "list": each time they are given.
local function read_option(list, i, known)
  local name, value = list[i]:match "^%-%-([%w-]+)=?(.*)$"
  if known[name] == nil then return nil, unknown_option(list[i], name, known) end
  if not known[name] then return name, true, i + 1 end
  if value ~= "" then return name, value, i + 1 end
  if not list[i + 1] then return nil, ("option `--%s` needs a value"):format(name) end
  return name, list[i + 1], i + 2
end

-- Splits { options..., SCENE, words... } into options, file, words; or nil and a message. With `anywhere`, options may
-- stand behind the scene too, up to `--`; with `optional`, there may be no scene: then file is nil.
function scene.arguments(list, known, anywhere, optional)
  local options, words, i = {}, {}, 1
  local taking = true
  while list[i] do
    if taking and list[i]:sub(1, 2) == "--" then
      if list[i] == "--" then
        taking, i = false, i + 1
      else
        local name, value, after = read_option(list, i, known)
        if not name then return nil, value end
        if known[name] == "list" then
          value = table.move({ value }, 1, 1, #(options[name] or {}) + 1, options[name] or {})
        end
        options[name], i = value, after
      end
    else
      words[#words + 1], i = list[i], i + 1
      taking = taking and (anywhere or false)
    end
  end
  if #words == 0 and not optional then return nil, "expected a scene, a Lua file" end
  return options, words[1], table.move(words, 2, #words, 1, {})
end

-- A word of the scene that looks like an option of the command was hardly meant for the scene.
function scene.note_strays(words, known)
  for _, word in ipairs(words) do
    local name = word:match "^%-%-([%w-]+)"
    if name and known[name] ~= nil then
      io.stderr:write(("note: `--%s` stands behind the scene and is a word for it; options of ambit go before\n")
        :format(name))
    end
  end
end

return scene
