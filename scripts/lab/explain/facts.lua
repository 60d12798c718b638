-- explain/facts.lua -- runs a scene with its output discarded and gathers what it loaded, built, computed and left out.
local check = require "ambit.check"
local core = require "ambit.core"
local process = require "ambit.explain.process"
local scene = require "ambit.command.scene"
local session = require "ambit.session"

local explain = {}

-- The modules that the scene read beyond those that every scene needs, by name. What explains is read later: it would
-- hide what the scene needs of the same modules.
local function modules_since(before)
  local list = {}
  for _, name in ipairs(check.sorted(process.modules())) do
    if not before[name] then list[#list + 1] = name end
  end
  return list
end

-- Resident now and at most; the system counts the latter a little late.
local function memory()
  local now, peak = core.memory()
  return now, math.max(now, peak)
end

-- What is asked of the graph, and how much memory there is, when a verb has ended.
local function observe(verb)
  verb.answers = core.answers()
  verb.resident, verb.peak = memory()
  if verb.verb == "evaluate" then verb.request = table.remove(session.asked) end
end

-- In the order in which they were made.
local function listed(values)
  local list = {}
  for _, number in ipairs(check.sorted(values)) do list[#list + 1] = values[number] end
  return list
end

local stages = { "seconds_graph", "seconds_tape", "seconds_context", "seconds_open", "seconds_run", "seconds_close" }

-- A verb that has no report of its own has only its time.
local function spent(verb, key)
  if key == "seconds_run" and not verb.report[key] then return verb.cpu_seconds end
  return verb.report[key] or 0
end

-- { { name, seconds } }: CPU time before the scene began, of the script itself, and of each stage of all verbs
local function times(facts)
  local list, sum = { { "load", facts.cpu_start } }, 0
  for _, key in ipairs(stages) do
    local seconds = 0
    for _, verb in ipairs(facts.verbs) do seconds = seconds + spent(verb, key) end
    list[#list + 1] = { key:match "_(.*)", seconds }
    sum = sum + seconds
  end
  table.insert(list, 2, { "script", math.max(0, facts.cpu_end - facts.cpu_start - sum) })
  return list
end

-- The share of the graph that each verb asked for: since the verb before it ended.
local function count_answers(facts)
  local before = facts.answers_start
  for _, verb in ipairs(facts.verbs) do
    local own = {}
    for _, key in ipairs { "nodes", "asked", "shared", "folded" } do own[key] = verb.answers[key] - before[key] end
    verb.own, before = own, verb.answers
  end
end

-- For a simulate: the solver that suits, and why. Looking at the scene loads plugins, so it comes last.
local function add_suggestions(facts)
  local suggest = require "ambit.simulate.suggest"
  for _, verb in ipairs(facts.verbs) do
    if verb.verb == "simulate" and verb.request then
      local good, s = pcall(function() return verb.request.suggestion or suggest.advice(verb.request) end)
      verb.suggestion = good and { solver = s.solver, arithmetic = suggest.arithmetic(s.solver), reason = s.reason }
    end
  end
end

-- gather(file, words) -> facts; facts.problem: the error that ended the scene
function explain.gather(file, words)
  session.verbs = {}
  local facts = { file = file, verbs = session.verbs }
  session.keep(observe)
  local restore = scene.discard_output()
  facts.answers_start, facts.cpu_start = core.answers(), core.cpu()
  facts.resident_start = memory()
  local modules_before = process.modules()
  local good, problem = scene.run(file, words)
  facts.cpu_end, facts.answers = core.cpu(), core.answers()
  facts.resident, facts.peak = memory()
  facts.libraries, facts.plugins = process.libraries(), process.plugins()
  facts.modules, facts.module_count = modules_since(modules_before), process.module_count()
  restore()
  facts.problem = not good and problem ~= scene.leave and tostring(problem) or nil
  local mechanisms = listed(session.mechanisms)
  facts.data = require "ambit.explain.data".collect(mechanisms, listed(session.odes), facts.verbs)
  facts.mechanisms = {}
  local tree = require "ambit.explain.tree"
  for i, m in ipairs(mechanisms) do facts.mechanisms[i] = tree.tree(m) end
  facts.times = times(facts)
  count_answers(facts)
  add_suggestions(facts)
  return facts
end

return explain
