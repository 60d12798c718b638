-- page/columns.lua -- rows as an HTML table that can be read without scripts, and sorted with them.
local html = require "ambit.report.html"
local number = require "ambit.page.number"

local columns = {}

-- A column of numbers; show(x) -> text.
function columns.number(title, value, show, hint)
  return { title = title, hint = hint, value = value, kind = "number",
    cell = function(row) return html.text(show(value(row))) end,
    sort = function(row) return number.sort(value(row)) end }
end

-- A column of texts.
function columns.text(title, value, hint)
  return { title = title, hint = hint, value = value, kind = "words",
    cell = function(row) return html.text(value(row) or "") end, sort = function(row) return value(row) or "" end }
end

-- Those in which at least one row has something; a number that is none is something.
function columns.used(list, rows)
  local used = {}
  for _, column in ipairs(list) do
    for _, row in ipairs(rows) do
      if column.value(row) ~= nil then
        used[#used + 1] = column
        break
      end
    end
  end
  return used
end

local function head(list)
  local cells = {}
  for i, column in ipairs(list) do
    cells[i] = html.tag("th", { scope = "col", class = column.kind, title = column.hint }, html.text(column.title))
  end
  return html.tag("thead", {}, html.tag("tr", {}, table.concat(cells)))
end

local function line(list, row, attributes)
  local cells = {}
  for i, column in ipairs(list) do
    local first = i == 1
    cells[i] = html.tag(first and "th" or "td", { class = column.kind, scope = first and "row" or nil,
      ["data-sort"] = column.sort(row) }, column.cell(row))
  end
  return html.tag("tr", attributes, table.concat(cells))
end

-- The first column names the row; attributes(row, i) -> those of the row, or nil. name: what the table is called.
function columns.table(name, list, rows, attributes)
  local lines = {}
  for i, row in ipairs(rows) do lines[i] = line(list, row, attributes and attributes(row, i) or {}) end
  return html.tag("div", { class = "scroll", role = "region", tabindex = 0, ["aria-label"] = name },
    html.tag("table", { class = "sortable" }, head(list), html.tag("tbody", {}, table.concat(lines, "\n"))))
end

return columns
