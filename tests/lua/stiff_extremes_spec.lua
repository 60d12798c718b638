-- stiff at its limits: horizons whose rates have no squares, and states that start from nothing.
local ambit = require "ambit"

describe("stiff at its limits", function()
  it("ends by itself where a step times the rates is beyond the numbers", function()
    local system = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local run = ambit.simulate { system, initial = { x = 1 }, t = { 0, 1e200 }, solver = "stiff" }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached > 1e140 and run.t_reached < 1e200)
    assert.is_true(run.x.x.lo <= 0 and run.x.x.hi >= 0)
    assert.truthy(run.reason:find("at t = 1.", 1, true) and run.reason:find("`step_max`", 1, true), run.reason)
  end)

  -- x6 = t^2 / 2, x5 = t^3 / 6, ...: at first x1 is lost in the rounding of what cancels in its rate
  it("gives states that start from nothing a size", function()
    local names = { "x1", "x2", "x3", "x4", "x5", "x6" }
    local system = ambit.ode { states = names, equations = function(s, _, t)
      local wave, rates = 1e4 * ambit.sin(t), {}
      for k, name in ipairs(names) do
        local next_one = names[k + 1] and s[names[k + 1]] or t
        rates[name] = next_one + wave * ambit.cos(s[name]) - wave * ambit.cos(s[name])
      end
      return rates
    end }
    local run = ambit.simulate { system, initial = { 0, 0, 0, 0, 0, 0 }, t = { 0, 1 }, solver = "stiff" }
    assert.equal("complete", run.status, run.reason)
    local factorial = 1
    for k = 6, 1, -1 do
      factorial = factorial * (8 - k)
      local x = run.x[names[k]]
      assert.is_true(x.lo <= 1 / factorial * (1 + 1e-15) and x.hi >= 1 / factorial * (1 - 1e-15), names[k])
      assert.is_true(x.hi - x.lo < 1e-9, names[k])
    end
  end)
end)
