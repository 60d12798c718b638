-- source/latex.lua -- an ode as an aligned environment of LaTeX: parts, derivatives, then the sets of the data.
local core = require "ambit.core"
local source_model = require "ambit.source.model"

local source_latex = {}

local function number(x) return core.source({ core.expression(x) }, "latex")[1] end

-- Where a long right-hand side may go on in the next line: before a sign outside of all brackets.
local function breakable(text, width)
  local lines, from, depth, i = {}, 1, 0, 1
  while i <= #text do
    local c, two = text:sub(i, i), text:sub(i, i + 1)
    if two == "\\{" or two == "\\}" then
      i = i + 1
    elseif c == "{" or text:find("^\\left", i) then
      depth = depth + 1
    elseif c == "}" or text:find("^\\right", i) then
      depth = depth - 1
    elseif depth == 0 and text:find("^ [+-] ", i) and i - from > width then
      lines[#lines + 1] = text:sub(from, i - 1)
      from = i + 1
    end
    i = i + 1
  end
  lines[#lines + 1] = text:sub(from)
  return table.concat(lines, " \\\\\n  &\\quad {}")
end

function source_latex.write(self)
  local model, taken = source_model.read(self), {}
  local unique, lines, names = source_model.namer(taken, "^{\\ast}"), {}, {}
  local function add(expression, name)
    local text = unique(core.source_identifier("latex", name))
    names[#names + 1] = { expression, text }
    return text
  end
  for _, state in ipairs(model.states) do state.text = add(state.expression, state.name) end
  for _, datum in ipairs(model.data) do datum.text = add(datum.expression, datum.name) end
  for _, free in ipairs(model.free) do add(free.expression, free.name) end
  local formulas = {}
  for _, parameter in ipairs(model.parameters) do
    if not parameter.datum and not parameter.free and not core.is_constant(parameter.expression) then
      formulas[#formulas + 1] = { parameter.expression, unique(core.source_identifier("latex", parameter.name)) }
    end
  end
  local definitions = {}
  for i, formula in ipairs(formulas) do definitions[i] = core.source({ formula[1] }, "latex", names)[1] end
  table.move(formulas, 1, #formulas, #names + 1, names)
  local function part_name(i) return unique(("z_{%d}"):format(i)) end
  local parts, part_texts, rates = source_model.write(model, "latex", names, part_name)
  for i, part in ipairs(parts) do lines[#lines + 1] = ("%s &= %s"):format(part.name, breakable(part_texts[i], 90)) end
  for i, state in ipairs(model.states) do
    lines[#lines + 1] = ("\\dot{%s} &= %s"):format(state.text, breakable(rates[i], 90))
  end
  for i, formula in ipairs(formulas) do lines[#lines + 1] = ("%s &= %s"):format(formula[2], definitions[i]) end
  for _, datum in ipairs(model.data) do
    lines[#lines + 1] = ("%s &\\in \\left[%s, %s\\right]"):format(datum.text, number(datum.lo), number(datum.hi))
  end
  return "\\begin{aligned}\n  " .. table.concat(lines, " \\\\\n  ") .. "\n\\end{aligned}\n"
end

return source_latex
