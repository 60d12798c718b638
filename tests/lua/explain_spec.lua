-- `ambit explain`: the five levels of leaving out, memory and time; as text, lines of JSON and a graph.
local command = os.getenv "AMBIT_COMMAND" or "ambit"
local has_cjson, cjson = pcall(require, "cjson")

local function write(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

local function read(path)
  local file = assert(io.open(path))
  local text = file:read "a"
  file:close()
  return text
end

-- explain(scene text or path.lua, options, environment) -> exit code, stdout, stderr
local function explain(scene, options, environment)
  local own = not scene:find "^%S+%.lua$"
  local name = own and write('local ambit = require "ambit"\n' .. scene) or scene
  local err = os.tmpname()
  local pipe = assert(io.popen(("%s '%s' explain %s '%s' 2>%s"):format(environment or "", command, options or "", name,
    err)))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  local problem = read(err)
  os.remove(err)
  if own then os.remove(name) end
  return code, output, problem
end

local function has(text, ...)
  for _, words in ipairs { ... } do
    assert.truthy(text:find(words, 1, true), ("%s\ndoes not say %q"):format(text, words))
  end
end

-- The records of the scene, by kind.
local function records(scene, options)
  local code, output, problem = explain(scene, "--json " .. (options or ""))
  local by = setmetatable({}, { __index = function(t, key) t[key] = {} return t[key] end })
  for line in output:gmatch "[^\n]+" do
    local record = cjson.decode(line)
    table.insert(by[record.record], record)
  end
  return by, code, problem
end

local function loaded(by)
  local set = {}
  for _, plugin in ipairs(by.available) do
    if plugin.loaded == 1 then set[plugin.kind .. "." .. plugin.name] = plugin end
  end
  for _, library in ipairs(by.library) do set[library.name] = library end
  return set
end

local decay = [[
local f = ambit.ode { states = { "x" }, parameters = { a = ambit.around(1, "1%"), b = 2, c = ambit.around(3, 0) },
  equations = function(s, p) return { x = -p.a * p.b * p.c * s.x } end }
]]

describe("ambit explain", function()
  it("discards what the scene prints", function()
    local code, output = explain 'print "not shown" io.write "nor this" io.stdout:write "nor that"'
    assert.equal(0, code)
    assert.falsy(output:find "not shown" or output:find "nor ")
    has(output, "0 verbs", "the scene has no mechanism", "not asked for: the scene has no ambit.reduce")
  end)

  it("adds up the runs that a verb is made of", function()
    if not has_cjson then return pending "cjson is not installed" end
    local by = records "scripts/bouncing_ball.lua"
    local hybrid = by.verb[1].report
    assert.equal("lohner", hybrid.solver)
    assert.truthy(hybrid.steps > 0 and hybrid.operations > 0 and hybrid.seconds_run > 0)
    assert.truthy(hybrid.tape_instructions < 100)
    local reduce = records("scripts/reduce_double_pendulum.lua").verb[1]
    assert.equal("reduce", reduce.verb)
    assert.truthy(reduce.report.steps > 0 and reduce.report.coefficients > 0)
  end)

  it("measures each of two plugins whose files have the same name", function()
    if not has_cjson then return pending "cjson is not installed" end
    local by = records(decay .. [[
ambit.simulate { f, initial = { x = 1 }, t = 1, solver = "taylor_model" }
ambit.evaluate { ambit.between(0, 1), arithmetic = "taylor_model" }]])
    local mapped = {}
    for _, library in ipairs(by.library) do
      if library.name == "taylor_model.so" then mapped[#mapped + 1] = library.mapped end
    end
    assert.equal(2, #mapped)
    assert.are_not.equal(mapped[1], mapped[2])
  end)

  it("shows that a kinematic scene maps no solver and no GSL, and builds poses alone", function()
    local code, output = explain "scripts/manipulator.lua"
    assert.equal(0, code)
    has(output, "1. evaluate (complete) in real", "11 of 109 quantities built, 98 left out (90 %)",
      "built:           pose 11 of 11\n", "never asked for: twist (11)", " solvers: ", "gsl krawczyk lohner",
      "25 data: 15 fixed (also those of no width), 10 uncertain", "5. evaluate in gradient")
    assert.falsy(output:match("libraries:(.-)largest"):find "gsl")
  end)

  it("explains with nothing but ode, evaluate, events, equilibria", function()
    local code, output = explain(decay .. [[
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 }, solver = "lohner",
        events = { { g = function(s) return s.x - 0.5 end, name = "half" } } }
      ambit.equilibria { f, box = { x = { -1, 2 } } }
      ambit.roots { function(s) return s.x - 1 end, box = { x = { 0, 2 } } }]])
    assert.equal(0, code)
    has(output, "3 verbs", "1. simulate (complete) in interval by lohner", "best suited: ", "2. equilibria (complete)",
      "3. roots (complete)", "the scene has no mechanism", "4 data: 3 fixed (also those of no width), 1 uncertain",
      "uncertain:       a [0.9899")
  end)

  it("lists who was tried where the first choice was not good enough", function()
    local _, output = explain [[
      local o = ambit.ode { states = { "y", "z" }, equations = function(s)
        return { y = -ambit.number(1), z = ambit.sqrt(s.y) }
      end }
      ambit.simulate { o, initial = { y = ambit.around(1, "1%"), z = 0 }, t = { 0, 1 } }]]
    has(output, "     tried: lohner: unable at t = ", "     tried: zonotope: unable at t = ")
  end)

  it("shows what a reduction has cut", function()
    local code, output = explain "scripts/reduce_arm.lua"
    assert.equal(0, code)
    has(output, " terms cut (", "each with a proof")
    assert.falsy(output:find "not asked for: the scene")
  end)

  it("explains what there was before an error, and ends with 1", function()
    local code, output, problem = explain [[
local m = ambit.mechanism "half"
local hand = m:rigid_link { from = m.world, offset = { 1, 0, 0 }, name = "hand" }
ambit.evaluate { m:position(hand) }
m:revolut { from = m.world }]]
    assert.equal(1, code)
    has(output, "1 verb, ended by an error", "1. evaluate (complete) in interval", "hand  ", 'mechanism "half"')
    has(problem, ":5:", "revolut", "revolute")
    code, output, problem = explain "local x = = 1"
    assert.equal(1, code)
    has(output, "0 verbs, ended by an error")
    has(problem, ":2:")
    code, _, problem = explain "/nonexistent/scene.lua"
    assert.equal(1, code)
    has(problem, "/nonexistent/scene.lua")
  end)

  it("takes a scene that leaves by os.exit for complete", function()
    local code, output = explain "ambit.evaluate { ambit.around(1, 0.1) } os.exit(3)"
    assert.equal(0, code)
    has(output, "1 verb\n")
  end)

  it("says which option it does not know and which file it cannot write, before the scene runs", function()
    local code, _, problem = explain("", "--jsn")
    assert.equal(2, code)
    has(problem, "did you mean `--json`?")
    code, _, problem = explain("error 'ran'", "--dot /nonexistent/x.dot")
    assert.equal(1, code)
    has(problem, "cannot write the file of --dot: /nonexistent/x.dot")
    assert.falsy(problem:find "ran")
  end)
end)

describe("the module ambit", function()
  it("reads the code of a verb when it is first called", function()
    local name = write [[
local ambit = require "ambit"
assert(type(ambit.reduce) == "function" and not package.loaded["ambit.reduce"])
local m = ambit.mechanism "m"
ambit.evaluate { m:position(m:rigid_link { from = m.world, offset = { 1, 0, 0 } }) }
for _, verb in ipairs { "simulate", "reduce", "reduce.certify", "verify", "compare", "sample", "view", "plot" } do
  assert(not package.loaded["ambit." .. verb], verb)
end
assert(select(2, pcall(ambit.reduce, 1)):find "reduce: expected a table" and package.loaded["ambit.reduce"])]]
    local pipe = io.popen(("'%s' run %s 2>&1"):format(command, name))
    local output = pipe:read "a"
    local good = pipe:close()
    os.remove(name)
    assert.is_true(good, output)
  end)

  it("lists all quantities that the parts of a mechanism have", function()
    local name = write [[
local ambit, core = require "ambit", require "ambit.core"
local m = ambit.mechanism { "m", gravity = { 0, "-9.81", 0 } }
local ball = m:spherical_quaternion { from = m.world, name = "ball" }
m:rigid_body { at = ball, mass = 1, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
m:dynamics()
local built, available = 0, 0
for part = 0, core.part_count(m.handle) - 1 do
  for _, q in ipairs(core.quantities(m.handle, part)) do
    built, available = built + (q.pulled and 1 or 0), available + 1
  end
end
local some, all = core.pulled(m.handle)
assert(built >= some and some > 0 and available == all, ("%d %d, %d %d"):format(built, some, available, all))
assert(not pcall(core.quantities, m.handle, 99) and not pcall(core.quantities, m.handle, -1))]]
    local pipe = io.popen(("'%s' run %s 2>&1"):format(command, name))
    local output = pipe:read "a"
    local good = pipe:close()
    os.remove(name)
    assert.is_true(good, output)
  end)
end)

describe("ambit explain --json", function()
  if not has_cjson then return pending "no cjson" end

  it("counts plugins, libraries and the memory they map", function()
    local by, code = records "scripts/manipulator.lua"
    local here = loaded(by)
    assert.equal(0, code)
    for name in pairs(here) do assert.falsy(name:find "^solver%." or name:find "gsl", name) end
    assert.is_true(here["libc.so.6"].mapped >= here["libc.so.6"].resident)
    assert.is_true(here["libc.so.6"].resident > 100000)
    assert.is_true(here["arithmetic.affine"].bytes > 10000)
    assert.is_true(#by.available > 50)
    assert.is_true(by.memory[1].peak >= by.memory[1]["end"])
  end)

  it("shows that a simulation in doubles loads no enclosing arithmetic", function()
    local by = records(decay .. 'ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 }, solver = "gsl" }')
    local here = loaded(by)
    assert.truthy(here["solver.gsl"] and here["arithmetic.real"])
    for _, name in ipairs { "interval", "affine", "gradient", "taylor_model", "mpfr" } do
      assert.falsy(here["arithmetic." .. name], name)
      assert.falsy(here[name .. ".so"], name)
    end
  end)

  it("counts what was asked of the graph, shared and folded", function()
    local by = records [[
      local x = ambit.around(1, 0.1)
      local y = ambit.sin(x)          -- new
      local z = ambit.sin(x)          -- there already
      local w = (y + 0) * 1           -- folded, twice
      ambit.evaluate { y * w }]] -- new
    local graph = by.verb[1].graph
    assert.same({ 5, 1, 2 }, { graph.asked, graph.shared, graph.folded })
    assert.equal(1, by.verb[1].report.unknowns)
    assert.equal(2, by.verb[1].report.tape_instructions)
  end)

  it("tells Taylor coefficients that are computed from those known to be zero", function()
    local by = records [[
      local f = ambit.ode { states = { "x" }, parameters = { a = ambit.around(1, "1%") },
        equations = function(s, p) return { x = ambit.sin(p.a) * s.x } end }
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 }, solver = "lohner" }]]
    local report = by.verb[1].report
    assert.is_true(report.coefficients > 0 and report.skipped > 0 and report.constant_slots > 0)
    assert.equal("lohner", report.solver)
    assert.is_string(by.verb[1].because)
  end)

  it("says which data are uncertain, fixed or varying, and which verbs needed them", function()
    local by = records(decay .. [[
      local m = ambit.mechanism "m"
      local q = m:rigid_link { from = m.world, offset = { ambit.around(1, 0.1), ambit.time, 0 }, name = "link" }
      ambit.simulate { f, initial = { x = ambit.around(1, 0.5) }, t = { 0, 1 }, solver = "lohner" }
      ambit.evaluate { m:position(q).x }]])
    local kind, verbs = {}, {}
    for _, datum in ipairs(by.datum) do kind[datum.name], verbs[datum.name] = datum.kind, datum.verbs end
    assert.same({ "uncertain", "fixed", "fixed", "uncertain", "uncertain", "varying", "fixed" },
      { kind.a, kind.b, kind.c, kind["initial x"], kind["link.offset.x"], kind["link.offset.y"],
        kind["link.offset.z"] })
    assert.same({ "1", "1", "2" }, { verbs.a, verbs["initial x"], verbs["link.offset.x"] })
  end)

  it("tells quantities by name, stages, and why a scene failed", function()
    local by, code = records [[
      local m = ambit.mechanism { "m", gravity = { 0, 0, "-9.81" } }
      local q = m:revolute { from = m.world, axis = "y", name = "q" }
      m:point_mass { at = m:rigid_link { from = q, offset = { 1, 0, 0 } }, mass = 1 }
      m:dynamics()
      error "at last"]]
    assert.equal(1, code)
    local of = {}
    for _, q in ipairs(by.quantity) do of[q.name] = q end
    assert.is_true(of.acceleration.pulled > 0)
    assert.equal(0, of.momentum.pulled)
    local pulled, available = 0, 0
    for _, q in ipairs(by.quantity) do pulled, available = pulled + q.pulled, available + q.available end
    assert.same({ pulled, available }, { by.mechanism[1].pulled, by.mechanism[1].available })
    local stages = {}
    for i, stage in ipairs(by.stage) do stages[i] = stage.name end
    assert.equal("load script graph tape context open run close", table.concat(stages, " "))
    assert.equal("failed", by.result[1].status)
    has(by.result[1].reason, "at last")
  end)

  it("writes all parts, however many", function()
    local by = records [[
      local m = ambit.mechanism "chain"
      local at = m.world
      for i = 1, 1000 do at = m:rigid_link { from = at, offset = { 1, 0, 0 } } end
      ambit.evaluate { m:position(at) }]]
    assert.equal(1000, #by.part)
    assert.equal("to.pose", by.part[1000].built)
  end)
end)

describe("the graph of ambit explain", function()
  local scene = [[
local m = ambit.mechanism "arm \"5\""
local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
m:point_mass { at = tip, mass = 1, name = "idle" }
ambit.evaluate { m:position(tip), at = { q = 1 } }]]

  it("shows parts, quantities, verbs and what is left out, in the language of Graphviz", function()
    local code, output = explain(scene, "--dot -")
    assert.equal(0, code)
    has(output, "digraph scene {", 'label="q\\nrevolute\\ncoordinate q", class="joint"', 'label="pose 3 of 3"',
      'label="mechanism arm \\"5\\""', 'label="1. evaluate', 'label="arithmetic\\ninterval"')
    assert.truthy(output:find 'label="idle[^\n]*class="left"[^\n]*dashed[^\n]*gray')
    assert.truthy(output:find 'label="momentum 0 of 4", class="left"')
    assert.truthy(output:find 'label="%d+ solvers\\n[^\n]*gsl[^\n]*class="left"')
    assert.equal("}\n", output:sub(-2))
  end)

  it("is readable for a thousand parts", function()
    local _, output = explain([[
local m = ambit.mechanism "chain"
local at = m.world
for i = 1, 1000 do at = m:rigid_link { from = at, offset = { 1, 0, 0 } } end]], "--dot -")
    has(output, 'label="... and 992 more alike"')
    local _, lines = output:gsub("\n", "")
    assert.is_true(lines < 80, lines)
  end)

  it("is drawn by dot, with the numbers as tool tips", function()
    if not os.execute "command -v dot >/dev/null 2>&1" then return end
    local name = os.tmpname()
    local code, output, problem = explain(scene, "--svg " .. name)
    local svg = read(name)
    os.remove(name)
    assert.equal(0, code, problem)
    has(output, "1  In the process")
    has(svg, "<svg", "prefers-color-scheme: dark", "</svg>")
    assert.truthy(svg:find "<title>revolute `q`: %d of 14 quantities built")
    assert.falsy(svg:find "<title>n%d")
    local _, left = svg:gsub('class="node left"', "")
    assert.is_true(left > 5)
  end)

  it("says what to install where there is no dot, and writes --dot all the same", function()
    local name = os.tmpname()
    local code, _, problem = explain("error 'ran'", "--svg " .. name, "PATH=/nonexistent")
    assert.equal(1, code)
    has(problem, "needs the program `dot` of Graphviz", "apt install graphviz", "--dot FILE works without it")
    assert.falsy(problem:find "ran")
    code = explain(scene, "--dot " .. name, "PATH=/nonexistent")
    assert.equal(0, code)
    has(read(name), "digraph scene")
    os.remove(name)
  end)
end)
