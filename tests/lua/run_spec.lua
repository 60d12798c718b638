-- run_spec.lua -- what a run gives back: enclosures at any time, and the set at its end to go on from.
local ambit = require "ambit"

-- x = x0 cos(w t), v = -x0 w sin(w t)
local function oscillator(w)
  return ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -w * w * s.x } end }
end

local function truth(x0, w, t) return { x = x0 * math.cos(w * t), v = -x0 * w * math.sin(w * t) } end

-- Every corner of the data's box; the oracle is good to 1e-12 here.
local function check_inside(enclosure, x0s, ws, t)
  for _, x0 in ipairs(x0s) do
    for _, w in ipairs(ws) do
      local exact = truth(x0, w, t)
      for _, name in ipairs { "x", "v" } do
        assert.is_true(enclosure[name].lo <= exact[name] + 1e-12 and exact[name] - 1e-12 <= enclosure[name].hi,
          ("%s(%g) = %.17g is outside %s"):format(name, t, exact[name], tostring(enclosure[name])))
      end
    end
  end
end

describe("a run", function()
  it("knows the states at any time within a step, if it was made dense", function()
    local run = ambit.simulate { oscillator(1), initial = { x = ambit.around(1, "1%"), v = 0 }, t = { 0, 3 },
      solver = "lohner", dense = true }
    for k = 0, 60 do
      local t = 3 * k / 60
      local x = run:at(t)
      check_inside(x, { 0.99, 0.995, 1, 1.01 }, { 1 }, t)
      assert.is_true(x.x:width() < 0.021 * math.abs(math.cos(t)) + 1e-3)
    end
    local rough = ambit.simulate { oscillator(1), initial = { x = ambit.around(1, "1%"), v = 0 }, t = { 0, 3 },
      solver = "lohner" }
    assert.is_true(run:at(1.23).x:width() < 0.2 * rough:at(1.23).x:width())
  end)

  it("knows them backwards too", function()
    local run = ambit.simulate { oscillator(1), initial = { x = 1, v = 0 }, t = { 0, -2 }, solver = "lohner",
      dense = true }
    for k = 0, 40 do
      local t = -2 * k / 40
      check_inside(run:at(t), { 1 }, { 1 }, t)
      assert.is_true(run:at(t).x:width() < 1e-12)
    end
  end)

  it("gives its end as a function of the same uncertain data", function()
    local w, x0 = ambit.between("0.9", "1.1"), ambit.around(1, "1%")
    local model = oscillator(w)
    local first = ambit.simulate { model, initial = { x = x0, v = 0 }, t = { 0, 1 }, solver = "lohner" }
    local set = first:set()
    local second = ambit.simulate { model, initial = set, t = { 1, 3 }, solver = "lohner" }
    local whole = ambit.simulate { model, initial = { x = x0, v = 0 }, t = { 0, 1, 3 }, solver = "lohner" }
    check_inside(second.x, { 0.99, 1, 1.01 }, { 0.9, 0.95, 1, 1.1 }, 3)
    -- going on is as good as not having stopped; a box forgets how x, v and w belong together
    assert.is_true(second.x.x:width() < 1.1 * whole.x.x:width())
    local box = ambit.simulate { model, initial = { x = first.x.x, v = first.x.v }, t = { 1, 3 }, solver = "lohner" }
    assert.is_true(box.x.x:width() > 1.2 * second.x.x:width())
    -- and the difference of the end and the same end is zero but for the rest
    local hull = ambit.evaluate { set, arithmetic = "affine" }
    assert.equal("complete", hull.status)
    assert.is_true(hull.x.lo <= first.x.x.lo + 1e-3 and hull.x.hi >= first.x.x.hi - 1e-3)
  end)

  it("gives a box where the solver knows no more", function()
    local run = ambit.simulate { oscillator(1), initial = { x = 1, v = 0 }, t = { 0, 1 }, solver = "gsl" }
    local set = run:set()
    assert.is_true(math.abs(ambit.evaluate { set.x, arithmetic = "real" }:mid() - math.cos(1)) < 1e-6)
  end)

  it("keeps the last step only, on request", function()
    local run = ambit.simulate { oscillator(1), initial = { x = 1, v = 0 }, t = { 0, 1, 2, 3, 4, 5 }, solver = "lohner",
      keep = "last" }
    local count = 0
    for step in run:steps() do
      count = count + 1
      assert.equal(5, step.t)
    end
    assert.equal(1, count)
    assert.is_true(run.step_count >= 5)
    check_inside(run.x, { 1 }, { 1 }, 5)
    assert.has_error(function() run:at(1) end)
  end)
end)
