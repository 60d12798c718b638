-- random_equations.lua -- does any solution of random equations leave what was proved about it?
--   ambit run tests/lua/random_equations.lua [--solver NAME] [--systems N] [--draws N] [--seed N] [--beyond X]
--     [--kinks] [--varying] [--verbose]
--
-- Systems of 1 to 8 states and 1 to 10 data of .01 to 10 %, of every operation that a tape may hold, forwards and
-- backwards in time; solutions for drawn data and initial values, most of them corners, are integrated in extended
-- precision (tests/oracle/equations_lua.c) and must lie inside, at ends of steps and between; and at the end of the run
-- in the set for just these data (run:set()), which is much narrower. Needs the test module
-- `equations` in LUA_CPATH. --beyond 2: data are drawn from twice their ranges, so that solutions must be found
-- outside. --varying: about half of the parameters are functions of time, drawn as steps between the ends of their
-- ranges at random times, or, where their rate is bounded, which is so of half of them, as lines. --kinks: with abs,
-- min and max that solutions cross, forces with two slopes and dead zones among them. Exit 1 if a solution is outside
-- by more than the oracle may be off.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"
local equations = require "equations"

local DOUBT = 20 -- times the differences of solutions that were found by different steps

local o = { systems = 40, draws = 20, seed = 1, beyond = 1, solver = "zonotope" }
do
  local i = 1
  while arg[i] do
    local key = arg[i]:match "^%-%-(%a+)$"
    if key == "verbose" or key == "kinks" or key == "varying" then
      o[key], i = true, i + 1
    elseif key and o[key] and arg[i + 1] then
      o[key], i = tonumber(arg[i + 1]) or arg[i + 1], i + 2
    else
      io.stderr:write(("random_equations.lua: unknown or incomplete option `%s`\n"):format(arg[i]))
      os.exit(2)
    end
  end
end

-- A generator of its own, so that systems do not depend on the interpreter's.
local state = o.seed * 2654435761 + 12345
local function unit()
  state = (state * 6364136223846793005 + 1442695040888963407)
  return ((state >> 11) & 0x1fffffffffffff) / 0x20000000000000
end
local function pick(n) return 1 + math.floor(unit() * n) end

-- -- systems: lists of instructions over slots x, p, t

local binary = { add = 1, sub = 1, mul = 1, div = 1, atan2 = 1, min = 1, max = 1, hypot = 1, pow = 1 }

