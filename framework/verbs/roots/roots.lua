-- roots.lua -- ambit.roots { { f1, f2 }, box = { x = { lo, hi }, y = { lo, hi } }, at = { name = value } }: every root
-- in the box, proved. The first entry may be a function(s) that returns the expressions; s.x is the unknown x.
local binding = require "ambit.run.binding"
local check = require "ambit.check"
local core = require "ambit.core"
local formula = require "ambit.formula"
local evaluate = require "ambit.evaluate"
local option = require "ambit.option"
local partial = require "ambit.run.partial"
local session = require "ambit.session"
local slope = require "ambit.roots.slope"
local shape = require "ambit.shape"
local uncertain = require "ambit.run.uncertain"

local verb = {}

-- Of ranges with ends that are no doubles: the part that is asked for for certain, { lo, hi }.
local asked = setmetatable({}, { __mode = "k" })

-- One end of a range, outward and inward: an infinite number, or anything that is one number in the unit.
local function bound(value, side, unit, what)
  if value == math.huge or value == -math.huge then return value, value end
  local e = core.expression(value, unit, what)
  if not core.is_constant(e) then
    check.fail("%s: the ends of a range are known numbers, not uncertain themselves", what)
  end
  local x = core.interval(e)
  return x[side], x[side == "lo" and "hi" or "lo"]
end

