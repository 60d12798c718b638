-- passport.lua: the machines of scripts/passport, by the default call: proved, how near to the truth, at what cost?
-- ambit run scripts/bench/passport.lua [--row NAME] [--draws N] [--seconds S]
--
-- Each scene asks one question, with no option. It passes if the run is complete or the bounds are proved, in at most
-- 60 s of CPU, and no enclosure at a listed time is more than 1.5 times as wide as the hull of samples. The factor
-- counts a state at the times at which its hull is at least a hundredth as wide as its widest, unless that is below
-- 1e-6 of its magnitude. --seconds: CPU time for each question, 60 without it. Exit 1 if a row does not pass, or if a
-- sample lies outside its enclosure: then the table says OUTSIDE.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local core = require "ambit.core"
local bench = require "bench"

local FACTOR, SECONDS = 1.5, 60

local names = { "attitude", "cart_pole", "clutch", "crane", "dc_motor", "drone", "elevator", "engine", "five_bar",
  "furuta", "gearbox", "gimbal", "hexapod_leg", "hydraulic_boom", "lane_keeping", "maglev", "quarter_car", "robot_move",
  "satellite", "scara", "tower", "washing_machine", "wind_turbine", "wiper" }

local asked = { draws = 200, seconds = SECONDS }
for i = 1, #arg, 2 do
  local key, value = arg[i]:match "^%-%-(%a+)$", arg[i + 1]
  if not value or not (key == "row" or key == "draws" or key == "seconds") then
    io.stderr:write(("passport.lua: unknown or incomplete option `%s`\n"):format(arg[i]))
    os.exit(2)
  end
  asked[key] = key == "row" and value or assert(tonumber(value), "a number is missing")
end

-- The verbs on a budget of CPU time, and what the last call took.
local spent = 0
for _, verb in ipairs { "simulate", "verify" } do
  local own = ambit[verb]
  ambit[verb] = function(t)
    local began = core.cpu()
    core.deadline(began + asked.seconds)
    local result = own(t)
    core.deadline(nil)
    spent = core.cpu() - began
    return result
  end
end

-- Listed times that the run reached.
local function reached(run, t)
  local list = {}
  for i = 2, #t do
    local time = ambit.evaluate({ ambit.number(t[i]), arithmetic = "interval" }):mid()
    if time <= run.t_reached then list[#list + 1] = t[i] end
  end
  return list
end

-- The largest factor and where it is; a contradiction, if there is one.
local function against(run, t)
  local times = reached(run, t.t)
  if #times == 0 then return math.huge, "-" end
  local seen = ambit.sample { t[1], initial = t.initial, t = { t.t[1], table.unpack(times) }, n = asked.draws }
  local most, where = 0, "-"
  for _, name in ipairs(run.states) do
    local widest, size = 0, 0
    for _, time in ipairs(times) do
      local hull = seen:at(time)[name]
      widest, size = math.max(widest, hull.hi - hull.lo), math.max(size, math.abs(hull.lo), math.abs(hull.hi))
    end
    for _, time in ipairs(times) do
      local hull, set = seen:at(time)[name], run:at(time)[name]
      local width = hull.hi - hull.lo
      if widest > 1e-6 * size and width >= widest / 100 and set:width() / width > most then
        most, where = set:width() / width, ("%s at %s s"):format(name, time)
      end
    end
  end
  return most, where, run:overestimation(seen).contradiction
end

local passed, outside, rows = 0, 0, 0

local function row(name)
  collectgarbage()
  local call = bench.listen("passport/" .. name, { "simulate", "verify" })[1]
  local cpu, result, factor, where, wrong = spent, call.result, 0, "-", nil
  local done, outcome
  if call.verb == "verify" then
    done, outcome = result.status == "proved", result.status
  else
    done = result.status == "complete"
    outcome = ("%s at %.4g s"):format(result.status, result.t_reached)
    factor, where, wrong = against(result, call.t)
  end
  local passes = done and factor <= FACTOR and cpu <= SECONDS and not wrong
  rows, passed, outside = rows + 1, passed + (passes and 1 or 0), outside + (wrong and 1 or 0)
  bench.line(name, result.solver or "-", outcome,
    call.verb == "verify" and "-" or bench.number(factor), where, bench.seconds(cpu),
    wrong and "**OUTSIDE**" or passes and "passes" or "**fails**")
  if not done then io.stderr:write(name, ": ", result.reason or "?", "\n") end
end

bench.head("machine", "solver", "outcome", "width / hull", "at", "CPU", "")
for _, name in ipairs(names) do
  if not asked.row or name:find(asked.row, 1, true) then row(name) end
end
print(("\n%d of %d pass"):format(passed, rows))
os.exit((passed == rows and outside == 0) and 0 or 1)
