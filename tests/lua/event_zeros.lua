-- event_zeros.lua -- ambit run tests/lua/event_zeros.lua [SYSTEMS [FIRST]]: is any zero of an event lost?
--
-- Each system has a closed form, and a function u of its states, its data and time that is 0 at a time c that is a
-- double. Events are made of such u by functions that keep the zero: roots, distances, abs, products, min and max,
-- inverse functions at the ends of their domains, and these of each other. Most of them have no derivative there, or no
-- values beyond it. Every c must lie in the time of an event, or the run must be unable before it; where g is 0 without
-- changing its sign, or beyond which it is not defined, the event must not be certain.
local ambit = require "ambit"
local systems, first = tonumber(arg[1] or 2000), tonumber(arg[2] or 1)

-- -- random choices, the same on every machine

local state

local function random(n) -- 1 .. n
  state = state * 6364136223846793005 + 1442695040888963407
  return (state >> 33) % n + 1
end

local function one_of(list) return list[random(#list)] end

local function dyadic(lo, hi) return lo + (hi - lo) * random(256) / 256 end

-- -- systems with known solutions: { ode, initial, u(c) -> function(s, p, t) that is 0 at c }

local function datum(middle)
  if random(2) == 1 then return ambit.number(middle) end
  return ambit.between(middle - 1 / 64, middle + 1 / 64)
end

local function line()
  local slope, x0 = one_of { 1, -1, 0.5, -2 }, datum(dyadic(-1, 1))
  local ode = ambit.ode { states = { "x" }, equations = function(s) return { x = slope + 0 * s.x } end }
  return ode, { x = x0 }, function(c) return function(s) return s.x - x0 - slope * c end end
end

local function decay()
  local x0 = datum(1)
  local ode = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
  return ode, { x = x0 }, function(c)
    local grown = ambit.exp(ambit.number(c))
    return one_of { function(s) return s.x * grown - x0 end, function(s) return ambit.log(s.x / x0) + c end,
      function(s, _, t) return s.x * ambit.exp(t) - x0 + s.x * (t - c) end }
  end
end

local function turning()
  local x0 = datum(1)
  local ode = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = -s.y, y = s.x } end }
  return ode, { x = x0, y = 0 }, function(c)
    local cos, sin = ambit.cos(ambit.number(c)), ambit.sin(ambit.number(c))
    return one_of { function(s) return s.y * cos - s.x * sin end, function(s) return s.x - x0 * cos end,
      function(s) return x0 * sin - s.y end }
  end
end

local function falling()
  local y0, v0 = datum(2), datum(dyadic(-1, 1))
  local ode = ambit.ode { states = { "y", "v" }, equations = function(s) return { y = s.v, v = -4 + 0 * s.v } end }
  return ode, { y = y0, v = v0 }, function(c)
    return one_of { function(s) return s.v - v0 + 4 * c end, function(s) return s.y - y0 - v0 * c + 2 * c * c end }
  end
end

local function slowing()
  local ode = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x ^ 2 } end }
  return ode, { x = 1 }, function(c) return function(s) return s.x * (1 + c) - 1 end end
end

-- -- functions of u that are 0 where u is 0; graze: no sign changes there, or there are no values on one side; edge:
-- they are not defined everywhere

local abs, sqrt, min, max = ambit.abs, ambit.sqrt, ambit.min, ambit.max

