-- Equations as Lua source, by running it, and as lists of terms.
local ambit = require "ambit"
local core = require "ambit.core"

local languages = { "text", "lua", "latex", "modelica" }

local here = debug.getinfo(1, "S").source:match "^@(.*/)" or ""
local random_expression = dofile(here .. "environment/random_expression.lua")
local random_of, grow, value_at = random_expression.random_of, random_expression.grow, random_expression.value_at

local function run(source, ...) return assert(load(source, "=source", "t"))(...) end

local function ode_of(rates, symbols, parameters)
  local names = {}
  for i, s in ipairs(symbols) do names[i] = tostring(s) end
  return ambit.ode { "random", states = names, parameters = parameters, equations = function() return rates end }
end

local x, y, yaw_rate, prime = core.symbol "x", core.symbol "y", core.symbol "yaw_rate", core.symbol "beta1'"
local states = { x, y, yaw_rate, prime }

-- The new data as the old ones, by their names.
local function with_data_of(new, old)
  local from, to = {}, {}
  for name, datum in pairs(old.parameters) do
    from[#from + 1], to[#to + 1] = new.parameters[name], datum
  end
  return core.substitute(new.rates, from, to)
end

describe("Lua source", function()
  -- The rules of folding do not always leave what they made alone (a factor that is no double may move outward), so now
  -- and then a rate comes back in another form, which then stays.
  it("gives the same expressions when it is run", function()
    local random, long, changed = random_of(7), 0, 0
    local leaves, points = { x, y, yaw_rate, prime, ambit.time }, {}
    for i, v in ipairs { 0.3, -0.7, 1.4, 0.2, 1.1 } do points[i] = core.expression(v) end
    for _ = 1, 60 do
      local pool = grow(random, leaves, 70)
      local rates = { pool[#pool], pool[#pool - 1], pool[#pool - 2], pool[#pool - 3] }
      local old = ode_of(rates, states)
      local source = old:lua()
      local new = run(source)
      local again = run(new:lua())
      for i, rate in ipairs(old.rates) do
        assert.is_true(again.rates[i] == new.rates[i])
        if new.rates[i] ~= rate then
          changed = changed + 1
          local a, b = value_at(rate, leaves, points), value_at(new.rates[i], leaves, points)
          assert.is_true(a == b or math.abs(a - b) < 1e-9 * (1 + math.abs(a)))
        end
      end
      if source:find "local z1 =" then long = long + 1 end
    end
    assert.is_true(changed <= 10)
    assert.is_true(long > 5 and long < 55)
  end)

  it("keeps data, their ends and their names", function()
    local random = random_of(3)
    for _ = 1, 20 do
      local parameters = { v = ambit.between("0.1", "0.2"), ["the load"] = ambit.around(3, "1%"), ["end"] = "1/3",
        n = 4 }
      local leaves = { x, y, parameters.v, parameters["the load"] }
      local pool = grow(random, leaves, 60)
      local old = ode_of({ pool[60], pool[59] + parameters.v, pool[58], pool[57] }, states, parameters)
      local new = run(old:lua())
      for name, value in pairs(old.parameters) do
        if core.is_constant(value) then
          assert.is_true(value == new.parameters[name])
        else
          local a, b = core.leaves { value }[1], core.leaves { new.parameters[name] }[1]
          assert.is_true(a.lo == b.lo and a.hi == b.hi and value ~= new.parameters[name])
        end
      end
      local rates = with_data_of(new, old)
      for i, rate in ipairs(old.rates) do assert.is_true(rate == rates[i]) end
    end
  end)

  it("keeps states, units, their order, shared data and formulas", function()
    local u = ambit.between(1, 2)
    local old = ambit.ode { "a\n\"b\"\\", states = { { "v", "m/s" }, { "x", "m" }, { "1st", "1" } },
      parameters = { a = u, b = u, c = u * ambit.pi / 180, d = ambit.around(u, "1%"), free = core.symbol("free", "N") },
      equations = function(s, p, t)
        return { -p.c * s.x + p.a - p.free, s.v + p.b * ambit.sin(t), s["1st"] * p.d }
      end }
    local new = run(old:lua(), { free = core.symbol("free", "N") })
    assert.same(old.states, new.states)
    assert.same(old.units, new.units)
    assert.equal(old.name, new.name)
    assert.is_true(new.parameters.a == new.parameters.b)
    local from, to = {}, {}
    for _, leaf in ipairs(core.leaves(new.rates)) do
      if leaf.kind == "unknown" then from[#from + 1] = leaf.expression end
    end
    for _, leaf in ipairs(core.leaves(old.rates)) do
      if leaf.kind == "unknown" then to[#to + 1] = leaf.expression end
    end
    assert.equal(2, #to)
    for i, rate in ipairs(core.substitute(new.rates, from, to)) do assert.is_true(rate == old.rates[i]) end
    assert.has_error(function() run(old:lua()) end)
  end)

  it("comes from mechanisms too", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local bob = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta" },
      offset = { 0, ambit.around(-1, "1%"), 0 } }
    m:point_mass { at = bob, mass = 1 }
    local old = m:dynamics()
    local new = run(old:lua())
    assert.same(old.states, new.states)
    assert.same(old.units, new.units)
    local a, b = core.leaves(old.rates), core.leaves(new.rates)
    local function unknown(list)
      for _, leaf in ipairs(list) do
        if leaf.kind == "unknown" then return leaf.expression end
      end
    end
    for i, rate in ipairs(core.substitute(new.rates, { unknown(b) }, { unknown(a) })) do
      assert.is_true(rate == old.rates[i])
    end
  end)

  it("runs as a model", function()
    local old = ambit.ode { states = { x = "m", v = "m/s" }, parameters = { k = ambit.between(4, "4.41") },
      equations = function(s, p) return { x = s.v, v = -p.k * s.x } end }
    local function last(f) return ambit.simulate { f, initial = { x = 1, v = 0 }, t = { 0, 1 } }.x.x end
    assert.equal(tostring(last(old)), tostring(last(run(old:lua()))))
  end)

  it("is accepted by Lua however deep and long the equations are", function()
    local deep, sum = x, y
    for i = 1, 3000 do deep = ambit.sin(deep) * y + x end
    for i = 1, 2000 do sum = sum + ambit.cos(x * i) / (y + i) end
    local old = ambit.ode { states = { "x", "y" }, equations = { deep, sum } }
    local new = run(old:lua())
    assert.is_true(new.rates[1] == deep and new.rates[2] == sum)
    for line in old:lua():gmatch "[^\n]+" do assert.is_true(#line <= 130) end
    for _, language in ipairs(languages) do assert.is_true(#old[language](old) < 300000) end
  end)

  it("refuses what it cannot write", function()
    assert.has_error(function() core.source({ x }, "cobol") end)
    local e = x
    for _ = 1, 60 do e = ambit.sin(e) * ambit.cos(e) end
    local good, message = pcall(core.source, { e }, "lua")
    assert.is_false(good)
    assert.truthy(message:find("longer than 1000000 characters", 1, true))
  end)
end)

describe("term trees", function()
  it("are lists in Lua", function()
    local e = ambit.sin(x + y * (1 + x)) - y
    local tree = core.term_tree({ e, x * (x + y) }, 3, 10)
    local list = core.term_list(tree)
    assert.equal(0, list[1].level)
    assert.equal(0, list[1].parent)
    assert.is_true(list[1].expression == e)
    for k, term in ipairs(list) do
      assert.is_true(term.parent < k and (term.level == 0 or list[term.parent].level == term.level - 1))
      assert.is_true(#term.text <= 110)
    end
    local same = core.term_rewrite(tree, {}, {})
    assert.is_true(same[1] == e and same[2] == x * (x + y))
    for k, term in ipairs(list) do
      if term.equation == 1 and term.expression == -y then
        assert.is_true(core.term_rewrite(tree, { k }, { core.expression(0) })[1] == e + y)
      end
    end
    assert.has_error(function() core.term_rewrite(tree, { #list + 1 }, { x }) end)
    assert.has_error(function() core.term_rewrite(tree, { 1, 1 }, { x, x }) end)
    assert.has_error(function() core.term_tree({ e }, -1) end)
    local long = x
    for i = 1, 100 do long = long + ambit.sin(y * i) end
    local text = core.term_list(core.term_tree({ long }))[1].text
    assert.truthy(#text < 110 and text:find " %.%.%.$")
  end)
end)
