-- reduce/picture_svg.lua -- panels of lines and dots over a logarithmic axis, as an SVG file.
local axis = require "ambit.report.axis"
local report_svg = require "ambit.report.svg"

local svg = {}

local function tick(v) return ("%.6g"):format(v) end

local function write_axes(canvas, panel, frame)
  for _, v in ipairs(panel.y.ticks) do
    local y = axis.pixel(panel.y, v, frame.bottom, frame.top)
    canvas:rule(frame.left, y, frame.right, y, "grid")
    canvas:text(frame.left - 6, y + 4, tick(v), 60, { anchor = "end", class = "small" })
  end
  for _, v in ipairs(panel.x.ticks) do
    local x = axis.pixel(panel.x, v, frame.left, frame.right)
    canvas:rule(x, frame.bottom, x, frame.top, "grid")
    canvas:text(x, frame.bottom + 18, tick(v), 60, { anchor = "middle", class = "small" })
  end
  canvas:add('<path class="axis" d="M%.1f %.1fV%.1fH%.1f"/>', frame.left, frame.top, frame.bottom, frame.right)
  local across, up = (frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2
  canvas:text(across, frame.top - 12, panel.title, frame.right - frame.left, { anchor = "middle" })
  canvas:text(across, frame.bottom + 40, panel.across, frame.right - frame.left, { anchor = "middle" })
  canvas:text(frame.left - 62, up, panel.up, frame.bottom - frame.top, { anchor = "middle", turned = true })
  local bound = axis.pixel(panel.y, 1, frame.bottom, frame.top)
  canvas:rule(frame.left, bound, frame.right, bound, "bound")
  canvas:text(frame.right - 4, bound - 6, "bound", 60, { anchor = "end", class = "small" })
end

-- Pixels of a point; the second value: it is below the axis and drawn at its foot.
local function place(panel, frame, point)
  local x = axis.pixel(panel.x, point[1], frame.left, frame.right)
  if not (point[2] >= panel.y.lo) then return x, frame.bottom, true end
  return x, axis.pixel(panel.y, math.min(point[2], panel.y.hi), frame.bottom, frame.top), false
end

local function write_line(canvas, panel, frame, series)
  local points = {}
  for i, point in ipairs(series.points) do points[i] = { place(panel, frame, point) } end
  canvas:line(points, series.colour, series.dash)
end

local function write_dots(canvas, panel, frame, series)
  for _, point in ipairs(series.points) do
    local x, y, below = place(panel, frame, point)
    if not below then
      canvas:dot(x, y, series.size or 3.2, series.colour)
    elseif series.shows_zero then
      canvas:ring(x, y, 3.2, series.colour)
    end
  end
end

local function write_panel(canvas, panel, frame)
  write_axes(canvas, panel, frame)
  for _, series in ipairs(panel.series) do
    if series.lined and #series.points > 1 then write_line(canvas, panel, frame, series) end
    if series.dotted then write_dots(canvas, panel, frame, series) end
  end
  if #panel.series == 0 then
    local x, y = (frame.left + frame.right) / 2, (frame.top + frame.bottom) / 2
    canvas:text(x, y, panel.empty, 400, { anchor = "middle" })
  end
end

-- entries: { text, colour or nil, dash or nil, dotted }
local function write_legend(canvas, entries, width, top)
  for i, entry in ipairs(entries) do
    local x, y = 30 + (i - 1) % 2 * (width / 2), top + (i - 1) // 2 * 20
    local colour = entry.colour or "#888888"
    if entry.dotted then
      canvas:dot(x + 14, y - 4, 2, colour)
    else
      canvas:line({ { x, y - 4 }, { x + 28, y - 4 } }, colour, entry.dash)
    end
    canvas:text(x + 36, y, entry.text, width / 2 - 50)
  end
end

local WIDTH, PANEL = 1240, 420

-- title, { { title, across, up, x, y, series, empty }, ... }, legend -> the text of the file
function svg.text(title, panels, legend)
  local head = 50 + (#legend + 1) // 2 * 20
  local height, each = head + PANEL, WIDTH / #panels
  local canvas = report_svg.canvas(WIDTH, height, title)
  canvas:text(WIDTH / 2, 26, title, WIDTH - 40, { anchor = "middle", class = "title" })
  write_legend(canvas, legend, WIDTH, 56)
  for i, panel in ipairs(panels) do
    local left = (i - 1) * each
    write_panel(canvas, panel, { left = left + 90, right = left + each - 24, top = head + 36, bottom = height - 60 })
  end
  return canvas:finish()
end

return svg
