-- What happens where the solver that suits best fails, and who may be chosen at all.
local ambit = require "ambit"
local core = require "ambit.core"
local suggest = require "ambit.simulate.suggest"

local function chain(n, tolerance)
  local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
  local at, initial = m.world, {}
  for i = 1, n do
    at = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" .. i }, offset = { 1, 0, 0 } }
    m:point_mass { at = at, mass = 1 }
    initial["q" .. i] = ambit.around(1, tolerance)
    initial["q" .. i .. "'"] = ambit.around("0.5", tolerance)
  end
  return m:dynamics(), initial
end

-- What suits may change; here lohner is asked first, then zonotope.
local function with_lohner_first(question, other)
  local own = suggest.solver
  suggest.solver = function() -- luacheck: ignore
    local next_one = { solver = other or "zonotope", reason = "next", score = 1 }
    return { solver = "lohner", reason = "first here", others = { next_one } }
  end
  local good, run = pcall(ambit.simulate, question)
  suggest.solver = own
  assert(good, run)
  return run
end

local function hull(question)
  question.n = 100
  return ambit.sample(question)
end

describe("a run of the solver that suits", function()
  it("is done again by another where it gets too wide, and says so", function()
    local system, initial = chain(2, "0.1%")
    local first = ambit.simulate { system, initial = initial, t = { 0, 1 }, solver = "lohner" }
    local run = with_lohner_first { system, initial = initial, t = { 0, 1 } }
    assert.equal("complete", run.status)
    assert.is_true(#run.tried == 2 and run.tried[1].solver == "lohner")
    assert.matches("times as wide as sampled", run.tried[1].outcome)
    assert.equal(run.tried[#run.tried].solver, run.solver)
    assert.is_true(first.overestimate > 2 and run.overestimate < 1.5, first.overestimate)
    local seen = hull { system, initial = initial, t = { 0, 1 } }
    local factor = run:overestimation(seen)
    assert.is_nil(factor.contradiction)
    assert.is_true(factor.max["q2'"] < 1.5)
  end)

  it("is done again by another where it ends", function()
    local system, initial = chain(2, "0.1%")
    local alone = ambit.simulate { system, initial = initial, t = { 0, 2 }, solver = "lohner" }
    assert.equal("unable", alone.status)
    local run = with_lohner_first { system, initial = initial, t = { 0, 2 } }
    assert.equal("complete", run.status)
    assert.same({ { solver = "zonotope", t_from = 0, t = 2 } }, run.parts)
  end)

  it("is gone on from where it ended with a tight set", function()
    local system, initial = chain(2, "0.1%")
    local simulate = core.simulate
    core.simulate = function(flow, ...) -- luacheck: ignore
      if flow.solver == "lohner" then flow.times = { 0, 0.25 } end
      local track, facts, report = simulate(flow, ...)
      if flow.solver == "lohner" then facts.status, facts.code, facts.reason = "unable", "unable.step", "made to" end
      return track, facts, report
    end
    local good, run = pcall(with_lohner_first, { system, initial = initial, t = { 0, 0.5, 1 }, dense = true })
    core.simulate = simulate
    assert(good, run)
    assert.equal("complete", run.status)
    assert.same({ { solver = "lohner", t_from = 0, t = 0.25 }, { solver = "zonotope", t_from = 0.25, t = 1 } }, run.parts)
    local whole = ambit.simulate { system, initial = initial, t = { 0, 0.5, 1 }, solver = "zonotope", dense = true }
    assert.is_nil(run:overestimation(hull { system, initial = initial, t = { 0, 0.5, 1 } }).contradiction)
    for _, t in ipairs { 0, 0.1, 0.25, 0.5, 0.7, 1 } do -- dense on both sides of the seam
      local inside, outer = whole:at(t).q1, run:at(t).q1
      assert.is_true(outer.lo <= inside.hi and inside.lo <= outer.hi and outer:width() < 2 * inside:width(), t)
    end
    local set = ambit.evaluate { { run:set().q1 }, arithmetic = "interval" }[1]
    assert.is_true(set:width() < 2 * whole.x.q1:width())
    assert.is_false(set:intersect(whole.x.q1):is_empty()) -- the set at the end, not that at the seam
    local further = { system, initial = run:set(), t = { 1, 1.25 }, solver = "zonotope" }
    local direct = ambit.simulate { system, initial = initial, t = { 0, 1.25 }, solver = "zonotope" }
    assert.is_false(ambit.simulate(further).x.q1:intersect(direct.x.q1):is_empty())
    assert.is_true(run.overestimate == nil or run.overestimate > 0.99)
  end)

  it("stays as it was where another solver gains next to nothing", function()
    local o = ambit.ode { states = { "y", "z" }, equations = function(s)
      return { y = -ambit.number(1), z = ambit.sqrt(s.y) }
    end }
    local run = ambit.simulate { o, initial = { y = ambit.around(1, "1%"), z = 0 }, t = { 0, 1 } }
    assert.equal("unable", run.status)
    assert.is_true(run.x.y.hi >= 1.01 - run.t_reached and run.x.y.lo <= 0.99 - run.t_reached)
    local last
    for step in run:steps() do last = step.t end
    assert.equal(run.t_reached, last)
  end)

  it("stays as it is where it is tight, and nothing is drawn", function()
    local drawn, own = 0, core.sample_system
    core.sample_system = function(...) -- luacheck: ignore
      drawn = drawn + 1
      return own(...)
    end
    local o = ambit.ode { states = { "x", "v" }, equations = function(s) return { s.v, -s.x } end }
    local run = ambit.simulate { o, initial = { ambit.around(1, "1%"), ambit.around(0, "0.01") }, t = { 0, 10 } }
    core.sample_system = own
    assert.equal(0, drawn)
    assert.is_nil(run.tried)
    assert.same({ { solver = run.solver, t_from = 0, t = 10 } }, run.parts)
    assert.is_true(run.overestimate >= 1 - 1e-3 and run.overestimate < 1.1, run.overestimate)
  end)

  it("that has no uncertain data has nothing to be held against", function()
    local o = ambit.ode { states = { "x" }, equations = function(s) return { -s.x } end }
    assert.is_nil(ambit.simulate { o, initial = { 1 }, t = 1 }.overestimate)
  end)

  it("ends where the solution does, and nobody else is asked", function()
    local o = ambit.ode { states = { "x" }, equations = function(s) return { s.x ^ 2 } end }
    local run = ambit.simulate { o, initial = { ambit.around(1, "1%") }, t = 3 }
    assert.equal("unable", run.status)
    assert.is_true(run.t_reached < 1 / 0.99)
    assert.is_nil(run.tried)
  end)

  it("says that solutions may escape only where ordinary runs end there, too", function()
    local function reason_of(rate, x0, t)
      local system = ambit.ode { states = { "x" }, equations = function(s, _, time) return { x = rate(s.x, time) } end }
      local run = ambit.simulate { system, initial = { x = x0 }, t = t }
      assert.equal("unable", run.status)
      return run.reason
    end
    for _, x0 in ipairs { ambit.number(1), ambit.around(1, "1%") } do
      assert.matches("before t = 1%.0%d+ s, too: there solutions may escape",
        reason_of(function(x) return x ^ 2 end, x0, { 0, 2 }))
    end
    assert.matches("before t = 0%.7 s, too", reason_of(function(x) return -1 / ambit.sqrt(x) end, 1, { 0, 2 }))
    -- some of the starts escape, most do not: x = x0 / (x0 + (1 - x0) e^t)
    local some = reason_of(function(x) return x * (x - 1) end, ambit.between("0.5", "1.01"), { 0, 10 })
    assert.is_nil(some:find "escape", some)
  end)

  it("that nobody completes says who was tried, and which narrower data would do", function()
    local system, initial = chain(2, "1%")
    local run = with_lohner_first({ system, initial = initial, t = { 0, 1.6 } }, "valencia")
    assert.equal("unable", run.status)
    assert.matches("tried besides: `", run.reason)
    local part = run.reason:match "with data (.-) as wide, `lohner` completes"
    local percent = ({ half = "0.5%", ["a quarter"] = "0.25%", ["a tenth"] = "0.1%", ["a hundredth"] = "0.01%" })[part]
    assert.truthy(percent, run.reason)
    system, initial = chain(2, percent)
    local narrow = ambit.simulate { system, initial = initial, t = { 0, 1.6 }, solver = "lohner" }
    assert.equal("complete", narrow.status) -- the advice is true
  end)

  it("that nobody completes says which datum the width came from, and with how much of it the run completes", function()
    local function question(tolerance)
      local system, initial = chain(2, "1e-7%")
      initial.q1 = ambit.around(1, tolerance, "tilt")
      return { system, initial = initial, t = { 0, 2.4 } }
    end
    local run = with_lohner_first(question "4%", "valencia")
    assert.equal("unable", run.status)
    local from = run.width_from
    assert.equal("tilt", from and from.shares[1].datum, run.reason)
    assert.is_true(from.shares[1].share > 0.9 and from.shares[2].share < 0.1)
    assert.is_true(from.factor > 1)
    assert.matches("`tilt` %(%+%-4 %%%) makes %d+ %% of that width", run.reason)
    local percent = run.reason:match "with `tilt` %+%-([%d.e-]+) %%, `lohner` completes"
    assert.is_truthy(percent, run.reason)
    assert.is_true(tonumber(percent) < 4)
    local narrow = question(percent .. "%")
    narrow.solver = "lohner"
    assert.equal("complete", ambit.simulate(narrow).status) -- the advice is true
  end)

  it("leaves no records of tries that were not taken", function()
    local function lines(scene)
      local path, out = os.tmpname(), os.tmpname()
      local file <close> = assert(io.open(path, "w"))
      file:write('local ambit = require "ambit"\n', scene)
      file:flush()
      os.execute(("'%s' run --json %s %s >%s.text 2>&1"):format(os.getenv "AMBIT_COMMAND", out, path, out))
      local list = {}
      for line in io.lines(out) do list[#list + 1] = line end
      for _, name in ipairs { path, out, out .. ".text" } do os.remove(name) end
      return list
    end
    local list, last, steps = lines [[
      local o = ambit.ode { states = { "y", "z" }, equations = function(s)
        return { y = -ambit.number(1), z = ambit.sqrt(s.y) }
      end }
      local run = ambit.simulate { o, initial = { y = ambit.around(1, "1%"), z = 0 }, t = { 0, 1 } }
      print(#run.tried)]], 0, 0
    for _, line in ipairs(list) do
      assert.is_nil(line:find('"nil"', 1, true), line)
      if line:find('"record":"way_back"', 1, true) then last = tonumber(line:match '"t":([^,]+)') end
      local t = line:find('"record":"step"', 1, true) and tonumber(line:match '"t":%[([^,]+)')
      if t then
        assert.is_true(t >= last, line)
        last, steps = t, steps + 1
      end
    end
    assert.is_true(steps > 0)
  end)

  it("has one budget of CPU time for all that follows the first run", function()
    local system, initial = chain(2, "1%")
    local clock, asked, cpu, simulate, own = 0, {}, core.cpu, core.simulate, suggest.solver
    core.cpu = function() return clock end -- luacheck: ignore
    core.simulate = function(flow, ...) -- luacheck: ignore
      local solver = flow.solver
      asked[#asked + 1] = solver
      local track, facts, report = simulate(flow, ...)
      clock = clock + 3 -- s: the first run took three, so that others have six
      if solver == "valencia" then clock = clock + 10 end
      facts.status, facts.code, facts.reason, facts.t_reached = "unable", "unable.step", "made to", 0
      return track, facts, report
    end
    suggest.solver = function() -- luacheck: ignore
      return { solver = "lohner", reason = "first here", others = { { solver = "valencia", reason = "", score = 1 },
        { solver = "taylor_model", reason = "", score = 1 }, { solver = "zonotope", reason = "", score = 1 } } }
    end
    local good, run = pcall(ambit.simulate, { system, initial = initial, t = { 0, 0.1 } })
    core.cpu, core.simulate, suggest.solver = cpu, simulate, own
    assert(good, run)
    assert.same({ "lohner", "valencia", "lohner" }, asked) -- the third in parts, for which half of it is kept
    assert.matches("not tried, since the CPU time for this was spent: `taylor_model`, `zonotope`", run.reason)
  end)

  it("counts the work of the parts of a run that came to the end and was too wide", function()
    local system, initial = chain(2, "0.1%")
    local work, simulate = nil, core.simulate
    core.simulate = function(flow, watch, options) -- luacheck: ignore
      work = options.band_work or work
      local track, facts, report = simulate(flow, watch, options)
      if not work then report.operations = flow.solver == "lohner" and 1e8 or 1 end
      if flow.solver == "valencia" then facts.status, facts.code, facts.t_reached = "unable", "unable.step", 0 end
      return track, facts, report
    end
    local good, run = pcall(with_lohner_first, { system, initial = initial, t = { 0, 1 } }, "valencia")
    core.simulate = simulate
    assert(good, run)
    assert.equal(24 * 1e8, work)
    assert.equal("complete", run.status)
    assert.is_true(run.overestimate <= 1.5, run.overestimate) -- whole more than 2
    assert.is_true(run.pieces > 1 and run.pieces < 200)
    assert.equal(run.pieces, run.tried[#run.tried].pieces)
  end)

  it("goes on with the first, as long as it is steady, where that was slow and nobody got further", function()
    local system, initial = chain(2, "1%")
    local asked, reach, simulate = {}, {}, core.simulate
    core.simulate = function(flow, watch, options) -- luacheck: ignore
      local n = #asked + 1
      asked[n], reach[n] = flow.solver, options.reach
      if n == 1 then flow.times = { 0, 0.01 } end
      local track, facts, report = simulate(flow, watch, options)
      if n == 1 then
        facts.status, facts.code, facts.reason, facts.cpu_seconds = "unable", "unable.short-steps", "made to", 60
      end
      if flow.solver == "valencia" or options.pieces then
        facts.status, facts.code, facts.reason, facts.t_reached = "unable", "unable.step", "made to", 0
      end
      return track, facts, report
    end
    local good, run = pcall(with_lohner_first, { system, initial = initial, t = { 0, 0.1 } }, "valencia")
    core.simulate = simulate
    assert(good, run)
    assert.same({ "lohner", "valencia", "lohner", "lohner" }, asked) -- the third in parts
    assert.equal(math.huge, reach[4])
    assert.equal("complete", run.status)
    assert.equal(4, #run.tried)
  end)

  it("keeps its events when another goes on", function()
    local system, initial = chain(2, "0.1%")
    local run = with_lohner_first { system, initial = initial, t = { 0, 2 },
      events = { { name = "low", g = function(s) return s.q1 end } } }
    assert.equal("complete", run.status)
    assert.equal("zonotope", run.solver)
    assert.is_true(#run.events >= 1 and run.events[1].name == "low")
  end)
end)

describe("verify", function()
  it("asks another solver where the first is open, and ends one that makes no way", function()
    local o = ambit.ode { states = { "x", "v" }, equations = function(s) return { s.v, -s.x - s.v / 10 } end }
    local asked, watch, own = {}, core.watch, suggest.solver
    core.watch = function(flow, settings) -- luacheck: ignore
      local findings, outcome, report = watch(flow, settings)
      local solver = flow.solver
      assert.equal(2, settings.patience)
      if solver == "taylor_model" then outcome.status = "unable" findings[1].holds = false findings[1].hi = math.huge end
      asked[#asked + 1] = solver
      return findings, outcome, report
    end
    suggest.solver = function() -- luacheck: ignore
      return { solver = "taylor_model", reason = "first", others = { { solver = "zonotope", reason = "next", score = 1 } } }
    end
    local good, report = pcall(ambit.verify, { o, initial = { ambit.around(1, "1%"), 0 }, t = { 0, 3 },
      safe = function(s) return s.x - "1.02" end })
    core.watch, suggest.solver = watch, own
    assert(good, report)
    assert.equal("proved", report.status)
    assert.equal("zonotope", asked[#asked])
    assert.equal("taylor_model", asked[1])
  end)
end)
