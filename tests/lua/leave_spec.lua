-- Nothing but the command gives exit code 0 (findings S7), and what ends it is said. AMBIT_COMMAND is the command to
-- test; solver.faulty (plugins/faulty.c) ends as its option says.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

-- Lua never finalises what is made while it closes: memory that the end of the process takes back is no leak then.
local no_leaks = 'ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0"'

local function read(name)
  local file = io.open(name)
  local text = file and file:read "a" or ""
  if file then file:close() end
  os.remove(name)
  return text
end

local function write(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

-- Runs a scene, `before` the command: exit code, all output, records.
local function run(text, before)
  local name, out, records = write([[local ambit = require "ambit"
    local drift = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }
    local function faulty(fault)
      return ambit.simulate { drift, initial = { 0 }, t = { 0, 1 }, solver = "faulty", fault = fault }
    end
    ]] .. text), os.tmpname(), os.tmpname()
  local _, how, code = os.execute(("( %s '%s' run --quiet --json %s %s ) >%s 2>&1"):format(before or "", command, records,
    name, out))
  os.remove(name)
  return how == "exit" and code or how .. code, read(out), read(records)
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

describe("ambit run", function()
  it("ends with 1 and a sentence where a plugin calls exit(0)", function()
    local code, output, records = run 'faulty "leave"'
    assert.equal(1, code)
    has(output, "ended the process by exit()", "invalid.exit")
    assert.falsy(records:find('"record":"end"', 1, true)) -- what is there is incomplete, and one can see that
  end)

  it("ends by os.exit with at least the exit code of its verbs, and writes the last record", function()
    for _, case in ipairs { { 'faulty "unsure" os.exit(0)', 3 }, { 'faulty "unsure" os.exit(true)', 3 },
      { 'faulty "unsure" os.exit(5)', 5 }, { 'faulty "fine" os.exit(0)', 0 }, { 'faulty "fine" os.exit(false)', 1 },
      { 'faulty "unsure" pcall(os.exit)', 3 },
      { 'faulty "fine" os.exit(256)', 1 }, { 'faulty "unsure" os.exit(512)', 1 }, { 'faulty "fine" os.exit(-256)', 1 },
      { 'faulty "fine" os.exit(259)', 3 }, { 'faulty "fine" coroutine.wrap(os.exit)(7)', 7 } } do
      local code, output, records = run(case[1])
      assert.equal(case[2], code, case[1] .. output)
      has(records, ('"exit":%d'):format(case[1]:find "259" and 259 or case[2]))
    end
  end)

  it("counts the verbs of finalisers, also of those that run while Lua closes", function()
    local late = 'keep = setmetatable({}, { __gc = function() faulty "%s" end }) %s'
    for _, case in ipairs { { "unsure", "", 3, "unable.width" }, { "inverted", "", 1, "broken.bounds" },
      { "nothing", "", 4, "domain.constraint" }, { "fine", "", 0 }, { "nothing", 'faulty "unsure"', 3 },
      { "unsure", "keep = nil collectgarbage()", 3 } } do
      local code, output = run(late:format(case[1], case[2]), no_leaks)
      assert.equal(case[3], code, case[1] .. case[2] .. output)
      if case[4] then has(output, case[4], "in a finaliser") end
    end
  end)

  it("stops at SIGTERM and SIGHUP as at Ctrl-C", function()
    for fault, expected in pairs { term = 143, hang_up = 129 } do
      local code, _, records = run(('faulty "%s"'):format(fault))
      assert.equal(expected, code)
      has(records, '"record":"end","code":"stopped.request"', ('"exit":%d'):format(expected))
    end
  end)

  it("says that standard output is closed, and keeps the records free of what is printed", function()
    local name, records = write 'print "text" require "ambit".evaluate { 1 }', os.tmpname()
    local _, _, code = os.execute(("'%s' run --quiet --json %s %s >&- 2>/dev/null"):format(command, records, name))
    os.remove(name)
    assert.equal(1, code)
    assert.falsy(read(records):find("text\n", 1, true))
  end)

  it("takes back the line that a limit of the file's size tore", function()
    local code, output, records = run("for i = 1, 3000 do ambit.evaluate { ambit.between(1, 2) } end",
      "trap '' XFSZ; ulimit -f 64;")
    assert.equal(1, code)
    has(output, "cannot write records", "large")
    assert.equal("\n", records:sub(-1))
  end)
end)

describe("ambit test", function()
  -- Exit code and all output for a file that holds `text`.
  local function suite(text, options)
    local name = os.tmpname()
    os.remove(name)
    name = name .. "_spec.lua"
    local file = assert(io.open(name, "w"))
    file:write(text)
    file:close()
    local pipe = io.popen(("'%s' test %s %s 2>&1"):format(command, name, options or ""))
    local output = pipe:read "a"
    local _, _, code = pipe:close()
    os.remove(name)
    return code, output
  end

  it("fails where a spec calls os.exit(0)", function()
    local code, output = suite 'describe("x", function() it("leaves", function() os.exit(0) end) end)'
    assert.equal(1, code)
    has(output, "os.exit in a spec")
  end)

  it("fails where no test ran", function()
    local one = 'describe("x", function() it("is", function() end) end)'
    for _, case in ipairs { { "local x = 1" }, { 'describe("x", function() end)' }, { one, "-- --filter=nothing" } } do
      local code, output = suite(table.unpack(case))
      assert.equal(1, code, output)
      has(output, "no test ran")
    end
    assert.equal(0, (suite(one)))
    assert.equal(0, (suite(one, "-- --list")))
  end)
end)

describe("ambit repl", function()
  -- Exit code and all output for the lines of a pipe.
  local function repl(lines, environment)
    local name = write(lines)
    local pipe = io.popen(("%s '%s' repl <%s 2>&1"):format(environment or "", command, name))
    local output = pipe:read "a"
    local _, _, code = pipe:close()
    os.remove(name)
    return code, output
  end
  local faulty = [[drift = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }
    function faulty(fault)
      return ambit.simulate { drift, initial = { 0 }, t = { 0, 1 }, solver = "faulty", fault = fault }
    end
    ]]

  it("fed by a pipe ends with the exit code of its verbs", function()
    for _, case in ipairs { { "fine", 0 }, { "unsure", 3 }, { "nothing", 4 }, { "inverted", 1 } } do
      local code, output = repl(faulty .. ('faulty "%s"\n'):format(case[1]))
      assert.equal(case[2], code, output)
    end
    assert.equal(1, (repl(faulty .. 'faulty "unsure"\nerror "no"\n')))
    assert.equal(3, (repl(faulty .. 'faulty "unsure"\nos.exit(0)\n')))
    local code, output = repl(faulty .. 'setmetatable({}, { __gc = function() faulty "unsure" end })\n', no_leaks)
    assert.equal(3, code, output)
    assert.truthy(output:find("unable.width in a finaliser at the end", 1, true), output)
    assert.equal(1, (repl "os.exit(256)\n"))
    assert.equal(0, (repl "sqrt(between(-1, 1))\n")) -- nothing was asked: what it is is shown
  end)
end)
