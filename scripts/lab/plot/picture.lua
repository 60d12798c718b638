-- plot/picture.lua -- quantities of a run as an SVG file: for each a panel over time, or over another quantity. Boxes
-- hold from one instant to the next; lines across are limits, upright ones the times of events.
local axis = require "ambit.report.axis"
local svg = require "ambit.report.svg"

local picture = {}

local WIDE, PAIR, HIGH = 900, 620, 300 -- pixels of a panel: alone in its row, one of two
local HEAD, LINE = 48, 18           -- above the panels: the title, each line of the legend
local sampled_colour = "#333333"

local function finite(x) return x and x == x and math.abs(x) < 1e300 end

-- Calls with each finite bound of the course's quantity k, and with its limit.
local function each_bound(plot, k, f)
  local of = plot.course[k]
  for _, bounds in ipairs { of, of.tube } do
    for i in ipairs(plot.course.t) do
      if finite(bounds.lo[i]) then f(bounds.lo[i]) end
      if finite(bounds.hi[i]) then f(bounds.hi[i]) end
    end
  end
  local l, place = plot.limits[k] or {}, plot.hull and plot.hull.k[k]
  if finite(l.lo) then f(l.lo) end
  if finite(l.hi) then f(l.hi) end
  for _, bounds in ipairs(place and { plot.hull.lo[place], plot.hull.hi[place] } or {}) do
    for i in ipairs(plot.hull.t) do if finite(bounds[i]) then f(bounds[i]) end end
  end
end

local function is_bounded(of, i) return finite(of.lo[i]) and finite(of.hi[i]) end

local function axis_of(plot, k)
  local lo, hi = math.huge, -math.huge
  each_bound(plot, k, function(v) lo, hi = math.min(lo, v), math.max(hi, v) end)
  if lo > hi then lo, hi = -1, 1 end
  local margin = math.max(0.04 * (hi - lo), 1e-12 * math.max(math.abs(lo), math.abs(hi)))
  if margin == 0 then margin = 1 end
  return axis.linear(lo - margin, hi + margin)
end

