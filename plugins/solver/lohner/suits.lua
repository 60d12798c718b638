-- When lohner suits: narrow sets and equations that are close to linear. Always worth a try, being the cheapest.
return function(f)
  if f.kink then return 0.2, "linear sets, up to the kink" end
  if f.invariants > 0 then return 0.6, "closed loops: it narrows the enclosure by their constraints at each step" end
  if f.unknowns == 0 then return 0.6, "not stiff, and no uncertain data" end
  return 0.6, "not stiff, and the solution is close to linear in the uncertain data"
end
