-- provenance_spec.lua -- every stream of records and every report begins with whence it comes. The SHA-256 are held
-- against those of the program sha256sum.
local function absolute(name) return name:find "^/" and name or os.getenv "PWD" .. "/" .. name end
local command = absolute(assert(os.getenv "AMBIT_COMMAND", "AMBIT_COMMAND: the command to test"))
local build = absolute(assert((os.getenv "AMBIT_PATH" or ""):match "([^:]*)/tests/plugins",
  "AMBIT_PATH needs tests/plugins of the build"))

local function read(name)
  local file = assert(io.open(name, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

local function write(name, text)
  local file = assert(io.open(name, "w"))
  assert(file:write(text))
  file:close()
  return name
end

-- Standard output and exit code of a shell command.
local function shell(text)
  local pipe = assert(io.popen(text))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  return output, code
end

local function sha256sum(file) return (shell(("sha256sum '%s'"):format(file))):match "^%x+" end

local name = os.tmpname()
local scene = write(name, [[
local ambit = require "ambit"
ambit.evaluate { ambit.sin(ambit.number "1e300") * ambit.around(1, "1%"), arithmetic = "affine" }
local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
ambit.simulate { f, initial = { x = 1 }, t = { 0, 1 }, solver = "lohner" }
local m = ambit.mechanism "arm"
m:rigid_link { from = m:revolute { from = m.world, axis = "z", angle = "0.5", name = "q" }, offset = { 1, 0, 0 } }]])

-- Each file of a text that has a hash is hashed anew; -> how many.
local function check_hashes(text, pattern)
  local count = 0
  for file, hash in text:gmatch(pattern) do
    assert.equal(sha256sum(file), hash, file)
    count = count + 1
  end
  return count
end

local in_json, in_text = '"file":"([^"]+)"[^{}]-"sha256":"(%x+)"', "(/[^,\n]+), SHA%-256 (%x+)"

describe("provenance", function()
  it("begins the records of a run, and each plugin stands before what rests on it", function()
    local text, code = shell(("'%s' run --quiet --json - %s"):format(command, scene))
    assert.equal(0, code)
    local lines = {}
    for line in text:gmatch "[^\n]+" do lines[#lines + 1] = line end
    assert.truthy(lines[1]:find('^{"record":"provenance","ambit":"[%d.]+","command":"run","scene":{"file":"' .. scene
      .. '","sha256":"%x+"},"kernel":{"file":"[^"]+/bin/ambit","sha256":"%x+"}}$'), lines[1])
    assert.truthy(check_hashes(text, in_json) >= 6)
    local seen = {}
    for _, line in ipairs(lines) do
      local kind, plugin = line:match '^{"record":"plugin","kind":"(%a+)","name":"([%w_]+)","version":"[%d.]+"'
      if kind then seen[kind .. "." .. plugin] = true end
      if line:find('"record":"value"', 1, true) then assert.is_true(seen["arithmetic.affine"]) end
      if line:find('"record":"step"', 1, true) then assert.is_true(seen["solver.lohner"]) end
    end
    assert.is_true(seen["arithmetic.interval"] and seen["service.digest"])
  end)

  it("begins every report", function()
    local base = os.tmpname()
    local words = ("compare --quick --csv B.csv --json B.json --html B.html --svg B.svg "):gsub("B", base) .. scene
    local _, code = shell(("'%s' %s 2>/dev/null"):format(command, words))
    assert.equal(0, code)
    assert.truthy(read(base .. ".csv"):find "^# ambit: [%d.]+, ambit compare\r\n# scene: ")
    assert.truthy(check_hashes(read(base .. ".csv"):gsub("\r", ""), in_text) >= 4)
    assert.truthy(read(base .. ".csv"):find("# solver lohner: ", 1, true)) -- which ran in a child
    assert.truthy(read(base .. ".json"):find '^{"record":"provenance"')
    assert.truthy(check_hashes(read(base .. ".json"), in_json) >= 4)
    assert.truthy(read(base .. ".html"):find('<details class="provenance">', 1, true))
    assert.truthy(read(base .. ".html"):find("solver lohner</dt><dd>[%d.]+, /[^<]+, SHA%-256 %x+"))
    assert.truthy(read(base .. ".svg"):find("<metadata>\nambit: [%d.]+, ambit compare\n"))
    shell(("'%s' explain --svg %s.svg %s"):format(command, base, scene))
    assert.truthy(read(base .. ".svg"):find("<metadata>\nambit: [%d.]+, ambit explain\n"))
    assert.truthy(check_hashes(read(base .. ".svg"):match "<metadata>(.-)</metadata>", in_text) >= 4)
    shell(("'%s' view --quiet %s -o %s.html"):format(command, scene, base))
    assert.truthy(read(base .. ".html"):find('"provenance":{"ambit"', 1, true))
    assert.truthy(read(base .. ".html"):find("element revolute</dt><dd>[%d.]+, /[^<]+, SHA%-256 %x+"))
    for _, form in ipairs { "json", "csv", "markdown", "html" } do
      shell(("'%s' stability --case linear --solver lohner --%s %s.x >/dev/null 2>&1"):format(command, form, base))
      assert.truthy(read(base .. ".x"):sub(1, form == "html" and -1 or 200):find "kernel", form)
    end
    assert.truthy((shell(("'%s' explain %s"):format(command, scene))):find "^ambit: [%d.]+, ambit explain\nscene: ")
    assert.truthy((shell(("'%s' explain --json %s"):format(command, scene))):find '^{"record":"provenance"')
    assert.truthy((shell(("'%s' profile %s"):format(command, scene))):find "^ambit: [%d.]+, ambit profile\nscene: ")
    assert.truthy((shell(("'%s' profile --json - %s"):format(command, scene))):find '^{"provenance":{"ambit":')
    os.execute(("rm -f %s %s.*"):format(base, base))
  end)

  it("begins the file of a reduction and of a certificate", function()
    local ambit = require "ambit"
    local function decay(k) return ambit.ode { states = { "x" }, equations = function(s) return { x = -k * s.x } end } end
    local c = ambit.certify { decay(ambit.around(1, "1%")), decay(1), t = { 0, 1 }, initial = { x = 1 },
      outputs = { "x" }, error = { x = "0.1" } }
    assert.truthy(c:json():find '^{"provenance":{"ambit":"[%d.]+"')
    assert.truthy(check_hashes(c:json(), in_json) >= 3)
  end)

  it("ends what a scene prints of a certificate, a reduction and a verification, and is in pictures", function()
    local picture = os.tmpname()
    local text, code = shell(("cat <<'E' | '%s' run --quiet /dev/stdin 2>&1\n"):format(command) .. ([[
local ambit = require "ambit"
local function decay(k)
  return ambit.ode { states = { "x" }, equations = function(s) return { x = -k * s.x - 0.001 * s.x ^ 3 } end }
end
local q = { t = { 0, 1 }, initial = { x = 1 }, outputs = { "x" }, error = { x = "0.1" } }
local function asked(...)
  local t = { ... }
  for key, value in pairs(q) do t[key] = value end
  return t
end
local c = ambit.certify(asked(decay(ambit.around(1, "1%%")), decay(1)))
print(c)
print "==="
c:picture("%s", { draws = 10 })
print(ambit.reduce(asked(decay(1))))
print "==="
print(ambit.verify { decay(1), t = { 0, 1 }, initial = { x = 1 }, safe = function(s) return s.x - 2 end })
E]]):format(picture))
    assert.equal(0, code, text)
    local count = 0
    for part in (text .. "===\n"):gmatch "(.-)===\n" do
      count = count + 1
      assert.truthy(part:find("provenance\n%s+ambit: [%d.]+, ambit run\n"), part)
      assert.truthy(part:find("solver lohner: ", 1, true), part)
      assert.truthy(check_hashes(part:gsub("scene: [^\n]*\n", ""), in_text) >= 3, part)
    end
    assert.equal(3, count)
    local svg = read(picture)
    os.remove(picture)
    assert.truthy(svg:find("<metadata>\nambit: [%d.]+, ambit run\n"), svg:sub(1, 400))
    assert.truthy(check_hashes(svg:match "<metadata>(.-)</metadata>":gsub("scene: [^\n]*\n", ""), in_text) >= 3)
  end)

  it("tells who takes the place of Ambit's own, and which folders are trusted", function()
    local text = shell(("AMBIT_PATH=%s/tests/shadow '%s' --allow-shadow --trust /tmp run --quiet --json - %s"):format(
      build, command, scene))
    assert.truthy(text:find '"trusted":"/tmp"')
    assert.truthy(text:find('"name":"interval","version":"6.66","file":"' .. build:gsub("%p", "%%%0")
      .. '/tests/shadow/arithmetic/interval.so","sha256":"%x+","shadows":"yes"}'))
  end)

  it("names files as they are called everywhere", function()
    local text = shell(("cd '%s/tests' && AMBIT_PATH=shadow '%s' --allow-shadow run --quiet --json - %s"):format(build,
      command, scene))
    assert.truthy(text:find(build .. '/tests/shadow/arithmetic/interval.so","sha256":"', 1, true), text)
    assert.truthy(check_hashes(text, in_json) >= 6)
  end)

  it("is refused for a plugin whose file was changed after it was loaded", function()
    local folder = os.tmpname()
    os.remove(folder)
    os.execute(("umask 022; mkdir -p %s/arithmetic; cp %s/tests/plugins/arithmetic/minimal.so %s/arithmetic"):format(folder,
      build, folder))
    local own = write(os.tmpname(), ([[
local ambit = require "ambit"
ambit.plugin("arithmetic", "minimal")
local file = io.open("%s/arithmetic/minimal.so", "a")
file:write "x"
file:close()
ambit.evaluate { ambit.around(1, "1%%"), arithmetic = "minimal" }]]):format(folder))
    local text, code = shell(("AMBIT_PATH=%s '%s' run --quiet --json - %s 2>&1"):format(folder, command, own))
    assert.equal(1, code)
    assert.truthy(text:find("arithmetic/minimal.so was changed after it was loaded", 1, true), text)
    assert.falsy(text:find('"record":"value"', 1, true))
    os.execute("rm -r " .. folder)
    os.remove(own)
  end)

  it("is that of the text that runs, read once, also out of a pipe", function()
    local hash = sha256sum(scene)
    for _, words in ipairs { "/dev/stdin", "/dev/fd/0" } do
      local text, code = shell(("cat %s | '%s' run --quiet --json - %s 2>&1"):format(scene, command, words))
      assert.equal(0, code)
      assert.truthy(text:find(('"scene":{"file":"%s","sha256":"%s"}'):format(words, hash), 1, true), text)
      assert.truthy(text:find('"record":"value"', 1, true) and text:find('"record":"step"', 1, true), text)
    end
    local own = write(os.tmpname(), [[
#!/usr/bin/env -S ambit run
local file = io.open(arg[0], "w")
file:write "other"
file:close()
print(require "ambit".provenance().scene.sha256, debug.getinfo(1).currentline)]])
    hash = sha256sum(own)
    assert.equal(hash .. "\t5\n", (shell(("'%s' run --quiet %s"):format(command, own))))
    os.remove(own)
    local text, code = shell(("echo 'return {}' | '%s' stability --json - /dev/stdin 2>&1"):format(command))
    assert.equal(1, code)
    assert.truthy(text:find("an empty one", 1, true), text)
  end)

  it("needs a scene that can be read", function()
    local output = os.tmpname()
    for file, problem in pairs { ["/nowhere/x.lua"] = "cannot open /nowhere/x.lua: No such file or directory",
      ["/tmp"] = "cannot read /tmp: Is a directory" } do
      for _, option in ipairs { "", "--json " .. output } do
        local text, code = shell(("'%s' run --quiet %s %s 2>&1"):format(command, option, file))
        assert.equal(1, code)
        assert.truthy(text:find(problem, 1, true), text)
      end
    end
    os.remove(output)
  end)

  it("costs nothing where nobody asks", function()
    local text = shell(("'%s' run --quiet %s"):format(command, write(os.tmpname(), [[
local ambit = require "ambit"
ambit.evaluate { ambit.around(1, "1%") }
for line in io.lines "/proc/self/maps" do if line:find "nettle" or line:find "digest" then print(line) end end]])))
    assert.equal("", text)
  end)
end)
