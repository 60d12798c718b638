-- assemble.lua -- m:assemble { beta = "0.3", guess = { theta = 0 }, within = "1e-3" } or box = { theta = { lo, hi } }:
-- a configuration in which every loop is closed, found and proved; or the proof that there is none.
--
-- Coordinates with a value are given (they may be uncertain: then the statement holds for every value). The others are
-- searched in their `box`, or within a radius of where a plain Newton iteration ends that starts at the guess.
local check = require "ambit.check"
local core = require "ambit.core"
local data = require "ambit.assemble.data"
local loops = require "ambit.loops"
local roots = require "ambit.roots"

local NEAR = 1e-7 -- radius in which a configuration is proved if it cannot be in the whole box

local methods = {}

local Assembly = { __name = "assembly" }
Assembly.__index = Assembly

function Assembly.__tostring(self)
  local lines = { self.reason == "" and self.status or self.status .. ": " .. self.reason }
  for _, name in ipairs(self.configuration and check.sorted(self.configuration) or {}) do
    lines[#lines + 1] = ("  %s = %s"):format(name, tostring(self.configuration[name]))
  end
  return table.concat(lines, "\n")
end

-- -- what is asked

-- The coordinates of the mechanism: names in order, and { name, unit, q } by name.
local function coordinates(self)
  local names, of = {}, {}
  for i, c in ipairs(core.coordinates(self.handle)) do names[i], of[c.name] = c.name, c end
  return names, of
end

-- Values for coordinates that are given, as expressions by name.
local function read_given(t, names, of)
  local given = {}
  for _, name in ipairs(names) do
    if t[name] ~= nil then given[name] = core.expression(t[name], of[name].unit, "assemble: " .. name) end
  end
  return given
end

local function check_names(list, what, names, given)
  check.keys(check.table(list, "assemble: " .. what), names, "assemble: " .. what)
  for name in pairs(list) do
    if given[name] then check.fail("assemble: `%s` has a value and is in `%s`", name, what) end
  end
end

-- `within`: one radius, or one for each name
local function radius_of(within, name, unit)
  local what = "assemble: within"
  if type(within) == "table" then within, what = within[name], what .. "." .. name end
  if within == nil then return 1e-3 end
  local r = core.interval(core.expression(within, unit, what)).hi
  if not (r > 0) or r == math.huge then check.fail("%s: expected a positive radius, got %s", what, tostring(within)) end
  return r
end

-- The coordinates that are sought: names, symbols, units, in the order of the mechanism.
local function find_sought(names, of, symbols, given, t)
  local sought = { names = {}, symbols = {}, units = {} }
  for _, name in ipairs(names) do
    if symbols[name] and not given[name] then
      if t.guess == nil and not (t.box and t.box[name] ~= nil) then
        check.fail("assemble: `%s` has neither a value nor a range: %s = ..., box = { %s = { lo, hi } } or a guess",
          name, name, name)
      end
      local n = #sought.names + 1
      sought.names[n], sought.symbols[n], sought.units[n] = name, of[name].q, of[name].unit
    end
  end
  return sought
end

-- Values for the symbols that are not sought.
local function bind(names, of, symbols, given, time)
  local leaves, values = {}, {}
  for _, name in ipairs(names) do
    if symbols[name] and given[name] then leaves[#leaves + 1], values[#values + 1] = of[name].q, given[name] end
  end
  if symbols.t then
    if time == nil then check.fail "assemble: the loops depend on time: say when, t = ..." end
    leaves[#leaves + 1] = symbols.t.expression
    values[#values + 1] = core.expression(time, "s", "assemble: t")
  end
  return leaves, values
end

-- -- where to look

-- A finite number in the middle of a range.
local function middle(x)
  local m = x:mid()
  return m == m and m > -1e3 and m < 1e3 and m or 0
end

-- Ranges of the unknowns that have one in `box`; where to start for all of them.
local function read_start(t, sought)
  local ranges, start = {}, {}
  for i, name in ipairs(sought.names) do
    local range = t.box and t.box[name]
    if range ~= nil then ranges[i] = roots.range(range, "assemble: box." .. name, sought.units[i]) end
    local value = t.guess and t.guess[name]
    if value ~= nil then
      start[i] = core.interval(core.expression(value, sought.units[i], "assemble: guess." .. name)):mid()
    else
      start[i] = ranges[i] and middle(ranges[i]) or 0
    end
  end
  return ranges, start
end

local function around(x, r) return core.interval(x) + core.interval(-r, r) end

-- The box about the centre for the unknowns that have no range of their own.
local function fill_ranges(t, sought, ranges, centre)
  local filled = {}
  for i, name in ipairs(sought.names) do
    filled[i] = ranges[i] or around(centre[i], radius_of(t.within, name, sought.units[i]))
  end
  return filled
end

-- -- what is found

-- The rows' enclosures at a configuration or over a box; nil if a range is not bounded.
local function residuals(q, ranges)
  local leaves, values = table.move(q.symbols, 1, #q.symbols, 1, {}), {}
  for i, x in ipairs(ranges) do
    if x.lo == -math.huge or x.hi == math.huge then return nil end
    values[i] = core.expression(x)
  end
  table.move(q.leaves, 1, #q.leaves, #leaves + 1, leaves)
  table.move(q.values, 1, #q.values, #values + 1, values)
  return (core.evaluate { expressions = q.expressions, leaves = leaves, values = values })
end

-- The first row of each loop that `is_open` says is open: "`close1` (close1.2: 0.3)"
local function list_open(rows, describe)
  local list, seen = {}, {}
  for k, row in ipairs(rows) do
    local text = describe(k)
    if text and not seen[row.loop] then
      seen[row.loop] = true
      list[#list + 1] = ("`%s` (%s %s)"):format(row.loop, row.name, text)
    end
  end
  return list
end

local function all_loops(rows)
  local list, seen = {}, {}
  for _, row in ipairs(rows) do
    if not seen[row.loop] then list[#list + 1] = ("`%s`"):format(row.loop) end
    seen[row.loop] = true
  end
  return list
end

-- Why there is no configuration: loops that cannot close on their own, else those that stay open at the nearest point.
local function explain_none(q, rows, open)
  local values = residuals(q, q.ranges)
  local list = values and list_open(rows, function(k)
    return not values[k]:contains(0) and "is within " .. tostring(values[k]) .. " all over the box" or nil
  end) or {}
  if #list > 0 then return "no configuration in the box closes " .. table.concat(list, ", ") end
  list = open and list_open(rows, function(k)
    return math.abs(open[k]) > 1e-9 and ("is still %.3g where an iteration came nearest"):format(open[k]) or nil
  end) or {}
  if #list > 0 then return "no configuration in the box closes all loops: " .. table.concat(list, ", ") end
  return "no configuration in the box closes " .. table.concat(all_loops(rows), ", ")
end

-- One configuration: what is given, and what was found.
local function complete(point, given)
  local whole = {}
  for name, value in pairs(given) do whole[name] = core.evaluate { expressions = { value } }[1] end
  for name, x in pairs(point) do whole[name] = x end
  return setmetatable(whole, getmetatable(point))
end

-- A configuration near the centre, if nothing is proved in the whole box; the iteration may have left the box.
local function prove_near(q, centre)
  local near = setmetatable({ ranges = {} }, { __index = q })
  for i, x in ipairs(centre) do
    local r = around(x, NEAR * math.max(1, math.abs(x)))
    local lo, hi = math.max(r.lo, q.ranges[i].lo), math.min(r.hi, q.ranges[i].hi)
    if lo > hi then return nil end
    near.ranges[i] = core.interval(lo, hi)
  end
  local found = roots.run(near)
  return found.status == "complete" and #found.proved == 1 and found.proved[1] or nil
end

local function classify(q, found)
  if found.status == "broken" or found.status == "stopped" then return found.status end
  if found.status ~= "complete" then return "undecided" end
  -- a part of the data has a configuration in the box: roots.finish says partial
  if #found.partly > 0 or roots.leaving(q, found) > 0 then return "complete" end
  if #found.proved == 0 then return "none" end
  return #found.proved == 1 and "unique" or "several"
end

-- What is proved about configurations whose enclosures reach out of the box; else what the solver said.
local function explain_edge(found)
  for _, point in ipairs(found.proved) do
    if found.status == "complete" and not point.inside then
      return "a configuration is proved, but not that it lies in the box for every value of the data: its enclosure "
        .. "reaches out of the box"
    end
  end
  return found.reason
end

local function describe(self, q, rows, given, found, start)
  local result = { status = classify(q, found), reason = explain_edge(found), boxes = found.boxes,
    cpu_seconds = found.cpu_seconds, box = {}, configurations = {}, undecided = {}, report = found.report }
  if result.status == found.status or result.status == "undecided" then result.code = found.code end
  result.partly = {}
  for i, name in ipairs(q.names) do result.box[name] = q.ranges[i] end
  for i, point in ipairs(found.partly) do result.partly[i] = complete(point, given) end
  for i, point in ipairs(found.proved) do result.configurations[i] = complete(point, given) end
  for i, point in ipairs(found.undecided) do result.undecided[i] = complete(point, given) end
  result.configuration = result.configurations[1]
  if result.status == "none" then result.reason = explain_none(q, rows, start.open) end
  if result.status == "undecided" and not result.configuration and #found.undecided > 0 then
    local candidate = found.further > 0 and #found.undecided == 1 and found.undecided[1]
    local near = not candidate and start.converged and prove_near(q, start.centre)
    if near then
      result.reason = result.reason
        .. ("; within %g (relative above 1) of where an iteration ends one configuration is proved"):format(NEAR)
    end
    if candidate or near then result.configuration = complete(candidate or near, given) end
  end
  if result.configuration then
    local at = {}
    for i, name in ipairs(q.names) do at[i] = result.configuration[name] end
    result.residuals = {}
    for k, value in ipairs(residuals(q, at)) do result.residuals[rows[k].name] = value end
  end
  return setmetatable(result, Assembly)
end

-- -- how it depends on the data

-- The configuration as expressions of the data, worked out once.
local function dependence(q, given, configuration)
  local found, known
  return function()
    if known then return found end
    known = true
    local box = {}
    for i, name in ipairs(q.names) do box[i] = configuration[name] end
    local list = data.expressions(core.substitute(q.expressions, q.leaves, q.values), q.symbols, q.names, box)
    if not list then return nil end
    found = {}
    for name, value in pairs(given) do found[name] = value end
    for i, name in ipairs(q.names) do found[name] = list[i] end
    return found
  end
end

-- { name = expression of the data } that holds the configuration for every value of theirs; nil where the data are
-- exact, or too wide for it.
function Assembly:of_data()
  local of = rawget(self, "dependence")
  return of and of() or nil
end

-- The only configuration in its box: runs that start from it start correlated.
local function hand_out(self, q, given, result, time)
  if result.status ~= "unique" then return end
  result.dependence = dependence(q, given, result.configuration)
  local at = time ~= nil and core.interval(core.expression(time, "s", "assemble: t")) or nil
  data.hand_out({ mechanism = self, time = at, of = result.dependence }, result.configuration)
end

-- -- the method

local function read_request(self, t)
  local names, of = coordinates(self)
  local own = { "guess", "box", "within", "t" }
  table.move(names, 1, #names, #own + 1, own)
  local q = roots.settings(t, "assemble", own, 0)
  local given = read_given(t, names, of)
  for _, key in ipairs { "guess", "box" } do
    if t[key] ~= nil then check_names(t[key], key, names, given) end
  end
  if type(t.within) == "table" then check_names(t.within, "within", names, given) end
  return q, names, of, given
end

-- Where a plain iteration ends: { centre, open, converged }.
local function approach(q, start)
  local centre, open, converged = core.approach { equations = q.expressions, unknowns = q.symbols,
    names = q.names, leaves = q.leaves, values = q.values, x = start }
  if not centre then return { centre = start, converged = false } end
  return { centre = converged and centre or start, open = open, converged = converged }
end

function methods:assemble(t)
  check.table(t, "assemble")
  if not core.has_constraints(self.handle) then
    check.fail("assemble: the mechanism `%s` has no closed loops", self.name)
  end
  local q, names, of, given = read_request(self, t)
  local rows = core.constraints(self.handle)
  q.expressions = {}
  for k, row in ipairs(rows) do q.expressions[k] = row.residual end
  local symbols = roots.symbols(q.expressions)
  local sought = find_sought(names, of, symbols, given, t)
  if #sought.names == 0 then check.fail "assemble: nothing is sought: every coordinate of the loops has a value" end
  q.names, q.symbols = sought.names, sought.symbols
  q.leaves, q.values = bind(names, of, symbols, given, t.t)
  local ranges, first = read_start(t, sought)
  local start = approach(q, first)
  q.ranges = fill_ranges(t, sought, ranges, start.centre)
  q.centre = start.converged and start.centre or first
  local found = roots.run(q)
  local result = describe(self, q, rows, given, found, start)
  roots.finish(q, "assemble", found, result)
  if result.configuration then loops.adopt(self, result.configuration, t.t) end
  hand_out(self, q, given, result, symbols.t and t.t)
  return result
end

local assemble = {}

assemble.methods = methods

return assemble
