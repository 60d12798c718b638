-- explain.lua -- `ambit explain`: what a scene loads, builds and leaves out, in numbers.
local core = require "ambit.core"
local limits = require "ambit.command.limits"
local sandbox = require "ambit.command.sandbox"
local explain_facts = require "ambit.explain.facts"
local outputs = require "ambit.command.outputs"
local scene = require "ambit.command.scene"

local command = { scene = true }

command.usage = [[
usage: ambit explain [--json] [--dot FILE|-] [--svg FILE] [LIMITS] SCENE.lua [ARG ...]
Runs the scene with its output discarded, then prints what it left out, in numbers: plugins and shared libraries in the
process, quantities built of those available and the parts of every mechanism, nodes of the graph that were shared,
folded away and put on tapes, Taylor coefficients known to be zero, uncertain and fixed data, terms cut by model
reduction; memory and CPU time; and for every simulation the best-suited solver and arithmetic and why.
  --json       one object per line instead
  --dot FILE   also a graph of the scene in the language of Graphviz; what is left out is grey and dashed. `-` is
               standard output (and nothing else is printed)
  --svg FILE   the same as a picture with numbers in tool tips; needs the program `dot` (Debian: graphviz)
]] .. sandbox.usage .. "\n" .. limits.usage .. [[

exit: 0 done, 1 error in the scene (what was built until then is still explained), 5 a limit was reached, 130
      interrupted]]

local known = sandbox.with { json = false, dot = true, svg = true }

local function complain(message)
  io.stderr:write("ambit: ", message, "\n")
  return 1
end

-- Says before the work starts what could not be written after it.
local function check_outputs(options)
  local problem = outputs.problem(options, { "dot", "svg" }, { dot = true })
  if problem then return problem end
  if options.svg and not require("ambit.explain.svg").has_dot() then
    return "--svg needs the program `dot` of Graphviz (Debian: apt install graphviz); --dot FILE works without it"
  end
end

local function write_graphs(options, facts)
  local text, tips = require("ambit.explain.graph").dot(facts)
  if options.dot then
    local good, problem = pcall(outputs.write, options.dot, text)
    if not good then return complain(problem) end
  end
  if not options.svg then return 0 end
  local problem = require("ambit.explain.svg").write(options.svg, text, tips)
  return problem and complain(problem) or 0
end

function command.run(list)
  local options, file, words = scene.arguments(list, known)
  if not options then return 2, file end
  if options.sandbox and options.svg then
    return 2, "option `--svg` starts Graphviz, which a sandbox does not let it: take --dot"
  end
  local wrong = scene.prepare(options, { scene = file, outputs = { options.dot } })
  if wrong then return 2, wrong end
  local unwritable = check_outputs(options)
  if unwritable then return complain(unwritable) end
  scene.note_strays(words, known)
  local facts = explain_facts.gather(file, words)
  local code = 0
  if options.json then
    require("ambit.explain.json").write(facts)
  elseif options.dot ~= "-" then
    io.stdout:write(require "ambit.provenance".lines "", "\n")
    require("ambit.explain.text").write(function(f, ...) io.stdout:write(f:format(...)) end, facts)
  end
  if options.dot or options.svg then code = write_graphs(options, facts) end
  if facts.problem then code = complain(facts.problem) end
  if core.interrupted() then complain "interrupted: what was built up to there is explained" end
  return code
end

return command
