-- lint/bytecode.lua -- what a Lua function was compiled to, read from string.dump: instructions, constants, nested
-- functions, lines. Only for the Lua that it was written for (5.4, as the format's own header says); for any other
-- nothing is read, so that nothing wrong is said.
--
-- A function: { code = { [0] = word }, constants = { [0] = { value } }, upvalues = { [0] = { in_stack, index } },
-- functions = { [0] = function }, parameters = count, line = { [pc] = number }, jumps_to = { [pc] = true } }
local bytecode = {}

local HEADER = "\27Lua\x54\0\x19\x93\r\n\x1a\n\4\8\8" .. string.pack("<i8 d", 0x5678, 370.5)
local NO_DELTA = -128 -- the line is among the absolute ones

bytecode.op = {}
for number, name in ipairs {
  "MOVE", "LOADI", "LOADF", "LOADK", "LOADKX", "LOADFALSE", "LFALSESKIP", "LOADTRUE", "LOADNIL", "GETUPVAL", "SETUPVAL",
  "GETTABUP", "GETTABLE", "GETI", "GETFIELD", "SETTABUP", "SETTABLE", "SETI", "SETFIELD", "NEWTABLE", "SELF", "ADDI",
  "ADDK", "SUBK", "MULK", "MODK", "POWK", "DIVK", "IDIVK", "BANDK", "BORK", "BXORK", "SHRI", "SHLI", "ADD", "SUB",
  "MUL", "MOD", "POW", "DIV", "IDIV", "BAND", "BOR", "BXOR", "SHL", "SHR", "MMBIN", "MMBINI", "MMBINK", "UNM", "BNOT",
  "NOT", "LEN", "CONCAT", "CLOSE", "TBC", "JMP", "EQ", "LT", "LE", "EQK", "EQI", "LTI", "LEI", "GTI", "GEI", "TEST",
  "TESTSET", "CALL", "TAILCALL", "RETURN", "RETURN0", "RETURN1", "FORLOOP", "FORPREP", "TFORPREP", "TFORCALL",
  "TFORLOOP", "SETLIST", "CLOSURE", "VARARG", "VARARGPREP", "EXTRAARG",
} do
  bytecode.op[number - 1], bytecode.op[name] = name, number - 1
end

-- -- the reader: { text, at }

local function byte(r)
  r.at = r.at + 1
  return r.text:byte(r.at - 1)
end

-- Seven bits a byte, the last one marked.
local function count(r)
  local n = 0
  while true do
    local b = byte(r)
    n = n << 7 | b & 0x7f
    if b & 0x80 ~= 0 then return n end
  end
end

local function text(r)
  local size = count(r)
  if size == 0 then return nil end
  r.at = r.at + size - 1
  return r.text:sub(r.at - size + 1, r.at - 1)
end

local function unpacked(r, format)
  local value, at = string.unpack(format, r.text, r.at)
  r.at = at
  return value
end

local readers = {
  [0] = function() return nil end, [1] = function() return false end, [0x11] = function() return true end,
  [0x13] = function(r) return unpacked(r, "<d") end, [0x03] = function(r) return unpacked(r, "<i8") end,
  [0x04] = text, [0x14] = text,
}

local function list(r, read)
  local all = {}
  for i = 0, count(r) - 1 do all[i] = read(r) end
  return all
end

-- The line of each instruction.
local function lines(r, first)
  local deltas, line, all = list(r, function() return unpacked(r, "i1") end), first, {}
  local absolute = {}
  for _ = 1, count(r) do
    local pc = count(r)
    absolute[pc] = count(r)
  end
  for pc = 0, deltas[0] and #deltas or -1 do
    line = deltas[pc] == NO_DELTA and absolute[pc] or line + deltas[pc]
    all[pc] = line
  end
  return all
end

local function read_function(r)
  text(r) -- its source
  local first = count(r)
  count(r) -- its last line
  local f = { parameters = byte(r) }
  r.at = r.at + 2 -- is it vararg, how many registers
  f.code = list(r, function() return unpacked(r, "<I4") end)
  f.constants = list(r, function() return { value = readers[byte(r)](r) } end)
  f.upvalues = list(r, function()
    local in_stack, index = byte(r) == 1, byte(r)
    byte(r)
    return { in_stack = in_stack, index = index }
  end)
  f.functions = list(r, read_function)
  f.line = lines(r, first)
  list(r, function() return { text(r), count(r), count(r) } end) -- local variables
  list(r, text)                                                  -- names of upvalues
  return f
end

-- The function that was compiled, or nil: it is not Lua's, or its format is not known.
function bytecode.read(f)
  local good, dump = pcall(string.dump, f)
  if not good or dump:sub(1, #HEADER) ~= HEADER then return nil end
  local read, result = pcall(read_function, { text = dump, at = #HEADER + 2 })
  return read and result or nil
end

-- op, A, B, C, k of an instruction; Bx and sJ from the word
function bytecode.fields(word)
  return word & 0x7f, word >> 7 & 0xff, word >> 16 & 0xff, word >> 24 & 0xff, word >> 15 & 1 == 1
end

function bytecode.wide(word) return word >> 15 end
function bytecode.jump(word) return (word >> 7) - 16777215 end

-- Does this Lua compile as expected? Looked at once: a build of another Lua may say 5.4 as well.
local function is_known()
  local f = bytecode.read(function(a, b) return a.x == 0 or a == b end)
  if not f then return false end
  local seen = {}
  for pc = 0, #f.code do seen[#seen + 1] = bytecode.op[f.code[pc] & 0x7f] end
  local found = table.concat(seen, " ")
  return found:find "^GETFIELD EQI JMP EQ JMP" ~= nil
end

bytecode.known = is_known()

return bytecode
