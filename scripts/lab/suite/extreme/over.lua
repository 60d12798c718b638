-- suite/extreme/over.lua -- every solver that moves in time, each with every arithmetic it takes.
local over = {}

function over.all()
  local list = {}
  for _, solver in ipairs { "lohner", "taylor_model", "stiff" } do
    list[#list + 1] = { solver = solver, arithmetic = "interval" }
  end
  for _, arithmetic in ipairs { "interval", "affine", "taylor_model", "gradient", "mpfr" } do
    list[#list + 1] = { solver = "valencia", arithmetic = arithmetic }
  end
  list[#list + 1] = { solver = "gsl", arithmetic = "real" }
  return list
end

-- One arithmetic for each: where the arithmetic does not matter.
function over.each()
  local list = {}
  for _, solver in ipairs { "lohner", "taylor_model", "stiff", "valencia" } do
    list[#list + 1] = { solver = solver, arithmetic = "interval" }
  end
  list[#list + 1] = { solver = "gsl", arithmetic = "real" }
  return list
end

return over
