-- bench.lua -- what the programs of this folder share: which of their parts are wanted, numbers as text, the least of
-- several run times, and lines of Markdown tables whose figures are reached or missed.
-- A program of this folder finds it by `package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path`.
local ambit = require "ambit"
local session = require "ambit.session"

local bench = { missed = 0, repeats = 5 }

local folder = (arg[0]:match ".*/" or "./") .. "../" -- of the scenes

local wanted = {}
for _, name in ipairs(arg or {}) do wanted[name] = true end

-- Is this part named on the command line? Without names, every part is.
function bench.wants(name) return next(wanted) == nil or wanted[name] end

function bench.number(x) return ("%.4g"):format(x) end

function bench.numbers(list)
  local text = {}
  for i, x in ipairs(list) do text[i] = bench.number(x) end
  return table.concat(text, " ")
end

-- 0.0123 -> "12.3 ms"
function bench.seconds(s)
  for _, unit in ipairs { { 1, "s" }, { 1e-3, "ms" }, { 1e-6, "us" }, { 1e-9, "ns" } } do
    if s >= unit[1] or unit[1] == 1e-9 then return ("%.3g %s"):format(s / unit[1], unit[2]) end
  end
end

-- The cells of one line.
function bench.line(...)
  local cells = table.pack(...)
  for i = 1, cells.n do cells[i] = tostring(cells[i]) end
  print("| " .. table.concat(cells, " | ") .. " |")
end

-- The head of a table.
function bench.head(...)
  bench.line(...)
  local rule = {}
  for i = 1, select("#", ...) do rule[i] = "---" end
  print("|" .. table.concat(rule, "|") .. "|")
end

-- A line whose last cell says whether the figure is reached.
function bench.figure(what, required, measured, ok)
  if not ok then bench.missed = bench.missed + 1 end
  bench.line(what, required, measured, ok and "reached" or "**missed**")
end

-- The exit code of the program: 1 if a figure is missed.
function bench.leave() os.exit(bench.missed == 0 and 0 or 1) end

-- Simulates several times: the run, and the least CPU seconds; what takes more than a second is run once.
function bench.simulate(t)
  local run = ambit.simulate(t)
  local least = run.cpu_seconds
  for _ = 2, least < 1 and bench.repeats or 1 do least = math.min(least, ambit.simulate(t).cpu_seconds) end
  return run, least
end

-- Runs a scene silently and returns what it asks of these verbs, in order: { verb, t, result } each.
function bench.listen(scene, verbs, words)
  local calls, own, show, write, exit, named = {}, {}, print, io.write, os.exit, arg
  for _, verb in ipairs(verbs) do
    own[verb] = ambit[verb]
    ambit[verb] = function(t)
      local result = own[verb](t)
      calls[#calls + 1] = { verb = verb, t = t, result = result }
      return result
    end
  end
  local left = {}
  arg = table.move(words or {}, 1, #(words or {}), 1, { [0] = folder .. scene .. ".lua" })
  print, io.write, os.exit = function() end, function() return io.stdout end, function() error(left, 0) end
  local good, problem = pcall(dofile, arg[0])
  print, io.write, os.exit, arg = show, write, exit, named
  for verb, f in pairs(own) do ambit[verb] = f end
  session.worst = "ok" -- scenes may well ask what cannot be proved
  if not good and problem ~= left then error(problem, 0) end
  return calls
end

-- Widths of an enclosure, in the order of the names.
function bench.widths(x, names)
  local w = {}
  for i, name in ipairs(names) do w[i] = x[name]:width() end
  return w
end

function bench.largest(x, names) return math.max(table.unpack(bench.widths(x, names))) end

-- The largest width relative to the magnitude of its state.
function bench.relative(x, names)
  local most = 0
  for _, name in ipairs(names) do most = math.max(most, x[name]:width() / x[name]:mag()) end
  return most
end

-- Do the enclosures contain reference digits (decimal texts)?
function bench.holds(x, names, digits)
  for i, name in ipairs(names) do
    local truth = ambit.interval(digits[i])
    if not (x[name].lo <= truth.hi and truth.lo <= x[name].hi) then return false end
  end
  return true
end

-- When the largest width is over a bound for the first time, and under it for the last time.
function bench.stays_under(run, names, bound)
  local first, last = run.t_reached, 0
  for step in run:steps() do
    local wide = bench.largest(step.x, names) > bound
    if wide and first == run.t_reached then first = step.t end
    if not wide then last = step.t end
  end
  return first, last
end

return bench
