-- suite/table.lua -- the result of `ambit stability` as tables: for a terminal, for a page of Markdown, as CSV.
local compare_table = require "ambit.compare.table"
local over = require "ambit.suite.over"

local suite_table = {}

local function number(x, format) return x and (format or "%.3g"):format(x) or "" end

local function reach(row)
  if not row.t_reached then return "" end
  return row.t_end and ("%.4g of %.4g"):format(row.t_reached, row.t_end) or ("%.4g"):format(row.t_reached)
end

local function memory(row) return row.memory and ("%.1f MB"):format(row.memory / 1e6) or "" end

local function remark(row)
  local parts = {}
  if row.verdict ~= "as expected" then
    parts[1] = row.verdict:upper() .. (row.changed and " (" .. row.changed .. ")" or "")
  end
  if row.reason then parts[#parts + 1] = row.reason end
  return table.concat(parts, ": ")
end

local columns = {
  { "with", function(row) return over.label { solver = row.solver, arithmetic = row.arithmetic,
    options_text = row.options } end, left = true },
  { "outcome", function(row) return row.outcome end, left = true },
  { "reached", reach },
  { "width", function(row) return number(row.width, "%.2e") end },
  { "digits", function(row) return number(row.digits, "%.1f") end },
  { "CPU", function(row) return compare_table.seconds(row.seconds) or "" end },
  { "steps", function(row) return number(row.steps, "%d") end },
  { "memory", memory },
  { "", remark, left = true },
}

local colours = { changed = "\27[31m", better = "\27[33m" }
local dim = { unable = "\27[36m", refused = "\27[36m", late = "\27[33m", ["out of memory"] = "\27[33m",
  computed = "\27[2m", proved = "\27[32m" }

local function cells_of(cases)
  local cells, rows = {}, {}
  for _, case in ipairs(cases) do
    for _, row in ipairs(case.rows) do
      local line = {}
      for k, column in ipairs(columns) do line[k] = column[2](row) end
      cells[#cells + 1], rows[#rows + 1] = line, row
    end
  end
  return cells, rows
end

local function groups_of(result)
  local order, groups = {}, {}
  for _, case in ipairs(result.cases) do
    if not groups[case.group] then
      order[#order + 1] = case.group
      groups[case.group] = {}
    end
    table.insert(groups[case.group], case)
  end
  return order, groups
end

-- Where a line is cut on a terminal; the reasons are whole in the files.
local function cut(line, room) return room and compare_table.short(line, room) or line end

local function headings()
  local list = {}
  for k, column in ipairs(columns) do list[k] = column[1] end
  return list
end

-- Lines grouped by group and case, in columns that are the same throughout. room: characters of a line, nil: any
function suite_table.text(result, coloured, room)
  local out = {}
  local order, groups = groups_of(result)
  local all = {}
  for _, group in ipairs(order) do table.move(groups[group], 1, #groups[group], #all + 1, all) end
  local cells, rows = cells_of(all)
  table.insert(cells, 1, headings())
  local lines, i = compare_table.aligned(cells, columns), 1
  for _, group in ipairs(order) do
    out[#out + 1] = ("%s\n  %s"):format(group:upper(), lines[1])
    for _, case in ipairs(groups[group]) do
      out[#out + 1] = ("%s: %s"):format(case.name, case.title)
      for _ = 1, #case.rows do
        local row = rows[i]
        i = i + 1
        local colour = coloured and (colours[row.verdict] or dim[row.outcome])
        local line = cut("  " .. lines[i], room)
        out[#out + 1] = colour and colour .. line .. "\27[0m" or line
      end
    end
    out[#out + 1] = ""
  end
  return table.concat(out, "\n") .. suite_table.summary(result)
end

-- "212 rows of 61 cases: 130 proved, 70 unable, ...; 0 changed; 83 s of CPU time"
function suite_table.summary(result)
  local count, n, parts = {}, 0, {}
  for _, case in ipairs(result.cases) do
    for _, row in ipairs(case.rows) do
      count[row.outcome] = (count[row.outcome] or 0) + 1
      n = n + 1
    end
  end
  for _, name in ipairs { "proved", "computed", "unable", "refused", "late", "out of memory", "crashed", "wrong" } do
    if count[name] then parts[#parts + 1] = ("%d %s"):format(count[name], name) end
  end
  return ("%d rows of %d cases: %s; %d changed; %.0f s of CPU time%s"):format(n, #result.cases,
    table.concat(parts, ", "), result.changed, result.cpu_seconds, result.interrupted and "; interrupted" or "")
end

-- What to write into the case where an expectation no longer holds; "" if all hold.
function suite_table.update(result)
  local lines = {}
  for _, case in ipairs(result.cases) do
    for _, row in ipairs(case.rows) do
      local fault = row.outcome == "wrong" or row.outcome == "crashed"
      if row.verdict ~= "as expected" then
        local label = over.label { solver = row.solver, arithmetic = row.arithmetic, options_text = row.options }
        local advice = fault and "a fault of Ambit, or of the reference"
          or row.expected == row.outcome and "keeps its outcome but not what it must reach: see `least` of the case"
          or ('if that is right, write expected = { ["%s"] = "%s" } in the case'):format(label, row.outcome)
        lines[#lines + 1] = ("%s, %s: %s (%s): %s"):format(case.name, label, row.outcome, row.changed or row.verdict,
          advice)
      end
    end
  end
  return table.concat(lines, "\n")
end

-- -- Markdown

local function escaped(text) return (text:gsub("|", "\\|"):gsub("[<>]", { ["<"] = "&lt;", [">"] = "&gt;" })) end

local function markdown_line(cells) return "| " .. table.concat(cells, " | ") .. " |" end

function suite_table.markdown(result)
  local out = {}
  local order, groups = groups_of(result)
  for _, group in ipairs(order) do
    out[#out + 1] = ("### %s\n"):format(group)
    out[#out + 1] = "| case | with | outcome | reached | width | digits | CPU | steps | reason |"
    out[#out + 1] = "|---|---|---|--:|--:|--:|--:|--:|---|"
    for _, case in ipairs(groups[group]) do
      for k, row in ipairs(case.rows) do
        local cells = { k == 1 and escaped(case.title) or "" }
        for i = 1, 7 do cells[i + 1] = escaped(columns[i][2](row)) end
        cells[#cells + 1] = escaped(remark(row))
        out[#out + 1] = markdown_line(cells)
      end
    end
    out[#out + 1] = ""
  end
  out[#out + 1] = suite_table.summary(result) .. "."
  return table.concat(out, "\n") .. "\n"
end

-- -- CSV (RFC 4180)

local fields = { "solver", "arithmetic", "options", "outcome", "expected", "verdict", "t_reached", "t_end", "width",
  "digits", "seconds", "steps", "memory", "reason" }

local function cell(value)
  if value == nil then return "" end
  local text = math.type(value) == "float" and ("%.17g"):format(value) or tostring(value)
  if text:find '[",\r\n]' then text = '"' .. text:gsub('"', '""') .. '"' end
  return text
end

function suite_table.csv(result)
  local lines = { "group,case," .. table.concat(fields, ",") }
  for _, case in ipairs(result.cases) do
    for _, row in ipairs(case.rows) do
      local cells = { cell(case.group), cell(case.name) }
      for _, field in ipairs(fields) do cells[#cells + 1] = cell(row[field]) end
      lines[#lines + 1] = table.concat(cells, ",")
    end
  end
  return table.concat(lines, "\r\n") .. "\r\n"
end

return suite_table
