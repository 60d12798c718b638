-- interface.lua -- what a scene can call and what it gets back, declared once: help, types for editors, and tables of
-- keys in docs/ are made of it. An entry is
--   { class = NAME, of = "bases", doc = sentence, member, ... }: a table that is given or got;
--   { "= NAME", type, sentence }: another name for a type;
--   { "NAME(parameters)", type of what it gives, sentence }, { "NAME", type, sentence }: a function, a value of ambit.
-- Members are written as the last two; `?` behind a name: it may be missing. Two more columns of a member are `unit`,
-- of a number without one, and `default`, what stands for a key that is missing, as Lua text:
-- tests/lua/default_spec.lua tries each of them. Types are those of LuaCATS, without the "ambit." in front of the
-- classes here. What plugins declare is not said again: options_of = VERB stands for the options of its solvers,
-- elements = true for all elements.
local core = require "ambit.core"

local interface = { list = {}, classes = {}, functions = {} }

-- A sentence on one line.
local function sentence(text) return (text or ""):gsub("%s+", " ") end

function interface.name(member) return (member[1]:match "^[^?(]+") end

-- The sentence of a member, with its unit and its default.
local function described(member)
  local text, notes = sentence(member[3]), {}
  notes[1] = member.unit and "in " .. member.unit
  if member.default then notes[#notes + 1] = "default " .. member.default end
  if #notes == 0 then return text end
  return ("%s(%s)"):format(text == "" and "" or text .. " ", table.concat(notes, ", "))
end

local function take(entry)
  interface.list[#interface.list + 1] = entry
  entry.doc = sentence(entry.doc)
  for _, member in ipairs(entry.class and entry or { entry }) do
    member[2], member[3] = sentence(member[2]):gsub("| ", "|"), described(member)
  end
  if entry.class then
    interface.classes[entry.class] = entry
  elseif entry[1]:find "^= " then
    interface.classes[entry[1]:sub(3)] = entry
  else
    interface.functions[interface.name(entry)] = entry
  end
end

for _, part in ipairs { "value", "model", "run", "question", "reduction", "comparison" } do
  for _, entry in ipairs(require("ambit.interface." .. part)) do take(entry) end
end
local one = { "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "sqr", "abs" }
for _, name in ipairs(table.move(core.described_functions, 1, #core.described_functions, #one + 1, one)) do
  if not interface.functions[name] then
    take { name .. "(x: datum)", "value", "Of numbers, texts, expressions and enclosures." }
  end
end

-- The parts of a text between commas that lie in no brackets.
local function parts(text)
  local list, depth, from = {}, 0, 1
  for at, c in text:gmatch "()([%(%){}<>,])" do
    if c == "," and depth == 0 then
      list[#list + 1], from = text:sub(from, at - 1), at + 1
    elseif c ~= "," then
      depth = depth + (c:find "[({<]" and 1 or -1)
    end
  end
  if from <= #text then list[#list + 1] = text:sub(from) end
  return list
end

-- Of a function: { { name, type }, ... }, the names with their `?`; nil of a value.
function interface.parameters(member)
  local inside = member[1]:match "^[^(]*(%b())$"
  if not inside then return nil end
  local list = parts(inside:sub(2, -2))
  for i, text in ipairs(list) do list[i] = { text:match "^%s*(%S+): (.*)$" } end
  return list
end

-- Members of a class and of those that it is based on, each once; the own ones first.
function interface.members(class)
  local list, seen = {}, {}
  local function add(entry)
    for _, member in ipairs(entry) do
      local name = interface.name(member)
      if not seen[name] then list[#list + 1], seen[name] = member, true end
    end
    for base in (entry.of or ""):gmatch "[%w_.]+" do add(interface.classes[base]) end
  end
  add(class)
  return list
end

-- Which verb's solvers have their options in this class, or nil.
function interface.options_of(class)
  if class.options_of then return class.options_of end
  for base in (class.of or ""):gmatch "[%w_.]+" do
    local verb = interface.options_of(interface.classes[base])
    if verb then return verb end
  end
end

-- The classes in a type, with `change` done to their names: words that are neither quoted nor keys of a table.
function interface.types(text, change)
  return (text:gsub('()(%f[%w_."][%a_][%w_.]*)()', function(from, word, to)
    if not interface.classes[word] or text:sub(from - 1, from - 1) == '"' or text:find("^%??:", to) then return end
    return change(word)
  end))
end

return interface
