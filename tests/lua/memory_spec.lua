-- Objects that Lua has finalised, but that finalisers and tables with weak keys still reach.
local ambit = require "ambit"

describe("an object that Lua has given up", function()
  it("is refused where a table with weak keys still holds it", function()
    local weak = setmetatable({}, { __mode = "k" })
    do
      local e = ambit.sin "1.25" * 3
      weak[e] = true
    end
    collectgarbage()
    for e in pairs(weak) do -- Lua drops such keys one cycle later
      local good, result = pcall(ambit.evaluate, { e })
      assert.is_true(not good or result:contains(3 * math.sin(1.25)))
    end
  end)

  it("is refused in a finaliser that comes later", function()
    local seen
    do
      local last = setmetatable({}, { __gc = function(t) seen = { pcall(function() return t.m:dynamics() end) } end })
      last.m = ambit.mechanism "dropped"
    end
    collectgarbage()
    collectgarbage()
    assert.is_table(seen)
    assert.is_false(seen[1])
  end)
end)
