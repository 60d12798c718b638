-- source/modelica.lua -- an ode as a model of Modelica (specification 3.6) that needs no library.
--
-- A datum is a parameter with the middle of its interval as value, the interval as bounds and as comment. Initial
-- values are not part of an ode.
local core = require "ambit.core"
local source_model = require "ambit.source.model"

local source_modelica = {}

local function number(x) return core.source({ core.expression(x) }, "modelica")[1] end
local function text(value)
  return '"' .. value:gsub('[\\"]', "\\%0"):gsub("%c", " ") .. '"'
end

-- "kg*m^2/s^2/A" as "kg.m2/(s2.A)"; nil if it is written in another way than by factors.
local function unit(value)
  if value:find "%^[-+]?%d+%.%d" or value:find "%^%(" then return nil end -- Modelica has whole powers only
  local above, below, rest = {}, {}, "*" .. value:gsub("^%s+", ""):gsub("%s+$", "")
  while rest ~= "" do
    local sign, factor, power, after = rest:match "^%s*([*./ ]?)%s*([%a%d]+)%^?(-?%d*)(.*)$"
    if not factor or not factor:find "^%a+$" and not factor:find "^1$" then return nil end
    if factor == "1" and power ~= "" then return nil end
    local list = sign == "/" and below or above
    if factor ~= "1" then list[#list + 1] = factor .. power end
    rest = after
  end
  local top = #above > 0 and table.concat(above, ".") or "1"
  if #below == 0 then return top end
  return top .. "/" .. (#below > 1 and "(" .. table.concat(below, ".") .. ")" or below[1])
end

local function attributes(list)
  return #list > 0 and "(" .. table.concat(list, ", ") .. ")" or ""
end

local function unit_attribute(value)
  local as = unit(value)
  return as and as ~= "1" and { ("unit = %s"):format(text(as)) } or {}
end

local function middle(datum)
  local x = datum.lo / 2 + datum.hi / 2
  return math.min(math.max(x, datum.lo), datum.hi)
end

local function declare_data(out, model)
  for _, datum in ipairs(model.data) do
    local lo, hi = number(datum.lo), number(datum.hi)
    out(("  parameter Real %s(min = %s, max = %s) = %s \"in [%s, %s]\";"):format(datum.text, lo, hi,
      number(middle(datum)), lo, hi))
  end
  for _, free in ipairs(model.free) do
    out(("  parameter Real %s%s \"to be given\";"):format(free.text, attributes(unit_attribute(free.unit))))
  end
end

local function declare_parameters(out, model, names, unique)
  local formulas = {}
  for _, parameter in ipairs(model.parameters) do
    if not parameter.datum and not parameter.free then
      local name = unique(core.source_identifier("modelica", parameter.name))
      local value = core.source({ parameter.expression }, "modelica", names)[1]
      out(source_model.wrap(("  parameter Real %s = %s;"):format(name, value), "    ", 110))
      if not core.is_constant(parameter.expression) then formulas[#formulas + 1] = { parameter.expression, name } end
    end
  end
  table.move(formulas, 1, #formulas, #names + 1, names)
end

local function declare_states(out, model)
  for _, state in ipairs(model.states) do
    out(("  Real %s%s;"):format(state.text, attributes(unit_attribute(state.unit))))
  end
end

-- In quotes, a number is put inside of them.
local function namer(taken)
  local plain = source_model.namer(taken, "_")
  return function(wanted)
    local inner = wanted:match "^'(.*)'$"
    if not inner then return plain(wanted) end
    local name, k = wanted, 1
    while taken[name] do
      k = k + 1
      name = ("'%s %d'"):format(inner, k)
    end
    taken[name] = true
    return name
  end
end

function source_modelica.write(self)
  local model, lines, names = source_model.read(self), {}, {}
  local unique = namer { pi = true }
  local function out(line) lines[#lines + 1] = line end
  for _, list in ipairs { model.states, model.data, model.free } do
    for _, entry in ipairs(list) do
      entry.text = unique(core.source_identifier("modelica", entry.name))
      names[#names + 1] = { entry.expression, entry.text }
    end
  end
  declare_data(out, model)
  declare_parameters(out, model, names, unique)
  declare_states(out, model)
  local function part_name(i) return unique("z" .. i) end
  local parts, definitions, rates = source_model.write(model, "modelica", names, part_name)
  for _, part in ipairs(parts) do out(("  Real %s;"):format(part.name)) end
  out "equation"
  for i, part in ipairs(parts) do
    out(source_model.wrap(("  %s = %s;"):format(part.name, definitions[i]), "    ", 110))
  end
  for i, state in ipairs(model.states) do
    out(source_model.wrap(("  der(%s) = %s;"):format(state.text, rates[i]), "    ", 110))
  end
  local name = core.source_identifier("modelica", model.name)
  local body = table.concat(lines, "\n")
  local code = body:gsub("\\.", ""):gsub("'[^'\n]*'", ""):gsub('"[^"\n]*"', "")
  local pi = code:find "%f[%w_]pi%f[^%w_]" and "  constant Real pi = 3.141592653589793;\n" or ""
  return ("model %s %s\n%s%s\nend %s;\n"):format(name, text(model.name), pi, body, name)
end

return source_modelica
