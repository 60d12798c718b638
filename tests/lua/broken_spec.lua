-- broken_spec.lua -- plugins that say they prove and give what no enclosure can be (findings S6): exit code 1, and the
-- message names them.
local command = os.getenv "AMBIT_COMMAND"
local folder = (os.getenv "AMBIT_PATH" or ""):match "([^:]*)/tests/plugins" .. "/tests/broken"

-- Exit code and all output of a scene.
local function run(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write('local ambit = require "ambit"\n', text)
  file:close()
  local pipe = assert(io.popen(("AMBIT_PATH='%s' '%s' run --quiet %s 2>&1"):format(folder, command, name)))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  os.remove(name)
  return code, output
end

describe("a plugin that gives no enclosures", function()
  for _, lie in ipairs { "nan", "reversed", "empty", "derivative" } do
    it("is named, and nothing of it is printed: " .. lie, function()
      local code, output = run(([[
        print(ambit.evaluate { ambit.exp(ambit.between(1, 2)), arithmetic = { "liar", lie = "%s" } })]]):format(lie))
      assert.equal(1, code)
      assert.truthy(output:find("arithmetic `liar` is broken", 1, true), output)
      assert.falsy(output:find "^%[")
    end)
  end

  -- Every verb that computes with the arithmetic: bounds of results, of operands that the kernel fills in, of series.
  local setting = [[
    local a = { "liar", lie = "%s" }
    local f = ambit.ode { states = { "x" },
      equations = function(s) return { x = -ambit.sin(s.x) + ambit.between(0, "0.1") } end }
    local start = { ambit.between(1, 2) }
    local function run(verb, t)
      t.initial, t.t, t.arithmetic, t.solver = start, { 0, 1 }, a, t.solver or "lohner"
      return verb(t)
    end
    local good, r = pcall(function() return %s end)
    print(good and r.status, good and r.code or r)]]
  for name, text in pairs {
    roots = "ambit.roots { function(s) return s.x ^ 2 - start[1] end, box = { x = { 0, 3 } }, arithmetic = a }",
    equilibria = "ambit.equilibria { f, box = { x = { -1, 1 } }, arithmetic = a }",
    evaluate = "ambit.evaluate { { ambit.sin(start[1]) }, arithmetic = a }",
    sample = "ambit.sample { { ambit.sin(start[1]) }, arithmetic = a }",
    simulate = "run(ambit.simulate, { f })",
    ["simulate with taylor_model"] = "run(ambit.simulate, { f, solver = 'taylor_model' })",
    ["simulate with valencia"] = "run(ambit.simulate, { f, solver = 'valencia' })",
    sensitivity = "run(ambit.sensitivity, { f }).run",
    verify = "run(ambit.verify, { f, budget = 1, safe = function(s) return s.x - 3 end })",
    certify = "run(ambit.certify, { f, f, outputs = { 'x' }, error = { x = 1 } })",
    reduce = "run(ambit.reduce, { f, outputs = { 'x' }, error = { x = 1 } })",
  } do
    it("is not believed by " .. name .. ", and a caught error does not make it good", function()
      for _, lie in ipairs { "nan", "reversed", "empty" } do
        local code, output = run(setting:format(lie, text))
        assert.equal(1, code, lie .. output)
        local said = output:find("^broken%s+broken%.bounds") or output:find("arithmetic `liar` is broken", 1, true)
        assert.truthy(said, lie .. output)
      end
      local code, output = run(setting:format("nothing", text))
      assert.equal(0, code, output)
    end)
  end

  it("is believed where it tells the truth", function()
    local code, output = run [[
      print(ambit.evaluate { ambit.exp(ambit.between(1, 2)), arithmetic = { "liar", lie = "nothing" } })]]
    assert.equal(0, code)
    assert.truthy(output:find "^%[2.7")
  end)
end)
