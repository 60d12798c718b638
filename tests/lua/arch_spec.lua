-- Small versions of the benchmarks of scripts/bench/arch: what is proved, how wide, in how many steps.
local folder = debug.getinfo(1, "S").source:match "^@(.*)tests/lua/" or "./"
package.path = folder .. "scripts/bench/?.lua;" .. folder .. "scripts/bench/arch/?.lua;" .. package.path
local ambit = require "ambit"

local function cases_of(scene)
  local by = {}
  for _, case in ipairs(require(scene)) do by[case.problem] = case end
  return by
end

local function bounds_of(run)
  local bounds = {}
  for step in run:steps() do
    for name, x in pairs(step.tube) do bounds[name] = bounds[name] and bounds[name]:hull(x) or x end
  end
  return bounds
end

-- The case's run with these settings changed.
local function simulate(case, changes)
  local request = {}
  for key, value in pairs(case.request) do request[key] = value end
  for key, value in pairs(changes or {}) do request[key] = value end
  return ambit.simulate(request)
end

-- Within a tenth above the width that was measured, and not far below, where no sound bound can be.
local function assert_width(measured, width) assert.is_true(width > 0.5 * measured and width < 1.1 * measured) end

describe("ARCH benchmarks", function()
  it("follow Laub and Loomis from a box of seven unknowns", function()
    local case = cases_of "laub_loomis" ["LALO20 W = 0.01"]
    local run = simulate(case)
    assert.is_true(case.proved(run, bounds_of(run)))
    assert_width(0.002524, run.x.x4:width())
    assert.is_true(run.step_count <= 77)
    local bounds = bounds_of(run)
    bounds.x4 = bounds.x4 + 0.5
    assert.is_false(case.proved(run, bounds)) -- what would reach 4.5 is noticed
    for _, side in ipairs { -0.0099, 0.0099 } do
      local start = {}
      for i, c in ipairs { 1.2, 1.05, 1.5, 2.4, 1, 0.1, 0.45 } do start["x" .. i] = c + side end
      local point = ambit.simulate { case.request[1], initial = start, t = { 0, 20 }, solver = "lohner" }
      for i = 1, 7 do assert.is_true(run.x["x" .. i]:contains(point.x["x" .. i]:mid())) end
    end
  end)

  it("follow the wide box of Laub and Loomis for a while", function()
    local case = cases_of "laub_loomis" ["LALO20 W = 0.1"]
    local run = simulate(case, { t = { 0, 5 }, order = 4 })
    assert.is_true(case.proved(run, bounds_of(run)))
    assert.is_true(run.step_count <= 40)
  end)

  it("keep two oscillators below a speed", function()
    local case = cases_of "coupled_van_der_pol" ["CVDP20 mu = 1"]
    local run = simulate(case)
    assert.is_true(case.proved(run, bounds_of(run)))
    assert_width(0.1113, run.x.x1:width())
    assert_width(0.4616, run.x.y1:width())
  end)

  it("hold Robertson's stiff reactions", function()
    for _, case in ipairs(require "robertson") do
      local run = simulate(case)
      assert.is_true(case.proved(run))
      assert.is_true(case.widths(run)["x + y + z"] < 1e-14)
    end
  end)

  it("keep production and destruction positive", function()
    for _, case in ipairs(require "production_destruction") do
      local run = simulate(case)
      assert.is_true(case.proved(run, bounds_of(run)))
    end
  end)

  it("bring a quadrotor to its goal", function()
    for name, case in pairs(cases_of "quadrotor") do
      local run = simulate(case)
      assert.is_true(case.proved(run, bounds_of(run)), name)
      assert.is_true(run.step_count <= 65)
    end
  end)

  it("follow hunters and prey past a circle that some touch", function()
    local row = require "lotka_volterra"[1].run()
    assert.is_true(row.proved)
    local twice, four = row.crossings[2], row.crossings[4]
    assert.equal(240000, twice + four + row.undecided) -- of the start, in units of 1e-7
    assert.is_true(row.undecided > 0 and row.undecided <= 160) -- one of them touches
    assert_width(1.77e-5, row.widths.area)
  end)
end)
