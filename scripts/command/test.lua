-- test.lua -- `ambit test`: busted as a library, inside this command.
local core = require "ambit.core"
local limits = require "ambit.command.limits"
local sandbox = require "ambit.command.sandbox"
local scene = require "ambit.command.scene"

local command = { scene = true }

command.usage = [[
usage: ambit test [LIMITS] [PATH ...] [-- BUSTED-OPTION ...]
Runs the *_spec.lua files in the given files and directories (default: tests) with busted; `require "ambit"` is this
command's own.
]] .. sandbox.usage .. "\n" .. limits.usage .. [[

exit: 0 all passed, 1 some failed or there was none, 5 a limit was reached]]

local missing = [[
ambit: the test runner "busted" is not installed for Lua 5.4
  Debian, Ubuntu: apt install lua-busted
  LuaRocks:       luarocks install busted
]]

-- Exit code 0 says that all tests ran: a spec cannot leave with it.
local function refuse_exit()
  io.stderr:write "ambit: os.exit in a spec ended the suite: what stands behind it did not run\n"
  core.leave(1)
end

-- Counts the tests that ended in the run that is about to begin: busted itself calls a suite of none passed.
local function count_tests(foreign)
  local open, counted = foreign.find "busted.core", { tests = 0 }
  package.loaded["busted.core"] = function()
    local busted = open()
    busted.subscribe({ "test", "end" }, function()
      counted.tests = counted.tests + 1
      return nil, true
    end)
    return busted
  end
  return counted
end

-- { path or option of busted, ... }, whether it lists only; or nil and what is wrong. Sets the limits.
local function arguments(words)
  local own, list, rest, listing = {}, {}, nil, false
  for _, word in ipairs(words) do
    if rest then
      rest[#rest + 1] = word
      listing = listing or word == "--list"
    elseif word == "--" then
      rest = {}
    else
      own[#own + 1] = word
    end
  end
  local options, first, others = scene.arguments(own, sandbox.with {}, true, true)
  if not options then return nil, first end
  list[1] = first or "tests"
  table.move(others, 1, #others, 2, list)
  if options.sandbox then
    options["allow-read"] = table.move(list, 1, #list, #(options["allow-read"] or {}) + 1, options["allow-read"] or {})
  end
  local wrong = scene.prepare(options, { is_open = true })
  if wrong then return nil, wrong end
  return table.move(rest or {}, 1, #(rest or {}), #list + 1, list), listing
end

function command.run(words)
  local list, listing = arguments(words)
  if not list then return 2, listing end
  local foreign = require "ambit.foreign"
  local compatibility = foreign.find "busted.compatibility"
  if compatibility then compatibility.exit = function(code) core.leave(code == 0 and 0 or 1) end end
  local runner = foreign.find "busted.runner"
  if not runner then
    io.stderr:write(missing)
    return 1
  end
  table.insert(list, 1, "--pattern=_spec%.lua$")
  list[0] = "ambit test"
  _G.arg = list
  _G.os.exit = refuse_exit
  local counted = count_tests(foreign)
  local wall = sandbox.enter()
  if wall then return 2, wall end
  runner { standalone = false } -- leaves by the function above if anything failed
  if counted.tests > 0 or listing then return 0 end
  io.stderr:write "ambit: no test ran: there is none in the files given, or an option of busted left all out\n"
  return 1
end

return command
