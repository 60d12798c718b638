-- stability.lua -- `ambit stability`: the suite of stiff, chaotic and extreme cases, held against what is expected.
local core = require "ambit.core"
local provenance = require "ambit.provenance"
local files = require "ambit.command.stability.files"
local scene = require "ambit.command.scene"
local select_cases = require "ambit.suite.select"
local suite = require "ambit.suite.run"
local suite_table = require "ambit.suite.table"

local command = {}

command.usage = [[
usage: ambit stability [CASES.lua] [--quick] [--group NAME] [--case NAME] [--solver NAME] [--budget FACTOR]
                       [--html FILE] [--json FILE|-] [--csv FILE] [--markdown FILE]
Runs stiff, chaotic and extreme problems over the solvers and arithmetics, each in a process with a budget of time and
memory, and says for each what came of it: proved, computed (by a solver that proves nothing), unable with its reason,
refused, late, out of memory; how far, how wide, how many digits are right, at what cost. Each outcome is held against
the expected one. CASES.lua: a file of your own that returns a list of cases.
  --quick          the short cases only
  --group NAME     stiff, chaotic or extreme
  --case NAME      one case
  --solver NAME    one solver (or one arithmetic, where nothing moves in time)
  --budget FACTOR  multiplies the time that each run has, for slow machines
  --html FILE      one page that works offline
  --json FILE      the whole result as one object; `-` is standard output (the table then goes to standard error)
  --csv FILE       one line for each row
  --markdown FILE  the tables as Markdown
Ctrl-C ends it; what was done is shown and written.
exit: 0 everything as expected, 1 error in a case or a file, 3 an outcome has changed, 130 interrupted]]

local known = { quick = false, group = true, case = true, solver = true, html = true, json = true, csv = true,
  markdown = true, budget = true }

local function complain(message) io.stderr:write("ambit: ", tostring(message), "\n") end

-- One line on a terminal that shows how far it is and what runs.
local function progress_line()
  if not core.terminal "stderr" then return nil, function() end end
  local room = 24
  return function(done, total, running)
    local names = {}
    for i, job in ipairs(running) do names[i] = job.case.name .. " " .. suite.label(job.combination) end
    local full = total > 0 and room * done // total or room
    io.stderr:write(("\r\27[K[%s%s] %d of %d: %s"):format(("#"):rep(full), ("."):rep(room - full), done, total,
      table.concat(names, ", "):sub(1, 90)))
    io.stderr:flush()
  end, function() io.stderr:write "\r\27[K" end
end

local function print_result(result, out)
  local coloured = out == io.stdout and core.terminal "stdout" and (os.getenv "NO_COLOR" or "") == ""
  local room = out == io.stdout and core.terminal "stdout" and (tonumber(os.getenv "COLUMNS") or 160) or nil
  out:write(suite_table.text(result, coloured, room), "\n")
  local update = suite_table.update(result)
  if update ~= "" then complain("not as expected:\n" .. update) end
end

local function code_of(result)
  if result.interrupted then return 130 end
  return result.changed > 0 and 3 or 0
end

local function run(selected, options)
  local show, clear = progress_line()
  local how = { quick = options.quick, budget = tonumber(options.budget), progress = show }
  local good, result = pcall(suite.run, selected, how)
  clear()
  if not good then return complain(result) or 1 end
  print_result(result, options.json == "-" and io.stderr or io.stdout)
  local written, problem = pcall(files.write, result, options)
  if not written then return complain(problem) or 1 end
  if result.interrupted then complain "interrupted: what was done up to there is kept" end
  return code_of(result)
end

function command.run(list)
  local options, file, words = scene.arguments(list, known, true, true)
  if not options then return 2, file end
  if words[1] then return 2, ("expected one file of cases, got also `%s`"):format(words[1]) end
  if options.budget and not ((tonumber(options.budget) or 0) > 0) then
    return 2, ("--budget: expected a positive number, got `%s`"):format(options.budget)
  end
  local problem = files.problem(options)
  if problem then return complain(problem) or 1 end
  local good, selected = pcall(function()
    return select_cases.of(file and select_cases.file(file) or select_cases.own(), options)
  end)
  if not good then return complain(selected) or 1 end
  if #selected == 0 then return complain "no case is left of what was asked for" or 1 end
  return run(selected, options)
end

return command
