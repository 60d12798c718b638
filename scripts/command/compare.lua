-- compare.lua -- `ambit compare`: runs a scene once, then everything that it evaluates again in each arithmetic and
-- everything that it simulates again by each solver.
local asked = require "ambit.command.compare.asked"
local limits = require "ambit.command.limits"
local sandbox = require "ambit.command.sandbox"
local code = require "ambit.code"
local compare = require "ambit.compare"
local compare_engine = require "ambit.compare.engine"
local compare_files = require "ambit.command.compare.files"
local compare_table = require "ambit.compare.table"
local core = require "ambit.core"
local progress = require "ambit.compare.progress"
local scene = require "ambit.command.scene"
local session = require "ambit.session"

local command = { scene = true }

command.usage = [[
usage: ambit compare SCENE.lua [ARG ...] [--html FILE] [--csv FILE] [--json FILE|-] [--svg FILE] [--repeat N]
                     [--limit SECONDS] [--quick] [LIMITS]
Runs the scene once, then repeats every `simulate` of it by each solver, arithmetic, order and tolerance that fits, and
every `evaluate` in each arithmetic and its orders: how wide, how far, in what time. The scene can say by which:
ambit.compare { solvers = { "lohner", { "taylor_model", order = { 8, 12 } } }, arithmetics = { "interval" } }.
  --html FILE      a page with work-precision diagrams and enclosures over time
  --csv FILE       one line for each combination and result
  --json FILE      one object per line; `-` is standard output (the tables then go to standard error)
  --svg FILE       error or width against run time
  --repeat N       runs of each combination after one to warm up, of which the fastest counts (default 5)
  --limit SECONDS  of CPU time for each combination (default 4); after one that takes longer, higher orders of the same
                   method are skipped
  --quick          the same as --repeat 1 --limit 1
]] .. sandbox.usage .. "\n" .. limits.usage .. [[

Words behind `--` are the scene's, even if they look like options. Ctrl-C ends the comparison; tables and files hold
what was done until then.
exit: 0 done, 1 error in the scene, its input or a file, or proofs contradict each other, 3 nothing was proved,
      5 a limit was reached, 130 interrupted]]

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

local function note(message) io.stderr:write("note: ", message, "\n") end

-- -- comparing

-- Comparisons of the scene itself first. One that cannot be made (a grid that does not fit) does not keep the others
-- from being made. -> list, whether there was such a one
local function compare_all(requests, settings)
  local list, failed = table.move(session.comparisons, 1, #session.comparisons, 1, {}), false
  for i, request in ipairs(requests) do
    local good, comparison = pcall(compare.run, request, settings, progress.new(i, #requests))
    if good then
      comparison.times = request.times
      list[#list + 1] = comparison
    else
      failed = true
      complain(comparison)
    end
  end
  return list, failed
end

local function print_tables(list, out)
  local coloured = out == io.stdout and core.terminal "stdout" and (os.getenv "NO_COLOR" or "") == ""
  for i, comparison in ipairs(list) do
    local times = (comparison.times or 1) > 1 and (", asked for %d times"):format(comparison.times) or ""
    out:write(("%s%d. %s: %s: %s%s\n"):format(i > 1 and "\n" or "", i, comparison.place ~= "" and comparison.place or
      "scene", comparison.verb, compare_table.size(comparison), times))
    out:write(compare_table.text(comparison, coloured), "\n")
  end
end

local quick = { repeats = 1, limit = 1 }

local function number_or_text(text) return text and (tonumber(text) or text) end

-- Options of the command come before what the scene says.
local function settings_of(options)
  local fast = options.quick and quick or {}
  return compare.settings({ repeats = number_or_text(options["repeat"]) or fast.repeats,
    limit = number_or_text(options.limit) or fast.limit }, session.compare)
end

local function run_scene(file, words, json)
  local exit = _G.os.exit
  _G.os.exit = function() error(scene.leave, 0) end -- what the scene asked for is still to be compared
  if json == "-" then scene.print_to_stderr() end
  asked.begin()
  local good, problem = scene.run(file, words)
  _G.os.exit = exit
  return good or problem == scene.leave, problem
end

-- The worst of what happened, as exit code.
local function code_of(list, failed)
  if core.interrupted() then return 130 end
  if failed then return 1 end
  local worst = "ok"
  for _, comparison in ipairs(list) do
    local ended = comparison.code or code.of(comparison.status)
    if code.is_worse(ended, worst) then worst = ended end
  end
  return code.exit(worst)
end

local function results(file, options, requests, failed)
  local good, settings = pcall(settings_of, options)
  if not good then return complain(settings) or 1 end
  settings.interrupted = core.interrupted() -- while the scene ran: nothing more is run
  local engine = compare_engine.new(settings)
  local list, some_failed = engine:calm(compare_all, requests, settings)
  engine:calm(print_tables, list, options.json == "-" and io.stderr or io.stdout)
  local unwritten = compare_files.write(list, file, options, settings, engine)
  if core.interrupted() then complain "interrupted: what was compared until then is kept" end
  return code_of(list, failed or some_failed or unwritten)
end

function command.run(list)
  local options, file, words = scene.arguments(list, sandbox.with { csv = true, svg = true, html = true, json = true,
    ["repeat"] = true, limit = true, quick = false }, true)
  if not options then return 2, file end
  local wrong = scene.prepare(options, { scene = file, children = true,
    outputs = { csv = options.csv, svg = options.svg, html = options.html, json = options.json } })
  if wrong then return 2, wrong end
  local problem = compare_files.problem(options)
  if problem then return complain(problem) or 1 end
  local good
  good, problem = run_scene(file, words, options.json)
  if not good then complain(problem) end
  local requests, others = asked.requests(), asked.others()
  if #requests == 0 and #session.comparisons == 0 then
    if good then
      complain(("%s asks nothing that can be compared: compare repeats `evaluate` and `simulate`%s"):format(file,
        others and ", not " .. others or ""))
    end
    return core.interrupted() and 130 or 1
  end
  if not good then note "what the scene asked before it failed is compared" end
  if others then note("compare repeats `evaluate` and `simulate`; left out: " .. others) end
  return results(file, options, requests, not good)
end

return command
