-- page/compare.lua -- comparisons as one HTML page: for each an advice, a diagram of work against precision, enclosures
-- over time, and the table of all combinations. The table and all texts are there without scripts too.
local columns = require "ambit.page.columns"
local compare_table = require "ambit.compare.table"
local compare_data = require "ambit.page.compare_data"
local document = require "ambit.page.document"
local html = require "ambit.report.html"
local number = require "ambit.page.number"
local ranges = require "ambit.page.ranges"

local page = {}

local marks = { complete = "\u{2713}", unable = "\u{25CB}", stopped = "\u{25A1}", skipped = "\u{2013}",
  refused = "\u{2013}" }

-- -- the table

local function label_column()
  return { title = "combination", kind = "words", value = function(row) return row.label end,
    sort = function(row) return row.label end,
    cell = function(row)
      local star = row.pareto and html.tag("abbr", { class = "star", title = "no other is both tighter and faster" },
        "\u{2605}") or ""
      return star .. html.text(row.label)
    end }
end

local function status_column()
  return { title = "status", kind = "words", value = function(row) return row.status end,
    sort = function(row) return row.status end,
    cell = function(row)
      local text = row.status .. (row.rigorous == false and row.status == "complete" and ", proves nothing" or "")
      return html.tag("span", { class = "badge " .. (row.rigorous == false and "plain" or row.status) },
        marks[row.status] or "\u{2717}", " ", html.text(text))
    end }
end

local function field(name) return function(row) return row[name] end end

local function proved(name) return function(row) return row.rigorous ~= false and row[name] or nil end end

-- What does not change over time has no end.
local function table_columns(over_time)
  local numeric = columns.number
  return { label_column(), status_column(),
    numeric(over_time and "final width" or "width", proved "width", number.up,
      over_time and "the largest over all names, at the last proved instant" or "the largest over all names"),
    numeric("largest width", proved "width_max", number.up, "over all names and instants"),
    numeric("/ tightest", proved "over_tightest", number.up, "width over that of the tightest combination"),
    numeric("/ sampled", proved "over_sample", number.up, "overestimation: width over that of the sampled hull"),
    numeric("/ sampled, worst", proved "over_sample_max", number.up, "overestimation at its worst instant"),
    numeric("true error", field "error", number.up, "largest distance from the reference"),
    numeric("CPU", field "seconds_run", number.seconds, "least of the repeats"),
    numeric("build", field "seconds_build", number.seconds, "CPU time to build graph and tape"),
    numeric("steps", field "steps", number.count), numeric("memory", field "memory", number.memory),
    numeric("time reached", field "t_reached", number.plain), numeric("repeats", field "repeats", number.count),
    columns.text("reason", field "reason") }
end

local function rows_table(comparison)
  local rows = comparison.rows
  if #rows == 0 then return html.say("p", "quiet", "No combination was run.") end
  local used = columns.used(table_columns(comparison.t ~= nil), rows)
  return columns.table("all combinations", used, rows, function(row, i)
    return { class = row.status == "complete" and "" or "failed", ["data-row"] = i - 1 }
  end)
end