local function time_axis(course)
  local first, last = course.t[1], course.t[#course.t]
  if first == last then last = first + 1 end
  return axis.linear(math.min(first, last), math.max(first, last))
end

local function title_of(q) return q.unit ~= "" and q.unit ~= "1" and ("%s, %s"):format(q.name, q.unit) or q.name end

-- -- one panel

local Panel = {}
Panel.__index = Panel

local function within(v, from, to) return math.max(math.min(v, math.max(from, to)), math.min(from, to)) end

function Panel:across(v) return within(axis.pixel(self.x, v, self.left, self.right), self.left, self.right) end

function Panel:up(v) return within(axis.pixel(self.y, v, self.bottom, self.top), self.bottom, self.top) end

function Panel:frame(canvas, across, upwards)
  for _, v in ipairs(self.x.ticks) do
    canvas:rule(self:across(v), self.top, self:across(v), self.bottom, "grid")
    canvas:text(self:across(v), self.bottom + 18, ("%.6g"):format(v), 80, { anchor = "middle", class = "small" })
  end
  for _, v in ipairs(self.y.ticks) do
    canvas:rule(self.left, self:up(v), self.right, self:up(v), "grid")
    canvas:text(self.left - 8, self:up(v) + 4, ("%.6g"):format(v), 76, { anchor = "end", class = "small" })
  end
  canvas:rule(self.left, self.top, self.left, self.bottom, "axis")
  canvas:rule(self.left, self.bottom, self.right, self.bottom, "axis")
  canvas:text((self.left + self.right) / 2, self.bottom + 38, across, self.right - self.left, { anchor = "middle" })
  canvas:text(self.left - 78, (self.top + self.bottom) / 2, upwards, self.bottom - self.top,
    { anchor = "middle", turned = true })
end

function Panel:limits(canvas, l, across)
  for _, v in pairs { l and l.lo, l and l.hi } do
    canvas:rule(self.left, self:up(v), self.right, self:up(v), "bound")
  end
  for _, v in pairs { across and across.lo, across and across.hi } do
    canvas:rule(self:across(v), self.top, self:across(v), self.bottom, "bound")
  end
end

-- The boxes of quantity k over time.
function Panel:over_time(canvas, plot, k, colour)
  local course, of = plot.course, plot.course[k]
  for i, t in ipairs(course.t) do
    local next_t = course.t[i + 1]
    if next_t and is_bounded(of.tube, i) then
      canvas:box(self:across(t), self:up(of.tube.lo[i]), self:across(next_t), self:up(of.tube.hi[i]), colour)
    end
    if is_bounded(of, i) then
      canvas:line({ { self:across(t), self:up(of.lo[i]) }, { self:across(t), self:up(of.hi[i]) } }, colour)
    end
  end
end

function Panel:events(canvas, plot)
  for _, e in ipairs(plot.run.events or {}) do
    if e.t:is_bounded() then
      canvas:box(self:across(e.t.lo), self.top, self:across(e.t.hi), self.bottom, svg.colours[5])
      canvas:text(self:across(e.t:mid()) + 4, self.top + 12, e.name, 120, { class = "tiny" })
    end
  end
end

function Panel:sampled(canvas, hull, k)
  for _, bounds in ipairs(hull and hull.k[k] and { hull.lo[hull.k[k]], hull.hi[hull.k[k]] } or {}) do
    local line = {}
    for i, t in ipairs(hull.t) do
      if finite(bounds[i]) then line[#line + 1] = { self:across(t), self:up(bounds[i]) } end
    end
    if #line > 1 then canvas:line(line, sampled_colour, 2) end
  end
end

-- Quantity k over quantity a.
function Panel:over_other(canvas, plot, a, k, colour)
  local x, y = plot.course[a].tube, plot.course[k].tube
  for i = 1, #plot.course.t - 1 do
    if is_bounded(x, i) and is_bounded(y, i) then
      canvas:box(self:across(x.lo[i]), self:up(y.lo[i]), self:across(x.hi[i]), self:up(y.hi[i]), colour)
    end
  end
  local line = {}
  local outline = plot.outlines[k] or {}
  for i, p in ipairs(outline) do
    line[i] = { self:across(outline.middle[1] + p[1]), self:up(outline.middle[2] + p[2]) }
  end
  line[#line + 1] = line[1]
  if #line > 1 then canvas:line(line, svg.colours[2]) end
end

-- -- the whole

local words = { holds = "within its limits at all times, proved", fails = "beyond its limits, proved",
  undecided = "limits: not decided" }

local function panel_at(n, count, head)
  local columns = count == 1 and 1 or 2
  local width = columns == 1 and WIDE or PAIR
  local column, row = (n - 1) % columns, (n - 1) // columns
  local left, top = column * width, head + row * HIGH
  return setmetatable({ left = left + 96, right = left + width - 24, top = top + 26, bottom = top + HIGH - 52 }, Panel)
end

local function write_panel(canvas, plot, n, k, count, head)
  local panel, q, colour = panel_at(n, count, head), plot.quantities[k], svg.colours[(k - 1) % #svg.colours + 1]
  panel.y = axis_of(plot, k)
  panel.x = plot.against and axis_of(plot, plot.against) or time_axis(plot.course)
  panel:frame(canvas, plot.against and title_of(plot.quantities[plot.against]) or "t, s", title_of(q))
  if plot.against then
    panel:over_other(canvas, plot, plot.against, k, colour)
  else
    panel:events(canvas, plot)
    panel:over_time(canvas, plot, k, colour)
    panel:sampled(canvas, plot.hull, k)
  end
  panel:limits(canvas, plot.limits[k], plot.against and plot.limits[plot.against])
  local verdict = plot.verdicts[q.name]
  if verdict then canvas:text(panel.left + 8, panel.top - 8, words[verdict], 400, { class = "small" }) end
end

-- Of how many boxes nothing is known, or no bound.
local function count_open(plot)
  local count = 0
  for k in ipairs(plot.quantities) do
    for i = 1, #plot.course.t - 1 do if not is_bounded(plot.course[k].tube, i) then count = count + 1 end end
  end
  return count
end

local function partial_names(plot)
  local names = {}
  for k, q in ipairs(plot.quantities) do
    for i in ipairs(plot.course.t) do
      if plot.course[k].partial[i] or plot.course[k].tube.partial[i] then
        names[#names + 1] = q.name
        break
      end
    end
  end
  return names
end

-- What is drawn, in one line each.
function picture.legend(plot)
  local run, open, partial = plot.run, count_open(plot), partial_names(plot)
  local list = { plot.proved and "boxes: proved to hold every motion that the data allow, at all times"
    or "boxes: not proved: solver " .. run.solver }
  if plot.hull and next(plot.hull.k) and not plot.against then
    list[#list + 1] = ("dashed: the hull of %d sampled motions"):format(plot.hull.draws)
  end
  if plot.against and next(plot.outlines) then list[#list + 1] = "outline: the set at the end" end
  if open > 0 then list[#list + 1] = ("%d boxes have no bound and are not drawn"):format(open) end
  if #partial > 0 then
    list[#list + 1] = table.concat(partial, ", ") .. ": only where it is defined, which is not for all data"
  end
  if run.ended_by then list[#list + 1] = ("up to the event %s"):format(run.ended_by) end
  if run.status ~= "complete" then
    list[#list + 1] = ("%s at t = %.6g"):format(run.status, run.t_reached)
  end
  return list
end

-- is_inside: for a page, which says title, legend and provenance itself.
function picture.text(plot, is_inside)
  local shown = {}
  for k in ipairs(plot.quantities) do if k ~= plot.against then shown[#shown + 1] = k end end
  local columns = #shown == 1 and 1 or 2
  local width = columns == 1 and WIDE or 2 * PAIR
  local legend = is_inside and {} or picture.legend(plot)
  local head = HEAD + LINE * #legend
  local canvas = svg.canvas(width, head + (#shown + columns - 1) // columns * HIGH + 8, plot.title, is_inside)
  if not is_inside then
    canvas:text(width / 2, 28, plot.title, width - 40, { anchor = "middle", class = "title" })
  end
  for n, line in ipairs(legend) do
    canvas:text(width / 2, 30 + n * LINE, line, width - 40, { anchor = "middle", class = "small" })
  end
  for n, k in ipairs(shown) do write_panel(canvas, plot, n, k, #shown, head) end
  return is_inside and canvas:finish() or require "ambit.provenance".svg(canvas:finish())
end

return picture
