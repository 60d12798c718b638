-- `ambit new`: what it writes and what it refuses; that it builds and conforms is the test `install`.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function read(name)
  local file = assert(io.open(name))
  local text = file:read "a"
  file:close()
  return text
end

-- run(words) -> exit code, stdout, stderr
local function run(words)
  local out, problems = os.tmpname(), os.tmpname()
  local _, _, code = os.execute(("'%s' %s >%s 2>%s"):format(command, words, out, problems))
  local stdout, stderr = read(out), read(problems)
  os.remove(out)
  os.remove(problems)
  return code, stdout, stderr
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

local directory
local written = { "mine.c", "CMakeLists.txt", "Makefile", "README.md" }

describe("ambit new", function()
  before_each(function()
    directory = os.tmpname()
    os.remove(directory)
  end)

  after_each(function()
    for _, name in ipairs(written) do os.remove(directory .. "/" .. name) end
    os.remove(directory)
  end)

  it("writes a directory for each kind", function()
    for _, kind in ipairs { "arithmetic", "element", "solver" } do
      local code, stdout, stderr = run(("new %s mine %s"):format(kind, directory))
      assert.equal(0, code, stderr)
      has(stdout, directory .. "/mine.c", "next: ")
      local source = read(directory .. "/mine.c")
      has(source, "mine.c -- ")
      assert.truthy(source:find(kind == "element" and '"mine"' or ('"%s.mine"'):format(kind), 1, true))
      has(read(directory .. "/CMakeLists.txt"), "find_package(Ambit REQUIRED)", kind, "mine.c", "check")
      has(read(directory .. "/Makefile"), "pkg-config", kind .. "/mine.so", "ambit check")
      has(read(directory .. "/README.md"), "# mine", kind)
      for _, name in ipairs(written) do
        assert.falsy(read(directory .. "/" .. name):find "skeleton")
        assert.falsy(read(directory .. "/" .. name):find "@%u+@")
        os.remove(directory .. "/" .. name)
      end
      os.remove(directory)
    end
  end)

  it("never overwrites", function()
    assert.equal(0, run("new arithmetic mine " .. directory))
    local file = assert(io.open(directory .. "/mine.c", "w"))
    file:write "kept"
    file:close()
    os.remove(directory .. "/README.md")
    local code, _, stderr = run("new arithmetic mine " .. directory)
    assert.equal(1, code)
    has(stderr, "exists already; nothing was written")
    assert.equal("kept", read(directory .. "/mine.c"))
    assert.is_nil(io.open(directory .. "/README.md"))
  end)

  it("refuses names that no plugin can have, or that one has already", function()
    for _, name in ipairs { "Mine", "1st", "a-b", "'a b'", "_x", "../x", "interval", ("a"):rep(64) } do
      local code, stdout, stderr = run(("new arithmetic %s %s"):format(name, directory))
      assert.equal(1, code, name)
      assert.equal("", stdout)
      has(stderr, "ambit: ")
    end
    local _, _, stderr = run("new arithmetic interval " .. directory)
    has(stderr, "there is a plugin arithmetic.interval already")
  end)

  it("says when it cannot write", function()
    local code, _, stderr = run "new arithmetic mine /dev/null/here"
    assert.equal(1, code)
    has(stderr, "/dev/null/here")
  end)

  it("ends with 2 on wrong usage", function()
    for _, words in ipairs { "", "arithmetic", "arithmetics mine", "service mine", "arithmetic a b c", "--x y" } do
      local code, stdout, stderr = run("new " .. words)
      assert.equal(2, code, words)
      assert.equal("", stdout)
      has(stderr, "usage: ambit new")
    end
    local _, _, stderr = run "new arithmetics mine"
    has(stderr, "did you mean `arithmetic`?")
    assert.equal(0, (run "new --help"))
  end)
end)
