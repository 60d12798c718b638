-- plot.lua -- ambit.plot { run, quantities = { "beta1", tip = m:position(tip) }, limits = { ["tip.y"] = { -1, 1 } },
-- against = "beta1", file = "p.svg" }: what a run proved of states and formulas, as a picture, a page or a table.
local check = require "ambit.check"
local core = require "ambit.core"
local course = require "ambit.plot.course"
local limit = require "ambit.plot.limit"
local outline = require "ambit.plot.outline"
local quantity = require "ambit.plot.quantity"
local run = require "ambit.run"

local verb = {}

local keys = { "quantities", "limits", "against", "sample", "title", "file" }
local DRAWS = 200
local SECONDS = 10 -- that the draws may take

-- -- files

-- The text of a file by the end of its name.
local writers = {
  svg = function(plot) return require "ambit.plot.picture".text(plot) end,
  csv = function(plot) return require "ambit.plot.csv".text(plot.course, plot.quantities) end,
  html = function(plot) return require "ambit.page.plot".of(plot) end,
}
local converted = { png = true, pdf = true } -- made of the SVG by rsvg-convert

local formats = { "svg", "html", "png", "pdf", "csv" }

local function format_of(file)
  local format = check.text(file, "plot: file"):match "%.([%w]+)$"
  format = format and format:lower()
  if writers[format] or converted[format] then return format end
  check.fail("plot: file: expected a name that ends with one of .%s, got `%s`", table.concat(formats, ", ."), file)
end

local function quoted(name) return "'" .. name:gsub("'", "'\\''") .. "'" end

local function check_converter(format)
  if converted[format] and os.execute "command -v rsvg-convert >/dev/null 2>&1" ~= true then
    check.fail("plot: %s files need the program rsvg-convert (Debian: librsvg2-bin); .svg and .html do not", format)
  end
end

local function convert(plot, format)
  local from, to = os.tmpname(), os.tmpname()
  local file = assert(io.open(from, "w"))
  file:write(writers.svg(plot))
  file:close()
  local good = os.execute(("rsvg-convert -f %s -o %s %s"):format(format, quoted(to), quoted(from)))
  local made = good and io.open(to, "rb")
  local text = made and made:read "a"
  if made then made:close() end
  os.remove(from)
  os.remove(to)
  if not text or text == "" then check.fail("plot: rsvg-convert could not make a %s file", format) end
  return text
end

local function text_of(plot, format) return converted[format] and convert(plot, format) or writers[format](plot) end

-- For commands, before anything is computed: an error if nothing can be written to a file of that name.
function verb.check_file(file)
  check_converter(format_of(file))
  local there = io.open(file)
  if there then there:close() end
  local handle, problem = io.open(file, "a")
  if not handle then check.fail("plot: file: cannot write %s", problem) end
  handle:close()
  if not there then os.remove(file) end
end

local function files_of(t)
  if t.file == nil then return {} end
  local list = type(t.file) == "table" and t.file or { t.file }
  for _, file in ipairs(list) do check_converter(format_of(file)) end
  return list
end

local function write(plot, files)
  for _, file in ipairs(files) do
    local problem = core.write_file(file, text_of(plot, format_of(file)))
    if problem then check.fail("plot: cannot write %s", problem) end
  end
end

-- -- what is drawn

-- The hull of sampled motions of the quantities: { t, lo, hi, draws, k = { [quantity] = its place in lo and hi } }, or
-- nil: there is none. A formula is carried along as a further state, which needs rates: not where states leap.
local function hull_of(subject, quantities, draws)
  local question = subject.question
  if not question or not question.again or (subject.report.unknowns or 0) == 0 then return nil end
  local place, carried, of = {}, {}, {}
  for k, q in ipairs(quantities) do
    place[k] = q.state
    if not q.state and not subject.system.sampled then
      carried[#carried + 1], of[#of + 1] = { name = q.name, g = q.g }, k
    end
  end
  local q = question
  if #carried > 0 then
    local outputs
    q, outputs = require "ambit.verify.carry".of(question, carried)
    local numbers = {}
    for i, symbol in ipairs(q.system.symbols) do numbers[symbol] = i end
    for n, symbol in pairs(outputs) do place[of[n]] = numbers[symbol] end
  end
  local inner = require "ambit.sample".inner(q, draws, 1, { cpu = SECONDS })
  if not inner or inner.failed > 0 then return nil end
  inner.k = place
  return inner
end

local function draws_of(t)
  if t.sample == nil then return DRAWS end
  if t.sample == false then return nil end
  return check.count(t.sample == true and DRAWS or t.sample, "plot: sample")
end

local function outlines_of(plot)
  local list, of = {}, plot.course
  local i, x = #of.t, of[plot.against]
  for k, q in ipairs(plot.quantities) do
    if k ~= plot.against and plot.proved and not of.ends_early and not x.partial[i] and not of[k].partial[i] then
      list[k] = outline.of(plot.run, plot.quantities[plot.against].g, q.g,
        { x.lo[i], x.hi[i], of[k].lo[i], of[k].hi[i] })
    end
  end
  return list
end

local Plot = { __name = "plot" }
Plot.__index = Plot

-- The text of a file with this ending.
function Plot:text(format)
  check_converter(format_of("." .. check.text(format, "plot: text")))
  return text_of(self, format)
end

check.methods(Plot, Plot)

local function subject_of(t)
  if not run.is(t[1]) then
    check.fail("plot: expected what ambit.simulate returned as the first entry, got %s", check.kind(t[1]))
  end
  return t[1]
end

function verb.plot(t)
  check.table(t, "plot")
  check.keys(t, keys, "plot", 1)
  local subject, files, draws = subject_of(t), files_of(t), draws_of(t)
  local plot = setmetatable({ run = subject, quantities = quantity.list(t.quantities, subject) }, Plot)
  plot.title = t.title and check.text(t.title, "plot: title") or "proved motion"
  plot.limits = limit.list(t.limits, plot.quantities)
  plot.against = t.against ~= nil and t.against ~= "t" and quantity.find(plot.quantities, t.against, "plot: against")
    or nil
  plot.proved = subject.rigorous and subject.status ~= "broken"
  plot.course = course.of(subject, course.finer(subject), plot.quantities)
  plot.hull = draws and hull_of(subject, plot.quantities, draws)
  plot.outlines = plot.against and outlines_of(plot) or {}
  plot.verdicts = {}
  for k, l in pairs(plot.limits) do
    plot.verdicts[plot.quantities[k].name] = limit.judge(plot, k, l)
  end
  write(plot, files)
  return plot
end

-- run:csv { quantities = ..., file = ... }: the text, which is also written to the file if there is one.
function verb.csv(subject, t)
  local own = { subject, sample = false }
  for key, value in pairs(t == nil and {} or check.table(t, "csv")) do own[key] = value end
  check.keys(t or {}, { "quantities", "file" }, "csv")
  return verb.plot(own):text "csv"
end

return verb
