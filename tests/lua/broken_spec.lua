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

  it("is believed where it tells the truth", function()
    local code, output = run [[
      print(ambit.evaluate { ambit.exp(ambit.between(1, 2)), arithmetic = { "liar", lie = "nothing" } })]]
    assert.equal(0, code)
    assert.truthy(output:find "^%[2.7")
  end)
end)
