-- `ambit check`: verdicts, exit codes, and reports that survive the plugin. AMBIT_COMMAND is the command to test.
local command = os.getenv "AMBIT_COMMAND" or "ambit"
local build = (os.getenv "AMBIT_PATH" or ""):match "([^:]*)/tests/plugins"

-- run(words) -> exit code, stdout, stderr
local function run(words)
  local out, problems = os.tmpname(), os.tmpname()
  local _, _, code = os.execute(("'%s' %s >%s 2>%s"):format(command, words, out, problems))
  local texts = {}
  for i, name in ipairs { out, problems } do
    local file = assert(io.open(name))
    texts[i] = file:read "a"
    file:close()
    os.remove(name)
  end
  return code, texts[1], texts[2]
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

local function broken(name) return ("%s/tests/broken/%s.so"):format(build, name) end

describe("ambit check", function()
  it("finds that the shipped arithmetics conform", function()
    local code, stdout = run "check --rounds 0.1 --isotonic interval"
    assert.equal(0, code, stdout)
    has(stdout, "arithmetic.interval: ", "operations", "environments", "dot", "jets", "conforms: ")
    assert.falsy(stdout:find "left to the kernel")
    code, stdout = run "check --rounds 0.1 arithmetic.real"
    assert.equal(0, code, stdout)
    has(stdout, "proves nothing", "conforms: ")
  end)

  it("lists what an arithmetic leaves to the kernel", function()
    local code, stdout = run("check --rounds 0.1 " .. build .. "/tests/plugins/arithmetic/double_double.so")
    assert.equal(0, code, stdout)
    has(stdout, "left to the kernel (sound, but loose and slow): pown exp log")
  end)

  it("repeats itself with the same seed, and takes another one", function()
    local words = "check --rounds 0.1 --seed %s %s"
    local _, first = run(words:format("5", broken "arithmetic/unsound"))
    local _, again = run(words:format("5", broken "arithmetic/unsound"))
    local _, other = run(words:format("6", broken "arithmetic/unsound"))
    local finding = "inclusion: [^\n]+"
    assert.equal(first:match(finding), again:match(finding))
    assert.not_equal(first:match(finding), other:match(finding))
    has(other, "with seed 6")
  end)

  it("prints broken promises and ends with 3", function()
    local code, stdout = run("check --rounds 0.1 " .. broken "arithmetic/unsound")
    assert.equal(3, code)
    has(stdout, "inclusion: ADD over [", "BROKEN: ", " promises, in ")
  end)

  it("reports plugins that crash, hang or leave", function()
    local code, stdout = run("check --rounds 0.1 " .. broken "arithmetic/crashing")
    assert.equal(3, code)
    has(stdout, "elements", "BROKEN: crashed: ", "in `operations`")
    code, stdout = run("check --rounds 0.1 --patience 1 " .. broken "arithmetic/endless")
    assert.equal(3, code)
    has(stdout, "elements", "BROKEN: no end within 1 s, in `operations`")
    code, stdout = run("check --rounds 0.1 " .. broken "arithmetic/quitting")
    assert.equal(3, code)
    has(stdout, "elements", "BROKEN: it ended the whole process (exit code 0), in `operations`")
  end)

  it("explains what cannot be loaded and ends with 1", function()
    local cases = {
      [broken "arithmetic/none"] = "no such file",
      [broken "arithmetic/mute"] = "exports no `ambit_entry`",
      [broken "arithmetic/boundless"] = "lacks `bounds`",
      [broken "arithmetic/stunted"] = "bytes",
      [broken "arithmetic/faceless"] = "does not offer the interface",
      [broken "arithmetic/future"] = "rebuild the plugin",
      [broken "element/inexpressive"] = "lacks `express`",
      [broken "solver/idle"] = "lacks `run`",
      ["./README.md"] = "not a shared object",
      ["nonesuch"] = "there is no plugin `nonesuch`",
      ["solver.interval"] = "there is no plugin `solver.interval`",
    }
    for words, piece in pairs(cases) do
      local code, stdout, stderr = run("check " .. words)
      assert.equal(1, code, words .. stdout .. stderr)
      has(stderr, "ambit: ", piece)
    end
  end)

  it("has kits for elements and solvers too", function()
    local code, stdout = run "check revolute"
    assert.equal(0, code, stdout)
    has(stdout, "element.revolute: ", "balances of power closed", "conforms: ")
    code, stdout = run "check lohner"
    assert.equal(0, code, stdout)
    has(stdout, "problems", "random systems", "conduct", "conforms: ")
    for name, section in pairs { elementary = "elementary", quasi_random = "quasi_random", eigen = "eigen",
      krawczyk = "equations", reduction = "models" } do
      code, stdout = run("check " .. name)
      assert.equal(0, code, stdout)
      has(stdout, section, " checks\n", "conduct", "conforms: ")
    end
  end)

  it("takes elements with kinks", function()
    local code, stdout = run("check " .. build .. "/tests/plugins/element/kink.so")
    assert.equal(0, code, stdout)
    has(stdout, "balances of power closed", "conforms: ")
  end)

  it("looks at elements on both sides of their kinks", function()
    local code, stdout = run("check " .. build .. "/tests/plugins/element/kink_fault.so")
    assert.equal(3, code, stdout)
    has(stdout, "power", "BROKEN: ")
    code, stdout = run("check " .. build .. "/tests/plugins/element/kink_jump.so")
    assert.equal(3, code, stdout)
    has(stdout, "energy, momentum or motion jumps by 1.000e-01 at a kink", "BROKEN: ")
  end)

  it("passes options on", function()
    local code, stdout = run "check gsl method=rk4"
    assert.equal(0, code, stdout)
    code, stdout = run "check real order=3"
    assert.equal(3, code)
    has(stdout, "options: ", "order")
  end)

  it("ends with 2 on wrong usage", function()
    for _, words in ipairs { "", "--seed", "--seed x interval", "--seed 0 interval", "--seed 1.5 interval",
      "--rounds -1 interval", "--sed 1 interval", "interval degree", "--long=3 interval" } do
      local code, stdout, stderr = run("check " .. words)
      assert.equal(2, code, words)
      assert.equal("", stdout)
      has(stderr, "ambit: ", "usage: ambit check")
    end
    local code, stdout = run "check --help"
    assert.equal(0, code)
    has(stdout, "usage: ambit check", "exit: 0 it conforms, 1 it cannot be loaded, 3")
  end)
end)
