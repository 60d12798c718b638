-- riccati.lua -- gains of a linear-quadratic controller in doubles: K = R^-1 B' X, A'X + X A - X B R^-1 B' X + Q = 0.
--
-- X spans the stable subspace of the Hamiltonian matrix, found by its sign, Z -> (Z / c + c Z^-1) / 2 [Roberts 1980;
-- Byers 1987]. Nothing is proved about K: any gains make a controller, and a run encloses what this one does.
local riccati = {}

local MOST, CLOSE = 60, 1e-12

local function zero(n, m)
  local a = {}
  for i = 1, n do
    a[i] = {}
    for j = 1, m do a[i][j] = 0 end
  end
  return a
end

local function product(a, b)
  local c = zero(#a, #b[1])
  for i = 1, #a do
    for k = 1, #b do
      for j = 1, #b[1] do c[i][j] = c[i][j] + a[i][k] * b[k][j] end
    end
  end
  return c
end

local function transposed(a)
  local t = zero(#a[1], #a)
  for i, row in ipairs(a) do
    for j, x in ipairs(row) do t[j][i] = x end
  end
  return t
end

-- a^-1 b by elimination with pivots, and log |det a|; nil: singular
local function solve(a, b)
  local n, m, volume = #a, {}, 0
  for i = 1, n do m[i] = table.move(b[i], 1, #b[i], n + 1, table.move(a[i], 1, n, 1, {})) end
  for k = 1, n do
    local p = k
    for i = k + 1, n do
      if math.abs(m[i][k]) > math.abs(m[p][k]) then p = i end
    end
    m[k], m[p] = m[p], m[k]
    local pivot = m[k][k]
    if not (math.abs(pivot) > 0 and math.abs(pivot) < math.huge) then return nil end
    volume = volume + math.log(math.abs(pivot))
    for i = 1, n do
      local factor = i ~= k and m[i][k] / pivot or 0
      if factor ~= 0 then
        for j = k, #m[i] do m[i][j] = m[i][j] - factor * m[k][j] end
      end
    end
  end
  local x = {}
  for i = 1, n do
    x[i] = {}
    for j = 1, #b[1] do x[i][j] = m[i][n + j] / m[i][i] end
  end
  return x, volume
end

local function identity(n)
  local a = zero(n, n)
  for i = 1, n do a[i][i] = 1 end
  return a
end

local function sign(z)
  local n, one = #z, identity(#z)
  for _ = 1, MOST do
    local inverse, volume = solve(z, one)
    if not inverse then return nil end
    local c, change, size = math.exp(volume / n), 0, 0
    for i = 1, n do
      for j = 1, n do
        local x = 0.5 * (z[i][j] / c + c * inverse[i][j])
        change, size = change + math.abs(x - z[i][j]), size + math.abs(x)
        z[i][j] = x
      end
    end
    if change <= CLOSE * size then return z end
    if change ~= change then return nil end
  end
  return nil
end

-- A [n][n], B [n][m], q [n] and r [m] the diagonals of Q and R, r > 0 -> K [m][n], or nil: no gains make it stable.
function riccati.gains(A, B, q, r)
  local n, h, turned = #A, zero(2 * #A, 2 * #A), zero(#r, #A) -- turned: R^-1 B'
  for k in ipairs(r) do
    for i = 1, n do turned[k][i] = B[i][k] / r[k] end
  end
  local spread = product(B, turned)
  for i = 1, n do
    for j = 1, n do h[i][j], h[i][n + j], h[n + i][n + j] = A[i][j], -spread[i][j], -A[j][i] end
    h[n + i][i] = -q[i]
  end
  local w = sign(h)
  if not w then return nil end
  -- [W12; W22 + I] X = -[W11 + I; W21], by least squares
  local left, right = zero(2 * n, n), zero(2 * n, n)
  for i = 1, 2 * n do
    for j = 1, n do
      left[i][j] = w[i][n + j] + (i == n + j and 1 or 0)
      right[i][j] = -w[i][j] - (i == j and 1 or 0)
    end
  end
  local back = transposed(left)
  local x = solve(product(back, left), product(back, right))
  return x and product(turned, x)
end

return riccati
