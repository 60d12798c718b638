-- leg/surface.lua -- a set of states just before its solutions meet the surface g = 0 -> exactly onto the surface,
-- and from there to one common instant.
--
-- Onto: with c = g at the start, dx/ds = -c f/g', dt/ds = -c/g', dc/ds = 0 moves every solution along its own path, and
-- g(x(s), t(s)) = c (1 - s): at s = 1 it is 0. Away: with tau the time at the start, dx/ds = (T - tau) f(x, tau + s
-- (T - tau)) is at s = 1 where the solution is at T. Both are runs of any solver; docs/numerics/events.md.
local core = require "ambit.core"
local fresh = require "ambit.fresh"
local leg = require "ambit.leg"

local surface = {}

-- The clock and the distance of a system of these states: names of their own, since a system may have a clock already.
local function names_of(states)
  local used = fresh.set(states)
  return fresh.name("(time)", used), fresh.name("(distance)", used)
end

-- dg/dt along the solutions, undefined where g has a kink
function surface.rate(g, system) return core.rate_off_kinks(g, system.symbols, system.rates) end

-- { expression } with states and time replaced
function surface.at(list, system, x, t)
  local leaves, values = { core.time() }, { core.expression(t) }
  table.move(system.symbols, 1, #system.symbols, 2, leaves)
  table.move(x, 1, #x, 2, values)
  return core.substitute(list, leaves, values)
end

-- The system's states and more of them, `rates` being those of all.
local function extended(system, more, symbols, rates)
  local names, units = table.move(system.states, 1, #system.states, 1, {}), table.move(system.units, 1, #system.units,
    1, {})
  local all = table.move(system.symbols, 1, #system.symbols, 1, {})
  for i, name in ipairs(more) do
    names[#names + 1], units[#units + 1], all[#all + 1] = name, "1", symbols[i]
  end
  return leg.system(names, units, all, rates)
end

-- The system with time as a state, for those whose solutions are at different times.
function surface.with_clock(system)
  local name = names_of(system.states)
  local clock = core.symbol(name, "s")
  local rates = core.substitute(system.rates, { core.time() }, { clock })
  rates[#rates + 1] = core.expression(1)
  return extended(system, { name }, { clock }, rates), clock
end

-- x: the states at time t (all expressions) -> { x, t } on g = 0, with the run that went there, if that is complete;
-- when: enclosure of t
function surface.onto(base, system, g, x, t)
  local time_name, distance_name = names_of(system.states)
  local clock, distance = core.symbol(time_name, "s"), core.symbol(distance_name, "1")
  local list = { surface.rate(g, system) }
  table.move(system.rates, 1, #system.rates, 2, list)
  list = core.substitute(list, { core.time() }, { clock })
  local speed, rates = -distance / list[1], {}
  for i = 1, #system.rates do rates[i] = speed * list[i + 1] end
  rates[#rates + 1], rates[#rates + 2] = speed, core.expression(0)
  local whole = extended(system, { time_name, distance_name }, { clock, distance }, rates)
  local initial = table.move(x, 1, #x, 1, {})
  initial[#initial + 1], initial[#initial + 2] = core.expression(t), surface.at({ g }, system, x, t)[1]
  local run = leg.run(base, whole, initial, { 0.0, 1.0 })
  local names = table.move(system.states, 1, #system.states, 1, {})
  names[#names + 1] = time_name
  local set = leg.set(base, run, names)
  return { run = run, t = set and table.remove(set), x = set, when = run.x[time_name] }
end

-- x: the states at time t -> where they are at T, with the run and the watch of the events in the list (whose t is s)
function surface.away(base, system, x, t, T, list, starts_on)
  local name = names_of(system.states)
  local clock = core.symbol(name, "s")
  local left = core.expression(T) - clock
  local now, expressions = clock + core.time() * left, table.move(system.rates, 1, #system.rates, 1, {})
  for _, e in ipairs(list) do expressions[#expressions + 1] = e.g end
  expressions = core.substitute(expressions, { core.time() }, { now })
  local rates, moved = {}, {}
  for i = 1, #system.rates do rates[i] = left * expressions[i] end
  rates[#rates + 1] = core.expression(0)
  for i, e in ipairs(list) do
    moved[i] = setmetatable({ g = expressions[#system.rates + i] }, { __index = e })
  end
  local whole = extended(system, { name }, { clock }, rates)
  local initial = table.move(x, 1, #x, 1, {})
  initial[#initial + 1] = t
  local run, watch = leg.run(base, whole, initial, { 0.0, 1.0 }, moved, { starts_on = starts_on })
  return { run = run, x = leg.set(base, run, system.states) }, watch
end

return surface
