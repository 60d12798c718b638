-- forever/weight.lua -- candidates of W, for sets in which z'W z decays (framework/verbs/forever/decay.lua): constant
-- matrices from Lyapunov's equation, and for mechanisms the energy with a cross term.
local core = require "ambit.core"
local decay = require "ambit.forever.decay"
local metric = require "ambit.forever.metric"

local weight = {}

local CROSS = { 0.05, 0.1, 0.2, 0.35, 0.5, 0.7 } -- of the largest cross term with which the energy decays
local HALVINGS = 40

-- Constant W = P for x' = f: g = P f.
local function constant(system, rates, p)
  local n, image = #rates, {}
  for i = 1, n do
    image[i] = core.expression(0)
    for j = 1, n do image[i] = image[i] + p[(i - 1) * n + j] * rates[j] end
  end
  return decay.new(system, p, image)
end

-- { { decay, frame } } of an ode, or nil and why there is none
function weight.of_ode(system, centre, scales)
  local rates, n = {}, #system.states
  for i, rate in ipairs(system.rates) do rates[i] = decay.bare(rate) end
  local plain, why = decay.new(system, {}, rates)
  if not plain then return nil, "it has no Jacobian: " .. why end
  local a = plain:values(plain.jacobian, centre)
  local list = a and metric.candidates(n, a, scales)
  if not list then return nil, "at the middle of the data the linearised system is not proved to decay" end
  local found = {}
  for _, p in ipairs(list) do
    local one = constant(system, rates, p)
    local f, inverse = metric.frame(n, p, metric.multiply(n, p, a))
    if f then found[#found + 1] = { decay = one, frame = one:frame(f, inverse) } end
  end
  return found
end

-- -- mechanisms: W = [K, e M; e M, M], W f = [K v + e h; e M v + h], M the masses, h the forces, e a small rate

-- Places of coordinates and their speeds among the states: { q }, { v }; nil: speeds are not the rates of coordinates.
local function places(system)
  local place, q, v = {}, {}, {}
  for i, symbol in ipairs(system.symbols) do place[system.states[i]] = { i, symbol } end
  local coordinates, speeds = core.coordinates(system.mechanism.handle), core.speeds(system.mechanism.handle)
  if #coordinates ~= #speeds or 2 * #speeds ~= #system.states then return nil end
  for k, speed in ipairs(speeds) do
    local c, s = place[coordinates[k].name], place[speed.name]
    if not c or not s or system.rates[c[1]] ~= s[2] then return nil end
    q[k], v[k] = c[1], s[1]
  end
  return q, v
end

local function rows(n, zero)
  local list = {}
  for k = 1, n * n do list[k] = zero end
  return list
end

-- Is the system the one that the mechanism describes as it is now? It may have got parts since, or data of the system
-- may have been replaced.
local function is_current(system)
  local m = system.mechanism
  return rawget(m, "cached") == system and rawget(m, "cached_parts") == core.part_count(m.handle)
end

-- Do the masses depend on nothing but coordinates and constant data? Laws of force may put in what varies or a speed.
local function is_of_coordinates(system, mass, q)
  for _, leaf in ipairs(core.leaves(mass)) do
    local known = leaf.kind == "unknown"
    for _, place in ipairs(q) do known = known or leaf.expression == system.symbols[place] end
    if not known then return false end
  end
  return true
end

local function parts_of(system)
  local q, v = places(system)
  if not q or not is_current(system) then return nil end
  local handle = system.mechanism.handle
  local m, mass = core.motion(handle)
  if not is_of_coordinates(system, mass, q) then return nil end
  local force = core.force(handle)
  local parts = { q = q, v = v, m = m, mass = {}, force = {}, moving = {} }
  for i, h in ipairs(force) do parts.force[i] = decay.bare(h) end
  for k, e in ipairs(mass) do
    local sum = core.expression(0)
    for i = 1, m do
      sum = sum + decay.bare(core.derivative(e, system.symbols[q[i]])) * decay.bare(system.symbols[v[i]])
    end
    parts.mass[k], parts.moving[k] = decay.bare(e), sum
  end
  return parts
end

-- The energy with stiffness k (numbers, by rows) and cross term e.
local function energy(system, parts, k, e)
  local n, m = #system.states, parts.m
  local w, moving, image = rows(n, core.expression(0)), rows(n, core.expression(0)), {}
  local function at(list, i, j, value) list[(i - 1) * n + j] = core.expression(value) end
  for i = 1, m do
    local qi, vi = parts.q[i], parts.v[i]
    local pulled, carried = e * parts.force[i], parts.force[i]
    for j = 1, m do
      local qj, vj, of = parts.q[j], parts.v[j], (i - 1) * m + j
      local speed, mass, change = decay.bare(system.symbols[vj]), parts.mass[of], parts.moving[of]
      at(w, qi, qj, k[of])
      at(w, vi, vj, mass)
      at(w, qi, vj, e * mass)
      at(w, vi, qj, e * mass)
      at(moving, vi, vj, change)
      at(moving, qi, vj, e * change)
      at(moving, vi, qj, e * change)
      if k[of] ~= 0 then pulled = pulled + k[of] * speed end
      carried = carried + e * mass * speed
    end
    image[qi], image[vi] = pulled, carried
  end
  return decay.new(system, w, image, moving)
end

-- With its frame at the middle of the data; nil: there it does not decay.
local function framed(system, parts, k, e, centre)
  local one = energy(system, parts, k, e)
  local w, jacobian = one:values(one.weight, centre), one:values(one.jacobian, centre)
  local f, inverse = nil, nil
  if w and jacobian then f, inverse = metric.frame(one.n, w, jacobian) end
  return f and { decay = one, f = f, inverse = inverse }
end

-- The stiffness about the centre: minus the symmetric part of dh/dq.
local function stiffness(system, parts, centre)
  local list, m = {}, parts.m
  local plain = decay.new(system, {}, parts.force)
  local slope = plain and plain:values(plain.jacobian, centre)
  if not slope then return nil end
  local n = #system.states
  for i = 1, m do
    for j = 1, m do
      list[(i - 1) * m + j] = -0.5 * (slope[(i - 1) * n + parts.q[j]] + slope[(j - 1) * n + parts.q[i]])
    end
  end
  return list
end

local function largest_cross(system, parts, k, centre)
  local lo, hi = 0, 1
  while hi < 1e12 and framed(system, parts, k, hi, centre) do hi = 2 * hi end
  for _ = 1, HALVINGS do
    local e = 0.5 * (lo + hi)
    if framed(system, parts, k, e, centre) then lo = e else hi = e end
    if lo > 0 and hi - lo < 0.05 * hi then break end
  end
  return lo > 0 and lo
end

-- { { decay, frame } } of a mechanism by its energy; nil: that does not decay
function weight.of_mechanism(system, centre)
  local good, parts = pcall(parts_of, system)
  local k = good and parts and stiffness(system, parts, centre)
  local most = k and largest_cross(system, parts, k, centre)
  if not most then return nil end
  local found = {}
  for _, share in ipairs(CROSS) do
    local one = framed(system, parts, k, share * most, centre)
    if one then found[#found + 1] = { decay = one.decay, frame = one.decay:frame(one.f, one.inverse) } end
  end
  return found
end

return weight
