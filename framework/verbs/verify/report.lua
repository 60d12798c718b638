-- verify/report.lua -- what ambit.verify gives back: a verdict for each condition, with bounds, counterexamples and
-- reasons.
local box = require "ambit.verify.box"
local check = require "ambit.check"
local code = require "ambit.code"
local core = require "ambit.core"
local instant = require "ambit.run.instant"
local provenance = require "ambit.provenance"

local report = {}

-- -- counterexamples: one choice of the data, the middle of a box

local Counterexample = { __name = "counterexample" }
local methods = {}

-- What an expression of the data is for this choice.
function methods:value(expression)
  return core.evaluate { expressions = { core.expression(expression) }, leaves = self.unknowns,
    values = self.values }[1]
end

check.methods(methods, Counterexample)
Counterexample.__index = methods

-- What is to be printed: { { name, value } } of the initial values and of the parameters and data that are uncertain. A
-- parameter or initial value that is a datum is called as the datum, and that is not said twice.
local function lines_of(self, q)
  local lines, said, called = {}, {}, {}
  for j, name in ipairs(self.names) do called[self.unknowns[j]] = name end
  local function name_of(expression)
    for unknown, name in pairs(called) do
      if unknown == expression then return name end
    end
  end
  local function add(expression, name, value)
    local own = name_of(expression)
    if own then said[own] = true end
    lines[#lines + 1] = { own or name, value }
  end
  local order = table.move(q.system.states, 1, #q.system.states, 1, {})
  local place = {}
  for i, name in ipairs(order) do place[name] = i end
  table.sort(order)
  for _, name in ipairs(order) do add(q.initial[place[name]], "initial " .. name, self.initial[name]) end
  for _, name in ipairs(check.sorted(self.parameters)) do
    add(q.system.parameters[name], name, self.parameters[name])
  end
  for _, name in ipairs(self.names) do
    if not said[name] then lines[#lines + 1] = { name, self.data[name] } end
  end
  return lines
end

-- The middle of a box as a choice of the data: initial values, parameters and data by name.
local function choice(job, part)
  local q = job.asked
  local self = setmetatable({ unknowns = job.unknowns, names = job.names, values = {}, initial = {}, parameters = {},
    data = {} }, Counterexample)
  local middle = {}
  for j, lo in ipairs(part.lo) do
    local hi = part.hi[j]
    middle[j] = math.min(math.max(0.5 * lo + 0.5 * hi, lo), hi)
  end
  for j, x in ipairs(box.allowed(job, middle)) do
    local value = core.interval(job.lo[j], job.hi[j])
    if not job.sound_points then -- some choice of these meets the constraints
      value = core.interval(part.lo[j], part.hi[j])
    elseif job.inner.lo[j] <= job.inner.hi[j] then
      value = core.interval(x, x)
    end
    self.values[j], self.data[job.names[j]] = core.expression(value), value
  end
  for i, name in ipairs(q.system.states) do self.initial[name] = self:value(q.initial[i]) end
  for _, name in ipairs(check.sorted(q.system.parameters)) do
    local parameter = q.system.parameters[name]
    if not core.is_constant(parameter) then self.parameters[name] = self:value(parameter) end
  end
  self.lines = lines_of(self, q)
  return self
end

-- "initial x = 1", "mu = 2", "arm.offset.x = 1.5"
local function described(self)
  local parts = {}
  for i, line in ipairs(self.lines) do parts[i] = ("%s = %s"):format(line[1], tostring(line[2])) end
  return parts
end

function Counterexample.__tostring(self)
  return ("g in %s at t in %s, from\n    %s"):format(tostring(self.g), tostring(self.t),
    table.concat(described(self), "\n    "))
end

-- -- verdicts

local Verdict = { __name = "verdict" }
Verdict.__index = Verdict

local quantity = { always = "max g", at_end = "g at the end", once = "min g" }

function Verdict.__tostring(self)
  local text = ("%s: %s, %s in %s"):format(self.name, self.status, quantity[self.kind], tostring(self.bound))
  if self.counterexample then text = text .. "\n  " .. tostring(self.counterexample) end
  return self.reason ~= "" and text .. "\n  " .. self.reason or text
end

local function reason_of(job, condition, k)
  if condition.status == "broken" then return job.broken.reason end
  if condition.status == "impossible" then return job.nowhere.reason end
  if condition.status ~= "undecided" then return "" end
  local worst = condition.worst
  local why = { job.stopped and "stopped on request" or job.spent and "the budget is spent"
    or "there is nothing left to refine" }
  if #job.lo > 0 then why[#why + 1] = "hardest about " .. table.concat(described(choice(job, worst)), ", ") end
  if worst.outcome.status ~= "complete" then
    why[#why + 1] = worst.outcome.reason
  elseif worst[k].undefined then
    why[#why + 1] = "the condition is not known to be defined along the whole run"
  elseif worst[k].worst then
    why[#why + 1] = "the worst bound is at t in " .. tostring(instant.of_clock(worst[k].worst, job.asked.times.shift))
  end
  return table.concat(why, "; ")
end

local function counterexample(job, condition)
  local c, times = choice(job, condition.box), job.asked.times
  c.t = instant.of_clock(condition.finding.when or core.interval(times[1]):hull(times[#times]), times.shift)
  c.g = condition.finding.value or core.interval(condition.finding.lo, condition.finding.hi)
  return c
end

-- Empty if no part of the data is a start.
local function bound_of(condition)
  if condition.hi == -math.huge then return core.interval "[empty]" end
  return core.interval(condition.lo, math.max(condition.hi, condition.lo))
end

local function code_of(job, condition, k)
  if condition.status == "broken" then return job.broken.code end
  if condition.status == "impossible" then return job.nowhere.code end
  if condition.status ~= "undecided" then return code.of(condition.status) end
  local worst = condition.worst
  return job.stopped and "stopped.request" or job.spent and "unable.budget"
    or worst.outcome.status ~= "complete" and worst.outcome.code or worst[k].undefined and "unable.partial"
    or "unable.undecided"
end

local function verdict(job, condition, k)
  return setmetatable({ name = condition.name, kind = condition.kind, status = condition.status,
    code = code_of(job, condition, k), bound = bound_of(condition), reason = reason_of(job, condition, k),
    counterexample = condition.status == "refuted" and counterexample(job, condition) or nil }, Verdict)
end

-- -- the whole

local Report = { __name = "verification" }
Report.__index = Report

function Report.__tostring(self)
  local lines = { ("%s after %d run%s"):format(self.status, self.refinements + 1, self.refinements == 0 and "" or "s") }
  for _, c in ipairs(self.list) do lines[#lines + 1] = tostring(c) end
  for _, line in ipairs(provenance.tail()) do lines[#lines + 1] = line end
  return table.concat(lines, "\n")
end

-- What decides the whole: refuted if one condition is, proved if all are. The others hold of all conditions or of none.
local ranks = { "refuted", "broken", "impossible", "undecided" }

local function overall(list)
  for _, status in ipairs(ranks) do
    for _, c in ipairs(list) do
      if c.status == status then return status, c.code end
    end
  end
  return "proved", "ok"
end

local function reasons(list)
  local lines = {}
  for _, c in ipairs(list) do
    if c.reason ~= "" then lines[#lines + 1] = c.name .. ": " .. c.reason end
  end
  return table.concat(lines, "; ")
end

-- What the conditions say of the whole; its bound and counterexample are those of the first with its status.
local function conclude(self)
  self.status, self.code = overall(self.list)
  self.reason, self.bound, self.counterexample = reasons(self.list), nil, nil
  for _, c in ipairs(self.list) do
    if c.status == self.status and not self.bound then self.bound, self.counterexample = c.bound, c.counterexample end
  end
  return self
end

-- A finished search -> its report.
function report.of(job)
  local list, by_name = {}, {}
  for k, condition in ipairs(job.conditions) do
    list[k] = verdict(job, condition, k)
    by_name[condition.name] = list[k]
  end
  return conclude(setmetatable({ list = list, conditions = by_name, refinements = job.runs - 1,
    cpu_seconds = core.cpu() - job.start, report = job.report }, Report))
end

-- The same as an answer for all times: what was not reached until the end of a run may be reached later.
function report.for_ever(self)
  for _, c in ipairs(self.list) do
    if c.kind == "once" and c.status == "refuted" then
      c.status, c.code, c.counterexample = "undecided", "unable.undecided", nil
      c.reason = "it was not reached for all data while solutions were followed; later it may be"
    end
    -- of a least value nothing is known from below, of a largest one no more than that a proved one is not positive
    local least, most = c.bound.lo, c.bound.hi
    if c.kind == "always" then most = c.status == "proved" and math.max(most, 0) or math.huge end
    if c.kind == "once" then least = -math.huge end
    if not c.bound:is_empty() then c.bound = core.interval(least, most) end
  end
  return conclude(self)
end

-- Conditions about which no run was needed: proved, or undecided for this reason.
function report.without_run(conditions, reason)
  local list, by_name, status = {}, {}, reason and "undecided" or "proved"
  for k, c in ipairs(conditions) do
    list[k] = setmetatable({ name = c.name, kind = c.kind, status = status, code = code.of(status),
      reason = reason or "", bound = core.interval(-math.huge, reason and math.huge or 0) }, Verdict)
    by_name[c.name] = list[k]
  end
  return setmetatable({ list = list, conditions = by_name, status = status, code = code.of(status),
    reason = reason or "", refinements = 0, bound = list[1].bound, report = {} }, Report)
end

-- { name, { "status", ..., "bound", ... }, ... }: for the result's record
function report.fields(self)
  local fields = {}
  for _, c in ipairs(self.list) do
    fields[#fields + 1], fields[#fields + 2] = c.name, { "status", c.status, "bound", c.bound, "code", c.code }
  end
  return fields
end

return report
