-- riccati.lua -- gains of a linear-quadratic controller in doubles: K = R^-1 B' X, A'X + X A - X B R^-1 B' X + Q = 0.
--
-- X spans the stable subspace of the Hamiltonian matrix, found by its sign, Z -> (Z / c + c Z^-1) / 2 [Roberts 1980;
-- Byers 1987]. Nothing is proved about K: any gains make a controller, and a run encloses what this one does.
local matrix = require "ambit.float_matrix"

local riccati = {}

local MOST, CLOSE = 60, 1e-12

local function sign(z)
  local n = #z
  for _ = 1, MOST do
    local inverse, volume = matrix.solve(z)
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
  local n, h, turned = #A, matrix.zero(2 * #A, 2 * #A), matrix.zero(#r, #A) -- turned: R^-1 B'
  for k in ipairs(r) do
    for i = 1, n do turned[k][i] = B[i][k] / r[k] end
  end
  local spread = matrix.product(B, turned)
  for i = 1, n do
    for j = 1, n do h[i][j], h[i][n + j], h[n + i][n + j] = A[i][j], -spread[i][j], -A[j][i] end
    h[n + i][i] = -q[i]
  end
  local w = sign(h)
  if not w then return nil end
  -- [W12; W22 + I] X = -[W11 + I; W21], by least squares
  local left, right = matrix.zero(2 * n, n), matrix.zero(2 * n, n)
  for i = 1, 2 * n do
    for j = 1, n do
      left[i][j] = w[i][n + j] + (i == n + j and 1 or 0)
      right[i][j] = -w[i][j] - (i == j and 1 or 0)
    end
  end
  local back = matrix.transposed(left)
  local x = matrix.solve(matrix.product(back, left), matrix.product(back, right))
  return x and matrix.product(turned, x)
end

return riccati
