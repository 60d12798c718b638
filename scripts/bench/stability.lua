-- stability.lua: the suite of `ambit stability` in short: what each solver makes of stiff and chaotic problems, and how
-- the extreme inputs end.
-- ambit run scripts/bench/stability.lua [PAGE.md]   prints the tables; every row goes to PAGE.md. Exit 1 if an outcome
-- is not the expected one. Takes some minutes.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local bench = require "bench"
local select_cases = require "ambit.suite.select"
local suite = require "ambit.suite.run"
local suite_table = require "ambit.suite.table"

local result = suite.run(select_cases.of(select_cases.own(), {}), { budget = 2 })

-- -- stiff and chaotic: cases against solvers

local columns = { "lohner", "taylor_model", "valencia", "stiff", "gsl" }

-- Is row a the better answer of the same solver? Further first, then more digits.
local function better(a, b)
  local reach, other = a.t_reached or 0, b.t_reached or 0
  if reach ~= other then return reach > other end
  return (a.digits or -1) > (b.digits or -1)
end

local function cell(row)
  if not row then return "" end
  if row.outcome == "proved" or row.outcome == "computed" then
    local quality = row.digits and ("%.1f digits, "):format(row.digits)
      or row.width and ("width %.2g, "):format(row.width)
    return (quality or "") .. bench.seconds(row.seconds)
  end
  if row.t_reached and row.t_end then
    return ("%s at %s of %s"):format(row.outcome, bench.number(row.t_reached), bench.number(row.t_end))
  end
  return row.outcome
end

bench.head("case", table.unpack(columns))
for _, case in ipairs(result.cases) do
  if case.group ~= "extreme" then
    local best = {}
    for _, row in ipairs(case.rows) do
      if row.solver and (not best[row.solver] or better(row, best[row.solver])) then best[row.solver] = row end
    end
    local cells = {}
    for i, name in ipairs(columns) do cells[i] = cell(best[name]) end
    bench.line(case.title, table.unpack(cells))
  end
end

-- -- extreme: how many of each outcome

local outcomes = { "proved", "computed", "unable", "refused", "late", "out of memory" }
local counts, names, cases, faults = {}, {}, 0, { crashed = 0, wrong = 0 }
for _, case in ipairs(result.cases) do
  if case.group == "extreme" then
    cases = cases + 1
    for _, row in ipairs(case.rows) do
      local name = row.solver and ("solver `%s`"):format(row.solver)
        or row.arithmetic and ("arithmetic `%s`"):format(row.arithmetic) or "what no solver sees"
      if not counts[name] then
        counts[name] = {}
        names[#names + 1] = name
      end
      counts[name][row.outcome] = (counts[name][row.outcome] or 0) + 1
      if faults[row.outcome] then faults[row.outcome] = faults[row.outcome] + 1 end
    end
  end
end
table.sort(names)
print(("\n%d extreme inputs; %d crashed, %d missed a reference or gave a NaN for a bound. What became of them:\n")
  :format(cases, faults.crashed, faults.wrong))
bench.head("in", table.unpack(outcomes))
for _, name in ipairs(names) do
  local cells = {}
  for i, outcome in ipairs(outcomes) do cells[i] = counts[name][outcome] or "" end
  bench.line(name, table.unpack(cells))
end

local bad = {}
for _, case in ipairs(result.cases) do
  for _, row in ipairs(case.rows) do
    if row.verdict ~= "as expected" then
      bad[#bad + 1] = ("%s, %s: %s instead of %s"):format(case.name, suite.label(row), row.outcome, row.expected)
    end
  end
end
print(("\n%d cases in %d seconds of CPU time; %d outcomes not as expected%s%s"):format(#result.cases,
  math.floor(result.cpu_seconds), #bad, #bad > 0 and ": " or ".", table.concat(bad, "; ")))

if arg[1] then
  local page = assert(io.open(arg[1], "w"))
  page:write("# Every stiff, chaotic and extreme case\n\n",
    "Written by `scripts/bench/stability.lua`; in short: [results](../results.md).\n\n",
    suite_table.markdown(result), "\n")
  assert(page:close())
end
bench.missed = #bad
bench.leave()
