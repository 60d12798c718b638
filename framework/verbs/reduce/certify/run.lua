-- reduce/certify/run.lua -- a rigorous bound of |g| over all times of a run, for each of several g at once.
--
-- g is bounded over the enclosure of the states at each time, and, where it is smooth, as a further state of the system
-- (verify/carry.lua), which keeps what the states have in common; both hold, the tighter one is taken. Uncertain data
-- may be cut into boxes: the bound is the greatest over them.
local carry = require "ambit.verify.carry"
local core = require "ambit.core"
local flow_of = require "ambit.reduce.certify.flow"
local code = require "ambit.code"
local refine = require "ambit.reduce.certify.refine"
local uncertain = require "ambit.run.uncertain"
local work = require "ambit.run.work"

local run = {}

local CUTS = 64         -- in time, for each bound in each step
local NO_RIVALS = 2 ^ 31 -- only somebody's rival

-- -- boxes of the data

-- The uncertain data of a request, as uncertain.data gives them.
function run.data(q)
  local all = table.move(q.initial, 1, #q.initial, 1, {})
  table.move(q.system.rates, 1, #q.system.rates, #all + 1, all)
  table.move(q.outputs, 1, #q.outputs, #all + 1, all)
  return uncertain.data(all)
end

-- Into how many parts each datum is cut; a number of pieces is spread evenly over all.
local function parts_of(unknowns, fields)
  local parts, left = {}, (fields.pieces or 1) > 0 and fields.pieces or 1
  for j, unknown in ipairs(unknowns) do
    parts[j] = 1
    for _, cut in ipairs(fields.cuts or {}) do
      if cut.unknown == unknown then parts[j] = math.max(1, cut.parts) end
    end
  end
  local j = 1
  while #unknowns > 0 and left >= 2 do
    parts[j], left, j = parts[j] * 2, left / 2, j % #unknowns + 1
  end
  return parts
end

local function cut_points(lo, hi, parts)
  local at = { lo }
  for k = 1, parts - 1 do at[k + 1] = math.min(math.max(lo + (hi - lo) * (k / parts), at[k]), hi) end
  at[parts + 1] = hi
  return at
end

-- { { lo = {}, hi = {} }, ... } that cover the data
function run.boxes(q)
  local unknowns, lo, hi = run.data(q)
  local boxes = { { lo = {}, hi = {} } }
  for j, parts in ipairs(parts_of(unknowns, q.split or {})) do
    local at, finer = cut_points(lo[j], hi[j], parts), {}
    for _, b in ipairs(boxes) do
      for k = 1, parts do
        local box = { lo = table.move(b.lo, 1, #b.lo, 1, {}), hi = table.move(b.hi, 1, #b.hi, 1, {}) }
        box.lo[j], box.hi[j] = at[k], at[k + 1]
        finer[#finer + 1] = box
      end
    end
    boxes = finer
  end
  return unknowns, boxes
end

-- -- what is watched

local function is_state(system, g)
  for _, symbol in ipairs(system.symbols) do
    if symbol == g or symbol == -g then return true end
  end
  return false
end

-- The request with those outputs as states that are not plain states already: request, { [k] = state }
function run.carried(q)
  local conditions, number = {}, {}
  for k, g in ipairs(q.outputs) do
    if not core.is_constant(g) and not is_state(q.system, g) then
      conditions[#conditions + 1], number[#conditions + 1] = { name = tostring(k), g = g }, k
    end
  end
  if #conditions == 0 then return q, {} end
  local with, states = carry.of(q, conditions)
  local by_output = {}
  for n, state in pairs(states) do by_output[number[n]] = state end
  return with, by_output
end

-- For each output g, carried as c: both behind each other, in the order of core.watch.
local function watched(q, states, limits)
  local w = { conditions = {}, of = {} }
  local function add(k, expression, rivals)
    local n = #w.of + 1
    w.conditions[n] = { g = expression, name = ("output %d"):format(k), kind = "most",
      limit = limits and limits[k] or 0, rivals = rivals }
    w.of[n] = k
  end
  for k, g in ipairs(q.outputs) do
    add(k, g, states[k] and 1 or 0)
    if states[k] then add(k, states[k], NO_RIVALS) end
  end
  return w
end

local function watch(q, w, how, unknowns, box)
  local findings, outcome, report = core.watch(flow_of(q, how), { conditions = w.conditions, cuts = CUTS,
    unknowns = unknowns, lo = box.lo, hi = box.hi, threads = how.run_options and how.run_options.threads,
    last = q.times.last })
  if how.report then work.add(how.report, report) end
  return findings, outcome, report
end

-- A run for its own sake: how far it gets.
function run.alone(q, how, unknowns, box)
  local nothing = { conditions = {} }
  local _, outcome, report = watch(q, nothing, how, unknowns, box)
  return outcome, report
end

-- Each output's bound of |g|: the smaller of the two forms.
local function bounds_of(q, w, findings)
  local bounds, when = {}, {}
  for n, finding in ipairs(findings) do
    local k = w.of[n]
    if not bounds[k] or finding.hi < bounds[k] then
      bounds[k], when[k] = finding.hi, finding.worst and finding.worst:mid() or q.times[1]
    end
  end
  return bounds, when
end

local function first_run(q, how, limits, unknowns, box)
  local with, states = run.carried(q)
  local w = watched(q, states, limits)
  local good, findings, outcome, report = pcall(watch, with, w, how, unknowns, box)
  if good then return with, w, findings, outcome, report end
  w = watched(q, {}, limits) -- the solver may refuse the rate of an output, which is no reason to refuse the output
  return q, w, watch(q, w, how, unknowns, box)
end

local knob = "; a finer `split` of the data, another `solver`, a shorter `t` or a smaller `tolerance` may help"

local function why(outcome, box_count)
  if outcome.gave_up then return "an output is off by more than its bound" end
  local reason = outcome.reason ~= "" and outcome.reason or "no bound of an output was found"
  return reason .. (box_count > 1 and " (in one part of the data)" or "") .. knob
end

-- Runs over a box: box.bound, box.when; false if there is no bound, and job.result says why.
local function solve(job, box)
  local findings, outcome, report
  local result = job.result
  if not job.watched then
    job.with, job.watched, findings, outcome, report = first_run(job.q, job.how, job.limits, job.unknowns, box)
  else
    findings, outcome, report = watch(job.with, job.watched, job.how, job.unknowns, box)
  end
  result.steps, result.arithmetic = result.steps + report.steps, report.arithmetic
  box.bound, box.when = bounds_of(job.q, job.watched, findings)
  local finite = true
  for k, bound in ipairs(box.bound) do
    if outcome.impossible then box.bound[k] = 0 end -- no solution starts here
    finite = finite and bound < math.huge
  end
  if outcome.impossible or (outcome.status == "complete" and finite) then return true end
  code.refuse_broken(outcome)
  local stopped = outcome.status == "stopped" and not outcome.gave_up
  result.status, result.exceeded = stopped and "stopped" or "unable", outcome.gave_up
  result.t_reached = outcome.t_reached
  result.code = outcome.gave_up and "unable.bound" or outcome.code
  if result.code == "ok" then result.code = "unable.partial" end
  result.reason = stopped and "stopped on request" or why(outcome, job.boxes)
  return false
end

-- A part of a box that has a bound: if it fails, what holds for the whole still does.
local function solve_part(job, box)
  local result = job.result
  if solve(job, box) then return true end
  if result.status == "unable" then
    result.status, result.code, result.reason, result.exceeded = "proved", "ok", "", false
    result.t_reached = job.q.times[#job.q.times]
  end
  return false
end

-- The greatest over all boxes.
local function collect(job, boxes)
  local result = job.result
  result.bound, result.when = {}, {}
  for _, box in ipairs(boxes) do
    for k, bound in ipairs(box.bound) do
      if not result.bound[k] or bound > result.bound[k] then result.bound[k], result.when[k] = bound, box.when[k] end
    end
  end
  return result
end

-- q: { system, initial, times, outputs = { g }, split }; how: { solver, arithmetic, arithmetic_options, options,
-- run_options, refine = most further runs over parts of the data, gain = see refine.run }; goals: nil, or { what the
-- bounds should come down to, 0: nothing }; gives_up: as soon as a bound is surely above its goal (with refine: far
-- above), the run is given up
-- -> { status = "proved" | "unable" | "stopped", reason, t_reached, bound = { |g| <= }, when, steps, cpu_seconds,
-- exceeded: given up because of a limit }
function run.bounds(q, how, goals, gives_up)
  local start, refines = core.cpu(), (how.refine or 0) > 0
  local job = { q = q, how = how, limits = gives_up and goals }
  job.result = { status = "proved", reason = "", t_reached = q.times[#q.times], bound = {}, when = {}, steps = 0,
    exceeded = false, solver = how.solver, arithmetic = how.arithmetic }
  local boxes
  job.unknowns, boxes = run.boxes(q)
  job.boxes = #boxes
  if refines and gives_up then
    job.limits = {}
    for k, goal in ipairs(goals) do job.limits[k] = refine.REACH * goal end
  end
  for _, box in ipairs(boxes) do
    if not solve(job, box) then break end
  end
  if job.result.status == "proved" and refines then
    refine.run(q, job.unknowns, boxes, goals, how.refine, function(box) return solve_part(job, box) end, how.gain)
  end
  if job.result.status == "proved" then collect(job, boxes) end
  job.result.cpu_seconds = core.cpu() - start
  return job.result
end

return run
