-- reduce/picture.lua -- what a reduction costs, as a picture: the proved error against the number of terms, and against
-- time together with the sampled one. Errors are parts of their bounds, so that outputs of different units share an
-- axis.
local axis = require "ambit.report.axis"
local check = require "ambit.check"
local json = require "ambit.reduce.json"
local number = require "ambit.report.number"
local provenance = require "ambit.provenance"
local proof = require "ambit.reduce.certify.proof"
local sample = require "ambit.reduce.sample"
local report_svg = require "ambit.report.svg"
local svg = require "ambit.reduce.picture_svg"

local picture = {}

local DECADES = 8   -- at most, below the greatest value: an error starts at zero
local DOTS = 60     -- sampled errors of an output in a scenario

local function colour_of(k) return report_svg.colours[(k - 1) % #report_svg.colours + 1] end

-- A logarithmic axis of parts of a bound, with the bound on it.
local function share_axis(series)
  local most, values = 1, { 1 }
  for _, s in ipairs(series) do
    for _, point in ipairs(s.points) do
      if point[2] < math.huge then most = math.max(most, point[2]) end
    end
  end
  for _, s in ipairs(series) do
    for _, point in ipairs(s.points) do
      if point[2] >= most * 10 ^ -DECADES and point[2] < math.huge then values[#values + 1] = point[2] end
    end
  end
  return axis.range(values, 10)
end

-- What an output's errors are drawn against: its bound, or what was proved where none was given.
local function unit_of(self, k)
  local error = self.error[self.outputs[k]]
  return self.bounds[k] or error and error > 0 and error or 1
end

-- -- the panels

local function history_panel(self)
  local series, least, most = {}, math.huge, 0
  for k, name in ipairs(self.outputs) do
    local points = {}
    for _, entry in ipairs(self.history) do
      local error = entry.error and entry.error[name]
      if error then
        points[#points + 1] = { entry.terms, error / unit_of(self, k) }
        least, most = math.min(least, entry.terms), math.max(most, entry.terms)
      end
    end
    if #points > 0 then
      series[#series + 1] = { points = points, colour = colour_of(k), lined = true, dotted = true, shows_zero = true }
    end
  end
  if least > most then least, most = 0, 1 end
  local x, whole = axis.linear(least - 0.5, most + 0.5), {}
  for _, tick in ipairs(x.ticks) do
    if tick % 1 == 0 then whole[#whole + 1] = tick end
  end
  x.ticks = whole
  return { title = "proved error of the reduced model by its size", across = "number of terms", up = "error / bound",
    x = x, y = share_axis(series), series = series,
    empty = "nothing was cut" }
end

-- Every so many of the points that at most DOTS remain.
local function thinned(points)
  local list, step = {}, math.max(1, math.ceil(#points / DOTS))
  for i = #points, 1, -step do table.insert(list, 1, points[i]) end
  return list
end

local function along(curve, name, bound)
  local points = {}
  for i, t in ipairs(curve.t) do
    local error = curve.error[name] and curve.error[name][i]
    if error then points[#points + 1] = { t, error / bound } end
  end
  return points
end

local function time_panel(self, curves, sampled)
  local series, from, to = {}, math.huge, -math.huge
  local function add(points, style)
    if #points == 0 then return end
    style.points = points
    series[#series + 1] = style
    for _, point in ipairs(points) do from, to = math.min(from, point[1]), math.max(to, point[1]) end
  end
  for k, name in ipairs(self.outputs) do
    for s, curve in ipairs(curves) do
      add(along(curve, name, unit_of(self, k)), { colour = colour_of(k), dash = s, lined = true })
    end
    for _, found in ipairs(sampled and sampled.scenarios or {}) do
      add(thinned(along({ t = found.t, error = found.curve }, name, unit_of(self, k))),
        { colour = colour_of(k), dotted = true, size = 1.8 })
    end
  end
  if not (from < to) then from, to = 0, 1 end
  return { title = "difference over time: proved (lines), sampled (dots)", across = "t in s", up = "error / bound",
    x = axis.linear(from, to), y = share_axis(series), series = series, empty = "no error was proved" }
end

local function legend_of(self, curves)
  local list = {}
  for k, name in ipairs(self.outputs) do
    local error = self.error[name]
    list[k] = { colour = colour_of(k), text = ("%s: bound %s, proved %s"):format(name,
      self.bounds[k] and number.short(self.bounds[k]) or "none", error and number.up(error) or "nothing") }
  end
  for s, curve in ipairs(#curves > 1 and curves or {}) do list[#list + 1] = { dash = s, text = curve.name } end
  return list
end

-- The text of the file. curves: { { name, t, error = { [output] = { at each t } } }, ... }; sampled: of reduce_sample.
-- A certificate has no history.
function picture.text(self, curves, sampled)
  local over_time, legend = time_panel(self, curves, sampled), legend_of(self, curves)
  if not self.history then return svg.text("error of the reduced model", { over_time }, legend) end
  local title = ("%s of %s terms are left"):format(self.terms_after, self.terms_before)
  return svg.text(title, { history_panel(self), over_time }, legend)
end

function picture.write(self, file, options, what)
  if file == nil then check.fail("%s: expected the name of a file, as in result:picture \"reduction.svg\"", what) end
  json.writable(file, what)
  local sampled = sample.of(self, options, what)
  local curves = proof.curve(self.detailed, self.model, self.given, self.settings).scenarios
  json.save(file, provenance.svg(picture.text(self, curves, sampled)), what)
end

return picture
