-- `split`, `threads` and `keep`: uncertain data cut into pieces, whose union does not depend on how many threads work.
local ambit = require "ambit"
local core = require "ambit.core"
local flow = require "ambit.run.flow"
local simulate = require "ambit.simulate"

local function message(t)
  local good, problem = pcall(ambit.simulate, t)
  assert.is_false(good)
  return problem
end

local function copy(t, more)
  local all = {}
  for key, value in pairs(t) do all[key] = value end
  for key, value in pairs(more) do all[key] = value end
  return all
end

-- x' = -a x^2: x(t) = x0 / (1 + a x0 t)
local a = ambit.between("0.5", 1)
local decay = ambit.ode {
  states = { "x" }, parameters = { a = a }, equations = function(s, p) return { x = -p.a * s.x ^ 2 } end,
}
local question = { decay, initial = { x = ambit.between(1, 3) }, t = { 0, 1, 2 }, solver = "lohner" }
local function exact(x0, rate, t) return x0 / (1 + rate * x0 * t) end

describe("split", function()
  it("encloses all solutions, more tightly than one set", function()
    local whole, cut = ambit.simulate(question), ambit.simulate(copy(question, { split = { x = 16, a = 4 } }))
    assert.equal("complete", cut.status)
    assert.equal(64, cut.pieces)
    assert.equal(1, whole.pieces)
    assert.equal(2, cut.step_count) -- one for each interval of the list
    for _, t in ipairs { 1, 2 } do
      local x = cut:at(t).x
      assert.is_true(x.lo <= exact(1, 1, t) and exact(3, 0.5, t) <= x.hi)
      assert.is_true(x.lo >= 0.99 * exact(1, 1, t) and x.hi <= 1.01 * exact(3, 0.5, t))
      assert.is_true(x:width() <= whole:at(t).x:width())
    end
    local tube = cut:at(0.5).x -- between the instants of the list
    for x0 = 1, 3, 0.25 do assert.is_true(tube:contains(exact(x0, 0.75, 0.5))) end
  end)

  it("cuts where sets reach beyond a band, and nowhere else", function()
    local q = simulate.request(copy(question, {}), "simulate", nil, {})
    local lo, hi = { exact(1, 1, 1), exact(1, 1, 2) }, { exact(3, 0.5, 1), exact(3, 0.5, 2) }
    local first
    for _, threads in ipairs { 1, 2, 3 } do
      local track, facts = core.simulate(flow(q), nil, { silent = true, threads = threads, band_lo = lo, band_hi = hi,
        band_runs = 200, band_limit = 0.005 })
      assert.equal("complete", facts.status)
      assert.is_true(facts.pieces > 8 and facts.pieces < 64, facts.pieces) -- a grid of 64 is as tight
      local bits = { facts.pieces }
      for k = 1, 2 do
        local x, tube = core.track_value(track, k, 1), core.track_value(track, k, 1, true)
        local width = hi[k] - lo[k]
        assert.is_true(x.lo <= lo[k] and x.lo >= lo[k] - 0.005 * width)
        assert.is_true(x.hi >= hi[k] and x.hi <= hi[k] + 0.005 * width)
        assert.is_true(tube.lo <= exact(1, 1, k) and tube.hi >= exact(3, 0.5, k - 1))
        bits[#bits + 1] = ("%a %a %a %a"):format(x.lo, x.hi, tube.lo, tube.hi)
      end
      first = first or bits
      assert.same(first, bits)
    end
    assert.has_error(function()
      core.simulate(flow(q), nil, { band_lo = { 0 }, band_hi = { 1 }, band_runs = 4, band_limit = 1 })
    end)
  end)

  it("does not depend on the number of threads", function()
    local first
    for _, threads in ipairs { 1, 2, 3, 7 } do
      local run = ambit.simulate(copy(question, { split = 12, threads = threads, t = { 0, 2 } }))
      assert.equal(threads, run.threads)
      assert.equal(64, run.step_count) -- a common grid between a start and an end
      local bits = {}
      for step in run:steps() do
        bits[#bits + 1] = ("%a %a %a %a %a"):format(step.t, step.x.x.lo, step.x.x.hi, step.tube.x.lo, step.tube.x.hi)
      end
      first = first or bits
      assert.same(first, bits)
    end
  end)

  it("does not depend on it with arithmetics that keep something from one piece to the next", function()
    local mu = ambit.between("0.9", "1.1")
    local pendulum = ambit.ode {
      states = { "x", "y" }, parameters = { mu = mu },
      equations = function(s, p, t) return { s.y, -p.mu * ambit.sin(s.x) + ambit.cos(t) * "0.1" } end,
    }
    local first
    for _, threads in ipairs { 1, 2, 8 } do
      local run = ambit.simulate {
        pendulum, initial = { ambit.around(1, "0.3"), ambit.around(0, "0.02") }, t = { 1, 0.5 }, split = 13,
        solver = "lohner", arithmetic = "affine", threads = threads,
      }
      local bits = ("%a %a %a %a"):format(run.x.x.lo, run.x.x.hi, run.x.y.lo, run.x.y.hi)
      first = first or bits
      assert.equal(first, bits)
    end
  end)

  it("cuts by choice what has influence", function()
    local run = ambit.simulate(copy(question, { split = 8 }))
    assert.is_true(run.pieces == 8 or run.pieces == 6)
    local still = ambit.ode {
      states = { "x", "y" }, equations = function(s) return { x = s.x, y = ambit.number(0) } end,
    }
    run = ambit.simulate {
      still, initial = { x = ambit.between(1, 2), y = ambit.between(1, "1.0000001") }, t = 3, split = 5,
      solver = "lohner",
    }
    assert.equal(5, run.pieces) -- all for x
    assert.equal("complete", run.status)
  end)

  it("takes data themselves as keys", function()
    local p, q = ambit.between(0, 1), ambit.between(2, 3)
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local base = { f, initial = { x = p + q }, t = 1, solver = "lohner" }
    assert.equal(6, ambit.simulate(copy(base, { split = { [p] = 2, [q] = 3 } })).pieces)
    assert.matches("`x` depends on 2 uncertain data", message(copy(base, { split = { x = 2 } })))
  end)

  it("names the piece that could not go on", function()
    local escape = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
    local run = ambit.simulate {
      escape, initial = { x = ambit.between("0.1", 1) }, t = { 0, "0.5", 1, "1.5", 2 }, split = { x = 9 },
      solver = "lohner", threads = 2,
    }
    assert.equal("unable", run.status)
    assert.matches("^piece 9 of 9 %(initial x in %[0%.9, 1%]%): ", run.reason)
    assert.equal(0.5, run.t_reached) -- the last instant that all pieces reached
    assert.is_true(run.x.x:contains(1 / (1 - 0.5)))
    local rate = ambit.between(1, 4, "rate")
    local faster = ambit.ode { states = { "x" }, equations = function(v) return { x = rate * v.x ^ 2 } end }
    run = ambit.simulate { faster, initial = { x = 1 }, t = { 0, 1 }, split = 4, solver = "lohner", threads = 2 }
    assert.matches("^piece 4 of 4 %(rate in %[3%.25, 4%]%): ", run.reason)
  end)

  it("counts the time of all threads, and that of the clock", function()
    local run = ambit.simulate(copy(question, { split = 16 }))
    assert.is_true(run.cpu_seconds > 0 and run.wall_seconds > 0)
    assert.is_true(run.cpu_seconds <= run.wall_seconds * run.threads + 0.05)
  end)

  it("stops on Ctrl-C, whatever the pieces are at", function()
    local file, out = os.tmpname(), os.tmpname()
    local handle = assert(io.open(file, "w"))
    handle:write [[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = ambit.sin(t) - s.x } end }
      local start = { x = ambit.between(1, 2) }
      local run = ambit.simulate { f, initial = start, t = { 0, 1e9 }, split = 4, threads = 2, solver = "lohner" }
      print(run.status, run.pieces)]]
    handle:close()
    local words = "timeout --preserve-status -s INT 1 %q run --quiet %q >%q 2>&1"
    local _, _, code = os.execute(words:format(os.getenv "AMBIT_COMMAND", file, out))
    handle = assert(io.open(out))
    local text = handle:read "a"
    handle:close()
    os.remove(file)
    os.remove(out)
    assert.equal(130, code)
    assert.matches("stopped\t4", text)
  end)

  it("explains what it does not understand", function()
    local function says(text, split)
      local problem = message(copy(question, { split = split }))
      assert.is_truthy(problem:find(text, 1, true), problem)
    end
    says("split: there is no state, parameter or datum `y`", { y = 2 })
    says("split: x: expected a positive integer, got 0", { x = 0 })
    says("split: x: expected a positive integer, got 1.5", { x = 1.5 })
    says("split: x: at most 65536, got 65537", { x = 65537 })
    says("split: more than 65536 pieces", { x = 60000, a = 60000 })
    says("split: expected a number of pieces, or { state = parts }, got string", "many")
    says("split: expected a number of pieces, or { state = parts }, got an empty table", {})
    says("split: expected names of states or parameters, or uncertain data as keys, got 1", { 16 })
    says("split: `datum` is not uncertain", { [ambit.number(3)] = 2 })
    assert.matches("are the same uncertain datum", message {
      decay, initial = { x = a }, t = 1, solver = "lohner", split = { x = 2, [a] = 2 },
    })
    assert.matches("`x` is not uncertain", message(copy(question, { initial = { x = 1 }, split = { x = 2 } })))
  end)
end)

