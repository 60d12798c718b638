-- view.lua -- `ambit view`: runs a scene and writes a page that shows its mechanisms.
local check = require "ambit.check"
local limits = require "ambit.command.limits"
local sandbox = require "ambit.command.sandbox"
local code = require "ambit.code"
local core = require "ambit.core"
local data = require "ambit.view.data"
local page = require "ambit.view.page"
local scene = require "ambit.command.scene"
local session = require "ambit.session"
local target = require "ambit.command.view.target"

local command = { scene = true }

command.usage = [[
usage: ambit view SCENE.lua [ARG ...] [-o FILE] [--quiet] [LIMITS]
Runs the scene and writes one HTML page, which needs no network and no other file: its mechanisms over time, and boxes
that are guaranteed to contain chosen points at each instant and all the way to the next. The scene can say what:
  ambit.view { m, run = run, points = { tip = frame }, at = { joint = angle }, t = { 0, 5 }, title = "..." }
Otherwise it is every mechanism, with the last simulation of it, and the frames that nothing else is fixed to.
  -o, --page FILE  the page (default: the name of the scene, .html, in the working directory); `-` is standard output
  --quiet          no progress bar and no notes
]] .. sandbox.usage .. "\n" .. limits.usage .. [[

Words behind `--` are the scene's, even if they look like options.
exit: 0 written, 1 error in the scene, its input or the file, 3 written, but of a simulation that could not be proved,
4 written, but of one that is proved to be impossible, 5 a limit was reached]]

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

local function note(message) io.stderr:write("note: ", message, "\n") end

-- -- what to show

local function question_of(run)
  for _, entry in ipairs(session.runs) do
    if entry.run == run then return entry.request end
  end
end

local function last_run(m)
  for i = #session.runs, 1, -1 do
    local entry = session.runs[i]
    if entry.request.system.mechanism == m then return entry.run end
  end
end

local function requests()
  local list = table.move(session.views, 1, #session.views, 1, {})
  for _, number in ipairs(#list == 0 and check.sorted(session.mechanisms) or {}) do
    local m = session.mechanisms[number]
    list[#list + 1] = { mechanism = m, run = last_run(m), at = {} }
  end
  for _, request in ipairs(list) do request.question = request.run and question_of(request.run) end
  return list
end

local function run_scene(file, words)
  local exit = _G.os.exit
  _G.os.exit = function() error(scene.leave, 0) end -- what the scene has made is still to be shown
  session.runs = {}
  session.keep()
  local good, problem = scene.run(file, words)
  _G.os.exit = exit
  return good or problem == scene.leave, problem
end

local function build(file)
  local views, worst = {}, "ok"
  for i, request in ipairs(requests()) do
    local good, view = pcall(data.of, request)
    if not good then error((request.place or "") .. tostring(view), 0) end
    views[i] = view
    local ended = view.code or "ok"
    if code.is_worse(ended, worst) then worst = ended end
  end
  if #views == 0 then error(("%s makes no mechanism: there is nothing to show"):format(file), 0) end
  return page.of(views, file:match "[^/]*$"), worst
end

-- -- the command

-- -o is short for --page.
local function long_options(list)
  local long, taking = {}, true
  for i, word in ipairs(list) do
    if word == "--" then taking = false end
    long[i] = taking and word == "-o" and "--page" or word
  end
  return long
end

local function show(file, words, output, quiet)
  local good, text, worst = run_scene(file, words)
  if good then good, text, worst = pcall(build, file) end
  if not good then return complain(text) or 1 end
  local problem = target.write(output, text)
  if problem then return complain(problem) or 1 end
  if not quiet and output ~= "-" then note(("%s: %.0f kB"):format(output, #text / 1024)) end
  if code.exit(worst) == 0 then return 0 end
  complain "a simulation that is shown could not be proved to its end: the page says how far"
  return code.exit(worst)
end

function command.run(list)
  local options, file, words = scene.arguments(long_options(list), sandbox.with { page = true, quiet = false }, true)
  if not options then return 2, file end
  local wrong = scene.prepare(options, { scene = file, outputs = { options.page } })
  if wrong then return 2, wrong end
  core.progress(not options.quiet)
  core.notes(not options.quiet)
  local output = options.page or file:match("[^/]*$"):gsub("%.lua$", "") .. ".html"
  local problem = target.problem(output)
  if problem then return complain(problem) or 1 end
  if output == "-" then scene.print_to_stderr() end
  return show(file, words, output, options.quiet)
end

return command
