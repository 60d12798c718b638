-- robots.lua: whole mechanisms with every tolerance: how far, how near to the truth, at what cost?
-- ambit run scripts/bench/robots.lua [--row NAME] [--solver NAME] [--draws N] [--seconds S] [--marks yes]
--
-- Prints a table: of each scene of scripts/bench/robots how far it is proved, with nothing chosen by the scene, the
-- largest width of the enclosures by that of the hull of samples, CPU time and memory, on one core. Samples are
-- ordinary runs of the same scene with drawn data: at random, half of them corners, and the corners at which each state
-- is least and greatest to first order, at each listed time. The factor counts states whose hull is wider than the
-- row's bound. --row: only rows whose name has this in it; --seconds: CPU time for each run, without it as much as it
-- takes; --marks: a line for each listed time, too.
-- Exit 1 if a row is missed, or a sample or a reference is not in its enclosure: then the table says OUTSIDE.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local core = require "ambit.core"
local bench = require "bench"
local replay = require "robots.replay"
local rows = require "robots.rows"

local asked = { draws = 60, seconds = math.huge }
do
  local i = 1
  while arg[i] do
    local key, value = arg[i]:match "^%-%-(%a+)$", arg[i + 1]
    if not value or not (key == "row" or key == "solver" or key == "draws" or key == "seconds" or key == "marks") then
      io.stderr:write(("robots.lua: unknown or incomplete option `%s`\n"):format(arg[i]))
      os.exit(2)
    end
    asked[key] = (key == "draws" or key == "seconds") and assert(tonumber(value), "a number is missing") or value
    i = i + 2
  end
end

-- The most memory since this was called last, MB; nil where Linux does not tell.
local function peak()
  local file = io.open "/proc/self/status"
  local kilobytes = file and tonumber(file:read("a"):match "VmHWM:%s*(%d+)" or nil)
  if file then file:close() end
  local reset = io.open("/proc/self/clear_refs", "w")
  if reset then
    reset:write "5"
    reset:close()
  end
  return kilobytes and kilobytes / 1024
end

-- What the scene asks, run: the run or report, its data, CPU seconds, memory.
local function prove(row)
  collectgarbage()
  peak()
  local result = replay.prove(row.scene, row.words, asked.solver, asked.seconds)
  result.memory = peak()
  return result
end

-- -- samples

local function draw(random, n)
  local point, is_corner = {}, random() < 0.5
  for k = 1, n do
    local s = 2 * random() - 1
    point[k] = is_corner and (s < 0 and -1 or 1) or s
  end
  return point
end

