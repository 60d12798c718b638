-- float_matrix.lua -- matrices of doubles by rows, { { a, b }, { c, d } }. Nothing is proved of what they give.
local matrix = {}

function matrix.zero(n, m)
  local a = {}
  for i = 1, n do
    a[i] = {}
    for j = 1, m do a[i][j] = 0.0 end
  end
  return a
end

function matrix.identity(n)
  local a = matrix.zero(n, n)
  for i = 1, n do a[i][i] = 1.0 end
  return a
end

-- Of a list of all entries, row by row; and back.
function matrix.rows(n, list)
  local a = {}
  for i = 1, n do a[i] = table.move(list, (i - 1) * n + 1, i * n, 1, {}) end
  return a
end

function matrix.list(a)
  local list = {}
  for _, row in ipairs(a) do table.move(row, 1, #row, #list + 1, list) end
  return list
end

function matrix.product(a, b)
  local c = matrix.zero(#a, #b[1])
  for i, row in ipairs(c) do
    for k, factor in ipairs(a[i]) do
      for j, x in ipairs(b[k]) do row[j] = row[j] + factor * x end
    end
  end
  return c
end

function matrix.transposed(a)
  local t = matrix.zero(#a[1], #a)
  for i, row in ipairs(a) do
    for j, x in ipairs(row) do t[j][i] = x end
  end
  return t
end

-- a^-1 b by elimination with row pivots, and log |det a|; nil: a seems singular. Without b the inverse.
function matrix.solve(a, b)
  local n, m, volume = #a, {}, 0
  b = b or matrix.identity(n)
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
  local x = matrix.zero(n, #b[1])
  for i, row in ipairs(x) do
    for j in ipairs(row) do
      row[j] = m[i][n + j] / m[i][i]
      if not (math.abs(row[j]) < math.huge) then return nil end
    end
  end
  return x, volume
end

return matrix