local wrappers = {
  { "u^2", function(u) return u ^ 2 end, graze = true },
  { "sqrt(u^2)", function(u) return sqrt(u ^ 2) end, graze = true },
  { "sqrt(u)", function(u) return sqrt(u) end, edge = true, graze = true },
  { "sqrt(-u)", function(u) return sqrt(-u) end, edge = true, graze = true },
  { "sqrt(|u|)", function(u) return sqrt(abs(u)) end, graze = true },
  { "|u|", function(u) return abs(u) end, graze = true },
  { "-|u|", function(u) return -abs(u) end, graze = true },
  { "u sqrt(u)", function(u) return u * sqrt(u) end, edge = true, graze = true },
  { "u |u|", function(u) return u * abs(u) end },
  { "u^3", function(u) return u ^ 3 end },
  { "2 u + |u|", function(u) return 2 * u + abs(u) end },
  { "max(u, 2 u)", function(u) return max(u, 2 * u) end },
  { "max(u, -u / 2)", function(u) return max(u, -u / 2) end, graze = true },
  { "min(u, u^2)", function(u) return min(u, u ^ 2) end },
  { "min(u, 1 / 8)", function(u) return min(u, 0.125) end },
  { "sin u", function(u) return ambit.sin(u) end },
  { "acos(1 - u^2)", function(u) return ambit.acos(1 - u ^ 2) end, edge = true, graze = true },
  { "asin(sqrt(u))", function(u) return ambit.asin(sqrt(u)) end, edge = true, graze = true },
  { "log(1 + u)", function(u) return ambit.log(1 + u) end, edge = true },
  { "exp u - 1", function(u) return ambit.exp(u) - 1 end },
  { "atan2(u, 1)", function(u) return ambit.atan2(u, 1) end },
  { "atan2(u, |u| - 1 / 4)", function(u) return ambit.atan2(u, 0.25 - abs(u)) end },
  { "u / sqrt(1 + u^2)", function(u) return u / sqrt(1 + u ^ 2) end },
  { "sqrt(-|u|)", function(u) return sqrt(-abs(u)) end, edge = true, graze = true },
}

-- Of two functions with a zero at the same c, or each its own.
local pairs_of = {
  { "distance", function(u, v) return sqrt(u ^ 2 + v ^ 2) end, same = true, graze = true },
  { "product", function(u, v) return u * v end },
  { "min", function(u, v) return min(abs(u), abs(v)) end, graze = true },
  { "product of roots", function(u, v) return sqrt(abs(u)) * v end },
  { "root of product", function(u, v) return sqrt(u * v) end, graze = true },
}

