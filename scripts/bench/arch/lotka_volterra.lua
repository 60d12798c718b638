-- lotka_volterra.lua: LOVO21, prey x and hunters y from [1.288, 1.312] x {1} once around, to t = 3.64. Solutions run
-- into the circle of radius 0.161 about (1, 1) or pass it: some touch it. Equations are the same on both sides.
--
-- The start is cut into pieces. For a piece all of whose solutions cross the circle equally often, events say so for
-- sure; others are halved, down to LEAST. What is left undecided holds the solutions that touch: of these no
-- enclosure can say whether they cross. So proved is where all solutions are at the end, and how often each of them
-- crosses, but for those of the undecided part, whose share of the start is a figure.
local ambit = require "ambit"

local FIRST, LAST, PIECE, LEAST = 12880000, 13120000, 10000, 80 -- of the start, in units of 1e-7
local radius = ambit.number "0.161"
local function outside(s) return (s.x - 1) ^ 2 + (s.y - 1) ^ 2 - radius ^ 2 end
local species = ambit.ode { states = { "x", "y" },
  equations = function(s) return { x = 3 * (s.x - s.x * s.y), y = s.x * s.y - s.y } end }

-- of one piece: how often its solutions cross, if that is sure, or nil
local function crossings(run)
  for _, event in ipairs(run.events) do
    if not event.certain then return nil end
  end
  return #run.events
end

local function simulate(from, to)
  local start = ambit.between(("%de-7"):format(from), ("%de-7"):format(to))
  return ambit.simulate { species, initial = { x = start, y = 1 }, t = { 0, "3.64" }, solver = "taylor_model",
    events = { { g = outside, name = "circle" } }, partial = true }
end

local function take(row, from, to)
  local run = simulate(from, to)
  row.steps, row.seconds = row.steps + run.step_count, row.seconds + run.cpu_seconds
  if run.status ~= "complete" and run.status ~= "partial" then
    row.status, row.t_reached, row.reason, row.proved = run.status, run.t_reached, run.reason, false
    return
  end
  local count = crossings(run)
  if not count and to - from > LEAST then
    local middle = (from + to) // 2
    take(row, from, middle)
    return take(row, middle, to)
  end
  if count then row.crossings[count] = (row.crossings[count] or 0) + to - from end
  if not count then row.undecided = row.undecided + to - from end
  for _, name in ipairs { "x", "y" } do
    row[name] = row[name] and row[name]:hull(run.x[name]) or run.x[name]
  end
end

local function run()
  local row = { status = "complete", t_reached = 3.64, steps = 0, seconds = 0, proved = true, undecided = 0,
    crossings = {}, widths = {} }
  for from = FIRST, LAST - PIECE, PIECE do take(row, from, from + PIECE) end
  if not row.proved then return row end
  row.widths = { area = row.x:width() * row.y:width(), undecided = row.undecided / (LAST - FIRST) }
  return row
end

return { { problem = "LOVO21", property = "area at 3.64; how often each crosses", run = run } }
