-- robot/tolerance.lua -- tolerances laid on the data of a robot by pattern: { mass = "2%", ["*_joint.offset"] = "0.1
-- mm" }.
--
-- A pattern is [NAME.]DATUM[.COMPONENT]; NAME, of a link or of a joint, may hold * and ?. Each number that a pattern
-- meets becomes one fresh unknown, as by ambit.around. Where several patterns meet one number the most specific one
-- holds: a name without * and ? before one with, then the longer name, then one that says the component.
--
-- A relative tolerance on the inertia as a whole is one factor for each body, 1 +- p: the symmetric matrix then stays
-- one that a body can have, for those are a cone. In any other case each entry of the upper triangle is an unknown of
-- its own; nothing then says that every matrix in the set belongs to a body.
local check = require "ambit.check"
local core = require "ambit.core"

local xyz = { "x", "y", "z" }

local tolerance = {
  data = {
    mass = { of = "link", unit = "kg" },
    centre = { of = "link", unit = "m", xyz },
    inertia = { of = "link", unit = "kg m^2", { "xx", "xy", "xz", "yy", "yz", "zz" } },
    offset = { of = "joint", unit = "m", xyz },
    angle = { of = "joint", unit = "rad", { "roll", "pitch", "yaw" } },
  },
}
local names_of_data = check.sorted(tolerance.data)

local function index_of(list, wanted)
  for i, value in ipairs(list or {}) do
    if value == wanted then return i end
  end
end

-- "elbow_*.offset.z" -> "elbow_*", "offset", 3
local function split(key)
  local words = {}
  for word in (key .. "."):gmatch "([^.]*)%." do words[#words + 1] = word end
  local n = #words
  if tolerance.data[words[n]] then return table.concat(words, ".", 1, n - 1), words[n], nil end
  local datum = n > 1 and tolerance.data[words[n - 1]]
  if not datum then
    check.fail('tolerances: `%s` does not end in a datum%s', key, check.suggest(words[n], names_of_data))
  end
  local component = index_of(datum[1], words[n])
  if not component then
    check.fail("tolerances: `%s`: %s has no component `%s`%s", key, words[n - 1], words[n],
      check.suggest(words[n], datum[1] or {}))
  end
  return table.concat(words, ".", 1, n - 2), words[n - 1], component
end

-- The Lua pattern of a name with * and ?
local function glob(name)
  local pattern = name:gsub("[%^%$%(%)%%%.%[%]%+%-]", "%%%0"):gsub("%*", ".*"):gsub("%?", ".")
  return "^" .. pattern .. "$"
end

-- Checks the tolerance itself: a number in SI units or a text, with a unit that fits or in per cent. Is it relative,
-- and how large, in SI units or per cent?
local function size_of(value, datum, key)
  local what = "tolerances: " .. key
  local kind = check.kind(value)
  if kind ~= "number" and kind ~= "string" then
    check.fail('%s: expected a tolerance such as "2%%" or "1 %s", got %s', what, tolerance.data[datum].unit, kind)
  end
  local percent = kind == "string" and value:match "^(.*)%%%s*$"
  local unit = not percent and tolerance.data[datum].unit or nil
  local size = core.interval(core.expression(percent or value, unit, what))
  if size.lo < 0 or not size:is_bounded() then
    check.fail("%s: a tolerance is finite and not negative, got %s", what, tostring(value))
  end
  return percent and true or false, size.hi
end

local function parse(key, value)
  if type(key) ~= "string" then
    check.fail("tolerances: expected pattern = tolerance, got an entry [%s]", tostring(key))
  end
  local name, datum, component = split(key)
  local literal = name:gsub("[*?]", "")
  local is_relative, size = size_of(value, datum, key)
  return { key = key, value = value, datum = datum, component = component, name = name,
    match = glob(name == "" and "*" or name), is_exact = name ~= "" and literal == name, length = #literal,
    is_relative = is_relative, size = size }
end

local Set = {}
Set.__index = Set

-- new { pattern = tolerance, ... }, more tables of them
function tolerance.new(...)
  local set = setmetatable({ patterns = {}, data = {} }, Set)
  for _, t in ipairs { ... } do
    check.table(t, "tolerances")
    for _, key in ipairs(check.sorted(t)) do set.patterns[#set.patterns + 1] = parse(key, t[key]) end
  end
  return set
end

local function is_better(p, q)
  if p.is_exact ~= q.is_exact then return p.is_exact end
  if p.length ~= q.length then return p.length > q.length end
  return (p.component and 1 or 0) > (q.component and 1 or 0)
end

-- The pattern that holds for this number. names: that of the file and the full one.
function Set:find(names, datum, component)
  local best, rival
  for _, p in ipairs(self.patterns) do
    if p.datum == datum and (p.component == nil or p.component == component)
      and (names[1]:find(p.match) or names[2]:find(p.match)) then
      p.has_met = true
      if not best or is_better(p, best) then
        best, rival = p, nil
      elseif not is_better(best, p) then
        rival = p
      end
    end
  end
  if rival and rival.value ~= best.value then
    check.fail("tolerances: `%s` and `%s` both meet %s of `%s`: say which with a longer name", best.key, rival.key,
      datum, names[1])
  end
  if best then best.was_best = true end
  return best
end

-- The number with the tolerance, a datum that is called after what it is of.
local function lay(set, names, datum, component, pattern, expression)
  local list = tolerance.data[datum][1]
  local label = names[2] .. "." .. datum .. (list and component and "." .. list[component] or "")
  core.name_data({ expression }, label)
  set.data[#set.data + 1] = { name = label, tolerance = pattern.value, value = expression }
  pattern.has_laid = true
  return expression
end

-- The number with the tolerance of the pattern, which must leave it above zero where there is nothing below.
local function around(names, pattern, number, is_positive)
  local most = pattern.is_relative and 100 or core.interval(number).lo
  if is_positive and pattern.size >= most then
    check.fail("tolerances: `%s`: within %s the %s of `%s` can be zero or less", pattern.key, tostring(pattern.value),
      pattern.datum, names[1])
  end
  return core.around(number, pattern.value)
end

-- Does the pattern leave the number as it is? A tolerance of 0 has then done what it was given for.
local function is_idle(pattern, number)
  if pattern.size == 0 then pattern.has_laid = true end
  return pattern.size == 0 or pattern.is_relative and number == core.expression(0)
end

-- The number, an expression, with its tolerance.
function Set:lay(names, datum, component, number)
  local pattern = self:find(names, datum, component)
  if not pattern or is_idle(pattern, number) then return number end
  return lay(self, names, datum, component, pattern, around(names, pattern, number, datum == "mass"))
end

-- The upper triangle of an inertia.
function Set:lay_inertia(names, entries)
  local factors, laid = {}, {}
  for i, entry in ipairs(entries) do
    local pattern = self:find(names, "inertia", i)
    if pattern and pattern.is_relative and not pattern.component and pattern.size > 0 then
      factors[pattern] = factors[pattern]
        or lay(self, names, "inertia", nil, pattern, around(names, pattern, core.expression(1), true))
      laid[i] = factors[pattern] * entry
    else
      laid[i] = self:lay(names, "inertia", i, entry)
    end
  end
  return laid
end

-- What was laid on nothing is a mistake. names: { link = { ... }, joint = { ... } }
function Set:finish(names)
  for _, p in ipairs(self.patterns) do
    local of = tolerance.data[p.datum].of
    if not p.has_met then
        check.fail("tolerances: `%s` meets nothing: there is no such %s%s", p.key,
        of == "link" and "link with a body" or of, check.suggest(p.name, names[of]))
    end
    if p.was_best and not p.has_laid then
      check.fail("tolerances: `%s` changes nothing: every number that it meets is 0, and %s of that is 0", p.key,
        tostring(p.value))
    end
  end
end

return tolerance
