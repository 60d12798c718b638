-- Text is the decimal that it says, in every verb and every place that takes a number besides a time (those are in
-- instant_spec). Each place is asked for something that is the number itself; what comes back must hold it, as a
-- quotient of whole numbers, exactly. The oracle is arithmetic on decimal digits, which share nothing with Ambit's.
local ambit = require "ambit"
local core = require "ambit.core"

-- the digits of a double, or decimal text, times a whole number, with 60 places behind the point; and its sign
local function digits(x, factor)
  local whole, part = (type(x) == "number" and ("%.60f"):format(math.abs(x)) or x):match "^(%d+)%.?(%d*)$"
  local text, carry, list = whole .. part .. ("0"):rep(60 - #part), 0, {}
  for i = #text, 1, -1 do
    local v = tonumber(text:sub(i, i)) * factor + carry
    table.insert(list, 1, tostring(math.tointeger(v % 10)))
    carry = v // 10
  end
  return (("%d"):format(carry) .. table.concat(list)):gsub("^0+", "")
end

local function at_most(a, b) return #a < #b or #a == #b and a <= b end

-- lo <= p / q <= hi, p > 0; p: decimal text
local function holds(x, n)
  local low = x.lo <= 0 or at_most(digits(x.lo, n.q), digits(n.p, 1))
  local high = x.hi == math.huge or x.hi > 0 and at_most(digits(n.p, 1), digits(x.hi, n.q))
  return low and high
end

local numbers = {
  { text = "0.1", p = "0.1", q = 1 }, { text = "1/3", p = "1", q = 3 }, { text = "0.7/2.1", p = "1", q = 3 },
  { text = "1000000.1", p = "1000000.1", q = 1 }, { text = "1e-3", p = "0.001", q = 1 },
  { text = "0.30000000000000000001", p = "0.30000000000000000001", q = 1 },
  { text = ambit.number "1e6" + "0.1", p = "1000000.1", q = 1 }, -- as "1e6" + "0.1" is in a scene
  { text = ambit.number "1" / 3, p = "1", q = 3 },
}

local function still(more)
  return ambit.ode { states = { "x" }, parameters = more, equations = function() return { x = 0 } end }
end

local function at_rate(rate) return ambit.ode { states = { "x" }, equations = function() return { x = rate } end } end

local function run(system, start, more)
  local q = { system, initial = { x = start }, t = { 0, 1 }, solver = "lohner" }
  for key, value in pairs(more or {}) do q[key] = value end
  return ambit.simulate(q)
end

local function slider(build)
  local m = ambit.mechanism "slider"
  local at = m:prismatic { from = m.world, axis = "x", name = "x" }
  return m, build(m, at)
end

-- what the enclosure's lower end was rounded from
local function lower_end(x) return core.interval(x.lo, x.lo * (1 + 0x1p-49)) end

-- of all that may be a root, one
local function root_of(r)
  for _, name in ipairs { "proved", "partly", "undecided" } do
    if r[name][1] then return r[name][1].x end
  end
end

-- x at the end of a hybrid model that comes to rest behind the guard
local function switching(system, guard, reset)
  return ambit.hybrid({ modes = { up = { system, guards = { { name = "top", direction = "rising", to = "rest", g = guard,
    reset = reset } } }, rest = { still() } }, mode = "up", initial = { x = 0 }, t = { 0, 1 } }).x.x
end

local places = {
  evaluate = function(v) return ambit.evaluate { v + 0 } end,
  number = function(v) return ambit.evaluate { ambit.number(v) * 1 } end,
  around = function(v) return ambit.evaluate { ambit.around(v, "1e-40") } end,
  ["around, the tolerance"] = function(v) -- which is no expression
    return type(v) == "string" and lower_end(ambit.evaluate { ambit.around(ambit.number(v) * 2, v) }) or nil
  end,
  ["between, both ends"] = function(v) return ambit.evaluate { ambit.between(v, v) + 0 } end,
  interval = function(v) return ambit.interval(ambit.number(v)) end,
  ["simulate, a start"] = function(v) return run(still(), v).x.x end,
  ["simulate, a parameter"] = function(v)
    return run(ambit.ode { states = { "x" }, parameters = { p = v }, equations = function(_, p) return { x = p.p } end },
      0).x.x
  end,
  ["simulate, an equation"] = function(v) return run(at_rate(v), 0).x.x end,
  ["simulate, an event"] = function(v)
    return run(at_rate(2 * v), 0, { t = { 0, 1 }, events = { { g = function(s) return s.x - v end } } }).events[1].x.x
  end,
  ["simulate, what varies"] = function(v) return run(at_rate(ambit.varying(v, 3 * v)), 0, { solver = "zonotope" }).x.x end,
  ["mechanism, a length"] = function(v)
    local m, tip = slider(function(m, at) return m:rigid_link { from = at, offset = { v, 0, 0 } } end)
    return ambit.evaluate { m:position(tip).x - m:position(m.world).x, at = { x = 0 } }
  end,
  ["mechanism, a mass"] = function(v) -- a = F / m
    local m = slider(function(m, at) m:point_mass { at = at, mass = 1 / ambit.number(v) }
      m:applied_force { at = at, force = { 1, 0, 0 } }
    end)
    return ambit.simulate({ m:dynamics(), initial = { x = 0, ["x'"] = 0 }, t = { 0, 1 }, solver = "lohner" }).x["x'"]
  end,
  roots = function(v) return root_of(ambit.roots { function(s) return s.x - v end, box = { x = { 0, 2e6 } } }) end,
  ["roots, the box"] = function(v)
    return root_of(ambit.roots { function(s) return s.x * s.x - v * s.x end, box = { x = { v / 2, v } },
      partial = true })
  end,
  equilibria = function(v)
    local system = ambit.ode { states = { "x" }, equations = function(s) return { x = v - s.x } end }
    return root_of(ambit.equilibria { system, box = { x = { 0, 2e6 } } })
  end,
  ["inverse_kinematics, a position"] = function(v)
    local m, tip = slider(function(m, at) return m:rigid_link { from = at, offset = { 0, 1, 0 } } end)
    return root_of(ambit.inverse_kinematics { m, at = tip, position = { v, 1, 0 }, box = { x = { 0, 2e6 } } })
  end,
  sensitivity = function(v) -- x = p^2 / 2, dx/dp = p
    local p = ambit.around(v, "1e-40")
    return ambit.sensitivity({ at_rate(p * p / 2), initial = { x = 0 }, t = { 0, 1 }, solver = "lohner",
      wrt = { p = p } }):d("x", p)
  end,
  ["hybrid, a guard"] = function(v)
    return switching(at_rate(2 * v), function(s) return s.x - v end, function(s) return { x = s.x } end)
  end,
  ["hybrid, a reset"] = function(v)
    return switching(at_rate(1), function(s) return s.x - "0.5" end, function() return { x = v } end)
  end,
  ["sampled, a law"] = function(v)
    local law = ambit.sampled { period = "0.3", outputs = { "u" }, law = function() return v end }
    return ambit.simulate({ ambit.ode { states = { "x" }, sampled = law, equations = function(s) return { x = s.u } end },
      initial = { x = 0 }, t = { 0, 1 } }).x.x
  end,
  map = function(v)
    return ambit.simulate({ ambit.map { states = { "x" }, next = function() return { x = v } end }, initial = { x = 0 },
      t = { 0, 1 } }).x.x
  end,
  ["certify, a model"] = function(v)
    return core.interval(0, ambit.certify({ at_rate(v), still(), t = { 0, 1 }, initial = { x = 0 }, outputs = { "x" },
      solver = "lohner" }).error.x)
  end,
}

describe("text is the number that it says", function()
  local before
  setup(function() before = ambit.text_arithmetic(true) end) -- as in scenes; plain busted leaves it to Lua
  teardown(function() core.text_arithmetic(before) end)

  for place, ask in pairs(places) do
    it(place, function()
      for _, n in ipairs(numbers) do
        local x = ask(n.text)
        if x or type(n.text) == "string" then
          assert.is_true(holds(x, n), ("%s misses %s / %d"):format(x:text(17), n.p, n.q))
        end
      end
    end)
  end

  it("in thresholds of verify, on either side", function()
    local tiny = ambit.number "1e-30" -- by which nothing that a double holds can be told apart
    for _, n in ipairs(numbers) do
      local v = ambit.number(n.text)
      local function verdict(start, threshold, kind)
        local q = { still(), initial = { x = start }, t = { 0, 1 }, solver = "lohner" }
        q[kind] = function(s) return s.x - threshold end
        return ambit.verify(q).status
      end
      for _, kind in ipairs { "safe", "at_end", "reach" } do
        assert.not_equal("refuted", verdict(n.text, v, kind))
        assert.not_equal("proved", verdict(n.text, v - tiny, kind))
        assert.not_equal("refuted", verdict(v - tiny, v, kind))
        assert.equal("proved", verdict(v - tiny, v * "1.000001", kind))
        assert.equal("refuted", verdict(v * "1.000001", v, kind))
      end
    end
  end)

  it("in the errors that certify and reduce allow", function()
    for _, n in ipairs(numbers) do
      local v, tiny = ambit.number(n.text), ambit.number "1e-30"
      local function certified(error)
        return ambit.certify({ at_rate(error), still(), t = { 0, 1 }, initial = { x = 0 }, outputs = { "x" },
          error = { x = n.text }, solver = "lohner" }).status
      end
      if type(n.text) == "string" then
        assert.not_equal("proved", certified(v + tiny))
        assert.equal("proved", certified(v * "0.999999"))
        assert.equal("exceeded", certified(v * "1.000001"))
        local function dropped(rate) -- the rate itself, or only what is added
          local sum = ambit.ode { states = { "x" }, equations = function(s) return { x = rate + "1e-25" * s.x } end }
          local small = ambit.reduce { sum, t = { 0, 1 }, initial = { x = 0 }, outputs = { "x" }, error = { x = n.text } }
          return small.error.x > 1e-6
        end
        assert.is_false(dropped(v + tiny))
        assert.is_true(dropped(v * "0.999"))
      end
    end
  end)
end)
