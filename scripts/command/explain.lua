-- explain.lua -- `ambit explain`: what a scene loads, builds and leaves out, in numbers.
local check = require "ambit.check"
local core = require "ambit.core"
local explain_tree = require "ambit.command.explain_tree"
local scene = require "ambit.command.scene"
local session = require "ambit.session"
local suggest = require "ambit.suggest"

local command = { scene = true }

command.usage = [[
usage: ambit explain [--json] SCENE.lua [ARG ...]
Runs the scene with its output discarded, then prints which plugins and libraries it loaded, the model tree of every
mechanism (parts, what hangs on what, coordinates, masses, closed loops), how many quantities were built of those
available, the size of every verb's problem, and for every simulation the best-suited solver and arithmetic and why.
  --json       one object per line instead]]

local function discard_output()
  local null = io.open("/dev/null", "w")
  local stdout = io.stdout
  io.output(null)
  _G.print = function() end
  io.stdout = null
  return function() io.stdout = stdout io.output(stdout) end
end

local function loaded_plugins()
  local loaded, left = {}, {}
  for _, entry in ipairs(core.list()) do
    local name = entry.kind .. "." .. entry.name
    if entry.loaded then loaded[#loaded + 1] = name else left[#left + 1] = name end
  end
  return loaded, left
end

local function libraries()
  local list = {}
  for _, file in ipairs(core.libraries()) do list[#list + 1] = file:match "[^/]+$" end
  table.sort(list)
  return list
end

-- The mechanisms of the scene, in the order in which they were made.
local function mechanisms()
  local list = {}
  for _, number in ipairs(check.sorted(session.mechanisms)) do list[#list + 1] = session.mechanisms[number] end
  return list
end

local keys = { "arithmetic", "solver", "expressions", "states", "parameters", "unknowns", "steps", "graph_nodes",
  "tape_slots",
  "tape_constants", "tape_instructions", "tape_runs", "constant_slots", "seconds_build", "seconds_run" }

local meaning = {
  expressions = "asked for", unknowns = "uncertain data that became variables", graph_nodes = "in the whole graph",
  tape_slots = "slots", tape_constants = "of them constants", tape_instructions = "of them instructions",
  tape_runs = "runs of one opcode", constant_slots = "slots with one Taylor coefficient instead of all",
    seconds_build = "s to build",
  seconds_run = "s to run", parameters = "uncertain parameters", states = "states", steps = "steps",
}

-- "suggested: stiff with interval, as here: ..." of a simulate
local function print_suggestion(write, verb)
  local s = verb.suggestion
  if not s then return end
  write("   %12s  %s with %s%s: %s\n", "best suited", s.solver, suggest.arithmetic(s.solver),
    s.solver == verb.report.solver and ", as here" or "", s.reason)
end

local function print_text(write, facts)
  write("loaded plugins:    %s\n", #facts.loaded > 0 and table.concat(facts.loaded, " ") or "none")
  write("not loaded:        %s\n", table.concat(facts.left, " "))
  write("shared libraries:  %s\n", table.concat(facts.libraries, " "))
  for _, m in ipairs(facts.mechanisms) do explain_tree.write(write, m) end
  for i, verb in ipairs(facts.verbs) do
    write("\n%d. %s (%s)%s%s\n", i, verb.verb, verb.status,
      verb.report.arithmetic and " in " .. verb.report.arithmetic or "",
      verb.report.solver and " by " .. verb.report.solver or "")
    print_suggestion(write, verb)
    for _, key in ipairs(keys) do
      local value = verb.report[key]
      if meaning[key] and value and value ~= 0 then
        write("   %12s  %s\n", math.type(value) == "float" and ("%.6f"):format(value) or tostring(value), meaning[key])
      end
    end
  end
  write("\nCPU time of the whole scene: %.4f s\n", facts.seconds)
end

local function pairs_of(t, order)
  local list = {}
  for _, key in ipairs(order) do
    if t[key] ~= nil then list[#list + 1], list[#list + 2] = key, t[key] end
  end
  return list
end

local function write_json(facts)
  core.records_open "-"
  core.record("plugins", { "loaded", table.concat(facts.loaded, " "), "left", table.concat(facts.left, " "),
    "libraries",
    table.concat(facts.libraries, " ") })
  for _, m in ipairs(facts.mechanisms) do explain_tree.record(m) end
  for _, verb in ipairs(facts.verbs) do
    local fields = { "verb", verb.verb, "status", verb.status, "report", pairs_of(verb.report, keys) }
    if verb.suggestion then
      table.move({ "suggested", verb.suggestion.solver, "because", verb.suggestion.reason }, 1, 4, #fields + 1, fields)
    end
    core.record("verb", fields)
  end
  core.record("result", { "verb", "explain", "status", "complete", "cpu_seconds", facts.seconds })
  core.records_close()
end

local known = { json = false }

function command.run(list)
  local options, file, words = scene.arguments(list, known)
  if not options then return 2, file end
  scene.note_strays(words, known)
  session.keep()
  local restore = discard_output()
  os.exit = function() error(scene.leave, 0) end -- what the scene loaded is still to be told
  local start = core.cpu()
  local good, problem = scene.run(file, words)
  local facts = { seconds = core.cpu() - start, libraries = libraries(), mechanisms = mechanisms(),
    verbs = session.verbs }
  restore()
  if not good and problem ~= scene.leave then
    io.stderr:write("ambit: ", tostring(problem), "\n")
    return 1
  end
  facts.loaded, facts.left = loaded_plugins()
  if options.json then write_json(facts) return 0 end
  print_text(function(format, ...) io.stdout:write(format:format(...)) end, facts)
  return 0
end

return command
