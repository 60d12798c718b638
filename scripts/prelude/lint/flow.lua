-- lint/flow.lua -- where does a function compare an expression by == or ~=, or use it as a condition?
--
-- Values are followed through the compiled function: from its arguments and what it refers to outside, through locals,
-- arithmetic, functions of Ambit and functions of the scene. A value is
--   nil                                     nobody knows
--   { kind = "expression", name, sure }     an expression; sure: worked out here, not handed over and perhaps left out
--   { kind = "value", value }               a value of Lua: of a constant, or outside the function
--   { kind = "closure", f, upvalues }       a function made inside
-- Where ways meet that disagree, nobody knows: what is reported is an expression on every way.
local bytecode = require "ambit.lint.bytecode"
local check = require "ambit.check"

local op, fields, wide, jump = bytecode.op, bytecode.fields, bytecode.wide, bytecode.jump

local DEEPEST = 5      -- calls of functions within functions
local MOST_STEPS = 2e5 -- instructions followed in all; beyond nothing more is reported

local flow = {}

local function is_expression(v) return v ~= nil and v.kind == "expression" end
local function is_nil(v) return v ~= nil and v.kind == "value" and v.value == nil end
local function expression(name, sure) return { kind = "expression", name = name, sure = sure } end
local function constant(value) return { kind = "value", value = value } end

-- A value of Lua as it is followed.
local function of_value(value, name, sure)
  return check.kind(value) == "expression" and expression(name, sure) or constant(value)
end

flow.of_value = of_value

local function same(a, b)
  if a == nil or b == nil or a.kind ~= b.kind then return a == b end
  if a.kind == "expression" then return a.sure == b.sure end
  return a.kind == "value" and rawequal(a.value, b.value) or a == b
end

local function meet(a, b)
  if is_expression(a) and is_expression(b) then return expression(a.name, a.sure and b.sure) end
  return same(a, b) and a or nil
end

