-- jitter.lua -- controllers whose clocks jitter: each sample is at an instant of its own, in a window of 2 `jitter`.
--
-- Who follows solutions takes the system with windows: it leaps where a window opens and where it closes, at known
-- instants, and a function of time that is 1 before the sample and 0 behind it says what acts in between. Of that
-- function nothing is asked but that it is measurable, so that every true solution is one of that system
-- (docs/numerics/zonotope.md, section 7d). Samples are drawn by the clock itself (by_clock).
local check = require "ambit.check"
local core = require "ambit.core"
local fresh = require "ambit.fresh"

local jitter = {}

local function copy(list) return table.move(list, 1, #list, 1, {}) end

local function append(list, other) return table.move(other, 1, #other, #list + 1, list) end

local function names_in(formulas)
  local names = {}
  for _, leaf in ipairs(core.leaves(formulas)) do names[#names + 1] = leaf.name end
  return names
end

-- Within which bounds the states stay, of functions of bounded rate.
local function keep_bounds(handle, system, n)
  if not system.carried then return end
  local bounds = {}
  for i = 1, n do bounds[i] = core.interval(-math.huge, math.huge) end
  for k, one in ipairs(system.carried) do bounds[system.plain + k] = core.interval(one.leaf.lo, one.leaf.hi) end
  core.system_bound(handle, bounds)
end

-- An unknown for a rate: what varies has its share of an equation's width there, not of each rate's.
local function put_unknown(form, one, rate)
  local unknown, n = core.symbol(one.name .. "'", "1"), #form.unknowns + 1
  form.unknowns[n], form.residuals[n], form.pivot[n] = unknown, unknown - rate, n
  return unknown
end

local function is_zero(e)
  local x = core.is_constant(e) and core.tight(e)
  return x and x.lo == 0 and x.hi == 0
end

-- The system with further states, { name, symbol, rate }. speed: that of the states it has; from, to: leaves that are
-- replaced in their rates. A rate may be a function of the list of these, which the implicit form has otherwise.
local function extended(system, further, speed, from, to)
  local names, units, symbols = copy(system.states), copy(system.units), copy(system.symbols)
  for _, one in ipairs(further) do
    names[#names + 1], units[#units + 1], symbols[#symbols + 1] = one.name, "1", one.symbol
  end
  local function change(list) return core.substitute(list, from, to) end
  local function all_of(rates, put)
    local all = change(rates)
    for i, rate in ipairs(all) do rates[i], all[i] = rate, speed and speed * rate or rate end
    for _, one in ipairs(further) do
      local rate = one.rate
      if type(rate) == "function" then rate = rate(rates) end
      all[#all + 1] = is_zero(rate) and rate or put(one, rate)
    end
    return all
  end
  local invariants, invariant_names = core.system_invariants(system.system)
  local rates = all_of(copy(system.rates), function(_, rate) return rate end)
  local handle, form = core.system(names, units, symbols, rates, change(invariants), invariant_names),
    core.system_implicit(system.system)
  if form then
    form.residuals = change(form.residuals)
    form.rates = all_of(form.rates, function(one, rate) return put_unknown(form, one, rate) end)
    if #form.unknowns > form.stage_end[#form.stage_end] then form.stage_end[#form.stage_end + 1] = #form.unknowns end
    core.system_give_implicit(handle, form)
  end
  keep_bounds(handle, system, #names)
  return setmetatable({ system = handle, states = names, units = units, symbols = symbols, rates = rates,
    further = further, without_jitter = system }, { __index = system })
end

local function namer(system, jumps)
  local used = fresh.set(system.states, names_in(system.rates))
  for _, jump in ipairs(jumps) do
    for _, name in ipairs(names_in(jump[3])) do used[name] = true end
  end
  return function(name) return fresh.name(name, used) end
end

local function state(name) return { name = name, symbol = core.symbol(name, "1"), rate = core.expression(0) } end

-- -- windows

-- What a sample changes: { number of the state, what it becomes }, ...; the other states by number of their leaves.
local function changes_of(system, jump)
  local list, moving = {}, {}
  for i, to in ipairs(jump[3]) do
    if is_zero(to - system.symbols[i]) then
      moving[core.leaves({ system.symbols[i] })[1].number] = i
    else
      list[#list + 1] = { at = i, to = to, own = system.symbols[i] }
    end
  end
  return list, moving
end

local function has_kinks(to, moving)
  for _, leaf in ipairs(core.leaves { to }) do
    if moving[leaf.number] and not pcall(core.derivative, to, leaf.expression) then return true end
  end
  return not pcall(core.derivative, to, core.time())
end

-- run d(to)/dt
local function slope_of(to, moving, run)
  return function(rates)
    local sum = core.derivative(to, core.time())
    for _, leaf in ipairs(core.leaves { to }) do
      local i = moving[leaf.number]
      if i then sum = sum + core.derivative(to, leaf.expression) * rates[i] end
    end
    return run * sum
  end
end

-- A value of it at the start of a run: what varies has some value then.
local function at_start(e, from, to)
  local leaves, values = copy(from), copy(to)
  for _, leaf in ipairs(core.leaves { e }) do
    if leaf.kind == "varying" then
      leaves[#leaves + 1], values[#values + 1] = leaf.expression, core.between(leaf.lo, leaf.hi, leaf.name)
    end
  end
  return core.substitute({ e }, leaves, values)[1]
end

-- Of a law with kinks: copies of what it reads, which stop at the sample. Adds them to w.
local function copies_of(w, to, moving, name, run)
  local from, values = {}, {}
  for _, leaf in ipairs(core.leaves { to }) do
    local i, is_time = moving[leaf.number], leaf.kind == "time"
    if (i or is_time) and not w.copy[leaf.number] then
      local one = state(name(leaf.name .. ".read"))
      one.open, one.shut, one.rate = leaf.expression, core.expression(0), function(rates)
        return is_time and run or run * rates[i]
      end
      w.copy[leaf.number] = one
      w.states[#w.states + 1] = one
    end
    local one = w.copy[leaf.number]
    if one then from[#from + 1], values[#values + 1] = leaf.expression, one.symbol end
  end
  return core.substitute({ to }, from, values)[1]
end

-- The window of one controller: its states, with what they become where it opens and shuts; what its outputs are while
-- it is open, `seen`; what they become where it shuts, `after`.
local function window_of(system, jump, size, name)
  local changes, moving = changes_of(system, jump)
  local is_open, before = state(name "window"), core.varying(0, 1, name "before the sample")
  local w = { states = { is_open }, copy = {}, changes = changes, after = {}, own = {}, seen = {},
    period = jump[1], shut = jump[2] + size, open = jump[2] - size }
  w.starts_open = core.tight(w.open).lo < 0
  if w.starts_open then w.open = w.open + jump[1] end
  is_open.open, is_open.shut = core.expression(1), core.expression(0)
  local run, held = is_open.symbol * before, is_open.symbol * (1 - before)
  for k, one in ipairs(changes) do
    local ahead
    if has_kinks(one.to, moving) then
      ahead = copies_of(w, one.to, moving, name, run) - one.own
    else
      local by = state(name(system.states[one.at] .. ".change"))
      by.open, by.shut, by.rate = one.to - one.own, core.expression(0), slope_of(one.to, moving, run)
      w.states[#w.states + 1], ahead = by, by.symbol
    end
    w.own[k], w.seen[k], w.after[k] = one.own, one.own + held * ahead, one.own + ahead
  end
  return w
end

-- What all states become: key: "open" or "shut"
local function leap(all, w, key)
  local to = copy(all.symbols)
  for _, one in ipairs(w.states) do to[one.at] = one[key] end
  if key == "shut" then
    for k, one in ipairs(w.changes) do to[one.at] = w.after[k] end
  end
  return to
end

-- The same of a controller that does not jitter, whose law may read what others do.
local function leap_beside(all, jump, own, seen)
  local to = core.substitute(jump, own, seen)
  for i, symbol in ipairs(all.symbols) do
    if not jump[i] or is_zero(jump[i] - symbol) then to[i] = symbol end
  end
  return to
end

local function check_apart(system, controller, w)
  for _, one in ipairs(w.changes) do
    for _, leaf in ipairs(core.leaves { one.to }) do
      for _, other in ipairs(system.sampled) do
        for _, held in ipairs(other ~= controller and require "ambit.sampled".states(other) or {}) do
          if leaf.kind == "symbol" and leaf.name == held.name then
            check.fail("sampled `%s`: jitter: its law reads `%s`, which `%s` changes at samples of its own",
              controller.name, held.name, other.name)
          end
        end
      end
    end
  end
end

-- The system with windows for all controllers that jitter; itself if none does.
function jitter.windows(system)
  if not system.jitter then return system end
  local jumps, windows, further, own, seen = core.system_jumps(system.system), {}, {}, {}, {}
  local name = namer(system, jumps)
  for c, controller in ipairs(system.sampled) do
    local w = controller.jitter and window_of(system, jumps[c], controller.jitter, name)
    if w then
      check_apart(system, controller, w)
      append(further, w.states)
      append(own, w.own)
      append(seen, w.seen)
    end
    windows[c] = w or false
  end
  for k, one in ipairs(further) do one.at = #system.states + k end
  local all = extended(system, further, nil, own, seen)
  for c, w in ipairs(windows) do
    if w then
      core.system_jump(all.system, w.period, w.open, leap(all, w, "open"))
      core.system_jump(all.system, w.period, w.shut, leap(all, w, "shut"))
    else
      core.system_jump(all.system, jumps[c][1], jumps[c][2], leap_beside(all, jumps[c][3], own, seen))
    end
  end
  all.held, all.seen, all.windows = own, seen, windows
  return all
end

-- -- the clock itself

-- The system by the clock of its only controller, which sees each sample at its own instant: x' = (1 + pace) f. How
-- late the last sample was and the next one will be are states, in parts of the jitter, and each sample draws another.
-- still: times at which the clock is right, so that the states there are those of the system.
function jitter.by_clock(system, still)
  local jump = core.system_jumps(system.system)[1]
  local name, size = namer(system, { jump }), core.in_unit(system.sampled[1].jitter, "1")
  local period, now = core.in_unit(jump[1], "1"), core.in_unit(core.time(), "1")
  local late, last, coming = state(name "late"), state(name "late.last"), state(name "late.next")
  late.rate = (coming.symbol - last.symbol) / period
  local drawn = core.varying(-1, 1, name "jitter")
  for _, t in ipairs(still) do
    local off = core.abs(now + period - t) / period -- of the next sample
    drawn = drawn * core.max(0, core.min(1, 1 + (off - 1) * 1e6))
  end
  local from, to = { core.time() }, { core.time() + core.in_unit(size * late.symbol, "s") }
  local all = extended(system, { late, last, coming }, 1 + size * late.rate, from, to)
  local after = core.substitute(jump[3], from, to)
  append(after, { coming.symbol, coming.symbol, drawn })
  core.system_jump(all.system, jump[1], jump[2], after)
  return all
end

-- -- what verbs do with them

-- For samples at these times, as a request lists them. Of several controllers, some of which jitter, none does: that is
-- allowed, too.
function jitter.for_samples(system, times)
  local still = {}
  if #system.sampled > 1 then return system end
  for _, t in ipairs(type(times) == "table" and times or { times }) do
    local good, e = pcall(core.expression, t, "s")
    if good and core.is_constant(e) then still[#still + 1] = core.in_unit(e, "1") end
  end
  return jitter.by_clock(system, still)
end

-- The initial values of all its states, from those of the system without jitter.
function jitter.start(system, initial, t)
  local from, to = append({ core.time() }, copy(system.symbols)), append({ core.expression(t) }, copy(initial))
  local list, opening = copy(initial), {}
  for k = #to + 1, #from do to[k] = core.expression(0) end
  for _, w in ipairs(system.windows or {}) do
    for _, one in ipairs(w and w.starts_open and w.states or {}) do opening[one] = true end
  end
  for _, one in ipairs(system.further or {}) do
    list[#list + 1] = opening[one] and at_start(one.open, from, to) or core.expression(0)
  end
  return list
end

-- A request about the system with windows becomes one for samples.
function jitter.draw(q)
  local plain = q.system.without_jitter
  q.system = jitter.for_samples(plain, q.times)
  q.initial = jitter.start(q.system, table.move(q.initial, 1, #plain.states, 1, {}), q.times[1])
end

-- A formula of the states, with what outputs are while a window is open.
function jitter.seen(system, e) return core.substitute({ e }, system.held, system.seen)[1] end

-- { [number of a state] = true } of those that leap at samples whose instants are not known.
function jitter.leaping(system)
  local list = {}
  for _, w in ipairs(system.windows) do
    for _, one in ipairs(w and w.changes or {}) do list[one.at] = true end
  end
  return list
end

-- Enclosures of the states as the scene has them, of those of all states at the same time.
function jitter.shown(system, list)
  local values, shown = {}, {}
  for k, x in ipairs(list) do values[k] = core.expression(x) end
  for i in ipairs(system.without_jitter.states) do shown[i] = list[i] end
  local seen, k = core.evaluate { expressions = system.seen, leaves = system.symbols, values = values }, 0
  for _, w in ipairs(system.windows) do
    for _, one in ipairs(w and w.changes or {}) do
      k = k + 1
      shown[one.at] = seen[k]
    end
  end
  return shown
end

return jitter
