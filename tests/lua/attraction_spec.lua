-- Starts from which every solution comes to rest: ambit.attraction.
local ambit = require "ambit"
local cover = require "ambit.forever.cover"

local function random(lo, hi) return lo + (hi - lo) * math.random() end

-- A step of Runge and Kutta's, in floats.
local function step(f, x, h)
  local function moved(k, by)
    local y = {}
    for i, value in ipairs(x) do y[i] = value + by * k[i] end
    return y
  end
  local a = f(x)
  local b = f(moved(a, 0.5 * h))
  local c = f(moved(b, 0.5 * h))
  local d = f(moved(c, h))
  local y = {}
  for i = 1, #x do y[i] = x[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) end
  return y
end

local function tanh(x)
  local e = math.exp(-2 * math.abs(x))
  return (x < 0 and -1 or 1) * (1 - e) / (1 + e)
end

local function fails(f, text)
  local good, why = pcall(f)
  assert.is_false(good)
  assert.is_truthy(tostring(why):find(text, 1, true), tostring(why))
end

describe("a region of attraction", function()
  it("goes up to the separatrix, and not beyond it", function()
    local a = ambit.around(1, "10%", "a")
    local bistable = ambit.ode { states = { "x" }, equations = function(s) return { x = a * (s.x - s.x ^ 3) } end }
    local region = ambit.attraction { bistable, about = { x = 1 }, within = { x = { -1, 3 } }, budget = 60 }
    assert.equal("proved", region.status)
    assert.is_true(region.share > 0.7 and region.share <= 0.75, region.share) -- of it 3/4 tend to 1: x > 0
    assert.is_true(region:contains { x = ambit.between("0.2", "2.9") })
    for _, x in ipairs { 0, -0.5, -1 } do assert.is_false(region:contains { x = x }) end
    assert.is_false(region:contains { x = ambit.between("-0.1", 1) })
    assert.is_true(region.settles.x:contains(1) and region.settles.x:width() < 1e-6)
  end)

  it("holds for all masses and whatever pushes", function()
    math.randomseed(191)
    local mass, push = ambit.around(1, "10%", "mass"), ambit.varying("-0.2", "0.2", "push")
    local pendulum = ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = "9.81" * ambit.sin(s.x) + push - 8 / mass * ambit.tanh((20 * s.x + 6 * s.v) / 8) }
    end }
    local region = ambit.attraction { pendulum, about = { x = 0 }, within = { x = { -1, 1 }, v = { -2, 2 } },
      budget = 100, split = { [mass] = 2 } }
    assert.equal("proved", region.status)
    local flown = 0
    for _, cell in ipairs(region.cells) do
      local x = { cell.lo[1] + math.random(0, 1) * (cell.hi[1] - cell.lo[1]), random(cell.lo[2], cell.hi[2]) }
      if not region.set:contains { x = x[1], v = x[2] } then flown = flown + 1 end
      local m, turn = math.random() < 0.5 and 0.9 or 1.1, math.random(1, 3)
      for k = 1, 1500 do -- pushed with the motion, against rest, or at random
        local w = turn == 1 and x[2] or turn == 2 and x[1] or math.sin(0.01 * k * k)
        w = w >= 0 and 0.2 or -0.2
        x = step(function(y)
          return { y[2], 9.81 * math.sin(y[1]) + w - 8 / m * tanh((20 * y[1] + 6 * y[2]) / 8) }
        end, x, 0.02)
      end
      assert.is_true(region.settles.x:contains(x[1]) and region.settles.v:contains(x[2]))
    end
    assert.is_true(flown >= 5, flown) -- not by the set alone
    assert.is_false(region:contains { x = 1, v = 2 })
  end)

  it("is what the regions for all parts of the data have in common", function()
    for _, d in ipairs { ambit.between(0, "0.4", "d"), "0.4" - ambit.between(0, "0.4", "d") } do
      local system = ambit.ode { states = { "x" }, parameters = { d = d },
        equations = function(s, p) return { x = (s.x - p.d) * (1 - s.x) } end } -- from x > d to 1
      local region = ambit.attraction { system, about = { x = 1 }, within = { x = { "0.01", 2 } }, budget = 40,
        split = { d = 4 } }
      assert.is_true(region:contains { x = ambit.between("0.5", 2) })
      assert.is_true(region.share <= 1.6 / 1.99)
      for _, x in ipairs { "0.02", "0.15", "0.25", "0.35", "0.399" } do assert.is_false(region:contains { x = x }) end
    end
  end)

  it("has starts that leave the box, turn over and come back", function()
    math.randomseed(193)
    local pendulum = ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = "9.81" * ambit.sin(s.x) - 5 * ambit.tanh(4 * s.x + "1.2" * s.v) }
    end }
    local region = ambit.attraction { pendulum, about = { x = 0 }, within = { x = { -0.75, 0.75 }, v = { -2, 2 } },
      budget = 200 }
    local far = 0
    for _, cell in ipairs(region.cells) do
      local x, farthest = { random(cell.lo[1], cell.hi[1]), random(cell.lo[2], cell.hi[2]) }, 0
      for _ = 1, 2000 do
        x = step(function(y) return { y[2], 9.81 * math.sin(y[1]) - 5 * tanh(4 * y[1] + 1.2 * y[2]) } end, x, 0.01)
        farthest = math.max(farthest, math.abs(x[1]))
      end
      if farthest > 3.2 then far = far + 1 end -- beyond the lowest point
      assert.is_true(math.abs(x[1]) < 1e-6 and math.abs(x[2]) < 1e-6)
    end
    assert.is_true(far >= 4, far)
  end)

  it("is not proved by a solver that proves nothing, and takes several data in parts", function()
    local a, b = ambit.around(1, "10%", "a"), ambit.around(1, "3%", "start x")
    local system = ambit.ode { states = { "x" }, equations = function(s) return { x = a * (s.x - b * s.x ^ 3) } end }
    local function region(solver)
      return ambit.attraction { system, about = { x = 1 }, within = { x = { -1, 3 } }, budget = 30,
        split = { [a] = 2, [b] = 2 }, solver = solver }
    end
    local unproved, proved = region "gsl", region()
    local set = proved.set.box.x
    assert.is_true(unproved.share <= set:width() / 4) -- of cells in the set alone
    assert.is_true(proved.share > 0.6 and proved.share <= 0.75, proved.share)
  end)

  it("is not claimed where rest attracts nothing", function()
    local system = ambit.ode { states = { "x", "v" }, equations = function(s)
      return { x = s.v, v = -s.x + "0.1" * s.v }
    end }
    local region = ambit.attraction { system, about = { x = 0 }, within = { x = { -1, 1 }, v = { -1, 1 } } }
    assert.equal("undecided", region.status)
    assert.is_false(region:contains { x = 0, v = 0 })
  end)

  it("says what is missing", function()
    local system = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x - s.v } end }
    fails(function() ambit.attraction { system, about = { x = 0 } } end, "within is missing")
    fails(function() ambit.attraction { system, about = { x = 0 }, within = { x = { -1, 1 } } } end,
      "the state `v` has no range")
    fails(function() ambit.attraction { system, about = { x = 0 }, within = { x = { -1, 1 }, v = { 0, 0 } } } end,
      "within.v")
    fails(function()
      ambit.attraction { system, about = { x = 0 }, within = { x = { -1, 1 }, v = { -1, 1 } }, horizon = -1 }
    end, "horizon")
  end)
end)

describe("boxes that cover another", function()
  it("are told from those that do not, as points tell", function()
    math.randomseed(192)
    local yes, no = 0, 0
    for _ = 1, 300 do
      local cells = {}
      for k = 1, 12 do
        local x, y = math.random(0, 4), math.random(0, 4)
        cells[k] = { lo = { x, y }, hi = { x + math.random(1, 3), y + math.random(1, 3) } }
      end
      local x, y = math.random(1, 4), math.random(1, 4)
      local box = { lo = { x, y }, hi = { x + math.random(0, 2), y + math.random(0, 2) } }
      local all = true
      for i = 0, 40 do
        for j = 0, 40 do -- also within cells of the grid of corners
          local p, q = box.lo[1] + (box.hi[1] - box.lo[1]) * i / 40, box.lo[2] + (box.hi[2] - box.lo[2]) * j / 40
          local found = false
          for _, c in ipairs(cells) do
            found = found or c.lo[1] <= p and p <= c.hi[1] and c.lo[2] <= q and q <= c.hi[2]
          end
          all = all and found
        end
      end
      assert.equal(all, cover.contains(cells, box))
      if all then yes = yes + 1 else no = no + 1 end
    end
    assert.is_true(yes > 20 and no > 20)
  end)
end)
