-- stability.lua -- is a proved state of rest stable, whatever the uncertain data are? And ambit.eigenvalues.
--
-- Two proofs (docs/numerics/stability.md). Of x' = f(x): the eigenvalues of df/dx, enclosed over the root and all data,
-- or Lyapunov's equation. Of a mechanism, where eigenvalues on the imaginary axis tell nothing: its energy has a strict
-- minimum at rest, and nothing puts energy in (Lagrange and Dirichlet). Worked out when it is first asked for.
local check = require "ambit.check"
local core = require "ambit.core"
local evaluate = require "ambit.evaluate"
local partial = require "ambit.run.partial"
local roots = require "ambit.roots"
local session = require "ambit.session"
local shape = require "ambit.shape"

local NEAR = 1e-6 -- how far around rest, in coordinates and speeds, the power is looked at

local CLOSE = 1e-12 -- how far around rest the equations must be smooth

local stability = {}

-- df/dx by rows, or nil and why there is none.
local function derivatives(list, symbols)
  local entries = {}
  for _, f in ipairs(list) do
    for _, x in ipairs(symbols) do
      local good, d = pcall(core.derivative, f, x)
      if not good then return nil, "there is a state at which it has no derivative: " .. tostring(d) end
      entries[#entries + 1] = d
    end
  end
  return entries
end

local WIDE = 1e-9 -- relative above 1: what is narrower is a rounded number, no datum
local PIECES = 64 -- of the data's ranges, if they are too wide as a whole

-- The uncertain data that expressions and values depend on: { expression, lo, hi }.
local function uncertain(list, values)
  local found = {}
  for _, leaf in ipairs(core.leaves(table.move(values, 1, #values, #list + 1, table.move(list, 1, #list, 1, {})))) do
    local wide = leaf.kind == "unknown" and leaf.hi - leaf.lo > WIDE * math.max(1, math.abs(leaf.lo), math.abs(leaf.hi))
    if wide then found[#found + 1] = leaf end
  end
  return found
end

-- Enclosures, or nil if one is not bounded or not defined all over the box.
local function enclose(list, leaves, values)
  local found = core.evaluate { expressions = list, leaves = leaves, values = values }
  for _, x in ipairs(found) do
    if x:is_empty() or not x:is_bounded() or x.partial then return nil end
  end
  if #uncertain(list, values) == 0 then return found end
  local other = core.evaluate { arithmetic = core.default.linear, expressions = list, leaves = leaves, values = values }
  for i, x in ipairs(other) do found[i] = found[i]:intersect(x) end
  return found
end

-- Values of all states at a point: those that were searched, speeds at 0, the others as `at` says. `off`: enclosure
-- that is added to each.
local function place(self, point, off)
  local leaves, values = {}, {}
  local function add(leaf, value)
    leaves[#leaves + 1] = leaf
    values[#values + 1] = core.expression(off and value + off or value)
  end
  for k, name in ipairs(self.system.states) do
    if self.speeds[name] then
      add(self.system.symbols[k], core.interval(0))
    elseif self.searched[name] then
      add(self.system.symbols[k], rawget(point, name))
    end
  end
  for i, leaf in ipairs(self.leaves) do leaves[#leaves + 1], values[#values + 1] = leaf, self.values[i] end
  return leaves, values
end

-- Are the expressions smooth in all states around rest? A derivative's formula says nothing about it: that of atan2 is
-- bounded across its jump, that of x^2.5 at the edge of its domain.
local function are_smooth(self, point, list)
  local names, box, leaves, values, off = {}, {}, {}, {}, core.interval(-CLOSE, CLOSE)
  local bound = {}
  for i, leaf in ipairs(self.leaves) do bound[i] = leaf end
  for k, name in ipairs(self.system.states) do
    local symbol = self.system.symbols[k]
    local value = self.speeds[name] and core.interval(0) or self.searched[name] and rawget(point, name)
    for i, leaf in ipairs(self.leaves) do
      if leaf == symbol then value, bound[i] = core.interval(self.values[i]), false end
    end
    names[k], box[k] = name, value and core.interval(value + off) or core.interval(-math.huge, math.huge)
  end
  for i, leaf in ipairs(bound) do
    if leaf then leaves[#leaves + 1], values[#values + 1] = leaf, self.values[i] end
  end
  return core.are_smooth { equations = list, unknowns = self.system.symbols, names = names, leaves = leaves,
    values = values, box = box }
end

-- -- by the eigenvalues of the linearised system

local function jacobian(self)
  if self.jacobian == nil then
    local entries, why = derivatives(self.system.rates, self.system.symbols)
    self.jacobian, self.no_jacobian = entries or false, why
  end
  return self.jacobian
end

-- The data's ranges in pieces: what is the case in each of them, or "undecided". Halves the relatively widest one.
local function judge_pieces(entries, n, leaves, values, data, budget)
  local widest, most = nil, 0
  for i, datum in ipairs(data) do
    local part = (datum.hi - datum.lo) / datum.whole
    if part > most then widest, most = i, part end
  end
  if not widest or budget < 2 then return "undecided" end
  local verdict
  local datum = data[widest]
  local middle = datum.lo + (datum.hi - datum.lo) / 2
  for _, range in ipairs { { datum.lo, middle }, { middle, datum.hi } } do
    local part = table.move(data, 1, #data, 1, {})
    part[widest] = { expression = datum.expression, lo = range[1], hi = range[2], whole = datum.whole }
    local all_leaves, all_values = table.move(leaves, 1, #leaves, 1, {}), table.move(values, 1, #values, 1, {})
    for _, d in ipairs(part) do
      all_leaves[#all_leaves + 1] = d.expression
      all_values[#all_values + 1] = core.expression(core.interval(d.lo, d.hi))
    end
    local matrix, own = enclose(entries, all_leaves, all_values), "undecided"
    if matrix then own = select(2, core.spectrum(n, matrix)) end
    if own == "undecided" then own = judge_pieces(entries, n, leaves, values, part, budget // 2) end
    if own == "undecided" or (verdict and own ~= verdict) then return "undecided" end
    verdict = own
  end
  return verdict
end

-- The same question for parts of the data's ranges.
local function subdivide(self, point, facts)
  local entries = jacobian(self)
  if not entries then return end
  local leaves, values = place(self, point)
  local data = uncertain(entries, self.values)
  for _, datum in ipairs(data) do datum.whole = datum.hi - datum.lo end
  local verdict = judge_pieces(entries, #self.system.states, leaves, values, data, PIECES)
  if verdict == "undecided" then return end
  facts.stability, facts.stability_by, facts.stability_reason = verdict, "eigenvalues, for parts of the data", ""
end

local function linearise(self, point, facts)
  local entries = jacobian(self)
  if not entries then
    facts.stability_reason = self.no_jacobian
    return
  end
  local matrix = enclose(entries, place(self, point))
  if not matrix then
    facts.stability_reason = "the Jacobian is not bounded over the root's box"
    return
  end
  local values, verdict, by = core.spectrum(#self.system.states, matrix)
  facts.eigenvalues, facts.stability, facts.stability_by = values or {}, verdict, by
  if verdict == "undecided" then
    facts.stability_reason = values and "an eigenvalue may lie on the imaginary axis"
      or "no enclosure of the eigenvalues was found"
  end
end

-- -- by energy

-- Total energy's second derivatives, upper triangle mirrored; false if it has none.
local function hessian(self)
  if self.hessian == nil then
    self.hessian = false
    local energy = self.system.mechanism:energy().total
    local first = derivatives({ energy }, self.system.symbols)
    local second = first and derivatives(first, self.system.symbols)
    if second then self.hessian = second end
  end
  return self.hessian
end

-- What is put in, in some neighbourhood of rest; nil: not known.
local function power_near(self, point)
  local found = enclose({ self.system.mechanism:power() }, place(self, point, core.interval(-NEAR, NEAR)))
  return found and found[1]
end

local function try_energy(self, point, facts)
  for _, name in ipairs(self.system.states) do
    if not (self.speeds[name] or self.searched[name]) then return end -- `at` puts it there: no root was proved for it
  end
  if not are_smooth(self, point, { self.system.mechanism:energy().total }) then return end
  local second, power = hessian(self), power_near(self, point)
  local matrix = second and power and power.hi <= 0 and enclose(second, place(self, point))
  if not matrix or not core.is_positive_definite(#self.system.states, matrix) then return end
  facts.stability, facts.stability_by, facts.stability_reason = "stable", "energy", ""
end

-- -- what is said of a point

local function refusal(self)
  local invariants = core.system_invariants(self.system.system)
  if #invariants > 0 then
    return "the states depend on each other (closed loops, quaternions): eigenvalues of all of them tell nothing"
  end
  if roots.symbols(self.system.rates).t then return "the system depends on time" end
end

local function decide(self, point)
  local facts = { stability = "undecided", stability_by = "", stability_reason = "", eigenvalues = {} }
  facts.stability_reason = refusal(self) or ""
  if facts.stability_reason ~= "" then return facts end
  if not are_smooth(self, point, self.system.rates) then
    facts.stability_reason = "the equations jump, or have a kink or the edge of their domain, where the system rests"
    return facts
  end
  linearise(self, point, facts)
  local power = facts.stability == "undecided" and self.system.mechanism and power_near(self, point)
  local attempts = { subdivide, self.system.mechanism and try_energy or nil }
  if power and power.lo == 0 and power.hi == 0 then attempts = { try_energy, subdivide } end -- nothing takes energy out
  for _, attempt in ipairs(attempts) do
    if facts.stability == "undecided" then attempt(self, point, facts) end
  end
  return facts
end

-- Whoever asks for the verdict on a point gets it, and its code counts.
local function count(facts)
  session.finish("stability", { status = facts.stability, reason = facts.stability_reason,
    code = facts.stability == "undecided" and "unable.undecided" or "ok", cpu_seconds = facts.cpu_seconds }, {},
    { "by", facts.stability_by })
end

local keys = { stability = true, stability_by = true, stability_reason = true, eigenvalues = true }

-- self: { system, speeds, searched (names as keys), leaves, values } -> function(point, key) for roots.run's `more`.
function stability.new(self)
  local known = setmetatable({}, { __mode = "k" })
  return function(point, key)
    if not keys[key] then return nil end
    if not known[point] then
      local start = core.cpu()
      known[point] = decide(self, point)
      known[point].cpu_seconds = core.cpu() - start
      count(known[point])
    end
    return known[point][key]
  end
end

-- An entry that has no value for any of the data: there is no matrix.
local function refuse_empty(facts, matrix, blame)
  for _, x in ipairs(matrix) do
    if x:is_empty() then
      facts.status, facts.code = "impossible", "domain.undefined"
      facts.reason = ("%s is defined for none of the data"):format(blame == "" and "an entry" or ("`%s`"):format(blame))
    end
  end
end

local function why_partial(matrix, blame)
  for _, x in ipairs(matrix) do
    if x.partial then
      return ("%s is undefined for part of the data, and the eigenvalues hold for the rest"):format(
        blame == "" and "an entry" or ("`%s`"):format(blame))
    end
  end
end

-- ambit.eigenvalues { { a, b }, { c, d } }: n enclosures { re, im, count } of the eigenvalues of every matrix of the
-- set
function stability.eigenvalues(t)
  check.table(t, "eigenvalues")
  local allowed, n = partial.read(t, "eigenvalues"), #t
  check.keys(t, { "partial" }, "eigenvalues", n)
  if n == 0 then check.fail "eigenvalues: expected the rows of a matrix: { { a, b }, { c, d } }" end
  for i, row in ipairs(t) do
    if type(row) ~= "table" or #row ~= n then check.fail("eigenvalues: row %d: expected %d entries", i, n) end
  end
  local entries = shape.flatten(table.move(t, 1, n, 1, {}), "eigenvalues")
  if #entries ~= n * n then check.fail("eigenvalues: expected %d rows of %d entries and nothing else", n, n) end
  local start = core.cpu()
  local matrix, _, blame = core.evaluate { expressions = entries }
  local values, verdict, by = core.spectrum(n, matrix)
  local facts = { status = values and "complete" or "unable", code = values and "ok" or "unable.eigenvalues",
    stability = verdict, stability_by = by, cpu_seconds = core.cpu() - start,
    reason = values and "" or "the matrix is not bounded, or its eigenvectors are too dependent for data so wide" }
  refuse_empty(facts, matrix, blame)
  partial.judge(facts, why_partial(matrix, blame), allowed)
  session.finish("eigenvalues", facts, {}, { "rows", n, "stability", verdict })
  return evaluate.with_status(facts.status == "impossible" and {} or values or {}, facts)
end

return stability
