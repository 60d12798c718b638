-- compare/picture.lua -- comparisons as a gnuplot script: error or width across (of several results: their largest
-- overestimation, since widths of different quantities do not compare), CPU time up, both logarithmic; one panel for
-- each comparison, one colour and marker for each method, its orders joined by a line. What cannot be drawn is listed
-- below.
--
-- Everything is placed here, in pixels, and gnuplot draws it: so labels can keep clear of points and of each other.
local compare_label = require "ambit.compare.label"
local compare_table = require "ambit.compare.table"
local compare_axis = require "ambit.report.axis"
local drawn = require "ambit.compare.drawn"

local picture = { colours = drawn.colours }

local panels_at_most = 6
local char, line_height = 6.9, 17 -- pixels, of 13 px sans-serif

local function quoted(text) return "'" .. tostring(text):gsub("'", "''"):gsub("[\r\n]+", " ") .. "'" end

-- What an SVG file may contain: names are the scene's, whatever bytes they have.
function picture.printable(text)
  return (utf8.len(text) and text or text:gsub("[\128-\255]", "?")):gsub("%c+", " ")
end

local function short(text, pixels) return compare_table.short(text, math.floor(pixels / char)) end

-- -- layout

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

-- -- writing gnuplot

local function writer()
  local lines = {}
  return lines, function(format, ...) lines[#lines + 1] = select("#", ...) > 0 and format:format(...) or format end
end

local function text_at(write, l, x, y, text, extra) -- the middle of its height at y
  write("set label %s at screen %.5f,%.5f %s", quoted(picture.printable(text)), x / l.width, y / l.height,
    extra or "left")
end

local function segment(write, l, x1, y1, x2, y2, style)
  write("set arrow from screen %.5f,%.5f to screen %.5f,%.5f nohead %s", x1 / l.width, y1 / l.height, x2 / l.width,
    y2 / l.height, style)
end

local hull_style, reference_style = "lc rgb '#888888' dt 3 lw 1.5", "lc rgb '#888888' dt 2 lw 1.5"

local function write_legend(write, l, styles, has)
  local entries = {}
  for _, s in ipairs(styles) do
    entries[#entries + 1] = { s.name, ("lc rgb '%s' dt %d lw 1.5"):format(s.colour, s.dash), s }
  end
  if has.reference then
    entries[#entries + 1] = { ("time of %s, proves nothing"):format(has.reference), reference_style }
  end
  if has.sample then entries[#entries + 1] = { "sampled: the inner estimate", hull_style } end
  local step = (l.width - 60) / l.legend_columns
  for i, entry in ipairs(entries) do
    local x = 40 + (i - 1) % l.legend_columns * step
    local y = l.height - 50 - (i - 1) // l.legend_columns * 20
    if not entry[3] or entry[3].axis then segment(write, l, x, y, x + 28, y, entry[2]) end
    if entry[3] then
      write("set label '' at screen %.5f,%.5f point pt %d ps 0.8 lc rgb '%s'", (x + 14) / l.width, y / l.height,
        entry[3].marker, entry[3].colour)
    end
    text_at(write, l, x + 36, y, short(entry[1], step - 44))
  end
end

local function write_head(write, l, title, styles, notes, has)
  text_at(write, l, l.width / 2, l.height - 20, short(title, l.width - 40), "center font ',16'")
  write_legend(write, l, styles, has)
  if #notes == 0 then return end
  text_at(write, l, 24, l.foot - 14, "not drawn:", "left font ',12'")
  for i, note in ipairs(notes) do
    text_at(write, l, 36, l.foot - 14 - i * line_height, short(note, 1.04 * (l.width - 60)), "left font ',12'")
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

local function ticks(values, format)
  local list = {}
  for i, v in ipairs(values) do list[i] = ("%s %.17g"):format(quoted(format(v)), v) end
  return table.concat(list, ", ")
end

local function time_text(v)
  return compare_table.seconds(v * (1 + 1e-12), "%.4g")
end

local function write_axes(write, l, frame, x, y, title)
  write("set lmargin at screen %.5f; set rmargin at screen %.5f", frame.left / l.width, frame.right / l.width)
  write("set bmargin at screen %.5f; set tmargin at screen %.5f", frame.bottom / l.height, frame.top / l.height)
  write("set xrange [%.17g:%.17g]; set yrange [%.17g:%.17g]", x.lo, x.hi, y.lo, y.hi)
  write("set xtics (%s)", ticks(x.ticks, function(v) return ("%.6g"):format(v) end))
  write("set ytics (%s)", ticks(y.ticks, time_text))
  text_at(write, l, (frame.left + frame.right) / 2, frame.bottom - 47, title, "center")
  text_at(write, l, frame.left - 76, (frame.bottom + frame.top) / 2, "CPU time of one run", "center rotate")
end

local function write_title(write, l, frame, comparison, number)
  local title = (number and ("%d. "):format(number) or "") .. compare_table.size(comparison)
  if comparison.place and comparison.place ~= "" then title = title .. ", " .. comparison.place:match "[^/]*$" end
  text_at(write, l, (frame.left + frame.right) / 2, frame.top + 16, short(title, frame.right - frame.left), "center")
end

-- Lines through the whole panel: the time of what proves nothing, the samples.
local function write_references(write, reference, inner)
  if reference then
    write("set arrow from graph 0,first %.17g to graph 1,first %.17g nohead %s", reference.seconds_run,
      reference.seconds_run, reference_style)
  end
  if inner then
    write("set arrow from first %.17g,graph 0 to first %.17g,graph 1 nohead %s", inner, inner, hull_style)
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

local function write_families(write, l, families, key, styles, x, y, frame, data)
  local plots, points = {}, {}
  for k, family in ipairs(families) do
    local style = styles[family[1].family]
    plots[k] = ("%s using 1:2 with linespoints lc rgb '%s' pt %d ps 0.8 lw 1.5 dt %d notitle"):format(
      data(family, key), style.colour, style.marker, style.dash)
    add_points(points, family, key, style.colour, x, y, frame)
  end
  for _, label in ipairs(compare_label.place(points, frame)) do
    text_at(write, l, label.x, label.y, label.text, ("center font ',11' tc rgb '%s' front"):format(label.colour))
  end
  if #plots == 0 then
    text_at(write, l, (frame.left + frame.right) / 2, (frame.bottom + frame.top) / 2,
      "no enclosure with a finite width above zero", "center")
    plots[1] = "NaN notitle"
  end
  write("plot %s", table.concat(plots, ", \\\n  "))
end

local function write_panel(write, l, comparison, i, many, styles, data)
  local key, title, inner = drawn.measure(comparison)
  if inner and not compare_axis.on_axis(inner) then inner = nil end
  local families, reference = drawn.families(comparison, key), drawn.reference(comparison)
  local frame = frame_of(l, i)
  local x, y = ranges_of(families, key, inner, reference)
  write_axes(write, l, frame, x, y, title)
  write_title(write, l, frame, comparison, many and i)
  write_references(write, reference, inner)
  write_families(write, l, families, key, styles, x, y, frame, data)
  write "unset label; unset arrow"
end

-- The data of the families as named blocks, which gnuplot wants outside of the panels: the lines, and a function that
-- adds a family and returns its name.
local function data_blocks()
  local lines, count = {}, 0
  return lines, function(family, key)
    count = count + 1
    local name = "$data_" .. count
    lines[#lines + 1] = name .. " << END"
    for _, row in ipairs(family) do lines[#lines + 1] = ("%.17g %.17g"):format(row[key], row.seconds_run) end
    lines[#lines + 1] = "END"
    return name
  end
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

-- A gnuplot script that draws the comparisons to its standard output (SVG); the second value: how many were left out.
function picture.script(comparisons, title)
  local shown = table.move(comparisons, 1, math.min(#comparisons, panels_at_most), 1, {})
  local styles, notes = drawn.styles(shown), drawn.notes(shown)
  local l = layout(shown, styles, notes)
  local lines, write = writer()
  local blocks, data = data_blocks()
  write("set terminal svg size %d,%d noenhanced font 'sans-serif,13' background rgb 'white'", l.width, l.height)
  write "set multiplot"
  write "set logscale xy; unset key; set border 3; set tics nomirror out; set grid lc rgb '#dddddd' lt 1"
  write_head(write, l, title, styles, notes, legend_of(shown))
  for i, comparison in ipairs(shown) do write_panel(write, l, comparison, i, #shown > 1, styles, data) end
  write "unset multiplot"
  return table.concat(blocks, "\n") .. "\n" .. table.concat(lines, "\n") .. "\n", #comparisons - #shown
end

return picture
