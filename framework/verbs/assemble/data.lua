-- assemble/data.lua -- how an assembled configuration depends on the uncertain data, so that a run which starts from it
-- knows what the states and the data have in common.
--
-- For each p one root x(p) of f(x, p) = 0 is proved to lie in a box. With a root and dx/dp in numbers at the middle of
-- the data, y(p) = L(p) - C f(L(p), p) is one step of Newton's method from L, the tangent: as an expression of the data
-- it is exact up to terms of the third degree. What is missing is enclosed: f(y) - f(x) = J (y - x) with J in the
-- enclosure of df/dx over a box that holds both, so x - y solves J e = -f(y(p), p), whatever p is; f(y(p), p) is
-- bounded by Taylor models. So x_i(p) = y_i(p) + e_i with e_i in a narrow range. docs/numerics/loops.md
local core = require "ambit.core"
local option = require "ambit.option"

local STEPS = 20    -- of Newton's method in numbers
local GAIN = 0.5    -- more of its box than this left over: nothing is gained

local data = {}

-- -- in numbers; they prove nothing

local function numbers(expressions, leaves, at)
  local values, out = {}, {}
  for i, x in ipairs(at) do values[i] = core.expression(x) end
  local found = core.evaluate { arithmetic = core.default.points, expressions = expressions,
    leaves = leaves, values = values }
  for i, x in ipairs(found) do
    out[i] = x:mid()
    if x.partial or not (math.abs(out[i]) < math.huge) then return nil end
  end
  return out
end

-- y := A x, rows of A
local function times(rows, x)
  local y = {}
  for i, row in ipairs(rows) do
    y[i] = 0
    for k, a in ipairs(row) do y[i] = y[i] + a * x[k] end
  end
  return y
end

