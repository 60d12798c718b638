-- When taylor_model suits: few uncertain data that bend the solution. Its polynomials grow with the number of data.
local BEND = 1e-4 -- part of a state's size by which one datum bends the solution away from a linear map
local MANY = 8    -- data from which on polynomials are too large to be worth a try

return function(f)
  if f.task == "sensitivity" then return 0.05, "polynomials for each of the many states" end
  if f.task == "certify" then return 0.05, "small errors are nearly linear in the data" end
  if f.bend > BEND * f.unknowns ^ 2 and f.invariants == 0 and not f.kink then
    return 0.8, ("wide data: they spread the solution by %.2g %% of its size and bend it by %.2g %%, which a linear \z
      map does not follow"):format(100 * f.spread, 100 * f.bend)
  end
  if f.unknowns == 0 or f.unknowns > MANY or f.kink then return 0.1, "polynomials in the uncertain data" end
  return 0.5, "polynomials in the uncertain data"
end
