-- page/outcome.lua -- how a run of the stability suite ended, as a mark and a word: never by colour alone.
local html = require "ambit.report.html"
local number = require "ambit.page.number"

local outcome = {}

-- The order in which they are counted.
outcome.names = { "proved", "computed", "unable", "refused", "late", "out of memory", "crashed", "wrong" }

local marks = { proved = "\u{2713}", computed = "\u{2248}", unable = "\u{25CB}", refused = "\u{2013}",
  late = "\u{2026}", ["out of memory"] = "\u{25AE}", crashed = "!", wrong = "\u{2717}" }

outcome.meanings = { proved = "proved to the end", computed = "came to the end, by a solver that proves nothing",
  unable = "could not prove it, and says so", refused = "does not take this question", late = "out of its time",
  ["out of memory"] = "out of its memory", crashed = "ended by a fault",
  wrong = "misses its reference, or is no number" }

function outcome.mark(name) return marks[name] or "?" end

-- As the class of an element.
function outcome.kind(name) return (name or ""):gsub("[^%w]", "-") end

function outcome.badge(name)
  return html.tag("span", { class = "badge " .. outcome.kind(name) }, outcome.mark(name), " ", html.text(name or ""))
end

-- "lohner interval, order = 20"
function outcome.label(row)
  local parts = {}
  for _, word in ipairs { row.solver or false, row.arithmetic or false } do
    if word and word ~= "" then parts[#parts + 1] = word end
  end
  local text = table.concat(parts, " ")
  if row.options and row.options ~= "" then text = text .. ", " .. row.options end
  return text
end

-- What was expected: "proved, to t = 10, 5 digits"
function outcome.expected(row)
  if not row.expected then return nil end
  local least, list = row.least or {}, { row.expected }
  if least.t_reached then list[#list + 1] = "to t = " .. number.plain(least.t_reached) end
  if least.digits then list[#list + 1] = number.plain(least.digits) .. " digits" end
  return table.concat(list, ", ")
end

-- { [outcome] = n }, those with a verdict
function outcome.count(cases)
  local count, verdicts, total = {}, {}, 0
  for _, case in ipairs(cases) do
    for _, row in ipairs(case.rows) do
      count[row.outcome] = (count[row.outcome] or 0) + 1
      verdicts[row.verdict or ""] = (verdicts[row.verdict or ""] or 0) + 1
      total = total + 1
    end
  end
  return count, verdicts, total
end

return outcome