-- p: { list, symbols, unknowns, jacobian } -> x, C at the middle of the data; nil: none was found
local function solve_in_the_middle(p, start)
  local matrix = require "ambit.float_matrix"
  local n, x, leaves, c = #p.list, table.move(start, 1, #start, 1, {}), table.move(p.symbols, 1, #p.symbols, 1, {}), nil
  table.move(p.unknowns, 1, #p.unknowns, n + 1, leaves)
  for _ = 1, STEPS do
    local at = table.move(p.middle, 1, #p.middle, n + 1, table.move(x, 1, n, 1, {}))
    local f, a = numbers(p.list, leaves, at), numbers(p.jacobian, leaves, at)
    c = f and a and matrix.solve(matrix.rows(n, a))
    if not c then return nil end
    local step, longest = times(c, f), 0
    for i = 1, n do
      x[i] = x[i] - step[i]
      longest = math.max(longest, math.abs(step[i]) / (1 + math.abs(x[i])))
    end
    if longest < 1e-14 then return x, c, at, leaves end
    if not (longest < 1e3) then return nil end
  end
  return x, c, table.move(p.middle, 1, #p.middle, n + 1, table.move(x, 1, n, 1, {})), leaves
end

-- -- the expressions

-- The tangent L(p).
local function tangent(p, x, c, at, leaves)
  local n, slopes, lines = #p.list, {}, {}
  for j, u in ipairs(p.unknowns) do
    local list = {}
    for k, f in ipairs(p.list) do list[k] = core.derivative(f, u) end
    local by = numbers(list, leaves, at)
    if not by then return nil end
    slopes[j] = times(c, by)
  end
  for i = 1, n do
    lines[i] = core.expression(x[i])
    for j, u in ipairs(p.unknowns) do
      if slopes[j][i] ~= 0 then lines[i] = lines[i] - slopes[j][i] * (u - p.middle[j]) end
    end
  end
  return lines
end

local function newton_step(p, lines, c)
  local f, y = core.substitute(p.list, p.symbols, lines), {}
  for i, line in ipairs(lines) do
    y[i] = line
    for k, a in ipairs(c[i]) do
      if a ~= 0 then y[i] = y[i] - a * f[k] end
    end
  end
  return y
end

-- e in x = y + e; nil: not bounded, or not narrow enough to be worth it. box: enclosures of x.
local function enclose_rest(p, y, box)
  local name, options = option.arithmetic({ core.default.polynomials, order = 2 }, "assemble")
  local n, both, values = #y, table.move(y, 1, #y, 1, {}), {}
  table.move(core.substitute(p.list, p.symbols, y), 1, n, n + 1, both)
  local found = core.evaluate { arithmetic = name, options = options, expressions = both }
  local ranges, defects = {}, {}
  for i = 1, n do
    ranges[i], defects[i] = found[i]:hull(box[i]), -found[n + i]
    if found[i].partial or defects[i].partial or not defects[i]:is_bounded() or not ranges[i]:is_bounded() then
      return nil
    end
    values[i] = core.expression(ranges[i])
  end
  if not core.are_smooth { equations = p.list, unknowns = p.symbols, names = p.names, box = ranges } then return nil end
  local entries = core.evaluate { expressions = p.jacobian, leaves = p.symbols, values = values }
  for _, x in ipairs(entries) do
    if x.partial or not x:is_bounded() then return nil end
  end
  local rest = core.solve(n, entries, defects)
  for i, e in ipairs(rest or {}) do
    if not (e:width() <= GAIN * box[i]:width()) and box[i]:width() > 1e-12 * (1 + box[i]:mag()) then return nil end
  end
  return rest
end

-- list: the equations with values put in, in the symbols called names; box: enclosures of their root, by place ->
-- { expression } of the data and of fresh unknowns, in which the root lies for every value of the data; nil: the box is
-- all that is known.
function data.expressions(list, symbols, names, box)
  local p = { list = {}, symbols = symbols, names = names, unknowns = {}, middle = {}, jacobian = {} }
  for _, f in ipairs(list) do
    if not core.is_constant(f) then p.list[#p.list + 1] = f end
  end
  if #p.list ~= #symbols or core.jumps(p.list) then return nil end
  for _, leaf in ipairs(core.leaves(p.list)) do
    if leaf.kind == "unknown" then
      p.unknowns[#p.unknowns + 1] = leaf.expression
    end
  end
  if #p.unknowns == 0 then return nil end
  for j, x in ipairs(core.evaluate { expressions = p.unknowns }) do p.middle[j] = x:mid() end
  for _, f in ipairs(p.list) do
    for _, x in ipairs(symbols) do
      local good, d = pcall(core.derivative, f, x)
      if not good then return nil end
      p.jacobian[#p.jacobian + 1] = d
    end
    for _, u in ipairs(p.unknowns) do
      if not pcall(core.derivative, f, u) then return nil end
    end
  end
  local start = {}
  for i, x in ipairs(box) do start[i] = x:mid() end
  local x, c, at, leaves = solve_in_the_middle(p, start)
  local lines = x and tangent(p, x, c, at, leaves)
  if not lines then return nil end
  local y = newton_step(p, lines, c)
  local rest = enclose_rest(p, y, box)
  if not rest then return nil end
  for i, e in ipairs(rest) do y[i] = y[i] + core.expression(e) end
  return y
end

-- -- what becomes of it

-- [enclosure] = { assembly, name }: enclosures of configurations that were handed out
local handed = setmetatable({}, { __mode = "k" })

-- assembly: { mechanism, time (an enclosure, or nil: no matter), of = function() -> { name = expression } or nil }
function data.hand_out(assembly, configuration)
  assembly.names = {}
  for name, x in pairs(configuration) do
    handed[x] = { assembly = assembly, name = name }
    assembly.names[#assembly.names + 1] = name
  end
end

-- The assembly all of whose coordinates are among the initial values as it handed them out; nil: there is none.
local function assembly_of(values, system, times)
  for _, x in pairs(values) do
    local assembly = handed[x] and handed[x].assembly
    if assembly then
      if assembly.mechanism ~= system.mechanism or system.replaced then return nil end
      local t = assembly.time
      if t and (times.shift or times.start or not (t.lo == times[1] and t.hi == times[1])) then return nil end
      for _, name in ipairs(assembly.names) do
        local own = handed[values[name]]
        if not own or own.assembly ~= assembly or own.name ~= name then return nil end
      end
      return assembly
    end
  end
  return nil
end

-- initial [i], expressions, with coordinates as expressions of the data where all of them are, untouched, of one
-- assembly of the same mechanism with its own data. given: initial values as they were written.
function data.correlate(initial, given, system, times)
  if not system.mechanism then return initial end
  local values = {}
  for i, name in ipairs(system.states) do
    values[name] = given[name]
    if values[name] == nil then values[name] = given[i] end
  end
  local assembly = assembly_of(values, system, times)
  local of = assembly and assembly.of()
  if not of then return initial end
  local list = {}
  for i, name in ipairs(system.states) do
    list[i] = of[name] or initial[i]
    if of[name] then core.name_data({ list[i] }, "initial " .. name) end
  end
  return list
end

return data
