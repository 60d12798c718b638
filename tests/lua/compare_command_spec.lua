-- `ambit compare` on scenes that simulate: what it finds in a scene, its files, Ctrl-C. AMBIT_COMMAND is the command.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

local function count(text, piece)
  local n = 0
  for _ in text:gmatch(piece) do n = n + 1 end
  return n
end

local function write(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

local function read(name)
  local file = io.open(name)
  if not file then return nil end
  local text = file:read "a"
  file:close()
  os.remove(name)
  return text
end

local head = [[
local ambit = require "ambit"
local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
]]
local grid = [[
ambit.compare { solvers = { { "lohner", order = { 6, 12 } }, "gsl" } }
]]

-- Runs the command on a scene -> exit code, stdout, stderr; before: a shell command in front of it, such as VAR=value
local function scene(text, options, before)
  local file, out, problems = write(text), os.tmpname(), os.tmpname()
  local _, _, code = os.execute(("%s '%s' compare %s %s >%s 2>%s"):format(before or "", command, options or "", file,
    out, problems))
  os.remove(file)
  return code, read(out), read(problems)
end

describe("ambit compare on what a scene simulates", function()
  it("repeats every question once, of evaluate and of simulate", function()
    local code, stdout, stderr = scene(head .. grid .. [[
      for _, solver in ipairs { "lohner", "valencia" } do
        ambit.simulate { f, initial = { x = "[1, 2]" }, t = { 0, 1 }, solver = solver }
      end
      local x = ambit.between(1, 2)
      ambit.simulate { f, initial = { x = x }, t = { 0, 2 } }
      ambit.evaluate { x * x }]], "--quick")
    assert.equal(0, code, stderr)
    has(stdout, "1. ", "evaluate: 1 result", "2. ", "simulate: 1 state of 1 uncertain datum from t = 0 to 1",
      "asked for 2 times", "3. ", "from t = 0 to 2", "lohner order=12", "gsl", "proves nothing", "/ sampled",
      "Use lohner")
    assert.falsy(stdout:find("4. ", 1, true))
    for line in stdout:gmatch "[^\n]+" do assert.is_true(utf8.len(line) <= 120, line) end
    assert.equal("", stderr)
  end)

  it("tells questions apart that differ in how data go together", function()
    local code, stdout = scene([[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x", "y" }, equations = function(s) return { x = s.y, y = -s.x } end }
      ambit.compare { solvers = { "lohner" } }
      local a = ambit.between(1, 2)
      ambit.simulate { f, initial = { a, a }, t = 1 }
      ambit.simulate { f, initial = { a, ambit.between(1, 2) }, t = 1 }
      ambit.simulate { f, initial = { ambit.between(1, 2), ambit.between(1, 2) }, t = 1 }]], "--quick")
    assert.equal(0, code)
    assert.equal(2, count(stdout, "simulate: "))
    has(stdout, "2 states of 1 uncertain datum", "2 states of 2 uncertain data", "asked for 2 times")
  end)

  it("writes a line of CSV for each combination and state, records, a picture, a page", function()
    local csv, html, svg, json = os.tmpname(), os.tmpname(), os.tmpname(), os.tmpname()
    local code, _, stderr = scene(head .. grid .. "ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 } }",
      ("--quick --csv %s --html %s --json %s --svg %s"):format(csv, html, json, svg))
    assert.equal(0, code, stderr)
    local text = read(csv)
    assert.equal(1 + 3, count(text:gsub("#[^\n]*\n", ""), "\r\n"))
    has(text, "1,simulate,", ",lohner,interval,order=12,yes,complete,,1,x,0.3678794", ",gsl,real,,no,complete,,1,x,")
    has(read(html), "<html", "lohner order=12")
    text = read(json)
    assert.equal(4, count(text:gsub('{"record":"p[rl][ou][vg][^\n]*\n', ""), "\n")) -- without provenance, plugins
    has(text, '"solver":"lohner"', '"error":', '"t_reached":1', '"verb":"compare"')
    text = read(svg)
    has(text, "<svg", "largest distance from the reference", "lohner, by order")
  end)

  it("compares what was asked before os.exit, before an error, and inside a callback", function()
    local question = grid .. "ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 } } "
    local code, stdout = scene(head .. question .. "os.exit(5)", "--quick")
    assert.equal(0, code)
    has(stdout, "lohner order=6")
    local stderr
    code, stdout, stderr = scene(head .. question .. "error 'too bad'", "--quick")
    assert.equal(1, code)
    has(stdout, "lohner order=6")
    has(stderr, "too bad", "before it failed")
    code, stdout = scene(head .. grid .. [[
      ambit.ode { states = { "y" }, equations = function(s)
        ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 } }
        return { y = s.y }
      end }]], "--quick")
    assert.equal(0, code)
    has(stdout, "lohner order=6")
  end)

  it("goes on where one question cannot be compared", function()
    local code, stdout, stderr = scene(head .. [[
      ambit.compare { solvers = { "lohner" }, reference = { t = 1, x = { x = "0.36788" } } }
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 } }
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 2 } }]], "--quick")
    assert.equal(1, code, stderr) -- a proof and a reference that contradict each other
    has(stdout, "misses the reference", "from t = 0 to 2")
  end)

  it("says that an enclosure reached its end nowhere, with exit code 3", function()
    local code, stdout = scene([[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x * s.x } end }
      ambit.compare { solvers = { "lohner", "valencia" } }
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 2 } }]], "--quick")
    assert.equal(3, code)
    has(stdout, "unable", "no combination proved the simulation to its end", "came farthest")
  end)

  it("keeps what was done when it is interrupted", function()
    local csv, html, mark = os.tmpname(), os.tmpname(), os.tmpname()
    os.remove(mark)
    -- the third combination would take very long; the signal comes when it runs, which its files say
    local text = head .. [[
      ambit.compare { solvers = { "gsl", "lohner", { "lohner", step_max = 1e-7 }, "valencia" } }
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 } }
      local run, simulate = 0, require "ambit.simulate"
      local solve = simulate.solve
      simulate.solve = function(q)
        if table.concat(q.options, " "):find "step_max" then io.open("]] .. mark .. [[", "w"):close() end
        return solve(q)
      end]]
    local file, out = write(text), os.tmpname()
    local _, _, code = os.execute(([['%s' compare --limit 60 --csv %s --html %s %s >%s 2>&1 & pid=$!
      i=0; while [ ! -e %s ] && [ $i -lt 600 ]; do sleep 0.1; i=$((i + 1)); done
      kill -INT $pid; wait $pid]]):format(command, csv, html, file, out, mark))
    os.remove(file)
    os.remove(mark)
    local stdout, lines = read(out), read(csv)
    assert.equal(130, code, stdout)
    has(stdout, "interrupted: what was compared until then is kept")
    has(lines, ",gsl,real,,no,complete,", ",lohner,interval,,yes,complete,",
      ",valencia,interval,,yes,skipped,interrupted")
    assert.truthy(lines:find ",step_max=[^,]+,yes,s[a-z]+,interrupted")
    has(read(html), "<html")
  end)

  it("tells bad options and files before any work", function()
    local code, stdout, stderr = scene(head .. "print 'ran'", "--html /nonexistent/page.html")
    assert.equal(1, code)
    has(stderr, "--html", "/nonexistent/page.html")
    assert.equal("", stdout)
    code, _, stderr = scene(head, "--csv /tmp/one --html /tmp/one")
    assert.equal(1, code)
    has(stderr, "--csv and --html name the same file")
    code, stdout, stderr = scene(head .. "ambit.simulate { f, initial = { x = 1 }, t = 1 }", "--repeat -3")
    assert.equal(1, code)
    has(stderr, "repeats", "positive integer", "-3")
    code, _, stderr = scene(head .. "ambit.compare { solvers = { 'lohnr' } }")
    assert.equal(1, code)
    has(stderr, "lohnr", "`lohner`")
    code, _, stderr = scene(head, "--fast")
    assert.equal(2, code)
    has(stderr, "--fast")
  end)
end)
