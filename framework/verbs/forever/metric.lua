-- forever/metric.lua -- matrices P, by rows and in floats, for which x'P x decays along x' = A x; and frames for them.
--
-- Nothing here is believed: framework/verbs/forever/decay.lua proves what it needs of any matrix.
local core = require "ambit.core"
local matrix = require "ambit.float_matrix"

local metric = {}

local SWEEPS, ROUNDS = 60, 20
local SHIFTS = { 0, 0.5, 0.8, 0.95 } -- of the slowest decay
local FASTEST = 60 -- halvings in the search for the slowest decay

local function at(a, n, i, j) return a[(i - 1) * n + j] end

function metric.multiply(n, a, b) return matrix.list(matrix.product(matrix.rows(n, a), matrix.rows(n, b))) end

function metric.transposed(n, a) return matrix.list(matrix.transposed(matrix.rows(n, a))) end

-- Lower factor L of a = L L', or nil.
local function cholesky(n, a)
  local l = {}
  for i = 1, n do
    for j = 1, n do l[(i - 1) * n + j] = 0.0 end
    for j = 1, i do
      local sum = at(a, n, i, j)
      for k = 1, j - 1 do sum = sum - at(l, n, i, k) * at(l, n, j, k) end
      if i == j and not (sum > 0 and sum < math.huge) then return nil end
      l[(i - 1) * n + j] = i == j and math.sqrt(sum) or sum / at(l, n, j, j)
    end
  end
  return l
end

-- The inverse; nil: singular.
function metric.inverse(n, a)
  local inverse = matrix.solve(matrix.rows(n, a))
  return inverse and matrix.list(inverse)
end

-- One rotation of Jacobi's in the plane (p, q), of s and of the vectors' columns.
local function rotate(n, s, v, p, q)
  local theta = (at(s, n, q, q) - at(s, n, p, p)) / (2 * at(s, n, p, q))
  local t = (theta >= 0 and 1 or -1) / (math.abs(theta) + math.sqrt(theta * theta + 1))
  local c = 1 / math.sqrt(t * t + 1)
  local r = t * c
  for k = 1, n do
    local x, y = at(s, n, k, p), at(s, n, k, q)
    s[(k - 1) * n + p], s[(k - 1) * n + q] = c * x - r * y, r * x + c * y
    x, y = at(v, n, k, p), at(v, n, k, q)
    v[(k - 1) * n + p], v[(k - 1) * n + q] = c * x - r * y, r * x + c * y
  end
  for k = 1, n do
    local x, y = at(s, n, p, k), at(s, n, q, k)
    s[(p - 1) * n + k], s[(q - 1) * n + k] = c * x - r * y, r * x + c * y
  end
end

-- Eigenvectors of a symmetric matrix, as columns.
local function eigenvectors(n, a)
  local s, v = table.move(a, 1, n * n, 1, {}), {}
  for i = 1, n * n do v[i] = 0.0 end
  for i = 1, n do v[(i - 1) * n + i] = 1.0 end
  for _ = 1, SWEEPS do
    local off = 0
    for p = 1, n - 1 do
      for q = p + 1, n do
        if math.abs(at(s, n, p, q)) > 1e-15 * math.sqrt(math.abs(at(s, n, p, p) * at(s, n, q, q))) then
          off = off + 1
          rotate(n, s, v, p, q)
        end
      end
    end
    if off == 0 then break end
  end
  return v
end

-- Scales of the states in which rows and columns of A weigh the same (Osborne).
local function balance(n, a)
  local d = {}
  for i = 1, n do d[i] = 1.0 end
  for _ = 1, ROUNDS do
    for i = 1, n do
      local row, column = 0, 0
      for j = 1, n do
        if j ~= i then
          row, column = row + math.abs(at(a, n, i, j)) * d[j], column + math.abs(at(a, n, j, i)) / d[j]
        end
      end
      if row > 0 and column > 0 then d[i] = math.sqrt(row / column) end
    end
  end
  return d
end

-- F with F'P F = 1 and F'(G + G') F diagonal, and its inverse; nil: P is not definite, or G + G' not negative.
function metric.frame(n, p, g)
  local l = cholesky(n, p)
  local c = l and metric.transposed(n, l)
  local f = c and metric.inverse(n, c)
  if not f then return nil end
  local y = metric.multiply(n, metric.multiply(n, metric.transposed(n, f), g), f)
  local s = {}
  for i = 1, n do
    for j = 1, n do s[(i - 1) * n + j] = -at(y, n, i, j) - at(y, n, j, i) end
  end
  if not cholesky(n, s) then return nil end
  local v = eigenvectors(n, s)
  return metric.multiply(n, f, v), metric.multiply(n, metric.transposed(n, v), c)
end

-- P of Lyapunov's equation for A + shift in the scales d: (A + shift)'P + P(A + shift) = -d^-2; nil: none is definite
local function solve(n, a, d, shift)
  local list = {}
  for i = 1, n do
    for j = 1, n do
      list[(i - 1) * n + j] = core.interval(at(a, n, i, j) * d[j] / d[i] + (i == j and shift or 0))
    end
  end
  local p = core.lyapunov(n, list)
  if not p then return nil end
  for i = 1, n do
    for j = 1, n do p[(i - 1) * n + j] = p[(i - 1) * n + j] / (d[i] * d[j]) end
  end
  return cholesky(n, p) and p
end

-- How fast the slowest part of x' = A x decays, or nil if some does not.
local function slowest(n, a, d)
  if not solve(n, a, d, 0) then return nil end
  local lo, hi = 0, 0
  for i = 1, n do hi = hi - at(a, n, i, i) / n end -- the mean of all real parts
  for _ = 1, FASTEST do
    local shift = 0.5 * lo + 0.5 * hi
    if solve(n, a, d, shift) then lo = shift else hi = shift end
    if hi - lo < 1e-3 * hi then break end
  end
  return lo
end

-- { P, ... }; nil: x' = A x is not stable. scales: of the states, or nil
function metric.candidates(n, a, scales)
  local list = {}
  local rate = slowest(n, a, balance(n, a))
  if not rate then return nil end
  for _, d in ipairs { balance(n, a), scales } do
    for _, share in ipairs(SHIFTS) do list[#list + 1] = solve(n, a, d, share * rate) end
  end
  return list
end

return metric
