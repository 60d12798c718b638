-- trust_spec.lua -- what may speak (findings S5 and section 5): shipped names, folders that others may write, modules
-- of others in the current folder.
local function absolute(name) return name:find "^/" and name or os.getenv "PWD" .. "/" .. name end
local command = absolute(assert(os.getenv "AMBIT_COMMAND", "AMBIT_COMMAND: the command to test"))
local build = absolute(assert((os.getenv "AMBIT_PATH" or ""):match "([^:]*)/tests/plugins",
  "AMBIT_PATH needs tests/plugins of the build"))

local function write(name, text)
  local file = assert(io.open(name, "w"))
  assert(file:write(text))
  file:close()
  return name
end

-- Exit code and all output of `ambit WORDS` in a folder, with that AMBIT_PATH.
local function ambit(path, words, folder)
  local pipe = assert(io.popen(("cd '%s' && AMBIT_PATH='%s' '%s' %s 2>&1"):format(folder or "/", path, command, words)))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  return code, output
end

describe("plugins that take the place of Ambit's own", function()
  local scene = write(os.tmpname(), [[
local ambit = require "ambit"
print(ambit.evaluate { ambit.between(5, 6), arithmetic = "interval" })]])

  it("are refused, and both files are named", function()
    local code, output = ambit(build .. "/tests/shadow", "run " .. scene)
    assert.equal(1, code)
    assert.truthy(output:find(build .. "/tests/shadow/arithmetic/interval.so", 1, true), output)
    assert.truthy(output:find("Ambit's own [^\n]*/plugins/arithmetic/interval%.so"), output)
  end)

  it("speak if that is allowed, by the command or by the program", function()
    local code, output = ambit(build .. "/tests/shadow", "--allow-shadow run " .. scene)
    assert.equal("[0, 1]\n", output)
    assert.equal(0, code)
    local own = write(os.tmpname(), [[
local ambit = require "ambit"
ambit.trust { shadow = true }
print(ambit.evaluate { ambit.between(5, 6), arithmetic = "interval" })]])
    code, output = ambit(build .. "/tests/shadow", "run " .. own)
    assert.equal("[0, 1]\n", output)
    assert.equal(0, code)
    os.remove(own)
  end)

  it("are not those of Ambit's own folder by another name", function()
    local code, output = ambit(build .. "/plugins", "run " .. scene)
    assert.equal("[5, 6]\n", output)
    assert.equal(0, code)
  end)
end)

describe("a folder that others may write", function()
  local root = os.tmpname()
  os.remove(root)
  os.execute(("umask 022; mkdir -p %s/arithmetic; cp %s/tests/plugins/arithmetic/minimal.so %s/arithmetic; chmod 777 %s")
    :format(root, build, root, root))
  local scene = write(os.tmpname(), [[
local ambit = require "ambit"
print(ambit.evaluate { ambit.between(5, 6), arithmetic = "minimal" })]])

  it("is refused", function()
    local code, output = ambit(root, "run " .. scene)
    assert.equal(1, code)
    assert.truthy(output:find(root .. " may be written by everybody (mode 0777)", 1, true), output)
    code, output = ambit("", "check --rounds 0.01 " .. root .. "/arithmetic/minimal.so")
    assert.equal(1, code)
    assert.truthy(output:find("may be written by everybody", 1, true), output)
  end)

  it("is taken if its user trusts it", function()
    for _, option in ipairs { "--trust " .. root, "--trust=" .. root } do
      local code, output = ambit(root, option .. " run " .. scene)
      assert.equal("[5, 6]\n", output)
      assert.equal(0, code)
    end
    local code = ambit("", ("--trust %s check --rounds 0.01 %s/arithmetic/minimal.so"):format(root, root))
    assert.equal(0, code)
  end)

  it("must be there to be trusted", function()
    local code, output = ambit(root, "--trust /nowhere/at/all run " .. scene)
    assert.equal(2, code)
    assert.truthy(output:find("cannot trust /nowhere/at/all: No such file or directory", 1, true), output)
    code, output = ambit(root, "--trust")
    assert.equal(2, code)
    assert.truthy(output:find("option `--trust` needs a folder", 1, true))
  end)

  it("is removed", function() os.execute("rm -r " .. root) end)
end)

describe("a named pipe in a plugin's place", function()
  it("is refused at once", function()
    local root = os.tmpname()
    os.remove(root)
    os.execute(("umask 022; mkdir -p %s/solver && mkfifo %s/solver/pipe.so"):format(root, root))
    for _, words in ipairs { "plugins pipe", "check " .. root .. "/solver/pipe.so" } do
      local code, output = ambit(root, words)
      assert.equal(1, code, words)
      assert.truthy(output:find("pipe.so: not a regular file", 1, true), output)
    end
    os.execute("rm -r " .. root)
  end)
end)

describe("the current folder", function()
  it("gives no modules to the command", function()
    local folder = os.tmpname()
    os.remove(folder)
    os.execute("mkdir " .. folder)
    for _, name in ipairs { "lxp", "readline" } do
      write(("%s/%s.lua"):format(folder, name), 'io.open("was-here", "w"):close() return {}')
    end
    write(folder .. "/scene.lua", ('require "ambit".load "%s/scripts/robots/ur5.urdf"'):format(os.getenv "PWD" or "."))
    ambit("", "run scene.lua", folder)
    ambit("", "repl </dev/null", folder)
    local found = io.open(folder .. "/was-here")
    os.execute("rm -r " .. folder)
    assert.is_nil(found)
  end)
end)
