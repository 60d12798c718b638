-- The functions that the kernel describes in one file each, in every arithmetic, solver, unit and language; judged by
-- the math library of Lua and by quadrature.
local ambit = require "ambit"
local core = require "ambit.core"

-- name -> { value in doubles, where it is asked, latex of f(x) }
local one = {
  log1p = { function(x) return math.log(1 + x) end, -0.5, 2, "\\operatorname{log1p}\\left(x\\right)" },
  expm1 = { function(x) return math.exp(x) - 1 end, -1, 1, "\\operatorname{expm1}\\left(x\\right)" },
  asinh = { function(x) return x < 0 and -math.log(-x + math.sqrt(1 + x * x)) or math.log(x + math.sqrt(1 + x * x)) end,
    -2, 3, "\\operatorname{arsinh}\\left(x\\right)" },
  acosh = { function(x) return math.log(x + math.sqrt(x * x - 1)) end, 1.5, 3,
    "\\operatorname{arcosh}\\left(x\\right)" },
  atanh = { function(x) return 0.5 * math.log((1 + x) / (1 - x)) end, -0.75, 0.5,
    "\\operatorname{artanh}\\left(x\\right)" },
  log2 = { function(x) return math.log(x, 2) end, 0.5, 3, "\\log_{2}\\left(x\\right)" },
  log10 = { function(x) return math.log(x, 10) end, 0.5, 3, "\\log_{10}\\left(x\\right)" },
  exp2 = { function(x) return 2 ^ x end, -2, 2, "\\operatorname{exp2}\\left(x\\right)" },
  cbrt = { function(x) return x < 0 and -(-x) ^ (1 / 3) or x ^ (1 / 3) end, 0.5, 3, "\\sqrt[3]{x}" },
}
local pairs_of = {
  hypot = { function(x, y) return math.sqrt(x * x + y * y) end, "\\operatorname{hypot}\\left(x, y\\right)" },
  pow = { function(x, y) return x ^ y end, "{x^{y}}" },
}
local arithmetics = { "interval", "affine", "gradient", "taylor_model", "mpfr" }

local function about(x, slack) return ambit.interval(x - slack, x + slack) end
local function meets(a, b) return a.lo <= b.hi and b.lo <= a.hi end

-- of enclosures that were evaluated
local function evaluated(e, arithmetic) return ambit.evaluate { e, arithmetic = arithmetic } end

