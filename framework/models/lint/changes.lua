-- lint/changes.lua -- what the instructions of a compiled function lead to and change: where it goes on, registers,
-- variables of the functions around (upvalues), fields of tables.
local bytecode = require "ambit.lint.bytecode"

local op, fields, wide, jump = bytecode.op, bytecode.fields, bytecode.wide, bytecode.jump

local changes = {}

local function set_of(names)
  local set = {}
  for name in names:gmatch "%S+" do set[op[name]] = true end
  return set
end

local tests = set_of "EQ LT LE EQK EQI LTI LEI GTI GEI TEST TESTSET"

-- What writes no register, tests excepted.
changes.silent = set_of "SETUPVAL SETTABUP SETTABLE SETI SETFIELD MMBIN MMBINI MMBINK CLOSE TBC JMP LT LE LTI LEI GTI \z
  GEI RETURN RETURN0 RETURN1 SETLIST VARARGPREP EXTRAARG TFORPREP TFORLOOP"

-- What may write all registers from its A on; any other writes A alone.
local several = set_of "LOADNIL SELF CALL TAILCALL VARARG FORLOOP FORPREP TFORCALL"

-- Where it may go on behind an instruction: up to two places.
function changes.next_of(o, pc, word)
  if tests[o] then return pc + 1, pc + 2 end
  if o == op.JMP then return pc + 1 + jump(word) end
  if o == op.LFALSESKIP then return pc + 2 end
  if o == op.RETURN or o == op.RETURN0 or o == op.RETURN1 then return nil end
  if o == op.FORPREP then return pc + 1, pc + 2 + wide(word) end
  if o == op.FORLOOP or o == op.TFORLOOP then return pc + 1, pc + 1 - wide(word) end
  if o == op.TFORPREP then return pc + 1 + wide(word) end
  return pc + 1
end

local function writes(word, register)
  local o, a, b = fields(word)
  if changes.silent[o] or tests[o] and o ~= op.TESTSET then return false end
  if o == op.LOADNIL then return register >= a and register <= a + b end
  if o == op.SELF then return register == a or register == a + 1 end
  return register == a or several[o] and register > a or false
end

-- May the local variable in a register be written behind pc, as long as it lives? A captured one ends with CLOSE.
function changes.is_written_behind(f, pc, register)
  local seen, open = {}, { pc + 1 }
  while #open > 0 do
    local at = table.remove(open)
    local word = f.code[at]
    if word and not seen[at] then
      seen[at] = true
      local o, a = fields(word)
      if writes(word, register) then return true end
      if o ~= op.CLOSE or a > register then
        local one, two = changes.next_of(o, at, word)
        if one then open[#open + 1] = one end
        if two then open[#open + 1] = two end
      end
    end
  end
  return false
end

-- The upvalues that f writes, or functions made in it: { [index] = true }
function changes.upvalues(f)
  if f.written then return f.written end
  f.written = {}
  for pc = 0, #f.code do
    local o, _, b = fields(f.code[pc])
    if o == op.SETUPVAL then f.written[b] = true end
  end
  for _, inner in pairs(f.functions) do
    for i in pairs(changes.upvalues(inner)) do
      if not inner.upvalues[i].in_stack then f.written[inner.upvalues[i].index] = true end
    end
  end
  return f.written
end

-- The registers whose local variables are written by functions made in f: { register, ... }
function changes.shared(f)
  if f.shared then return f.shared end
  f.shared = {}
  for _, inner in pairs(f.functions) do
    for i in pairs(changes.upvalues(inner)) do
      if inner.upvalues[i].in_stack then f.shared[#f.shared + 1] = inner.upvalues[i].index end
    end
  end
  return f.shared
end

-- Does a register only ever hold tables that f makes?
local function is_own(f, register)
  for pc = 0, #f.code do
    if writes(f.code[pc], register) and f.code[pc] & 0x7f ~= op.NEWTABLE then return false end
  end
  return register >= f.parameters
end

-- The key of a store into a table; nil: it is computed.
function changes.key(f, o, b)
  if o == op.SETFIELD or o == op.SETTABUP then return f.constants[b].value end
  if o == op.SETI then return b end
end

-- Calls back for each store of f, and of functions made in it, into tables that are perhaps not its own: store(key),
-- key being nil if it is computed.
function changes.stores(f, store)
  for pc = 0, #f.code do
    local o, a, b = fields(f.code[pc])
    if o == op.SETTABUP or (o == op.SETFIELD or o == op.SETI or o == op.SETTABLE) and not is_own(f, a) then
      store(changes.key(f, o, b))
    end
  end
  for _, inner in pairs(f.functions) do changes.stores(inner, store) end
end

return changes
