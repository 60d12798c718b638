-- parameter.lua -- the value of a declared parameter, in its declared shape, as expressions in its SI unit.
local check = require "ambit.check"
local core = require "ambit.core"

local parameter = {}

-- "N m/rad or N/m": some data have one unit or another.
function parameter.unit_text(param)
  return (param.unit:gsub("^|", ""):gsub("|$", ""):gsub("|", " or "))
end

local axes = { x = { 1, 0, 0 }, y = { 0, 1, 0 }, z = { 0, 0, 1 } }

local function one(param, value, what)
  if type(value) == "table" or type(value) == "function" or type(value) == "boolean" then
    check.fail("%s: expected a number, text or expression%s, got %s", what,
      param.unit ~= "1" and " in " .. parameter.unit_text(param) or "", check.kind(value))
  end
  local units = {}
  for unit in param.unit:gmatch "[^|]+" do units[#units + 1] = unit end
  for i = 1, #units - 1 do
    local fits, e = pcall(core.expression, value, units[i], what)
    if fits then return e end
  end
  return core.expression(value, units[#units], what)
end

local DEEPEST = 2 -- rows of numbers

-- { a, b, c }, { x =, y =, z = } or rows, as one list of n expressions
local function many(param, value, n, what)
  local list = {}
  local function walk(node, path, depth)
    if type(node) ~= "table" then
      list[#list + 1] = one(param, node, path)
    elseif depth > DEEPEST then
      check.fail("%s: expected a list of %d numbers, got lists within lists", what, n)
    elseif node.x ~= nil and node.y ~= nil and node.z ~= nil then
      for _, key in ipairs { "x", "y", "z" } do walk(node[key], path .. "." .. key, depth + 1) end
    else
      local count = 0
      for _ in pairs(node) do count = count + 1 end
      if count ~= #node then check.fail("%s: expected a list of %d numbers, got a table with other keys", what, n) end
      for i, child in ipairs(node) do walk(child, ("%s[%d]"):format(path, i), depth + 1) end
    end
  end
  if type(value) ~= "table" then check.fail("%s: expected a list of %d numbers, got %s", what, n, check.kind(value)) end
  walk(value, what, 1)
  if #list ~= n then check.fail("%s: expected %d numbers, got %d", what, n, #list) end
  return list
end

local function axis(param, value, what)
  if type(value) ~= "string" then
    local list = many(param, value, 3, what)
    local zero = core.expression(0)
    if list[1] == zero and list[2] == zero and list[3] == zero then check.fail("%s: the axis is zero", what) end
    return list
  end
  local sign, letter = value:match "^%s*([+-]?)%s*([xyz])%s*$"
  if not letter then check.fail('%s: expected an axis "x", "-z" or three numbers, got `%s`', what, value) end
  local list = {}
  for i, component in ipairs(axes[letter]) do list[i] = core.expression(sign == "-" and -component or component) end
  return list
end

local function flag(_, value, what)
  if type(value) ~= "boolean" then check.fail("%s: expected true or false, got %s", what, check.kind(value)) end
  return { core.expression(value and 1 or 0) }
end

local function integer(_, value, what)
  local n = math.tointeger(tonumber(value))
  if n and type(value) == "string" and core.interval(value):width() > 0 then n = nil end -- "3.00000000000000000001"
  if not n then check.fail("%s: expected an integer, got %s", what, tostring(value)) end
  return { core.expression(n) }
end

local function choice(param, value, what)
  local words = {}
  for word in param.shape:gmatch "[^|]+" do
    if word == value then return { core.expression(#words) } end
    words[#words + 1] = word
  end
  check.fail('%s: expected one of %s, got `%s`%s', what, table.concat(words, ", "), tostring(value),
    check.suggest(value, words))
end

local shapes = { axis = axis, flag = flag, integer = integer }

-- How many numbers a shape such as "", "3", "3x3" has.
local function extent(text)
  local n = 1
  for factor in text:gmatch "%d+" do n = n * tonumber(factor) end
  return n
end

-- express(param, value, what) -> { expression, ... }
function parameter.express(param, value, what)
  if param.shape:find "|" then return choice(param, value, what) end
  local special = shapes[param.shape]
  if special then return special(param, value, what) end
  if param.shape == "" then return { one(param, value, what) } end
  return many(param, value, extent(param.shape), what)
end

-- What the declaration itself says when the user says nothing; nil: absent. A constant is made only once.
local remembered = setmetatable({}, { __mode = "k" })

function parameter.fallback(param, what)
  local text = param.fallback
  if text == nil then check.fail('%s is required (%s)', what, param.doc or "no description") end
  if text == "" then return nil end
  if remembered[param] then return remembered[param] end
  local value = text
  if param.shape == "flag" then
    value = text == "true" or text == "1"
  elseif param.shape == "axis" and text:find "," or param.shape:find "^%d" then
    value = {}
    for part in text:gmatch "[^,%s]+" do value[#value + 1] = part end
    if #value == 1 then for i = 2, extent(param.shape) do value[i] = value[1] end end
  end
  remembered[param] = parameter.express(param, value, what)
  return remembered[param]
end

return parameter
