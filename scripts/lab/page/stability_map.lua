-- page/stability_map.lua -- cases against solvers, one mark for each run: the whole suite at a glance.
local html = require "ambit.report.html"
local outcome = require "ambit.page.outcome"

local map = {}

local function column_of(row) return (row.solver or "") .. "\0" .. (row.arithmetic or "") end

-- Solvers with their arithmetics, those of one solver side by side, in the order in which they come.
local function columns_of(cases)
  local solvers, of = {}, {}
  for _, case in ipairs(cases) do
    for _, row in ipairs(case.rows) do
      local solver, key = row.solver or "", column_of(row)
      if not of[solver] then
        solvers[#solvers + 1] = solver
        of[solver] = {}
      end
      if not of[solver][key] then
        of[solver][key] = true
        table.insert(of[solver], { key = key, solver = solver, arithmetic = row.arithmetic or "" })
      end
    end
  end
  local list = {}
  for _, solver in ipairs(solvers) do table.move(of[solver], 1, #of[solver], #list + 1, list) end
  return list
end

local function head(list)
  local cells = { html.tag("th", { scope = "col" }, "case") }
  for _, column in ipairs(list) do
    cells[#cells + 1] = html.tag("th", { scope = "col", class = "column" }, html.text(column.solver), "<br>",
      html.text(column.arithmetic))
  end
  return html.tag("thead", {}, html.tag("tr", {}, table.concat(cells)))
end

-- Attributes by which the filters find a run, here and in the tables of the cases.
function map.attributes(case, row)
  return { ["data-group"] = case.group, ["data-solver"] = row.solver or "", ["data-arithmetic"] = row.arithmetic or "",
    ["data-outcome"] = row.outcome, ["data-verdict"] = row.verdict or "" }
end

local function mark(case, row, address)
  local verdict = row.verdict ~= "as expected" and row.verdict or nil
  local text = ("%s: %s%s"):format(outcome.label(row), row.outcome, verdict and ", " .. verdict or "")
  local attributes = map.attributes(case, row)
  attributes.href, attributes.title, attributes["aria-label"] = "#" .. address, text, text
  attributes.class = ("run %s%s"):format(outcome.kind(row.outcome), verdict and " " .. outcome.kind(verdict) or "")
  return html.tag("a", attributes, outcome.mark(row.outcome))
end

local function line(list, case, i)
  local cells = {}
  for k, column in ipairs(list) do
    local marks = {}
    for number, row in ipairs(case.rows) do
      if column_of(row) == column.key then marks[#marks + 1] = mark(case, row, ("r%d-%d"):format(i, number)) end
    end
    cells[k] = html.tag("td", {}, table.concat(marks, " "))
  end
  local name = html.tag("a", { href = "#s" .. i, title = case.title }, html.text(case.name))
  return html.tag("tr", {}, html.tag("th", { scope = "row" }, name), table.concat(cells))
end

-- cases in groups: { { name, { number, ... } }, ... }
function map.of(cases, groups)
  local list, bodies = columns_of(cases), {}
  for g, group in ipairs(groups) do
    local lines = {}
    for k, i in ipairs(group[2]) do lines[k] = line(list, cases[i], i) end
    local title = html.tag("th", { scope = "rowgroup", colspan = #list + 1, class = "group-name" }, html.text(group[1]))
    bodies[g] = html.tag("tbody", {}, html.tag("tr", { class = "group-line" }, title), table.concat(lines, "\n"))
  end
  return html.tag("div", { class = "scroll", role = "region", tabindex = 0, ["aria-label"] = "cases and solvers" },
    html.tag("table", { id = "map" }, head(list), table.concat(bodies, "\n")))
end

return map
