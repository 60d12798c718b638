-- loops.lua -- closed loops of a mechanism: constraints, independent coordinates, multipliers, rank.
local check = require "ambit.check"
local core = require "ambit.core"
local Matrix = require "ambit.matrix"
local session = require "ambit.session"
local shape = require "ambit.shape"

local methods = {}

-- What follows from the choice of independent coordinates has to be made again.
local function forget(self)
  self.cached, self.cached_parts = false, false
end

local function coordinate_names(self)
  local names = {}
  for i, c in ipairs(core.coordinates(self.handle)) do names[i] = c.name end
  return names
end

local function need_loops(self, what)
  if core.has_constraints(self.handle) then return end
  check.fail("%s: the mechanism `%s` has no closed loops; elements whose names begin with `close_` close them", what,
    self.name)
end

-- { row name = residual }: what vanishes in every assembled configuration.
function methods:constraints()
  local rows, t = core.constraints(self.handle), {}
  for _, row in ipairs(rows) do t[row.name] = row.residual end
  return setmetatable(t, Matrix)
end

-- m:independent { "beta" }: these are to determine the others. Without an argument: which ones do.
function methods:independent(names)
  if names == nil then return core.loops(self.handle).independent end
  if type(names) == "string" then names = { names } end
  check.table(names, "independent")
  check.keys(names, {}, "independent", #names)
  local known = coordinate_names(self)
  for _, s in ipairs(core.speeds(self.handle)) do known[#known + 1] = s.name end
  local is_known, said = {}, {}
  for _, name in ipairs(known) do is_known[name] = true end
  for _, name in ipairs(names) do
    if not is_known[name] then
      check.fail("independent: there is no coordinate `%s`%s", tostring(name), check.suggest(name, known))
    end
    if said[name] then check.fail("independent: `%s` is named twice", name) end
    said[name] = true
  end
  core.loops_choose(self.handle, names)
  forget(self)
end

-- What a user writes, as a set of numbers.
local function set_of(value, unit, what)
  return core.evaluate { expressions = { core.expression(value, unit, what) } }[1]
end

-- m:reference { beta = "-0.06" }: the assembled configuration at which the independent coordinates are chosen (of sets
-- the middle); what is not said starts at 0, and so does t. Without an argument: the one that is used.
function methods:reference(t)
  if t == nil then return core.loops(self.handle).reference end
  check.table(t, "reference")
  local units, known = { t = "s" }, { "t" }
  for i, c in ipairs(core.coordinates(self.handle)) do units[c.name], known[i + 1] = c.unit, c.name end
  check.keys(t, known, "reference")
  local names, values = check.sorted(t), {}
  for i, name in ipairs(names) do values[i] = set_of(t[name], units[name], "reference: " .. name):mid() end
  core.loops_refer(self.handle, names, values)
  rawset(self, "has_reference", true)
  forget(self)
end

-- Names of rows that the others imply, at the reference configuration and near it, and of those that are 0 = 0.
function methods:redundant()
  need_loops(self, "redundant")
  local found = core.loops(self.handle).redundant
  local _, trivial = core.constraints(self.handle)
  return table.move(trivial, 1, #trivial, #found + 1, found)
end

-- { row name = multiplier } as functions of the states: the forces (N) and torques (N m) that keep the loops closed.
function methods:multipliers()
  need_loops(self, "multipliers")
  local t = {}
  for _, row in ipairs(core.multipliers(self.handle)) do t[row.name] = row.multiplier end
  return setmetatable(t, Matrix)
end

-- Expressions in which dependent speeds, accelerations and multipliers are replaced by what the states make of them.
function methods:of_states(value)
  local expressions, _, rebuild = shape.flatten(value, "of_states")
  return rebuild(core.of_states(self.handle, expressions))
end

-- { lo, hi } or anything that is a set of numbers
local function bounds(value, unit, what)
  if type(value) == "table" and getmetatable(value) == nil then
    if #value ~= 2 then check.fail("%s: expected { lo, hi }, got a list of %d", what, #value) end
    local lo, hi = set_of(value[1], unit, what).lo, set_of(value[2], unit, what).hi
    if lo > hi then
      check.fail("%s: the range is empty: %s is greater than %s", what, core.literal(lo), core.literal(hi))
    end
    return lo, hi
  end
  local x = set_of(value, unit, what)
  return x.lo, x.hi
end

local function certify_rank(self, t)
  need_loops(self, "rank")
  check.table(t, "rank")
  check.keys(t, { "box", "t", "boxes" }, "rank")
  check.table(t.box, "rank: box")
  local units, known = {}, {}
  for i, c in ipairs(core.coordinates(self.handle)) do units[c.name], known[i] = c.unit, c.name end
  check.keys(t.box, known, "rank: box")
  local names, lo, hi = check.sorted(t.box), {}, {}
  for i, name in ipairs(names) do lo[i], hi[i] = bounds(t.box[name], units[name], "rank: box." .. name) end
  local from, to = bounds(t.t or 0, "s", "rank: t")
  return core.rank(self.handle,
    { names = names, lo = lo, hi = hi, from = from, to = to, boxes = check.count(t.boxes or 10000, "rank: boxes") })
end

-- What the verdicts mean for the exit code: a proof that the rank is lost is an answer.
local ranks = { proved = "ok", empty = "ok.none", singular = "ok.refuted", undecided = "unable.undecided" }

-- m:rank { box = { beta = { lo, hi }, ... }, t = { lo, hi }, boxes = 10000 } -> { status = "proved", "undecided",
-- "singular" or "empty"; code, reason, independent, dependent, redundant, rows, boxes }
function methods:rank(t)
  local start, found = core.cpu(), certify_rank(self, t)
  found.code, found.reason, found.cpu_seconds = ranks[found.status], "", core.cpu() - start
  if found.status == "undecided" then
    local names = table.concat(found.loops, "`, `")
    found.reason = ("the constraint Jacobian of `%s` may lose rank; narrow the box, or raise `boxes`"):format(names)
  end
  session.finish("rank", found, {}, { "boxes", found.boxes })
  return found
end

local loops = {}

-- The states at about the last hundredth of a run; nil: nothing is kept of then. Not every solver says something
-- between its steps.
local function before_end(run)
  local length, found = run.t_reached - run.t_start, nil
  local good, x = pcall(run.at, run, run.t_reached - length / 100)
  if good then return x end
  for step in run:steps() do
    if (run.t_reached - step.clock) / length < 0.01 then break end
    found = step
  end
  return found and found.x
end

-- The coordinates where a run ended, widened by what they moved in the last hundredth of it; nil: not bounded.
local function box_around_end(self, run)
  local box, finish, before = {}, run.x, before_end(run)
  if not before then return nil end
  for _, name in ipairs(coordinate_names(self)) do
    local last = finish[name]
    local moved = math.max(math.abs(last.lo - before[name].hi), math.abs(last.hi - before[name].lo))
    box[name] = { last.lo - moved, last.hi + moved }
    if not (box[name][1] > -math.huge and box[name][2] < math.huge) then return nil end
  end
  return box
end

-- An assembled configuration (at time t) becomes the reference, unless the user has said one.
function loops.adopt(self, configuration, t)
  if rawget(self, "has_reference") then return end
  local reference = { t = t }
  for name, value in pairs(configuration) do reference[name] = value end
  methods.reference(self, reference)
  rawset(self, "has_reference", nil)
end

-- A value for a speed that is no state because it follows from others: says so.
function loops.check_speeds(self, states, values, what)
  if not core.has_constraints(self.handle) then return end
  local is_state, speeds = {}, {}
  for _, name in ipairs(states) do is_state[name] = true end
  for _, s in ipairs(core.speeds(self.handle)) do
    if is_state[s.name] then speeds[#speeds + 1] = s.name end
  end
  for _, s in ipairs(core.speeds(self.handle)) do
    local found, value = pcall(function() return values[s.name] end) -- a set of a run refuses names that it has not
    if found and value ~= nil and not is_state[s.name] then
      check.fail("%s: the speed `%s` follows from %s, because loops are closed; m:independent { ... } and m:reference "
        .. "{ ... } before m:dynamics() choose others", what, s.name, table.concat(speeds, ", "))
    end
  end
end

-- What to add to the reason of a run that could not go on: are the loops perhaps singular near its end? nil: no, or
-- nothing is known.
function loops.hint(self, run)
  if not core.has_constraints(self.handle) or run.step_count == 0 then return nil end
  local box = box_around_end(self, run)
  if not box then return nil end
  local _, found = pcall(certify_rank, self, { box = box, t = { run.t_reached, run.t_reached }, boxes = 500 })
  if type(found) ~= "table" or (found.status ~= "undecided" and found.status ~= "singular") then return nil end
  return ("near there the constraint Jacobian of `%s` may lose rank: a singular position, at which the mechanism may "
    .. "take several ways"):format(table.concat(found.loops, "`, `"))
end

loops.methods = methods

return loops
