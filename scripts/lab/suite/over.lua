-- suite/over.lua -- the combinations of solver, arithmetic and options that a case is run with.
local check = require "ambit.check"
local core = require "ambit.core"
local option = require "ambit.option"

local over = {}

local function options_text(options)
  local list = {}
  for _, key in ipairs(check.sorted(options)) do list[#list + 1] = ("%s=%s"):format(key, tostring(options[key])) end
  return table.concat(list, " ")
end

-- { "affine", symbols = 10 } -> "affine", { symbols = 10 }
local function split_arithmetic(value)
  if type(value) ~= "table" then return value, {} end
  local options = {}
  for key, entry in pairs(value) do
    if key ~= 1 then options[key] = entry end
  end
  return value[1], options
end

local function installed(kind)
  local list = {}
  for _, entry in ipairs(core.list()) do
    if entry.kind == kind then list[#list + 1] = entry.name end
  end
  table.sort(list)
  return list
end

-- A plugin that does not load is a row too: its declaration is asked for again in the child.
local function declaration(kind, name)
  local good, found = pcall(option.declaration, kind, name)
  return good and found or { arithmetics = nil, verb = "simulate" }
end

local function combination(entry)
  local name, of_arithmetic = split_arithmetic(entry.arithmetic)
  local texts = {}
  for _, text in ipairs { options_text(of_arithmetic), options_text(entry.options or {}) } do
    if text ~= "" then texts[#texts + 1] = text end
  end
  if entry.solver and not name then
    name = (declaration("solver", entry.solver).arithmetics or "interval"):match "%S+"
  end
  return { solver = entry.solver, arithmetic = name, asked = entry.arithmetic, options = entry.options or {},
    options_text = table.concat(texts, " ") }
end

local verb_of = { simulate = "simulate", roots = "roots", equilibria = "roots", inverse_kinematics = "roots" }

-- first: each solver with its first arithmetic only
local function all(question, first)
  local list = {}
  if question == "evaluate" then
    for _, name in ipairs(installed "arithmetic") do list[#list + 1] = { arithmetic = name } end
    return list
  end
  for _, name in ipairs(installed "solver") do
    local found = declaration("solver", name)
    if found.verb == verb_of[question] then
      for arithmetic in (found.arithmetics or "interval"):gmatch "%S+" do
        list[#list + 1] = { solver = name, arithmetic = arithmetic }
        if first then break end
      end
    end
  end
  return #list > 0 and list or { {} }
end

local function entries(case)
  if case.over == nil or case.over == "all" then return all(case.question) end
  if case.over == "solvers" then return all(case.question, true) end
  return check.table(case.over, ("stability: case %s: over"):format(case.name))
end

-- -> { { solver, arithmetic, asked (as the verb takes it), options, options_text }, ... }
function over.of(case)
  local list = {}
  for _, some in ipairs { entries(case), case.also or {} } do
    for _, entry in ipairs(some) do
      local what = ("stability: case %s: over[%d]"):format(case.name, #list + 1)
      check.keys(check.table(entry, what), { "solver", "arithmetic", "options" }, what)
      list[#list + 1] = combination(entry)
    end
  end
  return list
end

function over.label(c)
  local words = {}
  for _, word in ipairs { c.solver or "", c.arithmetic or "", c.options_text } do
    if word ~= "" then words[#words + 1] = word end
  end
  return table.concat(words, " ")
end

return over
