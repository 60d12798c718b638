-- suite/judge.lua -- what a child process brought back, held against what is expected of its combination.
local case_of = require "ambit.suite.case"
local option = require "ambit.option"
local provenance = require "ambit.provenance"
local wire = require "ambit.wire"

local judge = {}

-- Words by which a message of the interpreter is told from one of Ambit: these are faults, not refusals.
local faults = { "attempt to ", "bad argument", "stack overflow", "wire: ", "no question is called",
  "the reference names" }

local function is_fault(message)
  for _, text in ipairs(faults) do
    if message:find(text, 1, true) then return true end
  end
  return false
end

-- Keys of the verbs that a reason can name besides the solver's own options.
local of_verbs = { "solver", "arithmetic", "initial", "split", "threads", "events", "end before",
  "data" }

-- A time, or the start by name.
local function names_time(reason)
  return reason:find "t = %-?%d" ~= nil or reason:find "t in %[" ~= nil or reason:find "^the initial values" ~= nil
end

local function names_knob(reason, solver)
  local words = { table.unpack(of_verbs) }
  if solver then
    local good, declaration = pcall(option.declaration, "solver", solver)
    for _, parameter in ipairs(good and declaration.parameters or {}) do words[#words + 1] = parameter.name end
  end
  for _, word in ipairs(words) do
    if reason:find("%f[%w_]" .. word .. "%f[^%w_]") then return true end
  end
  return false
end

-- A solver that gives up says when, why, and what to turn; nil: it does.
local function missing_in(reason, question, solver)
  if not reason or reason == "" then return "gives no reason" end
  if question == "simulate" and not names_time(reason) then return "names no time" end
  if not names_knob(reason, solver) then return "names nothing to turn" end
end

local function one_line(text) return (text:gsub("%s*\n%s*", "; ")) end

-- What core.child_wait says -> a row, not yet judged.
local function row_of(ended, case)
  if ended.outcome == "done" then
    local row = wire.read(provenance.take(ended.value))
    if row.reason then row.reason = one_line(row.reason) end
    return row
  end
  local row = { seconds = ended.cpu_seconds, reason = ended.message and one_line(ended.message) }
  if ended.outcome == "failed" then
    row.outcome = is_fault(row.reason or "") and "crashed" or "refused"
  else
    row.outcome = ended.outcome
    row.reason = row.reason or ended.outcome == "crashed" and ("signal %s"):format(ended.signal or "?")
      or ended.outcome == "late" and ("no answer within %g s of CPU time"):format(case.cpu)
      or ("more than %.3g bytes"):format(case.memory)
  end
  return row
end

local rank = { crashed = 0, wrong = 0, ["out of memory"] = 1, late = 2, refused = 3, unable = 4, computed = 5,
  proved = 5 }

-- "as expected", "changed" or "better", and in what.
local function verdict(row, question)
  if row.outcome == "wrong" or row.outcome == "crashed" then return "changed", row.outcome end
  if not rank[row.outcome] then return "changed", ("an outcome that nobody knows, %s"):format(tostring(row.outcome)) end
  if row.outcome == "refused" and (row.reason or "") == "" then return "changed", "the reason gives no reason" end
  if row.outcome == "unable" then
    local missing = missing_in(row.reason, question, row.solver)
    if missing then return "changed", "the reason " .. missing end
  end
  if row.expected and row.outcome ~= row.expected then
    return rank[row.outcome] > (rank[row.expected] or 0) and "better" or "changed",
      ("expected %s"):format(row.expected)
  end
  local least = row.least or {}
  if least.t_reached and not ((row.t_reached or -math.huge) >= least.t_reached) then
    return "changed", ("expected to reach t = %.9g"):format(least.t_reached)
  end
  if least.digits and not ((row.digits or 0) >= least.digits) then
    return "changed", ("expected %g digits"):format(least.digits)
  end
  return "as expected"
end

-- ended: of core.child_wait -> row of the result
function judge.row(ended, case, c)
  local row = row_of(ended, case)
  row.solver, row.options, row.memory = c.solver, c.options_text, ended.memory
  row.arithmetic = row.arithmetic or c.arithmetic
  row.expected, row.least = case_of.expected(case, c), case_of.least(case, c)
  row.verdict, row.changed = verdict(row, case.question)
  return row
end

return judge
