-- `--sandbox`: what a stranger's scene tries (escapes.lua) fails; either wall holds without the other; what a scene is
-- for goes on.
local escapes = dofile "tests/lua/escapes.lua"
local command = os.getenv "AMBIT_COMMAND" or "ambit"

-- A sanitizer looks for leaks in a process of its own, which a sandbox does not let it start.
local sanitized = 'ASAN_OPTIONS="$ASAN_OPTIONS:detect_leaks=0"'

local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end

local function write(name, text)
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  return name
end

-- A folder of this test's, with the files that scenes are after.
local folder = os.tmpname()
os.remove(folder)
assert(os.execute("mkdir -p " .. quoted(folder .. "/x")))
local canary = write(folder .. "/canary", "secret\n")
write(folder .. "/canary.lua", "return { secret = 1 }\n")
local allowed = write(folder .. "/allowed", "return 'may be read'\n")
write(folder .. "/bytecode", string.dump(function() return 1 end))
os.execute(("ln -s %s %s"):format(quoted(canary), quoted(folder .. "/link")))
local before = io.popen("ls -R " .. quoted(folder)):read "a"

local function filled(text) return (text:gsub("CANARY", canary):gsub("FOLDER", folder):gsub("ALLOWED", allowed)) end

-- exit code, what is printed
local function run(words, scene)
  local name = folder .. "/scene.lua"
  write(name, scene)
  local pipe = io.popen(("%s %s %s %s 2>&1"):format(sanitized, command, words, name))
  local text = pipe:read "a"
  local _, _, code = pipe:close()
  os.remove(name)
  return code, text
end

local head = [[
local function attempt(name, f)
  local good, result = pcall(f)
  if good and result then print("ESCAPED " .. name) end
end
]]

