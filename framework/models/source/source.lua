-- source.lua -- equations as source: ode:text(), ode:lua(), ode:latex(), ode:modelica().
local core = require "ambit.core"
local source_model = require "ambit.source.model"

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

source.methods = { text = text }

for _, language in ipairs { "lua", "latex", "modelica" } do
  source.methods[language] = function(...) return require("ambit.source." .. language).write(...) end
end

return source
