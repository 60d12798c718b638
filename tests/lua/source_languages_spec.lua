-- Equations as Modelica, LaTeX and text: small readers calculate what they read, and it is what the equation says.
local ambit = require "ambit"
local core = require "ambit.core"

-- ---- readers: each returns the value of the source, and fails on what its grammar does not have

local functions = {
  sin = math.sin, cos = math.cos, tan = math.tan, asin = math.asin, acos = math.acos, exp = math.exp, log = math.log,
  sqrt = math.sqrt, abs = math.abs, min = math.min, max = math.max, atan2 = math.atan, atan = math.atan,
  sinh = function(x) return (math.exp(x) - math.exp(-x)) / 2 end,
  cosh = function(x) return (math.exp(x) + math.exp(-x)) / 2 end,
  tanh = function(x) return 1 - 2 / (math.exp(2 * x) + 1) end,
}

-- Modelica 3.6, appendix A.2.7: arithmetic_expression, term, factor, primary. In `text` exponents may have a sign.
local function read_infix(source, values, is_text)
  local at = 1
  local expression
  local function skip() at = source:find("%S", at) or #source + 1 end
  local function take(pattern)
    skip()
    local first, last, what = source:find("^(" .. pattern .. ")", at)
    if first then at = last + 1 end
    return what
  end
  local function need(pattern)
    return take(pattern) or error(("expected %s at %q"):format(pattern, source:sub(at, at + 30)))
  end
  local function name()
    local quoted = take "'"
    if not quoted then return take "[%a_][%w_.]*'*" end
    local body = ""
    while source:sub(at, at) ~= "'" do
      local c = source:sub(at, at + (source:sub(at, at) == "\\" and 1 or 0))
      assert(c ~= "" and not c:find "[%c\128-\255]", "a quoted identifier ends badly")
      body, at = body .. c, at + #c
    end
    at = at + 1
    return "'" .. body .. "'"
  end
  local function primary()
    local number = take "%d+%.?%d*[eE][+-]?%d+" or take "%d+%.?%d*" or is_text and take "%.%d+[eE]?[+-]?%d*"
    if number then
      assert(number:find "[.eE]" or is_text or tonumber(number) < 2 ^ 31, "an integer overflows")
      return tonumber(number) + 0.0
    end
    if take "%(" then
      local value = expression()
      need "%)"
      return value
    end
    local word = name()
    assert(word, "nothing to read at " .. source:sub(at, at + 30))
    if not take "%(" then return values[word] or error("no value for " .. word) end
    local arguments = { expression() }
    while take "," do arguments[#arguments + 1] = expression() end
    need "%)"
    return functions[word](table.unpack(arguments))
  end
  local function factor()
    local base = primary()
    if not take "%^" then return base end
    local sign = is_text and take "%-" and -1 or 1
    return base ^ (sign * primary())
  end
  local function term()
    local value = factor()
    while true do
      local sign = take "[*/]"
      if not sign then return value end
      local right = factor()
      if sign == "*" then value = value * right else value = value / right end
    end
  end
  function expression()
    local value = take "%-" and -term() or term()
    while true do
      local sign = take "[+-]"
      if not sign then return value end
      local right = term()
      value = sign == "+" and value + right or value - right
    end
  end
  local value = expression()
  skip()
  assert(at > #source, "left over: " .. source:sub(at))
  return value
end

local function read_latex(source, values)
  local at, names = 1, {}
  for name in pairs(values) do names[#names + 1] = name end
  table.sort(names, function(a, b) return #a > #b or (#a == #b and a < b) end)
  local expression
  local function take(literal)
    at = source:find("%S", at) or #source + 1
    if source:sub(at, at + #literal - 1) ~= literal then return false end
    at = at + #literal
    return true
  end
  local function need(literal)
    if not take(literal) then error(("expected %s at %q"):format(literal, source:sub(at, at + 30))) end
  end
  local function number()
    at = source:find("%S", at) or #source + 1
    local first, last = source:find("^%d+%.?%d*", at)
    if not first then first, last = source:find("^%.%d+", at) end
    if not first then return nil end
    at = last + 1
    return tonumber(source:sub(first, last)) + 0.0
  end
  local function group()
    need "{"
    local value = expression()
    need "}"
    return value
  end
  local of = { ["\\sin"] = "sin", ["\\cos"] = "cos", ["\\tan"] = "tan", ["\\sinh"] = "sinh", ["\\cosh"] = "cosh",
    ["\\tanh"] = "tanh", ["\\exp"] = "exp", ["\\ln"] = "log", ["\\arcsin"] = "asin", ["\\arccos"] = "acos",
    ["\\arctan"] = "atan", ["\\operatorname{atan2}"] = "atan2", ["\\min"] = "min", ["\\max"] = "max" }
  local spelt = {}
  for name in pairs(of) do spelt[#spelt + 1] = name end
  table.sort(spelt, function(a, b) return #a > #b or (#a == #b and a < b) end)
  local function primary()
    local value = number()
    if value then return value end
    if take "\\frac" then
      local above = group()
      return above / group()
    end
    if take "\\sqrt" then return math.sqrt(group()) end
    if take "\\left(" then
      value = expression()
      need "\\right)"
      return value
    end
    if take "\\left|" then
      value = expression()
      need "\\right|"
      return math.abs(value)
    end
    for _, name in ipairs(names) do
      if take(name) then return values[name] end
    end
    for _, name in ipairs(spelt) do
      if take(name) then
        local power = take "^" and group() or 1
        need "\\left("
        local arguments = { expression() }
        while take "," do arguments[#arguments + 1] = expression() end
        need "\\right)"
        return functions[of[name]](table.unpack(arguments)) ^ power
      end
    end
    error("nothing to read at " .. source:sub(at, at + 30))
  end
  local function factor()
    local base = primary()
    return take "^" and base ^ group() or base
  end
  local function term()
    local value = factor()
    while take "\\," or take "\\cdot" do value = value * factor() end
    return value
  end
  function expression()
    local value = take "-" and -term() or term()
    while true do
      if take "+" then
        value = value + term()
      elseif take "-" then
        value = value - term()
      else
        return value
      end
    end
  end
  local value = expression()
  assert(at > #source, "left over: " .. source:sub(at))
  return value
end

local here = debug.getinfo(1, "S").source:match "^@(.*/)" or ""
local random_expression = dofile(here .. "environment/random_expression.lua")
local random_of, grow, value_at = random_expression.random_of, random_expression.grow, random_expression.value_at

local function run(source) return assert(load(source, "=source", "t"))() end

local states = {}
for i, name in ipairs { "x", "y", "yaw_rate", "beta1'" } do states[i] = core.symbol(name) end

describe("sources of other languages", function()
  local readers = {
    modelica = { read_infix, function(name) return core.source_identifier("modelica", name) end },
    latex = { read_latex, function(name) return core.source_identifier("latex", name) end },
    text = { function(source, values) return read_infix(source, values, true) end, function(name) return name end },
  }

  it("mean the same as the expression", function()
    local random, names = random_of(11), { "x", "y", "yaw_rate", "beta1'" }
    local checked = 0
    for _ = 1, 60 do
      local pool = grow(random, states, 60)
      local numbers = {}
      local values = { modelica = { pi = math.pi }, latex = { ["\\pi"] = math.pi }, text = { pi = math.pi } }
      for i, name in ipairs(names) do
        local v = (random(2000) - 1000) / 512
        numbers[i] = core.expression(v)
        for language, reader in pairs(readers) do values[language][reader[2](name)] = v end
      end
      for k = 15, #pool do
        local truth = value_at(pool[k], states, numbers)
        for language, reader in pairs(readers) do
          local source = core.source({ pool[k] }, language)[1]
          local good, have = pcall(reader[1], source, values[language])
          if not good then error(language .. ": " .. source .. ": " .. tostring(have)) end
          if truth and math.abs(have - truth) > 1e-6 * (1 + math.abs(truth)) then
            error(("%s: %s is %.17g, not %.17g: %s"):format(language, source, have, truth, tostring(pool[k])))
          end
          checked = checked + (truth and 1 or 0)
        end
      end
    end
    assert.is_true(checked > 2000)
  end)

  it("have numbers that read back as the same double", function()
    local random = random_of(5)
    for _ = 1, 500 do
      local v = (random(1 << 20) + random(1 << 20) / (1 << 20)) * 10.0 ^ (random(600) - 310)
      local e = { core.expression(v) }
      assert.equal(v, read_infix(core.source(e, "text")[1], {}, true))
      assert.equal(v, read_infix(core.source(e, "modelica")[1], {}))
      assert.equal(v, run("return " .. core.source(e, "lua")[1]))
      local latex = core.source(e, "latex")[1]
      local mantissa, power = latex:match "^(.-) ?\\?c?d?o?t? ?10%^{(-?%d+)}$"
      assert.equal(v, tonumber(power and (mantissa == "" and "1" or mantissa) .. "e" .. power or latex))
    end
    assert.same({ "2147483647", "2147483648.0", "0.1", "1/3" },
      core.source({ core.expression(2147483647), core.expression(2147483648), core.expression "0.1",
        core.expression "1/3" }, "modelica"))
  end)

  it("know names", function()
    local latex = { yaw_rate = "\\mathrm{yaw\\_rate}", beta1 = "\\beta_{1}", psi = "\\psi", x = "x", x12 = "x_{12}",
      ["beta1'"] = "\\beta_{1}'", vy = "\\mathrm{vy}", ["a.b"] = "\\mathrm{a.b}", ["50%"] = "\\mathrm{50\\%}",
      ["\\"] = "\\mathrm{\\backslash{}}", x_1 = "\\mathrm{x\\_1}", link2 = "\\mathrm{link}_{2}", ["'"] = "\\mathrm{'}" }
    for name, want in pairs(latex) do assert.equal(want, core.source_identifier("latex", name)) end
    local modelica = { yaw_rate = "yaw_rate", ["beta1'"] = "'beta1\\''", time = "'time'", der = "'der'",
      ["1st"] = "'1st'", ["a b"] = "'a b'", ["\\"] = "'\\\\'", ["ä"] = "'%C3%A4'", ["a\nb"] = "'a%0Ab'",
      sin = "'sin'", pi = "'pi'" }
    for name, want in pairs(modelica) do assert.equal(want, core.source_identifier("modelica", name)) end
  end)

  local states_of_all_kinds = { { "x", "m" }, { "x'", "m/s" }, { "z1", "kg*m^2/s^2/A" }, { "pi", "1" }, { "ä", "1" },
    { "%C3%A4", "1" }, { "der", "rad/s" }, { "yaw_rate", "1/s" }, { "datum", "N m" }, { "t", "1" }, { "sin", "1" } }
  local function awkward()
    local names = {}
    return ambit.ode { 'the "model"', states = states_of_all_kinds,
      parameters = { time = ambit.between("0.1", "0.7"), b = ambit.between(1, 2) * ambit.pi },
      equations = function(s, p, t)
        local all = ambit.between(-1, 1) + ambit.sin(p.b * t) * p.time
        for _, state in ipairs(states_of_all_kinds) do all = all + ambit.cos(1 * s[state[1]]) * ambit.sin(all) end -- 1/m or what it takes
        local rates = {}
        for i, state in ipairs(states_of_all_kinds) do rates[i] = all * s[state[1]] + i end
        return rates
      end }, names
  end

  it("declare every name once, in Modelica", function()
    local source, declared = awkward():modelica(), {}
    assert.truthy(source:find("^model 'the \\\"model\\\"' \"the \\\"model\\\"\"\n"))
    assert.truthy(source:find("\nend 'the \\\"model\\\"';\n$"))
    for line in source:match("^.-\n(.*)\nequation\n"):gmatch "[^\n]+" do
      local rest = line:match "^  parameter Real (.*);$" or line:match "^  constant Real (.*);$" or
        line:match "^  Real (.*);$"
      assert(rest, line)
      local name = rest:match "^'.-[^\\]'" or rest:match "^[%a_][%w_]*"
      assert.is_nil(declared[name])
      declared[name] = 0.5
    end
    assert.truthy(source:find('Real z1(unit = "kg.m2/(s2.A)");', 1, true))
    assert.truthy(source:find('Real datum(unit = "N.m");', 1, true))
    assert.truthy(source:find("  constant Real pi = 3.141592653589793;", 1, true))
    assert.truthy(source:find('  parameter Real \'time\'(min = 0.09999999999999999, max = 0.7000000000000001) = ', 1,
      true))
    declared.pi, declared.time = math.pi, 0.5
    local count = 0
    for left, right in source:match("\nequation\n(.*)\nend "):gmatch "([^=;]-) = ([^=;]+);" do
      left = left:match "^%s*(.-)$"
      local name = left:match "^der%((.*)%)$" or left
      assert(declared[name], name)
      read_infix(right, declared)
      count = count + 1
    end
    assert.is_true(count > 11)
  end)

  it("are whole in every language", function()
    local f = awkward()
    local new = run(f:lua())
    assert.same(f.states, new.states)
    assert.equal(f:latex(), f:latex())
    local latex = f:latex()
    local depth = 0
    for brace in latex:gsub("\\[{}]", ""):gmatch "[{}]" do
      depth = depth + (brace == "{" and 1 or -1)
      assert.is_true(depth >= 0)
    end
    assert.equal(0, depth)
    local _, opened = latex:gsub("\\left", "")
    local _, closed = latex:gsub("\\right", "")
    assert.equal(opened, closed)
    assert.truthy(latex:find("^\\begin{aligned}\n") and latex:find("\n\\end{aligned}\n$"))
    assert.truthy(latex:find("\\dot{x'} &= ", 1, true) and latex:find("\\dot{x} &= ", 1, true))
    assert.truthy(f:text():find("\n  d yaw_rate/dt = ", 1, true))
    assert.has_error(function() f.lua() end)
  end)
end)