-- The corners at which each state is extreme to first order at each time, from one run for each datum.
local function vertices(sample, n, times, states)
  local middle, by = sample {}, {}
  for k = 1, n do by[k] = sample { [k] = 0.1 } end
  local corners, seen = {}, {}
  for i = 1, #times do
    for _, name in ipairs(states) do
      local low, high, key = {}, {}, {}
      for k = 1, n do
        local rises = by[k][i][name] >= middle[i][name]
        low[k], high[k], key[k] = rises and -1 or 1, rises and 1 or -1, rises and "+" or "-"
      end
      local text = table.concat(key)
      if not seen[text] then
        seen[text] = true
        corners[#corners + 1], corners[#corners + 2] = low, high
      end
    end
  end
  return corners
end

-- The hull of samples [time][state] = { lo, hi }, how many there are, and the first that is outside.
local function hull_of(row, proof, times)
  local states, n = proof.run.states, #proof.data
  local hull, count, outside = {}, 0, nil
  local function sample(point) return replay.sample(row.scene, row.words, proof.data, point, times) end
  local function see(point)
    local values = sample(point)
    count = count + 1
    for i, t in ipairs(times) do
      hull[i] = hull[i] or {}
      for _, name in ipairs(states) do
        local x, set = values[i][name], proof.at[i][name]
        local h = hull[i][name] or { x, x }
        hull[i][name] = { math.min(h[1], x), math.max(h[2], x) }
        local off = math.max(set.lo - x, x - set.hi) - 1e-10 * math.max(1, math.abs(x))
        if not (off <= 0) and not outside then outside = ("%s at t = %s by %.3g"):format(name, t, off) end
      end
    end
  end
  for _, corner in ipairs(vertices(sample, n, times, states)) do see(corner) end
  math.randomseed(1)
  for _ = 1, asked.draws do see(draw(math.random, n)) end
  return hull, count, outside
end

-- The largest factor, where it is, and the widest hull; per listed time, if `each` is given.
local function factor_of(row, proof, hull, times, each)
  local most, where, widest = 0, "", 0
  for i, t in ipairs(times) do
    local here, which, wide = 0, "no hull is as wide as " .. row.over, 0
    for _, name in ipairs(proof.run.states) do
      local h, set = hull[i][name], proof.at[i][name]
      local width = h[2] - h[1]
      wide = math.max(wide, width)
      if width > row.over and set:width() / width > here then
        here = set:width() / width
        which = ("%s %.4g over %.4g"):format(name, set:width(), width)
      end
    end
    if each then each(t, here, which) end
    if here > most then most, where = here, ("%s at %.3g s"):format(which:match "%S+", t) end
    widest = math.max(widest, wide)
  end
  return most, where, widest
end

-- -- lines

local function outcome(run)
  if run.status == "complete" then return ("%.3g s"):format(run.t_reached) end
  return ("**%.3g s**, %s"):format(run.t_reached, run.status)
end

local function cost(proof) return ("%s, %s"):format(bench.seconds(proof.cpu_seconds), proof.memory
  and ("%.0f MB"):format(proof.memory) or "-") end

-- Where the sample can be compared: listed times that were reached.
local function reached(proof)
  local times = {}
  proof.at = {}
  for _, t in ipairs(proof.times) do
    if t > proof.times[1] and t <= proof.run.t_reached then
      times[#times + 1] = t
      proof.at[#times] = proof.run:at(t)
    end
  end
  return times
end

local function required(row)
  local text = { row.t and ("%s s"):format(row.t) or "proved" }
  if row.factor then text[#text + 1] = ("factor %s"):format(row.factor) end
  if row.digits then text[#text + 1] = ("%d digits"):format(row.digits) end
  if row.cpu then text[#text + 1] = ("%s s of CPU"):format(row.cpu) end
  if row.memory then text[#text + 1] = ("%d MB"):format(row.memory) end
  return table.concat(text, ", ")
end

local function within(row, proof)
  return proof.cpu_seconds <= (row.cpu or math.huge) and (proof.memory or 0) <= (row.memory or math.huge)
end

local kinds = {}

function kinds.tolerances(row, proof)
  local run, times = proof.run, reached(proof)
  local text, good = "-", false
  if #times > 0 then
    local hull, count, outside = hull_of(row, proof, times)
    local factor, where, widest = factor_of(row, proof, hull, times, asked.marks and function(t, here, which)
      io.stderr:write(("%s: at %.4g s %.4g: %s\n"):format(row.name, t, here, which))
    end)
    good = not outside and factor <= row.factor
    text = factor > 0 and ("%.3g (%s)"):format(factor, where) or ("hull at most %.1g"):format(widest)
    text = text .. (", %d samples"):format(count)
    if outside then text = text .. ", **OUTSIDE**: " .. outside end
  end
  return outcome(run), text, good and run.status == "complete" and within(row, proof)
end

-- A reference is a rounded number: known to half a unit of its last digit.
local function holds(x, digits)
  local mantissa, exponent = digits:match "^([^e]*)e?(.*)$"
  local last = #(mantissa:match "%.(%d*)$" or "") - (tonumber(exponent ~= "" and exponent or 0))
  local half = ambit.interval(-1, 1) * ambit.interval("0.5e-" .. math.tointeger(last))
  local truth = ambit.interval(digits) + half
  return x.lo <= truth.hi and truth.lo <= x.hi
end

-- Digits: the widths of all states by their magnitude, or 1 if that is less.
function kinds.exact(row, proof)
  local run = proof.run
  if run.status ~= "complete" then return outcome(run), "-", false end
  local widest, off = 1e-17, nil
  for _, name in ipairs(run.states) do
    local x = run.x[name]
    widest = math.max(widest, x:width() / math.max(1, x:mag()))
    if row.reference[name] and not holds(x, row.reference[name]) then off = name end
  end
  local digits = -math.log(widest, 10)
  local text = ("%.1f digits"):format(digits) .. (off and ", **OUTSIDE**: " .. off or "")
  return outcome(run), text, not off and digits >= row.digits and within(row, proof)
end

function kinds.verify(row, proof)
  return proof.report.status, "-", proof.report.status == "proved" and within(row, proof)
end

bench.head("scene", "data", "required", "reached", "largest factor over the hull", "solver, steps", "CPU, memory", "")
-- Is the row asked for? A name that is one row's is no part of others' names.
local function wanted(row)
  for _, other in ipairs(rows) do
    if other.name == asked.row then return row == other end
  end
  return not asked.row or row.name:find(asked.row, 1, true)
end

local contradictions = 0
for _, row in ipairs(rows) do
  if wanted(row) then
    local proof = prove(row)
    local done, text, good = kinds[row.kind](row, proof)
    if not good then bench.missed = bench.missed + 1 end
    if text:find "OUTSIDE" then contradictions = contradictions + 1 end
    local run = proof.run
    bench.line(("%s (`%s`)"):format(row.what, row.name), #proof.data, required(row), done, text,
      run and ("`%s`, %d"):format(run.solver, run.step_count) or "-", cost(proof), good and "reached" or "**missed**")
    io.stdout:flush()
  end
end
if contradictions > 0 then error(("%d rows are contradicted by a sample or a reference"):format(contradictions), 0) end
bench.leave()
