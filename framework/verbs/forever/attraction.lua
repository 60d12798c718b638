-- forever/attraction.lua -- ambit.attraction { system, about = { x = 0 }, within = { x = { -1, 1 }, v = { -2, 2 } } }:
-- starts from which every solution tends to rest, for all data.
--
-- A set that nothing leaves, in which all decays, comes first. The box of starts is cut into cells; a cell belongs to
-- the region if a proved run from all of it ends in that set, for all data (docs/numerics/forever.md). Unproved runs
-- say which cells are worth one, and how long it should be.
local check = require "ambit.check"
local core = require "ambit.core"
local cover = require "ambit.forever.cover"
local fresh = require "ambit.fresh"
local invariant = require "ambit.forever.invariant"
local ode = require "ambit.ode"
local session = require "ambit.session"
local simulate = require "ambit.simulate"
local uncertain = require "ambit.run.uncertain"

local verb = {}

local BUDGET = 1000  -- proofs that are tried, for each part of the data
local HORIZON = 8    -- times 1/rate: how long unproved runs are followed,
local INSTANTS = 50  -- and how often they are looked at on the way
local NEAR = 0.5     -- of the set's size: there a curve counts as come to rest
local CUTS = 6       -- halvings of a box that may be in the set in part
local INSIDE = 1.1   -- of the set's size: cells of which corners are farther are not inside
local LOOKS = 12     -- so often a proved run is looked at
local LONGER = 1.5   -- times that of the latest curve: how long it is
local AGAIN = 8      -- one in so many cells has to be new before the others of a round are tried again
local COARSE = 64    -- cells up to this share of the box are cut even if no curve from them comes to rest
local MANY = 4       -- states up to which all corners of a cell are followed

local Region = { __name = "attraction" }
local methods = {}

-- { state = value or enclosure } -> expressions, in the order of the states
local function point_of(self, values)
  check.keys(check.table(values, "contains"), self.states, "contains")
  local x = {}
  for i, name in ipairs(self.states) do
    if values[name] == nil then check.fail("contains: the state `%s` has no value", name) end
    x[i] = core.expression(values[name], ode.unit(self.system, i), "contains: " .. name)
  end
  return x
end

-- Is this start, which may be uncertain, proved to tend to rest, for all data?
function methods:contains(values)
  local x = point_of(self, values)
  if not self.set then return false end
  if self.set.set.by.decay:holds(self.set.set, x) then return true end
  local box = { lo = {}, hi = {} }
  for i, e in ipairs(core.evaluate { expressions = x }) do
    if e:is_empty() or e.partial or not e:is_bounded() then return false end
    box.lo[i], box.hi[i] = e.lo, e.hi
  end
  return cover.contains(self.cells, box)
end

check.methods(methods, Region)
Region.__index = methods

