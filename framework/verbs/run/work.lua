-- run/work.lua -- the report of a verb that is made of several runs: what was counted and spent is added up, sizes are
-- those of the largest run.
local core = require "ambit.core"

local work = {}

local added = { "steps" }
for _, entry in ipairs(core.work) do added[#added + 1] = entry[1] end
for _, stage in ipairs { "build", "graph", "tape", "context", "open", "run", "close" } do
  added[#added + 1] = "seconds_" .. stage
end

local largest = { "expressions", "states", "parameters", "unknowns", "graph_nodes", "tape_slots", "tape_constants",
  "tape_instructions", "tape_runs", "constant_slots" }

-- Adds the report of one run to `sum`, which is empty at first. Solver and arithmetic are those of the first run.
function work.add(sum, report)
  for _, key in ipairs(added) do
    if report[key] then sum[key] = (sum[key] or 0) + report[key] end
  end
  for _, key in ipairs(largest) do
    if report[key] then sum[key] = math.max(sum[key] or 0, report[key]) end
  end
  sum.solver, sum.arithmetic = sum.solver or report.solver, sum.arithmetic or report.arithmetic
end

return work
