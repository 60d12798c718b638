-- lotka_volterra.lua: LOVO21, prey x and hunters y from [1.288, 1.312] x {1} once around, to t = 3.64. Solutions run
-- into the circle of radius 0.161 about (1, 1) or pass it: some touch it. Equations are the same on both sides.
--
-- The start is cut into pieces. For a piece all of whose solutions go in, or all of which stay out, events say so for
-- sure; for the others, which hold the tangent ones, the crossing is undecided. Proved is where all solutions are at
-- the end; how long each is inside is not.
local ambit = require "ambit"

local PIECES = 24
local radius = ambit.number "0.161"
local function outside(s) return (s.x - 1) ^ 2 + (s.y - 1) ^ 2 - radius ^ 2 end
local species = ambit.ode { states = { "x", "y" },
  equations = function(s) return { x = 3 * (s.x - s.x * s.y), y = s.x * s.y - s.y } end }

-- of one piece: 0 for surely outside, the number of crossings if they are all sure, or nil
local function crossings(run)
  for _, event in ipairs(run.events) do
    if not event.certain then return nil end
  end
  return #run.events
end

local function run()
  local row = { status = "complete", t_reached = 3.64, steps = 0, seconds = 0, certain = 0, undecided = 0 }
  local x, y, first, last
  for i = 1, PIECES do
    local start = ambit.between(("1.%d"):format(287 + i), ("1.%d"):format(288 + i)) -- adjacent decimals: no gap
    local one = ambit.simulate { species, initial = { x = start, y = 1 }, t = { 0, "3.64" }, solver = "taylor_model",
      events = { { g = outside, name = "circle" } } }
    if one.status ~= "complete" then
      row.status, row.t_reached, row.reason = one.status, one.t_reached, one.reason
      row.widths, row.proved = {}, false
      return row
    end
    local sure = crossings(one)
    if sure then row.certain = row.certain + 1 else row.undecided = row.undecided + 1 end
    for _, event in ipairs(one.events) do
      first, last = math.min(first or event.t.lo, event.t.lo), math.max(last or event.t.hi, event.t.hi)
    end
    x, y = x and x:hull(one.x.x) or one.x.x, y and y:hull(one.x.y) or one.x.y
    row.steps, row.seconds = row.steps + one.step_count, row.seconds + one.cpu_seconds
  end
  row.proved, row.crossings_within = true, { first, last }
  row.widths = { area = x:width() * y:width(), ["undecided of " .. PIECES] = row.undecided }
  return row
end

return { { problem = "LOVO21", property = "area at 3.64", run = run } }