function Region.__tostring(self)
  if self.status ~= "proved" then return self.status .. ": " .. self.reason end
  return ("%s: from %.3g %% of the box every solution tends to rest (%d cells)"):format(self.status, 100 * self.share,
    #self.cells)
end

-- -- curves, which prove nothing

-- How far a point is from rest, in the frame of the set; 1: about where the set ends.
local function distance(set, x)
  local n, sum = #x, 0
  for i = 1, n do
    local u = 0
    for j = 1, n do u = u + set.by.frame.inverse[(i - 1) * n + j] * (x[j] - set.centre[j]:mid()) end
    sum = sum + u * u
  end
  return math.sqrt(sum) / set.radius
end

-- A run of a system that is the one that was asked for, in part.
local function silent(self, part, initial, times, solver)
  local q = simulate.request({ self.system, initial = initial, t = times, solver = solver }, "attraction", nil, {})
  q.system = part
  q.run_options = { silent = true }
  return simulate.solve(q)
end

-- When the curve from here has come to rest, for the middle of the data; false: it does not within the horizon.
local function follow(self, x)
  if distance(self.set.set, x) <= NEAR then return 0 end
  local good, run = pcall(silent, self, self.still, x, self.times, core.default.draws)
  for _, t in ipairs(good and self.times or {}) do
    if t > run.t_reached then return false end
    local state, at = run:at(t), {}
    for i, name in ipairs(self.states) do at[i] = state[name]:mid() end
    if distance(self.set.set, at) <= NEAR then return t end
  end
  return false
end

-- The same, once for each point: cells share their corners.
local function arrival(self, x)
  local key = table.concat(x, " ")
  if self.known[key] == nil then self.known[key] = follow(self, x) end
  return self.known[key]
end

-- Points of a cell: its middle and its corners.
local function points_of(cell)
  local n, middle = #cell.lo, {}
  for i = 1, n do middle[i] = 0.5 * cell.lo[i] + 0.5 * cell.hi[i] end
  local list = { middle }
  for k = 0, (n <= MANY and 2 ^ n or 0) - 1 do
    local corner = {}
    for i = 1, n do corner[i] = (k >> (i - 1)) & 1 == 1 and cell.hi[i] or cell.lo[i] end
    list[#list + 1] = corner
  end
  return list
end

-- The latest arrival of the curves from a cell; nil: one does not arrive. Also how many do.
local function latest(self, cell)
  local last, count, list = 0, 0, points_of(cell)
  for _, x in ipairs(list) do
    local t = arrival(self, x)
    if t then last, count = math.max(last, t), count + 1 end
  end
  return count == #list and last or nil, count
end

-- -- proofs

-- Is all of this box in the set, for all data? Corners that are far off, as floats tell, spare the proof.
local function is_inside(self, box, points)
  local set, x = self.set.set, {}
  for _, point in ipairs(points) do
    if distance(set, point) > INSIDE then return false end
  end
  for i in ipairs(self.states) do x[i] = core.between(box.lo[i], box.hi[i], "place " .. self.states[i]) end
  return (set.by.decay:holds(set, x))
end

-- Is all of this box in the region as it is known by now, in the set or in cells? Its parts may be in one or the other.
local function known(self, box, cuts)
  local points = points_of(box)
  if is_inside(self, box, points) or cover.contains(self.cells, box) then return true end
  local middle = points[1]
  if cuts == 0 or distance(self.set.set, middle) > 1 and not cover.contains(self.cells, { lo = middle, hi = middle })
  then
    return false
  end
  local low, high = cover.halves(box, self.units)
  return low ~= nil and known(self, low, cuts - 1) and known(self, high, cuts - 1)
end

-- Are all solutions from this cell in the region at one time up to `t`? Enclosures of a run that ends early hold too.
local function enters(self, cell, t)
  local x, times = {}, { 0 }
  for i in ipairs(self.states) do x[i] = core.between(cell.lo[i], cell.hi[i], self.starts[i]) end
  for k = 1, LOOKS do times[k + 1] = t * k / LOOKS end
  local good, run = pcall(silent, self, self.part, x, times, self.solver)
  if not good or not run.rigorous then return false end
  for k = 2, #times do
    if times[k] > run.t_reached then return false end
    local state, box = run:at(times[k]), { lo = {}, hi = {} }
    for i, name in ipairs(self.states) do box.lo[i], box.hi[i] = state[name].lo, state[name].hi end
    if known(self, box, CUTS) then return true end
  end
  return false
end

local function volume_of(cell, units)
  local product = 1
  for i, unit in ipairs(units) do product = product * (cell.hi[i] - cell.lo[i]) / unit end
  return product
end

-- Is the cell proved?
local function prove(self, cell)
  if not cell.last then return false end
  if not (known(self, cell, 0) or cell.last > 0 and enters(self, cell, LONGER * cell.last)) then return false end
  self.cells[#self.cells + 1], self.share = cell, self.share + cell.volume
  return true
end

-- Halves of cells that may belong to the region in part, with what curves say of them.
local function cut_all(self, list, units)
  local halves = {}
  for _, cell in ipairs(list) do
    if cell.count > 0 or cell.volume * COARSE >= 1 then
      for _, half in ipairs { cover.halves(cell, units) } do halves[#halves + 1] = half end
    end
  end
  return halves
end

-- Cells of the box, in rounds: of each the cells from which curves arrive first come first, because later ones may end
-- in them. What is not proved is tried again as long as others are, and cut then.
local function explore(self, box, units, budget)
  local left = { box }
  while #left > 0 and budget > 0 do
    for _, cell in ipairs(left) do
      cell.volume = volume_of(cell, units)
      cell.last, cell.count = latest(self, cell)
    end
    table.sort(left, function(x, y) return (x.last or math.huge) < (y.last or math.huge) end)
    local before
    repeat
      local failed = {}
      before = #self.cells
      for _, cell in ipairs(left) do
        if cell.last then budget = budget - 1 end
        if budget < 0 or not prove(self, cell) then failed[#failed + 1] = cell end
      end
      local some = #self.cells - before
      left = failed
    until some * AGAIN < #left or budget <= 0
    left = cut_all(self, left, units)
  end
end

-- What both lists of cells have in common; all cells come from cutting one box in halves, so that of two that meet one
-- is in the other.
local function common(list, other, units)
  local found, share = {}, 0
  for _, one in ipairs(list) do
    for _, two in ipairs(other) do
      local both, is_some = { lo = {}, hi = {} }, true
      for i in ipairs(units) do
        both.lo[i], both.hi[i] = math.max(one.lo[i], two.lo[i]), math.min(one.hi[i], two.hi[i])
        is_some = is_some and both.lo[i] < both.hi[i]
      end
      if is_some then found[#found + 1], share = both, share + volume_of(both, units) end
    end
  end
  return found, share
end

-- { [datum or name of a parameter] = parts } -> systems with each a part of the data, which together have all of them
local function parts_of(given, system)
  local parts = { system }
  for _, key in ipairs(check.sorted(given and check.table(given, "attraction: split") or {})) do
    local parameter = type(key) == "string" and system.parameters[key]
    local datum = core.expression(parameter or key, nil, "attraction: split")
    local data, _, _, _, names = uncertain.data { datum }
    local count = check.count(given[key], "attraction: split")
    if #data ~= 1 then
      check.fail("attraction: split: expected one uncertain datum, or the name of a parameter that is one, got %s",
        check.shown(key))
    end
    local range = core.evaluate { expressions = { data[1] } }[1]
    local finer = {}
    for _, part in ipairs(parts) do
      for k = 1, count do
        local lo = k == 1 and range.lo or range.lo + (k - 1) / count * (range.hi - range.lo)
        local hi = k == count and range.hi or range.lo + k / count * (range.hi - range.lo)
        local changed, rates = ode.replaced(part, { data[1] }, { core.between(lo, hi, names[1]) })
        finer[#finer + 1] = setmetatable({ system = changed, rates = rates }, { __index = part })
      end
    end
    parts = finer
  end
  return parts
end

-- The system with what varies at its middle, for curves.
local function still(part)
  local from, to = {}, {}
  for _, leaf in ipairs(core.leaves(part.rates)) do
    if leaf.kind == "varying" then
      from[#from + 1], to[#to + 1] = leaf.expression, core.expression(0.5 * leaf.lo + 0.5 * leaf.hi)
    end
  end
  if #from == 0 then return part end
  local changed, rates = ode.replaced(part, from, to)
  return setmetatable({ system = changed, rates = rates }, { __index = part })
end

-- The region for all data is what those for the parts of the data have in common.
local function explore_parts(self, parts, box, units, budget)
  local all
  for _, part in ipairs(parts) do
    self.part, self.still, self.cells, self.share, self.known = part, still(part), {}, 0, {}
    explore(self, { lo = box.lo, hi = box.hi }, units, budget)
    if all then self.cells, self.share = common(all, self.cells, units) end
    all = self.cells
  end
  self.known, self.part, self.still = nil, nil, nil
end

-- Names for starts, by place, that no datum of the system has.
local function starts_of(system)
  local used, names = fresh.set(system.states), {}
  for _, leaf in ipairs(core.leaves(system.rates)) do used[leaf.name or ""] = true end
  for i, name in ipairs(system.states) do names[i] = fresh.name("start " .. name, used) end
  return names
end

local function box_of(within, system)
  local box, units = { lo = {}, hi = {} }, {}
  for i, name in ipairs(system.states) do
    local range = within[name]
    if not range then check.fail("attraction: within: the state `%s` has no range { lo, hi }", name) end
    if not range:is_bounded() or not (range:width() > 0) then
      check.fail("attraction: within.%s: expected a bounded range with some width", name)
    end
    box.lo[i], box.hi[i], units[i] = range.lo, range.hi, range.hi - range.lo
  end
  return box, units
end

local function horizon(t, rate)
  local last = HORIZON / rate
  if t.horizon ~= nil then
    local given = core.evaluate { expressions = { core.expression(t.horizon, "s", "attraction: horizon") } }[1]
    last = given:mid()
    if not (last > 0 and last < math.huge) then check.fail "attraction: horizon: expected a time, 0 or more" end
  end
  local times = {}
  for k = 0, INSTANTS do times[k + 1] = last * (k / INSTANTS) ^ 2 end
  return times
end

function verb.attraction(t)
  check.table(t, "attraction")
  local start, system = core.cpu(), simulate.system(t, "attraction")
  check.keys(t, { "about", "within", "budget", "horizon", "solver", "split" }, "attraction", 1)
  invariant.refuse(system, "attraction")
  local budget = t.budget == nil and BUDGET or check.count(t.budget, "attraction: budget")
  if t.within == nil then check.fail "attraction: within is missing: the box of starts, { state = { lo, hi } }" end
  local within = invariant.within(t.within, system, "attraction")
  local box, units = box_of(within, system)
  local parts = parts_of(t.split, system)
  local set = invariant.find { system = system, guess = invariant.guess(t.about, system, "attraction"),
    within = within }
  local self = setmetatable({ status = set.status, reason = set.reason, system = system, states = system.states,
    cells = {}, share = 0 }, Region)
  if set.set then
    self.set, self.centre, self.settles = set, set.centre, set.settles
    self.starts = starts_of(system)
    self.times, self.solver = horizon(t, set.rate), t.solver or core.default.sets
    self.units = units
    explore_parts(self, parts, box, units, budget)
  end
  self.code = self.status == "proved" and "ok" or "unable.undecided"
  self.cpu_seconds = core.cpu() - start
  session.finish("attraction", self, {}, { "budget", budget })
  return self
end

return verb
