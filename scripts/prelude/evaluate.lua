-- evaluate.lua -- ambit.evaluate { expression or table of them, at = { name = value }, arithmetic = "interval" }:
-- enclosures.
local binding = require "ambit.binding"
local check = require "ambit.check"
local core = require "ambit.core"
local option = require "ambit.option"
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
  for i, path in ipairs(paths) do core.record("value", { "name", path, "value", results[i] }) end
end

function verb.evaluate(t)
  check.table(t, "evaluate")
  check.keys(t, { "at", "arithmetic" }, "evaluate", #t)
  local expressions, paths, rebuild = shape.flatten(verb.subject(t, "evaluate"), "evaluate")
  local leaves, values = binding.resolve(t.at, expressions, "evaluate")
  local name, options = option.arithmetic(t.arithmetic == nil and "interval" or t.arithmetic, "evaluate: arithmetic")
  session.ask { expressions = expressions, paths = paths, leaves = leaves, values = values, arithmetic = name }
  local results, report = core.evaluate(name, options, expressions, leaves, values)
  write_values(paths, results)
  local facts = { status = "complete", arithmetic = name, cpu_seconds = report.seconds_run, report = report }
  session.finish("evaluate", facts, report, { "arithmetic", name, "options", options })
  return verb.with_status(rebuild(results), facts)
end

return verb
