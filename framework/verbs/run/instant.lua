-- run/instant.lua -- times, in seconds. A number is the double that it is; text is the time that it says ("0.1", "5
-- ms"), and where that is no double, an instant is known by the doubles around it, its bracket.
--
-- A run's own clock shows doubles. It starts at a double next to the true start, and its `shift` is the rest, a
-- constant: clock + shift is the time (docs/numerics/instants.md). Instants are brackets on the clock.
local check = require "ambit.check"
local core = require "ambit.core"

local instant = {}

-- The numbers that a text or an expression may mean; only those with a unit or an operator need the graph.
local function enclose(value, what)
  if type(value) == "string" and tonumber(value) then return core.interval(value) end
  local e = core.expression(value, "s", what)
  if not core.is_constant(e) then check.fail("%s: a time cannot be uncertain", what) end
  return core.interval(e)
end

-- { lo, hi, near, value }: a bracket, the double in it that a solver steps on, and what was said; value nil: it is the
-- double lo = hi = near. is_set: an enclosure is allowed, and stands for all its times.
function instant.read(value, what, is_set)
  if is_set and check.kind(value) == "enclosure" and value:is_bounded() and value.lo < value.hi then
    return { lo = value.lo, hi = value.hi, near = value:mid(), set = value }
  end
  if type(value) ~= "number" then
    local x = enclose(value, what)
    if not x:is_bounded() then check.fail("%s: the time must be finite, got %s", what, tostring(value)) end
    if x.lo < x.hi then
      local nearest = type(value) == "string" and tonumber(value) or x:mid()
      return { lo = x.lo, hi = x.hi, near = math.min(math.max(nearest, x.lo), x.hi), value = value }
    end
    value = x.lo
  else
    core.check_number(value, what)
  end
  if value ~= value or value == math.huge or value == -math.huge then
    check.fail("%s: the time must be finite, got %s", what, value ~= value and "NaN" or tostring(value))
  end
  value = value + 0.0
  return { lo = value, hi = value, near = value }
end

function instant.text(t)
  if t.lo == t.hi then return core.literal(t.lo) end
  local between = ("between %s and %s"):format(core.literal(t.lo), core.literal(t.hi))
  return type(t.value) == "string" and ("`%s`, %s"):format(t.value, between) or between
end

-- Exactly.
function instant.expression(t) return core.expression(t.value or t.lo, "s") end

-- On the clock of what was started with these times.
function instant.on_clock(t, times)
  if not times.shift then return t end
  local start = instant.expression(times.start)
  local x = times[1] + (t.set and t.set - core.interval(start) or core.tight(instant.expression(t) - start))
  return { lo = x.lo, hi = x.hi, near = x:mid(), set = t.set, said = t, shift = times.shift }
end

-- How far t, on a clock, lies behind m, which its clock shows: enclosed to a few units in the last place of that; nil:
-- the bracket is all that is known, or as good for a run that started at `start`.
function instant.behind(t, m, start)
  if t.set or t.hi - t.lo <= 0x1p-51 * math.abs(t.near - start) then return nil end
  local e = instant.expression(t.said or t) - core.expression(m)
  return core.tight(t.shift and e - t.shift or e)
end

-- The time, an enclosure, at which the clock shows t, an enclosure or a number; as it is without a shift.
function instant.of_clock(t, shift)
  if not shift then return t end
  return (type(t) == "number" and core.interval(t) or t) + core.interval(shift)
end

-- 1: b is surely later than a, -1: earlier, 0: neither is known
local function order(a, b)
  if a.hi < b.lo then return 1 elseif a.lo > b.hi then return -1 end
  local way = core.tight(instant.expression(b) - instant.expression(a))
  return way.lo > 0 and 1 or way.hi < 0 and -1 or 0
end

-- Is b known to be later than a, both within a run?
function instant.is_later(b, a) return order(a, b) == 1 end

-- Are they surely the same?
function instant.is_same(a, b)
  if a.value == nil or b.value == nil then return a.lo == a.hi and b.lo == b.hi and a.lo == b.lo end
  return type(a.value) == type(b.value) and a.value == b.value
end

local function read_all(t, what)
  local list = {}
  for i, value in ipairs(t) do list[i] = instant.read(value, ("%s[%d]"):format(what, i)) end
  check.keys(t, {}, what, #list)
  if #list < 2 then
    check.fail("%s: expected { start, ..., end }, got %d time%s", what, #list, #list == 1 and "" or "s")
  end
  return list
end

local function check_order(list, what)
  local first, last = list[1], list[#list]
  local direction = order(first, last)
  if direction == 0 then
    check.fail("%s: the horizon is zero: start and end are both %s", what, instant.text(last))
  end
  for i = 2, #list do
    if order(list[i - 1], list[i]) ~= direction then
      check.fail("%s: the times must go one way, but %s follows %s", what, instant.text(list[i]),
        instant.text(list[i - 1]))
    end
  end
  return direction == 1
end

-- Doubles as numbers, others as they were said.
local function said(list)
  local values = {}
  for i, t in ipairs(list) do values[i] = t.value == nil and t.lo or tostring(t.value) end
  return values
end

-- t = { t0, ..., t1 }, ascending or descending; t = 10 means { 0, 10 } -> the doubles that a solver steps on. Of an
-- instant that is no double it is one next to it, of the last one both ends of the bracket. Besides: .said, for
-- those who read; and, nil where all is double, .start, as read, .shift, as above, .final, the last bracket, on the
-- clock, and .last, its first end. sides: of a sampled system (run/samples.lua), or nil; then there is .exact, too, the
-- true end where it is no double.
function instant.list(t, what, sides)
  if t == nil then check.fail("%s is missing: { start, ..., end } in seconds", what) end
  local list = read_all(type(t) == "table" and t or { 0, t }, what)
  local forward, start = check_order(list, what), list[1]
  local times = { start.lo, said = said(list) }
  if start.value ~= nil then
    times[1] = forward and start.lo or start.hi
    times.shift, times.start = instant.expression(start) - core.expression(times[1]), start
  end
  local function add(double)
    if (double > times[#times]) == forward and double ~= times[#times] then times[#times + 1] = double end
  end
  local final = instant.on_clock(list[#list], times)
  local near = sides and forward and not times.shift and sides(times[1], final)
  for i = 2, #list - 1 do add(near and near(list[i]) or instant.on_clock(list[i], times).near) end
  if final.lo < final.hi then
    add(forward and final.lo or final.hi)
    times.last, times.final = times[#times], final
    times.exact = sides and not times.shift and instant.expression(final) or nil
  end
  add(forward and final.hi or final.lo)
  return times
end

-- May times on the clock, an enclosure, lie behind the end, which is known by a bracket?
function instant.is_behind(times, x)
  if not times.final then return false end
  if times[#times] > times[1] then return x.hi > times.final.lo end
  return x.lo < times.final.hi
end

-- Another list of doubles for the same horizon.
function instant.like(times, list)
  list.shift, list.start, list.final, list.last, list.exact =
    times.shift, times.start, times.final, times.last, times.exact
  return list
end

-- The start and the end, for records: a number, or an enclosure.
function instant.first(times) return times.start and core.interval(times.start.lo, times.start.hi) or times[1] end

function instant.final(times)
  local last = times.last and core.interval(times.last):hull(times[#times]) or times[#times]
  return instant.of_clock(last, times.shift)
end

-- { start, end }: doubles, all of t between them.
function instant.span(t, what)
  local times = instant.list(t, what)
  local first, last = core.interval(instant.first(times)), core.interval(instant.final(times))
  if last.lo >= first.lo then return { first.lo, last.hi } end
  return { first.hi, last.lo }
end

-- Formulas of the time, as they read on a clock that was started with this shift.
function instant.formulas(list, shift)
  return shift and core.substitute(list, { core.time() }, { core.time() + shift }) or list
end

-- The true start, an expression.
function instant.start(times) return times.start and instant.expression(times.start) or core.expression(times[1]) end

return instant
