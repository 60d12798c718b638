-- operators.lua -- how a line of code is made wrong. Each operator is { name, function(code) -> { new code, ... } }: every
-- single place in the line where it applies gives one mutation. Comments and texts are blanked out before.
--
-- The operators imitate the mistakes that make an enclosure miss the truth: a bound rounded to the wrong side, a radius
-- or a remainder left out, the inner set taken for the outer one, a check that never fires.

-- Words of quantities whose loss makes a set too small.
local LOST = { "rad", "rest", "excess", "err", "eps", "lost", "local", "defect", "tail", "remainder", "spill", "slack",
  "bound", "width", "growth", "deviation", "margin", "pad" }

-- { { from, to }, ... } as whole words, both ways.
local SWAPS = {
  extremum = { { "larger", "smaller" }, { "fmax", "fmin" }, { "math.max", "math.min" }, { "mag", "mig" },
    { "ambit_interval_mag", "ambit_interval_mig" }, { "ambit_interval_hull", "ambit_interval_intersect" } },
  bound = { { "lo", "hi" }, { "least", "most" }, { "lower", "upper" }, { "below", "above" }, { "inner", "outer" },
    { "holds", "fails" } },
  direction = { { "ambit_round_up", "ambit_round_nearest" }, { "next_up", "next_down" }, { "step_up", "step_down" },
    { "next_above", "next_below" }, { "ambit_decimal_up", "ambit_decimal_down" } },
}

-- Calls f(first, last) for every whole word `word` of the code.
local function each_word(code, word, f)
  local from = 1
  while true do
    local a, b = code:find(word, from, true)
    if not a then return end
    local before, after = code:sub(a - 1, a - 1), code:sub(b + 1, b + 1)
    if not (a > 1 and before:find "[%w_]") and not after:find "[%w_]" then f(a, b) end
    from = b + 1
  end
end

local function replaced(code, a, b, new) return code:sub(1, a - 1) .. new .. code:sub(b + 1) end

local function swap(pairs_of_words)
  return function(code)
    local list = {}
    for _, pair in ipairs(pairs_of_words) do
      for k = 1, 2 do
        each_word(code, pair[k], function(a, b) list[#list + 1] = replaced(code, a, b, pair[3 - k]) end)
      end
    end
    return list
  end
end

-- Every plain occurrence of `from` becomes `to`.
local function plain(from, to)
  return function(code, list)
    local start = 1
    while true do
      local a, b = code:find(from, start, true)
      if not a then return end
      list[#list + 1] = replaced(code, a, b, to)
      start = b + 1
    end
  end
end

local logic = { plain("&&", "||"), plain("||", "&&"), plain(" and ", " or "), plain(" or ", " and ") }
local relation = { plain(" < ", " > "), plain(" > ", " < "), plain(" <= ", " >= "), plain(" >= ", " <= ") }

local function all(functions)
  return function(code)
    if code:find "^%s*for " then return {} end -- loops that do not run are noticed by everything
    local list = {}
    for _, f in ipairs(functions) do f(code, list) end
    return list
  end
end

local function is_lossy(code)
  local small = code:lower()
  for _, word in ipairs(LOST) do
    if small:find(word, 1, true) then return true end
  end
  return false
end

-- A check that never fires.
local function guard(code)
  local head, condition, rest = code:match "^(%s*if )(%b())(.*)$"
  if head then return { head .. "(0 && " .. condition .. ")" .. rest } end
  head, condition, rest = code:match "^(%s*if )(.-)( then.*)$"
  if head then return { head .. "false and (" .. condition .. ")" .. rest } end
  return {}
end

-- What is added to a radius is left out.
local function term(code)
  if not is_lossy(code) then return {} end
  local head, sum = code:match "^(.- %+= )(.-);"
  if not head then return {} end
  return { head .. "0 * (" .. sum .. ");" .. code:sub(#head + #sum + 2) }
end

-- A radius is taken for zero where it is used.
local function radius(code)
  local list, from = {}, 1
  while true do
    local a, b, name = code:find("([%a_][%w_.>%-]*)%b[]", from)
    if not a then return list end
    local after = code:sub(b + 1, b + 12)
    local stored = after:find "^%s*[%+%-%*/|&]?=[^=]" or after:find "^[%.%-%[]" or code:sub(a - 1, a - 1) == "&"
    if is_lossy(name) and not stored then list[#list + 1] = replaced(code, a, b, "(0 * " .. code:sub(a, b) .. ")") end
    from = b + 1
  end
end

local function sign(code)
  local list = {}
  if is_lossy(code) then
    plain(" + ", " - ")(code, list)
    plain(" - ", " + ")(code, list)
  end
  return list
end

-- A rounding unit is forgotten.
local function unit(code)
  local list, from = {}, 1
  while true do
    local a, b = code:find("0x1%.?%x*p%-%d+", from)
    if not a then return list end
    list[#list + 1] = replaced(code, a, b, "0.0")
    from = b + 1
  end
end

return {
  { "extremum", swap(SWAPS.extremum) },
  { "bound", swap(SWAPS.bound) },
  { "direction", swap(SWAPS.direction) },
  { "logic", all(logic) },
  { "relation", all(relation) },
  { "guard", guard },
  { "term", term },
  { "radius", radius },
  { "sign", sign },
  { "unit", unit },
}
