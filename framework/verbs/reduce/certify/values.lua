-- reduce/certify/values.lua -- the outputs of a run at given instants, enclosed for all data at once: each as an
-- expression of the states there and, where it is smooth, as a state of its own (certify/run.lua); the intersection of
-- both.
local bracket = require "ambit.run.bracket"
local code = require "ambit.code"
local core = require "ambit.core"
local flow_of = require "ambit.reduce.certify.flow"
local instant = require "ambit.run.instant"
local ode = require "ambit.ode"
local run = require "ambit.reduce.certify.run"
local work = require "ambit.run.work"

local values = {}

-- n equal parts of the time of a scenario, and what the solver has to step on anyway.
function values.instants(times, n)
  local list, first, last = instant.like(times, {}), times[1], times[#times]
  local direction, i = last > first and 1 or -1, 1
  for k = 0, n do
    local t = k == 0 and first or k == n and last or first + (last - first) * (k / n)
    while i <= #times and times[i] * direction < t * direction do
      list[#list + 1], i = times[i], i + 1
    end
    if times[i] == t then i = i + 1 end
    list[#list + 1] = t
  end
  return list
end

-- The request with other data: each unknown replaced.
function values.at_data(q, unknowns, data)
  local changed, rates = ode.replaced(q.system, unknowns, data)
  return { initial = core.substitute(q.initial, unknowns, data), outputs = core.substitute(q.outputs, unknowns, data),
    times = q.times, system = setmetatable({ rates = rates, system = changed }, { __index = q.system }) }
end

-- The times that an instant stands for: the last one for its bracket.
local function when(q, t)
  local last = t == q.times[#q.times] and q.times.last
  return last and core.interval(last):hull(t) or core.interval(t)
end

-- Over the bracket of the end.
local function states_at_end(q, track, t)
  local function initial()
    local named = {}
    for k, x in ipairs(core.evaluate { expressions = q.initial }) do named[q.system.states[k]] = x end
    return named
  end
  return bracket.values({ track = track, states = q.system.states, system = q.system, times = q.times, rigorous = true,
    initial = initial }, q.times.last, t, t)
end

-- The enclosures of all states at an instant; nil: the run did not get there.
local function states_at(q, track, t)
  if q.times.last and t == q.times[#q.times] then return states_at_end(q, track, t) end
  if t == q.times[1] then return core.evaluate { expressions = q.initial } end
  local i, is_end = core.track_find(track, t)
  if not i then return nil end
  local list = {}
  for k in ipairs(q.system.states) do
    list[k] = is_end and core.track_value(track, i, k, false) or core.track_dense(track, i, k, t)
      or core.track_value(track, i, k, true)
  end
  return list
end

-- Not known to be defined: anything. (What is carried as a state is defined where the run is.)
local function enclosure(x, carried)
  if carried then return x.partial and carried or x:intersect(carried) end
  return x.partial and core.interval "[entire]" or x
end

local function outputs_at(q, states, x, t)
  local data = { core.expression(when(q, t)) }
  for k, value in ipairs(x) do data[k + 1] = core.expression(value) end
  local leaves = table.move(q.system.symbols, 1, #q.system.symbols, 2, { core.time() })
  local list = core.evaluate { expressions = q.outputs, leaves = leaves, values = data }
  for k, value in ipairs(list) do
    local carried
    for i, symbol in ipairs(q.system.symbols) do
      if states[k] and symbol == states[k] then carried = x[i] end
    end
    list[k] = enclosure(value, carried)
  end
  return list
end

local function solve(q, how)
  local track, facts, report = core.simulate(flow_of(q, how), nil,
    { dense = true, silent = true, threads = how.run_options and how.run_options.threads })
  facts.steps = report.steps
  if how.report then work.add(how.report, report) end
  return track, facts
end

-- With the outputs as further states; without, if the solver refuses their rates.
local function solve_carried(q, how)
  local with, states = run.carried(q)
  local good, track, facts = pcall(solve, with, how)
  if good then return with, states, track, facts end
  return q, {}, solve(q, how)
end

-- One run: { status, reason, t_reached, steps, value = { [instant] = { enclosure of each output } } }
function values.one(q, how, instants)
  local with, states, track, facts = solve_carried(q, how)
  local result = { status = facts.status, code = facts.code, reason = facts.reason,
    t_reached = facts.t_reached, steps = facts.steps,
    value = {} }
  code.refuse_broken(facts)
  if facts.status ~= "complete" then return result end
  for j, t in ipairs(instants) do result.value[j] = outputs_at(with, states, states_at(with, track, t), t) end
  return result
end

-- The hull over all boxes of the data; stops at the first that is not complete.
function values.all(q, how, instants)
  local unknowns, boxes = run.boxes(q)
  local total = { status = "complete", reason = "", t_reached = q.times[#q.times], steps = 0, value = {} }
  for b, box in ipairs(boxes) do
    local data = {}
    for j in ipairs(unknowns) do data[j] = core.expression(core.interval(box.lo[j], box.hi[j])) end
    local part = values.one(#boxes == 1 and q or values.at_data(q, unknowns, data), how, instants)
    total.steps = total.steps + part.steps
    if part.status ~= "complete" then
      total.status, total.code, total.reason, total.t_reached = part.status, part.code, part.reason, part.t_reached
      return total
    end
    for j, list in ipairs(part.value) do
      for k, x in ipairs(list) do list[k] = b == 1 and x or total.value[j][k]:hull(x) end
      total.value[j] = list
    end
  end
  return total
end

return values