local function random_system()
  local nx, np = pick(8), pick(10)
  local s = { nx = nx, np = np, code = {}, out = {}, inputs = nx + np + 1 }
  local function emit(op, a, b)
    s.code[#s.code + 1] = { op, a, b }
    return s.inputs + #s.code
  end
  local function number(x) return emit("number", x) end
  local function leaf()
    local r = unit()
    return r < 0.6 and pick(nx) or r < 0.9 and nx + pick(np) or r < 0.95 and nx + np + 1 or number(2 * unit() - 1)
  end
  local positive -- of a slot: 1 + a^2 or so
  local expression
  function positive(a) return emit("add", number(1 + unit()), emit("sqr", a)) end
  local function tame(a) return emit("sin", a) end
  local kinds = {
    function(d) return emit("add", expression(d), expression(d)) end,
    function(d) return emit("sub", expression(d), expression(d)) end,
    function(d) return emit("mul", expression(d), expression(d)) end,
    function(d) return emit("mul", expression(d), expression(d)) end,
    function(d) return emit("sqr", expression(d)) end,
    function(d) return emit("div", expression(d), positive(expression(d))) end,
    function(d) return emit("sqrt", positive(expression(d))) end,
    function(d) return emit("exp", tame(expression(d))) end,
    function(d) return emit("log", positive(expression(d))) end,
    function(d) return emit("sin", expression(d)) end,
    function(d) return emit("cos", expression(d)) end,
    function(d) return emit("tan", emit("mul", number(0.7), tame(expression(d)))) end,
    function(d) return emit("atan", expression(d)) end,
    function(d) return emit("atan2", expression(d), positive(expression(d))) end,
    function(d) return emit("sinh", tame(expression(d))) end,
    function(d) return emit("cosh", tame(expression(d))) end,
    function(d) return emit("tanh", expression(d)) end,
    function(d) return emit("asin", emit("mul", number(0.8), tame(expression(d)))) end,
    function(d) return emit("acos", emit("mul", number(0.8), tame(expression(d)))) end,
    function(d) return emit("abs", positive(expression(d))) end,
    function(d) return emit("min", tame(expression(d)), number(1.5)) end,
    function(d) return emit("max", tame(expression(d)), number(-1.5)) end,
    function(d) return emit("neg", expression(d)) end,
    function(d) return emit("log1p", emit("sqr", expression(d))) end,
    function(d) return emit("expm1", tame(expression(d))) end,
    function(d) return emit("asinh", expression(d)) end,
    function(d) return emit("acosh", positive(expression(d))) end,
    function(d) return emit("atanh", emit("mul", number(0.8), tame(expression(d)))) end,
    function(d) return emit("log2", positive(expression(d))) end,
    function(d) return emit("log10", positive(expression(d))) end,
    function(d) return emit("exp2", tame(expression(d))) end,
    function(d) return emit("cbrt", positive(expression(d))) end,
    function(d) return emit("hypot", expression(d), positive(expression(d))) end,
    function(d) return emit("pow", positive(expression(d)), tame(expression(d))) end,
  }
  -- a law with two slopes, a dead zone, a saturation, and kinks of any two expressions
  local zero = o.kinks and number(0)
  local kinked = {
    function(d)
      local x = expression(d)
      return emit("sub", emit("max", x, zero), emit("mul", number(0.4 * unit()), emit("min", x, zero)))
    end,
    function(d)
      local x, gap = expression(d), number(0.2 * unit())
      return emit("add", emit("max", emit("sub", x, gap), zero), emit("min", emit("add", x, gap), zero))
    end,
    function(d) return emit("max", emit("min", expression(d), number(unit())), number(-unit())) end,
    function(d) return emit("abs", expression(d)) end,
    function(d) return emit("max", expression(d), expression(d)) end,
    function(d) return emit("min", expression(d), expression(d)) end,
  }
  if o.kinks then table.move(kinked, 1, #kinked, #kinds + 1, kinds) end
  -- half of the systems hold few kinds of operations, so that each kind is the worst in some system
  local few = unit() < 0.5 and { o.kinks and kinked[pick(#kinked)] or kinds[pick(#kinds)], kinds[pick(6)], kinds[3] }
    or kinds
  local polynomial = few ~= kinds and unit() < 0.5
  if polynomial then few = { kinds[1], kinds[3], kinds[5] } end
  function expression(d)
    if d == 0 or unit() < 0.2 then return leaf() end
    return few[pick(#few)](d - 1)
  end
  for i = 1, nx do
    if i < nx and unit() < 0.2 then
      s.out[i] = pick(nx) -- a copy of a state, as positions have
    else
      local f = not polynomial and emit("mul", number(0.8), tame(expression(3)))
      if polynomial or unit() < 0.5 then f = emit("mul", number(0.6), expression(2)) end
      s.out[i] = emit("sub", f, emit("mul", number(0.5), i))
    end
  end
  return s
end

-- The system as Ambit's expressions.
local function build(s, x, p, t)
  local slot = {}
  for i = 1, s.nx do slot[i] = x["x" .. i] end
  for i = 1, s.np do slot[s.nx + i] = p["p" .. i] end
  slot[s.inputs] = t
  for k, c in ipairs(s.code) do
    local op, a, b = c[1], slot[c[2]], slot[c[3]]
    local r
    if op == "number" then r = ambit.number(c[2])
    elseif op == "add" then r = a + b
    elseif op == "sub" then r = a - b
    elseif op == "mul" then r = a * b
    elseif op == "div" then r = a / b
    elseif op == "neg" then r = -a
    elseif op == "sqr" then r = a ^ 2
    elseif binary[op] then r = ambit[op](a, b)
    else r = ambit[op](a) end
    slot[s.inputs + k] = r
  end
  local f = {}
  for i = 1, s.nx do f["x" .. i] = slot[s.out[i]] end
  return f
end

local function random_data(s)
  local function range(middle, tolerance) return { middle, middle == 0 and tolerance or math.abs(middle) * tolerance } end
  local tolerance = unit() < 0.5 and 0.02 + 0.08 * unit() or 10 ^ (-4 + 3 * unit())
  s.p, s.x = {}, {}
  s.varies, s.rate = {}, {}
  for i = 1, s.np do
    s.p[i] = range(2 * unit() - 1, tolerance)
    s.varies[i] = o.varying and (i == 1 or unit() < 0.5)
    if s.varies[i] and unit() < 0.5 then s.rate[i] = s.p[i][2] * 10 ^ (2 * unit() - 0.5) end
  end
  for i = 1, s.nx do s.x[i] = range(unit() < 0.2 and 0 or 2 * unit() - 1, unit() < 0.3 and 0 or tolerance) end
  s.from = unit() < 0.3 and 2 * unit() - 1 or 0
  s.to = s.from + (unit() < 0.3 and -1 or 1) * (0.2 + unit())
end

local function draw(s)
  local is_corner = unit() < 0.7
  local function value(r)
    local u = 2 * unit() - 1
    if is_corner then u = u < 0 and -1 or 1 end
    return r[1] + (1 - 1e-12) * o.beyond * r[2] * u
  end
  local point = { x = {}, p = {} }
  for i = 1, s.nx do point.x[i] = value(s.x[i]) end
  for i = 1, s.np do point.p[i] = value(s.p[i]) end
  point.value = value
  return point
end

-- The instructions for parameters a_i + b_i t in place of those with a rate; a is where these were, b behind all.
local function with_lines(s)
  local rated, code, place = {}, {}, {}
  for i = 1, s.np do
    if s.rate[i] then rated[#rated + 1] = i end
  end
  local inputs = s.inputs + #rated
  for j = 1, s.nx + s.np do place[j] = j end
  place[s.inputs] = inputs
  for k, i in ipairs(rated) do
    code[#code + 1] = { "mul", s.nx + s.np + k, inputs }
    code[#code + 1] = { "add", s.nx + i, inputs + #code }
    place[s.nx + i] = inputs + #code
  end
  for k, c in ipairs(s.code) do
    local is_number = c[1] == "number"
    code[#code + 1] = { c[1], is_number and c[2] or place[c[2]], not is_number and c[3] and place[c[3]] or nil }
    place[s.inputs + k] = inputs + #code
  end
  local out = {}
  for i, slot in ipairs(s.out) do out[i] = place[slot] end
  return code, out, rated
end

-- The parameter i, which is `value` at t, goes to another one until `till`: a, b, what it is then.
local function line(s, i, value, target, t, till)
  local rate, span = (1 - 1e-9) * s.rate[i], math.abs(till - t)
  local slope = span > 0 and math.max(-rate, math.min(rate, (target - value) / span)) or 0
  if till < t then slope = -slope end
  return value - slope * t, slope, value + slope * (till - t)
end

-- The solution at the times, and a function that finds it once more, by other steps; what varies takes other values at
-- random times. In one call, since states that are rounded to doubles in between are off by more than an ulp where
-- solutions run away.
local function solve(s, point, times)
  local list, steps, places, p = { times[1] }, {}, { 1 }, table.move(point.p, 1, s.np, 1, {})
  local code, out, rated = with_lines(s)
  local now = table.move(p, 1, s.np, 1, {})
  for k = 1, #rated do p[s.np + k] = 0 end
  local pieces = o.varying and pick(12) or 1
  for k = 2, #times do
    local t = times[k - 1]
    for n = 1, pieces do
      local next_one = n == pieces and times[k] or t + (times[k] - t) * unit()
      for i = 1, o.varying and s.np or 0 do
        if s.varies[i] and not s.rate[i] and unit() < 0.7 then p[i] = point.value(s.p[i]) end
      end
      for k, i in ipairs(rated) do
        p[i], p[s.np + k], now[i] = line(s, i, now[i], unit() < 0.7 and point.value(s.p[i]) or now[i], t, next_one)
      end
      if next_one ~= t then
        list[#list + 1] = next_one
        steps[#list] = table.move(p, 1, s.np + #rated, 1, {})
      end
      t = next_one
    end
    places[k] = #list
  end
  local function at(tolerance)
    local values = equations.solve { x = point.x, p = p, code = code, out = out, times = list, steps = steps,
      tolerance = tolerance }
    local states = {}
    for k, place in ipairs(values and places or {}) do states[k] = values[place] end
    return values and states
  end
  return at(1e-17), at
end

-- How far the oracle itself may be off, from how far its solutions by other steps are apart. Rounding grows as
-- solutions do: x' = 2.4 x^2 shortly before it has no solution any more loses 10 digits.
local function doubt(again, at, i, value)
  local most = 0
  for _, tolerance in ipairs { 4e-18, 2e-17, 5e-17 } do
    local other = again(tolerance)
    most = math.max(most, other and math.abs(other[at][i] - value) or 0)
  end
  return DOUBT * most
end

local function prove(s)
  local states, parameters, initial = {}, {}, {}
  s.data, s.is_state = {}, {} -- and the number of the state or parameter
  local function datum(r, number, is_state)
    s.data[#s.data + 1] = ambit.between(r[1] - r[2], r[1] + r[2])
    s.is_state[#s.data] = { number, is_state }
    return s.data[#s.data]
  end
  for i = 1, s.nx do
    states[i] = "x" .. i
    initial["x" .. i] = s.x[i][2] == 0 and s.x[i][1] or datum(s.x[i], i, true)
  end
  for i = 1, s.np do
    local r = s.p[i]
    parameters["p" .. i] = s.varies[i] and ambit.varying(r[1] - r[2], r[1] + r[2], { rate = s.rate[i] }) or
      datum(r, i, false)
  end
  local ode = ambit.ode { states = states, parameters = parameters,
    equations = function(x, p, t) return build(s, x, p, t) end }
  return ambit.simulate { ode, initial = initial, t = { s.from, s.to }, solver = o.solver, dense = true }
end

-- Ends of steps, and times between.
local function instants(run, s)
  local list, apart = {}, { s.from }
  for step in run:steps() do list[#list + 1] = step.t end
  while #list > 6 do table.remove(list, pick(#list - 1)) end
  for _ = 1, 6 do list[#list + 1] = s.from + (run.t_reached - s.from) * unit() end
  table.sort(list, function(a, b) return (a - b) * (s.to - s.from) < 0 end)
  for _, t in ipairs(list) do
    if t ~= apart[#apart] then apart[#apart + 1] = t end
  end
  return apart
end

local total = { values = 0, outside = 0, blurred = 0, complete = 0, solutions = 0, widths = 0 }

-- The set at the end for the data of a point.
local function set_at(s, set, point)
  local values, list = {}, {}
  for k, which in ipairs(s.is_state) do
    values[k] = ambit.number((which[2] and point.x or point.p)[which[1]])
  end
  for i = 1, s.nx do list[i] = set["x" .. i] end
  return ambit.evaluate { core.substitute(list, s.data, values), arithmetic = "interval" }
end

local function check(number)
  local s = random_system()
  random_data(s)
  local run = prove(s)
  local done = math.abs(run.t_reached - s.from) > 0
  if run.status == "complete" then total.complete = total.complete + 1 end
  local worst = 0
  if done then
    local times = instants(run, s)
    local sets = {}
    for k, t in ipairs(times) do sets[k] = run:at(t) end
    if times[#times] ~= run.t_reached then times[#times + 1], sets[#sets + 1] = run.t_reached, run.x end
    local set = run:set()
    for _ = 1, o.draws do
      local point = draw(s)
      local solution, again = solve(s, point, times)
      if solution then
        total.solutions = total.solutions + 1
        local narrow = set_at(s, set, point)
        for k = 2, #times + 1 do
          for i = 1, s.nx do
            local at = math.min(k, #times)
            local value, set = solution[at][i], k > #times and narrow[i] or sets[k]["x" .. i]
            local off = math.max(set.lo - value, value - set.hi) - 1e-15 * (1 + math.abs(value))
            total.values = total.values + 1
            if off > 0 and off <= doubt(again, at, i, value) then
              total.blurred = total.blurred + 1
            elseif off > 0 or off ~= off then
              worst = math.max(worst, off)
              total.outside = total.outside + 1
              if o.verbose then print(("system %d: x%d at %.17g is %.17g, proved %s"):format(number, i, times[at], value, set)) end
            end
          end
        end
      end
    end
  end
  if o.verbose then
    print(("%4d  %d states, %d data: %s to %g of [%g, %g] %s%s"):format(number, s.nx, s.np, run.status, run.t_reached, s.from,
      s.to, worst > 0 and ("OUTSIDE by %.3g"):format(worst) or "", run.status == "complete" and "" or run.reason))
  end
end

for number = 1, o.systems do check(number) end
session.worst = "ok" -- what could not be proved is no failure here
print(("%d systems, %d complete; %d solutions, %d values: %d outside%s"):format(o.systems, total.complete, total.solutions,
  total.values, total.outside, total.blurred > 0 and (", %d not decided"):format(total.blurred) or ""))
os.exit(total.outside == 0 and 0 or 1)
