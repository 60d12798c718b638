-- roots/slope.lua -- how a proved root moves with an uncertain datum: root.slope(p) -> { x = dx/dp, ... }, for every
-- value of the data.
--
-- f(x(p), p) = 0 gives df/dx x' = -df/dp (implicit function theorem: df/dx is regular at a proved root). Both matrices
-- are enclosed over the root's box and the data, and so are the solutions.
local check = require "ambit.check"
local core = require "ambit.core"

-- The equations with values put in, without those that are 0 = 0.
local function solved(q)
  local list = {}
  local expressions = table.move(q.expressions, 1, q.leading or #q.expressions, 1, {})
  for _, f in ipairs(core.substitute(expressions, q.leaves, q.values)) do
    if not core.is_constant(f) then list[#list + 1] = f end
  end
  return list
end

local function read_datum(p)
  local leaf = check.kind(p) == "expression" and core.leaves({ p })[1]
  if not leaf or leaf.kind ~= "unknown" or leaf.expression ~= p then
    check.fail("slope: expected an uncertain datum, as ambit.around(1, 0.1) or ambit.between(1, 2) makes it")
  end
  return p
end

-- q: what roots.run was asked; point: enclosures by name -> function(datum)
return function(q, point)
  return function(p)
    read_datum(p)
    local list, n = solved(q), #q.names
    if #list ~= n then check.fail("slope: there are %d equations for %d unknowns", #list, n) end
    local leaves, values, entries, place = {}, {}, {}, {}
    for i, f in ipairs(list) do
      place[i] = rawget(point, q.names[i])
      leaves[i], values[i] = q.symbols[i], core.expression(place[i])
      for _, x in ipairs(q.symbols) do entries[#entries + 1] = core.derivative(f, x) end
    end
    for i, f in ipairs(list) do entries[n * n + i] = -core.derivative(f, p) end
    local smooth = core.are_smooth { equations = list, unknowns = q.symbols, names = q.names, box = place, data = true }
    if not smooth then return nil end -- a jump or a kink, maybe along the data alone
    local found = core.evaluate { expressions = entries, leaves = leaves, values = values }
    for _, x in ipairs(found) do
      if x.partial or not x:is_bounded() then return nil end
    end
    local x = core.solve(n, table.move(found, 1, n * n, 1, {}), table.move(found, n * n + 1, n * n + n, 1, {}))
    if not x then return nil end -- data too uncertain
    local slopes = {}
    for i, name in ipairs(q.names) do slopes[name] = x[i] end
    return slopes
  end
end
