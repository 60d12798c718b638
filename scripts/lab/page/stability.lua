-- page/stability.lua -- the result of the stability suite as one HTML page: counts, a map of cases against solvers, and
-- for each case the table of its runs. All of it is there without scripts too; they filter and sort.
local columns = require "ambit.page.columns"
local document = require "ambit.page.document"
local html = require "ambit.report.html"
local map = require "ambit.page.stability_map"
local number = require "ambit.page.number"
local outcome = require "ambit.page.outcome"

local page = {}

local function field(name) return function(row) return row[name] end end

-- -- the runs of a case

-- How far it came, as a bar and in words.
local function reach_column()
  local function share(row)
    local reached, whole = row.t_reached, row.t_end
    if not (reached and whole) or reached ~= reached or whole == 0 then return nil end
    return math.max(0, math.min(1, reached / whole))
  end
  return { title = "time reached", kind = "number", value = field "t_reached",
    sort = function(row) return number.sort(share(row) or row.t_reached) end,
    cell = function(row)
      local part = share(row)
      local bar = part and html.tag("span", { class = "reach", ["aria-hidden"] = "true" },
        html.tag("i", { style = ("width: %.1f%%"):format(100 * part) })) or ""
      local text = number.plain(row.t_reached)
      return bar .. html.text(part and ("%s of %s"):format(text, number.plain(row.t_end)) or text)
    end }
end

local function badge_column(title, name, show)
  return { title = title, kind = "words", value = field(name), sort = function(row) return row[name] or "" end,
    cell = show }
end

-- The verdict, what changed, and what was expected.
local function verdict_badge(row)
  local expected = outcome.expected(row) or ""
  if row.verdict == "as expected" then
    return html.say("span", "quiet", "as expected" .. (row.least and ": " .. expected or ""))
  end
  return html.tag("span", { class = "badge " .. outcome.kind(row.verdict) }, "\u{25B2} ", html.text(row.verdict or ""))
    .. " " .. html.text(row.changed or "")
    .. (expected ~= "" and html.say("div", "quiet", "expected: " .. expected) or "")
end

local function run_columns()
  local numeric = columns.number
  return { columns.text("with", outcome.label),
    badge_column("outcome", "outcome", function(row) return outcome.badge(row.outcome) end),
    badge_column("verdict", "verdict", verdict_badge), reach_column(),
    numeric("width", field "width", number.up), numeric("digits right", field "digits", number.digits),
    numeric("CPU", field "seconds", number.seconds), numeric("steps", field "steps", number.count),
    numeric("memory", field "memory", number.memory), columns.text("reason", field "reason") }
end

local function strip(case)
  local parts = {}
  for i, row in ipairs(case.rows) do
    parts[i] = html.tag("span", { class = "run " .. outcome.kind(row.outcome) }, outcome.mark(row.outcome))
  end
  return html.tag("span", { class = "runs", ["aria-hidden"] = "true" }, table.concat(parts, " "))
end

local function needs_a_look(case)
  for _, row in ipairs(case.rows) do
    if row.verdict ~= "as expected" then return true end
  end
  return false
end

local function case_of(case, i)
  local title = case.title and case.title ~= "" and case.title or case.name
  local facts = { { "case", case.name }, { "question", case.question or "" } }
  if case.source and case.source ~= "" then facts[3] = { "source", case.source } end
  return html.tag("details", { class = "card case", id = "s" .. i, open = needs_a_look(case) or nil },
    html.tag("summary", {}, html.say("span", "title", title), " ", strip(case)), html.facts(facts),
    columns.table("runs of " .. title, columns.used(run_columns(), case.rows), case.rows, function(row, k)
      local attributes = map.attributes(case, row)
      attributes.id = ("r%d-%d"):format(i, k)
      return attributes
    end))
end

-- -- the whole

-- { { name, { numbers of the cases } }, ... }
local function groups_of(cases)
  local list, of = {}, {}
  for i, case in ipairs(cases) do
    local name = case.group or ""
    if not of[name] then
      of[name] = {}
      list[#list + 1] = { name, of[name] }
    end
    table.insert(of[name], i)
  end
  return list
end

local function counts(count, verdicts)
  local items = {}
  local function add(kind, n, mark, text, meaning)
    items[#items + 1] = html.tag("li", { class = "count " .. outcome.kind(kind), title = meaning },
      html.tag("b", {}, tostring(n)), html.tag("span", {}, mark, " ", html.text(text)))
  end
  for _, name in ipairs(outcome.names) do
    if count[name] then add(name, count[name], outcome.mark(name), name, outcome.meanings[name]) end
  end
  for _, name in ipairs { "changed", "better" } do
    if verdicts[name] then add(name, verdicts[name], "\u{25B2}", name, "not as expected") end
  end
  return html.tag("ul", { class = "counts" }, table.concat(items))
end

local function verdict_of_all(result, verdicts)
  local changed, better = verdicts.changed or 0, verdicts.better or 0
  local text = changed + better == 0 and "Every outcome is as expected."
    or ("%s not as expected%s."):format(number.of(changed + better, "outcome"),
      better > 0 and (", %d of them better"):format(better) or "")
  local parts = { html.say("p", changed + better == 0 and "good advice" or "note", text) }
  if result.interrupted then
    parts[2] = html.say("p", "note", "Interrupted: this is what was done until then.")
  end
  return table.concat(parts)
end

local function meanings()
  local items = {}
  for i, name in ipairs(outcome.names) do
    items[i] = html.tag("li", {}, html.tag("span", { class = "run " .. outcome.kind(name) }, outcome.mark(name)), " ",
      html.text(("%s: %s"):format(name, outcome.meanings[name])))
  end
  return html.tag("details", { class = "meanings" }, html.tag("summary", {}, "What the marks mean"),
    html.tag("ul", {}, table.concat(items)))
end

local filters = [[<div class="tools" id="filters" role="search" aria-label="which runs" hidden></div>]]

local function body_of(result)
  local count, verdicts = outcome.count(result.cases)
  local groups, parts = groups_of(result.cases), {}
  for _, group in ipairs(groups) do
    local list = {}
    for k, i in ipairs(group[2]) do list[k] = case_of(result.cases[i], i) end
    parts[#parts + 1] = html.tag("section", { class = "group-of-cases" }, html.tag("h2", {}, html.text(group[1])),
      table.concat(list, "\n"))
  end
  if #result.cases == 0 then return html.say("p", "note", "No case was run.") end
  local glance = html.card("glance", "Cases and solvers", meanings(), map.of(result.cases, groups))
  return html.tag("section", {}, verdict_of_all(result, verdicts), counts(count, verdicts), filters, glance)
    .. table.concat(parts, "\n")
end

local styles = { "page.css", "table.css", "stability.css" }
local scripts = { "parts.js", "sort.js", "stability.js" }

-- RESULT of suite.run -> HTML
function page.of(result)
  local _, _, total = outcome.count(result.cases)
  local subtitle = ("%s of %s, %s"):format(number.of(total, "run"), number.of(#result.cases, "case"),
    result.quick and "the quick part of the suite" or "the whole suite")
  local facts = { { "command", result.quick and "ambit stability --quick" or "ambit stability" } }
  if result.cpu_seconds then facts[2] = { "CPU time of all", number.seconds(result.cpu_seconds) } end
  return document.of { title = "Numerical stability", subtitle = subtitle, body = body_of(result), styles = styles,
    scripts = scripts, facts = facts }
end

return page
