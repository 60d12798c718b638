-- compare/table.lua -- a comparison as an aligned table, and how numbers are shown in it.
local report_number = require "ambit.report.number"

local compare_table = {}

local widths_at_most = 3 -- results that get a column each
local page = 120         -- characters across

-- What a result is called: alone, it has no name.
function compare_table.name_of(path) return path == "" and "the value" or path end

local function number(x, format)
  if x == nil then return "" end
  if x ~= x or x == math.huge then return "inf" end
  return (format):format(x)
end

-- 1.2e-6 -> "1.20 µs"
function compare_table.seconds(s, format)
  if s == nil then return "" end
  local units = { { 1, "s" }, { 1e-3, "ms" }, { 1e-6, "µs" }, { 1e-9, "ns" } }
  for _, unit in ipairs(units) do
    if s >= unit[1] or unit[1] == 1e-9 then return (format or "%.3g"):format(s / unit[1]) .. " " .. unit[2] end
  end
end

-- 24636000 -> "24.6 MB"
function compare_table.memory(bytes)
  if bytes == nil then return "" end
  return bytes < 1e6 and ("%.3g kB"):format(bytes / 1e3) or ("%.3g MB"):format(bytes / 1e6)
end

local function ratio(x) return number(x, x and x < 1000 and "%.4g" or "%.3g") end

-- Rounded up: what is said of an enclosure stays true.
local function tight(x, digits)
  if x == nil then return "" end
  return (x ~= x or x == math.huge) and "inf" or report_number.up(x, digits or 3)
end

