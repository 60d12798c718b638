-- page/plot.lua -- quantities of a run as one HTML page: plots over time to point at, or the picture of a phase plane,
-- and a table of the limits.
local compare_data = require "ambit.page.compare_data"
local document = require "ambit.page.document"
local html = require "ambit.report.html"
local picture = require "ambit.plot.picture"

local page = {}

local words = { holds = "holds at all times, proved", fails = "fails, proved", undecided = "not decided" }

-- As one combination of a comparison, for the plots over time.
local function data_of(plot)
  local names, units, track = {}, {}, { t = plot.course.t, lo = {}, hi = {}, tube = { lo = {}, hi = {} } }
  for k, q in ipairs(plot.quantities) do
    local of = plot.course[k]
    names[k], units[k] = q.name, q.unit ~= "1" and q.unit or ""
    track.lo[k], track.hi[k], track.tube.lo[k], track.tube.hi[k] = of.lo, of.hi, of.tube.lo, of.tube.hi
  end
  local hull = plot.hull and { t = plot.hull.t, lo = {}, hi = {}, error = {} }
  for k in ipairs(hull and names or {}) do
    local place = plot.hull.k[k]
    if place then hull.lo[k], hull.hi[k] = plot.hull.lo[place], plot.hull.hi[place] end
  end
  local row = { label = plot.run.solver, status = plot.run.status, rigorous = plot.proved, track = track }
  return compare_data.of { names = names, units = units, rows = { row }, t = plot.course.t, sample = hull }
end

local function limits_of(plot)
  local facts = {}
  for k, q in ipairs(plot.quantities) do
    local l = plot.limits[k]
    if l then
      facts[#facts + 1] = { q.name, ("%s to %s %s: %s"):format(l.lo and ("%.6g"):format(l.lo) or "-\u{221E}",
        l.hi and ("%.6g"):format(l.hi) or "\u{221E}", q.unit, words[plot.verdicts[q.name]]) }
    end
  end
  return #facts > 0 and html.card("limits", "Limits", html.facts(facts)) or ""
end

function page.of(plot)
  local notes = html.say("p", "quiet", table.concat(picture.legend(plot), "; "))
  local drawn = plot.against and html.card("picture", "Phase plane", picture.text(plot, true))
    or html.tag("div", { class = "card tracks", id = "over-time" })
  local without = html.tag("noscript", {}, html.say("p", "quiet", "The plots need JavaScript."))
  return document.of { title = plot.title, subtitle = tostring(plot.run), body = notes .. limits_of(plot) .. drawn
    .. without, styles = { "uplot/uPlot.min.css", "page.css", "table.css", "plot.css" },
    scripts = { "parts.js", "scale.js", "element.js", "legend.js", "bands.js", "tracks.js", "over_time.js" },
    library = { "uplot/LICENSE", "uplot/uPlot.iife.min.js" }, data = data_of(plot),
    facts = { { "solver", ("%s over %s"):format(plot.run.solver, plot.run.arithmetic) },
      { "steps", tostring(plot.run.step_count) } } }
end

return page
