-- profile.lua -- `ambit profile`: where the time of a scene goes.
local core = require "ambit.core"
local limits = require "ambit.command.limits"
local sandbox = require "ambit.command.sandbox"
local json = require "ambit.report.json"
local outputs = require "ambit.command.outputs"
local provenance = require "ambit.provenance"
local scene = require "ambit.command.scene"
local session = require "ambit.session"
local sums = require "ambit.profile.sums"
local text = require "ambit.profile.text"

local command = { scene = true }

command.usage = [[
usage: ambit profile [--json FILE] [--folded FILE] [LIMITS] SCENE.lua [ARG ...]
Runs the scene with its output discarded, and tells where its time goes: by stage (script, model, graph, tape, open,
run, records), by service and plugin, by opcode and by equation, and as a tree of frames with bars. Opcodes and services
are measured while the scene runs; what measuring costs is measured too, told, and taken off. Equations are apportioned:
each has the instructions that it alone reaches, and its part of those that it shares.
  --json FILE    also write all of it as JSON; `-` is standard output, instead of the text
  --folded FILE  also write folded stacks (own time in microseconds), which flame graph programs read
]] .. sandbox.usage .. "\n" .. limits.usage .. [[

exit: 0 the scene ran, 1 it failed: then the profile is of what it did until there, 5 a limit was reached]]

local known = sandbox.with { json = true, folded = true }

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

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

-- What a writer was given, as one text.
local function text_by(write)
  local parts = {}
  write(function(...) parts[#parts + 1] = table.concat({ ... }) end)
  return table.concat(parts)
end

local function write_all(options, p)
  if options.folded then outputs.write(options.folded, text_by(function(w) text.fold(w, p.frames) end)) end
  if options.json then outputs.write(options.json, provenance.json(json.encode(p)) .. "\n") end
  if options.json == "-" or options.folded == "-" then return end
  outputs.write("-", provenance.lines "" .. "\n" .. text_by(function(w) text.print(w, p) end))
end

function command.run(list)
  local options, file, words = scene.arguments(list, known)
  if not options then return 2, file end
  local wrong = scene.prepare(options, { scene = file, outputs = { folded = options.folded, json = options.json } })
  if wrong then return 2, wrong end
  scene.note_strays(words, known)
  local refusal = outputs.problem(options, { "json", "folded" }, { json = true, folded = true })
  if refusal then return complain(refusal) or 1 end
  session.verbs = {}
  local p, problem = measure(file, words)
  p.verbs_ended = {}
  for i, verb in ipairs(session.verbs) do p.verbs_ended[i] = { verb = verb.verb, status = verb.status } end
  p.problem = problem and tostring(problem) or nil
  if problem then complain(problem) end
  if problem then complain "the profile is of what the scene did until there" end
  local good, why = pcall(write_all, options, p)
  if not good then return complain(why) or 1 end
  return problem and 1 or 0
end

return command
