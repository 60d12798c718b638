-- forever/decay.lua -- a set about the state of rest c of each of the data in which z'W z, z = x - c, decays along all
-- solutions, so that none leaves.
--
-- W is a symmetric matrix of formulas of states and data, g = W f is known as formulas too, and F is a regular matrix
-- of floats, by which z = F u. If F'(-dg/dx - its transpose - dW/dt) F >= 2 rate F'W F for all x of the ball
-- |u| <= R and all data, then r = sqrt(z'W z) obeys r' <= -rate r + residual (docs/numerics/forever.md). Boxes of
-- states and data are cut where the bounds need it.
local core = require "ambit.core"
local fresh = require "ambit.fresh"
local metric = require "ambit.forever.metric"

local decay = {}

local SLACK = 1e-14 -- relative, of sums of floats: more than their roundings, for the numbers of terms that occur
local RESTS = 8     -- boxes that are tried for the state of rest
local LARGEST = 1e100 -- half width of one
local LOOKS = 8     -- so often the middle of the worst box is tried: if it fails, all does

local methods = {}
methods.__index = methods

local function copy(list) return table.move(list, 1, #list, 1, {}) end

local function bare(e) return core.in_unit(core.expression(e), "1") end

-- Data that are not points, and functions of time of which bounds are known: { expression, lo, hi }.
local function find_data(list)
  local data = {}
  for _, leaf in ipairs(core.leaves(list)) do
    if leaf.kind == "varying" or leaf.kind == "unknown" then data[#data + 1] = leaf end
  end
  return data
end

-- The derivatives of a list by each of the states, by rows; or nil and why there are none.
local function derivatives(list, symbols)
  local found = {}
  for _, e in ipairs(list) do
    for _, x in ipairs(symbols) do
      local good, d = pcall(core.derivative, e, x)
      if not good then return nil, tostring(d):gsub("^[^:]*:%d+: ", "") end
      found[#found + 1] = bare(d)
    end
  end
  return found
end

-- system; weight: W by rows, of numbers or expressions; image: W f; moving: dW/dt by rows, or nil if W is constant. Or
-- nil and why not.
function decay.new(system, weight, image, moving)
  local self = setmetatable({ n = #system.states, system = system, weight = weight, image = image, moving = moving },
    methods)
  self.elsewhere = {} -- states at which dW/dt is taken, apart from those of dg/dx
  local used = fresh.set(system.states)
  for i, name in ipairs(moving and system.states or {}) do
    self.elsewhere[i] = core.symbol(fresh.name(name .. " elsewhere", used), "1")
  end
  if moving then self.moving = core.substitute(moving, system.symbols, self.elsewhere) end
  local why
  self.jacobian, why = derivatives(image, system.symbols)
  if not self.jacobian then return nil, why end
  local all = table.move(image, 1, #image, 1, {})
  if moving then table.move(weight, 1, #weight, #all + 1, all) end
  self.data = find_data(all)
  return self
end

-- -- bounds over boxes of states and data: { lo, hi } of the states, then of the data

local function whole(self, x)
  local box = { lo = {}, hi = {} }
  for i, range in ipairs(x) do box.lo[i], box.hi[i] = range.lo, range.hi end
  for k, leaf in ipairs(self.data) do box.lo[self.n + k], box.hi[self.n + k] = leaf.lo, leaf.hi end
  return box
end

local function middle_of(box)
  local point = { lo = {} }
  for j, lo in ipairs(box.lo) do point.lo[j] = 0.5 * lo + 0.5 * box.hi[j] end
  point.hi = point.lo
  return point
end

-- Enclosures of expressions over a box; nil: one is undefined or unbounded.
-- other: a box for the states at which dW/dt is taken.
function methods:enclose(list, box, arithmetic, other)
  local leaves, values = copy(self.system.symbols), {}
  for _, leaf in ipairs(self.data) do leaves[#leaves + 1] = leaf.expression end
  for j in ipairs(leaves) do values[j] = core.expression(core.interval(box.lo[j], box.hi[j])) end
  for i, symbol in ipairs(other and self.elsewhere or {}) do
    leaves[#leaves + 1], values[#values + 1] = symbol, core.expression(core.interval(other.lo[i], other.hi[i]))
  end
  local found = core.evaluate { arithmetic = arithmetic or core.default.linear, expressions = list, leaves = leaves,
    values = values }
  for _, e in ipairs(found) do
    if e:is_empty() or e.partial or not e:is_bounded() then return nil end
  end
  return found
end

-- Numbers: expressions at the point c, for the middle of the data; nil: not defined.
function methods:values(list, c)
  local x = {}
  for i, value in ipairs(c) do x[i] = core.interval(value) end
  local found = self:enclose(list, middle_of(whole(self, x)), core.default.ranges)
  if not found then return nil end
  for k, e in ipairs(found) do found[k] = e:mid() end
  return found
end

-- a' b c of a matrix of expressions or numbers b with one of floats a = c, by rows.
local function framed(n, f, b)
  local half, list = {}, {}
  for i = 1, n do
    for j = 1, n do
      local sum = core.expression(0)
      for k = 1, n do
        local x, y = b[(i - 1) * n + k], f[(k - 1) * n + j]
        if x ~= 0 and y ~= 0 then sum = sum + x * y end
      end
      half[(i - 1) * n + j] = sum
    end
  end
  for i = 1, n do
    for j = 1, n do
      local sum = core.expression(0)
      for k = 1, n do
        local x = f[(k - 1) * n + i]
        if x ~= 0 then sum = sum + x * half[(k - 1) * n + j] end
      end
      list[(i - 1) * n + j] = sum
    end
  end
  return list
end

-- The upper triangle by rows of b + b'.
local function symmetric(n, b)
  local list = {}
  for i = 1, n do
    for j = i, n do list[#list + 1] = b[(i - 1) * n + j] + b[(j - 1) * n + i] end
  end
  return list
end

-- Of F (by rows, in floats; inverse: roughly its inverse) what is needed again and again.
function methods:frame(f, inverse)
  local n, total = self.n, {}
  for k, e in ipairs(self.jacobian) do total[k] = self.moving and e + 0.5 * self.moving[k] or e end
  local forms = symmetric(n, framed(n, f, total)) -- of -N
  local weights = symmetric(n, framed(n, f, self.weight)) -- of 2 W
  local frame = { f = f, inverse = inverse, count = #forms, reach = {} }
  frame.forms = table.move(weights, 1, #weights, #forms + 1, forms)
  for i = 1, n do
    local sum = 0
    for k = 1, n do sum = sum + f[(i - 1) * n + k] ^ 2 end
    frame.reach[i] = math.sqrt(sum) * (1 + n * SLACK)
  end
  return frame
end

-- Gershgorin: bounds of the eigenvalues of all symmetric matrices of a set, entries [from + 1], ... being the upper
-- triangle.
local function spectrum(n, entries, from)
  local off, lo, hi, k = {}, math.huge, -math.huge, from
  local diagonal = {}
  for i = 1, n do off[i] = 0 end
  for i = 1, n do
    for j = i, n do
      k = k + 1
      if i == j then
        diagonal[i] = entries[k]
      else
        local size = entries[k]:mag()
        off[i], off[j] = off[i] + size, off[j] + size
      end
    end
  end
  for i = 1, n do
    local slack = n * SLACK * (diagonal[i]:mag() + off[i])
    lo, hi = math.min(lo, diagonal[i].lo - off[i] - slack), math.max(hi, diagonal[i].hi + off[i] + slack)
  end
  return lo, hi
end

-- Sets box.decay (least eigenvalue of N in the frame), box.least and box.most (eigenvalues of F'W F) and box.rate.
function methods:look(frame, box, root)
  box.rate, box.least, box.most, box.decay = -math.huge, -math.huge, math.huge, -math.huge
  local found = self:enclose(frame.forms, box, nil, root)
  if not found then return box end
  local _, growth = spectrum(self.n, found, 0)
  local lo, hi = spectrum(self.n, found, frame.count)
  box.least, box.most, box.decay = 0.5 * lo, 0.5 * hi, -growth
  if lo > 0 then box.rate = -growth / (growth < 0 and hi or lo) * (1 - 4 * SLACK) end -- decay / (2 * hi / 2)
  return box
end

-- Does the box of states surely miss |u| <= R? m'z = (F'm)'u <= |F'm| |u| for any m.
local function misses(frame, set, box, n)
  local u, m = {}, {}
  for i = 1, n do
    local sum = 0
    for j = 1, n do
      sum = sum + frame.inverse[(i - 1) * n + j] * (0.5 * box.lo[j] + 0.5 * box.hi[j] - set.centre[j]:mid())
    end
    u[i] = sum
  end
  local part, square = core.interval(0), core.interval(0)
  for j = 1, n do
    m[j] = 0
    for i = 1, n do m[j] = m[j] + frame.inverse[(i - 1) * n + j] * u[i] end
    part = part + core.interval(m[j]) * (core.interval(box.lo[j], box.hi[j]) - set.centre[j])
  end
  for k = 1, n do
    local sum = core.interval(0)
    for j = 1, n do sum = sum + core.interval(frame.f[(j - 1) * n + k]) * core.interval(m[j]) end
    square = square + sum ^ 2
  end
  return part.lo > 0 and (core.interval(part.lo) ^ 2).lo > (square * core.interval(set.outer) ^ 2).hi
end

local function collapsed(box, j)
  local part = { lo = copy(box.lo), hi = copy(box.hi) }
  part.lo[j] = 0.5 * box.lo[j] + 0.5 * box.hi[j]
  part.hi[j] = part.lo[j]
  return part
end

-- How much each dimension costs the rate at the root.
local function influences(self, frame, root)
  local list, most = {}, 0
  for j = 1, #root.lo do
    if root.hi[j] > root.lo[j] then
      local gain = self:look(frame, collapsed(root, j), root).rate - root.rate
      list[j] = gain == gain and gain < math.huge and math.max(gain, 0) or 1
      most = math.max(most, list[j])
    end
  end
  for j in pairs(list) do list[j] = math.max(list[j], 1e-3 * most) end
  return list
end

local function cut(box, root, weights)
  local best, most
  for j = 1, #root.lo do
    local value = weights[j] and weights[j] * (box.hi[j] - box.lo[j]) / (root.hi[j] - root.lo[j])
    if value and (not most or value > most) then best, most = j, value end
  end
  local m = best and 0.5 * box.lo[best] + 0.5 * box.hi[best]
  if not m or not (m > box.lo[best] and m < box.hi[best]) then return nil end
  local low, high = { lo = box.lo, hi = copy(box.hi) }, { lo = copy(box.lo), hi = box.hi }
  low.hi[best], high.lo[best] = m, m
  return { low, high }
end

local function take_worst(boxes)
  local at = 1
  for i, box in ipairs(boxes) do if box.rate < boxes[at].rate then at = i end end
  local box = boxes[at]
  boxes[at] = boxes[#boxes]
  boxes[#boxes] = nil
  return box
end

-- By place, the ranges of the states in |u| <= R.
function methods:ranges(frame, set)
  local x = {}
  for i = 1, self.n do
    local rad = set.outer * frame.reach[i]
    x[i] = set.centre[i] + core.interval(-rad, rad)
  end
  return x
end

-- The middle of a box is in the set, and decays too slowly: no cutting helps.
local function fails(self, frame, set, box, least, root)
  local point = middle_of(box)
  return not misses(frame, set, point, self.n) and not (self:look(frame, point, root).rate > least)
end

-- set: { centre = enclosures of c, outer = R }. Fills in rate and least (of F'W F), both for the whole set; the rate as
-- good as `enough` if it can be; false: none above `least` was found with so many boxes.
function methods:bound(frame, set, least, enough, budget)
  local root = whole(self, self:ranges(frame, set))
  self:look(frame, root, root)
  local boxes, weights = { root }, nil
  for count = 1, budget do
    local worst = take_worst(boxes)
    if worst.rate >= enough then
      boxes[#boxes + 1] = worst
      break
    end
    weights = weights or influences(self, frame, root)
    local parts = cut(worst, root, weights)
    if not parts then
      boxes[#boxes + 1] = worst
      break
    end
    if count % LOOKS == 1 and fails(self, frame, set, worst, least, root) then return false end
    for _, part in ipairs(parts) do
      if not misses(frame, set, part, self.n) then boxes[#boxes + 1] = self:look(frame, part, root) end
    end
  end
  local slowest, most = math.huge, -math.huge -- of a mean over places, and of W at another one
  set.least = math.huge
  for _, box in ipairs(boxes) do
    slowest, set.least, most = math.min(slowest, box.decay), math.min(set.least, box.least), math.max(most, box.most)
  end
  set.rate = slowest > 0 and set.least > 0 and slowest / (2 * most) * (1 - 4 * SLACK) or -math.huge
  return set.rate > least
end

-- -- the state of rest of each of the data, at the middle of what varies in time

local function calm(self, list)
  local leaves, values = {}, {}
  for _, leaf in ipairs(self.data) do
    if leaf.kind == "varying" then
      leaves[#leaves + 1], values[#values + 1] = leaf.expression, core.expression(0.5 * leaf.lo + 0.5 * leaf.hi)
    end
  end
  return #leaves > 0 and core.substitute(list, leaves, values) or list, #leaves > 0
end

-- a (floats, by rows) times expressions, a matrix or a vector of `columns`.
local function product(n, a, list, columns)
  local found = {}
  for i = 1, n do
    for j = 1, columns do
      local sum = core.expression(0)
      for k = 1, n do sum = sum + a[(i - 1) * n + k] * list[(k - 1) * columns + j] end
      found[#found + 1] = sum
    end
  end
  return found
end

local function numbers(m)
  local list = {}
  for i, x in ipairs(m) do list[i] = core.expression(x) end
  return list
end

-- Krawczyk: K = m - Y g(m) + (1 - Y dg/dx(X)) (X - m) inside X proves one root in X for each of the data. m: numbers,
-- near a root -> enclosures, or nil. Keeps the states of rest as formulas of the data: m - Y g(m) and what is left.
function methods:rest(m)
  local n, jacobian = self.n, calm(self, self.jacobian)
  local middle = self:values(jacobian, m)
  local y = middle and metric.inverse(n, middle)
  if not y then return nil end
  local points, radius = {}, {}
  for i = 1, n do points[i] = core.interval(m[i]) end
  local steps = core.substitute(product(n, y, calm(self, self.image), 1), self.system.symbols, numbers(m))
  local off = self:enclose(steps, whole(self, points))
  local slopes = product(n, y, jacobian, n)
  for i = 1, n do radius[i] = off and 1.5 * off[i]:mag() + 1e-12 * math.max(1, math.abs(m[i])) end
  for _ = 1, off and RESTS or 0 do
    local x, inside, left = {}, true, {}
    for i = 1, n do
      if not (radius[i] < LARGEST) then return nil end
    end
    for i = 1, n do x[i] = points[i] + core.interval(-radius[i], radius[i]) end
    local slope = self:enclose(slopes, whole(self, x))
    if not slope then return nil end
    for i = 1, n do
      left[i] = core.interval(0)
      for j = 1, n do
        local off_one = core.interval(i == j and 1 or 0) - slope[(i - 1) * n + j]
        left[i] = left[i] + off_one * core.interval(-radius[j], radius[j])
      end
      local k = left[i] - off[i]
      inside = inside and k:mag() < radius[i]
      x[i], radius[i] = points[i] + k, 1.2 * k:mag() + 1e-14 * math.max(1, math.abs(m[i]))
    end
    if inside then
      self.rests = { at = m, steps = steps, left = left }
      return x
    end
  end
end

-- An upper bound of |F'g(c)| at the states of rest `centre`, which what varies in time is to blame for.
function methods:residual(frame, centre)
  local n, y, squares = self.n, {}, core.expression(0)
  local still, varies = calm(self, self.image)
  if not varies then return 0 end
  for i = 1, n do
    y[i] = core.expression(0)
    for j = 1, n do y[i] = y[i] + frame.f[(j - 1) * n + i] * (self.image[j] - still[j]) end
    squares = squares + y[i] ^ 2
  end
  y[n + 1] = squares
  local found = self:enclose(y, whole(self, centre))
  if not found then return nil end
  local sum = core.interval(0)
  for i = 1, n do sum = sum + core.interval(found[i]:mag()) ^ 2 end
  return core.sqrt(core.interval(math.max(0, math.min(sum.hi, found[n + 1].hi)))).hi
end

-- Are the formulas defined and smooth all over the set, for all data?
function methods:is_smooth(frame, set)
  local list = copy(self.image)
  for i, rate in ipairs(self.moving and {} or self.system.rates) do list[self.n + i] = rate end
  return core.are_smooth { equations = list, unknowns = self.system.symbols, names = self.system.states,
    box = self:ranges(frame, set), leaves = {}, values = {} }
end

-- x - c of expressions x, with c as a function of the data.
function methods:offset(x)
  local z, rests = {}, self.rests
  for i = 1, self.n do
    z[i] = bare(x[i]) - rests.at[i] + rests.steps[i]
    if rests.left[i]:mag() > 0 then z[i] = z[i] - core.between(rests.left[i].lo, rests.left[i].hi) end
  end
  return z
end

-- z'W z of expressions x.
function methods:square(x, z)
  local n, sum, list = self.n, core.expression(0), self.weight
  if self.moving then
    local values = {}
    for i = 1, n do values[i] = core.expression(x[i]) end
    list = core.substitute(list, self.system.symbols, values)
  end
  for i = 1, n do
    sum = sum + z[i] ^ 2 * list[(i - 1) * n + i]
    for j = i + 1, n do sum = sum + 2 * z[i] * z[j] * list[(i - 1) * n + j] end
  end
  return sum
end

-- The largest entry, by magnitude, of 1 - C F, C being roughly the inverse of F.
local function defect(n, frame)
  local most = 0
  for i = 1, n do
    for j = 1, n do
      local sum = core.interval(i == j and -1 or 0)
      for k = 1, n do
        sum = sum + core.interval(frame.inverse[(i - 1) * n + k]) * core.interval(frame.f[(k - 1) * n + j])
      end
      most = math.max(most, sum:mag())
    end
  end
  return most
end

-- Are all states x (expressions) in the set, whatever the data? That is z'W z <= r^2, and |u| <= R: beyond that
-- nothing is known of a W that depends on the state. Also the enclosure of z'W z.
function methods:holds(set, x)
  local n, frame, z, size = self.n, set.by.frame, self:offset(x), core.expression(0)
  for i = 1, n do
    local u = core.expression(0)
    for j = 1, n do u = u + frame.inverse[(i - 1) * n + j] * z[j] end
    size = size + u ^ 2
  end
  local found = core.evaluate { arithmetic = core.default.linear, expressions = { self:square(x, z), size } }
  local limits = { core.interval(set.radius) ^ 2, core.interval(set.outer) ^ 2 }
  if self.moving then
    frame.defect = frame.defect or defect(n, frame)
    limits[2] = limits[2] * (core.interval(1) - core.interval(n) * core.interval(frame.defect)) ^ 2
  end
  local inside = not self.moving or n * frame.defect < 0.5
  for k = 1, self.moving and 2 or 1 do
    inside = inside and not found[k]:is_empty() and not found[k].partial and found[k].hi <= limits[k].lo
  end
  return inside, found[1]
end

decay.bare = bare

return decay
