-- units_of_systems.lua -- ambit run tests/lua/units_of_systems.lua [SYSTEMS [FIRST [SOLVER ...]]]: do units matter?
--
-- Random nonlinear systems of 1 to 4 states with data, some at rest, some about zero, some stiff: x_i' = sum a_ij x_j +
-- sum b_ij x_j x_(j+1) + c_i sin(w_i x_1) + f_i cos(t). Each is run as it is and with every state and time in units
-- that are powers of two between 2^-20 and 2^20, about 1e-6 to 1e6, so that data are the same. The default run and that
-- of each solver must take as many steps, but for 2 %, to as wide states, but for .1 %; stiff and valencia, whose
-- steps follow errors that are next to rounding, 10 % and 1 %.
local ambit = require "ambit"
local systems, first = tonumber(arg[1] or 300), tonumber(arg[2] or 1)
local solvers = { table.unpack(arg, 3) }
if #solvers == 0 then solvers = { "", "lohner", "taylor_model", "zonotope", "stiff", "valencia" } end

local STEPS, WIDTH = { stiff = 0.1, valencia = 0.1 }, { stiff = 0.01, valencia = 0.01 }
local ROUNDING = 1e-10 -- of a state's size

local state

local function random(n) -- 1 .. n
  state = state * 6364136223846793005 + 1442695040888963407
  return (state >> 33) % n + 1
end

local function real(lo, hi) return lo + (hi - lo) * random(1 << 20) / (1 << 20) end

local function share(p) return real(0, 1) < p end

local function make()
  local n = random(4)
  local s = { n = n, a = {}, b = {}, c = {}, w = {}, f = {}, lo = {}, hi = {}, span = real(0.2, 1.5) }
  local fast = share(0.2) and 1e3 or 1 -- some are stiff
  for i = 1, n do
    s.a[i], s.b[i] = {}, {}
    for j = 1, n do
      s.a[i][j] = share(0.3) and 0 or real(-2, 2)
      s.b[i][j] = share(0.6) and 0 or real(-0.5, 0.5)
    end
    s.a[i][i] = s.a[i][i] - (i == 1 and fast or 1)
    s.c[i], s.w[i], s.f[i] = share(0.5) and 0 or real(-1, 1), real(0.5, 2), share(0.7) and 0 or real(-1, 1)
    local middle, radius = share(0.4) and 0 or real(-2, 2), share(0.4) and 0 or real(0, 1) * 10 ^ -random(4)
    s.lo[i], s.hi[i] = middle - radius, middle + radius
  end
  return s
end

local function name(i) return "x" .. i end

-- one of the old units is unit[i], or `second`, of the new ones
local function run(s, unit, second, solver)
  local states, initial = {}, {}
  for i = 1, s.n do
    states[i] = name(i)
    initial[name(i)] = s.lo[i] == s.hi[i] and s.lo[i] * unit[i] or ambit.between(s.lo[i] * unit[i], s.hi[i] * unit[i])
  end
  local system = ambit.ode { states = states, equations = function(x, _, t)
    local rates = {}
    for i = 1, s.n do
      local per = unit[i] / second
      local sum = s.f[i] ~= 0 and s.f[i] * per * ambit.cos(t / second) or 0 * x[name(i)]
      for j = 1, s.n do
        local k = j % s.n + 1
        if s.a[i][j] ~= 0 then sum = sum + s.a[i][j] * per / unit[j] * x[name(j)] end
        if s.b[i][j] ~= 0 then sum = sum + s.b[i][j] * per / unit[j] / unit[k] * (x[name(j)] * x[name(k)]) end
      end
      if s.c[i] ~= 0 then sum = sum + s.c[i] * per * ambit.sin(s.w[i] / unit[1] * x.x1) end
      rates[name(i)] = sum
    end
    return rates
  end }
  return ambit.simulate { system, initial = initial, t = { 0, s.span * second }, solver = solver ~= "" and solver or nil }
end

-- number of steps, widths at the end
local function profile(r, s, unit)
  local steps, width = 0, {}
  for _ in r:steps() do steps = steps + 1 end
  for i = 1, s.n do width[i] = steps > 0 and r.x[name(i)]:width() / unit[i] or 0 end
  return steps, width
end

local function differ(a, b, share) return math.abs(a - b) > share * math.max(math.abs(a), math.abs(b)) end

local function compare(s, r, q, unit)
  if r.solver ~= q.solver then return ("%s is chosen, in other units %s"):format(r.solver, q.solver) end
  if r.status ~= q.status then return ("%s, in other units %s: %s"):format(r.status, q.status, r.reason or q.reason) end
  local one = {}
  for i = 1, s.n do one[i] = 1 end
  local steps, width = profile(r, s, one)
  local others, widths = profile(q, s, unit)
  if math.abs(steps - others) > 2 and differ(steps, others, STEPS[r.solver] or 0.02) then
    return ("%d steps, in other units %d"):format(steps, others)
  end
  if r.status ~= "complete" then return end
  for i = 1, s.n do
    local size = math.max(math.abs(r.x[name(i)].lo), math.abs(r.x[name(i)].hi))
    if differ(width[i], widths[i], WIDTH[r.solver] or 1e-3) and math.abs(width[i] - widths[i]) > ROUNDING * size + 1e-250 then
      return ("x%d is %.6g wide, in other units %.6g"):format(i, width[i], widths[i])
    end
  end
end

local failed, unable = {}, {}
for number = first, first + systems - 1 do
  state = number
  for _ = 1, 3 do random(2) end
  local s = make()
  local one, other = {}, {}
  for i = 1, s.n do one[i], other[i] = 1, 2.0 ^ (random(41) - 21) end
  local second = 2.0 ^ (random(41) - 21)
  for _, solver in ipairs(solvers) do
    local r, q = run(s, one, 1, solver), run(s, other, second, solver)
    local problem = compare(s, r, q, other)
    if r.status ~= "complete" then unable[solver] = (unable[solver] or 0) + 1 end
    if problem then
      failed[solver] = (failed[solver] or 0) + 1
      print(("system %d, %s: %s"):format(number, solver == "" and "default" or solver, problem))
    end
  end
end
local total = 0
for _, solver in ipairs(solvers) do
  total = total + (failed[solver] or 0)
  print(("%s: %d of %d depend on units, %d unable"):format(solver == "" and "default" or solver, failed[solver] or 0,
    systems, unable[solver] or 0))
end
os.exit(total == 0)
