-- hard_spec.lua -- what every validated solver does with problems that cannot be solved, or not for long: a status, a
-- reason, and the enclosure so far; never a crash, a hang or a claim that is not true.
local ambit = require "ambit"

local solvers = { "lohner", "taylor_model", "valencia", "stiff" }

local function each(what, check)
  for _, solver in ipairs(solvers) do it(("%s: %s"):format(solver, what), function() check(solver) end) end
end

local function ode(rate)
  return ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = rate(s.x, t) } end }
end
local growth = ode(function(x) return x end)

describe("a validated solver", function()
  each("stops before a finite escape", function(solver)
    local run = ambit.simulate { ode(function(x) return x ^ 2 end), initial = { x = 1 }, t = { 0, 2 }, solver = solver }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 1 and run.t_reached > 0.9, tostring(run))
    assert.is_true(#run.reason > 20)
    local truth = 1 / (1 - run.t_reached)
    assert.is_true(run.x.x.lo <= truth and truth <= run.x.x.hi)
  end)

  each("stops before the first escape of an uncertain start", function(solver)
    local run = ambit.simulate { ode(function(x) return x ^ 2 end), initial = { x = ambit.around(1, "1%") },
      t = { 0, 2 }, solver = solver }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 1 / 1.01 and run.t_reached > 0.7, tostring(run))
  end)

  each("claims nothing false where solutions are not unique", function(solver)
    -- x' = sqrt |x| from 0: x = 0 and every (t - c)^2 / 4 after c are solutions
    local run = ambit.simulate { ode(function(x) return ambit.sqrt(ambit.abs(x)) end), initial = { x = 0 },
      t = { 0, 1 }, solver = solver }
    if run.status == "complete" then
      assert.is_true(run.x.x.lo <= 0 and run.x.x.hi >= 0.25, tostring(run.x.x))
    else
      assert.equal("unable", run.status)
      assert.is_true(run.t_reached < 1 and #run.reason > 20)
    end
  end)

  each("says that it is unable where it has no derivative of a kink", function(solver)
    for _, rate in ipairs { function(x) return -ambit.abs(x) end, function(x) return ambit.max(x, 2) - 2 end } do
      local run = ambit.simulate { ode(rate), initial = { x = 3 }, t = { 0, "0.1" }, solver = solver }
      if solver == "stiff" then
        assert.equal("unable.kink", run.code)
        assert.matches("state `x` has no derivative: [am]", run.reason)
        assert.equal(0, run.t_reached)
        assert.equal(3, run.x.x.lo)
        assert.equal("function", type(run.steps))
        assert.is_nil(run:steps()())
      else
        assert.equal("complete", run.status)
      end
    end
  end)

  each("stops where the right-hand side leaves its domain", function(solver)
    -- x' = -1 / x from 1: x = sqrt(1 - 2 t)
    local run = ambit.simulate { ode(function(x) return -1 / x end), initial = { x = 1 }, t = { 0, 1 },
      solver = solver }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 0.5 and run.t_reached > 0.3, tostring(run))
  end)

  each("refuses an initial set without points", function(solver)
    local good, message = pcall(ambit.simulate, { growth, initial = { x = ambit.interval "[empty]" }, t = { 0, 1 },
      solver = solver })
    assert.is_false(good)
    assert.matches("empty", message)
    assert.matches("hard_spec.lua:%d+:", message)
  end)

  each("refuses an unbounded initial set", function(solver)
    local good, message = pcall(ambit.simulate, { growth, initial = { x = ambit.interval(0, math.huge) }, t = { 0, 1 },
      solver = solver })
    assert.is_false(good)
    assert.matches("bounded", message)
  end)

  for _, tolerance in ipairs { 0, -1, 0 / 0, math.huge, 1e-300, 1e300 } do
    each(("survives a tolerance of %g"):format(tolerance), function(solver)
      local good, run = pcall(ambit.simulate, { growth, initial = { x = 1 }, t = { 0, 1 }, solver = solver,
        tolerance = tolerance })
      if not good then
        assert.matches("tolerance", run)
        assert.matches("hard_spec.lua:%d+:", run)
      elseif run.status == "complete" then
        assert.is_true(run.x.x:contains(math.exp(1)))
      else
        assert.is_true(#run.reason > 20)
      end
    end)
  end

  for _, times in ipairs { { 0, 0 }, { 0, 1 / 0 }, { 1, 0, 2 } } do
    each(("refuses the times %s"):format(table.concat(times, ", ")), function(solver)
      local good = pcall(ambit.simulate, { growth, initial = { x = 1 }, t = times, solver = solver })
      assert.is_false(good)
    end)
  end

  each("survives a horizon beyond all numbers", function(solver)
    local decay = ode(function(x) return x end)
    local run = ambit.simulate { decay, initial = { x = 1 }, t = { 0, 1e300 }, solver = solver }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 1000)
  end)

  each("starts anywhere: zeros of both signs, subnormal, huge", function(solver)
    for _, x0 in ipairs { 0.0, -0.0, 5e-324, -5e-324, 1e-300, 1e300, -1e300 } do
      local run = ambit.simulate { ode(function(x) return -x end), initial = { x = x0 }, t = { 0, 1 }, solver = solver }
      if run.status == "complete" then
        local truth = x0 * math.exp(-1)
        local slack = 4e-16 * math.abs(truth)
        assert.is_true(run.x.x.lo <= truth + slack and truth - slack <= run.x.x.hi,
          ("%g -> %s"):format(x0, tostring(run.x.x)))
      end
    end
  end)

  each("goes on as before behind instants that are next to each other", function(solver)
    local up = 0x1p-52
    local function steps(t)
      local run = ambit.simulate { ode(function(x) return -x end), initial = { x = 1 }, t = t, solver = solver }
      assert.equal("complete", run.status, tostring(run))
      assert.is_true(run.x.x:contains(ambit.exp(t[1] - t[#t])) or run.x.x:width() < 1e-3)
      return run.step_count
    end
    local usual = steps { 1, 10 }
    for _, t in ipairs { { 1, 1 + up, 10 }, { 1, 3, 3 + 2 * up, 10 }, { 1, 1 + 3 * up, 1 + 4 * up, 10 },
      { 1, 1 - up / 2, -8 }, { 1, 1 + 1e-12, 10 }, { 2 ^ 20, 2 ^ 20 + 2 ^ -32, 2 ^ 20 + 9 } } do
      local count = steps(t)
      assert.is_true(count <= 2 * usual + 8, ("%d steps instead of %d"):format(count, usual))
    end
    assert.equal(1, steps { 2 ^ 20, 2 ^ 20 + 2 ^ -32 })
  end)

  each("names the element whose formula is not smooth", function(solver)
    -- a block that meets a spring at x = 1/2: x = t until then, 1/2 + sin(t - 1/2) behind
    local m = ambit.mechanism { "block", gravity = { 0, 0, 0 } }
    local at, joint = m:prismatic { from = m.world, axis = "x", name = "slide" }
    m:point_mass { at = at, mass = 1 }
    m:joint_torque { joint = joint, name = "stop", force = function(x) return -ambit.max(0, x - "0.5") end }
    local run = ambit.simulate { m:dynamics(), initial = { slide = 0, ["slide'"] = 1 }, t = { 0, 2 }, solver = solver }
    if run.status == "complete" then -- a solver that takes kinks
      local truth = 0.5 + math.sin(1.5)
      assert.is_true(run.x.slide.lo <= truth + 1e-15 and truth - 1e-15 <= run.x.slide.hi, tostring(run.x.slide))
    else
      assert.equal("unable", run.status)
      assert.matches("max.*stop", run.reason)
      assert.is_true(run.t_reached <= 0.5 and (run.t_reached > 0.4 or solver == "stiff"), tostring(run))
    end
  end)
end)
