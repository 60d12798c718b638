-- arch.lua: the benchmarks of ARCH-COMP's category "continuous and hybrid systems with nonlinear dynamics".
-- ambit run scripts/bench/arch.lua [NAME ...]   prints a table: problem, property, verdict, widths at the end, steps,
-- CPU time. NAME: a file of scripts/bench/arch; none: all. Exit 1 where a property is not proved.
--
-- Problems are as in the repeatability packages of the category: JuliaReach 2020 and 2024 (github.com/JuliaReach,
-- ARCH2020_NLN_RE and ARCH2024_NLN_RE) and Ariadne 2020. These hold problems and settings, not the figures of the
-- reports, which is why none is quoted.
local folder = arg[0]:match ".*/" or "./"
package.path = folder .. "?.lua;" .. folder .. "arch/?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"

local scenes = { "robertson", "coupled_van_der_pol", "laub_loomis", "lotka_volterra",
  "production_destruction", "rendezvous", "quadrotor" }

-- Where each state is at any time.
local function bounds_of(run)
  local bounds = {}
  for step in run:steps() do
    for name, x in pairs(step.tube) do bounds[name] = bounds[name] and bounds[name]:hull(x) or x end
  end
  return bounds
end

local function text_of(widths)
  local list = {}
  for name, w in pairs(widths) do list[#list + 1] = name .. " " .. bench.number(w) end
  table.sort(list)
  return table.concat(list, ", ")
end

-- What a case gives: its run by `simulate` and where it went, or what its own `run` answers.
local function measure(case)
  if case.run then return case.run() end
  local run = ambit.simulate(case.request)
  return { proved = case.proved(run, bounds_of(run)), status = run.status, t_reached = run.t_reached,
    reason = run.reason, widths = case.widths(run), steps = run.step_count, seconds = run.cpu_seconds }
end

local rows = {}
bench.head("problem", "property", "proved", "widths at the end", "steps", "CPU")
for _, name in ipairs(scenes) do
  for _, case in ipairs(bench.wants(name) and require(name) or {}) do
    local row = measure(case)
    row.problem, row.property = case.problem, case.property
    rows[#rows + 1] = row
    local verdict = row.proved and "yes" or row.status == "complete" and "**no**"
      or ("**no** (to %s)"):format(bench.number(row.t_reached))
    bench.line(case.problem, case.property, verdict,
      text_of(row.widths or {}), row.steps, bench.seconds(row.seconds))
    if not row.proved then bench.missed = bench.missed + 1 end
  end
end
for _, row in ipairs(rows) do
  if row.reason and row.reason ~= "" then print(("%s: %s"):format(row.problem, row.reason)) end
end
bench.leave()
