-- Inputs that nobody means: what each was mended for. The whole list is the suite of `ambit stability`.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"

local function growth() return ambit.ode { states = { "x" }, equations = function(s) return { x = s.x } end } end

local function turning()
  return ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = -s.x * ambit.cos(t) } end }
end

local function solve(t)
  local run = ambit.simulate(t)
  session.worst = "ok"
  return run
end

local function fails(words, f, ...)
  local good, message = pcall(f, ...)
  assert.is_false(good)
  for _, word in ipairs(words) do assert.truthy(tostring(message):find(word, 1, true), message) end
end

describe("valencia", function()
  it("encloses the solution where steps may not be as short as the tolerance needs", function()
    for _, order in ipairs { 4, 6, 8 } do
      for _, step_min in ipairs { 0.005, 0.01, 0.02 } do
        local run = solve { growth(), initial = { x = 1 }, t = { 0, 1 }, solver = "valencia", order = order,
          step_min = step_min, tolerance = 1e-16 }
        for step in run:steps() do
          assert.is_true(step.t > step.t_from)
          assert.is_false(step.x.x:intersect(ambit.exp(ambit.interval(step.t))):is_empty())
        end
      end
    end
  end)

  it("ends where instants are too far apart for a shorter step", function()
    local run = solve { turning(), initial = { x = 1 }, t = { 1e16, 1e16 + 2 }, solver = "valencia", width_max = 10 }
    assert.equal("unable", run.status)
    assert.equal(1e16, run.t_reached)
  end)
end)

describe("gsl", function()
  local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }

  it("ends a run that slows down without end, and says which knob to turn", function()
    local sliding = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x / ambit.abs(s.x) } end }
    local run = solve { sliding, initial = { x = 1 }, t = { 0, 2 }, solver = "gsl", steps_max = 5000, keep = "last" }
    assert.equal("unable", run.status)
    assert.equal(5000, run.step_count)
    assert.truthy(run.reason:find "^at t = 1 s 5000 steps")
    assert.truthy(run.reason:find("`steps_max`", 1, true))
  end)

  it("takes as many steps as it may", function()
    local t = { decay, initial = { x = 1 }, t = { 0, 1 }, solver = "gsl", step_max = 0.125, relative = 1e-3 }
    local count = solve(t).step_count
    t.steps_max = count
    assert.equal("complete", solve(t).status)
    t.steps_max = count - 1
    assert.equal("unable", solve(t).status)
  end)

  it("lasts for the least number of seconds", function()
    local run = solve { decay, initial = { x = 1 }, t = { 0, 0x1p-1074 }, solver = "gsl" }
    assert.equal("complete", run.status)
    assert.equal(1, run.x.x.lo)
  end)
end)

describe("every solver", function()
  it("names time and knob for initial values that it cannot hold", function()
    for _, solver in ipairs { "lohner", "taylor_model" } do
      local run = solve { growth(), initial = { x = 1e308 }, t = { 3, 4 }, solver = solver }
      assert.equal("unable", run.status)
      assert.truthy(run.reason:find "^at t = 3 s the initial values")
      assert.truthy(run.reason:find("`initial`", 1, true))
    end
  end)

  it("refuses a horizon that is longer than the largest number, and NaN by name", function()
    for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff", "gsl" } do
      fails({ "time span", "too long" }, ambit.simulate,
        { growth(), initial = { x = 1 }, t = { -1.7e308, 1.7e308 }, solver = solver })
    end
    fails({ "t[2]", "got NaN" }, ambit.simulate, { growth(), initial = { x = 1 }, t = { 0, 0 / 0 } })
  end)
end)

describe("a slider-crank that runs into its dead point", function()
  it("ends with a reason in every solver, whatever is kept of the run", function()
    local m = ambit.mechanism { "slider-crank", gravity = { 0, 0, 0 } }
    local crank = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 1, 0, 0 } }
    local rod = m:rigid_link { from = m:revolute { from = crank, axis = "z", name = "b" }, offset = { 2, 0, 0 } }
    local slider = m:prismatic { from = m.world, axis = "x", name = "s" }
    m:point_mass { at = slider, mass = 1 }
    m:close_pin { a = rod, b = slider }
    m:independent { "s" }
    local initial = m:assemble { s = "2.875", guess = { a = "0.3", b = "-0.5" } }.configuration
    initial["s'"] = 1
    for _, solver in ipairs { "gsl", "lohner" } do
      for _, keep in ipairs { "all", "last" } do
        local run = solve { m:dynamics(), initial = initial, t = { 0, 0.5 }, solver = solver, keep = keep }
        assert.equal("unable", run.status)
        assert.truthy(math.abs(run.t_reached - 0.125) < 0.001)
        assert.truthy(run.reason:find "^at t = 0.125 s ")
      end
    end
  end)
end)

describe("memory that is too small", function()
  it("is told with what to turn", function()
    if core.is_sanitized then return pending "no limit of memory" end
    local child = core.child(function()
      local names, initial = {}, {}
      for i = 1, 1000 do names[i], initial[i] = "x" .. i, i end
      local ring = ambit.ode { states = names, equations = function(s)
        local rates = {}
        for i, name in ipairs(names) do rates[name] = s[names[i % 1000 + 1]] - s[name] end
        return rates
      end }
      return select(2, pcall(ambit.simulate, { ring, initial = initial, t = { 0, 1 }, solver = "valencia" }))
    end, { cpu = 20, memory = 3e8 })
    local _, ended = core.child_wait({ child }, 60)
    assert.equal("done", ended.outcome)
    for _, word in ipairs { "solver `valencia`", "out of memory", "fewer data uncertain", "`order`" } do
      assert.truthy(ended.value:find(word, 1, true), ended.value)
    end
  end)
end)

describe("powers", function()
  it("of half integers are defined at zero", function()
    local x = ambit.between(0, 4)
    local y = ambit.evaluate { x ^ 1.5 }
    assert.is_false(y.partial)
    assert.is_true(y:contains(0) and y:contains(8) and y.hi < 8.001)
    assert.equal(0, ambit.evaluate { ambit.number(0) ^ "0.5" }.hi)
    assert.equal(0, (ambit.interval(0) ^ 2.5).hi)
    assert.is_true((ambit.interval(-1, 4) ^ -0.5).partial)
    assert.is_true((ambit.interval(4) ^ "-1.5"):contains(0.125))
  end)
end)

describe("texts", function()
  it("beyond the largest number are refused as such, and so is a zero byte", function()
    fails({ "1e400", "beyond the largest number" }, ambit.number, "1e400")
    fails({ "-1e400", "beyond the largest number" }, ambit.between, "-1e400", 1)
    fails({ "zero byte" }, ambit.number, "1\0")
    fails({ "zero byte" }, ambit.interval, "1\0002")
  end)
end)
