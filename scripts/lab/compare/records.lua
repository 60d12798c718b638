-- compare/records.lua -- a comparison as records: one `row` for each combination.
local core = require "ambit.core"

local records = {}

local plain = { "solver", "arithmetic", "options", "status", "reason", "t_reached", "width", "width_max",
  "over_tightest", "over_sample", "over_sample_max", "error", "seconds_run", "seconds_build", "repeats", "steps",
  "memory" }

-- The enclosures at the end, as { name, enclosure, ... }.
local function values_of(row, comparison)
  local values = {}
  for i, name in ipairs(comparison.paths or comparison.names) do
    values[2 * i - 1] = name
    values[2 * i] = row.enclosures and row.enclosures[i] or row.values[name]
  end
  return values
end

local function pairs_of(row, comparison, number)
  local list = {}
  local function add(key, value)
    if value ~= nil and value ~= "" then list[#list + 1], list[#list + 2] = key, value end
  end
  add("comparison", number)
  add("verb_compared", comparison.verb)
  add("place", comparison.place)
  for _, key in ipairs(plain) do add(key, row[key]) end
  add("rigorous", row.rigorous and "yes" or "no")
  add("partial", row.partial and "yes" or nil)
  add("pareto", row.pareto and "yes" or nil)
  if row.enclosures or row.values then add("values", values_of(row, comparison)) end
  return list
end

function records.write(comparison, number)
  if not core.recording() then return end
  for _, row in ipairs(comparison.rows) do core.record("row", pairs_of(row, comparison, number)) end
end

return records
