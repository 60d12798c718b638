-- Places at which a formula has no derivative, or beyond which it is not defined: no verb may drop what happens there.
local ambit = require "ambit"
local sqrt, abs = ambit.sqrt, ambit.abs

local solvers = { "lohner", "taylor_model", "stiff", "valencia" }
local line = ambit.ode { states = { "x" }, equations = function() return { x = -1 } end }
local turn = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = -s.y, y = s.x } end }

-- f is 0 at x = y = c; is that in a box of the result?
local function is_listed(f, c)
  local r = ambit.roots { f, box = { x = { -1, 2 }, y = { -1, 2 } } }
  for _, list in ipairs { r.proved, r.partly, r.undecided } do
    for _, point in ipairs(list) do
      if point.x:contains(c) and point.y:contains(c) then return true end
    end
  end
  return false
end

describe("where there is no derivative", function()
  it("roots are listed", function()
    for _, c in ipairs { -1, 0, 0.5, 2 } do -- within the box, and at its ends
      for name, f in pairs {
        root = function(u) return sqrt(u) end, ["other root"] = function(u) return sqrt(-u) end,
        magnitude = function(u) return sqrt(u ^ 2) end, product = function(u) return u * sqrt(u) end,
        arc = function(u) return ambit.acos(1 - u ^ 2 / 8) end,
        ["arc of root"] = function(u) return ambit.asin(sqrt(u / 4)) end,
        distance = function(u, v) return sqrt(u ^ 2 + v ^ 2) end, isolated = function(u) return sqrt(-sqrt(u ^ 2)) end,
        uncertain = function(u) return ambit.between(1, 2) * sqrt(u) end,
      } do
        assert.is_true(is_listed(function(s) return { f(s.x - c, s.y - c), s.x - s.y } end, c), name)
        assert.is_true(is_listed(function(s) return { s.x - c, s.y - c, f(s.x - c, s.y - c) } end, c), name)
      end
    end
  end)

  it("least distances are not overlooked", function()
    local cos, sin = ambit.cos(ambit.number(1)), ambit.sin(ambit.number(1))
    for _, solver in ipairs(solvers) do
      local far = ambit.verify { turn, solver = solver, initial = { x = 1, y = 0 }, t = 2,
        safe = function(s) return 1e-6 - sqrt((s.x - cos) ^ 2 + (s.y - sin) ^ 2) end }
      assert.equal("refuted", far.status)
      for _, size in ipairs { abs, function(x) return sqrt(x ^ 2) end } do
        assert.equal("refuted", ambit.verify { line, solver = solver, initial = { x = 1 }, t = 2,
          safe = function(s) return 1e-6 - size(s.x) end }.status)
        assert.is_not.equal("refuted", ambit.verify { line, solver = solver, initial = { x = 1 }, t = 2,
          reach = function(s) return size(s.x) end }.status)
      end
    end
  end)

  it("a condition that is not defined proves and refutes nothing", function()
    for _, solver in ipairs(solvers) do
      local function status(kind, g)
        return ambit.verify { line, solver = solver, initial = { x = 1 }, t = 2, [kind] = g }.status
      end
      for _, g in ipairs { function(s) return -sqrt(s.x) end, function(s) return ambit.log(s.x) - 5 end,
        function(s) return -1 / s.x ^ 2 end, function(s) return -sqrt(s.x) * s.x end } do
        assert.equal("undecided", status("safe", g))
      end
      assert.equal("undecided", status("at_end", function(s) return -sqrt(s.x) end))
      assert.equal("undecided", status("reach", function(s) return sqrt(s.x) + "0.001" end))
      assert.equal("proved", status("reach", function(s) return sqrt(s.x) - "0.1" end))
      assert.equal("refuted", status("safe", function(s) return sqrt(s.x) - "0.9" end))
    end
  end)

  it("solutions that are not unique are enclosed, or none is", function() -- x' = sqrt |x| from 0: 0 and t^2 / 4
    for _, solver in ipairs(solvers) do
      local good, run = pcall(ambit.simulate, { t = { 0, 1 }, initial = { x = 0 }, solver = solver,
        ambit.ode { states = { "x" }, equations = function(s) return { x = sqrt(abs(s.x)) } end } })
      if good and run.t_reached > 0 then
        assert.is_true(run.x.x:contains(0) and run.x.x:contains(run.t_reached ^ 2 / 4))
      end
    end
  end)

  it("ranges are whole", function()
    local x, y = ambit.between(-1, 2), ambit.between(0, 1)
    local formulas = { abs(x), sqrt(y), sqrt(x ^ 2 + y ^ 2), sqrt(y) - y, abs(x) - x / 2, sqrt(x) - x, ambit.min(x, y),
      ambit.acos(1 - x ^ 2 / 4), 1 / x + y }
    local ranges = { { 0, 2 }, { 0, 1 }, { 0, math.sqrt(5) }, { 0, 0.25 }, { 0, 1.5 }, { math.sqrt(2) - 2, 0.25 },
      { -1, 1 }, { 0, math.pi / 2 }, { -1e300, 1e300 } }
    for _, arithmetic in ipairs { "interval", "gradient", "affine", "taylor_model", "mpfr" } do
      for i, found in ipairs(ambit.evaluate { formulas, arithmetic = arithmetic }) do
        assert.is_true(found.lo <= ranges[i][1] + 1e-15 and found.hi >= ranges[i][2] - 1e-15,
          ("%s, formula %d: %s"):format(arithmetic, i, tostring(found)))
      end
    end
  end)
end)
