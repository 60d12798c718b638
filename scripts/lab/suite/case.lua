-- suite/case.lua -- the cases of `ambit stability`: what one is, checked; what is expected of it.
--
-- A case is a table:
--   name, group, title, source         text; source says where data and reference come from
--   question                           "simulate" (default), "evaluate", "equilibria", "roots", or a word of your own
--   quick = true                       takes part in `ambit stability --quick`; or with which solvers (or arithmetics)
--                                      it does: { "stiff", "gsl" }
--   budget = { cpu = s, wall = s, memory = bytes }
--   make = function(ambit)             -> the table for the verb, without solver and arithmetic; or
--   run = function(ambit, solver, arithmetic, options) -> { outcome, reason, width, t_reached, steps, enclosures = {} }
--   over = { { solver =, arithmetic =, options = {} }, ... }   nil or "all": everything that is installed and fits;
--                                      "solvers": the same, but each solver with its first arithmetic only
--   also = { { solver =, ... }, ... }  besides
--   reference = { t =, x = { [name] = "[lo, hi]" } }, or a list of such, by time; surely holds the truth
--   expected = { ["valencia affine"] = "unable", lohner = "proved", default = "proved" }
--   least = { [as expected] = { t_reached =, digits = } }
local check = require "ambit.check"

local case = {}

local keys = { "name", "group", "title", "source", "question", "quick", "budget", "make", "run", "over", "also",
  "reference", "expected", "least" }

-- What a case can be expected to end with; "crashed" and "wrong" never are.
local expectable = { proved = true, computed = true, unable = true, refused = true, late = true,
  ["out of memory"] = true }

-- Of the plugins that come with Ambit something is expected; those of a user take part, and are only reported.
local shipped = {}
for name in ([[lohner taylor_model valencia stiff gsl krawczyk reduction
  real interval affine mpfr gradient]]):gmatch "%S+" do
  shipped[name] = true
end

local function read_references(list, what)
  if list == nil then return {} end
  if check.table(list, what).x then list = { list } end
  for i, entry in ipairs(list) do
    check.keys(check.table(entry, what), { "t", "x" }, what)
    check.table(entry.x, what .. ": x")
    if i > 1 and entry.t and not (entry.t > list[i - 1].t) then check.fail("%s: the times must ascend", what) end
  end
  return list
end

local function check_expected(expected, what)
  for _, name in ipairs(check.sorted(expected)) do
    local value = expected[name]
    if not expectable[value] then
      check.fail("%s: expected: %s: one of %s, got %s", what, name, table.concat(check.sorted(expectable), ", "),
        check.shown(value))
    end
  end
end

local function check_least(least, what)
  for _, name in ipairs(check.sorted(least)) do
    check.keys(check.table(least[name], what .. ": least: " .. name), { "t_reached", "digits" }, what .. ": least")
  end
end

-- false, true, or { [solver] = true }
local function read_quick(value, what)
  if type(value) ~= "table" then return value == true end
  local set = {}
  for _, name in ipairs(value) do set[check.text(name, what)] = true end
  return set
end

local function positive(value, default, what)
  if value == nil then return default end
  if type(value) ~= "number" or not (value > 0) then
    check.fail("%s: expected a positive number, got %s", what, check.shown(value))
  end
  return value
end

-- Checks what a user wrote and fills in what was left out.
function case.read(t)
  check.table(t, "stability: case")
  local what = ("stability: case %s"):format(check.text(t.name, "stability: name of a case"))
  check.keys(t, keys, what)
  if (t.make == nil) == (t.run == nil) then check.fail("%s: expected either make or run, a function", what) end
  if type(t.make or t.run) ~= "function" then
    check.fail("%s: %s: expected a function, got %s", what, t.make and "make" or "run", check.kind(t.make or t.run))
  end
  local budget = check.table(t.budget or {}, what .. ": budget")
  check.keys(budget, { "cpu", "wall", "memory" }, what .. ": budget")
  local expected = check.table(t.expected or {}, what .. ": expected")
  local least = check.table(t.least or {}, what .. ": least")
  check_expected(expected, what)
  check_least(least, what)
  return {
    name = t.name, group = check.text(t.group or "own", what .. ": group"), title = t.title or t.name,
    source = t.source or "", question = check.text(t.question or "simulate", what .. ": question"),
    quick = read_quick(t.quick, what .. ": quick"), make = t.make, run = t.run, over = t.over, also = t.also,
    cpu = positive(budget.cpu, 6, what .. ": budget: cpu"), wall = positive(budget.wall, nil, what .. ": budget: wall"),
    memory = positive(budget.memory, 1e9, what .. ": budget: memory"),
    references = read_references(t.reference, what .. ": reference"), expected = expected, least = least,
  }
end

-- The names under which something may be said about a combination, the most special first.
local function keys_of(c)
  local list = {}
  local function add(...)
    local words = {}
    for _, word in ipairs { ... } do
      if word ~= "" then words[#words + 1] = word end
    end
    list[#list + 1] = table.concat(words, " ")
  end
  local solver, arithmetic = c.solver or "", c.arithmetic or ""
  add(solver, arithmetic, c.options_text)
  add(solver, c.options_text)
  add(solver, arithmetic)
  add(solver)
  return list
end

local function lookup(t, c)
  for _, key in ipairs(keys_of(c)) do
    if t[key] ~= nil then return t[key] end
  end
  local known = shipped[c.solver or c.arithmetic] and (not c.arithmetic or shipped[c.arithmetic])
  if known or not (c.solver or c.arithmetic) then return t.default end
end

-- What is expected of a combination; nil: nothing is.
function case.expected(self, c) return lookup(self.expected, c) end
function case.least(self, c) return lookup(self.least, c) end

-- What nobody can mean: an expectation about a combination that the case is not run with.
function case.check_names(self, combinations)
  local known = { default = true }
  for _, c in ipairs(combinations) do
    for _, key in ipairs(keys_of(c)) do known[key] = true end
  end
  for _, list in ipairs { self.expected, self.least } do
    for _, key in ipairs(check.sorted(list)) do
      if not known[key] and not shipped[key:match "^%S+"] then
        check.fail("stability: case %s: nothing is called `%s`%s", self.name, key,
          check.suggest(key, check.sorted(known)))
      end
    end
  end
end

return case
