-- Statuses keep their difference to the end: words, codes and exit codes. AMBIT_COMMAND is the command to test;
-- solver.faulty (plugins/faulty.c) ends as its option says.
local ambit = require "ambit"
local session = require "ambit.session"

local command = os.getenv "AMBIT_COMMAND" or "ambit"
local drift = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }

local function faulty(fault)
  local run = ambit.simulate { drift, initial = { 0 }, t = { 0, 1 }, solver = "faulty", fault = fault }
  session.worst = "ok"
  return run
end

local function read(name)
  local file = assert(io.open(name))
  local text = file:read "a"
  file:close()
  os.remove(name)
  return text
end

-- Runs a scene: exit code, standard output, standard error, records.
local function scene(text, options)
  local name, out, problems, records = os.tmpname(), os.tmpname(), os.tmpname(), os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write([[local ambit = require "ambit"
    local drift = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }
    local function faulty(fault)
      return ambit.simulate { drift, initial = { 0 }, t = { 0, 1 }, solver = "faulty", fault = fault }
    end
    ]], text)
  file:close()
  local _, how, code = os.execute(("'%s' run --quiet %s --json %s %s >%s 2>%s"):format(command, options or "", records,
    name, out, problems))
  os.remove(name)
  return how == "exit" and code or how .. code, read(out), read(problems), read(records)
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

describe("an outcome", function()
  it("keeps its difference: a word and a code for each status", function()
    for fault, expected in pairs {
      fine = { "complete", "ok" },
      inverted = { "broken", "broken.bounds" },
      ["nan"] = { "broken", "broken.bounds" },
      gap = { "broken", "broken.time" },
      early = { "broken", "broken.time" },
      nothing = { "impossible", "domain.constraint" },
      unsure = { "unable", "unable.width" },
      own_code = { "unable", "unable.my-own" },
      bad_code = { "unable", "unable" },
      no_code = { "unable", "unable" },
      senseless = { "broken", "broken" },
    } do
      local run = faulty(fault)
      assert.equal(expected[1], run.status, fault)
      assert.equal(expected[2], run.code, fault)
      assert.equal(fault == "fine", run.reason == "")
    end
  end)

  it("decides the exit code, of several the worst", function()
    for _, case in ipairs {
      { 0, 'faulty "fine"', '"code":"ok"' },
      { 4, 'faulty "nothing"', '"status":"impossible","code":"domain.constraint"' },
      { 3, 'faulty "unsure"', '"status":"unable","code":"unable.width"' },
      { 1, 'faulty "inverted"', '"status":"broken","code":"broken.bounds"' },
      { 3, 'faulty "nothing" faulty "unsure" faulty "fine"', "unable.width" },
      { 1, 'faulty "inverted" faulty "unsure"', "broken.bounds" },
      { 4, 'faulty "nothing" faulty "fine"', "domain.constraint" },
      { 1, 'faulty "unsure" error "no"', "unable.width" },
    } do
      local code, _, problems, records = scene(case[2])
      assert.equal(case[1], code, case[2] .. problems)
      has(records, case[3])
    end
  end)

  it("of a verb that consists of many runs is broken if one of them is, and the scene goes on", function()
    local many = [[
      local q = { initial = { x = ambit.around(0, "0.1") }, t = { 0, 1 }, solver = "faulty", fault = "nan" }
      local function ask(verb, ...)
        local t = { ... }
        for key, value in pairs(q) do t[key] = value end
        return verb, t
      end
      local function safe(s) return s.x - 3 end
      local verb, t = ask(ambit.verify, drift)
      t.safe = safe
      local v = verb(t)
      assert(v.status == "broken" and v.code == "broken.bounds" and v.conditions.safe.code == "broken.bounds")
      assert(v.conditions.safe.bound.hi == math.huge and v.counterexample == nil)
      print(v)
      for _, criterion in ipairs { "difference", "bounds" } do
        verb, t = ask(ambit.certify, drift, drift)
        t.outputs, t.error, t.criterion = { "x" }, { x = 1 }, criterion
        local c = verb(t)
        assert(c.status == "broken" and c.code == "broken.bounds" and not next(c.error))
        print(c)
      end
      local two = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x - 0.001 * s.x ^ 3 } end }
      verb, t = ask(ambit.reduce, two)
      t.outputs, t.error = { "x" }, { x = 1 }
      local r = verb(t)
      assert(r.status == "broken" and r.code == "broken.bounds" and not next(r.error))
      assert(#r.terms == 0 and r.terms_after == r.terms_before)
      print(r)
      faulty "fine" ]]
    local code, out, problems, records = scene(many)
    assert.equal(1, code, problems)
    local _, count = out:gsub("solver `faulty` is broken", "")
    assert.is_true(count >= 4, out)
    has(records, '"verb":"verify","status":"broken","code":"broken.bounds"', '"verb":"certify","status":"broken"',
      '"verb":"reduce","status":"broken"', '"verb":"simulate","status":"complete","code":"ok"')
  end)

  it("of a verification that no solution is meant by is that there is none", function()
    local code, out, problems, records = scene [[
      local v = ambit.verify { drift, initial = { ambit.around(0, 1) }, t = { 0, 1 }, solver = "faulty",
        fault = "nothing", safe = { low = function(s) return s.x - 3 end, high = function(s) return s.x + 3 end } }
      assert(v.status == "impossible" and v.code == "domain.constraint")
      assert(v.reason:find("there is no solution", 1, true))
      assert(v.conditions.low.status == "impossible" and v.conditions.high.code == "domain.constraint")
      assert(v.conditions.low.bound:is_empty() and not v.counterexample)
      print(v)]]
    assert.equal(4, code, problems)
    has(out, "impossible", "low: impossible")
    has(records, '"status":"impossible","code":"domain.constraint"')
  end)

  it("of a single condition has a code", function()
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    local v = ambit.verify { f, initial = { ambit.around(1, "0.1") }, t = { 0, 1 }, budget = 9,
      safe = { proved = function(s) return s.x - 3 end, refuted = function(s) return s.x - 1 end,
        open = function(s) return s.x - "1.1" end } } -- it is just touched
    session.worst = "ok"
    assert.equal("ok", v.conditions.proved.code)
    assert.equal("ok.refuted", v.conditions.refuted.code)
    assert.equal("undecided", v.conditions.open.status)
    assert.equal("unable.budget", v.conditions.open.code)
  end)

  it("is broken for a whole split if one piece is", function()
    local run = ambit.simulate { drift, initial = { ambit.around(0, 1) }, t = { 0, 1 }, solver = "faulty",
      fault = "inverted", split = 4 }
    session.worst = "ok"
    assert.equal("broken", run.status)
  end)
end)

describe("ambit errors", function()
  local function errors(words)
    local pipe = io.popen(("'%s' errors %s 2>&1"):format(command, words))
    local text = pipe:read "a"
    local _, _, code = pipe:close()
    return text, code
  end

  it("explains a code, all codes, and corrects a wrong one", function()
    local text, code = errors "unable.width"
    assert.equal(0, code)
    has(text, "exit code 3", "`width_max`")
    text, code = errors ""
    assert.equal(0, code)
    has(text, "broken.bounds (exit code 1)", "domain (exit code 4)", "ok (exit code 0)")
    text, code = errors "unable.widht"
    assert.equal(2, code)
    has(text, "did you mean `unable.width`?")
  end)
end)
