-- poincare/attract.lua -- does a return map that is known to lead into its own start set contract there? By enclosures
-- of its derivative over that set, from the variational equations; docs/numerics/events.md, theorem 4.
local core = require "ambit.core"
local fresh = require "ambit.fresh"
local leg = require "ambit.leg"
local once = require "ambit.poincare.once"

local attract = {}

local POWERS = 6 -- of the derivative: up to 2^6

-- The system with the derivatives of its states by the starts of the free ones as states: rows by columns, y[i][j].
local function varied(system, free)
  local n, used = #system.states, fresh.set(system.states)
  local names, units, symbols, rates = {}, {}, {}, {}
  for i, name in ipairs(system.states) do
    names[i], units[i], symbols[i], rates[i] = name, "1", system.symbols[i], core.in_unit(system.rates[i], "1")
  end
  local y, slopes = {}, {}
  for i, name in ipairs(system.states) do
    y[i], slopes[i] = {}, {}
    for k = 1, n do slopes[i][k] = core.in_unit(core.derivative(system.rates[i], system.symbols[k]), "1") end
    for j, of in ipairs(free) do
      names[#names + 1], units[#units + 1] = fresh.name(("%s by %s"):format(name, system.states[of]), used), "1"
      y[i][j] = core.symbol(names[#names], "1")
      symbols[#symbols + 1] = y[i][j]
    end
  end
  for i = 1, n do
    for j in ipairs(free) do
      local sum = core.expression(0)
      for k = 1, n do sum = sum + slopes[i][k] * y[k][j] end
      rates[#rates + 1] = sum
    end
  end
  return leg.system(names, units, symbols, rates)
end

-- The set of x with derivatives 1 and 0.
local function start_of(initial, free)
  local x = table.move(initial, 1, #initial, 1, {})
  for i in ipairs(initial) do
    for _, of in ipairs(free) do x[#x + 1] = core.expression(i == of and 1 or 0) end
  end
  return x
end

-- The derivative of the map, [j][l] of the free states, at all of the set x with derivatives behind the states: what
-- moves along the flow until it is on the section again is taken off.
local function derivative(system, x, free, fixed)
  local n, m, list = #system.states, #free, {}
  local here = table.move(x, 1, n, 1, {})
  local rates = core.substitute(system.rates, system.symbols, here)
  for i, e in ipairs(rates) do rates[i] = core.in_unit(e, "1") end
  local function y(i, l) return core.in_unit(x[n + (i - 1) * m + l], "1") end
  for _, j in ipairs(free) do
    for l = 1, m do list[#list + 1] = y(j, l) - rates[j] / rates[fixed] * y(fixed, l) end
  end
  local matrix, found = {}, core.evaluate { arithmetic = core.default.linear, expressions = list }
  for k, e in ipairs(found) do
    if e:is_empty() or e.partial or not e:is_bounded() then return nil end
    local j = (k - 1) // m + 1
    matrix[j] = matrix[j] or {}
    matrix[j][k - (j - 1) * m] = e
  end
  return matrix
end

local function product(a, b)
  local c = {}
  for i = 1, #a do
    c[i] = {}
    for j = 1, #a do
      local sum = core.interval(0)
      for k = 1, #a do sum = sum + a[i][k] * b[k][j] end
      c[i][j] = sum
    end
  end
  return c
end

-- The largest sum of a row, by magnitude, rounded up.
local function norm(a)
  local most = 0
  for _, row in ipairs(a) do
    local sum = core.interval(0)
    for _, e in ipairs(row) do sum = sum + core.interval(e:mag()) end
    most = math.max(most, sum.hi)
  end
  return most
end

-- A bound of the norm of a power of all such matrices, and the power; the first that is below 1, or the last.
local function contraction(matrix)
  local power, k = matrix, 1
  for _ = 1, POWERS do
    if norm(power) < 1 then break end
    power, k = product(power, power), 2 * k
  end
  return norm(power), k
end

-- map: of poincare, whose orbit is proved; fixed: the state that the section fixes. -> { attracting, derivative,
-- multiplier }, or why nothing is known.
function attract.judge(map, fixed)
  local q, free = map.request, {}
  for i in ipairs(q.system.states) do
    if i ~= fixed then free[#free + 1] = i end
  end
  local good, system = pcall(varied, q.system, free)
  if not good then return nil, "the equations have no derivatives everywhere" end
  local own = setmetatable({ cpu_seconds = 0, step_count = 0, rigorous = true, report = {} }, { __index = q })
  local x, now = start_of(map.initial, free), q.start
  for _ = 1, q.returns do
    local image, why = once(own, system, q.g, x, now, q.times[2])
    if not image then return nil, why end
    x, now = image.x, image.t
  end
  map.cpu_seconds = map.cpu_seconds + own.cpu_seconds
  local matrix = own.rigorous and derivative(q.system, x, free, fixed)
  if not matrix then return nil, "the derivative of the map has no bound" end
  local size, k = contraction(matrix)
  -- a root of a number below 1, with more than its rounding
  local bound = size < math.huge and size ^ (1 / k) * (1 + 1e-12) or math.huge
  local named = {}
  for j, of in ipairs(free) do
    local row = {}
    for l, by in ipairs(free) do row[q.system.states[by]] = matrix[j][l] end
    named[q.system.states[of]] = row
  end
  return { attracting = size < 1, derivative = named, multiplier = bound }
end

return attract
