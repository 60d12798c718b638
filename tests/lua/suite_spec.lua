-- The stability suite: what is wrong is called wrong, what changes fails, what crashes or hangs is a row.
local ambit = require "ambit"
local case_of = require "ambit.suite.case"
local select_cases = require "ambit.suite.select"
local suite = require "ambit.suite.run"
local suite_table = require "ambit.suite.table"
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function decay(a)
  local system = a.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
  return { system, initial = { x = 1 }, t = { 0, 1 } }
end

local E = "0.367879441171442322?1"
local lohner = { { solver = "lohner" } }

local function run(case, wanted)
  case.name = case.name or "mine"
  return suite.run(select_cases.of({ case }, wanted or {}), {})
end

local function row_of(case)
  case.over = case.over or lohner
  local result = run(case)
  return result.cases[1].rows[1], result
end

-- A case that answers what it is told.
local function saying(answer) return { run = function() return answer end, over = { {} } } end

local function fails(text, f, ...)
  local good, problem = pcall(f, ...)
  assert.is_false(good, "no error was raised")
  assert.truthy(tostring(problem):find(text, 1, true), problem)
end

describe("the stability suite", function()
  it("proves a case and counts its right digits", function()
    local row, result = row_of { make = decay, reference = { t = 1, x = { x = E } }, expected = { lohner = "proved" },
      least = { lohner = { t_reached = 1, digits = 10 } } }
    assert.equal("proved", row.outcome)
    assert.equal("as expected", row.verdict)
    assert.is_true(row.digits > 10 and row.digits <= 17)
    assert.is_true(row.width > 0 and row.width < 1e-9)
    assert.equal(1, row.t_end)
    assert.equal("interval", row.arithmetic)
    assert.equal(0, result.changed)
    assert.is_false(result.interrupted)
  end)

  it("calls an enclosure wrong that misses a spoilt reference", function()
    local row, result = row_of { make = decay, reference = { t = 1, x = { x = "[0.3679, 0.368]" } },
      expected = { lohner = "proved" } }
    assert.equal("wrong", row.outcome)
    assert.equal("changed", row.verdict)
    assert.equal(1, result.changed)
    assert.truthy(row.reason:find("misses the reference", 1, true))
    assert.truthy(suite_table.update(result):find("a fault of Ambit", 1, true))
  end)

  it("looks at a reference on the way too", function()
    local function at_half(text)
      return row_of { make = function(a)
        local t = decay(a)
        t.t = { 0, 0.5, 1 }
        return t
      end, reference = { { t = 0.5, x = { x = text } }, { t = 1, x = { x = E } } } }.outcome
    end
    assert.equal("proved", at_half "0.606530659712633424?1")
    assert.equal("wrong", at_half "[0.6, 0.6065306]")
  end)

  it("notices NaN bounds and bounds the wrong way round", function()
    for _, x in ipairs { { lo = 0 / 0, hi = 1 }, { lo = 0, hi = 0 / 0 }, { lo = 1, hi = 0 } } do
      local row = row_of(saying { outcome = "proved", enclosures = { x = x } })
      assert.equal("wrong", row.outcome)
      assert.equal("changed", row.verdict)
    end
  end)

  it("does not let a reference go unseen", function()
    local function outcome(case)
      case.over = case.over or { {} }
      local row = row_of(case)
      assert.equal("changed", row.verdict)
      return row.outcome, row.reason
    end
    local function says(answer) return function() return answer end end
    local reference = { x = { y = "1" } }
    assert.equal("wrong", (outcome { run = says { outcome = "proved" }, reference = reference }))
    local name, reason = outcome { make = decay, over = lohner, reference = { t = 5, x = { x = "0.006?1" } },
      expected = { lohner = "proved" } }
    assert.equal("wrong", name)
    assert.truthy(reason:find("the reference at t = 5 was held against nothing", 1, true), reason)
    assert.equal("crashed", (outcome { make = decay, over = lohner, reference = { t = 1, x = { y = "1" } },
      expected = { default = "refused" } }))
    assert.equal("crashed", (outcome { make = decay, over = lohner, reference = { x = { x = E } },
      expected = { default = "refused" } }))
  end)

  it("takes no outcome that is none, and no refusal without a reason", function()
    assert.equal("changed", row_of(saying { outcome = "fine" }).verdict)
    assert.equal("changed", row_of(saying {}).verdict)
    local silent = { run = function() error("", 0) end, over = { {} }, expected = { default = "refused" } }
    assert.equal("the reason gives no reason", row_of(silent).changed)
  end)

  it("expects nothing in the quick run that a loaded machine could change", function()
    for _, entry in ipairs(select_cases.of(select_cases.own(), { quick = true })) do
      for _, c in ipairs(entry.combinations) do
        local expected = case_of.expected(entry.case, c)
        assert.is_true(expected ~= "late" and expected ~= "out of memory", entry.case.name .. " " .. (c.solver or ""))
      end
    end
  end)

  it("fails on a changed outcome, for worse and for better", function()
    local worse, result = row_of { make = function(a)
      local t = decay(a)
      t[1] = a.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
      return t
    end, over = { { solver = "lohner", options = { order = 12 } } }, expected = { lohner = "proved" } }
    assert.equal("unable", worse.outcome)
    assert.equal("changed", worse.verdict)
    assert.truthy(suite_table.update(result):find('["lohner interval order=12"] = "unable"', 1, true))
    local better = row_of { make = decay, expected = { default = "unable" } }
    assert.equal("better", better.verdict)
    assert.equal("changed", row_of { make = decay, reference = { t = 1, x = { x = E } },
      least = { default = { digits = 17.5 } } }.verdict)
    assert.equal("changed", row_of { make = decay, least = { default = { t_reached = 1.5 } } }.verdict)
  end)

  it("asks a reason for time and knob", function()
    local function verdict(reason, question)
      local case = saying { outcome = "unable", reason = reason }
      case.question = question
      local row = row_of(case)
      return row.verdict, row.changed
    end
    assert.equal("as expected", (verdict "at t = 0.3 s the solution escapes: end before it"))
    assert.equal("the reason names no time", select(2, verdict "the solution escapes: end before it"))
    assert.equal("the reason names nothing to turn", select(2, verdict "at t = 0.3 s it escapes"))
    assert.equal("the reason gives no reason", select(2, verdict "" ))
    assert.equal("as expected", (verdict("no box can be proved: change initial", "certify")))
  end)

  it("makes rows of crashes, faults, refusals and of what takes too long", function()
    local function outcome(f, budget)
      local row = row_of { run = f, over = { {} }, budget = budget }
      return row.outcome, row
    end
    local name, row = outcome(function() os.execute "kill -SEGV $PPID" end)
    assert.equal("crashed", name)
    assert.equal("changed", row.verdict)
    assert.equal("crashed", (outcome(function() os.exit(3) end)))
    assert.equal("crashed", (outcome(function() return nil + 1 end)))
    name, row = outcome(function() ambit.simulate { 1 } end)
    assert.equal("refused", name)
    assert.truthy(row.reason:find("simulate: expected", 1, true))
    assert.equal("late", (outcome(function() os.execute "exec sleep 60" end, { wall = 0.5 })))
  end)

  it("keeps what was proved until the budget was over", function()
    local row = row_of { make = function(a)
      local t = decay(a)
      t.t, t.step_max = { 0, 1e9 }, 1e-3
      return t
    end, budget = { cpu = 0.3 }, expected = { lohner = "late" } }
    assert.equal("late", row.outcome)
    assert.equal("as expected", row.verdict)
    assert.is_true(row.t_reached > 0 and row.t_reached < 1e9)
  end)

  it("takes every solver and arithmetic that fits, and asks nothing of a user's", function()
    local result = run { make = decay, reference = { t = 1, x = { x = E } }, expected = { gsl = "computed",
      default = "proved" } }
    local seen = {}
    for _, row in ipairs(result.cases[1].rows) do
      seen[row.solver .. " " .. row.arithmetic] = row
      if row.solver == "gsl" then assert.equal("computed", row.outcome) end
    end
    for _, name in ipairs { "lohner interval", "taylor_model interval", "stiff interval", "valencia interval", "gsl real" } do
      assert.truthy(seen[name], name)
      assert.equal("as expected", seen[name].verdict)
      assert.is_true(seen[name].digits > 4)
    end
    local own = run { make = decay, over = { { solver = "nobody" } }, expected = { default = "proved" } }
    assert.equal("refused", own.cases[1].rows[1].outcome)
    assert.is_nil(own.cases[1].rows[1].expected)
  end)

  it("evaluates in every arithmetic", function()
    local result = run { question = "evaluate", make = function(a)
      local x = a.between(1, 2)
      return { { y = x * x, z = 1 / a.between(-1, 1) } }
    end, expected = { real = "computed", default = "unable" } }
    local found = {}
    for _, row in ipairs(result.cases[1].rows) do found[row.arithmetic] = row end
    assert.equal("unable", found.interval.outcome)
    assert.truthy(found.interval.reason:find("z has no bounds", 1, true))
    assert.equal("as expected", found.interval.verdict)
  end)

  it("wants roots of the reference in some box", function()
    local function roots(text)
      return row_of { question = "roots", over = { { solver = "krawczyk" } },
        make = function() return { function(s) return { s.x ^ 2 - 2 } end, box = { x = { 0, 2 } } } end,
        reference = { x = { x = text } } }.outcome
    end
    assert.equal("proved", roots "1.41421356237309505?1")
    assert.equal("wrong", roots "1.5?0")
  end)

  it("says what is wrong with a case", function()
    local function read(case) return select_cases.of({ case }, {}) end
    fails("name of a case", read, {})
    fails("expected either make or run", read, { name = "a" })
    fails("unknown key `budgets`; did you mean `budget`?", read, { name = "a", make = decay, budgets = {} })
    fails("expected: lohner: one of", read, { name = "a", make = decay, expected = { lohner = "fine" } })
    fails("nothing is called `lohnr`; did you mean `lohner`?", read, { name = "a", make = decay,
      expected = { lohnr = "proved" } })
    fails("cpu: expected a positive number", read, { name = "a", make = decay, budget = { cpu = 0 } })
    fails("two cases are called `a`", select_cases.of, { { name = "a", make = decay }, { name = "a", make = decay } }, {})
    local list = { { name = "mine", make = decay } }
    fails("--group: nothing is called `stif`", select_cases.of, list, { group = "stif" })
    fails("--case: nothing is called `min`; did you mean `mine`?", select_cases.of, list, { case = "min" })
    fails("--solver: nothing is called `lohnr`; did you mean `lohner`?", select_cases.of, list, { solver = "lohnr" })
  end)

  it("knows its own cases: names, references and expectations of each fit", function()
    local all = select_cases.of(select_cases.own(), {})
    local quick = select_cases.of(select_cases.own(), { quick = true })
    assert.is_true(#all > 25 and #quick >= 5 and #quick < #all)
    for _, entry in ipairs(all) do
      assert.is_true(#entry.combinations > 0, entry.case.name)
      assert.is_true(#entry.case.references == 0 or entry.case.source ~= "", entry.case.name)
      assert.truthy(next(entry.case.expected), entry.case.name)
    end
  end)
end)

-- -- the command

local function write(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

local function read(name)
  local file = assert(io.open(name))
  local text = file:read "a"
  file:close()
  os.remove(name)
  return text
end

local function shell(words)
  local pipe = io.popen(("%s stability %s 2>&1; echo \"code $?\""):format(command, words))
  local text = pipe:read "a"
  pipe:close()
  return text, tonumber(text:match "code (%d+)\n$")
end

local cases = [[
local function decay(ambit)
  return { ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }, initial = { x = 1 },
    t = { 0, 1 } }
end
return {
  { name = "first", group = "own", title = "decay | 1", make = decay, over = { { solver = "stiff" } }, quick = true,
    expected = { stiff = "%s" } },
  { name = "second", group = "own", run = function() %s end, over = { {} } },
}
]]

describe("ambit stability", function()
  it("writes table, JSON, CSV and Markdown", function()
    local file, csv, json, markdown = write(cases:format("proved", "return { outcome = 'proved', width = 1 / 0 }")),
      os.tmpname(), os.tmpname(), os.tmpname()
    local text, code = shell(("%s --csv %s --json %s --markdown %s"):format(file, csv, json, markdown))
    assert.equal(0, code, text)
    assert.truthy(text:find("OWN\n", 1, true) and text:find("first: decay | 1\n", 1, true), text)
    assert.truthy(text:find("2 rows of 2 cases: 2 proved; 0 changed", 1, true), text)
    assert.truthy(read(csv):find("own,first,stiff,interval,,proved,proved,as expected,1,1,", 1, true))
    json = read(json)
    assert.truthy(json:find('"outcome":"proved"', 1, true) and json:find('"width":null', 1, true), json)
    assert.truthy(read(markdown):find("| decay \\| 1 | stiff interval | proved | 1 of 1 |", 1, true))
    os.remove(file)
  end)

  it("exits with 3 on a change and says what to do", function()
    local file = write(cases:format("unable", "return { outcome = 'proved' }"))
    local text, code = shell(file)
    assert.equal(3, code)
    assert.truthy(text:find('BETTER (expected unable)', 1, true), text)
    assert.truthy(text:find('write expected = { ["stiff interval"] = "proved" } in the case', 1, true), text)
    os.remove(file)
  end)

  it("keeps what was done at Ctrl-C", function()
    -- two at a time: the third starts when the first is done, and interrupts the command that started it
    local third = [[  { name = "third", group = "own", over = { {} }, run = function()
      local parent = io.open "/proc/self/stat":read "a":match "%) %a (%d+)"
      os.execute("kill -INT " .. parent .. "; exec sleep 60 >/dev/null 2>&1")
    end },
}
]]
    local file, json = write((cases:format("proved", "os.execute 'exec sleep 60 >/dev/null 2>&1'"):gsub("}\n$", function() return third end))), os.tmpname()
    local text, code = shell(("%s --json %s"):format(file, json))
    assert.equal(130, code, text)
    assert.truthy(text:find("interrupted: what was done up to there is kept", 1, true), text)
    json = read(json)
    assert.truthy(json:find('"interrupted":true', 1, true) and json:find('"name":"first"', 1, true), json)
    assert.is_nil(json:find('"name":"second"', 1, true))
    os.remove(file)
  end)

  it("refuses what it cannot do before it starts", function()
    for _, entry in ipairs {
      { "--grup stiff", 2, "unknown option `--grup`; did you mean `--group`?" },
      { "--group stif", 1, "--group: nothing is called `stif`; did you mean `stiff`?" },
      { "--case lorentz_1", 1, "did you mean `lorenz_1`?" },
      { "--budget none", 2, "--budget: expected a positive number" },
      { "--case lorenz_1 --csv /nowhere/x.csv", 1, "cannot write the file of --csv: /nowhere/x.csv" },
      { "/nowhere/cases.lua", 1, "cannot open /nowhere/cases.lua" },
      { "a.lua b.lua", 2, "expected one file of cases, got also `b.lua`" },
    } do
      local text, code = shell(entry[1])
      assert.equal(entry[2], code, text)
      assert.truthy(text:find(entry[3], 1, true), text)
    end
    local file = write "return 3"
    local text, code = shell(file)
    assert.equal(1, code)
    assert.truthy(text:find("expected it to return a list of cases, got number", 1, true), text)
    os.remove(file)
  end)
end)
