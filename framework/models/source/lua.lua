-- source/lua.lua -- an ode as a Lua program that returns it: the same expressions, node by node.
--
-- Data come back with their exact ends, as fresh unknowns. Symbols that are neither states nor parameters are to be
-- given to the program in a table: load(text) { v = ambit.between(1, 2) }.
local core = require "ambit.core"
local source_model = require "ambit.source.model"

local source_lua = {}

local keywords = {}
for word in ([[and break do else elseif end false for function goto if in local nil not or repeat return then true until
while]]):gmatch "%a+" do keywords[word] = true end

local function is_identifier(name) return name:find "^[%a_][%w_]*$" and not keywords[name] end
local function quoted(text) return (("%q"):format(text):gsub("\\\n", "\\n")) end
local function field(table_name, name)
  return is_identifier(name) and table_name .. "." .. name or ("%s[%s]"):format(table_name, quoted(name))
end
-- A variable, or where its name is no identifier the field of `data` that is called so.
function source_lua.variable(name) return is_identifier(name) and name or field("data", name) end
local function key(name) return is_identifier(name) and name or ("[%s]"):format(quoted(name)) end

local function number(x) return core.source({ core.expression(x) }, "lua")[1] end
local function between(datum) return ("between(%s, %s)"):format(number(datum.lo), number(datum.hi)) end

-- What everything is called inside the function(s, p, t); and where parameters are written.
local function names(model)
  local inside, outside = {}, {}
  for _, state in ipairs(model.states) do inside[#inside + 1] = { state.expression, field("s", state.name) } end
  for _, datum in ipairs(model.data) do
    inside[#inside + 1] = { datum.expression, field(datum.direct and "p" or "data", datum.name) }
    outside[#outside + 1] = { datum.expression, field("data", datum.name) }
  end
  for _, free in ipairs(model.free) do
    inside[#inside + 1] = { free.expression, field("p", free.name) }
    outside[#outside + 1] = { free.expression, field("given", free.name) }
  end
  for _, parameter in ipairs(model.parameters) do
    if not parameter.datum and not parameter.free and not core.is_constant(parameter.expression) then
      inside[#inside + 1] = { parameter.expression, field("p", parameter.name) }
    end
  end
  return inside, outside
end

-- Are there data that are no parameters by themselves, or parts of others too?
local function needs_table(model)
  for _, datum in ipairs(model.data) do
    if not datum.direct then return true end
  end
  for _, parameter in ipairs(model.parameters) do
    if not parameter.datum and #core.leaves { parameter.expression } > 0 then return true end
  end
  return false
end

local function write_data(out, model)
  if not needs_table(model) then return end
  out "local data = {"
  for _, datum in ipairs(model.data) do out(("  %s = %s,"):format(key(datum.name), between(datum))) end
  out "}"
end

local function write_parameters(out, model, outside)
  if #model.parameters == 0 and #model.free == 0 then return end
  local with_table, written = needs_table(model), {}
  out "  parameters = {"
  local function entry(name, text)
    out(source_model.wrap(("    %s = %s,"):format(key(name), text), "      ", 110))
    written[name] = true
  end
  for _, parameter in ipairs(model.parameters) do
    if parameter.datum and not with_table then
      entry(parameter.name, between(parameter.datum))
    elseif parameter.free then
      entry(parameter.name, field("given", parameter.name))
    else
      entry(parameter.name, core.source({ parameter.expression }, "lua", outside)[1])
    end
  end
  for _, free in ipairs(model.free) do
    if not written[free.name] then entry(free.name, field("given", free.name)) end
  end
  out "  },"
end

local function write_states(out, states)
  local list, plain = {}, true
  for _, state in ipairs(states) do plain = plain and state.unit == "1" end
  for i, state in ipairs(states) do
    list[i] = plain and quoted(state.name) or ("{ %s, %s }"):format(quoted(state.name), quoted(state.unit))
  end
  out(source_model.wrap("  states = { " .. table.concat(list, ", ") .. " },", "    ", 110))
  if not plain then out "  check_units = false, -- numbers stand for coefficients in SI units" end
end

local MOST_LOCALS = 150 -- Lua has 200

local function write_equations(out, model, inside)
  local function part_name(i, count) return count > MOST_LOCALS and ("z[%d]"):format(i) or "z" .. i end
  local parts, definitions, rates = source_model.write(model, "lua", inside, part_name)
  out "  equations = function(s, p, t)"
  if #parts > MOST_LOCALS then out "    local z = {}" end
  for i, part in ipairs(parts) do
    local head = #parts > MOST_LOCALS and "    " or "    local "
    out(source_model.wrap(head .. part.name .. " = " .. definitions[i], "      ", 110))
  end
  out "    return {"
  for i, state in ipairs(model.states) do
    out(source_model.wrap(("      %s = %s,"):format(key(state.name), rates[i]), "        ", 110))
  end
  out "    }"
  out "  end,"
end

-- local cos, sin = ambit.cos, ambit.sin: what the program uses
local function imports(body)
  local code = body:gsub('\\.', ""):gsub('"[^"\n]*"', '""')
  local used, from = {}, {}
  local names = table.move(core.described_functions, 1, #core.described_functions, 21, { "abs", "acos", "asin", "atan",
    "atan2", "between", "cos", "cosh", "exp", "interval", "log", "max", "min", "number", "pi", "sin", "sinh", "sqrt",
    "tan", "tanh" })
  table.sort(names)
  for _, name in ipairs(names) do
    if code:find("%f[%w_.]" .. name .. "%f[^%w_]") then
      used[#used + 1], from[#from + 1] = name, "ambit." .. name
    end
  end
  if #used == 0 then return "" end
  return source_model.wrap(("local %s = %s"):format(table.concat(used, ", "), table.concat(from, ", ")), "  ", 110)
    .. "\n"
end

function source_lua.write(self)
  local model = source_model.read(self)
  local lines = {}
  local function out(line) lines[#lines + 1] = line end
  local inside, outside = names(model)
  write_data(out, model)
  out "return ambit.ode {"
  out(("  name = %s,"):format(quoted(model.name)))
  write_states(out, model.states)
  write_parameters(out, model, outside)
  write_equations(out, model, inside)
  out "}"
  local body = table.concat(lines, "\n") .. "\n"
  local given = #model.free > 0 and 'local given = ... -- values of symbols, by name\n' or ""
  return 'local ambit = require "ambit"\n' .. imports(body) .. given .. body
end

return source_lua
