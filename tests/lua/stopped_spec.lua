-- stopped_spec.lua -- what ends a run from outside: the limits --time, --memory and --output, and signals. In every
-- case the records are whole lines, the last of which says what it was.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

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

-- Runs a scene: exit code, all output, records.
local function run(text, options, behind)
  local name, out, records = write(text), os.tmpname(), os.tmpname()
  local _, how, code = os.execute(("'%s' run --quiet --json %s %s %s %s >%s 2>&1"):format(command, records, options, name,
    behind or "", out))
  os.remove(name)
  return how == "exit" and code or how .. code, read(out), read(records)
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text:sub(1, 2000)) end
end

-- Each line is a whole object; the last one is the end, with this code.
local function check_records(records, code, exit)
  assert.equal("\n", records:sub(-1))
  local last, ends
  for line in records:gmatch "[^\n]+" do
    assert.truthy(line:find '^{"record":".*}$', line)
    last, ends = line, (ends or 0) + (line:find('"record":"end"', 1, true) and 1 or 0)
  end
  assert.equal(1, ends)
  has(last, ('{"record":"end","code":"%s","exit":%d'):format(code, exit))
end

local oscillator = [[
  local ambit = require "ambit"
  local system = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -ambit.sin(s.x) } end }
  local run = ambit.simulate { system, initial = { x = 1, v = 0 }, t = { 0, 1e5 }, solver = "lohner", step_max = ".01" }
  print(run.status, run.code, run.reason)]]

local many = 'local t = {} for i = 1, 1e9 do t[i] = ("x"):rep(1e6) .. i end'

local bombs = {
  { "a loop", "--time .3", "while true do end", "time" },
  { "a loop that catches errors", "--time .3",
    "local function again() while true do pcall(again) end end again()", "time" },
  { "a loop in a handler of errors", "--time .3", "xpcall(error, function() while true do end end)", "time" },
  { "a loop in a coroutine", "--time .3", "coroutine.wrap(function() while true do end end)()", "time" },
  { "a loop in a finaliser", "--time .3",
    "setmetatable({}, { __gc = function() while true do end end }) collectgarbage()", "time" },
  { "a loop in a text of an error", "--time .3",
    "error(setmetatable({}, { __tostring = function() while true do end end }))", "time" },
  { "a long search of the library's", "--time .3", '(("a"):rep(1e4)):find((".-"):rep(90) .. "b")', "time" },
  { "waiting for what does not come", "--time .3", 'io.popen "sleep 3":read()', "time" },
  { "a simulation", "--time .5", oscillator, "time" },
  { "memory of Lua's", "--memory 300M", many, "memory" },
  { "memory of formulas", "--memory 300M",
    'local ambit = require "ambit" local x = ambit.around(1, 1) for i = 1, 1e9 do x = ambit.sin(x + i) end', "memory" },
  { "what is printed", "--output 100k", 'while true do print(("x"):rep(100)) end', "output" },
  { "what is written", "--output 100k", 'while true do io.stdout:write(("x"):rep(1e6)) end', "output" },
  { "what is complained about", "--output 100k", "while true do io.stderr:write 'words\\n' end", "output" },
  { "what is recorded", "--output 100k", oscillator, "output" },
}

describe("a limit", function()
  for _, bomb in ipairs(bombs) do
    it(("of %s stops %s"):format(bomb[4], bomb[1]), function()
      local code, output, records = run(bomb[3], bomb[2])
      assert.equal(5, code, output:sub(1, 2000))
      has(output, ("the limit of --%s, %s"):format(bomb[4], bomb[2]:match "%S+$"))
      check_records(records, "stopped." .. bomb[4], 5)
      has(records, ('"reason":"the limit of --%s, '):format(bomb[4]))
      if bomb[4] == "output" then assert.is_true(#output + #records < 100 * 1024 + 70000) end
    end)
  end

  it("leaves the result of the verb that it stopped", function()
    local _, output, records = run(oscillator, "--time .5")
    has(records, '"record":"step"', '"verb":"simulate","status":"stopped","code":"stopped.time",' ..
      '"reason":"the limit of --time, .5 s, is reached"')
    assert.falsy(output:find("complete", 1, true))
  end)

  it("that is not reached changes nothing", function()
    local code, output, records = run('print(require "ambit".interval(1, 2))', "--time 100 --memory 1G --output 1M")
    assert.equal(0, code, output)
    assert.equal("[1, 2]\n", output)
    check_records(records, "ok", 0)
  end)

  it("must be a number", function()
    for _, options in ipairs { "--time x", "--time 0", "--time -1", "--time 1e3", "--memory 10X", "--output=0",
      "--memory", "--time nan" } do
      local code, output = run("", options, "x")
      assert.equal(2, code, options .. output)
      has(output, options:match "^%-%-%a+")
    end
  end)

  it("stops what other commands do with a scene", function()
    local plain = write "while true do end"
    local loop = plain .. "_spec.lua"
    os.rename(plain, loop)
    for _, words in ipairs { "compare", "explain", "profile", "view -o /dev/null", "test" } do
      local out = os.tmpname()
      local _, _, code = os.execute(("'%s' %s --time .2 %s >%s 2>&1"):format(command, words, loop, out))
      assert.equal(5, code, words)
      has(read(out), "the limit of --time, .2 s, is reached")
    end
    os.remove(loop)
  end)
end)

describe("a reader that leaves", function()
  it("ends the run with a message and whole records", function()
    local scene, records, out = write 'for i = 1, 1e7 do print "words" end', os.tmpname(), os.tmpname()
    os.execute(("{ '%s' run --quiet --json %s %s 2>%s; echo code $? >>%s; } | head -n 1 >/dev/null"):format(command,
      records, scene, out, out))
    os.remove(scene)
    has(read(out), "interrupted", "code 141")
    check_records(read(records), "stopped.request", 141)
  end)
end)
