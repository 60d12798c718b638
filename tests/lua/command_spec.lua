-- The command line: exit codes, messages, JSON lines. AMBIT_COMMAND is the command to test.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function quoted(s) return "'" .. s:gsub("'", "'\\''") .. "'" end

local function write(text, name)
  name = name or os.tmpname()
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

-- run(words, input) -> exit code, stdout, stderr
local function run(words, input)
  local out, problems, source = os.tmpname(), os.tmpname(), write(input or "")
  local _, _, code = os.execute(("%s %s <%s >%s 2>%s"):format(quoted(command), words, source, out, problems))
  local stdout, stderr = read(out), read(problems)
  for _, name in ipairs { out, problems, source } do os.remove(name) end
  return code, stdout, stderr
end

local function scene(text, options, words)
  local file = write(text)
  local code, stdout, stderr = run(("run %s %s %s"):format(options or "", file, words or ""))
  os.remove(file)
  return code, stdout, stderr, file
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

describe("a scene from standard input", function()
  local function piped(words, text)
    local line = [[printf %%s '%s' | ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0" '%s' %s 2>&1]] -- not in a sandbox
    local pipe = io.popen(line:format(text, command, words))
    local output = pipe:read "a"
    local _, _, code = pipe:close()
    return code, output
  end

  it("is run, with its words, in a sandbox too", function()
    for _, words in ipairs { "run - one", "run --sandbox - one" } do
      local code, output = piped(words, [[print(require "ambit".interval(1, 2):width(), arg[0], arg[1])]])
      assert.equal(0, code, output)
      assert.equal("1.0\t-\tone\n", output)
    end
  end)

  it("is named where it is wrong", function()
    local code, output = piped("run -", [[local a = 1
error "wrong"]])
    assert.equal(1, code)
    assert.truthy(output:find("standard input:2: wrong", 1, true), output)
  end)
end)

describe("ambit", function()
  it("says when standard output is full", function()
    local device = io.open("/dev/full", "w")
    if not device then return print "there is no /dev/full: not tried" end
    device:close()
    local file, problems = write 'print "hello"', os.tmpname()
    local records = os.tmpname()
    for _, place in ipairs { ">/dev/full", ">&-" } do
      local _, _, code = os.execute(("%s run --json %s %s %s 2>%s"):format(quoted(command), records, file, place, problems))
      assert.equal(1, code)
      has(read(problems), "not everything could be written to standard output")
      has(read(records):match "[^\n]+\n$", '"exit":1', "not everything could be written to standard output")
    end
    os.remove(file)
    os.remove(problems)
    os.remove(records)
  end)

  it("says what it can do", function()
    local code, stdout = run "--help"
    assert.equal(0, code)
    has(stdout, "run", "explain", "plugins", "test", "repl", "exit codes")
    for _, name in ipairs { "run", "explain", "plugins", "test", "repl" } do
      code, stdout = run(name .. " --help")
      assert.equal(0, code)
      has(stdout, "usage: ambit " .. name)
    end
    code, stdout = run "--version"
    assert.equal(0, code)
    assert.truthy(stdout:find "^ambit %d+%.%d+%.%d+\n$")
  end)

  it("hints at what is meant", function()
    for scene, hint in pairs {
      ["ambit.ode {}"] = ": a scene begins with: local ambit = require \"ambit\"",
      ["require 'ambit'.simulat {}"] = ": is `ambit.simulate` meant?",
      ["simulate {}"] = ": is `ambit.simulate` meant?",
      ["local ambit = require 'ambit' math.sin(ambit.around(1, .1))"] = "; ambit.sin takes every value of Ambit's",
      ["unheard_of()"] = "(global 'unheard_of')",
      ["string.unheard_of()"] = "(field 'unheard_of')",
    } do
      local file = write(scene)
      local code, _, stderr = run("run " .. file)
      assert.equal(1, code)
      assert.equal(hint, stderr:match("^[^\n]*"):sub(-#hint))
      os.remove(file)
    end
  end)

  it("ends with 2 on wrong usage", function()
    for _, words in ipairs { "", "rnu", "--hlep", "run", "run --jsn x.lua", "run --json", "explain", "plugins a b",
      "repl x", "test --x" } do
      local code, stdout, stderr = run(words)
      assert.equal(2, code, words)
      assert.equal("", stdout)
      has(stderr, "ambit: ")
    end
    local _, _, stderr = run "rnu"
    has(stderr, "did you mean `run`")
  end)
end)

describe("ambit run", function()
  it("passes words to the scene and ends with 0", function()
    local code, stdout = scene("print(arg[1], arg[2], ...)", "", "a 'b c'")
    assert.equal(0, code)
    assert.equal("a\tb c\ta\tb c\n", stdout)
    code, stdout = scene("print(arg[1])", "", "--help")
    assert.equal(0, code)
    assert.equal("--help\n", stdout)
  end)

  it("says so where an option of its own went to the scene", function()
    local code, stdout, stderr = scene("print(arg[1], arg[2])", "", "--json -")
    assert.equal(0, code)
    assert.equal("--json\t-\n", stdout)
    has(stderr, "note: `--json` stands behind the scene")
    for _, options in ipairs { "--quiet", "" } do
      code, _, stderr = scene("", options, options == "" and "--other" or "--json -")
      assert.equal(0, code)
      assert.equal("", stderr)
    end
  end)

  it("ends with 1, a message and a traceback on errors", function()
    local text = "local ambit = require 'ambit'\nlocal function f() ambit.interval(2, 1) end\nf()"
    local code, _, stderr, file = scene(text)
    assert.equal(1, code)
    has(stderr, file .. ":2: interval: the bounds are reversed", "stack traceback", file .. ":3:")
    code, _, stderr = scene "error { code = 3 }"
    assert.equal(1, code)
    has(stderr, "ambit: ")
    code, _, stderr, file = scene "local = 3"
    assert.equal(1, code)
    has(stderr, file .. ":1:")
    code, _, stderr = run "run /nonexistent/scene.lua"
    assert.equal(1, code)
    has(stderr, "/nonexistent/scene.lua")
  end)

  it("ends with 3 if something could not be proved", function()
    local code, stdout, stderr = scene [[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
      print(ambit.simulate({ f, initial = { x = 1 }, t = { 0, 2 } }).status)]]
    assert.equal(3, code)
    assert.equal("unable\n", stdout)
    has(stderr, "not everything could be proved")
    code = scene [[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
      ambit.simulate { f, initial = { x = 1 }, t = { 0, 2 } }
      error "and then"]]
    assert.equal(1, code)
  end)

  it("writes records as JSON lines that round-trip", function()
    local found, json = pcall(require, "cjson")
    if not found then return end
    local name = os.tmpname()
    local text = [[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
      local run = ambit.simulate { f, initial = { x = "0.1" }, t = { 0, 1 } }
      print(("%.17g %.17g"):format(run.x.x.lo, run.x.x.hi))
      ambit.evaluate { { a = ambit.pi } }]]
    local code, stdout = scene(text, "--json " .. name)
    assert.equal(0, code)
    local records = {}
    for line in io.lines(name) do records[#records + 1] = json.decode(line) end
    os.remove(name)
    local kinds = {}
    for i, r in ipairs(records) do kinds[i] = r.record end
    local last_step
    for _, r in ipairs(records) do if r.record == "step" then last_step = r end end
    assert.equal(stdout, ("%.17g %.17g\n"):format(last_step.x.x[1], last_step.x.x[2]))
    assert.equal("end", kinds[#kinds]) -- the last one says that none is missing
    assert.equal(0, records[#records].exit)
    records[#records], kinds[#kinds] = nil, nil
    assert.equal("result", kinds[#kinds])
    assert.equal("value", kinds[#kinds - 1])
    assert.equal("evaluate", records[#records].verb)
    assert.equal("complete", records[#records].status)
    assert.equal("simulate", records[#records - 2].verb)
    assert.equal(1, records[#records - 2].t_reached)
    assert.equal("lohner", records[#records - 2].settings.solver)
    assert.is_number(records[#records - 2].cpu_seconds)
    -- on standard output: nothing else there
    code, stdout = scene(text, "--json -")
    assert.equal(0, code)
    for line in stdout:gmatch "[^\n]+" do assert.is_string(json.decode(line).record) end
  end)

  it("keeps the records that were written before an error", function()
    local found, json = pcall(require, "cjson")
    if not found then return end
    local code, stdout = scene([[
      local ambit = require "ambit"
      ambit.evaluate { ambit.pi }
      error "later"]], "--json -")
    assert.equal(1, code)
    local kinds = {}
    for line in stdout:gmatch "[^\n]+" do
      local kind = json.decode(line).record
      if kind ~= "plugin" then kinds[#kinds + 1] = kind end
    end
    assert.same({ "provenance", "value", "result", "end" }, kinds)
    has(stdout, '"record":"end","code":"invalid","exit":1')
  end)

  it("says when records cannot be written", function()
    local code, _, stderr = scene("", "--json /nonexistent/records")
    assert.equal(1, code)
    has(stderr, "/nonexistent/records")
  end)

  it("is interrupted by Ctrl-C in plain Lua", function()
    local file = write "io.write 'on'\nio.flush()\nwhile true do end"
    local out = os.tmpname()
    local _, _, code = os.execute(("timeout -s INT 1 %s run %s >%s 2>&1"):format(quoted(command), file, out))
    local text = read(out)
    os.remove(file)
    os.remove(out)
    assert.equal(124, code) -- timeout's own: the command ended within its signal
    has(text, "interrupted", file .. ":3:")
  end)

  it("stops a simulation on Ctrl-C, keeps its steps and goes on", function()
    local file = write [[
      local ambit = require "ambit"
      local f = ambit.ode { states = { "x" }, equations = function(s, _, t) return { x = ambit.sin(t) - s.x } end }
      local run = ambit.simulate { f, initial = { x = 1 }, t = { 0, 1e9 } } -- contracting: provable for ever
      print(run.status, run.step_count > 0, run.t_reached > 0)]]
    local out = os.tmpname()
    local words = "timeout --preserve-status -s INT 1 %s run --quiet %s >%s 2>&1"
    local _, _, code = os.execute(words:format(quoted(command), file, out))
    local text = read(out)
    os.remove(file)
    os.remove(out)
    assert.equal(130, code)
    has(text, "stopped\ttrue\ttrue", "interrupted")
  end)
end)

describe("ambit plugins", function()
  it("lists without loading and prints manuals", function()
    local code, stdout = run "plugins"
    assert.equal(0, code)
    has(stdout, "arithmetic", "interval", "real")
    code, stdout = run "plugins interval"
    assert.equal(0, code)
    has(stdout, "arithmetic interval, version")
    code, stdout = run "plugins rigid_link"
    assert.equal(0, code)
    has(stdout, "ports", "from", "parameters", "offset")
    local stderr
    code, _, stderr = run "plugins intervl"
    assert.equal(1, code)
    has(stderr, "`interval`")
  end)
end)

describe("ambit repl", function()
  it("prints values, takes several lines, survives errors", function()
    local code, stdout, stderr = run("repl",
      "= sqrt(interval(4))\nfor i = 1, 2 do\nprint(i) end\nx = 3\nx + 1\nfoo()\n'after'\n")
    has(stdout, "2\n", "1\n2\n", "4\n", "after\n")
    has(stderr, "foo")
    assert.equal(1, code)
    code, stdout = run("repl", "pi\n")
    assert.equal(0, code)
    has(stdout, "pi  in [3.14159265358979")
  end)
end)

describe("ambit test", function()
  it("ends with 1 if a test fails and with 0 if none does", function()
    local name = os.tmpname()
    os.remove(name)
    name = name .. "_spec.lua"
    write("describe('x', function() it('y', function() assert.equal(1, 1) end) end)", name)
    assert.equal(0, (run("test " .. name)))
    write("describe('x', function() it('y', function() assert.equal(1, 2) end) end)", name)
    assert.equal(1, (run("test " .. name)))
    os.remove(name)
  end)
  it("says what to install if busted is missing", function()
    local out = os.tmpname()
    local _, _, code = os.execute(("LUA_PATH=/nonexistent/?.lua %s test >%s 2>&1"):format(quoted(command), out))
    local text = read(out)
    os.remove(out)
    assert.equal(1, code)
    has(text, "busted", "apt install lua-busted")
  end)
end)
