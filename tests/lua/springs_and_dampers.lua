-- springs_and_dampers.lua -- ambit run tests/lua/springs_and_dampers.lua [SYSTEMS [FIRST]]: can stiff follow them all?
--
-- Chains of 1 to 3 masses between springs of 1 to 1e8 N/m per kg and dampers of ratio .01 to 100, among them critical
-- ones, whose rates are double, from rest or displaced, under a force that begins smoothly, 1 - cos t. stiff must reach
-- the end, where it may not contradict lohner, and a single mass whose start is forgotten must be where
-- x = 1/k - Re(e^(i t) / (k - 1 + i c)) is.
local ambit = require "ambit"
local systems, first = tonumber(arg[1] or 100), tonumber(arg[2] or 1)
local NARROW = 1e-6 -- of the displacement under a constant load of 1
local FORGOTTEN = 60 -- e-folds

local state

local function random(n) -- 1 .. n
  state = state * 6364136223846793005 + 1442695040888963407
  return (state >> 33) % n + 1
end

local function real(lo, hi) return lo + (hi - lo) * random(1 << 20) / (1 << 20) end

local function make()
  local s = { n = random(3), k = 10 ^ real(0, 8), span = real(0.5, 3) }
  local ratio = ({ 1, 10 ^ real(-2, 2), 10 ^ real(-0.1, 0.1) })[random(3)]
  s.c = 2 * ratio * math.sqrt(s.k)
  s.start = random(2) == 1 and 0 or real(-1, 1)
  return s
end

local function run(s, solver)
  local states, initial = {}, {}
  for i = 1, s.n do
    states[i], states[s.n + i] = "x" .. i, "v" .. i
    initial["x" .. i], initial["v" .. i] = s.start, 0
  end
  local system = ambit.ode { states = states, equations = function(z, _, t)
    local rates = {}
    local function push(i) -- of the link below mass i
      local x, v = z["x" .. i], z["v" .. i]
      if i > 1 then x, v = x - z["x" .. i - 1], v - z["v" .. i - 1] end
      return s.k * x + s.c * v
    end
    for i = 1, s.n do
      local force = -push(i)
      if i < s.n then force = force + push(i + 1) else force = force + (1 - ambit.cos(t)) end
      rates["x" .. i], rates["v" .. i] = z["v" .. i], force
    end
    return rates
  end }
  return ambit.simulate { system, initial = initial, t = { 0, s.span }, solver = solver }
end

local function exact(s)
  local re, im, t = s.k - 1, s.c, s.span
  return 1 / s.k - (math.cos(t) * re + math.sin(t) * im) / (re * re + im * im)
end

local function judge(s)
  local r = run(s, "stiff")
  if r.status ~= "complete" then return r.reason end
  local q = run(s, "lohner")
  for i = 1, s.n do
    local name = "x" .. i
    local a = r.x[name]
    if a:width() > NARROW * (s.n / s.k + math.abs(s.start)) then return ("%s is %.3g wide"):format(name, a:width()) end
    if q.status == "complete" and (a.lo > q.x[name].hi or a.hi < q.x[name].lo) then
      return ("%s is in [%.17g, %.17g] by stiff, in [%.17g, %.17g] by lohner"):format(name, a.lo, a.hi, q.x[name].lo,
        q.x[name].hi)
    end
  end
  local slow = s.c * s.c < 4 * s.k and s.c / 2 or 2 * s.k / (s.c + math.sqrt(s.c * s.c - 4 * s.k))
  if s.n == 1 and slow * s.span > FORGOTTEN then
    local x, noise = exact(s), 1e-12 / s.k
    if x < r.x.x1.lo - noise or x > r.x.x1.hi + noise then
      return ("x1 is in [%.17g, %.17g] and must be %.17g"):format(r.x.x1.lo, r.x.x1.hi, x)
    end
  end
end

local failed = 0
for number = first, first + systems - 1 do
  state = number
  for _ = 1, 3 do random(2) end
  local s = make()
  local problem = judge(s)
  if problem then
    failed = failed + 1
    print(("system %d, %d masses, k = %.3g, c = %.3g, from %.3g, to %.3g: %s"):format(number, s.n, s.k, s.c, s.start,
      s.span, problem))
  end
end
print(("%d springs and dampers, %d failed"):format(systems, failed))
os.exit(failed == 0)
