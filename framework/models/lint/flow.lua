-- lint/flow.lua -- where does a function compare an expression by == or ~=, or use it as a condition?
--
-- Values are followed through the compiled function: from its arguments and what it refers to outside, through locals,
-- arithmetic, functions of Ambit and functions of the scene. A value is
--   nil                                     nobody knows
--   { kind = "expression", name, sure }     an expression; sure: worked out here, not handed over and perhaps left out
--   { kind = "value", value }               a value of Lua: of a constant, or outside the function
--   { kind = "closure", f, upvalues }       a function made inside
--   { kind = "table" }                      a table made inside
-- Where ways meet that disagree, nobody knows: what is reported is an expression on every way. What is changed
-- somewhere (variables of the functions around, fields of tables) is known nowhere; since that is found on the way, the
-- search is repeated until nothing new is found.
local bytecode = require "ambit.lint.bytecode"
local changes = require "ambit.lint.changes"

local op, fields, wide, jump, next_of = bytecode.op, bytecode.fields, bytecode.wide, bytecode.jump, changes.next_of

local DEEPEST = 5      -- calls of functions within functions
local MOST_STEPS = 2e5 -- instructions followed in one search; beyond nothing more is reported
local MOST_PASSES = 9  -- searches until nothing new is changed; beyond nothing is reported

local own_table = { kind = "table" }

local flow = {}

local function is_expression(v) return v ~= nil and v.kind == "expression" end
local function is_nil(v) return v ~= nil and v.kind == "value" and v.value == nil end
local function expression(name, sure) return { kind = "expression", name = name, sure = sure } end
local function constant(value) return { kind = "value", value = value } end

