-- check.lua -- `ambit check`: the conformance kit of a plugin, in a process of its own.
local check = require "ambit.check"
local core = require "ambit.core"
local plugin = require "ambit.plugin"

local command = {}

command.usage = [[
usage: ambit check [--seed N] [--rounds N | --long] [--isotonic] [--patience S] PLUGIN [OPTION=VALUE ...]
Puts a plugin through the conformance kit of its kind. PLUGIN is a file (./mine.so) or the name of an installed one
(interval, arithmetic.interval); OPTION=VALUE sets an option of an arithmetic or a solver. Prints what was checked,
every broken promise, and which operations an arithmetic leaves to the kernel.
  --seed N      of the random operands (default 1); the same seed finds the same
  --rounds N    N times the usual number of rounds and seconds (default 1)
  --long        the same as --rounds 20
  --isotonic    also demand that a part of the operands has an image within the image (plain interval arithmetics)
  --patience S  give up when nothing happens for S seconds (default 60, times the rounds)
exit: 0 it conforms, 1 it cannot be loaded, 3 it breaks a promise, crashes or hangs]]

local numbers = { seed = true, rounds = true, patience = true }
local flags = { long = true, isotonic = true }

-- Options and words of the command line, or nil and what is wrong with them.
local function arguments(words)
  local options, rest, i = {}, {}, 1
  while words[i] do
    local name, value = words[i]:match "^%-%-([%w-]+)=?(.*)$"
    if name and flags[name] and value == "" then
      options[name] = true
    elseif name and numbers[name] then
      if value == "" then i, value = i + 1, words[i + 1] end
      options[name] = tonumber(value)
      if not options[name] or options[name] <= 0 or options[name] ~= options[name] or options[name] > 2 ^ 53 then
        return nil, ("option `--%s` needs a positive number"):format(name)
      end
    elseif words[i]:sub(1, 1) == "-" then
      return nil, ("unknown option `%s`"):format(words[i])
    else
      rest[#rest + 1] = words[i]
    end
    i = i + 1
  end
  if not rest[1] then return nil, "expected a plugin, a file or a name" end
  for k = 2, #rest do
    if not rest[k]:find "^[%w_]+=" then return nil, ("expected OPTION=VALUE, got `%s`"):format(rest[k]) end
  end
  if options.seed and options.seed % 1 ~= 0 then return nil, "option `--seed` needs an integer" end
  return options, rest
end

-- The file that a word means, or nil and why there is none.
local function file_of(word)
  if word:find "/" then return word end
  if word:find "%.so$" then return "./" .. word end
  local kind, bare = word:match "^(%a+)%.([%w_-]+)$"
  local found, names = {}, {}
  for _, entry in ipairs(core.list()) do
    names[#names + 1] = entry.name
    if entry.name == (bare or word) and (not kind or entry.kind == kind) then found[#found + 1] = entry end
  end
  if #found == 1 then return found[1].file end
  if #found == 0 then
    return nil, ("there is no plugin `%s`%s; a file is written with a slash or .so"):format(word,
      check.suggest(word, names))
  end
  for i, entry in ipairs(found) do found[i] = entry.kind .. "." .. entry.name end
  return nil, ("several plugins are called `%s`: say which of %s"):format(word, table.concat(found, ", "))
end

-- What the kit tells, as lines; keeps the counts for the verdict.
local function reporter(options)
  local r = { judged = 0, broken = 0, fallbacks = {} }
  local open -- a section was begun, and its line is not complete
  local function line(text)
    if open then io.write "\n" end
    open = nil
    print(text)
  end
  local tell = {}
  function tell.plugin(id, doc) line(("%s: %s"):format(id, doc)) end
  function tell.begin(section)
    io.write(("  %-14s "):format(section))
    io.flush() -- so that one sees where it hangs
    open = section
  end
  function tell.done(section, text)
    local judged, broken = text:match "^(%d+) (%d+)$"
    judged, broken = math.tointeger(judged), math.tointeger(broken)
    local say = judged == 0 and "nothing to check" or judged .. " checks"
    if section == "isotonicity" and not options.isotonic then
      say = judged == 0 and "no, and none is demanded" or say .. ", none failed"
    end
    if broken > 0 then say = ("%s, %d broken"):format(say, broken) end
    if open then io.write(say, "\n") else print(("  %-14s %s"):format(section, say)) end
    open = nil
    r.judged, r.broken = r.judged + judged, r.broken + broken
  end
  function tell.finding(promise, text)
    line(("    %s: %s"):format(promise, text))
    r.findings = true
  end
  function tell.fallback(operation) r.fallbacks[#r.fallbacks + 1] = operation:lower() end
  function tell.note(_, text) line("  " .. text) end
  function tell.refused(_, text)
    if open then io.write "\n" end
    r.refused = text
  end
  function tell.died(section, how)
    if open then io.write "\n" end
    r.died = ("%s, in `%s`"):format(how, section)
  end
  r.tell = function(what, name, text) if tell[what] then tell[what](name, text) end end
  return r
end

local function verdict(r, code, seed)
  if #r.fallbacks > 0 then
    print("left to the kernel (sound, but loose and slow): " .. table.concat(r.fallbacks, " "))
  end
  if r.refused then
    io.stderr:write("ambit: ", r.refused, "\n")
  elseif r.died then
    print("BROKEN: " .. r.died)
  elseif code == 0 then
    print(("conforms: %d checks with seed %d, no promise broken"):format(r.judged, seed))
  else
    print(("BROKEN: %d promises, in %d checks with seed %d"):format(r.broken, r.judged, seed))
  end
  return code
end

function command.run(words)
  local options, rest = arguments(words)
  if not options then return 2, rest end
  local file, problem = file_of(rest[1])
  if not file then
    io.stderr:write("ambit: ", problem, "\n")
    return 1
  end
  local good, kit = pcall(plugin.plugin, "service", "conformance_kit")
  if not good then
    io.stderr:write("ambit: ", tostring(kit), "\n")
    return 1
  end
  local _, trusted, shadows = core.provenance() -- the kit has a kernel of its own, which knows nothing of these
  for _, folder in ipairs(trusted) do kit.fn.trust(folder) end
  if shadows then kit.fn.allow_shadow() end
  local rounds, seed = options.rounds or options.long and 20 or 1, math.tointeger(options.seed or 1)
  local report = reporter(options)
  io.stdout:flush() -- the child has a copy of what is not written yet
  local code = kit.fn.check(file, table.concat(rest, "\n", 2), seed, rounds,
    options.patience or 60 * math.max(1, rounds), options.isotonic and 1 or 0, report.tell)
  return verdict(report, code, seed)
end

return command
