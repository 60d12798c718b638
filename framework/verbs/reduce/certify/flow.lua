-- certify/flow.lua -- what a proof of certify runs (run/flow.lua): the coupled system q, solved as `how` says.
return function(q, how)
  return { system = q.system.system, solver = how.solver, arithmetic = how.arithmetic,
    options = how.options, arithmetic_options = how.arithmetic_options, initial = q.initial, times = q.times }
end
