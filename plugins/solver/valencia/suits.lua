-- When valencia suits: equations with kinks that the solution crosses, or that are only continuous. It needs no
-- derivatives of higher order.
return function(f)
  if f.task == "sensitivity" then return 0.05, "a polynomial for each of the many states" end
  if f.kink then
    return 0.9, ("the solution crosses the kink of `%s`, and Taylor series need smooth equations"):format(f.kink)
  end
  return f.kinks > 0 and 0.25 or 0.1, "it needs no Taylor series"
end
