-- state.lua -- m:state { "i", unit = "A", rate = function(q, i, t) ... end }: a quantity of a mechanism with a
-- first-order equation of its own, i' = rate. It is a state of m:dynamics(), and laws of force may depend on it.
--
-- q holds coordinates, speeds and states by name. A name that nothing has yet is that of a variable to come, so that
-- two states may depend on each other; verbs refuse what still has no variable.
local check = require "ambit.check"
local core = require "ambit.core"
local element = require "ambit.element"
local formula = require "ambit.formula"
local tree = require "ambit.tree"

local methods = {}

-- All variables that exist, by name; their units are not insisted on.
local function variables(self)
  local known = {}
  for _, list in ipairs { core.coordinates(self.handle), core.own_states(self.handle) } do
    for _, c in ipairs(list) do known[c.name] = core.in_unit(c.q, c.unit, true) end
  end
  for _, s in ipairs(core.speeds(self.handle)) do
    known[s.name] = core.in_unit(s.u, s.unit, true)
  end
  return setmetatable({}, {
    __index = function(_, name)
      return known[name] or core.symbol(check.text(name, "state: name of a variable"))
    end,
    __newindex = function(_, name) check.fail("state: `%s` cannot be assigned; return the rate", tostring(name)) end,
    __pairs = function() return next, known end,
  })
end

local function read_name(self, t)
  local name = t[1]
  if name == nil then name = t.name end
  if t[1] ~= nil and t.name ~= nil then check.fail "state: the name is given twice, first and as `name`" end
  if name == nil then check.fail "state: the name is missing: m:state { \"i\", unit = \"A\", rate = ... }" end
  check.text(name, "state: name")
  if name == "" then check.fail "state: the name is empty" end
  if name:find "'" then check.fail("state `%s`: a name cannot contain `'`: that marks time derivatives", name) end
  if name == "t" then check.fail "state `t`: the name is that of time" end
  return tree.named(self, "state", { name = name }).name
end

-- Its rate as an expression. own: the state itself.
local function read_rate(self, t, name, own)
  local rate, what = t.rate, ("state `%s`: rate"):format(name)
  if rate == nil then check.fail("%s is missing: a function(q, %s, t), or an expression", what, name) end
  if type(rate) == "function" then
    local arguments = { variables(self), core.in_unit(own, t.unit, true), core.time() }
    rate = core.written_by(self.handle, ("state `%s`"):format(name), formula.call, rate, what,
      table.unpack(arguments))
    if rate == nil then check.fail("%s: the function returned nothing", what) end
  end
  local e = core.expression(rate, t.unit and t.unit .. "/s", what)
  core.refuse_plain({ e }, what, true)
  return e
end

-- m:state { "i", unit = "A", rate = expression or function(q, i, t) } -> the state as an expression, in its unit
function methods:state(t)
  check.table(t, "state")
  check.keys(t, { "name", "unit", "rate" }, "state", 1)
  local name, d = read_name(self, t), element.declaration(core.default.state)
  if t.unit ~= nil then
    check.text(t.unit, ("state `%s`: unit"):format(name))
    core.expression("1 " .. t.unit, nil, ("state `%s`: unit"):format(name))
  end
  local rate, part = read_rate(self, t, name, core.symbol(name, t.unit)), core.part_count(self.handle)
  self.places[part] = core.where():gsub(": $", "")
  element.enter(self, d, name, self.places[part], { { rate } }, { -1, 0 }, t.unit)
  return core.in_unit(core.symbol(name), t.unit)
end

return { methods = methods }