local total = {}
for _, w in ipairs(wrappers) do if not w.edge then total[#total + 1] = w end end

local function wrap(u, depth, list)
  local f, names, graze = u, {}, false
  for i = 1, depth do
    local w, inner = one_of(list), f
    f, names[i], graze = function(...) return w[2](inner(...)) end, w[1], graze or w.graze
  end
  return f, table.concat(names, " of "), graze
end

-- { g, name, zeros = { c }, graze } with one planted zero or two
local function planted(u, place)
  local c = place()
  if random(3) > 1 then
    local g, name, graze = wrap(u(c), random(3) - 1, wrappers)
    return { g = g, name = name, zeros = { c }, graze = graze }
  end
  local two = one_of(pairs_of)
  local d = two.same and c or place()
  local f, h = wrap(u(c), random(2) - 1, total), wrap(u(d), random(2) - 1, total)
  return { g = function(...) return two[2](f(...), h(...)) end, name = two[1], zeros = { c, d }, graze = two.graze }
end

-- -- one system

local solvers = { "lohner", "taylor_model", "stiff", "valencia" }
local counts = { systems = 0, zeros = 0, found = 0, certain = 0, unable = 0, lost = 0 }

local function fail(number, event, c, why)
  counts.lost = counts.lost + 1
  print(("system %d: g = %s, zero at %.17g: %s"):format(number, event.name, c, why))
end

-- Did the run end before c, by itself or with an event of those that stop it?
local function ended_before(run, stops, c, way)
  if (run.t_reached - c) * way < 0 then return true end
  for _, found in ipairs(run.events) do
    local last = way > 0 and found.t.hi or found.t.lo
    if stops[found.name] and (last - c) * way < 0 then return true end
  end
  return false
end

-- Of the events called `name`, is the one that holds c there?
local function judge(number, run, event, name, c, way, stops)
  if c == 0 then return end -- where g is 0 at the start, that is no event
  counts.zeros = counts.zeros + 1
  for _, found in ipairs(run.events) do
    if found.name == name and found.t:contains(c) then
      counts.found = counts.found + 1
      if found.certain then counts.certain = counts.certain + 1 end
      if found.certain and event.graze then fail(number, event, c, "certain, but g only touches 0") end
      return
    end
  end
  if ended_before(run, stops, c, way) then
    counts.unable = counts.unable + 1
  else
    fail(number, event, c, ("%s at %.17g (%s), %d events"):format(run.status, run.t_reached, run.reason, #run.events))
  end
end

local function simulate(number, q, list, times, way)
  local events, stops = {}, {}
  for k, event in ipairs(list) do
    events[k] = { g = event.g, name = tostring(k), stop = random(4) == 1 }
    stops[tostring(k)] = events[k].stop
  end
  local run = ambit.simulate { q.ode, initial = q.initial, t = times, solver = q.solver, events = events }
  for k, event in ipairs(list) do
    for _, c in ipairs(event.zeros) do judge(number, run, event, tostring(k), c, way, stops) end
  end
end

-- A switch, or a return to a section: at the first zero or before, if other zeros are there.
local function first_of(number, event, run, found)
  for _, c in ipairs(event.zeros) do
    if c > 0 then
      counts.zeros = counts.zeros + 1
      if found and found.t:contains(c) then
        counts.found = counts.found + 1
        counts.certain = counts.certain + 1
        if event.graze then fail(number, event, c, "passed through, but g only touches 0") end
      elseif found and found.t.hi < c or run.status ~= "complete" and run.status ~= "partial" and not found then
        counts.unable = counts.unable + 1
      else
        fail(number, event, c, ("%s (%s)"):format(run.status, run.reason))
      end
    end
  end
end

local function switch(number, q, event, times)
  local behind = {}
  for _, name in ipairs(q.ode.states) do behind[name] = function(s) return s[name] end end
  local run = ambit.hybrid { initial = q.initial, t = times, solver = q.solver, mode = "before", modes = {
    before = { q.ode, guards = { { g = event.g, to = "behind" } } }, behind = { q.ode } } }
  first_of(number, event, run, run.events[1])
end

local function return_to(number, q, event, times)
  local map = ambit.poincare { q.ode, section = event.g, initial = q.initial, t_max = times[#times], solver = q.solver }
  first_of(number, event, map, map.returns[1])
end

local function try(number)
  state = number * 7919
  for _ = 1, 3 do random(2) end
  local ode, initial, u = one_of { line, decay, turning, falling, slowing }()
  local q = { ode = ode, initial = initial, solver = solvers[number % #solvers + 1] }
  local verb = number // #solvers % 8
  local way = verb < 6 and random(5) == 1 and -1 or 1
  local finish, instant = way * dyadic(0.5, 0.75), way * dyadic(0.125, 0.375)
  local function place() -- inside, at the ends, at an instant at which a step ends
    local kind = random(8)
    return kind == 1 and 0.0 or kind == 2 and finish or kind == 3 and instant or finish * dyadic(0, 1)
  end
  local list, times = {}, { 0, instant, finish }
  for k = 1, verb < 6 and random(3) or 1 do list[k] = planted(u, place) end
  counts.systems = counts.systems + 1
  local good, message
  if verb < 6 then
    good, message = pcall(simulate, number, q, list, times, way)
  else
    good, message = pcall(verb == 6 and switch or return_to, number, q, list[1], times)
  end
  if not good then fail(number, list[1], list[1].zeros[1], tostring(message)) end
end

for number = first, first + systems - 1 do try(number) end
print(("%d systems, %d zeros: %d in the time of an event (%d of them certain), %d behind the end of the run, %d lost")
  :format(counts.systems, counts.zeros, counts.found, counts.certain, counts.unable, counts.lost))
if counts.lost > 0 then error("zeros were lost", 0) end
