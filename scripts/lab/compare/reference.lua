-- compare/reference.lua -- the truth that errors are measured by: what the scene says, or, where all data are points,
-- the tightest proof among the rows, or at last a strict run that proves nothing. What it is, is said.
local check = require "ambit.check"
local core = require "ambit.core"
local instant = require "ambit.run.instant"

local reference = {}

local STRICT = { method = "rk8pd", relative = 1e-13, absolute = 1e-16 }

-- reference = { t = 1, x = { name = value or text or enclosure }, source = "where it is from" } -> { t, x =
-- enclosures, names, source }
function reference.read(value)
  if value == nil then return nil end
  local what = "compare: reference"
  check.table(value, what)
  check.keys(value, { "t", "x", "source" }, what)
  check.table(value.x, what .. ".x")
  local t = instant.read(value.t == nil and check.fail("%s.t is missing: a time in seconds", what) or value.t,
    what .. ".t")
  local source = value.source ~= nil and check.text(value.source, what .. ".source") or "given by the scene"
  local read = { t = t.lo, bracket = t.lo < t.hi and t or nil, x = {}, source = source }
  for _, name in ipairs(check.sorted(value.x)) do
    check.text(name, what .. ".x: name of a state")
    local kind = check.kind(value.x[name])
    if kind ~= "number" and kind ~= "string" and kind ~= "enclosure" then
      check.fail("%s.x.%s: expected a number, a text or an enclosure, got %s", what, name, kind)
    end
    read.x[name] = core.interval(value.x[name])
    read.names = read.names or {}
    read.names[#read.names + 1] = name
  end
  if not read.names then check.fail("%s.x: there is no state in it", what) end
  return read
end

-- Does it speak of this simulation: its states, its time?
local function fits(given, comparison)
  local known, from, to = {}, comparison.t[1], comparison.t[2]
  for _, name in ipairs(comparison.names) do known[name] = true end
  for _, name in ipairs(given.names) do
    if not known[name] then return false, ("it has no state `%s`%s"):format(name, check.suggest(name, comparison.names))
    end
  end
  if given.t == from or (given.t - from) * (given.t - to) > 0 then
    return false, ("t = %s is not within the run"):format(core.literal(given.t))
  end
  return true
end

-- The instant t, or one of its bracket.
local function place_of(comparison, t, bracket)
  local lo, hi = bracket and bracket.lo or t, bracket and bracket.hi or t
  for k, other in ipairs(comparison.instants) do if lo <= other and other <= hi then return k end end
end

-- x by name of bounds at an instant
local function named(comparison, at)
  local x = {}
  for k, name in ipairs(comparison.names) do x[name] = core.interval(at.lo[k], at.hi[k]) end
  return x
end

local function new(comparison, t, sets, names, source, bracket)
  local found = { t = t, x = {}, lo = {}, hi = {}, names = names, source = source, bracket = bracket,
    place = place_of(comparison, t, bracket) }
  for _, name in ipairs(names) do
    found.x[name], found.lo[name], found.hi[name] = sets[name]:mid(), sets[name].lo, sets[name].hi
  end
  return found
end

local function tightest(comparison)
  local best
  for _, row in ipairs(comparison.rows) do
    local good = row.rigorous and row.status == "complete" and row.at and row.at[#comparison.instants]
    if good and (not best or row.width < best.width) then best = row end
  end
  return best
end

-- run(solver, options) -> what a child says, or nil; only called where nothing better is known.
local function of_points(comparison, run)
  local last = #comparison.instants
  local t = comparison.instants[last]
  local best = tightest(comparison)
  if best then
    return new(comparison, t, named(comparison, best.at[last]), comparison.names,
      ("the tightest proof, of %s, %.2g wide"):format(best.label, best.width))
  end
  local installed = false
  for _, entry in ipairs(core.list()) do installed = installed or entry.kind == "solver" and entry.name == "gsl" end
  local result = installed and run("gsl", STRICT)
  local at = result and result.data and result.data.status == "complete" and result.data.at[last]
  if not at then return nil end
  return new(comparison, t, named(comparison, at), comparison.names,
    "not proved: gsl, method rk8pd with a relative tolerance of 1e-13")
end

-- The reference of a comparison, or nil.
function reference.find(comparison, given, run)
  if given then
    local good, problem = fits(given, comparison)
    if good then return new(comparison, given.t, given.x, given.names, given.source, given.bracket) end
    comparison.reference_problem = "the scene's reference is not for this simulation: " .. problem
  end
  if comparison.unknowns == 0 then return of_points(comparison, run) end
end

-- At most so far from the truth; the truth is somewhere in the reference's bounds.
local function error_of(row, x, found, index)
  local largest = 0
  for _, name in ipairs(found.names) do
    local k = index[name]
    local lo, hi = x.lo[k], x.hi[k]
    if not row.rigorous then lo = 0.5 * lo + 0.5 * hi hi = lo end
    largest = math.max(largest, hi - found.lo[name], found.hi[name] - lo)
  end
  return largest
end

local function misses(x, found, index)
  for _, name in ipairs(found.names) do
    local k = index[name]
    if x.lo[k] > found.hi[name] or x.hi[k] < found.lo[name] then return name end
  end
end

-- Fills the error of each row that says something at the reference's time; an enclosure that misses it is noted.
function reference.hold_against(comparison)
  local found, index = comparison.reference, {}
  if not found then return end
  for k, name in ipairs(comparison.names) do index[name] = k end
  for _, row in ipairs(comparison.rows) do
    local x = row.at and row.at[found.place]
    if x and found.bracket and row.rigorous then x = row.at_reference end
    if x then
      row.error = error_of(row, x, found, index)
      local name = row.rigorous and misses(x, found, index)
      if name and not comparison.missed then
        comparison.missed = ("%s misses the reference about %s at t = %s: %s and %s; one of both is wrong"):format(
          row.label, name, core.literal(found.t), tostring(core.interval(x.lo[index[name]], x.hi[index[name]])),
          tostring(core.interval(found.lo[name], found.hi[name])))
      end
    end
  end
end

return reference
