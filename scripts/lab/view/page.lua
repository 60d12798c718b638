-- view/page.lua -- what is to be shown, as one HTML page that needs nothing but itself. Its parts are
-- scripts/lab/view/parts.
local core = require "ambit.core"
local html = require "ambit.report.html"
local json = require "ambit.report.json"
local parts = require "ambit.view.parts"
local provenance = require "ambit.provenance"

local page = {}

local scripts = { "geometry.js", "camera.js", "model.js", "drawing.js", "hands.js", "table.js", "player.js", "main.js" }

local function script()
  local list = {}
  for i, name in ipairs(scripts) do list[i] = parts[name] end
  return table.concat(list, "\n")
end

-- views: what view_data makes, in order
function page.of(views, scene)
  local content = json.encode { ambit = core.version, provenance = provenance.now(), scene = scene, views = views }
  local fill = { TITLE = html.text(views[1].title), STYLE = parts["view.css"], SCRIPT = script(), DATA = content,
    PROVENANCE = provenance.html() }
  return (parts["page.html"]:gsub("@(%u+)@", fill))
end

return page
