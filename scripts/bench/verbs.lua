-- verbs.lua -- every question about whole robots with all their tolerances, asked as a user asks it first.
-- ambit run scripts/bench/verbs.lua [--machine NAME] [--verb NAME] [--seconds S]
--
-- Prints a table: for each machine and verb what came of the default call, CPU time and memory. Each question is asked
-- in a process of its own, on one core, with 60 s of CPU. A line fails if the question is not answered in that time, or
-- if two answers contradict each other. The machines are scenes of scripts/bench/robots, over a short time: what is
-- tried is whether verbs work on them, not how far a run comes (robots.lua). Exit 1 if a line fails.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local core = require "ambit.core"
local bench = require "bench"
local machines = require "verbs.machines"
local questions = require "verbs.questions"

local asked = { seconds = 60 }
do
  local i = 1
  while arg[i] do
    local key, value = arg[i]:match "^%-%-(%a+)$", arg[i + 1]
    if not value or not (key == "machine" or key == "verb" or key == "seconds") then
      io.stderr:write(("verbs.lua: unknown or incomplete option `%s`\n"):format(arg[i]))
      os.exit(2)
    end
    asked[key] = key == "seconds" and assert(tonumber(value), "a number is missing") or value
    i = i + 2
  end
end

local MEMORY = 6e9 -- bytes

-- Asks in a process of its own: was it answered, and how; what it cost.
local function answer(question, machine)
  local child = core.child(function()
    local show = print
    print = function() end
    local good, text = question.ask(machine, asked.seconds)
    print = show
    return (good and "+" or "-") .. text
  end, { cpu = asked.seconds, wall = 20 * asked.seconds, memory = MEMORY })
  local _, ended = core.child_wait { child }
  core.child_kill(child)
  if type(ended) ~= "table" then error("interrupted", 0) end
  local text = ended.value or ("-%s%s"):format(ended.outcome, ended.message and ": " .. ended.message or "")
  return text:sub(1, 1) == "+", text:sub(2):gsub("\n.*", ""), ended
end

bench.head("machine", "verb", "answer", "CPU, memory", "")
for _, machine in ipairs(machines) do
  if not asked.machine or machine.name == asked.machine then
    for _, question in ipairs(questions) do
      if not asked.verb or question.verb == asked.verb then
        local good, text, ended = answer(question, machine)
        local ok = good and ended.cpu_seconds <= asked.seconds
        if not ok then bench.missed = bench.missed + 1 end
        bench.line(("%s (`%s`)"):format(machine.what, machine.name), question.what, text,
          ("%s, %.0f MB"):format(bench.seconds(ended.cpu_seconds), ended.peak_memory / 1e6),
          ok and "works" or "**fails**")
        io.stdout:flush()
      end
    end
  end
end
bench.leave()
