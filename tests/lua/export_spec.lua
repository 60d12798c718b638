-- Functions that a plugin exports, called through libffi; Lua functions as callbacks.
local ambit = require "ambit"

describe("an exported function", function()
  local fn = ambit.plugin("service", "callbacks").fn

  it("takes and gives numbers, integers, texts and lists", function()
    assert.equal(6, fn.scale(2, 3))
    assert.equal(-4, fn.next_int(-5))
    assert.equal(2 ^ 40 | 0, fn.next_long((2 ^ 40 | 0) - 1))
    assert.equal("hello", fn.greet "Lua")
    assert.equal("who?", fn.greet "C")
    assert.equal(6.5, fn.sum { 1, 2, 3.5 })
    assert.equal(0, fn.sum {})
  end)

  it("calls a Lua function back", function()
    assert.is_true(math.abs(fn.integrate(0, 1, 200, function(x) return x * x end) - 1 / 3) < 1e-5)
    local seen = {}
    fn.each({ 5, 6 }, function(list, i) seen[#seen + 1] = i .. ":" .. table.concat(list, " ") end)
    assert.same({ "0:5.0", "1:5.0 6.0" }, seen)
  end)

  it("nests callbacks", function()
    local area = fn.integrate(0, 1, 20, function(x) return fn.integrate(0, x, 20, function(y) return y end) end)
    assert.is_true(math.abs(area - 1 / 6) < 1e-3)
  end)

  it("raises an error of a callback again after the plugin has returned", function()
    local calls = 0
    local good, problem = pcall(fn.integrate, 0, 1, 100, function(x)
      calls = calls + 1
      if x > 0.5 then error "too far" end
      return x
    end)
    assert.is_false(good)
    assert.truthy(problem:find("export_spec.lua:%d+: too far"))
    assert.equal(51, calls)
  end)

  it("keeps error values that are not texts, and NaN reaches the plugin meanwhile", function()
    local value = {}
    local _, problem = pcall(fn.stubborn, function() error(value) end)
    assert.equal(value, problem)
  end)

  it("survives a callback that returns nothing, a callback after collection, many calls", function()
    local good, problem = pcall(fn.integrate, 0, 1, 3, function() end)
    assert.is_false(good)
    assert.truthy(problem:find "must return a number")
    for _ = 1, 2000 do fn.integrate(0, 1, 2, function(x) return x end) end
    collectgarbage()
  end)

  it("checks its arguments", function()
    for _, case in ipairs {
      { "expected 2 arguments, got 1", fn.scale, 1 },
      { "argument 2: expected a number, got string", fn.scale, 1, "x" },
      { "argument 1: expected an integer", fn.next_int, 1.5 },
      { "does not fit into 32 bits", fn.next_int, 2 ^ 40 | 0 },
      { "expected a list of numbers, got number", fn.sum, 1 },
      { "element 2 is no number", fn.sum, { 1, {} } },
      { "argument 4: expected a function", fn.integrate, 0, 1, 2, 3 },
      { "expected text", fn.greet, 1 },
    } do
      local good, problem = pcall(table.unpack(case, 2))
      assert.is_false(good)
      assert.truthy(problem:find(case[1], 1, true), problem)
    end
  end)

  it("is named with the nearest one when it does not exist", function()
    local _, problem = pcall(function() return fn.scael end)
    assert.truthy(problem:find("did you mean `scale`", 1, true), problem)
    assert.truthy(problem:find("export_spec.lua:", 1, true))
  end)

  it("is listed in the manual", function()
    assert.truthy(ambit.help("service.callbacks"):find("integral of f", 1, true))
  end)
end)
