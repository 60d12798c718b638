-- report/html.lua -- pieces of HTML from texts that may hold any bytes.
local json = require "ambit.report.json"

local html = {}

local entities = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&#39;" }

-- A text on one line, of characters only.
function html.plain(text) return (json.clean(text):gsub("%c", " ")) end

-- The same as HTML, for the content of an element and for an attribute alike.
function html.text(text) return (html.plain(text):gsub("[&<>\"']", entities)) end

-- Elements with content that is HTML already, joined; attributes: { name = text or number, or true to set it }.
function html.tag(name, attributes, ...)
  local names, parts = {}, { "<", name }
  for key in pairs(attributes) do names[#names + 1] = key end
  table.sort(names)
  for _, key in ipairs(names) do
    local value = attributes[key]
    parts[#parts + 1] = value == true and " " .. key or (' %s="%s"'):format(key, html.text(tostring(value)))
  end
  parts[#parts + 1] = ">"
  for i = 1, select("#", ...) do parts[#parts + 1] = (select(i, ...)) end
  parts[#parts + 1] = ("</%s>"):format(name)
  return table.concat(parts)
end

-- An element that holds a text.
function html.say(name, kind, text) return html.tag(name, { class = kind }, html.text(text)) end

-- { { name, text }, ... } as a list of descriptions; nothing if it is empty.
function html.facts(list)
  if #list == 0 then return "" end
  local parts = {}
  for i, fact in ipairs(list) do
    parts[i] = html.tag("dt", {}, html.text(fact[1])) .. html.tag("dd", {}, html.text(fact[2]))
  end
  return html.tag("dl", { class = "facts" }, table.concat(parts))
end

-- A part of the page with a heading of its own.
function html.card(kind, title, ...)
  return html.tag("div", { class = "card " .. kind }, html.tag("h3", {}, html.text(title)), ...)
end

return html
