-- reduce/technique.lua -- by what a term of the equations may be replaced. Whatever it is, the proof compares the
-- result with the detailed model; here it need only be a good guess.
--
--   neglect    0
--   constant   its mean over the reference solutions, a number of six digits
--   enclosure  a fresh uncertain datum between the means over time of its least and of its greatest values along the
--              references (Mikelsons and Brandt 2009, equations 25 to 31, from enclosures instead)
--   linearise  its Taylor polynomial of first order in the states, about the mean of each over the references
--
-- A technique is a function(term, facts) -> expression, text; or nil where it has nothing to offer. term: of
-- core.term_list; facts: symbols (of the states), mean and size (of each state along the references), values (of this
-- term along them: { mean, size, lo, hi }), has (the techniques that come before: { [name] = true }), fresh(lo, hi) (a
-- symbol for a new uncertain datum), steady ({ [name] = true } of data that do not move).
local core = require "ambit.core"

local technique = {}

local NOTHING = 1e-9 -- part of the size of a quantity below which its mean is that of rounding errors

local function rounded(x) return ("%.6g"):format(x) end

-- A number of six digits as an expression; exactly that decimal.
local function decimal(x) return core.expression(rounded(x)) end

-- Is it the same at all times, whatever it is? steady: { [name] = true } of the symbols that are.
local function is_steady(expression, steady)
  for _, leaf in ipairs(core.leaves { expression }) do
    if leaf.kind ~= "unknown" and not (leaf.kind == "symbol" and steady[leaf.name]) then return false end
  end
  return true
end

function technique.neglect(term)
  local zero = core.expression(0)
  if term.expression == zero then return nil end
  return zero, "0"
end

local function is_finite(x) return x - x == 0 end

-- A mean of six digits, or 0 where it is that of rounding errors.
local function mean_of(values)
  return math.abs(values.mean) > NOTHING * values.size and rounded(values.mean) or "0"
end

function technique.constant(term, facts)
  if core.is_constant(term.expression) or not is_finite(facts.values.mean) then return nil end
  local text = mean_of(facts.values)
  if tonumber(text) == 0 and facts.has.neglect then return nil end
  return core.expression(text), text
end

function technique.enclosure(term, facts)
  if is_steady(term.expression, facts.steady) then return nil end
  local lo, hi = rounded(facts.values.lo), rounded(facts.values.hi)
  if not (is_finite(facts.values.lo) and is_finite(facts.values.hi) and tonumber(lo) < tonumber(hi)) then return nil end
  return facts.fresh(lo, hi), ("[%s, %s]"):format(lo, hi)
end

-- Does an expression depend on one of the states?
local function is_free_of(expression, symbols)
  for _, leaf in ipairs(core.leaves { expression }) do
    for _, symbol in ipairs(symbols) do
      if leaf.expression == symbol then return false end
    end
  end
  return true
end

-- { { i, derivative } } for each state that the term depends on; nil where it has none or is affine already.
local function slopes_of(expression, symbols)
  local list, is_affine = {}, true
  for i, symbol in ipairs(symbols) do
    local good, slope = pcall(core.derivative, expression, symbol)
    if not good then return nil end
    if slope ~= core.expression(0) then
      list[#list + 1] = { i, slope }
      is_affine = is_affine and is_free_of(slope, symbols)
    end
  end
  return not is_affine and list or nil
end

-- A number instead of an expression without variables.
local function shortened(expression)
  if #core.leaves { expression } > 0 or not core.is_constant(expression) then return expression end
  local x = core.interval(expression):mid()
  if x ~= x or math.abs(x) == math.huge then return nil end
  return decimal(x)
end

function technique.linearise(term, facts)
  local slopes = slopes_of(term.expression, facts.symbols)
  if not slopes then return nil end
  local middle = {}
  for i in ipairs(facts.symbols) do
    if not is_finite(facts.mean[i]) then return nil end
    middle[i] = core.expression(mean_of { mean = facts.mean[i], size = facts.size[i] })
  end
  local parts = { term.expression }
  for k, slope in ipairs(slopes) do parts[k + 1] = slope[2] end
  parts = core.substitute(parts, facts.symbols, middle)
  local sum = shortened(parts[1])
  for k, slope in ipairs(slopes) do
    local factor, i = shortened(parts[k + 1]), slope[1]
    if not sum or not factor then return nil end
    sum = sum + factor * (facts.symbols[i] - middle[i])
  end
  return sum, tostring(sum)
end

technique.names = { "branch", "neglect", "constant", "enclosure", "linearise", "merge" }

return technique
