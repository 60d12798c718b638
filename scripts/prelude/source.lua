-- source.lua -- equations as source: ode:text(), ode:lua(), ode:latex(), ode:modelica().
local core = require "ambit.core"
local source_latex = require "ambit.source.latex"
local source_lua = require "ambit.source.lua"
local source_model = require "ambit.source.model"
local source_modelica = require "ambit.source.modelica"

local source = {}

local function number(x) return core.source({ core.expression(x) }, "text")[1] end

-- The equations in full, with their data.
local function text(self)
  local model, lines, names = source_model.read(self), { ('ode "%s"'):format(self.name) }, {}
  for _, datum in ipairs(model.data) do names[#names + 1] = { datum.expression, datum.name } end
  local taken = {}
  for _, list in ipairs { model.states, model.data, model.free } do
    for _, entry in ipairs(list) do taken[entry.name] = true end
  end
  local unique = source_model.namer(taken, "_")
  local function part_name(i) return unique("z" .. i) end
  local parts, definitions, rates = source_model.write(model, "text", names, part_name)
  for i, part in ipairs(parts) do lines[#lines + 1] = ("  %s = %s"):format(part.name, definitions[i]) end
  for i, state in ipairs(model.states) do lines[#lines + 1] = ("  d %s/dt = %s"):format(state.name, rates[i]) end
  for _, datum in ipairs(model.data) do
    lines[#lines + 1] = ("  %s in [%s, %s]"):format(datum.name, number(datum.lo), number(datum.hi))
  end
  return table.concat(lines, "\n") .. "\n"
end

-- The methods of an ode.
function source.install(methods)
  methods.text = text
  methods.lua = source_lua.write
  methods.latex = source_latex.write
  methods.modelica = source_modelica.write
end

return source
