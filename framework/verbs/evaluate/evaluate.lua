-- evaluate.lua -- ambit.evaluate { expression or table of them, at = { name = value }, arithmetic = "interval" }:
-- enclosures.
local binding = require "ambit.run.binding"
local check = require "ambit.check"
local core = require "ambit.core"
local option = require "ambit.option"
local partial = require "ambit.run.partial"
local session = require "ambit.session"
local shape = require "ambit.shape"

local verb = {}

-- The list entries of the verb's table: one is meant as it is, several as a list.
function verb.subject(t, what)
  local list = {}
  for i, value in ipairs(t) do list[i] = value end
  if #list == 0 then check.fail("%s: expected an expression, or a table of them, as the first entry", what) end
  return #list == 1 and list[1] or list
end

-- A result keeps its status out of pairs(): it is reached through the metatable, after what the shape itself offers.
function verb.with_status(value, facts)
  if type(value) ~= "table" then return value end
  local meta, old = { is_shape = true }, getmetatable(value) or {}
  for key, entry in pairs(old) do meta[key] = entry end
  local index = old.__index
  meta.__index = function(self, key)
    local found
    if type(index) == "function" then found = index(self, key) elseif index then found = index[key] end
    if found == nil then found = facts[key] end
    return found
  end
  return setmetatable(value, meta)
end

local function write_values(paths, results)
  if not core.recording() then return end
  for i, path in ipairs(paths) do
    local fields = { "name", path, "value", results[i] }
    if results[i].partial then fields[5], fields[6] = "partial", true end
    core.record("value", fields)
  end
end

-- Paths of the results for which holds(x), as a subject: "x, y: "; nil: of none.
local function subject_of(paths, results, holds)
  local list = {}
  for i, x in ipairs(results) do
    if holds(x) then list[#list + 1] = paths[i] end
  end
  if #list == 0 then return nil end
  local text = table.concat(list, ", ")
  return text == "" and "" or text .. ": "
end

-- What is known about the results: status, code and reason. blame: the operation that left its domain.
local function judge(paths, results, blame, rigorous, allowed)
  local facts = { status = "complete", code = "ok", reason = "", partial = false }
  local what = blame == "" and "it" or ("`%s`"):format(blame)
  local nowhere = rigorous and subject_of(paths, results, function(x) return x:is_empty() end)
  if nowhere then
    facts.status, facts.code = "impossible", "domain.undefined"
    facts.reason = ("%s%s is defined for none of the data"):format(nowhere, what)
  end
  local partly = subject_of(paths, results, function(x) return x.partial end)
  local why = partly and ("%s%s is undefined for part of the data, and the enclosure holds for the rest"):format(partly,
    what)
  return partial.judge(facts, why, allowed)
end

function verb.evaluate(t)
  check.table(t, "evaluate")
  check.keys(t, { "at", "arithmetic", "partial" }, "evaluate", #t)
  local allowed = partial.read(t, "evaluate")
  local expressions, paths, rebuild = shape.flatten(verb.subject(t, "evaluate"), "evaluate")
  local leaves, values = binding.resolve(t.at, expressions, "evaluate")
  local name, options = option.arithmetic(t.arithmetic == nil and core.default.ranges or t.arithmetic,
    "evaluate: arithmetic")
  session.ask { expressions = expressions, paths = paths, leaves = leaves, values = values, arithmetic = name }
  local results, report, blame, rigorous = core.evaluate { arithmetic = name, options = options,
    expressions = expressions, leaves = leaves, values = values }
  write_values(paths, results)
  local facts = judge(paths, results, blame, rigorous, allowed)
  facts.arithmetic, facts.cpu_seconds, facts.report = name, report.seconds_run, report
  session.finish("evaluate", facts, report, { "arithmetic", name, "options", options })
  return verb.with_status(rebuild(results), facts)
end

return verb