local function remark(row)
  local list = {}
  if row.reason then
    list[1] = ("%s: %s"):format(row.status, (row.reason:gsub("%s*\n%s*", "; ")))
  elseif row.status ~= "complete" then
    list[1] = row.status
  end
  if row.rigorous == false and row.seconds_run then list[#list + 1] = "proves nothing" end
  if row.partial then list[#list + 1] = "the domain was left" end
  return table.concat(list, ", ")
end

local function width_columns(comparison)
  local columns, names = {}, comparison.names
  local function width(row, value) return tight(row.rigorous and value or nil, 5) end
  if #names > widths_at_most then
    return { { "largest width", function(row) return width(row, row.width) end } }
  end
  for i, name in ipairs(names) do
    local title = comparison.paths[i] == "" and "width" or "width of " .. name
    columns[i] = { title, function(row) return width(row, row.widths and row.widths[name]) end }
  end
  return columns
end

local function evaluation_columns(comparison, add)
  for _, column in ipairs(width_columns(comparison)) do add(column[1], column[2]) end
  add("/ tightest", function(row) return ratio(row.over_tightest) end)
  if comparison.sample then add("/ sampled", function(row) return ratio(row.over_sample) end) end
  add("run", function(row) return compare_table.seconds(row.seconds_run) end)
  add("build", function(row) return compare_table.seconds(row.seconds_build) end)
end

local function simulation_columns(comparison, add)
  local function proved(key)
    return function(row) return tight(row.rigorous and row[key] or nil) end
  end
  add("to t", function(row) return row.t_reached and ("%.4g"):format(row.t_reached) or "" end)
  add("width", proved "width")
  add("widest", proved "width_max")
  if comparison.sample then add("/ sampled", function(row) return ratio(row.over_sample) end) end
  if comparison.reference then add("error", function(row) return tight(row.error) end) end
  add("CPU", function(row) return compare_table.seconds(row.seconds_run) end)
  add("steps", function(row) return row.steps and ("%d"):format(row.steps) or "" end)
  add("memory", function(row) return compare_table.memory(row.memory) end)
end

-- On the Pareto front there is a star.
local function columns_of(comparison)
  local columns = {}
  local function add(title, value, left) columns[#columns + 1] = { title, value, left = left } end
  add("", function(row) return row.pareto and "*" or "" end, true)
  add(comparison.verb == "simulate" and "combination" or "arithmetic", function(row) return row.label end, true)
  if comparison.verb == "simulate" then
    simulation_columns(comparison, add)
  else
    evaluation_columns(comparison, add)
  end
  add("", remark, true)
  return columns
end

-- Characters, or bytes where the text is no UTF-8: the names of results are the scene's, whatever bytes they have.
function compare_table.length(text) return utf8.len(text) or #text end

-- The first so many characters; "..." where some are missing.
function compare_table.short(text, room)
  if compare_table.length(text) <= room then return text end
  local cut = utf8.len(text) and utf8.offset(text, math.max(room - 2, 1)) or math.max(room - 2, 1)
  return text:sub(1, cut - 1) .. "..."
end

local function pad(text, width, left)
  local space = (" "):rep(width - compare_table.length(text))
  return left and text .. space or space .. text
end

-- Rows of texts -> lines in columns, each to the right unless columns[k].left.
function compare_table.aligned(cells, columns)
  local widths, lines = {}, {}
  for _, line in ipairs(cells) do
    for k, text in ipairs(line) do widths[k] = math.max(widths[k] or 0, compare_table.length(text)) end
  end
  for i, line in ipairs(cells) do
    local padded = {}
    for k, text in ipairs(line) do padded[k] = pad(text, widths[k], columns[k].left) end
    lines[i] = table.concat(padded, "  "):gsub("%s+$", "")
  end
  return lines
end

local colours = { failed = "\27[31m", crashed = "\27[31m", refused = "\27[33m", skipped = "\27[33m",
  unbounded = "\27[33m", empty = "\27[33m", unable = "\27[33m", stopped = "\27[33m", late = "\27[33m",
  ["out of memory"] = "\27[33m" }

local function colour_of(row)
  if row.pareto then return "\27[32m" end
  return colours[row.status]
end

local function count(n, one, many) return ("%d %s"):format(n, n == 1 and one or many) end

-- "3 results of 25 uncertain data in 61 operations"; "4 states of 1 uncertain datum from t = 0 to 3"
function compare_table.size(comparison)
  local n, u = #comparison.names, comparison.unknowns
  local text = comparison.verb == "simulate" and count(n, "state", "states") or count(n, "result", "results")
  if u then text = ("%s of %s"):format(text, count(u, "uncertain datum", "uncertain data")) end
  if comparison.t then
    return ("%s from t = %.6g to %.6g"):format(text, comparison.t[1], comparison.t[2])
  end
  if u then text = ("%s in %d operations"):format(text, comparison.instructions) end
  return text
end

-- A text in lines of at most so many characters, broken between words; lines after the first are indented.
function compare_table.wrapped(text, room)
  local lines, line = {}, nil
  for word in text:gmatch "%S+" do
    if line and compare_table.length(line) + 1 + compare_table.length(word) > room then
      lines[#lines + 1], line = line, "    " .. word
    else
      line = line and line .. " " .. word or word
    end
  end
  lines[#lines + 1] = line
  return lines
end

-- What is said of several rows with other numbers is said once, of the first of them.
local function joined(notes)
  local list, place = {}, {}
  for _, row in ipairs(notes) do
    local text = remark(row)
    local kind = text:gsub("[%d.]+", "#")
    local known = place[kind] and list[place[kind]]
    if known then
      known.others[#known.others + 1] = row.label
    else
      list[#list + 1] = { label = row.label, others = {}, text = text }
      place[kind] = #list
    end
  end
  for i, entry in ipairs(list) do
    local others = #entry.others > 0 and (" (and so %s)"):format(table.concat(entry.others, ", ")) or ""
    list[i] = ("%s: %s%s"):format(entry.label, entry.text, others)
  end
  return list
end

local function remarks(comparison, notes)
  local list = joined(notes)
  local function add(format, value) if value then list[#list + 1] = format:format(value) end end
  add("no samples: %s", comparison.sample_problem)
  add("errors are distances from %s", comparison.reference and comparison.reference.source)
  add("%s", comparison.reference_problem)
  add("%s", comparison.reason)
  add("%s", comparison.advice)
  return list
end

-- Several lines, without a newline at the end; coloured for a terminal.
function compare_table.text(comparison, coloured)
  if #comparison.rows == 0 then return "compare: nothing was compared" end
  local columns, cells, notes = columns_of(comparison), { {} }, {}
  for k, column in ipairs(columns) do cells[1][k] = column[1] end
  for i, row in ipairs(comparison.rows) do
    cells[i + 1] = {}
    for k, column in ipairs(columns) do cells[i + 1][k] = column[2](row) end
  end
  local lines = compare_table.aligned(cells, columns)
  for i, row in ipairs(comparison.rows) do
    if compare_table.length(lines[i + 1]) > page then
      cells[i + 1][#columns] = row.status ~= "complete" and row.status or "" -- all of the remark goes below
      notes[#notes + 1] = row
    end
  end
  lines = compare_table.aligned(cells, columns)
  for i, row in ipairs(comparison.rows) do
    lines[i + 1] = compare_table.short(lines[i + 1], page)
    local colour = coloured and colour_of(row)
    if colour then lines[i + 1] = colour .. lines[i + 1] .. "\27[0m" end
  end
  for _, note in ipairs(remarks(comparison, notes)) do
    table.move(compare_table.wrapped(note, page), 1, 1000, #lines + 1, lines)
  end
  return table.concat(lines, "\n")
end

return compare_table
