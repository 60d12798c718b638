-- reduce/report_judge.lua -- rankings held against the exact one: Spearman's correlation of the order in which they put
-- the candidates of a pass. 1: the same order; 0: no relation; -1: the opposite.
local check = require "ambit.check"

local judge = {}

-- 1 for the least value; the mean of their places for equal ones.
local function places(values)
  local order, place = {}, {}
  for i = 1, #values do order[i] = i end
  table.sort(order, function(a, b)
    if values[a] ~= values[b] then return values[a] < values[b] end
    return a < b
  end)
  local from = 1
  while from <= #order do
    local to = from
    while to < #order and values[order[to + 1]] == values[order[from]] do to = to + 1 end
    for k = from, to do place[order[k]] = 0.5 * (from + to) end
    from = to + 1
  end
  return place
end

-- The correlation of the places of two lists of numbers, or nil where one of them puts nothing before anything.
function judge.spearman(first, second)
  local a, b, n = places(first), places(second), #first
  local mean, ab, aa, bb = 0.5 * (n + 1), 0, 0, 0
  for i = 1, n do
    ab, aa, bb = ab + (a[i] - mean) * (b[i] - mean), aa + (a[i] - mean) ^ 2, bb + (b[i] - mean) ^ 2
  end
  if aa == 0 or bb == 0 then return nil end
  return math.max(-1, math.min(1, ab / math.sqrt(aa * bb)))
end

-- Candidates that both lists know: NaN stands for one that could not be ranked.
local function common(first, second)
  local a, b = {}, {}
  for i, x in ipairs(first) do
    if x == x and second[i] and second[i] == second[i] then a[#a + 1], b[#b + 1] = x, second[i] end
  end
  return a, b
end

-- Was the exact ranking asked for?
function judge.is_possible(self)
  for _, pass in ipairs(self.rankings) do
    if pass.exact then return true end
  end
  return false
end

-- self.rankings: { { pass =, residual = { ... }, exact = { ... } }, ... }, a value for each candidate of the pass
function judge.of(self)
  if not judge.is_possible(self) then
    check.fail 'judge: there is no exact ranking to judge by; ask for it: ranking = { "residual", "exact" }'
  end
  local rows = {}
  for _, pass in ipairs(self.rankings) do
    for _, name in ipairs(pass.exact and check.sorted(pass) or {}) do
      if type(pass[name]) == "table" and name ~= "exact" then
        local a, b = common(pass[name], pass.exact)
        rows[#rows + 1] = { pass = pass.pass, ranking = name, candidates = #a, correlation = judge.spearman(a, b) }
      end
    end
  end
  return rows
end

return judge
