-- compare/csv.lua -- comparisons as CSV (RFC 4180): one line for each combination and result.
local core = require "ambit.core"
local evaluation = require "ambit.compare.evaluation"

local csv = {}

local columns = { "comparison", "verb", "place", "solver", "arithmetic", "options", "rigorous", "status", "reason",
  "t_reached", "result", "lo", "hi", "width", "width_max", "over_tightest", "over_sample", "over_sample_max", "error",
  "pareto", "partial", "seconds_run", "seconds_build", "repeats", "steps", "memory" }

-- those of a row that are written as they are
local plain = { "solver", "arithmetic", "status", "reason", "t_reached", "width_max", "over_tightest", "over_sample",
  "over_sample_max", "error", "seconds_run", "seconds_build", "repeats", "steps", "memory" }

local function cell(value)
  if value == nil then return "" end
  local text = math.type(value) == "float" and core.literal(value) or tostring(value)
  if text:find '[",\r\n]' then text = '"' .. text:gsub('"', '""') .. '"' end
  return text
end

local function line_of(fields)
  local cells = {}
  for i, name in ipairs(columns) do cells[i] = cell(fields[name]) end
  return table.concat(cells, ",") .. "\r\n"
end

local function options_text(options)
  local list = {}
  for i = 1, #options, 2 do list[#list + 1] = options[i] .. "=" .. options[i + 1] end
  return table.concat(list, " ")
end

local function fields_of(comparison, number, row)
  local fields = { comparison = number, verb = comparison.verb, place = comparison.place,
    options = options_text(row.options), rigorous = row.rigorous and "yes" or "no",
    pareto = row.pareto and "yes" or "no", partial = row.enclosures and (row.partial and "yes" or "no") }
  for _, key in ipairs(plain) do fields[key] = row[key] end
  return fields
end

-- The bounds of one result; the empty set has none.
local function add_result(fields, name, set, width)
  fields.result, fields.width, fields.lo, fields.hi = name, width, nil, nil
  if not set:is_empty() then fields.lo, fields.hi = set.lo, set.hi end
end

local function add_row(lines, comparison, number, row)
  local fields = fields_of(comparison, number, row)
  for i, set in ipairs(row.enclosures or {}) do
    add_result(fields, comparison.paths[i], set, row.widths[comparison.names[i]])
    fields.status, fields.reason = evaluation.status_of(set), nil
    lines[#lines + 1] = line_of(fields)
  end
  for _, name in ipairs(row.values and comparison.names or {}) do
    add_result(fields, name, row.values[name], row.widths[name])
    lines[#lines + 1] = line_of(fields)
  end
  if not row.enclosures and not row.values then lines[#lines + 1] = line_of(fields) end
end

function csv.text(list)
  local lines = { table.concat(columns, ",") .. "\r\n" }
  for number, comparison in ipairs(list) do
    for _, row in ipairs(comparison.rows) do add_row(lines, comparison, number, row) end
  end
  return table.concat(lines)
end

return csv
