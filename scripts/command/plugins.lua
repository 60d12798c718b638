-- plugins.lua -- `ambit plugins`.
local core = require "ambit.core"
local manual = require "ambit.manual"

local command = {}

command.usage = [[
usage: ambit plugins [NAME | KIND.NAME]
Lists the plugins on AMBIT_PATH and in the plugin directory without loading them, or prints the manual of one.
A plugin that has the name of one of Ambit's own, or that others may write, is refused: `ambit --help` says what allows
it.]]

local function list()
  local kind
  for _, entry in ipairs(core.list()) do
    if entry.kind ~= kind then
      print((kind and "\n" or "") .. entry.kind)
      kind = entry.kind
    end
    print(("  %-16s %s"):format(entry.name, entry.file))
  end
  if not kind then io.stderr:write("no plugins found; AMBIT_PATH names directories to look in\n") end
  return 0
end

function command.run(words)
  if #words > 1 then return 2, "expected one name" end
  if not words[1] then return list() end
  if words[1]:sub(1, 1) == "-" then return 2, ("unknown option `%s`"):format(words[1]) end
  local text, problem = manual.named(words[1])
  if not text then
    io.stderr:write("ambit: ", problem, "\n")
    return 1
  end
  print(text)
  return 0
end

return command
