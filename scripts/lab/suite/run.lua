-- suite/run.lua -- runs cases, each combination in a process of its own, two side by side, and collects the result:
--
-- { quick, version, cpu_seconds, changed, interrupted, cases = { { name, group, title, source, question, rows = {
--   { solver, arithmetic, options, outcome, reason, t_reached, t_end, width, digits, seconds, steps, memory, expected,
--     least, verdict, changed (in what) } } } } }
--
-- outcome: "proved", "computed" (by a solver that proves nothing), "unable", "refused", "late", "out of memory",
-- "crashed", "wrong". verdict: "as expected", "changed", "better".
local core = require "ambit.core"
local judge = require "ambit.suite.judge"
local measure = require "ambit.suite.measure"
local over = require "ambit.suite.over"
local provenance = require "ambit.provenance"
local wire = require "ambit.wire"

local suite = {}

local SIDE_BY_SIDE = 2
local GLANCE = 0.25 -- s between two looks at the progress

-- Wall time after which a child that computes nothing is killed.
local function wall(case) return case.wall or 10 * case.cpu + 60 end

-- budget: a factor on the times, for slow machines and checked builds
local function start(job, budget)
  local case, c = job.case, job.combination
  return core.child(function() return provenance.with(wire.write(measure.row(case, c))) end,
    { cpu = budget * case.cpu, wall = budget * wall(case), memory = case.memory })
end

local function jobs_of(cases)
  local jobs = {}
  for i, entry in ipairs(cases) do
    for k, c in ipairs(entry.combinations) do
      jobs[#jobs + 1] = { case = entry.case, combination = c, i = i, k = k }
    end
  end
  return jobs
end

-- Calls found(job, ended) for each job as it ends; false: interrupted, with `children` still running.
local function work(jobs, children, budget, found, progress)
  local running, next_job, done = {}, 1, 0
  while next_job <= #jobs or #children > 0 do
    while #children < SIDE_BY_SIDE and next_job <= #jobs do
      children[#children + 1], running[#running + 1] = start(jobs[next_job], budget), jobs[next_job]
      next_job = next_job + 1
    end
    if progress then progress(done, #jobs, running) end
    local index, ended = core.child_wait(children, GLANCE)
    if index and not core.interrupted() then
      table.remove(children, index)
      found(table.remove(running, index), ended)
      done = done + 1
    elseif ended == "interrupted" or core.interrupted() then
      return false
    end
  end
  return true
end

-- The same, and what was running is thrown away. Ctrl-C between two waits is an error in Lua.
local function work_until_interrupted(...)
  local jobs, children = ..., {}
  local good, whole = pcall(work, jobs, children, select(2, ...))
  for _, child in ipairs(children) do core.child_kill(child) end
  if not good and not core.interrupted() then error(whole, 0) end
  return good and whole
end

local function case_row(case)
  return { name = case.name, group = case.group, title = case.title, source = case.source, question = case.question,
    rows = {} }
end

-- Rows that came in any order, in the order of their combinations; cases without a row are left out.
local function in_order(list)
  local cases = {}
  for _, entry in ipairs(list) do
    local rows = {}
    for k = 1, entry.count do rows[#rows + 1] = entry.found[k] end
    entry.row.rows = rows
    if #rows > 0 then cases[#cases + 1] = entry.row end
  end
  return cases
end

-- selected: of suite.select; options: { quick, budget, progress = function(done, total, running jobs) }
function suite.run(selected, options)
  local result = { quick = options.quick or false, version = core.version, cpu_seconds = 0, changed = 0 }
  local list = {}
  for i, entry in ipairs(selected) do
    list[i] = { row = case_row(entry.case), count = #entry.combinations, found = {} }
  end
  local whole = work_until_interrupted(jobs_of(selected), options.budget or 1, function(job, ended)
    local row = judge.row(ended, job.case, job.combination)
    list[job.i].found[job.k] = row
    result.cpu_seconds = result.cpu_seconds + ended.cpu_seconds
    if row.verdict ~= "as expected" then result.changed = result.changed + 1 end
  end, options.progress)
  result.interrupted = not whole
  result.cases = in_order(list)
  return result
end

suite.label = over.label

return suite
