-- formula.lua -- functions of the scene that are called once, with expressions, to write down a formula: equations,
-- laws, events, conditions, outputs.
--
-- While they run no expression has a value, so == and ~= between an expression and anything else say nothing about it,
-- and as a condition it always holds. Lua asks Ambit about == only where both sides are expressions (expression.c
-- refuses it below formula.call); for the rest the function itself is searched (lint/flow.lua).
local formula = {}

local sentences = {
  compared = "%s is compared by == or ~=, but it is an expression, which has no value while the formula is written: \z
    the comparison never depends on it. Use ambit.abs, ambit.min and ambit.max, or one mode for each case \z
    (ambit.hybrid)",
  condition = "%s is used as a condition, but it is an expression, which has no value while the formula is written: \z
    it always holds. Use ambit.abs, ambit.min and ambit.max, or one mode for each case (ambit.hybrid)",
}

-- Functions that were searched already.
local searched = setmetatable({}, { __mode = "k" })

local function search(f, what, ...)
  if type(f) ~= "function" or searched[f] then return end
  searched[f] = true
  local found = require("ambit.lint.flow").search(f, table.pack(...))
  if not found then return end
  local name = found.name and ("`%s`"):format(found.name) or "a value"
  searched[f] = nil
  error(("%s:%d: %s: %s"):format(found.source, found.line, what, sentences[found.what]:format(name)), 0)
end

-- f(...), whose values are expressions.
function formula.call(f, what, ...)
  search(f, what, ...)
  local results = table.pack(f(...))
  return table.unpack(results, 1, results.n) -- not a tail call: expression.c looks for this function
end

return formula