describe("a scene in a sandbox", function()
  it("gets nowhere, whatever it tries", function()
    local parts = { head }
    for _, entry in ipairs(escapes.attempts) do
      parts[#parts + 1] = ("attempt(%q, function() %s\nend)"):format(filled(entry[1]), filled(entry[2]))
    end
    parts[#parts + 1] = 'print("all tried")'
    assert.is_true(#escapes.attempts + #escapes.bombs >= 200, #escapes.attempts + #escapes.bombs)
    local code, text = run("run --sandbox --time 60 --allow-read " .. allowed, table.concat(parts, "\n"))
    assert.is_nil(text:find "ESCAPED", text)
    assert.is_truthy(text:find("all tried", 1, true), text)
    assert.is_nil(text:find("secret", 1, true), text)
    assert.is_true(code == 0 or code == 3, text)
    assert.equal(before, io.popen("ls -R " .. quoted(folder)):read "a")
    assert.equal("secret\n", io.open(canary):read "a")
  end)

  it("ends by a limit, whatever it does", function()
    for _, bomb in ipairs(escapes.bombs) do
      local code, text = run("run --sandbox --quiet --time 0.4 --memory 200M --output 50k", bomb[2])
      assert.is_true(code == 5 or code == 1, bomb[1] .. ": " .. code .. " " .. text:sub(-300))
      assert.is_true(#text < 3e5, bomb[1])
    end
  end)

  it("reads what it may, and calculates as ever", function()
    local code, text = run("run --sandbox --allow-read " .. folder .. "/x --allow-read " .. allowed, filled [[
      local ambit = require "ambit"
      assert(require "ambit" == ambit and dofile "ALLOWED" == "may be read")
      assert(io.open("ALLOWED"):read "a" == "return 'may be read'\n" and io.open "FOLDER/x/none" == nil)
      assert(load "return 1 + 1"() == 2 and ("x"):rep(2) == "xx" and os.time() > 0 and os.date() and #arg == 0)
      local class = setmetatable({}, { __index = { f = function() return 7 end } })
      assert(class:f() == 7 and getmetatable(class).__index.f() == 7)
      local m = ambit.mechanism { "p", gravity = { 0, "-9.81", 0 } }
      local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
      m:point_mass { at = tip, mass = ambit.around(1, "1%") }
      local run = ambit.simulate { m:dynamics(), initial = { q = ambit.around(1, "1%"), ["q'"] = 0 }, t = 1, threads = 2,
        split = 2 }
      assert(run.status == "complete" and ambit.evaluate { "0.5" + 0.5 }:contains(1))
      print(ambit.verify { m:dynamics(), initial = { q = 0, ["q'"] = 0 }, t = 1, safe = m:position(tip).x - 2 }.status)]])
    assert.equal(0, code, text)
    assert.is_truthy(text:find("proved", 1, true), text)
  end)

  it("is run by every command that runs scenes", function()
    local scene = [[local ambit = require "ambit"
      local escaped = pcall(function() return assert(io.open "/etc/passwd") end)
      if escaped then error "escaped" end
      local o = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
      ambit.simulate { o, initial = { x = ambit.around(1, "1%") }, t = 1 }]]
    local page = folder .. "/page"
    for _, words in ipairs { "explain --sandbox", "profile --sandbox", "compare --sandbox --quick --csv " .. page, "run --sandbox --json " .. page,
      "profile --sandbox --json " .. page } do
      os.remove(page)
      local code, text = run(words, scene)
      assert.equal(0, code, words .. ": " .. text)
      if words:find(page, 1, true) then assert(io.open(page), words):close() end
    end
    os.remove(page)
  end)

  it("is refused with a clear word where the command line is wrong", function()
    local code, text = run("run --allow-read /etc", "")
    assert.equal(2, code)
    assert.is_truthy(text:find("option `--allow-read` needs `--sandbox`", 1, true), text)
    code, text = run("run --sandbox --allow-read /nowhere", "")
    assert.equal(2, code)
    assert.is_truthy(text:find("/nowhere: No such file", 1, true), text)
    code, text = run("explain --sandbox --svg x.svg", "")
    assert.equal(2, code)
    assert.is_truthy(text:find("Graphviz", 1, true), text)
  end)
end)

describe("the system's wall", function()
  -- Without the first one: the scene has all of Lua, and is shut in by its own call.
  local function behind(children, code)
    return run("run --quiet", ([[
      local core = require "ambit.core"
      local files, why = core.sandbox({ "/lib", "/usr/lib", "/lib64", "/etc/ld.so.cache", %q }, {}, %s)
      if files == nil then print(why) os.exit(7) end
      if not files then print "no Landlock" end
      %s]]):format(allowed, tostring(children), filled(code)))
  end

  it("keeps files, programs, processes and the network from the process", function()
    local code, text = behind(false, [[
      local function gets(f) local good, result = pcall(f) return good and result end
      if files then
        print("canary", gets(function() return io.open "CANARY" end) and "READ" or "kept")
        print("passwd", gets(function() return io.open "/etc/passwd" end) and "READ" or "kept")
        print("write", gets(function() return io.open("FOLDER/made", "w") end) and "WRITTEN" or "kept")
        print("remove", gets(function() return os.remove "CANARY" end) and "REMOVED" or "kept")
      end
      print("program", gets(function() return os.execute "true" end) and "RAN" or "kept")
      print("pipe", gets(function() return io.popen "echo x":read "a" == "x\n" end) and "RAN" or "kept")
      print("fork", gets(function() return require "ambit.core".child(function() return "x" end) end) and "FORKED" or "kept")
      print("allowed", io.open "ALLOWED" and "read")]])
    assert.equal(0, code, text)
    for _, word in ipairs { "READ", "WRITTEN", "REMOVED", "RAN", "FORKED" } do
      assert.is_nil(text:find(word, 1, true), text)
    end
    assert.is_truthy(text:find("allowed%s+read"), text)
    assert.equal("secret\n", io.open(canary):read "a")
  end)

  it("lets a command fork that has to, and no program start there", function()
    local code, text = behind(true, [[
      local core = require "ambit.core"
      print("fork", pcall(core.child, function() return "x" end) and "forked" or "kept")
      print("program", os.execute "true" and "RAN" or "kept")]])
    assert.equal(0, code, text)
    assert.is_truthy(text:find("fork%s+forked"), text)
    assert.is_nil(text:find("RAN", 1, true), text)
  end)

  it("shuts in a suite of specs", function()
    local spec = write(folder .. "/some_spec.lua", filled [[
      describe("a stranger's spec", function()
        it("cannot read", function() assert.is_nil((io.open "CANARY")) end)
        it("cannot write", function() assert.is_nil((io.open("FOLDER/made", "w"))) end)
        it("cannot run", function() assert.is_falsy((os.execute "true")) end)
        it("can prove", function() assert.is_true(require "ambit".interval(0, 1):contains "0.5") end)
      end)]])
    local pipe = io.popen(("%s %s test --sandbox %s 2>&1"):format(sanitized, command, spec))
    local text = pipe:read "a"
    local _, _, code = pipe:close()
    os.remove(spec)
    if text:find("no Landlock", 1, true) then return end
    assert.equal(0, code, text)
    assert.is_truthy(text:find("4 successes", 1, true), text)
  end)
end)

teardown(function() os.execute("rm -rf " .. quoted(folder)) end)
