-- The one-track model with the reductions that were published for it, and the two-track model: scripts/one_track.lua
-- and two_track.lua. Published: Mikelsons and Brandt, DETC2009-86954, equations 25 to 41.
local ambit = require "ambit"

local one_track = assert(loadfile "scripts/one_track.lua")("model")
local two_track = assert(loadfile "scripts/two_track.lua")("model")

-- Verdicts and true deviations (equation 19), by Runge-Kutta with 4001 points, 41 speeds, both ends of delta: an oracle
-- in ordinary floating point that shares nothing with the proofs. A proved bound cannot be below the true deviation at
-- its nodes; how far it may be above says how tight we want to stay.
local expected = {
  { "accepted", x = { 0.0729, 0.0730 }, y = { 0.0814, 0.0816 } },
  { "rejected", x = { 0.0729, 0.0730 }, y = { 15.84, 15.9 } },
  { "accepted", x = { 0.05, 0.3 }, y = { 0.1, 0.2 } },
  { "rejected", x = { 166.6, 168 }, y = { 52, 1000 } },
  { "accepted", ["vy'"] = { 0, 1e-12 }, ["yaw_rate'"] = { 0, 1e-12 } }, -- nothing but rounding
  { "rejected", ["vy'"] = { 0.4, 0.8 }, ["yaw_rate'"] = { 0.1, 0.5 } },
  { "accepted", vy = { 0.03778, 0.0379 }, yaw_rate = { 0.004478, 0.0046 } },
  { "rejected", ["vy'"] = { 0.348, 0.4 }, ["yaw_rate'"] = { 0.02428, 0.0999 } }, -- the yaw acceleration alone would do
}

-- What takes longer, and is as tight as that.
local thorough = { { split = 8, solver = "taylor_model" }, { solver = "taylor_model" }, {}, { solver = "lohner" },
  { solver = "lohner" }, { solver = "lohner" }, { solver = "taylor_model" },
  { solver = "lohner", split = { v = 16, delta = 4 } } }

describe("the one-track model", function()
  it("is judged with no option, and every verdict is the expected one", function()
    local exit = require "ambit.code".exit
    for k, case in ipairs(one_track.published()) do
      local verdict = one_track.judge(case[2], case[3], case[4])
      assert.equal(expected[k][1], verdict.status == "proved" and "accepted" or "rejected", case[1])
      assert.equal(0, exit(verdict.code), case[1])
    end
  end)

  for k, case in ipairs(one_track.published()) do
    it(("judges: %s"):format(case[1]), function()
      local how = {}
      for key, value in pairs(case[4] or {}) do how[key] = value end
      for key, value in pairs(thorough[k]) do how[key] = value end
      local verdict = one_track.judge(case[2], case[3], how)
      assert.equal(expected[k][1], verdict.status == "proved" and "accepted" or "rejected")
      for _, name in ipairs(verdict.outputs) do
        local least, most = table.unpack(expected[k][name])
        assert.is_true(verdict.error[name] >= least, ("%s: %.9g < %g"):format(name, verdict.error[name], least))
        assert.is_true(verdict.error[name] <= most, ("%s: %.9g > %g"):format(name, verdict.error[name], most))
      end
    end)
  end

  it("has a steady state for each angle", function() -- with the printed sign vy would end at -0.0191
    local box = ambit.evaluate { one_track.steady(one_track.steady_corner().car.parameters),
      arithmetic = "affine" }
    assert.is_true(math.abs(box.yaw_rate.lo - 0.055397) < 1e-6 and math.abs(box.yaw_rate.hi - 0.083096) < 1e-6)
    assert.is_true(math.abs(box.vy.lo + 0.037729) < 1e-6 and math.abs(box.vy.hi + 0.025153) < 1e-6)
  end)

  it("finds that nothing moves in a steady corner", function()
    local q = one_track.steady_corner()
    local small = ambit.reduce { q.car, t = { 0, 2 }, initial = q.initial, outputs = q.outputs, error = q.error }
    assert.equal("complete", small.status)
    assert.equal(0, small.terms_after)
    for _, bound in pairs(small.error) do assert.is_true(bound < 1e-12) end
  end)

  it("finds the published reduction of the straight ride by itself", function()
    local q = one_track.straight()
    local small = one_track.reduce(q, "bounds")
    assert.equal("complete", small.status)
    assert.is_true(small.equations_after <= 3 and small.terms_after <= 3, tostring(small))
    for name, bound in pairs(small.error) do assert.is_true(bound <= tonumber(q.error[name])) end
  end)
end)

