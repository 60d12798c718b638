-- A plain interval in equations would silently be one unknown constant: it is refused, with the words for what may have
-- been meant. Where a set is given as a datum, it is one.
local ambit = require "ambit"
local session = require "ambit.session"

local interval = ambit.interval

local function refused(f, part)
  local good, message = pcall(f)
  assert.is_false(good)
  for _, text in ipairs { part, "ambit.between", "ambit.varying" } do
    message = tostring(message)
    if not message:find(text, 1, true) then error(("expected %q in %s"):format(text, message), 2) end
  end
end

local function oscillator(force)
  return function()
    return (ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x + force } end })
  end
end

local function slider()
  local m = ambit.mechanism "slider"
  local at = m:prismatic { from = m.world, axis = "x", name = "q" }
  m:point_mass { at = at, mass = 1 }
  return m, at
end

describe("a plain interval", function()
  it("is refused in the right-hand side of an ode", function()
    refused(oscillator(interval(-1, 1)), "derivative of v: the plain interval [-1, 1]")
    local function of(equations)
      return function() return (ambit.ode { states = { "x" }, equations = equations }) end
    end
    refused(of(function() return { interval(0, 1) } end), "derivative of x")
    refused(of { x = function(s) return 2 * (interval(0, 1) * s.x) end }, "derivative of x")
  end)

  it("is refused as text, too", function()
    refused(oscillator "[-1, 1]", "[-1, 1]")
    refused(oscillator "0?1", "[-1, 1]")
    refused(oscillator "[-1, 1] m/s^2", "[-1, 1]")
  end)

  it("names the line that wrote it", function()
    refused(oscillator(interval(-1, 1)), "plain_interval_spec.lua:")
  end)

  it("is refused where it was computed", function()
    refused(oscillator(ambit.evaluate { ambit.between(0, 1) * 2 }), "[0, 2]")
  end)

  it("is refused in force laws and in formulas of parameters", function()
    refused(function()
      local m, at = slider()
      m:applied_force { at = at, force = function() return { interval(-1, 1), 0, 0 } end }
    end, "applied_force: force")
    refused(function()
      local m, at = slider()
      m:applied_force { at = at, force = { m:position(at).x * interval(-1, 1), 0, 0 } }
    end, "applied_force: force")
  end)

  it("is refused in events, resets and conditions", function()
    local f = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }
    refused(function()
      ambit.simulate { f, initial = { 0 }, t = { 0, 1 },
        events = { { g = function(s) return s.x - interval(0, 1) end } } }
    end, "events[1].g")
    refused(function()
      ambit.hybrid { modes = { a = { f, guards = { { g = function(s) return s.x - 1 end, to = "a",
        reset = function(s) return { x = interval(0, 1) * s.x } end } } } }, initial = { 0 }, t = { 0, 2 },
        start = "a" }
    end, "reset: x")
    refused(function()
      ambit.verify { f, initial = { 0 }, t = { 0, 1 }, safe = function(s) return s.x - interval(1, 2) end }
    end, "verify: safe")
  end)

  it("is refused as an input of certify and reduce, and is a datum as a parameter", function()
    local f = ambit.ode { states = { "x", "y" }, parameters = { u = 0, k = 1 },
      equations = function(s, p) return { x = p.u - p.k * s.x - 0.001 * s.y, y = -s.y } end }
    local function ask(given, scenarios)
      return { f, f, t = { 0, "0.1" }, initial = { x = 0, y = 0 }, outputs = { "x" }, error = { x = 1 }, inputs = given,
        scenarios = scenarios, parameters = { k = interval(1, 2) } }
    end
    local function without_second(t)
      t[2] = nil
      return t
    end
    for _, value in ipairs { interval(-1, 1), "[-1, 1]" } do
      refused(function() ambit.certify(ask { u = value }) end, "certify: `u`: the plain interval")
      refused(function() ambit.certify(ask(nil, { { inputs = { u = value } } })) end, "certify: `u`: the plain")
      refused(function() ambit.reduce(without_second(ask { u = value })) end, "reduce: `u`: the plain interval")
    end
    refused(function() ambit.certify(ask { u = function(t) return t * interval(0, 1) end }) end, "certify: `u`")
    assert.equal("proved", ambit.certify(ask { u = ambit.between(-1, 1) }).status)
  end)

  it("is a datum as an initial value, as a parameter and as a value of a variable", function()
    local decay = ambit.ode { states = { "x" }, parameters = { k = interval(1, 2), c = "[0, 1]" },
      equations = function(s, p) return { x = p.c - p.k * s.x } end }
    local run = ambit.simulate { decay, initial = { x = interval(1, 2) }, t = { 0, 1 } }
    local again = ambit.simulate { decay, initial = { x = run.x.x }, t = { 1, 2 } }
    session.worst = "ok"
    assert.equal("complete", again.status)
    local m, at = slider()
    m:applied_force { at = at, force = { interval(-1, 1), 0, 0 } }
    assert.is_true(ambit.evaluate({ m:position(at).x, at = { q = interval(1, 2) } }):contains(1.5))
  end)

  it("of no width is a number", function()
    assert.equal("complete", ambit.simulate { oscillator(interval(1))(), initial = { 1, 0 }, t = { 0, 1 } }.status)
  end)

  it("may stand where nothing moves: in expressions and in roots", function()
    local x = ambit.between(0, 1)
    assert.is_true(ambit.evaluate({ x + interval(0, 1) }):contains(2))
  end)
end)
