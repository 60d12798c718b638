-- core.reduce: what goes into the solver of reductions and what comes back; errors and stops inside proofs.
local ambit = require "ambit"
local core = require "ambit.core"

local x, v = core.symbol("spec_x", "m"), core.symbol("spec_v", "m/s")

-- An oscillator with a weak cubic spring; the proof is played: errors add up.
local function problem(change)
  local t, along = {}, {}
  for i = 0, 100 do
    t[i + 1] = i / 10
    along[2 * i + 1], along[2 * i + 2] = math.cos(i / 10), -math.sin(i / 10)
  end
  local error = { 3, 3, 0.02, 0.004 }
  local q = { states = { "x", "v" }, symbols = { x, v }, rates = { v, -x - 0.01 * v - 0.001 * x ^ 3 },
    outputs = { "x" }, output_expressions = { x }, bounds = { 0.03 },
    candidates = { "x: v", "v: -x", "v: -0.01 v", "v: -0.001 x^3" },
    effect = { -v, x, 0.01 * v, 0.001 * x ^ 3 }, effect_candidate = { 1, 2, 3, 4 }, effect_state = { 1, 2, 2, 2 },
    references = { { scenario = 1, t = t, x = along, data = {} } } }
  local seen = { log = {}, calls = 0 }
  function q.prove(cut, how)
    local sum = 0
    seen.calls = seen.calls + 1
    for _, k in ipairs(cut) do sum = sum + error[k] end
    seen.how = how
    return "proved", { sum }
  end
  function q.tried(outcome, candidates, errors)
    seen.log[#seen.log + 1] = ("%s %s %s"):format(outcome, table.concat(candidates, ","), errors and errors[1] or "none")
  end
  for key, value in pairs(change or {}) do q[key] = value end
  return q, seen
end

local function assert_refused(part, change)
  local good, message = pcall(core.reduce, (problem(change)))
  assert.is_false(good)
  if not tostring(message):find(part, 1, true) then error(("expected %q, got %s"):format(part, message), 2) end
end

describe("core.reduce", function()
  it("cuts what fits into the bounds, and tells every decision", function()
    local q, seen = problem { options = { "adjoint", "true", "one_step", "true" } }
    local r, report = core.reduce(q)
    assert.equal("complete", r.status)
    assert.same({ 3, 4 }, r.cut)
    assert.same({ "accepted 4 0.004", "accepted 3 0.024", "halved 1,2 6.024", "undone 1 3.024", "undone 2 3.024" },
      seen.log)
    assert.equal(5, r.proofs)
    assert.equal(seen.calls, r.proofs)
    assert.equal("full", seen.how)
    for _, name in ipairs { "residual", "adjoint", "one_step" } do assert.equal(4, #r.rankings[name]) end
    assert.is_nil(r.rankings.exact)
    assert.is_true(r.cpu_seconds_rank >= 0 and r.cpu_seconds_rank <= r.cpu_seconds)
    assert.equal("reduction", report.solver)
    assert.equal("real", report.arithmetic)
  end)

  it("ranks by proofs of lowered order, told apart, and takes errors by the outputs' names", function()
    local asked = {}
    local q = problem { options = { "ranking", "lowered_order" }, references = {},
      prove = function(cut, how)
        asked[how] = (asked[how] or 0) + 1
        return "proved", { x = how == "lowered" and 0.06 or 0.01 * #cut }
      end }
    local r = core.reduce(q)
    assert.same({ lowered = 4, full = 3 }, asked)
    assert.same({ 2, 2, 2, 2 }, r.rankings.lowered_order)
    assert.equal(4, r.proofs_lowered)
    assert.same({ 1, 2, 3 }, r.cut)
  end)

  it("gives data once for all nodes or row by row", function()
    local p = core.symbol("spec_p", "1")
    local function ranks(data)
      return core.reduce(problem { data = { p }, effect = { -p * v, x, v, x },
        references = { { t = { 0, 1, 2 }, x = { 0, 1, 1, 2, 2, 3 }, data = data } } }).rankings.residual
    end
    assert.same(ranks { 3 }, ranks { 3, 3, 3 })
    assert.is_true(ranks({ 3, 5, 4 })[1] > ranks({ 3 })[1])
  end)

  it("keeps what was accepted when a proof says that it was stopped", function()
    local q, seen = problem()
    local prove = q.prove
    function q.prove(cut, how)
      if seen.calls == 2 then return "stopped", nil, "the budget is spent" end
      return prove(cut, how)
    end
    local r = core.reduce(q)
    assert.equal("stopped", r.status)
    assert.equal("the budget is spent", r.reason)
    assert.same({ 3, 4 }, r.cut)
    assert.equal(2, #seen.log)
  end)

  it("undoes what cannot be proved", function()
    local r = core.reduce(problem { prove = function() return "unable", nil, "the step became too short" end })
    assert.equal("complete", r.status)
    assert.same({}, r.cut)
  end)

  it("raises an error of a callback again, whatever it is, and is usable afterwards", function()
    local thing = { "an error that is a table" }
    for _, name in ipairs { "prove", "tried" } do
      local calls = 0
      local good, got = pcall(core.reduce, problem { [name] = function()
        calls = calls + 1
        error(thing)
      end })
      assert.is_false(good)
      assert.equal(thing, got)
      assert.equal(1, calls)
    end
    assert_refused("`prove` must return", { prove = function() return "maybe" end })
    assert_refused("`prove` must return", { prove = function() end })
    assert_refused("gave no error of output `x`", { prove = function() return "proved", {} end })
    assert_refused("gave no error of output `x`", { prove = function() return "proved", { 0 / 0 } end })
    assert_refused("that is 0 or greater", { prove = function() return "proved", { -1 } end })
    assert_refused("table expected", { prove = function() return "proved", 1 end })
    assert_refused("yield", { prove = function() coroutine.yield() end })
    assert.equal("complete", core.reduce((problem())).status)
  end)

  it("runs other verbs and itself inside a proof", function()
    local depth = 0
    local q = problem()
    local prove = q.prove
    function q.prove(cut, how)
      if depth == 0 then
        depth = 1
        assert(core.reduce((problem())).status == "complete")
        assert(ambit.evaluate { x ^ 2, at = { spec_x = ambit.between(1, 2) } } ~= nil)
        depth = 0
      end
      return prove(cut, how)
    end
    assert.same({ 3, 4 }, core.reduce(q).cut)
  end)

  it("stops on Ctrl-C inside a proof, with what was accepted until then", function()
    local file, out = os.tmpname(), os.tmpname()
    local handle = assert(io.open(file, "w"))
    handle:write [[
      local ambit, core = require "ambit", require "ambit.core"
      local f = ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = ambit.sin(t) - s.x } end }
      local x = core.symbol("x", "1")
      for _, ignores in ipairs { false, true } do
        local calls = 0
        local r = core.reduce { states = { "x" }, symbols = { x }, rates = { x }, outputs = { "x" },
          output_expressions = { x }, bounds = { 1 }, candidates = { "a", "b", "c" }, effect = { x, 2 * x, 3 * x },
          effect_candidate = { 1, 2, 3 }, effect_state = { 1, 1, 1 }, options = { "cluster", "1" },
          references = { { t = { 0, 1 }, x = { 0, 1 }, data = {} } },
          prove = function()
            calls = calls + 1
            if calls == 1 then return "proved", { 0 } end
            io.popen("kill -INT $PPID"):close()
            if ignores then return "proved", { 0 } end
            local run = ambit.simulate { f, initial = { x = 1 }, t = { 0, 1e9 } } -- a whole life, unless stopped
            return run.status, nil, run.reason
          end }
        print(r.status, table.concat(r.cut, ","), calls)
      end]]
    handle:close()
    local words = "timeout 20 %q run --quiet %q >%q 2>&1"
    local _, _, code = os.execute(words:format(os.getenv "AMBIT_COMMAND", file, out))
    handle = assert(io.open(out))
    local text = handle:read "a"
    handle:close()
    os.remove(file)
    os.remove(out)
    assert.equal(130, code)
    assert.matches("stopped\t1\t2\nstopped\t1,2\t2\n", text)
  end)

  it("refuses requests that make no sense", function()
    local without = problem()
    without.prove = nil
    assert.has_error(function() core.reduce(without) end)
    assert_refused("`prove` must be a function, not a boolean", { prove = false })
    assert_refused("`rates` has 1 entries, not 2", { rates = { v } })
    assert_refused("`effect_state` has 1 entries, not 4", { effect_state = { 1 } })
    assert_refused("`bounds` has 2 entries, not 1", { bounds = { 1, 2 } })
    assert_refused("must be greater than 0", { bounds = { 0 } })
    assert_refused("effect 1 is of candidate", { effect_candidate = { 0, 1, 2, 3 } })
    assert_refused("`x` has 1 entries, not 2", { references = { { t = { 0 }, x = { 1 }, data = {} } } })
    assert_refused("`t` is missing", { references = { { x = { 1 }, data = {} } } })
    assert_refused("there are no reference solutions", { references = {} })
    assert_refused("`residual`", { options = { "ranking", "residul" } })
    assert_refused("clutser", { options = { "clutser", "3" } })
    assert_refused("advances in time; it does not choose what a model may leave out", { solver = "lohner" })
    assert_refused("`states`: expected a list, got string", { states = "x" })
  end)

  it("is refused by the verbs that need another kind of solver", function()
    local system = ambit.ode { states = { x = "1" }, equations = function(s) return { x = -s.x } end }
    local good, message = pcall(ambit.simulate, { system, t = { 0, 1 }, initial = { x = 1 }, solver = "reduction" })
    assert.is_false(good)
    assert.truthy(message:find("chooses what a model may leave out; it does not advance in time", 1, true))
    local function f(s) return s.spec_x end
    good, message = pcall(ambit.roots, { f, box = { spec_x = { -1, 1 } }, solver = "reduction" })
    assert.is_false(good)
    assert.truthy(message:find("it does not find roots; what does: `krawczyk`", 1, true))
    assert.equal("reduce", core.plugin("solver", "reduction").verb)
  end)
end)
