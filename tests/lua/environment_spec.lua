-- A host program may have set another rounding mode or flush-to-zero: every proved answer stays the same, bit by bit.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function answers(mode, flush)
  local pipe = assert(io.popen(("'%s' run --quiet tests/lua/environment/answers.lua %s %s 2>&1"):format(command, mode, flush)))
  local text = pipe:read "a"
  assert.truthy(pipe:close(), text)
  return text
end

describe("in any floating-point environment", function()
  local usual = answers("nearest", "gradual")

  it("there is something to compare", function()
    local _, lines = usual:gsub("\n", "\n")
    assert.is_true(lines > 40)
  end)

  for _, mode in ipairs { "nearest", "upward", "downward", "zero" } do
    it("answers the same, rounding " .. mode, function()
      assert.equal(usual, answers(mode, "gradual"))
      assert.equal(usual, answers(mode, "flush"))
    end)
  end
end)
