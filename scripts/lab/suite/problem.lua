-- suite/problem.lua -- what the cases of the suite have in common: states y1 to yn, texts as numbers.
local problem = {}

-- { "y1", ..., "yn" }
function problem.states(n)
  local list = {}
  for i = 1, n do list[i] = "y" .. i end
  return list
end

-- make() of a case: rates(y, number, t, ambit) -> { derivative, ... } with y[1] to y[n]; initial: { value, ... } as
-- numbers, texts, or expressions of ambit made by a function.
function problem.make(title, n, rates, initial, t)
  return function(ambit)
    local names = problem.states(n)
    local system = ambit.ode { title, states = names, equations = function(s, _, time)
      local y = {}
      for i, name in ipairs(names) do y[i] = s[name] end
      return rates(y, ambit.number, time, ambit)
    end }
    return { system, initial = type(initial) == "function" and initial(ambit) or initial,
      t = type(t) == "table" and t or { 0, t } }
  end
end

-- { a, b, ... } of texts -> { y1 = a, y2 = b, ... }
function problem.digits(list)
  local x = {}
  for i, text in ipairs(list) do x["y" .. i] = text end
  return x
end

-- Values that are zero but for some: zeros(20, { [2] = "0.2" })
function problem.zeros(n, others)
  local list = {}
  for i = 1, n do list[i] = others and others[i] or 0 end
  return list
end

return problem
