-- When zonotope suits: data that bend the solution, many of them or by little, whose common effects it keeps, large
-- mechanisms, and kinks that the set crosses.
local MANY = 5      -- data ...
local LARGE = 12    -- ... or states from which on polynomials without generators are too large, and linear maps
local BENT = 1e-7   -- with so much bend, or width where the bend was not seen, lose what the data share
local LOOPS = 0.015 -- width of data up to which closed loops are as good without their constraints at each step, unless
                    -- the mechanism is twice as large
local CLEAR = 1e-5  -- bend from which on linear maps are wider, also of few data,
local WIDE = 0.02   -- and up to which few generators hold what polynomials of higher degree would;
local WIDEST = 0.2  -- of more than FEW data, in which such polynomials are slow
local FEW = 3
local SEEN = 0.5    -- part of the run up to which ordinary runs must come to tell the bend

return function(f)
  if (f.varying or 0) > 0 then return 1, "what varies in time acts on all states in common" end
  if f.task == "certify" and f.states >= LARGE and f.unknowns >= 1 and f.seen < SEEN then
    return 0.9, ("%d states, balances of forces instead of formulas for accelerations"):format(f.states)
  end
  if f.task == "certify" then return 0.05, "small errors are nearly linear in the data" end
  if f.kink then
    return 1, ("the solution crosses the kink of `%s`: a line takes its place meanwhile"):format(f.kink)
  end
  if f.unknowns == 0 and f.states >= 2 * LARGE and f.seen < SEEN then
    return 0.9, ("%d states with large equations"):format(f.states)
  end
  local bent = f.bend > BENT or f.seen < SEEN and f.width > BENT
  local many = f.unknowns >= MANY or f.unknowns > 0 and f.states >= LARGE
  if bent and many and (f.invariants == 0 or f.width <= LOOPS or f.states >= 2 * LARGE) then
    return 0.9, ("%d uncertain data and %d states: what they have in common is kept"):format(f.unknowns, f.states)
  end
  if f.invariants == 0 and f.unknowns > 0 and f.bend > CLEAR and f.bend < (f.unknowns > FEW and WIDEST or WIDE) then
    return 0.85, ("the data bend the solution by %.2g %% of its size, which low degrees follow"):format(100 * f.bend)
  end
  return f.unknowns > 0 and 0.55 or 0.3, "what the data have in common is kept"
end
