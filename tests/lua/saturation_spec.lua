-- tanh and the logistic function at any argument, in every solver, against closed forms; Coulomb friction made smooth,
-- through its reversals, against samples.
local ambit = require "ambit"
local around, tanh, exp, number = ambit.around, ambit.tanh, ambit.exp, ambit.number

local SOLVERS = { "lohner", "taylor_model", "zonotope", "stiff", "valencia" }

local function linear(states, equations) return ambit.ode { states = states, equations = equations, check_units = false } end

-- u' = -tanh u from u0: sinh u falls as e^-t
local function slowed(u0, t)
  local log_of_sinh = u0 - math.log(2) + math.log(1 - math.exp(-2 * u0)) - t
  if log_of_sinh > 20 then return log_of_sinh + math.log(2) end
  local s = math.exp(log_of_sinh)
  return math.log(s + math.sqrt(s * s + 1))
end

describe("tanh", function()
  for _, solver in ipairs(SOLVERS) do
    it("slows down in closed form by " .. solver, function()
      for _, case in ipairs { { 0.5, 2 }, { 30, 20 }, { 1000, 7 }, { 400, 400 }, { -2500, 40 } } do
        for _, scale in ipairs { 0x1p-20, 1, 0x1p20 } do -- of the state, and of time
          local u0, t = case[1], case[2]
          local o = linear({ "x" }, function(s) return { -tanh(s.x / scale) } end)
          local run = ambit.simulate { o, initial = { u0 * scale }, t = { 0, t * scale }, solver = solver }
          assert.equal("complete", run.status, run.reason)
          local want = (u0 < 0 and -1 or 1) * slowed(math.abs(u0), t) * scale
          local x, slack = run.x.x, 1e-14 * math.abs(u0) * scale -- of `want`, which is a double
          assert.is_true(x.lo - slack <= want and want <= x.hi + slack)
          assert.is_true(x:width() < 1e-7 * math.abs(u0) * scale)
        end
      end
    end)
  end
end)

describe("the logistic function", function()
  -- y' = e^y / (1 + e^y) = 1 - 1 / (1 + e^y): y - e^-y grows by t. All are increasing.
  local function grown(y) return y - math.exp(-y) end
  for _, solver in ipairs(SOLVERS) do
    it("is bounded however large its argument is, by " .. solver, function()
      for _, y0 in ipairs { -3, 0.5, 50, 800, 1e5 } do
        for _, form in ipairs { function(y) return exp(y) / (1 + exp(y)) end, function(y) return 1 - 1 / (exp(y) + 1) end,
          function(y) return 1 / (1 + exp(-y)) end } do
          local o = linear({ "y" }, function(s) return { form(s.y) } end)
          local run = ambit.simulate { o, initial = { y0 }, t = { 0, 3 }, solver = solver }
          assert.equal("complete", run.status, run.reason)
          local y, want = run.x.y, grown(y0) + 3
          local slack = 1e-14 * (1 + math.abs(want))
          assert.is_true(grown(y.lo) <= want + slack and grown(y.hi) >= want - slack)
          assert.is_true(y:width() < 1e-9 * (1 + math.abs(y0)))
        end
      end
    end)
  end
end)

describe("Coulomb friction, made smooth", function()
  local state = 1
  local function random(lo, hi)
    state = (state * 6364136223846793005 + 1442695040888963407) & 0x7fffffffffffffff
    return lo + (hi - lo) * ((state >> 11) % 0x100000) / 0x100000
  end

  -- A pendulum with friction at its hinge; time in units of `scale` seconds.
  local function pendulum(v0, friction, start, scale)
    local pull, drag, width = number(9.81) / scale ^ 2, around(friction, "2%") / scale ^ 2, number(v0) / scale
    local o = linear({ "a", "w" }, function(s) return { s.w, -pull * ambit.sin(s.a) - drag * tanh(s.w / width) } end)
    return { o, initial = { a = around(start, "1%"), w = 0 }, t = { 0, number(1.5) * scale, number(3) * scale } }
  end

  it("is followed through reversals by the default call", function()
    for i = 1, 12 do
      local v0, friction, start = 10 ^ random(-4, -1), random(0.1, 1), random(0.5, 1.2)
      local q = pendulum(v0, friction, start, i % 3 == 0 and 1024 or 1)
      local run = ambit.simulate(q)
      assert.equal("complete", run.status, run.reason)
      local seen = ambit.sample { q[1], initial = q.initial, t = q.t, n = 60 }
      local result = run:overestimation(seen)
      assert.is_nil(result.contradiction)
      for _, name in ipairs(run.states) do
        local hull, set = seen:at(q.t[3])[name], run:at(q.t[3])[name]
        assert.is_true(set:width() < 1.5 * (hull.hi - hull.lo), ("v0 %g, friction %g, start %g: %g times"):format(v0,
          friction, start, set:width() / (hull.hi - hull.lo)))
      end
    end
  end)
end)

describe("a wide set that comes to rest on a slope of tanh", function()
  it("becomes as narrow as its hull, in any unit of time", function()
    for _, load in ipairs { 0, 0.3, -0.6 } do
      for _, width in ipairs { 0.5, 1, 2, 5 } do
        for _, scale in ipairs { 0x1p-20, 1, 0x1p20 } do
          local o = linear({ "x" }, function(s) return { (load - tanh(s.x)) / scale } end)
          local run = ambit.simulate { o, initial = { around(0, width) }, t = { 0, 80 * scale }, solver = "zonotope" }
          assert.equal("complete", run.status, run.reason)
          local rest = 0.5 * math.log((1 + load) / (1 - load))
          assert.is_true(run.x.x.lo <= rest + 1e-15 and run.x.x.hi >= rest - 1e-15 and run.x.x:width() < 1e-4)
        end
      end
    end
  end)

  it("does so where friction holds what has slipped, in two coordinates", function()
    local first, second, grip = around("0.25", "2%"), around("1.6", "2%"), around(180, "5%")
    local o = linear({ "slip", "momentum" }, function(s, _, t)
      local torque = grip * (1 - exp(-t / "0.2")) * tanh(s.slip / 2)
      local car = (s.momentum - first * s.slip) / (first + second)
      return { (60 - torque) / first - (torque - "0.05" * car) / second, 60 - "0.05" * car }
    end)
    local q = { o, initial = { 150, 150 * first }, t = { 0, 1, 2 } }
    local run = ambit.simulate(q)
    assert.equal("complete", run.status, run.reason)
    local seen = ambit.sample { o, initial = q.initial, t = q.t, n = 60 }
    assert.is_nil(run:overestimation(seen).contradiction)
    for _, name in ipairs(run.states) do
      for i = 2, 3 do
        local hull = seen:at(q.t[i])[name]
        assert.is_true(run:at(q.t[i])[name]:width() < 1.1 * (hull.hi - hull.lo))
      end
    end
  end)
end)
