-- linear_systems.lua -- ambit run tests/lua/linear_systems.lua [SYSTEMS [FIRST]]: is any linear system too hard?
--
-- x' = A x of 1 to 5 states from a box, about zero or not, some states known exactly, some zero and at rest; saddles,
-- oscillators, decays of 50 e-folds and growth as much; t from 0, -3 or 1e9 s. The set at the end has the widths
-- |e^(A t)| (hi - lo), and the default run must end there within 1.05 of them, or of what lohner lets a run add to a
-- set while it was larger. Again with each state, and time, in units that are 2^-20 to 2^20 as large.
local ambit = require "ambit"
local systems, first = tonumber(arg[1] or 1000), tonumber(arg[2] or 1)
local EXCESS, ROUNDING = 1.05, 1e-12 -- of the true width; of the largest that the state could be
local LOSS, NOTHING = 2.0 ^ -13, 1e-280 -- of the latter; beside an exact zero

-- -- random choices, the same on every machine

local state

local function random(n) -- 1 .. n
  state = state * 6364136223846793005 + 1442695040888963407
  return (state >> 33) % n + 1
end

local function real(lo, hi) return lo + (hi - lo) * random(1 << 20) / (1 << 20) end

local function share(p) return real(0, 1) < p end

-- -- the true widths

local function product(X, Y)
  local n, Z = #X, {}
  for i = 1, n do
    Z[i] = {}
    for j = 1, n do
      local sum = 0
      for k = 1, n do sum = sum + X[i][k] * Y[k][j] end
      Z[i][j] = sum
    end
  end
  return Z
end

local function matrix(n, entry)
  local A = {}
  for i = 1, n do
    A[i] = {}
    for j = 1, n do A[i][j] = entry(i, j) end
  end
  return A
end

-- e^(A t) by scaling and squaring of 18 terms of its series, to about 1e-12
local function exponential(A, t)
  local n, norm = #A, 0
  for i = 1, n do
    local sum = 0
    for j = 1, n do sum = sum + math.abs(A[i][j] * t) end
    norm = math.max(norm, sum)
  end
  local halvings = norm > 0 and math.max(0, math.ceil(math.log(norm, 2)) + 3) or 0
  local step = matrix(n, function(i, j) return A[i][j] * t / 2 ^ halvings end)
  local E = matrix(n, function(i, j) return i == j and 1 or 0 end)
  local term = E
  for k = 1, 18 do
    local next = product(term, step)
    term = matrix(n, function(i, j) return next[i][j] / k end)
    local sum = E
    E = matrix(n, function(i, j) return sum[i][j] + term[i][j] end)
  end
  for _ = 1, halvings do E = product(E, E) end
  return E
end

-- -- systems

local function oscillators(count) -- coupled, x'' = -k x - c x'
  local n = 2 * count
  return matrix(n, function(i, j)
    if i <= count then return j == i + count and 1 or 0 end
    if j > count then return i == j and -real(0, 1) or 0 end
    return i == j + count and -real(1, 100) or real(-1, 1)
  end)
end

local function full(n, size)
  return matrix(n, function() return share(0.3) and 0 or real(-size, size) end)
end

local function make()
  local kind = random(4)
  local A = kind == 1 and oscillators(random(2)) or full(random(5), kind == 2 and 10 or 1)
  local s = { A = A, from = ({ 0, 0, 0, 1e9, -3 })[random(5)], span = real(0.5, 10), lo = {}, hi = {} }
  if s.from == 1e9 then s.span = math.ceil(s.span) end
  for i = 1, #A do
    local middle, radius = share(0.5) and 0 or real(-5, 5), share(0.3) and 0 or real(0, 1)
    s.lo[i], s.hi[i] = middle - radius, middle + radius
  end
  return s
end

local function name(i) return "x" .. i end

-- in units of which unit[i] and second make one of the old ones
local function run(s, unit, second)
  local states, initial = {}, {}
  for i = 1, #s.A do
    states[i] = name(i)
    initial[name(i)] = s.lo[i] == s.hi[i] and s.lo[i] * unit[i] or ambit.between(s.lo[i] * unit[i], s.hi[i] * unit[i])
  end
  local system = ambit.ode { states = states, equations = function(x)
    local rates = {}
    for i = 1, #s.A do
      local sum = 0 * x[name(i)]
      for j = 1, #s.A do
        if s.A[i][j] ~= 0 then sum = sum + s.A[i][j] * unit[i] / unit[j] / second * x[name(j)] end
      end
      rates[name(i)] = sum
    end
    return rates
  end }
  return ambit.simulate { system, initial = initial, t = { s.from * second, (s.from + s.span) * second } }
end

-- What is wrong with a run, or nil.
local function judge(s, E, r, unit)
  if r.status ~= "complete" then return ("%s: %s"):format(r.status, r.reason) end
  for i = 1, #s.A do
    local width, size = 0, 0
    for j = 1, #s.A do
      width = width + math.abs(E[i][j]) * (s.hi[j] - s.lo[j])
      for k = 1, #s.A do size = size + math.abs(E[i][j] * E[j][k]) * math.max(math.abs(s.lo[k]), math.abs(s.hi[k])) end
      size = size + math.max(math.abs(s.lo[j]), math.abs(s.hi[j]))
    end
    local found = r.x[name(i)]:width() / unit[i]
    if found < width * (1 - 1e-9) - ROUNDING * size then
      return ("x%d is %.17g wide and must be %.17g"):format(i, found, width)
    end
    if found > EXCESS * width + LOSS * size + NOTHING then
      return ("x%d is %.4g wide in place of %.4g, with %s"):format(i, found, width, r.solver)
    end
  end
end

local failed = 0
for number = first, first + systems - 1 do
  state = number
  for _ = 1, 3 do random(2) end
  local s = make()
  local E, one, other = exponential(s.A, s.span), {}, {}
  for i = 1, #s.A do one[i], other[i] = 1, 2.0 ^ (random(41) - 21) end
  local problem = judge(s, E, run(s, one, 1), one)
  if not problem then
    problem = judge(s, E, run(s, other, 2.0 ^ (random(41) - 21)), other)
    problem = problem and "in other units: " .. problem
  end
  if problem then
    failed = failed + 1
    print(("system %d: %s"):format(number, problem))
  end
end
print(("%d linear systems, %d failed"):format(systems, failed))
os.exit(failed == 0)
