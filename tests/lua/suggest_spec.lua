-- Which solver a run gets that names none, and what `ambit explain` says about it. The examples are far from the
-- thresholds, so that these may be tuned.
local ambit = require "ambit"
local command = os.getenv "AMBIT_COMMAND"

local function ode(states, equations) return ambit.ode { states = states, equations = equations } end

local pendulum = ode({ "phi", "omega" }, function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) } end)
local relaxation = ode({ "x" }, function(s, _, t) return { x = -10000 * (s.x - ambit.cos(t)) } end)
local rubbing = ode({ "x", "v" }, function(s)
  return { x = s.v, v = -s.x - ambit.number("0.1") * s.v * ambit.abs(s.v) }
end)
local linear = ode({ "x", "y" }, function(s) return { x = s.y, y = -s.x } end)

local function chosen(t)
  local run = ambit.simulate(t)
  return run.solver, run.solver_reason
end

describe("without a solver, simulate takes", function()
  it("lohner for narrow data", function()
    local solver, why = chosen { pendulum, initial = { phi = 1, omega = 0 }, t = 1 }
    assert.equal("lohner", solver)
    assert.matches("no uncertain data", why)
    solver, why = chosen { pendulum, initial = { phi = ambit.around(1, "0.0001%"), omega = 0 }, t = 1 }
    assert.equal("lohner", solver)
    assert.matches("close to linear in the uncertain data", why)
  end)

  it("lohner for wide data of linear equations", function()
    assert.equal("lohner", (chosen { linear, initial = { x = ambit.between(1, 5), y = ambit.between(-3, 3) }, t = 1 }))
  end)

  it("taylor_model for wide data", function()
    local solver, why = chosen { pendulum, initial = { phi = ambit.between("0.5", "1.5"), omega = 0 }, t = 4 }
    assert.equal("taylor_model", solver)
    assert.matches("wide data", why)
  end)

  it("stiff for stiff equations, not for short looks at them", function()
    local solver, why = chosen { relaxation, initial = { x = 0 }, t = 1 }
    assert.equal("stiff", solver)
    assert.matches("the fastest motion decays by a factor of e 1e%+04 times", why)
    assert.equal("lohner", (chosen { relaxation, initial = { x = 0 }, t = 1e-4 }))
    local kinked = ode({ "x" }, function(s, _, t) return { x = -10000 * (ambit.abs(s.x) - 2 - ambit.cos(t)) } end)
    assert.equal("lohner", (chosen { kinked, initial = { x = 3 }, t = "0.2" })) -- `stiff` needs derivatives
  end)

  it("zonotope for what is not smooth", function()
    local solver, why = chosen { rubbing, initial = { x = 0, v = 1 }, t = 2 } -- v changes its sign near 1.6
    assert.equal("zonotope", solver)
    assert.matches("crosses the kink of `abs", why)
    assert.equal("lohner", (chosen { rubbing, initial = { x = 0, v = 1 }, t = 1 })) -- on one side of it
  end)

  it("zonotope for many data that bend the solution", function()
    local function chain(n)
      local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
      local at, initial = m.world, {}
      for i = 1, n do
        at = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" .. i },
          offset = { ambit.around("0.5", "0.1%"), 0, 0 } }
        m:point_mass { at = at, mass = ambit.around(1, "0.1%") }
        initial["q" .. i], initial["q" .. i .. "'"] = 0, 0
      end
      return m:dynamics(), initial
    end
    local m, initial = chain(3) -- six data
    local solver, why = chosen { m, initial = initial, t = "0.1" }
    assert.equal("zonotope", solver)
    assert.matches("6 uncertain data and 6 states", why)
    m, initial = chain(1)
    assert.not_equal("zonotope", (chosen { m, initial = initial, t = "0.1" }))
    local linear, start = {}, {} -- never bends
    for i = 1, 6 do linear[i], start["x" .. i] = "x" .. i, ambit.between(1, 2) end
    local decay = ode(linear, function(s)
      local rate = {}
      for _, name in ipairs(linear) do rate[name] = -s[name] end
      return rate
    end)
    assert.equal("lohner", (chosen { decay, initial = start, t = 1 }))
  end)

  it("lohner for closed loops", function()
    local m = ambit.mechanism { "loop", gravity = { 0, -9.81, 0 } }
    local bar = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 1, 0, 0 } }
    local tip = m:rigid_link { from = m:revolute { from = bar, axis = "z", name = "b" }, offset = { 1, 0, 0 } }
    m:point_mass { at = bar, mass = 1 }
    m:point_mass { at = tip, mass = 1 }
    m:close_distance { a = m.world, b = tip, length = ambit.sqrt(2) }
    local solver, why = chosen {
      m:dynamics(), t = 0.01, initial = { a = ambit.between("0.3", "0.9"), b = ambit.pi / 2, ["a'"] = 0 },
    }
    assert.equal("lohner", solver)
    assert.matches("closed loops", why)
  end)