-- Counters of work, which are the same on every machine.
local function work_table(comparison)
  local known, names, rows = {}, {}, {}
  for _, row in ipairs(comparison.rows) do
    if row.work then rows[#rows + 1] = row end
    for name, value in pairs(row.work or {}) do
      if math.type(value) and not known[name] and not name:find "seconds" then known[name] = true end
    end
  end
  for name in pairs(known) do names[#names + 1] = name end
  if #names == 0 then return "" end
  table.sort(names)
  local list = { columns.text("combination", field "label") }
  for _, name in ipairs(names) do
    list[#list + 1] = columns.number((name:gsub("_", " ")), function(row) return row.work[name] end, number.count)
  end
  return html.tag("details", { class = "card" }, html.tag("summary", {}, "Counted work, the same on every machine"),
    columns.table("counted work", list, rows))
end

-- -- texts

local function shown(value)
  if math.type(value) then return number.count(value) end
  if type(value) ~= "table" then return tostring(value) end
  local names, parts = {}, {}
  for name in pairs(value) do names[#names + 1] = name end
  table.sort(names, function(a, b) return tostring(a) < tostring(b) end)
  for i, name in ipairs(names) do
    parts[i] = (math.type(name) and "" or tostring(name) .. " = ") .. shown(value[name])
  end
  return table.concat(parts, ", ")
end

local function settings(comparison)
  local value, list = comparison.settings, {}
  if type(value) == "table" then
    local names = {}
    for name in pairs(value) do names[#names + 1] = name end
    table.sort(names, function(a, b) return tostring(a) < tostring(b) end)
    for i, name in ipairs(names) do list[i] = { tostring(name), shown(value[name]) } end
  elseif value then
    list[1] = { "settings", shown(value) }
  end
  local sample = comparison.sample
  if sample and sample.draws then list[#list + 1] = { "sampled hull", ("%s draws, %s failed"):format(
    number.count(sample.draws), number.count(sample.failed or 0)) } end
  local reference = comparison.reference
  if reference and reference.source then list[#list + 1] = { "reference", reference.source } end
  if comparison.cpu_seconds then list[#list + 1] = { "CPU time of all", number.seconds(comparison.cpu_seconds) } end
  return html.facts(list)
end

local function title_of(comparison)
  local title = comparison.title
  return title and title ~= "" and title or comparison.place or comparison.verb or "comparison"
end

local function advice_of(comparison)
  local advice = comparison.advice
  if type(advice) == "table" then advice = table.concat(advice, " ") end
  return advice ~= "" and advice or nil
end

local function subtitle(comparison)
  local list = { comparison.verb }
  if comparison.place and comparison.place ~= title_of(comparison) then list[#list + 1] = comparison.place end
  if comparison.t then
    list[#list + 1] = ("t from %s to %s s"):format(number.plain(comparison.t[1]), number.plain(comparison.t[2]))
  end
  list[#list + 1] = number.of(#comparison.rows, "combination")
  local names = {}
  for i, name in ipairs(comparison.names or {}) do names[i] = compare_table.name_of(name) end
  local some = table.concat(names, ", ", 1, math.min(#names, 8))
  list[#list + 1] = #names > 8 and ("%s and %d more"):format(some, #names - 8) or some ~= "" and some or nil
  return table.concat(list, " \u{00B7} ")
end

local function notes(comparison)
  local parts = {}
  if comparison.interrupted then
    parts[1] = html.say("p", "note", "Interrupted: this is what was done until then.")
  end
  if comparison.reason then parts[#parts + 1] = html.say("p", "note", comparison.reason) end
  local sample, reference = comparison.sample_problem, comparison.reference_problem
  if sample then parts[#parts + 1] = html.say("p", "quiet", "No samples: " .. sample) end
  if reference then parts[#parts + 1] = html.say("p", "quiet", "No reference: " .. reference) end
  return table.concat(parts)
end

-- -- sections

local without_scripts = html.tag("noscript", {}, html.say("p", "quiet",
  "The diagrams need JavaScript. The tables hold all their numbers."))

local function section(comparison, i)
  local advice = advice_of(comparison)
  return html.tag("section", { class = "comparison", id = "c" .. i, ["data-number"] = i - 1 },
    html.tag("h2", {}, html.text(title_of(comparison))), html.say("p", "quiet", subtitle(comparison)),
    advice and html.say("p", "advice", advice) or "", notes(comparison), without_scripts,
    html.tag("div", { class = "card diagram", hidden = true }),
    html.tag("div", { class = "card tracks", hidden = true }), ranges.of(comparison),
    html.card("all", "All combinations", rows_table(comparison)), work_table(comparison), settings(comparison))
end

local function complete(comparison)
  local count = 0
  for _, row in ipairs(comparison.rows) do if row.status == "complete" then count = count + 1 end end
  return count
end

local function contents(list)
  local items = {}
  for i, comparison in ipairs(list) do
    items[i] = html.tag("li", {}, html.tag("a", { href = "#c" .. i }, html.text(title_of(comparison))),
      html.say("span", "quiet", (" %d of %d complete"):format(complete(comparison), #comparison.rows)))
  end
  return html.tag("nav", { class = "card contents", ["aria-label"] = "comparisons" }, html.tag("ol", {},
    table.concat(items)))
end

local styles = { "uplot/uPlot.min.css", "page.css", "table.css", "plot.css", "ranges.css" }
local scripts = { "parts.js", "sort.js", "tip.js", "scale.js", "element.js", "diagram.js", "legend.js",
  "bands.js", "tracks.js", "compare.js" }

-- comparisons, and the name of the scene -> HTML
function page.of(comparisons, scene)
  local sections, rows, data = {}, 0, {}
  for i, comparison in ipairs(comparisons) do
    sections[i], data[i], rows = section(comparison, i), compare_data.of(comparison), rows + #comparison.rows
  end
  local body = (#comparisons > 1 and contents(comparisons) or "") .. table.concat(sections, "\n")
  if #comparisons == 0 then body = html.say("p", "note", "Nothing was compared.") end
  return document.of { title = "Comparison of " .. scene, subtitle = ("%s, %s"):format(
    number.of(#comparisons, "comparison"), number.of(rows, "combination")), body = body, styles = styles,
    scripts = scripts, library = { "uplot/LICENSE", "uplot/uPlot.iife.min.js" }, data = { comparisons = data },
    facts = { { "command", "ambit compare " .. scene } } }
end

return page
