-- run/flow.lua -- what core.simulate, core.look, core.watch and core.sample_system run, of a request as
-- simulate.request makes it: the system's handle and, unless `changes` names others, the request's own settings.
local keys = { "solver", "arithmetic", "options", "arithmetic_options", "initial", "times" }

return function(q, changes)
  local flow = { system = q.system.system }
  for _, key in ipairs(keys) do
    flow[key] = changes and changes[key]
    if flow[key] == nil then flow[key] = q[key] end
  end
  flow.final = flow.times.exact and { flow.times.exact }
  return flow
end
