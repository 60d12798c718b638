-- compare/picture.lua -- comparisons as an SVG file: error or width across (of several results: their largest
-- overestimation, since widths of different quantities do not compare), CPU time up, both logarithmic; one panel for
-- each comparison, one colour and marker for each method, its orders joined by a line. What cannot be drawn is listed
-- below.
local compare_label = require "ambit.compare.label"
local compare_table = require "ambit.compare.table"
local compare_axis = require "ambit.report.axis"
local drawn = require "ambit.compare.drawn"
local svg = require "ambit.report.svg"

local picture = {}

local panels_at_most = 6
local line_height = 17 -- pixels
local grey = "#888888"

-- -- layout, in pixels from the left and from the bottom

local function layout(comparisons, styles, notes)
  local n = #comparisons
  local columns = n == 1 and 1 or 2
  local rows = (n + columns - 1) // columns
  local l = { width = n == 1 and 900 or 1240, columns = columns, rows = rows }
  l.panel_width, l.panel_height = l.width // columns, n == 1 and 480 or 410
  l.legend_columns = math.max(1, (l.width - 60) // l.panel_width > 1 and 4 or 3)
  l.legend_rows = (#styles + 2 + l.legend_columns - 1) // l.legend_columns
  l.head = 44 + l.legend_rows * 20
  l.foot = #notes > 0 and 22 + #notes * line_height or 8
  l.height = l.head + rows * l.panel_height + l.foot
  return l
end

-- The frame of panel i: pixels from the left and from the bottom.
local function frame_of(l, i)
  local column, row = (i - 1) % l.columns, (i - 1) // l.columns
  local left = column * l.panel_width
  local top = l.height - l.head - row * l.panel_height
  return { left = left + 98, right = left + l.panel_width - 28, top = top - 34, bottom = top - l.panel_height + 68 }
end

-- -- writing: `draw` is the canvas and the layout

-- The middle of its height at y.
local function text_at(draw, x, y, text, room, look)
  draw.canvas:text(x, draw.layout.height - y + 4, text, room, look)
end

local function line(draw, x1, y1, x2, y2, colour, dash)
  local height = draw.layout.height
  draw.canvas:line({ { x1, height - y1 }, { x2, height - y2 } }, colour, dash)
end

local HULL, REFERENCE = 3, 2 -- dashes

local function write_legend(draw, styles, has)
  local l, entries = draw.layout, {}
  for _, s in ipairs(styles) do entries[#entries + 1] = { s.name, s.colour, s.dash, s } end
  if has.reference then
    entries[#entries + 1] = { ("time of %s, proves nothing"):format(has.reference), grey, REFERENCE }
  end
  if has.sample then entries[#entries + 1] = { "sampled: the inner estimate", grey, HULL } end
  local step = (l.width - 60) / l.legend_columns
  for i, entry in ipairs(entries) do
    local x = 40 + (i - 1) % l.legend_columns * step
    local y = l.height - 50 - (i - 1) // l.legend_columns * 20
    if not entry[4] or entry[4].axis then line(draw, x, y, x + 28, y, entry[2], entry[3]) end
    if entry[4] then draw.canvas:marker(entry[4].marker, x + 14, l.height - y, entry[2]) end
    text_at(draw, x + 36, y, entry[1], step - 44)
  end
end

local function write_head(draw, title, styles, notes, has)
  local l = draw.layout
  text_at(draw, l.width / 2, l.height - 20, title, l.width - 40, { anchor = "middle", class = "title" })
  write_legend(draw, styles, has)
  if #notes == 0 then return end
  text_at(draw, 24, l.foot - 14, "not drawn:", 200, { class = "small" })
  for i, note in ipairs(notes) do
    text_at(draw, 36, l.foot - 14 - i * line_height, note, 1.04 * (l.width - 60), { class = "small" })
  end
end

local function ranges_of(families, key, inner, reference)
  local widths, times = {}, {}
  for _, family in ipairs(families) do
    for _, row in ipairs(family) do
      widths[#widths + 1], times[#times + 1] = row[key], row.seconds_run
    end
  end
  widths[#widths + 1] = inner
  if reference then times[#times + 1] = reference.seconds_run end
  return compare_axis.range(widths, 1.2), compare_axis.range(times, 10)
end

local function time_text(v)
  return compare_table.seconds(v * (1 + 1e-12), "%.4g")
end

local function write_axes(draw, frame, x, y, title)
  local canvas, height = draw.canvas, draw.layout.height
  for _, v in ipairs(x.ticks) do
    local at = compare_axis.pixel(x, v, frame.left, frame.right)
    canvas:rule(at, height - frame.bottom, at, height - frame.top, "grid")
    text_at(draw, at, frame.bottom - 18, ("%.6g"):format(v), 80, { anchor = "middle", class = "small" })
  end
  for _, v in ipairs(y.ticks) do
    local at = compare_axis.pixel(y, v, frame.bottom, frame.top)
    canvas:rule(frame.left, height - at, frame.right, height - at, "grid")
    text_at(draw, frame.left - 8, at, time_text(v), 80, { anchor = "end", class = "small" })
  end
  canvas:rule(frame.left, height - frame.bottom, frame.left, height - frame.top, "axis")
  canvas:rule(frame.left, height - frame.bottom, frame.right, height - frame.bottom, "axis")
  text_at(draw, (frame.left + frame.right) / 2, frame.bottom - 44, title, frame.right - frame.left + 60,
    { anchor = "middle" })
  text_at(draw, frame.left - 76, (frame.bottom + frame.top) / 2, "CPU time of one run", 300,
    { anchor = "middle", turned = true })
end

local function write_title(draw, frame, comparison, number)
  local title = (number and ("%d. "):format(number) or "") .. compare_table.size(comparison)
  if comparison.place and comparison.place ~= "" then title = title .. ", " .. comparison.place:match "[^/]*$" end
  text_at(draw, (frame.left + frame.right) / 2, frame.top + 16, title, frame.right - frame.left,
    { anchor = "middle" })
end

-- Lines through the whole panel: the time of what proves nothing, the samples.
local function write_references(draw, frame, x, y, reference, inner)
  if reference then
    local at = compare_axis.pixel(y, reference.seconds_run, frame.bottom, frame.top)
    line(draw, frame.left, at, frame.right, at, grey, REFERENCE)
  end
  if inner then
    local at = compare_axis.pixel(x, inner, frame.left, frame.right)
    line(draw, at, frame.bottom, at, frame.top, grey, HULL)
  end
end

-- Appends the points of a family in pixels, each with the one before it.
local function add_points(points, family, key, colour, x, y, frame)
  local before
  for _, row in ipairs(family) do
    before = { x = compare_axis.pixel(x, row[key], frame.left, frame.right),
      y = compare_axis.pixel(y, row.seconds_run, frame.bottom, frame.top), text = row.axis and row.value or nil,
      colour = colour, before = before }
    points[#points + 1] = before
  end
end

local function write_family(draw, points, first, style)
  local path, height = {}, draw.layout.height
  for i = first, #points do path[#path + 1] = { points[i].x, height - points[i].y } end
  if #path > 1 then draw.canvas:line(path, style.colour, style.dash) end
  for _, p in ipairs(path) do draw.canvas:marker(style.marker, p[1], p[2], style.colour) end
end

local function write_families(draw, families, key, styles, x, y, frame)
  local points = {}
  for _, family in ipairs(families) do
    local style, first = styles[family[1].family], #points + 1
    add_points(points, family, key, style.colour, x, y, frame)
    write_family(draw, points, first, style)
  end
  for _, label in ipairs(compare_label.place(points, frame)) do
    text_at(draw, label.x, label.y, label.text, 200, { anchor = "middle", class = "tiny", colour = label.colour })
  end
  if #families == 0 then
    text_at(draw, (frame.left + frame.right) / 2, (frame.bottom + frame.top) / 2,
      "no enclosure with a finite width above zero", 400, { anchor = "middle" })
  end
end

local function write_panel(draw, comparison, i, many, styles)
  local key, title, inner = drawn.measure(comparison)
  if inner and not compare_axis.on_axis(inner) then inner = nil end
  local families, reference = drawn.families(comparison, key), drawn.reference(comparison)
  local frame = frame_of(draw.layout, i)
  local x, y = ranges_of(families, key, inner, reference)
  write_axes(draw, frame, x, y, title)
  write_title(draw, frame, comparison, many and i)
  write_references(draw, frame, x, y, reference, inner)
  write_families(draw, families, key, styles, x, y, frame)
end

local function legend_of(comparisons)
  local has = {}
  for _, comparison in ipairs(comparisons) do
    local reference = drawn.reference(comparison)
    has.reference = has.reference or reference and (reference.solver or reference.arithmetic)
    local _, _, inner = drawn.measure(comparison)
    has.sample = has.sample or inner and inner > 0
  end
  return has
end

-- What goes across, in one word for all panels.
function picture.subject(comparisons)
  local words = {}
  for _, comparison in ipairs(comparisons) do words[comparison.measure == "error" and "error" or "width"] = true end
  return words.error and words.width and "error or width" or words.error and "error" or "width"
end

-- The text of the file, and how many comparisons were left out.
function picture.text(comparisons, title)
  local shown = table.move(comparisons, 1, math.min(#comparisons, panels_at_most), 1, {})
  local styles, notes = drawn.styles(shown), drawn.notes(shown)
  local l = layout(shown, styles, notes)
  local draw = { canvas = svg.canvas(l.width, l.height, title), layout = l }
  write_head(draw, title, styles, notes, legend_of(shown))
  for i, comparison in ipairs(shown) do write_panel(draw, comparison, i, #shown > 1, styles) end
  return draw.canvas:finish(), #comparisons - #shown
end

return picture
