-- view/motion.lua -- when a mechanism is looked at, and where its coordinates are then.
--
-- A motion has instants 1 .. n: t[i], at[i]: enclosures of the coordinates at t[i], by name; over[i], between instants
-- i and i + 1: a list of { t = enclosure, values }, each of which holds for all times in its t (the tubes of the steps
-- of a run), together for all times from t[i] to t[i + 1].
local core = require "ambit.core"
local instant = require "ambit.run.instant"

local motion = {}

local MOST_TUBES = 4    -- looked at between two instants; more are put together
local MOST_SECONDS = 20 -- that a repeated simulation may take

local function span(a, b) return core.enclosure(math.min(a, b), math.max(a, b)) end

local function hull_of(tubes, first, last)
  local hull = { t = tubes[first].t, values = {} }
  for name, x in pairs(tubes[first].values) do hull.values[name] = x end
  for i = first + 1, last do
    hull.t = hull.t:hull(tubes[i].t)
    for name, x in pairs(tubes[i].values) do hull.values[name] = hull.values[name]:hull(x) end
  end
  return hull
end

-- As many as can be looked at, each the hull of consecutive ones.
local function condensed(tubes)
  if #tubes <= MOST_TUBES then return tubes end
  local list, size = {}, math.ceil(#tubes / MOST_TUBES)
  for first = 1, #tubes, size do list[#list + 1] = hull_of(tubes, first, math.min(first + size - 1, #tubes)) end
  return list
end

local function steps_of(run)
  local list = {}
  for step in run:steps() do list[#list + 1] = step end
  return list
end

-- About `count` instants from the start to what was reached, the given ones among them; nil: there is no room for them.
local function finer(given, reached, count)
  local times, whole = instant.like(given, { given[1] }), math.abs(reached - given[1])
  for i = 2, #given do
    local from, to = given[i - 1], given[i]
    local beyond = math.abs(to - given[1]) >= whole
    if beyond then to = reached end
    local parts = math.max(1, math.floor(count * math.abs(to - from) / whole + 0.5))
    for k = 1, parts do
      local t = k == parts and to or from + (to - from) * (k / parts)
      if t == times[#times] then return nil end
      times[#times + 1] = t
    end
    if beyond then break end
  end
  return times
end

-- A solver of high order makes few steps. The same question asked again, with instants in between at which steps end,
-- tells more about the way from one to the next. Where that proves less, the first answer stands.
local function refined(run, question, count)
  local steps = run.step_count
  if steps == 0 or steps >= count / 2 or run.cpu_seconds / steps * count > MOST_SECONDS then return run end
  local times = finer(question.times, run.t_reached, count)
  if not times then return run end
  local good, again = pcall(run.question.again, { last = false }, times)
  return good and again.status == "complete" and again.t_reached == run.t_reached and again or run
end

-- The last step of a run that ends in a bracket is that: what it says belongs to one instant.
local function add_end(self, run, step)
  local n, way = #self.t, self.over[#self.t - 1]
  self.t[n], self.at[n] = run.times.final.near, run.x
  if way then way[#way + 1] = step.has_tube and { t = span(step.clock_from, step.clock), values = step.tube } or nil end
end

-- Between the instants of a run: at most `count` of them, at ends of steps.
local function collect(run, count)
  local steps, t_start = steps_of(run), run.t_start
  local last = #steps > 1 and steps[#steps].clock_from == run.times.last and table.remove(steps) or nil
  local self = { t = { t_start }, at = { run.initial() }, over = {} }
  local tubes, length = {}, #steps > 0 and (steps[#steps].clock - t_start) / count or 0
  local all = steps[1] and steps[1].clock_from == t_start -- a run may have kept its last step only
  for i, step in ipairs(steps) do
    if step.has_tube then tubes[#tubes + 1] = { t = span(step.clock_from, step.clock), values = step.tube } end
    if i == #steps or #steps <= count or (step.clock - t_start) / length >= #self.t then
      self.over[#self.t] = step.has_tube and (all or #self.t > 1) and condensed(tubes) or false
      self.t[#self.t + 1], self.at[#self.at + 1] = step.clock, step.x
      tubes = {}
    end
  end
  if last then add_end(self, run, last) end
  return self
end

-- A given value may depend on time: its enclosure over t.
local function value_over(e, t)
  local leaf
  for _, entry in ipairs(core.leaves { e }) do
    if entry.kind == "time" then leaf = entry.expression end
  end
  if not leaf then return e end
  return core.evaluate { expressions = { e }, leaves = { leaf }, values = { core.expression(t) } }[1]
end

local function put(values, given, t)
  for name, e in pairs(given) do rawset(values, name, value_over(e, t)) end
end

-- given: values of coordinates that are no states of the run; count 0: only the start. The result's `again`: steps of
-- the repeated simulation, if there was one.
function motion.of_run(run, question, given, count)
  local self = { t = { run.t_start }, at = { run.initial() }, over = {} }
  if count > 0 then
    local fine = refined(run, question, count)
    self = collect(fine, fine == run and count or fine.step_count)
    self.again = fine ~= run and fine.step_count or nil
  end
  local function time(t) return instant.of_clock(t, run.times.shift) end
  for i, t in ipairs(self.t) do
    local final = i == #self.t and i > 1 and run.times.final
    put(self.at[i], given, time(final and core.enclosure(final.lo, final.hi) or core.enclosure(t, t)))
    for _, tube in ipairs(self.over[i] or {}) do put(tube.values, given, time(tube.t)) end
  end
  return self
end

-- -- without a run

local function is_quaternion(d)
  for _, port in ipairs(d.outs) do
    if port.kind == "joint" and port.coordinates > port.dof then return true end
  end
  return false
end

-- The unit quaternion of no rotation, whose scalar part is the first; everything else is zero.
local function at_rest(m)
  local values = {}
  for _, c in ipairs(core.coordinates(m.handle)) do
    local q = is_quaternion(m.declared[c.part]) and c.name:find "%.1$" and 1 or 0
    values[c.name] = core.enclosure(q, q)
  end
  return values
end

local function values_over(rest, given, t)
  local values = {}
  for name, x in pairs(rest) do values[name] = x end
  put(values, given, t)
  return values
end

-- times nil: one instant, t = 0; count 0: only the start
function motion.given(m, given, times, count)
  local rest, self = at_rest(m), { t = {}, at = {}, over = {} }
  local first, last = times and times[1] or 0.0, times and times[#times] or 0.0
  for i = 0, times and count or 0 do
    local t = i == 0 and first or i == count and last or first + (last - first) * (i / count)
    self.t[i + 1], self.at[i + 1] = t, values_over(rest, given, core.enclosure(t, t))
    if i > 0 then
      local between = span(self.t[i], t)
      self.over[i] = { { t = between, values = values_over(rest, given, between) } }
    end
  end
  return self
end

return motion
