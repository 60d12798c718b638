-- compare.lua -- `ambit compare`: runs a scene once, then everything that it evaluates again in each arithmetic.
local compare = require "ambit.compare"
local compare_files = require "ambit.command.compare_files"
local compare_table = require "ambit.compare.table"
local core = require "ambit.core"
local scene = require "ambit.command.scene"
local session = require "ambit.session"

local command = { scene = true }

command.usage = [[
usage: ambit compare SCENE.lua [ARG ...] [--csv FILE] [--svg FILE] [--json FILE|-] [--repeat N] [--limit SECONDS]
Runs the scene once, then repeats every `evaluate` of it in each arithmetic and its orders: how wide, in what time. The
scene can say in which: ambit.compare { arithmetics = { "interval", { "affine", symbols = { 10, 20 } } } }.
  --csv FILE       one line for each combination and result
  --svg FILE       width against run time, drawn by gnuplot
  --json FILE      one object per line; `-` is standard output (the tables then go to standard error)
  --repeat N       runs of each combination after one to warm up, of which the fastest counts (default 5)
  --limit SECONDS  after a run that takes longer, higher orders of that arithmetic are skipped (default 10)
Words behind `--` are the scene's, even if they look like options.
exit: 0 done, 1 error in the scene, its input or a file, 3 nothing was proved or proofs contradict each other]]

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

local function note(message) io.stderr:write("note: ", message, "\n") end

-- -- what the scene evaluates

local function same_list(a, b)
  if #a ~= #b then return false end
  for i, e in ipairs(a) do if e ~= b[i] then return false end end
  return true
end

local function same(a, b)
  return same_list(a.expressions, b.expressions) and same_list(a.paths, b.paths) and same_list(a.leaves, b.leaves)
    and same_list(a.values, b.values)
end

-- The same expressions asked for in several arithmetics, as a loop over arithmetics does, are one request.
local function distinct(asked)
  local list = {}
  for _, request in ipairs(asked) do
    local known
    for _, other in ipairs(list) do known = known or same(other, request) and other end
    if known then
      known.times = known.times + 1
    else
      request.times = 1
      list[#list + 1] = request
    end
  end
  return list
end

local function other_verbs()
  local count, names = {}, {}
  for _, entry in ipairs(session.verbs) do
    if entry.verb ~= "evaluate" and entry.verb ~= "compare" then
      if not count[entry.verb] then names[#names + 1] = entry.verb end
      count[entry.verb] = (count[entry.verb] or 0) + 1
    end
  end
  for i, name in ipairs(names) do names[i] = ("%s (%d)"):format(name, count[name]) end
  return #names > 0 and table.concat(names, ", ") or nil
end

-- -- comparing

local function progress_line(number, total)
  if not core.terminal "stderr" then return nil, function() end end
  return function(i, n, name)
    io.stderr:write(("\r\27[Kcomparison %d of %d: %d of %d: %s"):format(number, total, i, n, name))
    io.stderr:flush()
  end, function() io.stderr:write "\r\27[K" end
end

local function compare_all(requests, settings)
  local list = table.move(session.comparisons, 1, #session.comparisons, 1, {})
  for i, request in ipairs(requests) do
    local show, clear = progress_line(i, #requests)
    local good, comparison = pcall(compare.run, request, settings, show)
    clear()
    if not good then error(comparison, 0) end
    comparison.times = request.times
    list[#list + 1] = comparison
  end
  return list
end

local function print_tables(list, out)
  local coloured = out == io.stdout and core.terminal "stdout" and (os.getenv "NO_COLOR" or "") == ""
  for i, comparison in ipairs(list) do
    local times = (comparison.times or 1) > 1 and (", asked for %d times"):format(comparison.times) or ""
    out:write(("%s%d. %s: %s%s\n"):format(i > 1 and "\n" or "", i, comparison.place ~= "" and comparison.place or
      "evaluate", compare_table.size(comparison), times))
    out:write(compare_table.text(comparison, coloured), "\n")
  end
end

-- Options of the command come before what the scene says.
local function settings_of(options)
  local own = { repeats = options["repeat"] and (tonumber(options["repeat"]) or options["repeat"]),
    limit = options.limit and (tonumber(options.limit) or options.limit) }
  return compare.settings(own, session.compare)
end

local function run_scene(file, words, json)
  local exit = os.exit
  os.exit = function() error(scene.leave, 0) end -- what the scene asked for is still to be compared
  if json == "-" then scene.print_to_stderr() end
  session.asked = {}
  local good, problem = scene.run(file, words)
  os.exit = exit
  return good or problem == scene.leave, problem
end

local function results(file, options, requests)
  local good, settings = pcall(settings_of, options)
  if not good then return complain(settings) or 1 end
  local list
  good, list = pcall(compare_all, requests, settings)
  if not good then return complain(list) or 1 end
  print_tables(list, options.json == "-" and io.stderr or io.stdout)
  local code = 0
  for _, comparison in ipairs(list) do
    if comparison.status ~= "complete" then code = 3 end
  end
  local problem = compare_files.write(list, file, options, settings)
  return problem and 1 or code
end

function command.run(list)
  local options, file, words = scene.arguments(list, { csv = true, svg = true, json = true, ["repeat"] = true,
    limit = true }, true)
  if not options then return 2, file end
  local problem = compare_files.problem(options)
  if problem then return complain(problem) or 1 end
  local good
  good, problem = run_scene(file, words, options.json)
  if not good then return complain(problem) or 1 end
  local others, requests = other_verbs(), distinct(session.asked)
  session.asked = nil
  if #requests == 0 and #session.comparisons == 0 then
    complain(("%s evaluates nothing: compare repeats `evaluate` only%s"):format(file, others and ", not " .. others or
      ""))
    return 1
  end
  if others then note("compare repeats `evaluate` only; left out: " .. others) end
  return results(file, options, requests)
end

return command
