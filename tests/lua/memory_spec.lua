-- Objects that Lua has finalised, but that finalisers and tables with weak keys still reach.
local ambit = require "ambit"

describe("an object that Lua has given up", function()
  it("is refused where a table with weak keys still holds it", function()
    local weak, tried = setmetatable({}, { __mode = "k" }), 0
    -- Lua drops such keys when their memory is freed, a cycle behind their finalisers: one that runs among these sees
    -- the keys whose finalisers came before its own. Objects are finalised last made, first.
    local function look()
      for e in pairs(weak) do
        tried = tried + 1
        local good, problem = pcall(ambit.evaluate, { e })
        assert(not good, tostring(problem))
      end
    end
    local failed
    do
      setmetatable({}, { __gc = function()
        local good, problem = pcall(look)
        failed = not good and problem
      end })
      for i = 1, 10 do weak[ambit.sin(ambit.between(i, i + 1)) * 3] = true end
    end
    collectgarbage()
    assert.is_false(failed)
    assert.equal(10, tried)
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
