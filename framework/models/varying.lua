-- varying.lua -- ambit.varying(lo, hi [, name or { rate = ..., name = ... }]): functions of time of which only bounds
-- are known, also of their rate of change.
--
-- One with a bounded rate is a leaf like the others, and every verb may take it for one, which forgets the rate. Who
-- follows solutions takes the system that carries it: the function is a state, its rate is what varies, and solvers are
-- told within which bounds that state stays.
local check = require "ambit.check"
local core = require "ambit.core"
local fresh = require "ambit.fresh"

local varying = {}

local rated = {} -- by number of the leaf: { lo, hi (expressions), rate = { lo, hi }, unit }; kept as long as leaves are

local function rate_of(value, unit)
  local ends = type(value) == "table" and getmetatable(value) == nil and value or nil
  if ends then check.keys(ends, {}, "varying: rate", 2) end
  local per = unit and unit .. "/s"
  local hi = core.expression(ends and ends[2] or value, per, "varying: rate")
  local lo = ends and core.expression(ends[1], per, "varying: rate") or -hi
  for _, e in ipairs { lo, hi } do
    if not core.is_constant(e) then check.fail "varying: rate: expected known numbers" end
  end
  if not (core.tight(lo).hi <= 0 and core.tight(hi).lo >= 0) then
    check.fail("varying: rate: expected a bound, 0 or more, or { lo, hi } with 0 between them, got %s",
      check.shown(value))
  end
  return { lo = lo, hi = hi }
end

function varying.new(lo, hi, how)
  if type(how) ~= "table" then return core.varying(lo, hi, how) end
  check.keys(how, { "rate", "name" }, "varying")
  local e = core.varying(lo, hi, how.name)
  local leaf = core.leaves({ e })[1]
  if how.rate == nil or not leaf then return e end
  local unit = core.unit_of(e)
  rated[leaf.number] = { lo = core.expression(lo), hi = core.expression(hi), rate = rate_of(how.rate, unit),
    unit = unit }
  return e
end

-- Those of the leaves of these expressions that have a rate: { { leaf, about }, ... }
local function found_in(list)
  local found = {}
  if next(rated) == nil then return found end
  for _, leaf in ipairs(core.leaves(list)) do
    if rated[leaf.number] then found[#found + 1] = { leaf = leaf, about = rated[leaf.number] } end
  end
  return found
end

-- What is known of a leaf's rate, or nil.
function varying.of(leaf) return rated[leaf.number] end

local function copy(list) return table.move(list, 1, #list, 1, {}) end

-- How often a function may cross its range in a second.
local function speed_of(one)
  local rate = one.about.rate
  return math.max(-core.tight(rate.lo).lo, core.tight(rate.hi).hi) / (one.leaf.hi - one.leaf.lo)
end

-- Of each: its name as a state, symbol, rate, start. Returns the bounds of all states.
local function states_of(found, system, formulas)
  local used, bounds = fresh.set(system.states), {}
  for _, leaf in ipairs(core.leaves(formulas)) do
    if leaf.name and not rated[leaf.number] then used[leaf.name] = true end
  end
  for i = 1, #system.states do bounds[i] = core.interval(-math.huge, math.huge) end
  for _, one in ipairs(found) do
    one.name = fresh.name(one.leaf.name or "what varies", used)
    one.symbol = core.symbol(one.name, one.about.unit or "1")
    local rate = one.about.rate
    one.rate = core.in_unit(core.varying(rate.lo, rate.hi, fresh.name("rate of " .. one.name, used)), "1")
    one.rate_number = (core.leaves({ one.rate })[1] or {}).number
    one.start = core.between(one.about.lo, one.about.hi, fresh.name("start of " .. one.name, used))
    bounds[#bounds + 1] = core.interval(one.leaf.lo, one.leaf.hi)
  end
  return bounds
end

-- The system with its functions of bounded rate as states; itself if there are none. Of the fastest `forgotten` ones
-- (none) the equations have any value within the bounds instead: that is true, too, and says more of one that crosses
-- its range faster than the system moves.
function varying.carried(system, forgotten)
  if next(rated) == nil then return system end
  local formulas = copy(system.rates)
  for _, jump in ipairs(core.system_jumps(system.system)) do
    table.move(jump[3], 1, #jump[3], #formulas + 1, formulas)
  end
  local found = found_in(formulas)
  if #found == 0 then return system end
  table.sort(found, function(a, b)
    local x, y = speed_of(a), speed_of(b)
    return x > y or x == y and a.leaf.number < b.leaf.number
  end)
  local bounds = states_of(found, system, formulas)
  local names, units, symbols = copy(system.states), copy(system.units), copy(system.symbols)
  local from, to, defaults, further = {}, {}, {}, {}
  for name, value in pairs(system.defaults or {}) do defaults[name] = value end
  for k, one in ipairs(found) do
    names[#names + 1], units[#units + 1], symbols[#symbols + 1] = one.name, one.about.unit or "1", one.symbol
    if k > (forgotten or 0) then from[#from + 1], to[#to + 1] = one.leaf.expression, one.symbol end
    defaults[one.name] = { initial = one.start }
  end
  local rates = core.substitute(system.rates, from, to)
  for _, one in ipairs(found) do
    rates[#rates + 1] = one.rate
    -- the implicit form adds states by formulas that it differentiates: of s t, which is s, replaced by the rate
    local slope = core.between(0, 1)
    from[#from + 1], to[#to + 1], further[#further + 1] = slope, one.rate, slope * core.time()
  end
  local invariants, invariant_names = core.system_invariants(system.system)
  local handle = core.system(names, units, symbols, rates, core.substitute(invariants, from, to), invariant_names,
    system.system, from, to, further)
  for _, jump in ipairs(core.system_jumps(system.system)) do
    local after = core.substitute(jump[3], from, to)
    for _, one in ipairs(found) do after[#after + 1] = one.symbol end
    core.system_jump(handle, jump[1], jump[2], after)
  end
  core.system_bound(handle, bounds)
  return setmetatable({ system = handle, states = names, units = units, symbols = symbols, rates = rates,
    defaults = defaults, carried = found, plain = #system.states }, { __index = system })
end

-- The initial values of a request, with those of carried states by place, too.
function varying.initial(given, system)
  if type(given) ~= "table" or not system.carried or #given ~= system.plain then return given end
  local list = copy(given)
  for _, one in ipairs(system.carried) do list[#list + 1] = one.start end
  return list
end

-- Is this what such a state starts from if nothing is said?
function varying.is_start(one, initial)
  local leaves = core.leaves { initial }
  return #leaves == 1 and leaves[1].number == core.leaves({ one.start })[1].number
end

-- May carried states start within their bounds? What a set that a run came to has beyond them holds no function.
function varying.check_starts(initial, system, what)
  for k, one in ipairs(system.carried or {}) do
    local x = core.evaluate({ expressions = { initial[system.plain + k] } })[1]
    if not (x.lo <= one.leaf.hi and x.hi >= one.leaf.lo) then
      check.fail("%s: initial.%s: `%s` stays between %g and %g", what, one.name, one.name, one.leaf.lo, one.leaf.hi)
    end
  end
end

return varying