-- A value of Lua as it is followed. Nothing of the scene's is called: its objects may raise errors.
local function of_value(value, name, sure)
  if type(value) == "userdata" and getmetatable(value) == "ambit.expression" then return expression(name, sure) end
  return constant(value)
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
    for _, name in ipairs { "around", "number", "degrees", "derivative", "simplify", "sin", "cos", "tan", "asin",
      "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "sqr", "pow", "abs", "min", "max" } do
      makers[ambit[name]] = true
    end
    for _, name in ipairs(require "ambit.core".described_functions) do makers[ambit[name]] = true end
  end
  return makers[f]
end

-- -- what is changed

local every = {} -- stands for all tables, or all keys

-- Somebody writes t[key]; t: a table or `every`, key: nil if it is computed
local function note_store(run, t, key)
  if key == nil or key ~= key then key = every end
  local keys = run.stored[t] or {}
  run.stored[t] = keys
  if not keys[key] then keys[key], run.news = true, true end
end

local function note_static_stores(run, f) changes.stores(f, function(key) note_store(run, every, key) end) end

local function is_stored(run, t, key)
  local one, all = run.stored[t], run.stored[every]
  return one and (one[key] or one[every]) or all and (all[key] or all[every])
end

-- Variables around a function of the scene's that it writes, or functions made in it.
local function note_upvalues(run, f, code)
  for i in pairs(changes.upvalues(code)) do
    local good, id = pcall(debug.upvalueid, f, i + 1)
    if good and id and not run.changed[id] then run.changed[id], run.news = true, true end
  end
end

-- A function that is handed to somebody may be called at any time.
local function note_function(run, v)
  if v and v.kind == "closure" then note_static_stores(run, v.f) end
  if not (v and v.kind == "value" and type(v.value) == "function") then return end
  local code = bytecode.read(v.value)
  if code then
    note_upvalues(run, v.value, code)
    note_static_stores(run, code)
  end
end

-- Called is what nobody knows: it may change everything that it can reach.
local function note_stranger(run)
  if not run.strangers then run.strangers, run.news = true, true end
end

-- What a function is handed to another one for: { count, [0] = v, ... }
local function note_arguments(run, arguments)
  for i = 0, arguments.count - 1 do
    local v = arguments[i]
    note_function(run, v)
    if v and v.kind == "value" and type(v.value) == "table" and not run.given[v.value] then
      note_store(run, v.value, nil)
    end
  end
end

-- -- tables

-- t[key] without a side effect: of plain tables, of vectors and their like, of the tables that functions are given.
local function field(run, t, key)
  if not (t and t.kind == "value") or type(t.value) ~= "table" or key == nil or is_stored(run, t.value, key) then
    return nil
  end
  local name, meta = type(key) == "string" and key or nil, debug.getmetatable(t.value)
  local raw, given = rawget(t.value, key), run.given[t.value]
  local is_own = meta and (given or rawget(meta, "is_shape")) or false
  if meta == nil or raw ~= nil then
    local v = of_value(raw, name, is_own)
    return (given or not (run.strangers and is_expression(v))) and v or nil
  end
  if not (is_own or rawequal(run.globals, t.value)) then return nil end
  local good, value = pcall(function() return t.value[key] end)
  return good and of_value(value, name, is_own) or nil
end

-- t[?]: an expression where the table that a function is given holds nothing else
local function any_field(run, t)
  if not (t and t.kind == "value" and run.given[t.value]) then return nil end
  local some = false
  if run.stored[t.value] or run.stored[every] and run.stored[every][every] then return nil end
  for _, value in pairs(t.value) do -- made by Ambit
    if not is_expression(of_value(value)) then return nil end
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
for name in ("MOVE LOADI LOADF LOADK LOADTRUE LOADFALSE LOADNIL GETUPVAL GETTABUP GETTABLE GETI GETFIELD NEWTABLE UNM \z
  NOT LEN CONCAT CALL CLOSURE"):gmatch "%S+" do writes[op[name]] = true end

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
  local is_known = key and key.kind == "value"
  if is_known then frame[a] = field(run, frame[b], key.value) else frame[a] = any_field(run, frame[b]) end
end
step[op.GETI] = function(run, _, frame, a, b, c) frame[a] = field(run, frame[b], c) end
step[op.GETFIELD] = function(run, f, frame, a, b, c) frame[a] = field(run, frame[b], f.constants[c].value) end
step[op.SELF] = function(run, f, frame, a, b, c, k)
  local object = frame[b]
  frame[a + 1], frame[a] = object, k and field(run, object, f.constants[c].value) or nil
end
step[op.NEWTABLE] = function(_, _, frame, a) frame[a] = own_table end

local function store_into(run, t, key)
  if t == own_table then return end
  note_store(run, t and t.kind == "value" and type(t.value) == "table" and t.value or every, key)
end

step[op.SETFIELD] = function(run, f, frame, a, b) store_into(run, frame[a], changes.key(f, op.SETFIELD, b)) end
step[op.SETI] = function(run, f, frame, a, b) store_into(run, frame[a], changes.key(f, op.SETI, b)) end
step[op.SETTABUP] = function(run, f, frame, a, b)
  store_into(run, frame.upvalues[a], changes.key(f, op.SETTABUP, b))
end
step[op.SETTABLE] = function(run, _, frame, a, b)
  local key = frame[b]
  store_into(run, frame[a], key and key.kind == "value" and key.value or nil)
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
  if run.depth >= DEEPEST then return note_stranger(run) end
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
    local v = of_value(value, name, false)
    local known = not run.changed[debug.upvalueid(f, i)] and not (run.strangers and is_expression(v))
    list[i - 1] = known and v or nil
  end
  return list
end

local function text_of(value)
  local kind = type(value)
  local is_plain = kind == "string" or kind == "number" or kind == "boolean" or kind == "nil"
  return kind .. (is_plain and tostring(value) or ("%p"):format(value))
end

-- The same for calls of which the same would be found.
local function key_of(run, arguments)
  local parts = { run.quiet and "quiet" or "aloud" }
  for i = 0, arguments.count - 1 do
    local v = arguments[i]
    parts[#parts + 1] = v == nil and "?" or v.kind == "value" and text_of(v.value)
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
  if not info then return note_stranger(run) end -- an object that can be called
  if info.what == "C" then return note_arguments(run, arguments) end
  if info.source:sub(1, 9) == "=(ambit) " then return nil end
  local known, key = run.functions[f] or { code = bytecode.read(f) }, key_of(run, arguments)
  run.functions[f] = known
  if not known.code then return note_stranger(run) end
  if known[key] then return known[key].result end
  known[key] = {} -- also while it is followed: what calls itself is followed once
  note_upvalues(run, f, known.code)
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
  if f and f.kind == "closure" then
    r1 = call_closure(run, f.f, f.upvalues, arguments)
  elseif f and f.kind == "value" then
    r1, r2, r3 = call_value(run, f.value, arguments)
  else
    note_stranger(run)
    note_arguments(run, arguments)
  end
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

step[op.CLOSURE] = function(_, f, frame, a, _, _, _, pc, word)
  local inner, upvalues = f.functions[wide(word)], {}
  for i, upvalue in pairs(inner.upvalues) do
    local index = upvalue.index
    if not upvalue.in_stack then
      upvalues[i] = frame.upvalues[index]
    elseif index ~= a and not changes.is_written_behind(f, pc, index) then
      upvalues[i] = frame[index]
    end
  end
  frame[a] = { kind = "closure", f = inner, upvalues = upvalues }
end

step[op.VARARG] = function(_, _, frame, a)
  for i in pairs(frame) do
    if type(i) == "number" and i >= a then frame[i] = nil end
  end
end

local function other(_, _, frame, a) for i = a, a + 3 do frame[i] = nil end end

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
  local act = step[o] or not changes.silent[o] and other
  if act then act(run, f, frame, a, b, c, k, pc, word) end
  for _, register in ipairs(changes.shared(f)) do frame[register] = nil end
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

-- From a head to where the ways part, calling at_end(pc, frame) for each way; -> the first returned value, does it
-- return?
local function walk(run, f, heads, pc, frame, at_end)
  while f.code[pc] do
    local o, a, b, word = take(run, f, frame, pc)
    local one, two = next_of(o, pc, word)
    if not one then
      if o == op.RETURN0 or o == op.RETURN and b == 1 then return constant(nil), true end
      return frame[a], true
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
  for i in pairs(changes.upvalues(f)) do upvalues[i] = nil end
  local heads, start, quiet = heads_of(f), { upvalues = upvalues }, run.quiet
  for i = 0, f.parameters - 1 do start[i] = arguments[i] end
  for _, register in ipairs(changes.shared(f)) do start[register] = nil end
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

-- One search, with what earlier ones found to be changed.
local function pass(run, f, code, arguments)
  run.depth, run.steps, run.quiet, run.functions, run.news, run.found = 0, 0, false, {}, false, nil
  local values = { count = arguments.n }
  for i = 1, arguments.n do values[i - 1] = of_value(arguments[i], nil, false) end
  note_upvalues(run, f, code)
  follow(run, code, upvalues_of(run, f), values)
end

-- Tables that a formula is given: of variables, vectors; no mechanism.
local function given_of(arguments)
  local given = {}
  for i = 1, arguments.n do
    local value = arguments[i]
    local meta = type(value) == "table" and debug.getmetatable(value)
    if type(value) == "table" and not (meta and rawget(meta, "__name")) then given[value] = true end
  end
  return given
end

-- f called with these arguments -> nil, or what is wrong: { name, what = "compared" or "condition", line, source }
function flow.search(f, arguments)
  local own = debug.getinfo(f, "S").source:sub(1, 9) == "=(ambit) "
  local read = bytecode.known and not own and bytecode.read(f)
  if not read then return nil end
  local run = { given = given_of(arguments), stored = {}, changed = {}, strangers = false }
  for _ = 1, MOST_PASSES do
    pass(run, f, read, arguments)
    if not run.found then return nil end -- more changes can only take from what is known
    if not run.news then
      run.found.source = run.found.source or debug.getinfo(f, "S").short_src
      return run.found
    end
  end
  return nil
end

return flow
