-- main.lua -- the command line: `ambit <command> ...` -> exit code. Data goes to stdout, everything else to stderr.
local core = require "ambit.core"
local provenance = require "ambit.provenance"
local scene = require "ambit.command.scene"

local commands = {
  { "run", "run a scene" },
  { "explain", "what a scene loads, builds and leaves out" },
  { "profile", "where the time of a scene goes" },
  { "compare", "error and width against run time over solvers and arithmetics" },
  { "stability", "stiff, chaotic and extreme cases: how far, how tight, at what cost, and why not" },
  { "view", "a page that shows mechanisms and their enclosures over time" },
  { "plugins", "list the plugins, or print the manual of one" },
  { "check", "put a plugin through the conformance kit" },
  { "new", "write the skeleton of a plugin" },
  { "test", "run scripted test suites (*_spec.lua)" },
  { "errors", "what the codes of outcomes mean" },
  { "types", "the interface for editors (LuaCATS)" },
  { "repl", "calculate and build interactively" },
}

local exit_codes = [[
exit codes: 0 done and proved, 1 script or input error, or a broken plugin, 2 wrong usage, 3 ran but could not prove,
4 proved that there is no answer, 5 a limit of the command line was reached, 130 interrupted]]

local trust_options = [[
options before the command, for plugins (AMBIT_PATH):
  --trust FOLDER   load plugins from this folder although others may write there; may be repeated
  --allow-shadow   a plugin may have the kind and name of one of Ambit's own, which it replaces
]]

local function overview()
  local lines = { "usage: ambit <command> [options]", "", "commands:" }
  for _, entry in ipairs(commands) do lines[#lines + 1] = ("  %-9s %s"):format(entry[1], entry[2]) end
  lines[#lines + 1] = ""
  lines[#lines + 1] = trust_options
  lines[#lines + 1] = "`ambit <command> --help` says more; `ambit --version` prints the version."
  lines[#lines + 1] = exit_codes
  return table.concat(lines, "\n")
end

local function usage_error(message, text)
  io.stderr:write("ambit: ", message, "\n", text, "\n")
  return 2
end

local function unknown(name)
  local names = {}
  for i, entry in ipairs(commands) do names[i] = entry[1] end
  local near = core.nearest(name, names)
  local message = ("unknown %s `%s`%s"):format(name:sub(1, 1) == "-" and "option" or "command", name,
    near and ("; did you mean `%s`?"):format(near) or "")
  return usage_error(message, "try `ambit --help`")
end

-- Takes the options before the command off argv; nil, or what is wrong with them.
local function take_trust(argv)
  while argv[1] do
    local folder = argv[1]:match "^%-%-trust=(.+)$"
    if argv[1] == "--allow-shadow" then
      core.allow_shadow()
    elseif folder or argv[1] == "--trust" then
      if not folder then
        table.remove(argv, 1)
        folder = argv[1]
      end
      if not folder then return "option `--trust` needs a folder" end
      local good, problem = pcall(core.trust, folder)
      if not good then return tostring(problem) end
    else
      return nil
    end
    table.remove(argv, 1)
  end
end

return function(argv)
  core.text_arithmetic("ambit")
  local problem = take_trust(argv)
  if problem then return usage_error(problem, "try `ambit --help`") end
  local name = argv[1]
  if name == nil then return usage_error("expected a command", overview()) end
  if name == "--help" or name == "-h" or name == "help" then return print(overview()) or 0 end
  if name == "--version" or name == "-V" then return print("ambit " .. core.version) or 0 end
  for _, entry in ipairs(commands) do
    if entry[1] == name then
      local command = require("ambit.command." .. name)
      provenance.begin(name)
      local arguments = table.move(argv, 2, #argv, 1, {})
      for _, word in ipairs(arguments) do
        if word == "--" or (command.scene and word:sub(1, 1) ~= "-" and word ~= "-") then break end
        if word == "--help" or word == "-h" then return print(command.usage) or 0 end
      end
      _G.os.exit = scene.leave_by(function(asked) return asked end)
      local code, message = command.run(arguments)
      if code == 2 then return usage_error(message, command.usage) end
      return code
    end
  end
  return unknown(name)
end
