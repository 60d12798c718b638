-- Events of ambit.simulate: where g crosses zero, proved; closed forms tell where that is.
local ambit = require "ambit"

local oscillator = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }

local ball = ambit.ode {
  states = { "y", "v" }, parameters = { g = 10 },
  equations = function(s, p) return { y = s.v, v = -p.g } end,
}

local function swing(events, more)
  local t = { oscillator, initial = { x = 1, v = 0 }, t = { 0, 10 }, events = events }
  for key, value in pairs(more or {}) do t[key] = value end
  return ambit.simulate(t)
end

local function refused(part, t)
  local good, message = pcall(ambit.simulate, t)
  assert.is_false(good)
  assert.is_truthy(message:find(part, 1, true), ("%q expected, got: %s"):format(part, message))
end

local function x_is(value) return function(s) return s.x - value end end

-- K(k) by the arithmetic-geometric mean
local function complete_elliptic(k)
  local a, b = 1, math.sqrt(1 - k * k)
  for _ = 1, 40 do a, b = (a + b) / 2, math.sqrt(a * b) end
  return math.pi / (2 * a)
end

describe("events", function()
  it("are the zeros of cos t, in the order of time", function()
    local run = swing { { g = x_is(0), name = "middle" }, { g = function(s) return s.v end, direction = "rising" } }
    assert.equal("complete", run.status)
    local expected = {
      { 1, "middle", "falling" }, { 2, "2", "rising" }, { 3, "middle", "rising" }, { 5, "middle", "falling" },
      { 6, "2", "rising" },
    }
    assert.equal(#expected, #run.events)
    for i, e in ipairs(run.events) do
      local t = expected[i][1] * math.pi / 2
      assert.is_true(e.t.lo <= t + 1e-15 and t - 1e-15 <= e.t.hi)
      assert.is_true(e.t:width() < 1e-12)
      assert.is_true(e.x.x:contains(math.cos(t)) or math.abs(math.cos(t)) < 1e-15)
      assert.equal(expected[i][2], e.name)
      assert.equal(expected[i][3], e.direction)
      assert.is_true(e.certain)
      assert.is_nil(e.reason)
    end
  end)

  it("leave the steps alone", function()
    local plain, watched = swing(nil), swing { { g = x_is(0) } }
    assert.equal(plain.step_count, watched.step_count)
    assert.equal(plain.x.x, watched.x.x)
    local n = 0
    for _ in watched:steps() do n = n + 1 end
    assert.equal(n, watched.step_count)
    assert.is_nil(plain.events)
  end)

  it("enclose what every member of a set does", function()
    local run = ambit.simulate {
      ball, initial = { y = ambit.between("0.9", "1.1"), v = ambit.between("-0.1", "0.1") }, t = { 0, 2 },
      events = { { g = function(s) return s.y end, name = "impact", direction = "falling", stop = true } },
    }
    assert.equal("complete", run.status)
    assert.equal("impact", run.ended_by)
    local e = run.events[1]
    for i = 0, 10 do
      for k = 0, 10 do
        local y, v = 0.9 + 0.02 * i, -0.1 + 0.02 * k
        local speed = math.sqrt(v * v + 20 * y)
        assert.is_true(e.t.lo <= (v + speed) / 10 + 1e-12 and (v + speed) / 10 - 1e-12 <= e.t.hi)
        assert.is_true(e.x.v.lo <= -speed + 1e-12 and -speed - 1e-12 <= e.x.v.hi)
      end
    end
    assert.is_false(e.t:contains((0.1 + math.sqrt(0.01 + 20 * 1.2)) / 10)) -- of a ball that is not in the set
    assert.is_true(e.t:width() < 0.1)
  end)

  it("may depend on time and parameters", function()
    local run = ambit.simulate {
      ball, initial = { y = 0, v = 10 }, t = { 0, 1 },
      events = { { g = function(s, p, t) return s.v - p.g * t end, name = "half" } }, -- 10 - 20 t
    }
    assert.is_true(run.events[1].t:contains(0.5))
    assert.is_true(run.events[1].t:width() < 1e-13)
  end)

  it("may be what is measured on a mechanism", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "phi" }, offset = { 0, -1, 0 } }
    m:point_mass { at = tip, mass = 1 }
    local run = ambit.simulate {
      m:dynamics(), initial = { phi = 1, ["phi'"] = 0 }, t = { 0, 1 }, tolerance = 1e-12,
      events = { { g = m:position(tip).x, name = "lowest" } },
    }
    local quarter = complete_elliptic(math.sin(0.5)) / math.sqrt(9.81)
    assert.equal(1, #run.events)
    assert.is_true(run.events[1].t.lo <= quarter + 1e-14 and quarter - 1e-14 <= run.events[1].t.hi)
    assert.is_true(run.events[1].t:width() < 1e-8)
  end)

  it("say so where a solution only grazes", function()
    local run = swing { { g = x_is(-1), name = "apex" }, { g = x_is(1.000001) } }
    assert.equal("partial", run.status)
    assert.equal("unable.partial", run.code)
    assert.is_true(#run.events >= 1)
    for _, e in ipairs(run.events) do
      assert.equal("apex", e.name)
      assert.is_false(e.certain)
      assert.is_truthy(e.reason:find "graze")
    end
    assert.is_true(run.events[1].t:contains(math.pi))
    local stopped = swing { { g = x_is(-1), name = "apex", stop = true } }
    assert.equal("unable", stopped.status)
    assert.is_truthy(stopped.reason:find "event `apex` in t = .*graze")
  end)

  it("are not lost where g has no derivative", function()
    local line = ambit.ode { states = { "x" }, equations = function() return { x = -1 } end }
    for _, case in ipairs {
      { "graze", function(s) return s.x ^ 2 end }, { "graze", function(s) return ambit.sqrt(s.x ^ 2) end },
      { "graze", function(s) return ambit.abs(s.x) end }, { "leave its domain", function(s) return ambit.sqrt(s.x) end },
      { "leave its domain", function(s) return s.x * ambit.sqrt(s.x) end },
      { "leave its domain", function(s) return ambit.abs(s.x) ^ "1/3" end },
      { "more than once", function(s) return ambit.min(s.x, 2 * s.x) end },
    } do
      for _, solver in ipairs { "lohner", "taylor_model", "stiff", "valencia" } do
        local q = { line, initial = { x = 1 }, t = { 0, 2 }, solver = solver, events = { { g = case[2], stop = true } } }
        local run = ambit.simulate(q)
        assert.equal("unable", run.status)
        assert.is_truthy(run.reason:find(case[1], 1, true), run.reason)
        assert.equal(1, #run.events)
        assert.is_true(run.events[1].t:contains(1))
        q.events[1].stop = false
        assert.equal("partial", ambit.simulate(q).status)
        assert.is_false(ambit.simulate(q).events[1].certain)
      end
    end
  end)

  it("see a tip that runs through a post", function()
    local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
    local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "phi" }, offset = { 0, -1, 0 } }
    local post = m:rigid_link { from = m.world, offset = { 0, -1, 0 } }
    m:point_mass { at = tip, mass = 1 }
    local run = ambit.simulate {
      m:dynamics(), initial = { phi = 1, ["phi'"] = 0 }, t = { 0, 1 }, tolerance = 1e-12,
      events = { { g = m:distance(tip, post), name = "hit", stop = true } },
    }
    local quarter = complete_elliptic(math.sin(0.5)) / math.sqrt(9.81)
    assert.equal("unable", run.status)
    assert.is_true(run.events[1].t.lo <= quarter and quarter <= run.events[1].t.hi)
    local near = ambit.simulate {
      m:dynamics(), initial = { phi = 1, ["phi'"] = 0 }, t = { 0, 1 }, tolerance = 1e-12,
      events = { { g = m:distance(tip, post) - "0.1", name = "near", stop = true } },
    }
    assert.equal("near", near.ended_by)
    assert.is_true(near.events[1].certain)
  end)

  it("may have kinks elsewhere", function()
    local run = swing { { g = function(s) return ambit.abs(s.x) - 0.5 end } }
    assert.equal(6, #run.events)
    for i, e in ipairs(run.events) do
      local third = (i % 2 == 1 and i // 2 + 1 / 3 or i // 2 - 1 / 3) * math.pi
      assert.is_true(e.certain)
      assert.is_true(e.t.lo <= third + 1e-14 and third - 1e-14 <= e.t.hi)
    end
  end)

  it("say so where only a part of the set crosses", function()
    local run = swing({ { g = x_is(0.9), stop = true } }, { initial = { x = ambit.between("0.8", 1), v = 0 } })
    assert.equal("unable", run.status)
    assert.is_truthy(run.reason:find "touches g = 0 at the start")
    local ends = swing({ { g = x_is(0.5) } }, { initial = { x = ambit.between("0.8", 1), v = 0 }, t = { 0, 1 } })
    assert.is_false(ends.events[1].certain)
    assert.is_truthy(ends.events[1].reason:find "when the run ended")
  end)

  it("run backwards, too", function()
    local run = swing({ { g = x_is(0) } }, { t = { 0, -10 } })
    assert.equal(3, #run.events)
    for i, direction in ipairs { "rising", "falling", "rising" } do
      local t = -(2 * i - 1) * math.pi / 2
      assert.is_true(run.events[i].t.lo <= t + 1e-15 and t - 1e-15 <= run.events[i].t.hi)
      assert.equal(direction, run.events[i].direction)
    end
  end)

  it("are not certain if the solver proves nothing", function()
    local run = swing({ { g = x_is(0) } }, { solver = "gsl" })
    assert.equal(3, #run.events)
    for i, e in ipairs(run.events) do
      assert.is_false(e.certain)
      assert.is_true(math.abs(e.t:mid() - (2 * i - 1) * math.pi / 2) < 0.5)
    end
  end)

  it("are written as records, in front of the step that they are in", function()
    local name = os.tmpname()
    local file = assert(io.open(name, "w"))
    file:write [[
      local ambit = require "ambit"
      local line = ambit.ode { states = { "x" }, equations = { x = 1 } }
      ambit.simulate { line, initial = { x = ambit.between(0, "0.125") }, t = { 0, 1, 2 },
        events = { { g = function(s) return s.x - 0.5 end }, { g = function(s) return s.x - 2 end } } }
    ]]
    file:close()
    local pipe = assert(io.popen(("%s run --json - %s"):format(os.getenv "AMBIT_COMMAND" or "ambit", name)))
    local kinds, text = {}, pipe:read "a"
    pipe:close()
    os.remove(name)
    for kind in text:gmatch '"record":"(%a+)"' do
      if kind ~= "provenance" and kind ~= "plugin" then kinds[#kinds + 1] = kind end
    end
    assert.same({ "event", "step", "step", "event", "result", "end" }, kinds)
    assert.is_truthy(text:find '"event":1,"x":{"x":%[0.5,0.5%]},"rigorous":true')
    assert.is_truthy(text:find '"event":2,"x":{"x":%[2,2%]},"rigorous":false') -- the run ends before all are there
  end)

  it("refuse what they cannot use", function()
    local function with(events) return { oscillator, initial = { x = 1, v = 0 }, t = { 0, 1 }, events = events } end
    refused("simulate: events: expected a table", with(1))
    refused("events[1]: expected a table", with { 1 })
    refused("events[1].g: expected a formula", with { {} })
    refused("did you mean `direction`", with { { g = x_is(0), directon = "rising" } })
    refused("expected rising, falling or both, got up", with { { g = x_is(0), direction = "up" } })
    refused("events[1].stop: expected true or false", with { { g = x_is(0), stop = 1 } })
    refused("two are called `a`", with { { g = x_is(0), name = "a" }, { g = x_is(1), name = "a" } })
    refused("there is no `z`", with { { g = function(s) return s.z end } })
    local other = ambit.ode { states = { "q" }, equations = function(s) return { q = s.q } end }
    refused("g depends on `q`", with { { g = other.symbols[1] } })
  end)
end)

describe("events of sets that are split", function()
  it("are located in short tubes, since many pieces have no dense enclosure", function()
    local arm = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
    local joint, shoulder = arm:revolute { from = arm.world, axis = "z", name = "upper" }
    local tip = arm:rigid_link { from = joint, offset = { ambit.around(1, "1%"), 0, 0 } }
    arm:point_mass { at = tip, mass = ambit.between(1, 2) }
    arm:joint_damper { joint = shoulder, damping = "0.5" }
    local start = { upper = ambit.degrees(ambit.around(-60, 1)), ["upper'"] = 0 }
    local run = ambit.simulate { arm:dynamics(), initial = start,
      t = 2, solver = "taylor_model", events = { { g = arm:position(tip).x, direction = "falling" } } }
    assert.equal(1, #run.events)
    assert.is_true(run.events[1].certain)
    assert.is_true(run.events[1].t:width() < 0.05)
  end)
end)
