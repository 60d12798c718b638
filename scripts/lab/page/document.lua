-- page/document.lua -- a report as one HTML page that needs nothing but itself. Its parts are scripts/lab/page/parts.
local html = require "ambit.report.html"
local json = require "ambit.report.json"
local machine = require "ambit.page.machine"
local parts = require "ambit.page.parts"
local provenance = require "ambit.provenance"

local document = {}

local function joined(names)
  local list = {}
  for i, name in ipairs(names) do list[i] = assert(parts[name], name) end
  return table.concat(list, "\n")
end

-- What others wrote, with the terms under which it may be passed on.
local function library(names)
  return names and ("/*\n%s*/\n%s"):format(parts[names[1]], parts[names[2]]) or ""
end

-- page: { title, subtitle, body = HTML, data = for the scripts, or nil, styles, scripts = names of parts,
-- library = { license, text } names of parts, or nil, facts = { { name, text }, ... } for the foot }
function document.of(page)
  local facts = table.move(page.facts, 1, #page.facts, 1, {})
  local fill = { TITLE = html.text(page.title), SUBTITLE = html.text(page.subtitle), BODY = page.body,
    PROVENANCE = provenance.html(),
    STYLE = joined(page.styles), DARK = parts["dark.css"], SCHEME = parts["scheme.js"],
    LIBRARY = library(page.library), SCRIPT = joined(page.scripts), DATA = json.encode(page.data or {}),
    FACTS = html.facts(table.move(machine.facts(), 1, 3, #facts + 1, facts)) }
  return (parts["page.html"]:gsub("@(%u+)@", fill))
end

return document
