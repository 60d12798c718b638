-- The verb compare over solvers: rows, errors, overestimation, grids, and that its checks can fail.
local ambit = require "ambit"
local agree = require "ambit.compare.agree"
local judge = require "ambit.compare.judge"
local advice = require "ambit.compare.advice"
local overestimation = require "ambit.compare.overestimation"
local solvers = require "ambit.compare.solvers"

local function fails(f, ...)
  local good, problem = pcall(f)
  assert.is_false(good, "no error was raised")
  problem = tostring(problem)
  assert.truthy(problem:find "compare_simulate_spec%.lua:%d+: ", problem)
  for _, text in ipairs { ... } do assert.truthy(problem:find(text, 1, true), problem) end
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
local growth = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x * s.x } end }
local one_over_e = "[0.36787944117144232, 0.36787944117144233]" -- exp(-1), to 17 digits

describe("compare over solvers", function()
  it("gives a row for each combination, as simulate finds it", function()
    local r = ambit.compare { decay, initial = { x = "[1, 2]" }, t = { 0, 1 }, repeats = 2,
      solvers = { "lohner", { "taylor_model", order = { 2, 4 } }, { "gsl", method = { "rk4", "rk8pd" } } } }
    assert.equal("complete", r.status)
    assert.equal("simulate", r.verb)
    local labels = {}
    for i, row in ipairs(r.rows) do
      labels[i] = row.label
      assert.equal("complete", row.status)
      assert.equal(1, row.t_reached)
      assert.is_true(row.seconds_run > 0 and row.steps > 0 and row.repeats == 2 and row.memory >= 0)
      assert.equal(row.track.t[1], 0)
      assert.equal(row.track.t[#row.track.t], 1)
    end
    assert.same({ "lohner", "taylor_model order=2", "taylor_model order=4", "gsl method=rk4", "gsl method=rk8pd" },
      labels)
    local run = ambit.simulate { decay, initial = { x = "[1, 2]" }, t = { 0, 1 }, solver = "lohner" }
    assert.equal(run.x.x, r.rows[1].values.x)
    assert.equal(run.x.x:width(), r.rows[1].width)
    assert.equal(run.step_count, r.rows[1].steps)
    assert.is_true(r.rows[1].width_max >= 1) -- the initial set
    assert.is_false(r.rows[4].rigorous)
  end)

  it("holds widths against samples and against the tightest", function()
    local r = ambit.compare { growth, initial = { x = "[0.5, 0.6]" }, t = { 0, 1 }, repeats = 1, n = 2000,
      solvers = { "taylor_model", { "valencia", tolerance = 1e-4 } } }
    local exact = 0.6 / (1 - 0.6) - 0.5 / (1 - 0.5) -- x0 / (1 - x0 t)
    local least = math.huge
    for _, row in ipairs(r.rows) do least = math.min(least, row.width) end
    for _, row in ipairs(r.rows) do
      assert.is_true(row.width >= exact)
      assert.is_true(row.over_sample >= 1 and row.over_sample_max >= row.over_sample)
      assert.is_true(math.abs(row.over_sample / (row.width / exact) - 1) < 1e-2)
      assert.equal(row.width / least, row.over_tightest)
    end
    assert.equal(2000, r.sample.draws)
  end)

  it("measures errors by a reference, and the tightest proof is one where all data are points", function()
    local truth = ambit.interval(one_over_e)
    local t = { decay, initial = { x = 1 }, t = { 0, 1 }, repeats = 1,
      solvers = { { "lohner", tolerance = { 1e-4, 1e-14 } }, { "gsl", relative = { 1e-5, 1e-12 } } } }
    local function check(r, room)
      for _, row in ipairs(r.rows) do
        local x = row.values.x
        local lo, hi = x.lo, x.hi
        if not row.rigorous then lo, hi = x:mid(), x:mid() end
        local error = math.max(hi - truth.lo, truth.hi - lo)
        assert.is_true(math.abs(row.error - error) <= room, row.label .. " " .. row.error .. " " .. error)
      end
      assert.equal("error", r.measure)
    end
    local r = ambit.compare(t)
    has(r.reference.source, "the tightest proof", "lohner tolerance=1e-14")
    check(r, 1e-14)
    t.reference = { t = 1, x = { x = one_over_e }, source = "exp(-1)" }
    r = ambit.compare(t)
    assert.equal("exp(-1)", r.reference.source)
    check(r, 1e-16)
    has(tostring(r), "error", "distances from exp(-1)")
  end)

  it("says what a reference is that proves nothing", function()
    local r = ambit.compare { decay, initial = { x = 1 }, t = { 0, 1 }, repeats = 1, solvers = { "gsl" } }
    has(r.reference.source, "not proved", "gsl")
    assert.equal("unable", r.status)
    has(r.reason, "no combination proved")
    assert.is_true(r.rows[1].error < 1e-9)
    assert.is_true(r.rows[1].pareto)
  end)

  it("notices an enclosure that misses the reference", function()
    local r = ambit.compare { decay, initial = { x = 1 }, t = { 0, 1 }, repeats = 1, solvers = { "lohner" },
      reference = { t = 1, x = { x = "0.36788" } } }
    assert.equal("broken", r.status)
    assert.equal("broken.contradiction", r.code)
    has(r.reason, "lohner misses the reference about x at t = 1")
  end)

  it("notices an enclosure that misses what was sampled", function()
    local function comparison(lo, hi)
      return { names = { "x" }, instants = { 0, 1 }, rows = { { label = "a", rigorous = true, status = "complete",
        width = hi - lo, widths = { x = hi - lo }, at = { [2] = { lo = { lo }, hi = { hi } } } } },
        sample = { t = { 0, 1 }, lo = { { 1, 2 } }, hi = { { 1, 3 } }, error = { { 0, 1e-3 } } } }
    end
    for _, good in ipairs { { 2, 3 }, { 2.005, 3 }, { 0, 10 } } do
      local c = comparison(table.unpack(good))
      overestimation.find(c)
      assert.is_nil(agree.contradiction(c))
      assert.equal(c.rows[1].width, c.rows[1].over_sample)
    end
    local c = comparison(2.02, 3)
    overestimation.find(c)
    has(agree.contradiction(c), "a misses sampled motions about x at t = 1")
  end)

  it("notices proofs that contradict each other", function()
    local function row(label, lo, hi, rigorous)
      return { label = label, rigorous = rigorous ~= false,
        at = { { lo = { 0 }, hi = { 1 } }, { lo = { lo }, hi = { hi } } } }
    end
    local comparison = { names = { "x" }, instants = { 0, 1 }, rows = { row("a", 1, 2), row("b", 2, 3) } }
    assert.is_nil(agree.contradiction(comparison))
    comparison.rows[3] = row("c", 2.5, 4, false)
    assert.is_nil(agree.contradiction(comparison))
    comparison.rows[3] = row("c", 2.5, 4)
    has(agree.contradiction(comparison), "a and c contradict each other about x at t = 1", "[2.5, 4]")
  end)

  it("says what to look at first, and gives no advice where proofs contradict each other", function()
    local rows = {}
    for i = 1, 4 do
      rows[i] = { label = "r" .. i, rigorous = true, status = "complete", width = 1 + 1e-3 * i, width_max = 1 + 0.1 * i,
        over_sample_max = 2 ^ i, seconds_run = 1 / i }
    end
    assert.equal("over_sample_max", judge.telling(rows, "width", { "width_max", "over_sample_max" }))
    assert.equal("width_max", judge.telling(rows, "width_max", { "over_sample_max" }))
    assert.equal("width", judge.telling(rows, "width", {}))
    local front = judge.front(rows, "width")
    has(advice.of({ measure = "width", rows = rows, status = "complete" }, front), "Use r4")
    has(advice.of({ measure = "width", rows = rows, status = "unable", contradicted = true }, front), "No advice")
  end)

  it("marks the Pareto front and says what to use", function()
    local rows, state = {}, 7
    local function random()
      state = state * 16807 % 2147483647
      return state / 2147483647
    end
    for i = 1, 60 do
      rows[i] = { label = "r" .. i, rigorous = i % 7 ~= 0, status = i % 5 == 0 and "unable" or "complete",
        width = 10 ^ (-9 * random()), seconds_run = 10 ^ (-4 * random()) }
    end
    local front = judge.front(rows, "width")
    assert.is_true(#front > 1)
    local counted = 0
    for _, row in ipairs(rows) do
      local best = row.rigorous and row.status == "complete"
      for _, other in ipairs(rows) do
        if other ~= row and other.rigorous and other.status == "complete" and other.width < row.width and
          other.seconds_run < row.seconds_run then best = false end
      end
      assert.equal(best, row.pareto == true)
      if best then counted = counted + 1 end
    end
    assert.equal(#front, counted)
    local text = advice.of({ measure = "width", rows = rows }, front)
    has(text, "For widths to ", front[1].label, front[#front].label, "the tightest")
    text = advice.of({ measure = "width", rows = rows }, { front[1] })
    has(text, "Use " .. front[1].label)
  end)

  it("says what came farthest where nothing reached the end", function()
    local r = ambit.compare { growth, initial = { x = 1 }, t = { 0, 2 }, repeats = 1, limit = 2,
      solvers = { "lohner", { "lohner", order = 5 } } }
    assert.equal("unable", r.status)
    for _, row in ipairs(r.rows) do
      assert.equal("unable", row.status)
      assert.is_true(row.t_reached > 0.5 and row.t_reached < 1)
      assert.truthy(row.reason)
    end
    has(r.advice, "Nothing reached the end", "lohner")
    has(tostring(r), "unable", "to t")
  end)

  it("takes runs without a single step", function()
    local r = ambit.compare { growth, initial = { x = 1 }, t = { 0, 2 }, repeats = 1,
      solvers = { { "lohner", step_min = 1.5 } } }
    assert.equal("unable", r.rows[1].status)
    assert.equal(0, r.rows[1].steps)
    assert.same({ 0 }, r.rows[1].track.t)
  end)

  it("keeps in a track what holds between its instants, too", function()
    local turn = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = -s.y, y = s.x } end }
    for _, till in ipairs { 3, -3 } do
      local r = ambit.compare { turn, initial = { x = 1, y = 0 }, t = { 0, till }, repeats = 1,
        solvers = { "lohner", "taylor_model", "valencia", "stiff", "gsl" } }
      for _, row in ipairs(r.rows) do
        local track = row.track
        for k = 1, #track.t - 1 do
          assert.equal(row.rigorous, track.tube.lo[1][k] == track.tube.lo[1][k])
          for j = 0, row.rigorous and 8 or -1 do
            local t = track.t[k] + (track.t[k + 1] - track.t[k]) * j / 8
            assert.is_true(track.tube.lo[1][k] <= math.cos(t) + 1e-15 and math.cos(t) - 1e-15 <= track.tube.hi[1][k])
            assert.is_true(track.tube.lo[2][k] <= math.sin(t) + 1e-15 and math.sin(t) - 1e-15 <= track.tube.hi[2][k])
          end
        end
        assert.equal(till, track.t[#track.t])
      end
    end
  end)

  it("thins long tracks and keeps the widest", function()
    local r = ambit.compare { decay, initial = { x = "[1, 2]" }, t = { 0, 1 }, repeats = 1,
      solvers = { { "gsl", step_max = 1e-3 }, { "lohner", step_max = 1e-3 } } }
    for _, row in ipairs(r.rows) do
      assert.is_true(row.steps >= 1000)
      assert.is_true(#row.track.t > 100 and #row.track.t <= 201, #row.track.t)
      assert.equal(1, row.track.t[#row.track.t])
    end
  end)

  it("takes events, and instants before the start", function()
    local r = ambit.compare { decay, initial = { x = 1 }, t = { 0, 3 }, repeats = 1,
      events = { { g = function(s) return s.x - "0.5" end, stop = true } },
      solvers = { "lohner", { "lohner", order = 8 } } }
    for _, row in ipairs(r.rows) do
      assert.equal("complete", row.status)
      local run = ambit.simulate { decay, initial = { x = 1 }, t = { 0, 3 }, solver = "lohner",
        order = row.label == "lohner" and 0 or 8, events = { { g = function(s) return s.x - "0.5" end, stop = true } } }
      assert.equal(run.t_reached, row.t_reached)
    end
    r = ambit.compare { decay, initial = { x = 1 }, t = { 0, -1 }, repeats = 1, solvers = { "lohner" } }
    assert.equal(-1, r.rows[1].t_reached)
    assert.is_true(r.rows[1].error < 1e-12)
  end)
end)

describe("the grid of solvers", function()
  it("goes over everything that is installed and simulates", function()
    local seen = {}
    for _, c in ipairs(solvers.combinations()) do
      seen[c.solver] = true
      assert.is_nil(c.problem)
    end
    for _, entry in ipairs(ambit.plugins "solver") do
      local simulates = ambit.plugin("solver", entry.name).verb == "simulate"
      assert.equal(simulates, seen[entry.name] == true, entry.name)
    end
  end)

  it("takes a solver that nobody has listed from what it declares", function()
    local function of(...) return solvers.declared("mine", { parameters = { ... } }) end
    assert.same({ { "mine" } }, of())
    assert.same({ { "mine" } }, of({ name = "order", shape = "integer", fallback = "0" },
      { name = "tolerance", shape = "", fallback = "inf" }))
    assert.same({ { "mine", order = { 3, 5, 10 } }, { "mine", tolerance = { 1e-3, 1e-6, 1e-9 } } },
      of({ name = "order", shape = "integer", fallback = "5" }, { name = "tolerance", shape = "", fallback = "1e-9" }))
  end)

  it("crosses solvers with the arithmetics that fit", function()
    local labels = {}
    for i, c in ipairs(solvers.combinations({ { "valencia", order = { 6, 8 } }, "gsl" },
      { "interval", { "affine", symbols = 5 }, "real" })) do labels[i] = c.label end
    assert.same({ "valencia order=6", "valencia order=8", "valencia affine symbols=5 order=6",
      "valencia affine symbols=5 order=8", "gsl" }, labels)
    local list = solvers.combinations({ "gsl", "lohner" }, { "interval" })
    assert.equal(2, #list)
    has(list[1].refused, "gsl", "interval", "what fits: real")
    local r = ambit.compare { decay, initial = { x = 1 }, t = 1, solvers = { "gsl", "lohner" },
      arithmetics = { "interval" }, repeats = 1 }
    assert.equal("refused", r.rows[1].status)
    assert.equal("complete", r.rows[2].status)
  end)

  it("tells bad input apart, with the nearest name", function()
    local function with(t)
      t[1], t.initial, t.t = decay, t.initial or { x = 1 }, t.t or { 0, 1 }
      return function() ambit.compare(t) end
    end
    fails(with { solvers = { "lohnr" } }, "lohnr", "`lohner`")
    fails(with { solvers = { "krawczyk" } }, "krawczyk", "roots")
    fails(with { solvers = {} }, "solvers", "empty")
    fails(with { solvers = "lohner" }, "solvers", "table")
    fails(with { solvers = { { "lohner", ordr = 3 } } }, "ordr", "`order`")
    fails(with { solvers = { { "lohner", order = {} } } }, "order", "empty")
    fails(with { solver = "lohner" }, "solver", "`solvers`")
    fails(with { arithmetics = { "intervl" } }, "intervl", "`interval`")
    fails(with { repeats = -1 }, "repeats", "positive integer")
    fails(with { limit = 0 }, "limit", "positive")
    fails(with { memory = "much" }, "memory", "positive")
    fails(with { reference = { x = { x = 1 } } }, "reference.t")
    fails(with { reference = { t = 1, x = {} } }, "reference.x")
    fails(with { reference = { t = 1, x = { x = true } } }, "reference.x.x", "boolean")
    fails(with { initial = { y = 1 } }, "y")
    fails(function() ambit.compare { solvers = { "gls" } } end, "gls", "`gsl`")
    fails(function() ambit.compare { solvers = { "lohner" }, initial = {} } end, "initial")
    local r = ambit.compare { decay, initial = { x = 1 }, t = 1, solvers = { "lohner" }, repeats = 1,
      reference = { t = 1, x = { y = 1 } } }
    has(r.reference_problem, "no state `y`")
  end)

  it("keeps a combination that its solver refuses as a row", function()
    local r = ambit.compare { decay, initial = { x = 1 }, t = 1, repeats = 1,
      solvers = { { "lohner", order = { 10, 1000 } } } }
    assert.equal("complete", r.rows[1].status)
    assert.equal("failed", r.rows[2].status)
    has(r.rows[2].reason, "order")
    assert.equal("complete", r.status)
  end)
end)
