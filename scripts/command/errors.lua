-- errors.lua -- `ambit errors`: what the codes of outcomes mean.
local code = require "ambit.code"
local core = require "ambit.core"

local command = {}

command.usage = [[
usage: ambit errors [CODE]
       ambit errors --markdown
Prints what a code (`run.code`, "code" in JSON records) means and what to do; without one, all of them. --markdown
prints the table of docs/errors.md.
exit: 0 done, 2 there is no such code]]

local function print_one(entry)
  print(("%s (exit code %d)"):format(entry.code, code.exit(entry.code)))
  print("  " .. entry.meaning)
  if entry.advice ~= "" then print("  " .. entry.advice) end
end

local function print_markdown(list)
  print "| code | exit | meaning | what to do |"
  print "|---|---|---|---|"
  for _, e in ipairs(list) do
    print(("| `%s` | %d | %s | %s |"):format(e.code, code.exit(e.code), e.meaning, e.advice))
  end
end

-- The entry of a code, or nil and the nearest name.
local function find(list, name)
  local names = {}
  for i, e in ipairs(list) do
    if e.code == name then return e end
    names[i] = e.code
  end
  return nil, core.nearest(name, names)
end

function command.run(words)
  local list = code.list()
  if #words == 1 and words[1] == "--markdown" then return print_markdown(list) or 0 end
  if words[1] and words[1]:sub(1, 1) == "-" then return 2, ("unknown option `%s`"):format(words[1]) end
  if #words > 1 then return 2, ("unexpected `%s`"):format(words[2]) end
  if #words == 0 then
    for _, e in ipairs(list) do print_one(e) end
    return 0
  end
  local found, near = find(list, words[1])
  if found then return print_one(found) or 0 end
  return 2, ("there is no code `%s`%s"):format(words[1], near and ("; did you mean `%s`?"):format(near) or "")
end

return command
