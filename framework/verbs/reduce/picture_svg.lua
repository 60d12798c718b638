-- reduce/picture_svg.lua -- panels of lines and dots over a logarithmic axis as one SVG file that needs nothing but
-- itself, readable on light and dark pages: its colours follow the reader's scheme.
local axis = require "ambit.report.axis"
local compare_picture = require "ambit.compare.picture"
local compare_table = require "ambit.compare.table"

local svg = {}

local style = [[
text{font:13px sans-serif;fill:#1a1a1a}.small{font-size:12px}.title{font-size:16px}.back{fill:#fff}
.axis{stroke:#1a1a1a}.grid{stroke:#ddd}.bound{stroke:#777;stroke-width:1.5;stroke-dasharray:6 4}
path,line{fill:none}.line{stroke-width:1.7}
@media (prefers-color-scheme:dark){text{fill:#e6e6e6}.back{fill:#15181c}.axis{stroke:#e6e6e6}.grid{stroke:#3a3f45}
.bound{stroke:#aaa}.line,.dot,.ring{filter:brightness(1.35)}}]]

local entities = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&#39;" }

local function clean(text) return ((compare_picture.printable(text)):gsub("[&<>\"']", entities)) end

local dashes = { "", "7 3", "2 3", "9 3 2 3", "4 4" }

-- What appends elements: write(format, ...)
local function writer()
  local lines = {}
  return lines, function(format, ...) lines[#lines + 1] = format:format(...) end
end

local char = 6.9 -- pixels, of 13 px sans-serif

local function text_at(write, x, y, text, room, extra)
  write('<text x="%.1f" y="%.1f"%s>%s</text>', x, y, extra or "",
    clean(compare_table.short(text, math.max(4, math.floor(room / char)))))
end

local middle = ' text-anchor="middle"'

local function tick(v) return ("%.6g"):format(v) end

local function write_axes(write, panel, frame)
  for _, v in ipairs(panel.y.ticks) do
    local y = axis.pixel(panel.y, v, frame.bottom, frame.top)
    write('<line class="grid" x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f"/>', frame.left, y, frame.right, y)
    text_at(write, frame.left - 6, y + 4, tick(v), 60, ' text-anchor="end" class="small"')
  end
  for _, v in ipairs(panel.x.ticks) do
    local x = axis.pixel(panel.x, v, frame.left, frame.right)
    write('<line class="grid" x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f"/>', x, frame.bottom, x, frame.top)
    text_at(write, x, frame.bottom + 18, tick(v), 60, middle .. ' class="small"')
  end
  write('<path class="axis" d="M%.1f %.1fV%.1fH%.1f"/>', frame.left, frame.top, frame.bottom, frame.right)
  local across, up = (frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2
  text_at(write, across, frame.top - 12, panel.title, frame.right - frame.left, middle)
  text_at(write, across, frame.bottom + 40, panel.across, frame.right - frame.left, middle)
  write('<text transform="translate(%.1f %.1f) rotate(-90)" text-anchor="middle">%s</text>', frame.left - 62, up,
    clean(panel.up))
  local bound = axis.pixel(panel.y, 1, frame.bottom, frame.top)
  write('<line class="bound" x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f"/>', frame.left, bound, frame.right, bound)
  text_at(write, frame.right - 4, bound - 6, "bound", 60, ' text-anchor="end" class="small"')
end

-- Pixels of a point; the second value: it is below the axis and drawn at its foot.
local function place(panel, frame, point)
  local x = axis.pixel(panel.x, point[1], frame.left, frame.right)
  if not (point[2] >= panel.y.lo) then return x, frame.bottom, true end
  return x, axis.pixel(panel.y, math.min(point[2], panel.y.hi), frame.bottom, frame.top), false
end

local function write_line(write, panel, frame, series)
  local parts = {}
  for i, point in ipairs(series.points) do
    local x, y = place(panel, frame, point)
    parts[i] = ("%s%.1f %.1f"):format(i == 1 and "M" or "L", x, y)
  end
  local dash = dashes[((series.dash or 1) - 1) % #dashes + 1]
  write('<path class="line" stroke="%s"%s d="%s"/>', series.colour,
    dash ~= "" and (' stroke-dasharray="%s"'):format(dash) or "", table.concat(parts))
end

local function write_dots(write, panel, frame, series)
  for _, point in ipairs(series.points) do
    local x, y, below = place(panel, frame, point)
    if not below then
      write('<circle class="dot" cx="%.1f" cy="%.1f" r="%.1f" fill="%s"/>', x, y, series.size or 3.2, series.colour)
    elseif series.shows_zero then
      write('<circle class="ring" cx="%.1f" cy="%.1f" r="3.2" fill="none" stroke="%s"/>', x, y, series.colour)
    end
  end
end

local function write_panel(write, panel, frame)
  write_axes(write, panel, frame)
  for _, series in ipairs(panel.series) do
    if series.lined and #series.points > 1 then write_line(write, panel, frame, series) end
    if series.dotted then write_dots(write, panel, frame, series) end
  end
  if #panel.series == 0 then
    text_at(write, (frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2, panel.empty, 400, middle)
  end
end

-- entries: { text, colour or nil, dash or nil, dotted }
local function write_legend(write, entries, width, top)
  for i, entry in ipairs(entries) do
    local x, y = 30 + (i - 1) % 2 * (width / 2), top + (i - 1) // 2 * 20
    local colour = entry.colour or "#888888"
    if entry.dotted then
      write('<circle class="dot" cx="%.1f" cy="%.1f" r="2" fill="%s"/>', x + 14, y - 4, colour)
    else
      write('<path class="line" stroke="%s" stroke-dasharray="%s" d="M%.1f %.1fh28"/>', colour,
        entry.dash and dashes[(entry.dash - 1) % #dashes + 1] or "none", x, y - 4)
    end
    text_at(write, x + 36, y, entry.text, width / 2 - 50)
  end
end

local WIDTH, PANEL = 1240, 420

-- title, { { title, across, up, x, y, series, empty }, ... }, legend -> the text of the file
function svg.text(title, panels, legend)
  local lines, write = writer()
  local head = 50 + (#legend + 1) // 2 * 20
  local height, each = head + PANEL, WIDTH / #panels
  write('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d">', WIDTH, height, WIDTH,
    height)
  write("<title>%s</title><style>%s</style>", clean(title), style)
  write '<rect class="back" width="100%%" height="100%%"/>'
  text_at(write, WIDTH / 2, 26, title, WIDTH - 40, middle .. ' class="title"')
  write_legend(write, legend, WIDTH, 56)
  for i, panel in ipairs(panels) do
    local left = (i - 1) * each
    write_panel(write, panel, { left = left + 90, right = left + each - 24, top = head + 36, bottom = height - 60 })
  end
  write "</svg>"
  return table.concat(lines, "\n") .. "\n"
end

return svg
