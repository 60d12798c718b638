-- compare/table.lua -- a comparison as an aligned table, and how numbers are shown in it.
local compare_table = {}

local widths_at_most = 3 -- results that get a column each

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

local function ratio(x) return number(x, x and x < 1000 and "%.4g" or "%.3g") end

local function remark(row)
  local list = {}
  if row.reason then list[1] = ("%s: %s"):format(row.status, (row.reason:gsub("%s*\n%s*", "; "))) end
  if row.rigorous == false then list[#list + 1] = "proves nothing" end
  if row.partial then list[#list + 1] = "the domain was left" end
  return table.concat(list, ", ")
end

local function width_columns(comparison)
  local columns, paths = {}, comparison.paths
  local function width(row, value) return number(row.rigorous and value or nil, "%.5g") end
  if #paths > widths_at_most then
    return { { "largest width", function(row) return width(row, row.width) end } }
  end
  for i, path in ipairs(paths) do
    local title = path == "" and "width" or "width of " .. path
    columns[i] = { title, function(row) return width(row, row.widths and row.widths[i]) end }
  end
  return columns
end

local function columns_of(comparison)
  local columns = { { "arithmetic", function(row) return row.label end, left = true } }
  table.move(width_columns(comparison), 1, widths_at_most, 2, columns)
  local function add(title, value, left) columns[#columns + 1] = { title, value, left = left } end
  add("/ tightest", function(row) return ratio(row.over_tightest) end)
  if comparison.sample then add("/ sampled", function(row) return ratio(row.over_sample) end) end
  add("run", function(row) return compare_table.seconds(row.seconds_run) end)
  add("build", function(row) return compare_table.seconds(row.seconds_build) end)
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

local colours = { failed = "\27[31m", skipped = "\27[33m", unbounded = "\27[33m", empty = "\27[33m" }

local function colour_of(row)
  if row.over_tightest == 1 then return "\27[32m" end
  return colours[row.status]
end

-- "3 results of 25 uncertain data in 61 operations"
function compare_table.size(comparison)
  local n, u = #comparison.paths, comparison.unknowns
  local text = n == 1 and "1 result" or ("%d results"):format(n)
  if u then text = text .. (" of %d uncertain %s"):format(u, u == 1 and "datum" or "data") end
  if u then text = text .. (" in %d operations"):format(comparison.instructions) end
  return text
end

-- Several lines, without a newline at the end; coloured for a terminal.
function compare_table.text(comparison, coloured)
  if #comparison.rows == 0 then return "compare: nothing was compared" end
  local columns, cells = columns_of(comparison), { {} }
  for k, column in ipairs(columns) do cells[1][k] = column[1] end
  for i, row in ipairs(comparison.rows) do
    cells[i + 1] = {}
    for k, column in ipairs(columns) do cells[i + 1][k] = column[2](row) end
  end
  local lines = compare_table.aligned(cells, columns)
  for i, row in ipairs(comparison.rows) do
    local colour = coloured and colour_of(row)
    if colour then lines[i + 1] = colour .. lines[i + 1] .. "\27[0m" end
  end
  if comparison.sample_problem then lines[#lines + 1] = "no samples: " .. comparison.sample_problem end
  if comparison.reason then lines[#lines + 1] = comparison.reason end
  return table.concat(lines, "\n")
end

return compare_table
