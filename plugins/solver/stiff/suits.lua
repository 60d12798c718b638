-- When stiff suits: motions that decay much faster than the solution changes. It needs derivatives everywhere.
local STIFF_PER_STEP = 100 -- e-folds of the fastest decay in one step of an ordinary stiff method
local STIFF_IN_ALL = 1000  -- and over the run: below, a series solver needs a few hundred steps at most

return function(f)
  if f.kinks > 0 then return nil end
  if f.task == "sensitivity" then return 0.05, "its steps grow with the cube of the many states" end
  if f.decay / math.max(f.steps, 1) > STIFF_PER_STEP and f.decay > STIFF_IN_ALL then
    return 0.95, ("stiff: the fastest motion decays by a factor of e %.2g times, where %d steps follow the \z
      solution"):format(f.decay, f.steps)
  end
  return f.decay > STIFF_IN_ALL and 0.4 or 0.1, "its steps follow the solution, not the fastest motion"
end
