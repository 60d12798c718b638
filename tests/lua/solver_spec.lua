-- The lohner solver through the whole road: steps where they are hard to find, pieces of wide sets, other arithmetics.
local ambit = require "ambit"

local function ode(rate) return ambit.ode { states = { "x" }, equations = function(s, p, t) return { x = rate(s.x, t) } end } end

describe("lohner", function()
  it("goes where the right-hand side is smooth, up to where it is not", function()
    local root = ambit.simulate { ode(ambit.sqrt), initial = { x = 1 }, t = { 0, -1 } }
    assert.equal("complete", root.status)
    assert.is_true(root.x.x:contains(0.25))
    local kink = ambit.simulate {
      ode(function(x) return ambit.min(x, 1) end), initial = { x = "0.5" }, t = { 0, 3 }, solver = "lohner",
    }
    assert.equal("unable", kink.status)
    assert.is_true(kink.t_reached > 0.6931 and kink.t_reached <= math.log(2))
  end)

  it("does not take a domain for granted that a branch hides", function()
    local run = ambit.simulate {
      ode(function(x) return ambit.min(ambit.sqrt(x), -1) end), initial = { x = "0.5" }, t = { 0, 10 },
      solver = "lohner",
    }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached <= 0.5)
  end)

  it("steps on from listed times that are close together", function()
    for _, times in ipairs { { 0, 1e-13, 1 }, { 0, 1e-11, 100 } } do
      local run = ambit.simulate { ode(function(x) return -x end), initial = { x = 1 }, t = times }
      assert.equal("complete", run.status)
    end
  end)

  it("encloses wide sets piece by piece, whatever the arithmetic", function()
    local sin, log, atan, atan2, tanh = ambit.sin, ambit.log, ambit.atan, ambit.atan2, ambit.tanh
    local system = ambit.ode {
      states = { "a", "b", "c" },
      equations = function(s)
        return {
          a = 0.5 * sin(0.828125 * tanh(1.671875)),
          b = 0.5 * (atan2(s.b, 1.5 + atan(s.a) ^ 2) - s.b),
          c = 0.5 * log(1.25 + s.b ^ 2) * (s.b + s.a) ^ 3,
        }
      end,
    }
    local t = { 1, 0x1.c16d20bc5519bp-1 }
    local true_c = 0.5431867967 -- the largest of sampled solutions, by a Taylor method with 30 digits
    for _, arithmetic in ipairs { "interval", "minimal" } do
      for _, pieces in ipairs { 1, 8, 16 } do
        local run = ambit.simulate {
          system, t = t, solver = "lohner", order = 4, history = 0, arithmetic = arithmetic, pieces = pieces,
          initial = {
            a = log(1.25 + tanh(-0.078125) ^ 2),
            b = ambit.between(-1.9982412240138256, -1.7205087759861744),
            c = ambit.between(-0.6671800978404474, -0.08281990215955265),
          },
        }
        assert.equal("complete", run.status)
        assert.is_true(run.x.c.hi >= true_c)
      end
    end
  end)

  it("takes a slope order above the order that it would choose", function()
    local run = ambit.simulate {
      ode(function(x) return -x end), initial = { x = ambit.around(1, "1%") }, t = { 0, 1 }, jacobian_order = 60,
    }
    assert.equal("complete", run.status)
  end)
end)

describe("taylor_model", function()
  it("carries a remainder on by all of the flow's slope, not only by the slope's series", function()
    for _, h in ipairs { 0.1, 0.25, 0.5 } do
      local start = ambit.between(-1, 1) ^ 2 -- of first order: 0 and a remainder, which the start at 1 uses up
      local run = ambit.simulate { ode(function(x) return x end), initial = { start }, t = { 0, h },
        solver = "taylor_model", order = 1, time_order = 20, jacobian_order = 3, tolerance = 1, step_max = h }
      assert.equal(1, run.step_count)
      assert.is_true(run.x.x.hi >= math.exp(h) and run.x.x.hi < math.exp(h) + 1e-13)
    end
  end)
end)

describe("taylor_model, one long step of low order", function()
  local options = { t = { 0, 0.5 }, solver = "taylor_model", order = 10, time_order = 4, jacobian_order = 20,
    tolerance = 1, step_max = 0.5, pieces_max = 1 }
  local p = ambit.between(-3, 3) -- at the middle nothing grows

  local function check(system, initial)
    options[1], options.initial = system, initial
    local run = ambit.simulate(options)
    assert.equal(1, run.step_count)
    assert.is_true(run.x.x.hi >= math.exp(1.5) and run.x.x.lo <= math.exp(-1.5))
  end

  it("bounds how fast errors grow over all values of a parameter", function()
    check(ambit.ode { states = { "x" }, equations = function(s) return { x = p * s.x } end }, { 1 })
  end)

  it("bounds how fast errors grow over all values of a state", function()
    check(ambit.ode { states = { "x", "y" }, equations = function(s) return { x = s.y * s.x, y = 0 * s.y } end },
      { 1, p })
  end)
end)

describe("a jump of an angle within the set", function()
  local pi, atan = math.pi, math.atan
  -- x' = atan2(x, -1) from x0: pi - atan(x) above 0, -pi - atan(x) below it; Runge and Kutta's method of order 4
  local function follow(x, t)
    local function rate(y) return (x >= 0 and pi or -pi) - atan(y) end
    local n = 100
    for _ = 1, n do
      local h = t / n
      local a = rate(x)
      local b = rate(x + h / 2 * a)
      local c = rate(x + h / 2 * b)
      x = x + h / 6 * (a + 2 * b + 2 * c + rate(x + h * c))
    end
    return x
  end

  for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff" } do
    it(("is not smoothed over by %s"):format(solver), function()
      local jump = ode(function(x) return ambit.atan2(x, -1) end)
      for _, start in ipairs { { "-0.1", "0.1" }, { 0, "0.1" }, { "-0.1", 0 }, { "-0.01", "-0.001" } } do
        local lo, hi = tonumber(start[1]), tonumber(start[2])
        local run = ambit.simulate { jump, initial = { ambit.between(start[1], start[2]) }, t = { 0, "0.125" },
          solver = solver, dense = true }
        for k = 0, 4 do
          local x0 = lo + (hi - lo) * k / 4
          for step in run:steps() do
            local x = follow(x0, step.t)
            assert.is_true(step.x.x.lo <= x + 1e-9 and x - 1e-9 <= step.x.x.hi)
          end
        end
        if hi < 0 or solver == "valencia" then assert.equal("complete", run.status) end
      end
    end)
  end
end)

describe("every solver in time", function()
  -- The middle of these ranges is a double, half their width is none.
  it("starts from all values of a range", function()
    for _, solver in ipairs { "lohner", "stiff", "taylor_model", "valencia" } do
      for k = 1, 40 do
        local lo, hi = -k * 1e-18, 0.5 + 3 * k * 0x1p-53
        local run = ambit.simulate { ode(function(x) return 0 * x end), solver = solver,
          initial = { x = ambit.between(lo, hi) }, t = { 0, 1 } }
        assert.is_true(run.x.x:contains(ambit.interval(lo, hi)), solver)
      end
    end
  end)
end)