-- interval(...), whose messages are made to say what they are about
local function interval(what, ...)
  local good, result = pcall(core.interval, ...)
  if good then return result end
  local message, place = tostring(result), core.where()
  if message:sub(1, #place) == place then message = message:sub(#place + 1) end
  return check.fail("%s: %s", what, message)
end

-- { lo, hi }, an enclosure, or a text such as "[0, 1]" -> enclosure
function verb.range(value, what, unit)
  local kind = check.kind(value)
  if kind == "table" then
    check.keys(value, {}, what, 2)
    if value[1] == nil or value[2] == nil then check.fail("%s: expected { lo, hi }", what) end
    local lo, inner_lo = bound(value[1], "lo", unit, what)
    local hi, inner_hi = bound(value[2], "hi", unit, what)
    if lo > hi then
      check.fail("%s: the range is empty: %s is greater than %s", what, core.literal(lo), core.literal(hi))
    end
    local range = interval(what, lo, hi)
    asked[range] = { lo = inner_lo, hi = inner_hi }
    return range
  end
  if kind == "function" or kind == "boolean" or kind == "nil" then
    check.fail("%s: expected { lo, hi }, an enclosure or a text, got %s", what, kind)
  end
  local own = unit and core.unit_of(value)
  if own then core.expression(core.in_unit(core.expression(0), own), unit, what) end
  return interval(what, value)
end

-- The ranges of the unknowns by sorted name; units: { [name] = its unit } where they are known
function verb.read_box(box, what, units)
  if box == nil then check.fail("%s: box is missing: { x = { lo, hi }, ... } for every unknown", what) end
  check.table(box, what .. ": box")
  local names, ranges = {}, {}
  if next(box) == nil then check.fail("%s: box is empty: { x = { lo, hi }, ... } for every unknown", what) end
  for i, name in ipairs(check.sorted(box)) do
    names[i] = check.text(name, what .. ": box: name of an unknown")
    ranges[i] = verb.range(box[name], ("%s: box.%s"):format(what, name), units and units[name])
  end
  return names, ranges
end

-- The symbols that expressions reach, by name.
function verb.symbols(expressions)
  local symbols = {}
  for _, leaf in ipairs(core.leaves(expressions)) do
    if leaf.kind == "symbol" then symbols[leaf.name] = leaf end
    if leaf.kind == "time" then symbols.t = leaf end
  end
  return symbols
end

-- Values of `at` for symbols; others are no mistake as long as `allowed` names them.
function verb.bind(at, symbols, allowed, what)
  local leaves, values = {}, {}
  for _, name in ipairs(check.sorted(check.table(at == nil and {} or at, what .. ": at"))) do
    local leaf = symbols[name]
    if leaf then
      leaves[#leaves + 1] = leaf.expression
      values[#values + 1] = binding.value(leaf, at[name], ("%s: at.%s"):format(what, name))
      core.name_data({ values[#values] }, name)
    elseif not allowed[name] then
      check.fail("%s: at: there is no variable `%s`%s", what, tostring(name),
        check.suggest(name, check.sorted(symbols)))
    end
  end
  return leaves, values
end

-- What an unknown box or its root looks like: enclosures by name; facts besides are reached through the metatable.
local function named(names, facts, value)
  local point = {}
  for i, name in ipairs(names) do point[name] = value(i) end
  return evaluate.with_status(point, facts)
end

-- Does x lie within what is asked for?
local function is_inside(x, range)
  local a = asked[range] or range
  return x.lo >= a.lo and x.hi <= a.hi
end

local function precedes(names)
  return function(a, b)
    for _, name in ipairs(names) do
      if a[name].lo ~= b[name].lo then return a[name].lo < b[name].lo end
    end
    return false
  end
end

-- Facts about a point that are worked out when they are asked for: slope, and q.more(point, key).
local function further(q)
  return function(point, key)
    if key == "slope" then return slope(q, point) end
    return q.more and q.more(point, key)
  end
end

-- The lists of what was found: proved, proved for a part of the uncertain data's values, undecided.
local function read_track(track, names, ranges, more)
  local lists = { [0] = {}, {}, {} }
  for i = 1, core.track_count(track) do
    local _, _, _, event = core.track_step(track, i)
    local facts = { inside = true }
    local point = named(names, facts, function(k)
      local x = core.track_value(track, i, k, false)
      facts.inside = facts.inside and is_inside(x, ranges[k])
      return x
    end)
    setmetatable(facts, { __index = function(_, key) return more(point, key) end })
    local list = lists[event]
    list[#list + 1] = point
  end
  for i = 0, 2 do table.sort(lists[i], precedes(names)) end
  return lists[1], lists[2], lists[0]
end

local Roots = { __name = "roots" }
Roots.__index = Roots

function Roots.__tostring(self)
  local lines = { ("%s: %d root%s proved, %d box%s undecided"):format(self.status, #self.proved,
    #self.proved == 1 and "" or "s", #self.undecided, #self.undecided == 1 and "" or "es") }
  local function add(list, note)
    for _, point in ipairs(list) do
      local parts = {}
      for _, name in ipairs(self.unknowns) do parts[#parts + 1] = ("%s = %s"):format(name, tostring(point[name])) end
      lines[#lines + 1] = "  " .. table.concat(parts, ", ") .. note
    end
  end
  add(self.proved, "")
  add(self.partly, " (for a part of the uncertain data)")
  if self.reason ~= "" then lines[#lines + 1] = self.reason end
  return table.concat(lines, "\n")
end

-- The solver's name, its options and those of the arithmetic; every other key of t must be among own_keys.
function verb.settings(t, what, own_keys, positional)
  local q = { solver = t.solver == nil and core.default.roots or check.text(t.solver, what .. ": solver"),
    partial = partial.read(t, what) }
  local declaration = option.declaration("solver", q.solver)
  local known = { "solver", "arithmetic", "partial" }
  table.move(own_keys, 1, #own_keys, #known + 1, known)
  local names = option.names(declaration)
  table.move(names, 1, #names, #known + 1, known)
  check.keys(t, known, ("%s with solver %s"):format(what, q.solver), positional)
  q.options, q.option_list = option.collect(t, declaration)
  q.arithmetic_options = {}
  if t.arithmetic ~= nil then
    q.arithmetic, q.arithmetic_options = option.arithmetic(t.arithmetic, what .. ": arithmetic")
  end
  return q
end

-- q: settings, and expressions, names, symbols (expressions), ranges, leaves, values, centre (numbers or nil), more
function verb.run(q)
  local track, facts, report = core.roots { solver = q.solver, arithmetic = q.arithmetic, options = q.options,
    arithmetic_options = q.arithmetic_options, equations = q.expressions, unknowns = q.symbols, names = q.names,
    leaves = q.leaves, values = q.values, box = q.ranges, centre = q.centre, leading = q.leading }
  facts.proved, facts.partly, facts.undecided = read_track(track, q.names, q.ranges, further(q))
  facts.unknowns, facts.solver, facts.arithmetic, facts.report = q.names, q.solver, report.arithmetic, report
  return setmetatable(facts, Roots)
end

-- How many of the proved roots are not known to be in the box for all data, because their enclosures reach out of it.
function verb.leaving(q, facts)
  local count, list = 0, table.move(q.expressions, 1, #q.expressions, 1, {})
  for _, point in ipairs(facts.proved) do count = count + (point.inside and 0 or 1) end
  if count == 0 then return 0 end
  return #uncertain.data(table.move(q.values, 1, #q.values, #list + 1, list)) > 0 and count or 0
end

-- What holds for a part of the data only, or nil.
local function why_partial(q, facts)
  local n, out = #facts.partly, verb.leaving(q, facts)
  if n > 0 then
    return (n == 1 and "1 root exists" or ("%d roots exist"):format(n)) .. " only for a part of the data"
  end
  local where = "outside the box, which could be larger, for a part of the data"
  if out > 0 then return (out == 1 and "1 root may lie " or ("%d roots may lie "):format(out)) .. where end
end

-- The end of the verb `what`; outcome: what it made of the facts of the search, or nil.
function verb.finish(q, what, facts, outcome)
  local result = outcome or facts
  partial.judge(result, why_partial(q, facts), q.partial)
  session.finish(what, result, facts.report,
    { "solver", q.solver, "arithmetic", facts.arithmetic, "options", q.option_list, "boxes", facts.boxes })
  return result
end

-- The unknowns' symbols.
local function unknowns(names, symbols, what)
  local list = {}
  for i, name in ipairs(names) do
    if not symbols[name] then
      check.fail("%s: box: no equation depends on `%s`%s", what, name, check.suggest(name, check.sorted(symbols)))
    end
    list[i] = symbols[name].expression
  end
  return list
end

local function expressions_of(t, names, what)
  if type(t[1]) ~= "function" then return (shape.flatten(evaluate.subject(t, what), what)) end
  local values = {}
  for _, name in ipairs(names) do values[name] = core.symbol(name, "1") end
  local s = setmetatable({}, {
    __index = function(_, key)
      if values[key] == nil then
        check.fail("%s: `box` names no unknown `%s`%s", what, tostring(key), check.suggest(key, names))
      end
      return values[key]
    end,
  })
  return (shape.flatten(formula.call(t[1], what, s), what))
end

function verb.roots(t)
  check.table(t, "roots")
  local q = verb.settings(t, "roots", { "box", "at" }, #t)
  q.names, q.ranges = verb.read_box(t.box, "roots")
  q.expressions = expressions_of(t, q.names, "roots")
  if #q.expressions == 0 then check.fail "roots: there is no equation: expected { f, box = { ... } }" end
  local symbols = verb.symbols(q.expressions)
  if t.at ~= nil then check.table(t.at, "roots: at") end
  for _, name in ipairs(q.names) do
    if t.at and t.at[name] ~= nil then check.fail("roots: `%s` is in `box` and in `at`", name) end
  end
  q.symbols = unknowns(q.names, symbols, "roots")
  q.leaves, q.values = verb.bind(t.at, symbols, {}, "roots")
  return verb.finish(q, "roots", verb.run(q))
end

return verb
