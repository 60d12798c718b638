-- run.lua -- `ambit run`.
local code = require "ambit.code"
local limits = require "ambit.command.limits"
local sandbox = require "ambit.command.sandbox"
local core = require "ambit.core"
local provenance = require "ambit.provenance"
local scene = require "ambit.command.scene"
local session = require "ambit.session"

local command = { scene = true }

command.usage = [[
usage: ambit run [--json FILE|-] [--plot FILE] [--quiet] [LIMITS] SCENE.lua [ARG ...]
  --plot FILE  draws the states of each simulation over time (ambit.plot): .svg, .html, .png, .pdf or .csv; of several
               the second is FILE with -2 before the end of its name
  --json FILE  also write every record as a line of JSON, first whence they come (version, plugins, SHA-256); `-` is
               standard output (what the scene prints then goes to standard error)
  --quiet      no progress bar and no notes
]] .. sandbox.usage .. "\n" .. limits.usage .. [[

SCENE `-` is standard input. The words behind the scene are in its table `arg`. Ctrl-C ends a simulation with status
"stopped" and keeps what was recorded.
exit: 0 done and proved, 1 error in the scene or its input, or a plugin is broken, 3 a verb could not prove all, 4 a
verb proved that there is no answer, 5 a limit was reached, 130 interrupted; of several the worst: 1 before 3 before 4.
`ambit errors` lists the codes of verbs.]]

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

local sentences = { "a plugin contradicts itself, or a proof another or a reference",
  [3] = "not everything could be proved",
  [4] = "it is proved that there is no answer" }

local function close_records()
  local good, problem = pcall(core.records_close)
  if not good then complain(problem) end
  return good
end

-- The worst that happened: of the verbs, an error of the scene, a signal.
local function worst_of(problem)
  local stopped, _, ended = core.interrupted()
  if stopped then return ended end
  if problem and code.family(session.worst) ~= "broken" then return "invalid" end
  return session.worst
end

local MOST_PLOTS = 50 -- of one scene: files that nobody asked for one by one

-- A picture of each simulation of the scene. Were all of them written?
local function write_plots(file, problem)
  local all, runs = true, session.runs
  for i = 1, math.min(#runs, MOST_PLOTS) do
    local name = i == 1 and file or file:gsub("(%.%w+)$", ("-%d%%1"):format(i))
    sandbox.output(name)
    local good, why = pcall(require "ambit.plot".plot, { runs[i].run, file = name })
    if not good then complain(why) end
    all = all and good
  end
  if #runs > MOST_PLOTS then complain(("--plot: %d of %d simulations are drawn"):format(MOST_PLOTS, #runs)) end
  if #runs == 0 and not problem then complain "--plot: the scene calls no ambit.simulate: there is nothing to draw" end
  return all and #runs > 0
end

-- The end of the scene, however it came: the last record, what is to be said, the exit code. problem: the error that
-- ended it; asked: what os.exit asked for, which may not make it better; plot: the file of --plot.
local function finish(problem, asked, plot)
  local drawn = not plot or core.interrupted() or write_plots(plot, problem)
  local worst, stopped, by_stop, _, limit = worst_of(problem), core.interrupted()
  local exit = code.exit(worst)
  if asked and asked ~= 0 then exit = asked end
  if stopped then exit = by_stop end
  if problem then complain(problem) end
  local reason = limit or problem and tostring(problem):match "^[^\n]*"
  if not drawn and exit == 0 then worst, exit, reason = "invalid", 1, "a picture could not be written" end
  if not core.flush() and exit == 0 then
    worst, exit, reason = "invalid", 1, "not everything could be written to standard output"
  end
  pcall(core.record, "end", { "code", worst, "exit", exit, "reason", reason })
  if not close_records() then return 1 end
  if stopped and not limit then complain "interrupted: what was recorded up to there is kept" end
  local sentence = not problem and worst ~= "invalid" and sentences[code.exit(worst)]
  if sentence then complain(("%s (%s): see status, code and reason of the verbs"):format(sentence, worst)) end
  scene.watch_finalisers(exit, worst, function(worse, ended)
    complain(("%s (%s), in a finaliser at the end"):format(sentences[worse], ended))
  end)
  return exit
end

local known = sandbox.with { json = true, plot = true, quiet = false }

function command.run(list)
  local options, file, words = scene.arguments(list, known)
  if not options then return 2, file end
  local wrong = scene.prepare(options, { scene = file, outputs = { options.plot }, is_late = true })
  if wrong then return 2, wrong end
  core.progress(not options.quiet)
  core.notes(not options.quiet)
  if not options.quiet then scene.note_strays(words, known) end
  if options.plot then
    if options.sandbox and options.plot:find "%.[pP][nNdD][gGfF]$" then
      return 2, "--plot: .png and .pdf are made by another program, which --sandbox lets nobody start"
    end
    local good, problem = pcall(require "ambit.plot".check_file, options.plot)
    if not good then return 2, (tostring(problem):gsub("^.-plot: ", "--plot: "):gsub("plot: file", "plot")) end
    session.runs = {}
  end
  if options.json then
    local text, why = provenance.read(file)
    if not text then return complain(why) or 1 end
    local good, problem = pcall(provenance.records, options.json)
    if not good then return complain(problem) or 1 end
    if options.json == "-" then scene.print_to_stderr() end
  end
  _G.os.exit = scene.leave_by(function(asked) return finish(nil, asked, options.plot) end)
  local good, problem = scene.run(file, words)
  return finish(not good and problem or nil, nil, options.plot)
end

return command