-- -- two tracks

-- Classical Runge-Kutta on plain numbers, with the equations written again by hand.
local geometry = { { 1.3, 0.75, 4e4, true }, { 1.3, -0.75, 4e4, true }, { -1.45, 0.75, 5e4 }, { -1.45, -0.75, 5e4 } }

-- s: four speeds, four along, four across, x, y, yaw, vx, vy, yaw rate
local function derivative(s, delta)
  local d, X, Y, M = {}, 0, 0, 0
  local vx, vy, turn = s[16], s[17], s[18]
  for k, w in ipairs(geometry) do
    local angle = w[4] and delta or 0
    local c, n, ux, uy = math.cos(angle), math.sin(angle), vx - turn * w[2], vy + turn * w[1]
    local u, v, roll = ux * c + uy * n, uy * c - ux * n, 0.3 * s[k]
    d[k], d[4 + k] = -0.3 * s[4 + k], u / 0.3 * (6e4 * (1 - u / roll) - s[4 + k])
    d[8 + k] = -u / 0.6 * (w[3] * v / roll + s[8 + k])
    local fx, fy = s[4 + k] * c - s[8 + k] * n, s[4 + k] * n + s[8 + k] * c
    X, Y, M = X + fx, Y + fy, M + w[1] * fy - w[2] * fx
  end
  d[13], d[14] = vx * math.cos(s[15]) - vy * math.sin(s[15]), vx * math.sin(s[15]) + vy * math.cos(s[15])
  d[15], d[16], d[17], d[18] = turn, X / 1450 + turn * vy, Y / 1450 - turn * vx, M / 1920
  return d
end

local function moved(s, h, d)
  local r = {}
  for i = 1, 18 do r[i] = s[i] + h * d[i] end
  return r
end

local function follow(delta, seconds, steps)
  local v, s, h = 50 / 3, {}, seconds / steps
  for i = 1, 18 do s[i] = i <= 4 and v / 0.3 or 0 end
  s[16] = v
  for _ = 1, steps do
    local a = derivative(s, delta)
    local b = derivative(moved(s, h / 2, a), delta)
    local c = derivative(moved(s, h / 2, b), delta)
    local d = derivative(moved(s, h, c), delta)
    for i = 1, 18 do s[i] = s[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
  end
  return s
end

describe("the two-track model", function()
  local seconds = 0.5
  for name, case in pairs { ["+-1e-6 rad"] = { two_track.straight, 1e-6 },
    ["+-0.1 degree"] = { two_track.tenth, math.pi / 1800 } } do
    it("is proved, and contains single runs: " .. name, function()
      local question = two_track.question(case[1], seconds)
      local run = ambit.simulate(question)
      assert.equal("complete", run.status)
      assert.is_true(run.step_count < 400, ("%d steps"):format(run.step_count)) -- 4483 in 0.1 s if guesses ignore units
      local states, widest = question[1].states, {}
      for k = -2, 2 do
        local s = follow(case[2] * k / 2, seconds, 1000)
        for i, state in ipairs(states) do
          local x, slack = run.x[state], 1e-9 * math.abs(s[i]) + 1e-7 * case[2] -- the oracle's own error
          assert.is_true(x.lo <= s[i] + slack and s[i] - slack <= x.hi, ("%s: %.12g not in %s"):format(state, s[i], x))
          widest[state] = math.max(widest[state] or 0, math.abs(s[i]))
        end
      end
      for _, state in ipairs { "y", "yaw", "vy", "yaw_rate", "fy_fl", "fy_rr" } do -- odd in delta: the hull is known
        assert.is_true(run.x[state]:width() <= 1.02 * 2 * widest[state], state)
      end
    end)
  end

  it("is not proved where wheels may stand still", function()
    local question = two_track.question(two_track.tenth, seconds)
    question.initial.omega_fl = ambit.between(-1, 1)
    local run = ambit.simulate(question)
    assert.equal("unable", run.status)
    assert.equal(0, run.t_reached)
  end)
end)
