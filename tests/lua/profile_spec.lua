-- The command profile: its sums add up, every verb, plugin and thread has its place, equations share what they share,
-- a scene that fails is profiled up to there, bad input. AMBIT_COMMAND is the command to test.
local ambit = require "ambit"
local core = require "ambit.core"
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function quoted(s) return "'" .. s:gsub("'", "'\\''") .. "'" end

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
  return text
end

local function shell(line)
  local out, problems = os.tmpname(), os.tmpname()
  local _, _, code = os.execute(("%s </dev/null >%s 2>%s"):format(line, out, problems))
  local stdout, stderr = read(out), read(problems)
  os.remove(out)
  os.remove(problems)
  return code, stdout, stderr
end

-- JSON of our own writing: names, numbers, arrays and objects only.
local function parse(text)
  local at = 1
  local value
  local function skip() at = text:find("%S", at) end
  local function string()
    local last = text:find('"', at + 1, true)
    while text:sub(last - 1, last - 1) == "\\" do last = text:find('"', last + 1, true) end
    local s = text:sub(at + 1, last - 1):gsub("\\u(%x%x%x%x)", function(x) return utf8.char(tonumber(x, 16)) end)
    at = last + 1
    return s
  end
  local function members(close, one)
    at = at + 1
    skip()
    while text:sub(at, at) ~= close do
      one()
      skip()
      if text:sub(at, at) == "," then at = at + 1 skip() end
    end
    at = at + 1
  end
  function value()
    skip()
    local c, t = text:sub(at, at), {}
    if c == '"' then return string() end
    if c == "[" then
      members("]", function() t[#t + 1] = value() end)
      return t
    elseif c == "{" then
      members("}", function()
        local key = string()
        skip()
        at = at + 1
        t[key] = value()
      end)
      return t
    end
    local word = text:match("^[%w.+-]+", at)
    at = at + #word
    if word == "true" or word == "false" then return word == "true" end
    return assert(tonumber(word), word)
  end
  return value()
end

-- The profile of a scene, exit code, standard error.
local function profile(text, words)
  local file = write(text)
  local code, stdout, stderr = shell(("%s profile --json - %s %s"):format(quoted(command), quoted(file), words or ""))
  os.remove(file)
  return stdout ~= "" and parse(stdout) or nil, code, stderr
end

local function each(frame, f, depth)
  f(frame, depth or 0)
  for _, inner in ipairs(frame.frames) do each(inner, f, (depth or 0) + 1) end
end

local function named(frame, kind, name)
  local found
  each(frame, function(f) if f.kind == kind and f.name:find(name, 1, true) then found = found or f end end)
  return found
end

local function by_name(list)
  local t = {}
  for _, entry in ipairs(list) do t[entry.name] = entry end
  return t
end

local ode = [[
local ambit = require "ambit"
local around = ambit.around
local f = ambit.ode { states = { "phi", "omega" },
  equations = function(s) return { phi = s.omega, omega = -ambit.sin(s.phi) - s.omega ^ 3 } end }
local function run(settings)
  settings[1], settings.initial, settings.t = f, { phi = around(1, "1%"), omega = 0 }, { 0, 2 }
  return ambit.simulate(settings)
end
]]

local arm = [[
local ambit = require "ambit"
local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
]]

-- Own times of all frames make the whole, and so do the stages.
local function check_sums(p)
  local sum, stages = 0, 0
  each(p.frames, function(f)
    assert.is_true(f.self >= 0 and f.cost >= 0 and f.count >= 1)
    sum = sum + f.self
  end)
  for _, s in ipairs(p.stages) do stages = stages + s.self end
  assert.is_true(math.abs(sum - p.total) <= 1e-6 * p.total)
  assert.is_true(math.abs(stages - p.total) <= 1e-6 * p.total)
  -- what this thread did, what measuring cost and what is unaccounted for is the time that went by
  assert.is_true(math.abs(p.total + p.cost - p.others + p.unaccounted - p.wall_seconds) <= 0.02 * p.wall_seconds)
  assert.is_true(p.unaccounted <= 0.03 * p.wall_seconds)
end

describe("the profile", function()
  it("adds up, for every solver", function()
    local p, code = profile(ode .. [[
      for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff", "gsl" } do run { solver = solver } end]])
    assert.equal(0, code)
    check_sums(p)
    for _, solver in ipairs { "lohner", "taylor_model", "valencia", "stiff", "gsl" } do
      local verb = assert(named(p.frames, "verb", "simulate " .. solver))
      assert.truthy(named(verb, "stage", "run"))
      assert.truthy(named(verb, "solver", solver))
      assert.truthy(named(verb, "operation", "NEG"))
      assert.truthy(named(verb, "operation", "SIN") or named(verb, "operation", "COS"))
    end
    local stages = by_name(p.stages)
    for _, stage in ipairs { "script", "model", "graph", "tape", "open", "run", "records", "load" } do
      assert.truthy(stages[stage], stage)
    end
    assert.truthy(named(p.frames, "service", "jet.solve"))
    assert.equal(5, #p.verbs)
    assert.equal(5, #p.verbs_ended)
    assert.falsy(p.is_cut)
  end)

  it("divides what is shared between equations", function()
    local p = profile(ode .. [[run { solver = "lohner" }]])
    local verb = p.verbs[1]
    local equations = by_name(verb.equations)
    local sum = 0
    for _, e in ipairs(verb.equations) do sum = sum + e.self end
    assert.is_true(math.abs(sum - verb.operations) <= 1e-6 * verb.operations)
    assert.is_true(equations.omega.self > 0.99 * sum) -- phi' = omega needs no operation
    assert.equal(0, equations.phi.self)
    assert.equal(0, #equations.omega.with)
    local shared = profile([[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x", "y" }, equations = function(s)
        local r = ambit.sin(s.x * s.y)
        return { x = -r, y = r * s.x }
      end }
      ambit.simulate { f, initial = { x = 1, y = 1 }, t = { 0, 1 }, solver = "lohner" }]]).verbs[1]
    for i, e in ipairs(shared.equations) do
      assert.is_true(e.shared > 0 and e.own > 0)
      assert.equal(i == 1 and "y" or "x", e.with[1].name)
    end
  end)

  -- A series' products inside the rule of a sine are the sine's, whoever computes them; what is no instruction at all
  -- (integrals of series, curves of a solver) is no opcode of the tape's, so equations don't pay for it.
  it("gives opcodes what their rules do, and nothing else", function()
    for _, settings in ipairs { 'solver = "lohner", arithmetic = "affine"', 'solver = "lohner", arithmetic = "gradient"',
      'solver = "lohner", arithmetic = "interval"', 'solver = "valencia", arithmetic = "interval"',
      'solver = "valencia", arithmetic = "affine"', 'solver = "taylor_model"' } do
      local p = profile([[
        local ambit = require "ambit"
        local f = ambit.ode { states = { "x", "y" },
          equations = function(s) return { x = s.y, y = -ambit.sin(s.x) } end }
        ambit.simulate { f, initial = { x = ambit.around(1, "1%"), y = 0 }, t = { 0, "0.2" }, ]] .. settings .. " }")
      local other = 0
      for _, op in ipairs(p.operations) do
        assert.truthy(({ sin = true, cos = true, neg = true, other = true })[op.name], settings .. ": " .. op.name)
        if op.name == "other" then other = op.self end
      end
      local verb, sum = p.verbs[1], 0
      for _, e in ipairs(verb.equations) do sum = sum + e.self end
      assert.is_true(math.abs(sum + other - verb.operations) <= 1e-6 * verb.operations, settings)
    end
  end)

  it("knows mechanisms, evaluations, equilibria, reductions, draws and properties", function()
    local p, code, problems = profile(arm .. [[
      for _, arithmetic in ipairs { "real", "interval", "affine", "taylor_model" } do
        ambit.evaluate { m:position(elbow), at = { a = ambit.around(1, "1%") }, arithmetic = arithmetic }
      end
      ambit.equilibria { m:dynamics(), box = { a = { "-3", "3" } } }
      ambit.sample { m:position(elbow), at = { a = ambit.around(1, "1%") }, n = 100 }
      ambit.verify { m:dynamics(), initial = { a = "0.1", ["a'"] = 0 }, t = { 0, "0.1" },
        safe = { near = m:position(elbow).x - 1 } }
      local f = ambit.ode { states = { "x" },
        equations = function(s) return { x = -s.x + "1e-6" * s.x ^ 2 } end }
      ambit.reduce { f, t = { 0, 1 }, initial = { x = 1 }, outputs = { "x" }, error = { x = "0.1" } }
    ]])
    assert.equal("", problems)
    assert.equal(0, code)
    check_sums(p)
    assert.truthy(named(p.frames, "element", "revolute"))
    assert.truthy(named(p.frames, "element", "point_mass"))
    assert.truthy(named(p.frames, "load", "rigid_link"))
    for _, arithmetic in ipairs { "real", "interval", "affine", "taylor_model" } do
      local sines = false -- others evaluate in intervals too
      each(p.frames, function(f)
        local is = f.kind == "verb" and f.name:find("evaluate " .. arithmetic, 1, true)
        sines = sines or (is and named(f, "operation", "SIN") ~= nil)
      end)
      assert.is_true(sines, arithmetic)
    end
    local roots = assert(named(p.frames, "verb", "roots krawczyk"))
    assert.truthy(named(roots, "service", "contract.narrow"))
    assert.truthy(named(roots, "service", "num.matmul"))
    assert.truthy(named(p.frames, "verb", "watch"))
    assert.truthy(named(p.frames, "verb", "sample_expressions"))
    local reduction = assert(named(p.frames, "verb", "reduce"))
    assert.truthy(named(reduction, "stage", "proof"))
  end)

  it("joins the frames of threads", function()
    local p = profile(ode .. [[run { solver = "lohner", threads = 2, split = { phi = 6 } }]])
    check_sums(p)
    local items = assert(named(p.frames, "thread", "item of a pool"))
    assert.equal(6, items.count)
    assert.truthy(named(items, "solver", "lohner"))
    assert.is_true(p.others >= items.total)
  end)

  it("stays in order when errors pass", function()
    local p, code = profile(ode .. [[
      for i = 1, 50 do
        assert(not pcall(ambit.evaluate, { "nonsense" }))
        assert(not pcall(run, { solver = "lohner", tolerance = -1 }))
      end
      run { solver = "lohner" }]])
    assert.equal(0, code)
    check_sums(p)
    local deepest = 0
    each(p.frames, function(_, depth) deepest = math.max(deepest, depth) end)
    assert.is_true(deepest < 12)
  end)
end)

describe("the command profile", function()
  it("writes whole letters, also of names that were cut", function()
    local scene, folded = os.tmpname(), os.tmpname()
    os.remove(scene)
    scene = scene .. ("\u{3b1}"):rep(60) .. "b.lua" -- of which an odd number of bytes fits
    local file = assert(io.open(scene, "w"))
    file:write(ode .. [[run { solver = "lohner" }]])
    file:close()
    local code, stdout = shell(("%s profile --folded %s %s"):format(quoted(command), folded, quoted(scene)))
    local stacks = read(folded)
    os.remove(scene)
    os.remove(folded)
    assert.equal(0, code)
    assert.truthy(stacks:find "\u{3b1}")
    assert.truthy(utf8.len(stacks))
    assert.truthy(utf8.len(stdout))
  end)

  it("prints tables, bars and folded stacks", function()
    local scene, folded = write(ode .. [[run { solver = "lohner" } print "not seen"]]), os.tmpname()
    local code, stdout, stderr = shell(("%s profile --folded %s %s"):format(quoted(command), folded, quoted(scene)))
    assert.equal(0, code)
    assert.equal("", stderr)
    for _, words in ipairs { "profile of ", "stages", "opcodes", "equations of simulate lohner", "solver lohner",
      "unaccounted", "100.0 %", "####", "apportioned" } do
      assert.truthy(stdout:find(words, 1, true), words)
    end
    assert.falsy(stdout:find("not seen", 1, true))
    local lines, sum = 0, 0
    for line in read(folded):gmatch "[^\n]+" do
      local stack, us = line:match "^(.+) (%d+)$"
      assert.truthy(stack, line)
      assert.equal("script", stack:match "^[^;]+")
      lines, sum = lines + 1, sum + tonumber(us)
    end
    assert.is_true(lines > 10 and sum > 0)
    os.remove(scene)
    os.remove(folded)
  end)

  it("takes a scene whose hook calls Ambit between a function and its frame", function()
    local p, code, stderr = profile(ode .. [[
local x = ambit.around(1, "1%")
debug.sethook(function() return x + 1 end, "cr")
run { solver = "lohner" }
debug.sethook()]])
    assert.equal("", stderr)
    assert.equal(0, code)
    assert.truthy(named(p.frames, "verb", "simulate lohner"))
    check_sums(p)
  end)

  it("profiles a scene that fails until it fails", function()
    local p, code, stderr = profile(ode .. [[run { solver = "lohner" } error "broken here"]])
    assert.equal(1, code)
    assert.truthy(stderr:find("broken here", 1, true))
    assert.truthy(p.problem:find("broken here", 1, true))
    assert.truthy(named(p.frames, "verb", "simulate lohner"))
    check_sums(p)
  end)

  it("refuses bad input before it starts", function()
    local scene = write "error 'it ran'"
    local function refused(words)
      local code, _, stderr = shell(("%s profile %s"):format(quoted(command), words))
      assert.falsy(stderr:find("it ran", 1, true))
      return code, stderr
    end
    local code, stderr = refused("--jsn x " .. quoted(scene))
    assert.equal(2, code)
    assert.truthy(stderr:find("`--json`", 1, true))
    code = refused ""
    assert.equal(2, code)
    code, stderr = refused("--json /nowhere/at/all " .. quoted(scene))
    assert.equal(1, code)
    assert.truthy(stderr:find("cannot write the file of --json: /nowhere/at/all", 1, true))
    code, stderr = refused "/nowhere/scene.lua"
    assert.equal(1, code)
    assert.truthy(stderr:find("/nowhere/scene.lua", 1, true))
    os.remove(scene)
  end)
end)

describe("counted work", function()
  local function report_of(settings)
    local session = require "ambit.session"
    local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
    ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 }, solver = settings }
    return session.last.report
  end

  it("is in every report, with its meaning", function()
    local r = report_of "lohner"
    for _, entry in ipairs(core.work) do
      assert.equal("integer", math.type(r[entry[1]]), entry[1])
      assert.is_true(#entry[2] > 10)
    end
    assert.is_true(r.coefficients > 0 and r.orders > 0 and r.tried >= r.steps)
    assert.equal(0, r.allocations_run)
    for _, key in ipairs { "graph", "tape", "context", "open", "close", "build", "run" } do
      assert.is_true(r["seconds_" .. key] >= 0)
    end
  end)

  it("is the same for the same question", function()
    local a, b = report_of "taylor_model", report_of "taylor_model"
    for _, entry in ipairs(core.work) do assert.equal(a[entry[1]], b[entry[1]], entry[1]) end
  end)

  it("takes one profile at a time", function()
    assert.has_error(core.profile_end)
    core.profile_begin()
    assert.has_error(core.profile_begin)
    local root, is_cut, wall = core.profile_end()
    assert.equal("script", root.kind)
    assert.is_false(is_cut)
    assert.is_true(wall > 0)
  end)
end)
