-- report/svg.lua -- pictures as SVG files that need nothing but themselves, readable on light and dark pages: their
-- colours follow the reader's scheme. Places are pixels from the left and from the top.
local svg = {}

svg.colours = { "#4477aa", "#ee6677", "#228833", "#aa3377", "#ccaa22", "#33aacc", "#885522", "#555555" }

local CHAR = 6.9 -- width of a character of 13 px sans-serif, pixels

local style = [[
text{font:13px sans-serif;fill:#1a1a1a}.small{font-size:12px}.tiny{font-size:11px}.title{font-size:16px}.back{fill:#fff}
.axis{stroke:#1a1a1a}.grid{stroke:#ddd}.bound{stroke:#777;stroke-width:1.5;stroke-dasharray:6 4}
path,line{fill:none}.line{stroke-width:1.7}
@media (prefers-color-scheme:dark){text{fill:#e6e6e6}.back{fill:#15181c}.axis{stroke:#e6e6e6}.grid{stroke:#3a3f45}
.bound{stroke:#aaa}.line,.dot,.ring,.tinted{filter:brightness(1.35)}}]]

local entities = { ["&"] = "&amp;", ["<"] = "&lt;", [">"] = "&gt;", ['"'] = "&quot;", ["'"] = "&#39;" }

local dashes = { "", "7 3", "2 3", "9 3 2 3", "4 4" }

-- What an SVG file may contain: names are the scene's, whatever bytes they have.
function svg.printable(text)
  text = tostring(text)
  return (utf8.len(text) and text or text:gsub("[\128-\255]", "?")):gsub("%c+", " ")
end

local function clean(text) return ((svg.printable(text)):gsub("[&<>\"']", entities)) end

-- As much of the text as fits into `room` pixels.
local function shortened(text, room)
  text = svg.printable(text)
  local most = math.max(4, math.floor(room / CHAR))
  if utf8.len(text) <= most then return text end
  return text:sub(1, utf8.offset(text, most - 2) - 1) .. "..."
end

-- ' stroke-dasharray="..."' of the dash with that number, from 1; nil and 1: none
local function dashed(dash)
  local pattern = dashes[((dash or 1) - 1) % #dashes + 1]
  return pattern == "" and "" or (' stroke-dasharray="%s"'):format(pattern)
end

local Canvas = {}
Canvas.__index = Canvas

-- An empty picture; is_inside: for a page, whose style sheet says how things look.
function svg.canvas(width, height, title, is_inside)
  local self = setmetatable({ parts = {} }, Canvas)
  if is_inside then
    self:add('<svg class="plot" role="img" aria-label="%s" viewBox="0 0 %d %d">', clean(title), width, height)
    return self
  end
  self:add('<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" viewBox="0 0 %d %d">', width, height, width,
    height)
  self:add("<title>%s</title><style>%s</style>", clean(title), style)
  self:add '<rect class="back" width="100%%" height="100%%"/>'
  return self
end

function Canvas:add(format, ...) self.parts[#self.parts + 1] = format:format(...) end

-- The text of the file.
function Canvas:finish()
  self:add "</svg>"
  return table.concat(self.parts, "\n") .. "\n"
end

-- The base line at y; what does not fit into `room` pixels is cut. look: anchor = "middle" or "end", class, colour,
-- turned = true: upwards, about its place.
function Canvas:text(x, y, text, room, look)
  look = look or {}
  local extra = (look.anchor and (' text-anchor="%s"'):format(look.anchor) or "")
    .. (look.colour and (' style="fill:%s"'):format(look.colour) or "")
  local class = (look.class or "") .. (look.colour and " tinted" or "")
  if class ~= "" then extra = ('%s class="%s"'):format(extra, class) end
  local place = look.turned and ('transform="translate(%.1f %.1f) rotate(-90)"'):format(x, y)
    or ('x="%.1f" y="%.1f"'):format(x, y)
  self:add("<text %s%s>%s</text>", place, extra, clean(shortened(text, room)))
end

-- class: grid, axis or bound
function Canvas:rule(x1, y1, x2, y2, class)
  self:add('<line class="%s" x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f"/>', class, x1, y1, x2, y2)
end

-- A line through { x, y } of the list.
function Canvas:line(points, colour, dash)
  local parts = {}
  for i, p in ipairs(points) do parts[i] = ("%s%.1f %.1f"):format(i == 1 and "M" or "L", p[1], p[2]) end
  self:add('<path class="line" stroke="%s"%s d="%s"/>', colour, dashed(dash), table.concat(parts))
end

function Canvas:box(x1, y1, x2, y2, colour)
  self:add('<rect x="%.2f" y="%.2f" width="%.2f" height="%.2f" fill="%s" fill-opacity="0.55"/>', math.min(x1, x2),
    math.min(y1, y2), math.max(0.3, math.abs(x2 - x1)), math.max(0.3, math.abs(y2 - y1)), colour)
end

function Canvas:dot(x, y, radius, colour)
  self:add('<circle class="dot" cx="%.1f" cy="%.1f" r="%.1f" fill="%s"/>', x, y, radius, colour)
end

function Canvas:ring(x, y, radius, colour)
  self:add('<circle class="ring" cx="%.1f" cy="%.1f" r="%.1f" fill="none" stroke="%s"/>', x, y, radius, colour)
end

-- Corners of markers about their place, in pixels; what is no polygon is a circle.
local shapes = {
  square = { -4, -4, 4, -4, 4, 4, -4, 4 }, up = { 0, -5, 4.5, 3.5, -4.5, 3.5 }, down = { 0, 5, 4.5, -3.5, -4.5, -3.5 },
  diamond = { 0, -5.5, 5.5, 0, 0, 5.5, -5.5, 0 }, pentagon = { 0, -5, 4.8, -1.5, 3, 4, -3, 4, -4.8, -1.5 },
}

-- name: circle, square, up, down, diamond, pentagon, or one of them behind "open "
function Canvas:marker(name, x, y, colour)
  local open = name:match "^open (.*)"
  local shape = shapes[open or name]
  if not shape then return (open and Canvas.ring or Canvas.dot)(self, x, y, 4, colour) end
  local corners = {}
  for i = 1, #shape, 2 do corners[#corners + 1] = ("%.1f,%.1f"):format(x + shape[i], y + shape[i + 1]) end
  self:add('<polygon class="dot" points="%s" fill="%s" stroke="%s"/>', table.concat(corners, " "),
    open and "none" or colour, colour)
end

return svg
