-- textbook.lua: a hundred systems of textbooks (scripts/textbook) by the default call, against every solver.
-- ambit run scripts/bench/textbook.lua [--half fit|show] [--area NAME] [--row TEXT] [--seconds S] [--draws N]
--
-- The default call passes if it is complete whenever any solver is, takes at most twice the CPU time of the best solver
-- (or 10 ms more), and its sets are at most 1.5 times as wide as the best one's. The best solver is the fastest of
-- those whose sets are at most 1.5 times as wide as the narrowest ones. Width is that of the worst state at the end, by
-- the hull of samples. What is tuned is tuned on the odd rows of each area (fit); the even ones show what it is worth.
-- --seconds: CPU time for each run, 10 without it. Exit 1 if a row does not pass.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local core = require "ambit.core"
local bench = require "bench"
local session = require "ambit.session"
local suggest = require "ambit.simulate.suggest"

local WIDER, SLOWER, MORE = 1.5, 2, 0.01 -- times, times, s
local folder = (arg[0]:match ".*/" or "./") .. "../textbook/"

local asked = { seconds = 10, draws = 64 }
for i = 1, #arg, 2 do
  local key, value = arg[i]:match "^%-%-(%a+)$", arg[i + 1]
  if not value or not (key == "half" or key == "area" or key == "row" or key == "seconds" or key == "draws") then
    io.stderr:write(("textbook.lua: unknown or incomplete option `%s`\n"):format(arg[i]))
    os.exit(2)
  end
  asked[key] = (key == "seconds" or key == "draws") and assert(tonumber(value), "a number is missing") or value
end

local solvers = suggest.candidates({}, {}, nil, "textbook")

local function question(entry)
  local _, states, equations, initial, t = table.unpack(entry)
  local o = ambit.ode { entry[1], states = states, equations = equations, check_units = false }
  return { o, initial = initial, t = { 0, t } }
end

-- The widest state by its hull; states whose hull is mostly rounding do not count.
local function factor_of(run, seen)
  local most = 0
  for _, name in ipairs(run.states) do
    local hull, set = seen.x[name], run.x[name]
    local width = hull.hi - hull.lo
    if width > 1e-6 * set:mag() then most = math.max(most, set:width() / width) end
  end
  return most
end

local function try(entry, seen, solver)
  local q = question(entry)
  q.solver = solver
  collectgarbage()
  local began = core.cpu()
  core.deadline(began + (solver and asked.seconds or 4 * asked.seconds))
  local run = ambit.simulate(q)
  core.deadline(nil)
  local result = { solver = run.solver, cpu = core.cpu() - began, complete = run.status == "complete",
    factor = math.huge, reached = run.t_reached }
  if result.complete then result.factor = factor_of(run, seen) end
  session.worst = "ok"
  return result
end

-- Of all solvers the fastest that is complete and nearly as narrow as the narrowest; nil: none is complete.
local function best_of(entry, seen)
  local list, narrowest, best = {}, math.huge, nil
  for i, solver in ipairs(solvers) do
    list[i] = try(entry, seen, solver)
    narrowest = math.min(narrowest, list[i].factor)
  end
  for _, result in ipairs(list) do
    if result.complete and result.factor <= WIDER * narrowest and (not best or result.cpu < best.cpu) then
      best = result
    end
  end
  return best, narrowest
end

local function outcome(result)
  if not result then return "none is complete" end
  if not result.complete then return ("%s, until %.3g s"):format(result.solver, result.reached) end
  return ("%s, %.3g, %s"):format(result.solver, result.factor, bench.seconds(result.cpu))
end

local passed, rows, complete, completable = 0, 0, 0, 0

local function row(area, entry)
  local q = question(entry)
  q.n = asked.draws
  local seen = ambit.sample(q)
  local own = try(entry, seen, nil)
  local best, narrowest = best_of(entry, seen)
  local why = {}
  if best and not own.complete then why[#why + 1] = "incomplete" end
  if best and own.complete and own.factor > WIDER * narrowest then why[#why + 1] = "wide" end
  if best and own.cpu > math.max(SLOWER * best.cpu, best.cpu + MORE) then why[#why + 1] = "slow" end
  rows, passed = rows + 1, passed + (#why == 0 and 1 or 0)
  complete, completable = complete + (own.complete and 1 or 0), completable + (best and 1 or 0)
  bench.line(area, entry[1], outcome(own), outcome(best), #why == 0 and "passes" or table.concat(why, ", "))
end

bench.head("area", "system", "default: solver, width / hull, CPU", "best", "")
for _, area in ipairs { "mechanics", "circuits", "chemistry", "biology", "control" } do
  for i, entry in ipairs(dofile(folder .. area .. ".lua")) do
    local half = i % 2 == 1 and "fit" or "show"
    if (not asked.half or asked.half == half) and (not asked.area or asked.area == area)
      and (not asked.row or entry[1]:find(asked.row, 1, true)) then
      row(area, entry)
    end
  end
end
print(("\n%d of %d pass; %d are complete, %d by any solver"):format(passed, rows, complete, completable))
os.exit(passed == rows and 0 or 1)