describe("functions described in one place", function()
  it("are all asked for here", function()
    local n = 0
    for _, name in ipairs(core.described_functions) do
      n = n + 1
      assert.truthy(one[name] or pairs_of[name], name)
      assert.equal("function", type(ambit[name]))
      assert.truthy(ambit.help(name):find(name, 1, true))
    end
    for _ in pairs(one) do n = n - 1 end
    for _ in pairs(pairs_of) do n = n - 1 end
    assert.equal(0, n)
  end)

  it("enclose their range in every arithmetic, and no more of one operand", function()
    for name, f in pairs(one) do
      local x = ambit.between(f[2], f[3])
      local e = ambit[name](x)
      for _, arithmetic in ipairs(arithmetics) do
        local r = evaluated(e, arithmetic)
        for k = 0, 20 do
          assert.is_true(meets(r, about(f[1](f[2] + (f[3] - f[2]) * k / 20), 1e-14)), name .. " in " .. arithmetic)
        end
        assert.is_true(r:width() < (f[1](f[3]) - f[1](f[2])) * (1 + 1e-12) + 1e-14, name .. " in " .. arithmetic)
      end
      local middle = 0.5 * f[2] + 0.5 * f[3]
      local real = evaluated(ambit[name](ambit.number(middle)), "real")
      assert.is_true(math.abs(real.lo - f[1](middle)) < 1e-14)
    end
  end)

  it("stay correlated with their operand", function()
    local least = { affine = 0.05, taylor_model = 0.005, gradient = 0.2 }
    for name, f in pairs(one) do
      local middle, radius = 0.5 * f[2] + 0.5 * f[3], 0.01
      local x = ambit.between(middle - radius, middle + radius)
      local slope = (f[1](middle + 1e-5) - f[1](middle - 1e-5)) / 2e-5
      local e = ambit[name](x) - slope * x
      local alone = evaluated(e, "interval"):width()
      for arithmetic, share in pairs(least) do
        local r = evaluated(e, arithmetic)
        assert.is_true(r:width() < share * alone, ("%s in %s: %g of %g"):format(name, arithmetic, r:width(), alone))
        for k = -5, 5 do
          local at = middle + radius * k / 5
          assert.is_true(meets(r, about(f[1](at) - slope * at, 1e-13)), name .. " in " .. arithmetic)
        end
      end
    end
  end)

  it("of two operands hold their values and their dependence", function()
    for name, f in pairs(pairs_of) do
      local x, y = ambit.between(1.9, 2.1), ambit.between(-0.6, -0.4)
      local e = ambit[name](x, y)
      for _, arithmetic in ipairs(arithmetics) do
        local r, difference = evaluated(e, arithmetic), evaluated(e - ambit[name](x, y + 0), arithmetic)
        assert.is_true(difference.lo <= 0 and difference.hi >= 0)
        for k = 0, 5 do
          for l = 0, 5 do
            local value = f[1](1.9 + 0.04 * k, -0.6 + 0.04 * l)
            assert.is_true(meets(r, about(value, 1e-14)), name .. " in " .. arithmetic)
          end
        end
      end
      local tight, slack = evaluated(e, "interval"), 1e-14
      local lo, hi = math.huge, -math.huge
      for _, s in ipairs { 1.9, 2.1 } do
        for _, t in ipairs { -0.6, -0.4 } do lo, hi = math.min(lo, f[1](s, t)), math.max(hi, f[1](s, t)) end
      end
      assert.is_true(tight.lo > lo - slack and tight.hi < hi + slack)
    end
  end)

  it("agree in random expressions", function()
    local state = 20
    local function random(n)
      state = (state * 1103515245 + 12345) % 2147483648
      return state // 65536 % n + 1
    end
    local names = { table.unpack(core.described_functions) }
    local tamed = { log1p = function(u) return u ^ 2 end, acosh = function(u) return 1 + u ^ 2 end,
      atanh = function(u) return ambit.sin(u) * "0.7" end, log2 = function(u) return u ^ 2 + "0.25" end,
      log10 = function(u) return u ^ 2 + "0.25" end, cbrt = function(u) return u ^ 2 + "0.25" end,
      pow = function(u) return u ^ 2 + "0.25" end, expm1 = ambit.sin, exp2 = ambit.tanh }
    for round = 1, 60 do
      local box = { ambit.interval(0.5, 0.5 + random(10) / 200), ambit.interval(-1 - random(10) / 200, -1) }
      local x, y = ambit.between(box[1].lo, box[1].hi), ambit.between(box[2].lo, box[2].hi)
      local function build(a, b)
        local list = { a, b }
        local r = state
        for _ = 1, 6 do
          local name = names[random(#names)]
          local u, v = list[random(#list)], list[random(#list)]
          local inner = (tamed[name] or function(w) return w end)(u)
          list[#list + 1] = pairs_of[name] and ambit[name](inner, ambit.sin(v)) or ambit[name](inner)
          list[#list + 1] = random(2) == 1 and u * v or u - v
        end
        state = r
        return list[#list] + list[#list - 1]
      end
      local e, results = build(x, y), {}
      for _, arithmetic in ipairs(arithmetics) do results[arithmetic] = evaluated(e, arithmetic) end
      for k = 0, 3 do
        local s, t = box[1].lo + (box[1].hi - box[1].lo) * k / 3, box[2].lo + (box[2].hi - box[2].lo) * (3 - k) / 3
        local exact = evaluated(build(ambit.number(s), ambit.number(t)), "mpfr")
        for arithmetic, r in pairs(results) do
          assert.is_true(meets(r, exact), ("round %d: %s misses a value"):format(round, arithmetic))
        end
      end
      state = state + 7919 * round
    end
  end)

  it("are integrated by every solver", function()
    for name, f in pairs(one) do
      local from, to = f[2] + 0.1 * (f[3] - f[2]), f[3] - 0.1 * (f[3] - f[2])
      local n, sum = 400, f[1](from) + f[1](to)
      for k = 1, n - 1 do sum = sum + f[1](from + (to - from) * k / n) * (k % 2 == 1 and 4 or 2) end
      local want = sum * (to - from) / (3 * n)
      local o = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = 1, y = ambit[name](s.x) } end }
      for _, solver in ipairs { "lohner", "taylor_model", "zonotope", "valencia", "stiff" } do
        local run = ambit.simulate { o, initial = { x = from, y = 0 }, t = to - from, solver = solver }
        assert.equal("complete", run.status, name .. " by " .. solver)
        assert.is_true(meets(run:at(to - from).y, about(want, 1e-9)), name .. " by " .. solver)
        assert.is_true(run:at(to - from).y:width() < 1e-5, name .. " by " .. solver)
      end
    end
  end)

  it("keep accuracy at tiny arguments and do not overflow at huge ones", function()
    local tiny = { log1p = 1e-300, expm1 = 1e-300, asinh = 1e-300, atanh = 1e-300 }
    for name, x in pairs(tiny) do
      local r = ambit[name](ambit.interval(x, x))
      assert.is_true(r:width() <= 1e-315 and r:contains(x), name)
    end
    local r = ambit.asinh(ambit.interval(-1e300, 1e300))
    assert.is_true(math.abs(r.hi - 691.4686750787736) < 1e-12 and r.lo == -r.hi)
    assert.is_true(math.abs(ambit.acosh(ambit.interval(1e300, 1e300)).hi - 691.4686750787736) < 1e-12)
    local h = ambit.hypot(ambit.interval(3e300, 3e300), ambit.interval(4e300, 4e300))
    assert.is_true(meets(h, about(5e300, 1e285)) and h:width() < 2e285)
  end)

  it("are written in other languages", function()
    local x, y = ambit.between(1, 2, "x"), ambit.between(1, 2, "y")
    for name, f in pairs(one) do
      assert.equal(name .. "(x)", core.source({ ambit[name](x) }, "text")[1])
      assert.equal(name .. "(x)", core.source({ ambit[name](x) }, "lua")[1])
      assert.equal(f[4], core.source({ ambit[name](x) }, "latex")[1])
    end
    for name, f in pairs(pairs_of) do assert.equal(f[2], core.source({ ambit[name](x, y) }, "latex")[1]) end
    assert.equal("pow(x, y)", core.source({ x ^ y }, "lua")[1])
    local modelica = { log1p = "log(1 + x)", expm1 = "(exp(x) - 1)", asinh = "Modelica.Math.asinh(x)",
      acosh = "Modelica.Math.acosh(x)", atanh = "(0.5*log(2/(1 - x) - 1))", log2 = "(log(x)/log(2))",
      log10 = "log10(x)", exp2 = "(2^(x))", cbrt = "(sign(x)*abs(x)^(1/3))" }
    for name, want in pairs(modelica) do assert.equal(want, core.source({ ambit[name](x) }, "modelica")[1]) end
    assert.equal("log(1 + (x - y))", core.source({ ambit.log1p(x - y) }, "modelica")[1])
    assert.equal("((x)^(y))", core.source({ x ^ y }, "modelica")[1])
  end)

  it("have units", function()
    local length, volume = ambit.number "3 m", ambit.number "8 m^3"
    local _, unit = core.unit_of(ambit.hypot(length, ambit.number "4 m"))
    assert.equal("a length (m)", unit)
    _, unit = core.unit_of(ambit.cbrt(volume))
    assert.equal("a length (m)", unit)
    for _, call in ipairs { function() return ambit.log1p(length) end, function() return ambit.exp2(length) end,
      function() return ambit.hypot(length, volume) end } do
      assert.is_false((pcall(call)))
    end
  end)

  it("are found by roots, and contract", function()
    for name, f in pairs(one) do
      local o = ambit.roots { function(s) return { ambit[name](s.x) - f[1](0.25 * f[2] + 0.75 * f[3]) } end,
        box = { x = { f[2], f[3] } } }
      assert.equal("complete", o.status, name)
      assert.equal(1, #o.proved, name)
      assert.is_true(meets(o.proved[1].x, about(0.25 * f[2] + 0.75 * f[3], 1e-9)), name)
    end
  end)

  it("have differences that vanish with what two models do not share", function()
    for name, f in pairs(one) do
      local x, d = ambit.between(0.8 * f[2] + 0.2 * f[3], 0.2 * f[2] + 0.8 * f[3]), ambit.between(-1e-6, 1e-6)
      local e = ambit[name](x)
      local r = evaluated(core.difference({ e }, { e }, { x }, { d })[1], "interval")
      assert.is_true(r.lo < 0 and r.hi > 0 and r:width() < 1e-4, name .. " " .. tostring(r))
      local middle = 0.5 * f[2] + 0.5 * f[3]
      assert.is_true(r:contains(f[1](middle) - f[1](middle - 1e-6)) and r:contains(f[1](middle) - f[1](middle + 1e-6)))
    end
  end)

  it("are powers x ^ y of two expressions", function()
    local x, y = ambit.between(2, 3), ambit.between(0.5, 1.5)
    local r = evaluated(x ^ y, "interval")
    assert.is_true(meets(r, about(2 ^ 0.5, 1e-15)) and meets(r, about(3 ^ 1.5, 1e-14)))
    assert.is_true(r.lo > 2 ^ 0.5 - 1e-14 and r.hi < 3 ^ 1.5 + 1e-14)
    local tight = ambit.pow(ambit.interval(2, 2), ambit.interval(300.3, 300.3))
    assert.is_true(tight:width() <= 2 ^ 300.3 * 5e-16 and meets(tight, about(2 ^ 300.3, 1e76)))
  end)
end)