describe("threads", function()
  it("are a whole number", function()
    for _, bad in ipairs { 0, -1, 1.5, "two", 1000 } do
      assert.matches("simulate: threads: ", message(copy(question, { threads = bad })))
    end
  end)
end)

describe("sample", function()
  it("makes the same draws with any number of threads", function()
    local first = ambit.sample { decay, initial = { x = ambit.between(1, 3) }, t = { 0, 1 }, n = 300, threads = 1 }
    for _, threads in ipairs { 2, 3 } do
      local again = ambit.sample {
        decay, initial = { x = ambit.between(1, 3) }, t = { 0, 1 }, n = 300, threads = threads,
      }
      assert.equal(first.x.x, again.x.x)
      assert.equal(300, again.draws)
    end
    assert.is_false(pcall(ambit.sample, { decay, initial = { x = 1 }, t = 1, threads = 0 }))
  end)
end)

describe("keep", function()
  it("holds all steps, or only the last", function()
    local all, last = ambit.simulate(question), ambit.simulate(copy(question, { keep = "last" }))
    assert.equal(all.x.x, last.x.x)
    assert.equal(all.step_count, last.step_count)
    local kept = 0
    for _ in last:steps() do kept = kept + 1 end
    assert.equal(1, kept)
    assert.matches('keep: expected "all" or "last", got some', message(copy(question, { keep = "some" })))
  end)

  it("needs no memory for a long run", function()
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local times = {}
    for i = 0, 20000 do times[#times + 1] = i / 1000 end
    local run = ambit.simulate { f, initial = { x = 1 }, t = times, keep = "last", solver = "lohner" }
    assert.equal("complete", run.status)
    assert.equal(20000, run.step_count)
  end)
end)

describe("dense", function()
  it("is true or false", function()
    assert.matches("dense: expected true or false, got string", message(copy(question, { dense = "yes" })))
    local run = ambit.simulate(copy(question, { initial = { x = 1 }, dense = true }))
    assert.is_true(run:at("0.37").x:contains(exact(1, 0.75, 0.37)))
  end)
end)