-- Functions of Ambit whose result is an expression if an argument is one.
local makers
local function is_maker(f)
  if not makers then
    makers = {}
    local ambit = require "ambit"
    for _, name in ipairs { "around", "number", "degrees", "derivative", "simplify", "sin", "cos", "tan", "asin", "acos",
      "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "sqr", "pow", "abs", "min", "max" } do
      makers[ambit[name]] = true
    end
  end
  return makers[f]
end

-- -- tables

-- t[key] without a side effect: of plain tables, of vectors and their like, of the tables that functions are given.
local function field(run, t, key)
  if not (t and t.kind == "value") or type(t.value) ~= "table" or key == nil then return nil end
  local meta = getmetatable(t.value)
  if meta == nil then
    if run.stored[key] then return nil end -- the function itself may change it
    return of_value(rawget(t.value, key), tostring(key), false)
  end
  local is_given = run.given[t.value] or type(meta) == "table" and meta.is_shape
  if not (is_given or run.globals == t.value) then return nil end
  local good, value = pcall(function() return t.value[key] end)
  return good and of_value(value, tostring(key), is_given) or nil
end

-- t[?]: an expression where the table that a function is given holds nothing else
local function any_field(run, t)
  if not (t and t.kind == "value" and run.given[t.value]) then return nil end
  local some = false
  for _, value in pairs(t.value) do
    if check.kind(value) ~= "expression" then return nil end
    some = true
  end
  return some and expression(nil, true) or nil
end

-- -- reports

local function report(run, f, pc, v, what)
  if run.quiet then return end
  local line = f.line[pc] or 0 -- 0: the function was compiled without lines
  if not run.found or line < run.found.line then run.found = { name = v.name, what = what, line = line } end
end

local function compare(run, f, pc, a, b)
  if is_expression(a) and not is_nil(b) then report(run, f, pc, a, "compared") end
  if is_expression(b) and not is_nil(a) then report(run, f, pc, b, "compared") end
end

-- `x or default` tests x and writes the default into the same register in front of where it jumps to.
local writes = {}
for name in ("MOVE LOADI LOADF LOADK LOADTRUE LOADFALSE LOADNIL GETUPVAL GETTABUP GETTABLE GETI GETFIELD NEWTABLE UNM NOT \z
  LEN CONCAT CALL CLOSURE"):gmatch "%S+" do writes[op[name]] = true end

local function is_default(f, pc, register)
  local last = f.code[pc + 1 + jump(f.code[pc + 1])]
  if not last then return false end
  local o, a = fields(last)
  return a == register and (writes[o] or o == op.MMBIN or o == op.MMBINI or o == op.MMBINK)
end

local function condition(run, f, pc, v, register, wants_true)
  if not (is_expression(v) and v.sure) then return end
  if wants_true and is_default(f, pc, register) then return end
  report(run, f, pc, v, "condition")
end

-- -- instructions: function(run, f, frame, a, b, c, k, pc, word) on the registers of the frame

local function constant_at(f, i) return constant(f.constants[i].value) end

local step = {}

step[op.MOVE] = function(_, _, frame, a, b) frame[a] = frame[b] end
step[op.LOADI] = function(_, _, frame, a, _, _, _, _, word) frame[a] = constant(wide(word) - 65535) end
step[op.LOADF] = function(_, _, frame, a, _, _, _, _, word) frame[a] = constant(wide(word) - 65535.0) end
step[op.LOADK] = function(_, f, frame, a, _, _, _, _, word) frame[a] = constant_at(f, wide(word)) end
step[op.LOADFALSE] = function(_, _, frame, a) frame[a] = constant(false) end
step[op.LFALSESKIP] = step[op.LOADFALSE]
step[op.LOADTRUE] = function(_, _, frame, a) frame[a] = constant(true) end
step[op.LOADNIL] = function(_, _, frame, a, b) for i = a, a + b do frame[i] = constant(nil) end end
step[op.GETUPVAL] = function(_, _, frame, a, b) frame[a] = frame.upvalues[b] end
step[op.GETTABUP] = function(run, f, frame, a, b, c)
  frame[a] = field(run, frame.upvalues[b], f.constants[c].value)
end
step[op.GETTABLE] = function(run, _, frame, a, b, c)
  local key = frame[c]
  if key and key.kind == "value" then frame[a] = field(run, frame[b], key.value) else frame[a] = any_field(run, frame[b]) end
end
step[op.GETI] = function(run, _, frame, a, b, c) frame[a] = field(run, frame[b], c) end
step[op.GETFIELD] = function(run, f, frame, a, b, c) frame[a] = field(run, frame[b], f.constants[c].value) end
step[op.SELF] = function(run, f, frame, a, b, c, k)
  local object = frame[b]
  frame[a + 1], frame[a] = object, k and field(run, object, f.constants[c].value) or nil
end

local function arithmetic(_, _, frame, a, b, c)
  local operand = is_expression(frame[b]) and frame[b] or frame[c]
  frame[a] = is_expression(operand) and expression(operand.name, true) or nil
end

local function with_constant(_, _, frame, a, b)
  frame[a] = is_expression(frame[b]) and expression(frame[b].name, true) or nil
end

for _, name in ipairs { "ADD", "SUB", "MUL", "POW", "DIV" } do
  step[op[name]], step[op[name == "ADD" and "ADDI" or name .. "K"]] = arithmetic, with_constant
end
step[op.ADDK], step[op.UNM] = with_constant, with_constant

step[op.NOT] = function(run, f, frame, a, b, _, _, pc)
  condition(run, f, pc, frame[b], nil, false)
  frame[a] = nil
end
step[op.EQ] = function(run, f, frame, a, b, _, _, pc) compare(run, f, pc, frame[a], frame[b]) end
step[op.EQK] = function(run, f, frame, a, b, _, _, pc) compare(run, f, pc, frame[a], constant_at(f, b)) end
step[op.EQI] = function(run, f, frame, a, _, _, _, pc) compare(run, f, pc, frame[a], constant(0)) end
step[op.TEST] = function(run, f, frame, a, _, _, k, pc) condition(run, f, pc, frame[a], a, k) end
step[op.TESTSET] = function(run, f, frame, a, b, _, k, pc)
  if not k then condition(run, f, pc, frame[b], a, false) end
  frame[a] = nil
end

-- -- functions

local follow

-- What the scene's own function returns: its first value.
local function call_closure(run, f, upvalues, arguments)
  if run.depth >= DEEPEST then return nil end
  run.depth = run.depth + 1
  local result = follow(run, f, upvalues, arguments)
  run.depth = run.depth - 1
  return result
end

local function upvalues_of(run, f)
  local list = {}
  for i = 1, 255 do
    local name, value = debug.getupvalue(f, i)
    if not name then break end
    if name == "_ENV" then run.globals = value end
    list[i - 1] = of_value(value, name, false)
  end
  return list
end

-- The same for calls of which the same would be found.
local function key_of(run, arguments)
  local parts = { run.quiet and "quiet" or "aloud" }
  for i = 0, arguments.count - 1 do
    local v = arguments[i]
    parts[#parts + 1] = v == nil and "?" or v.kind == "value" and type(v.value) .. tostring(v.value)
      or v.kind == "closure" and tostring(v) or v.kind
  end
  return table.concat(parts, "\0")
end

local function call_value(run, f, arguments)
  if f == pairs and arguments[0] then return constant(next), arguments[0], constant(nil) end
  if is_maker(f) then
    for i = 0, arguments.count - 1 do
      if is_expression(arguments[i]) then return expression(arguments[i].name, true) end
    end
    return nil
  end
  local info = type(f) == "function" and debug.getinfo(f, "S")
  if not info or info.what ~= "Lua" or info.source:sub(1, 9) == "=(ambit) " then return nil end
  local known, key = run.functions[f] or { code = bytecode.read(f) }, key_of(run, arguments)
  run.functions[f] = known
  if not known.code or known[key] then return known[key] and known[key].result end
  known[key] = {} -- also while it is followed: what calls itself is followed once
  local found = run.found
  known[key].result = call_closure(run, known.code, upvalues_of(run, f), arguments)
  if run.found ~= found then run.found.source = run.found.source or info.short_src end
  return known[key].result
end

step[op.CALL] = function(run, _, frame, a, b, c)
  local f, arguments = frame[a], { count = b == 0 and 16 or b - 1 }
  for i = 0, arguments.count - 1 do arguments[i] = frame[a + 1 + i] end
  local r1, r2, r3
  for i, v in pairs(arguments) do
    if i ~= "count" and v.sure then arguments[i] = expression(v.name, false) end
  end
  if f and f.kind == "closure" then r1 = call_closure(run, f.f, f.upvalues, arguments) end
  if f and f.kind == "value" then r1, r2, r3 = call_value(run, f.value, arguments) end
  for i in pairs(frame) do
    if type(i) == "number" and i >= a then frame[i] = nil end
  end
  if c ~= 1 then frame[a], frame[a + 1], frame[a + 2] = r1, r2, r3 end
end
step[op.TAILCALL] = step[op.CALL]

step[op.TFORCALL] = function(run, _, frame, a, _, c)
  local over = frame[a] and frame[a].value == next and frame[a + 1]
  for i = a + 4, a + 3 + c do frame[i] = nil end
  if over and c >= 2 then frame[a + 5] = any_field(run, over) end
end

step[op.CLOSURE] = function(_, f, frame, a, _, _, _, _, word)
  local inner, upvalues = f.functions[wide(word)], {}
  for i, upvalue in pairs(inner.upvalues) do
    if upvalue.in_stack then upvalues[i] = frame[upvalue.index] else upvalues[i] = frame.upvalues[upvalue.index] end
  end
  for pc = 0, #inner.code do
    local o, _, b = fields(inner.code[pc])
    if o == op.SETUPVAL and inner.upvalues[b].in_stack then frame[inner.upvalues[b].index] = nil end
  end
  frame[a] = { kind = "closure", f = inner, upvalues = upvalues }
end

step[op.VARARG] = function(_, _, frame, a)
  for i in pairs(frame) do
    if type(i) == "number" and i >= a then frame[i] = nil end
  end
end

-- What writes no register; any other instruction may write four from its A on.
local silent = {}
for name in ("SETUPVAL SETTABUP SETTABLE SETI SETFIELD MMBIN MMBINI MMBINK CLOSE TBC JMP LT LE LTI LEI GTI GEI RETURN \z
  RETURN0 RETURN1 SETLIST VARARGPREP EXTRAARG TFORPREP TFORLOOP"):gmatch "%S+" do silent[op[name]] = true end

local function other(_, _, frame, a) for i = a, a + 3 do frame[i] = nil end end

-- Where it may go on: up to two instructions.
local tests = {}
for name in ("EQ LT LE EQK EQI LTI LEI GTI GEI TEST TESTSET"):gmatch "%S+" do tests[op[name]] = true end

local function next_of(o, pc, word)
  if tests[o] then return pc + 1, pc + 2 end
  if o == op.JMP then return pc + 1 + jump(word) end
  if o == op.LFALSESKIP then return pc + 2 end
  if o == op.RETURN or o == op.RETURN0 or o == op.RETURN1 then return nil end
  if o == op.FORPREP then return pc + 1, pc + 2 + wide(word) end
  if o == op.FORLOOP or o == op.TFORLOOP then return pc + 1, pc + 1 - wide(word) end
  if o == op.TFORPREP then return pc + 1 + wide(word) end
  return pc + 1
end

-- What functions change outside of themselves: names of fields, and upvalues, about which nobody knows then.
local function note_stores(run, f, upvalues)
  for pc = 0, #f.code do
    local o, _, b = fields(f.code[pc])
    if o == op.SETFIELD or o == op.SETTABUP then run.stored[f.constants[b].value] = true end
    if o == op.SETI then run.stored[b] = true end
    if o == op.SETUPVAL and upvalues then upvalues[b] = nil end
    if o == op.CLOSURE then note_stores(run, f.functions[wide(f.code[pc])], nil) end
  end
end

local function copy_of(frame)
  local copy = {}
  for key, value in pairs(frame) do copy[key] = value end
  return copy
end

-- The frame at pc, with what another way brings there; nil: nothing new.
local function arrive(frames, pc, frame)
  local there = frames[pc]
  if not there then
    frames[pc] = copy_of(frame)
    return true
  end
  local changed = false
  for key, value in pairs(there) do
    if key ~= "upvalues" then
      local both = meet(value, frame[key])
      if not same(both, value) then there[key], changed = both, true end
    end
  end
  return changed
end

local function take(run, f, frame, pc)
  local word = f.code[pc]
  local o, a, b, c, k = fields(word)
  local act = step[o] or not silent[o] and other
  if act then act(run, f, frame, a, b, c, k, pc, word) end
  run.steps = run.steps + 1
  return o, a, b, word
end

-- Where ways part or meet: the first instruction, and all that are not merely behind another.
local function heads_of(f)
  local heads = { [0] = true }
  for pc = 0, #f.code do
    local one, two = next_of(f.code[pc] & 0x7f, pc, f.code[pc])
    if one and (two or one ~= pc + 1) then
      heads[one] = true
      if two then heads[two] = true end
    end
  end
  return heads
end

-- From a head to where the ways part, calling at_end(pc, frame) for each way; -> a returned value, does it return?
local function walk(run, f, heads, pc, frame, at_end)
  while f.code[pc] do
    local o, a, b, word = take(run, f, frame, pc)
    local one, two = next_of(o, pc, word)
    if not one then
      local returns = o == op.RETURN1 or o == op.RETURN and b ~= 1
      return returns and frame[a] or nil, returns
    end
    if two or heads[one] then
      at_end(one, frame)
      if two then at_end(two, frame) end
      return nil, false
    end
    pc = one
  end
end

-- What is known at each head, whatever way led there.
local function settle(run, f, heads, start)
  local frames, open = { [0] = start }, { 0 }
  local function at_end(pc, frame)
    if f.code[pc] and arrive(frames, pc, frame) then open[#open + 1] = pc end
  end
  while #open > 0 and run.steps < MOST_STEPS do
    local pc = table.remove(open)
    walk(run, f, heads, pc, copy_of(frames[pc]), at_end)
  end
  return frames, #open == 0
end

local function nothing() end

-- Reports what is wrong in f, unless the run is quiet, and returns its first result.
function follow(run, f, upvalues, arguments)
  note_stores(run, f, upvalues)
  local heads, start, quiet = heads_of(f), { upvalues = upvalues }, run.quiet
  for i = 0, f.parameters - 1 do start[i] = arguments[i] end
  run.quiet = true
  local frames, settled = settle(run, f, heads, start)
  run.quiet = quiet
  if not settled then return nil end
  local result, first = nil, true
  for pc, frame in pairs(frames) do
    local value, returns = walk(run, f, heads, pc, copy_of(frame), nothing)
    if returns and first then
      result, first = value, false
    elseif returns then
      result = meet(result, value)
    end
  end
  return result
end

-- f called with these arguments -> nil, or what is wrong: { name, what = "compared" or "condition", line, source }
function flow.search(f, arguments)
  local own = debug.getinfo(f, "S").source:sub(1, 9) == "=(ambit) "
  local read = bytecode.known and not own and bytecode.read(f)
  if not read then return nil end
  local run = { depth = 0, steps = 0, quiet = false, stored = {}, given = {}, functions = {} }
  local values = { count = arguments.n }
  for i = 1, arguments.n do
    local value = arguments[i]
    local meta = getmetatable(value)
    if type(value) == "table" and not (meta and meta.__name) then run.given[value] = true end -- no mechanism
    values[i - 1] = of_value(value, nil, false)
  end
  follow(run, read, upvalues_of(run, f), values)
  if run.found then run.found.source = run.found.source or debug.getinfo(f, "S").short_src end
  return run.found
end

return flow
