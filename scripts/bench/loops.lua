-- loops.lua: closed loops, from the scenes of this tree.
-- ambit run scripts/bench/loops.lua   prints a table; exit 1 if a scene is not proved. Times are CPU time of the run.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local bench = require "bench"

local scenes = {
  { "andrews", { "0.01" }, "Andrews' squeezer, seven bodies, three loops" },
  { "andrews", { "0.03" }, "... three times as long" },
  { "n_four_bar", { "2" }, "N-four-bar, N = 2, hanging" },
  { "n_four_bar", { "10" }, "N-four-bar, N = 10, hanging" },
  { "bricard", {}, "Bricard's ring of six hinges, one equation redundant" },
  { "slider_crank_loop", {}, "slider-crank, closed" },
  { "stewart", {}, "Stewart platform" },
}

bench.head("mechanism", "states", "to t, s", "outcome", "largest width", "steps", "CPU")
for _, scene in ipairs(scenes) do
  local run = bench.listen(scene[1], { "simulate" }, scene[2])[1].result
  if run.status ~= "complete" then bench.missed = bench.missed + 1 end
  local widest = 0
  for _, name in ipairs(run.states) do widest = math.max(widest, run.x[name]:width()) end
  bench.line(("%s (`%s.lua`)"):format(scene[3], scene[1]), #run.states, bench.number(run.t_reached), run.status,
    bench.number(widest), run.step_count, bench.seconds(run.cpu_seconds))
end
bench.leave()