end)

describe("options", function()
  it("restrict the choice to solvers that have them", function()
    -- wide, but `history` is an option of lohner alone
    assert.equal("lohner", (chosen {
      pendulum, initial = { phi = ambit.between("0.5", "1.5"), omega = 0 }, t = "0.1", history = 8,
    }))
  end)

  it("of different solvers do not go together", function()
    local function says(text, more)
      local t = { pendulum, initial = { phi = 1, omega = 0 }, t = 1 }
      for key, value in pairs(more) do t[key] = value end
      local good, problem = pcall(ambit.simulate, t)
      assert.is_false(good)
      assert.is_truthy(problem:find(text, 1, true), problem)
    end
    says("unknown key `ordr`; did you mean `order`?", { ordr = 3 })
    says("unknown key `initail`; did you mean `initial`?", { initail = 3 })
    local alone = {} -- an option that only this solver has
    for _, name in ipairs { "lohner", "taylor_model", "stiff", "valencia" } do
      for _, param in ipairs(ambit.plugin("solver", name).parameters) do
        alone[param.name] = alone[param.name] == nil and name or "several"
      end
    end
    local one, other
    for key, name in pairs(alone) do
      if name == "lohner" then one = key end
      if name == "taylor_model" then other = key end
    end
    says("no solver has all these options", { [one] = 4, [other] = 4 })
    says(("`%s` is one of lohner"):format(one), { [one] = 4, [other] = 4 })
  end)
end)

describe("the choice", function()
  it("is the same every time, and costs little", function()
    local first, reason = chosen { pendulum, initial = { phi = ambit.between("0.5", "1.5"), omega = 0 }, t = 2 }
    for _ = 1, 3 do
      local again, why = chosen { pendulum, initial = { phi = ambit.between("0.5", "1.5"), omega = 0 }, t = 2 }
      assert.equal(first, again)
      assert.equal(reason, why)
    end
  end)

  it("leaves errors to the run", function()
    local undefined = ambit.sqrt(ambit.between(-1, 1))
    local good, problem = pcall(ambit.simulate, { pendulum, initial = { phi = undefined, omega = 0 }, t = 1 })
    assert.is_false(good)
    assert.matches("not defined for all values", problem)
  end)
end)

describe("ambit explain", function()
  it("names the best-suited pair, also where the scene chose another", function()
    local file = os.tmpname()
    local out = assert(io.open(file, "w"))
    out:write [[
      local ambit = require "ambit"
      local function rate(s, _, t) return { x = -1e4 * (s.x - ambit.cos(t)) } end
      local f = ambit.ode { states = { "x" }, equations = rate }
      ambit.simulate { f, initial = { x = 0 }, t = 1, solver = "lohner" }]]
    out:close()
    local pipe = assert(io.popen(("%q explain %q"):format(command, file)))
    local text = pipe:read "a"
    pipe:close()
    assert.matches("best suited: stiff with %S+: stiff: the fastest motion decays", text)
    pipe = assert(io.popen(("%q explain --json %q"):format(command, file)))
    text = pipe:read "a"
    pipe:close()
    os.remove(file)
    assert.matches('"suggested":"stiff"', text)
  end)
end)
