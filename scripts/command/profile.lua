-- profile.lua -- `ambit profile`: where the time of a scene goes.
local core = require "ambit.core"
local json = require "ambit.view.json"
local provenance = require "ambit.provenance"
local scene = require "ambit.command.scene"
local session = require "ambit.session"
local sums = require "ambit.command.profile.sums"
local text = require "ambit.command.profile.text"

local command = { scene = true }

command.usage = [[
usage: ambit profile [--json FILE] [--folded FILE] SCENE.lua [ARG ...]
Runs the scene with its output discarded, and tells where its time goes: by stage (script, model, graph, tape, open,
run, records), by service and plugin, by opcode and by equation, and as a tree of frames with bars. Opcodes and services
are measured while the scene runs; what measuring costs is measured too, told, and taken off. Equations are apportioned:
each has the instructions that it alone reaches, and its part of those that it shares.
  --json FILE    also write all of it as JSON; `-` is standard output, instead of the text
  --folded FILE  also write folded stacks (own time in microseconds), which flame graph programs read
exit: 0 the scene ran, 1 it failed: then the profile is of what it did until there]]

local known = { json = true, folded = true }

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

-- Opens the files before the work starts; nil and a message if one can't be written.
local function open_files(options)
  local files = {}
  for _, name in ipairs { "json", "folded" } do
    if options[name] == "-" then
      files[name] = io.stdout
    elseif options[name] then
      local file, problem = io.open(options[name], "w")
      if not file then return nil, ("option `--%s`: cannot write %s"):format(name, problem) end
      files[name] = file
    end
  end
  return files
end

-- Runs the scene; its profile, and what it failed with, if it did.
local function measure(file, words)
  local restore = scene.discard_output()
  local cpu = core.cpu()
  core.profile_begin()
  local good, problem = scene.run(file, words)
  local root, is_cut, wall = core.profile_end()
  cpu = core.cpu() - cpu
  restore()
  local p = sums.of(root)
  p.scene, p.frames, p.is_cut, p.wall_seconds, p.cpu_seconds = file, root, is_cut, wall, cpu
  p.unaccounted = math.max(0, wall - (p.total + p.cost - p.others))
  if not good and problem ~= scene.leave then return p, problem end
  return p
end

local function write_all(files, p)
  local function writer(file) return function(...) return assert(file:write(...)) end end
  if files.folded then text.fold(writer(files.folded), p.frames) end
  if files.json then writer(files.json)(provenance.json(json.encode(p)), "\n") end
  if files.json ~= io.stdout and files.folded ~= io.stdout then
    writer(io.stdout)(provenance.lines "", "\n")
    text.print(writer(io.stdout), p)
  end
  for _, name in ipairs { "json", "folded" } do
    if files[name] and files[name] ~= io.stdout then assert(files[name]:close()) end
  end
end

function command.run(list)
  local options, file, words = scene.arguments(list, known)
  if not options then return 2, file end
  scene.note_strays(words, known)
  local files, refusal = open_files(options)
  if not files then return complain(refusal) or 1 end
  session.verbs = {}
  local p, problem = measure(file, words)
  p.verbs_ended = {}
  for i, verb in ipairs(session.verbs) do p.verbs_ended[i] = { verb = verb.verb, status = verb.status } end
  p.problem = problem and tostring(problem) or nil
  if problem then complain(problem) end
  if problem then complain "the profile is of what the scene did until there" end
  local good, why = pcall(write_all, files, p)
  if not good then return complain(why) or 1 end
  return problem and 1 or 0
end

return command
