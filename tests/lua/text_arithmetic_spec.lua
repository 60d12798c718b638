-- Arithmetic on texts is Ambit's: "1" / "3" is a third. In a host's Lua it stays Lua's, which rounds; what may have
-- been rounded is then refused.
local ambit = require "ambit"
local number, interval = ambit.number, ambit.interval

local function refused(part, ...)
  local good, message = pcall(...)
  assert.is_false(good)
  assert.is_truthy(tostring(message):find(part, 1, true), ("%q expected, got: %s"):format(part, tostring(message)))
end

local function with(is_exact, run)
  local before = ambit.text_arithmetic(is_exact)
  local good, message = pcall(run)
  require("ambit.core").text_arithmetic(before)
  if not good then error(message, 0) end
end

describe("arithmetic on texts", function()
  it("means what the texts say", function()
    with(true, function()
      local cases = { -- 0 exactly
        -"124.14" * number(50) + 6207, ("1" / "3") * number(3) - 1, "0.1" + "0.2" - "0.3", "0.1" * 3 - number "0.3",
        3 * "0.1" - "0.3", "1.1" - 1 - "0.1", "0.1" ^ 2 - "0.01", ("2" ^ "0.5") ^ 2 - 2, 1 / "10" - "0.1",
        "1e300" / "1e299" - "1e1", "35 mm" + "1 m" - "1.035 m", -"60 deg" + ambit.pi / 3, "1/3" - "2/6",
      }
      for i, e in ipairs(cases) do
        local x = ambit.evaluate { e, arithmetic = "interval" }
        assert.is_true(x:contains(0), ("case %d: %s misses 0"):format(i, x:text(17)))
        assert.is_true(x:mag() < 1e-11, ("case %d: %s is wide"):format(i, x:text(17)))
      end
    end)
  end)

  it("leaves expressions, enclosures and types of others their own operators", function()
    with(true, function()
      assert.is_true(interval("0.1" * interval(1, 2)):contains "0.1")
      assert.is_true(interval("1" + number "2"):contains(3))
      local other = setmetatable({}, { __add = function() return "its own" end, __unm = function() return "minus" end })
      assert.equal("its own", "1" + other)
      assert.equal("its own", other + "1")
      assert.equal("minus", -other)
    end)
  end)

  it("refuses what is no number as Lua does, naming it", function()
    with(true, function()
      refused('"abc"', function() return "abc" + 1 end)
      refused("arithmetic on a table value", function() return "1" + {} end)
      refused("arithmetic on a table value", function() return {} * "1" end)
      refused("arithmetic on a nil value", function() return "1" - nil end)
      refused("tonumber", function() return "7" % 2 end)
      refused("tonumber", function() return "7" // 2 end)
    end)
  end)

  it("leaves joining, comparing and lengths to Lua", function()
    with(true, function()
      assert.equal("a12", "a" .. "1" .. 2)
      assert.is_true("10" < "9")
      assert.equal(1, #"7")
    end)
  end)

  it("is Lua's own again when it is asked for", function()
    with(false, function()
      assert.equal(-124.14, -"124.14")
      assert.equal(1 / 3, "1" / "3")
      assert.equal(1, "7" % 2)
      assert.equal(11, "10" + 1)
      assert.equal("integer", math.type("10" + 1))
      assert.is_truthy(number(0.5))
    end)
    refused("true or false", ambit.text_arithmetic, "yes")
  end)
end)

-- A stock interpreter with the module (LUA_CPATH), which nobody has told what texts mean.
local function stock(code)
  local script = os.tmpname()
  local file <close> = assert(io.open(script, "w"))
  file:write(code)
  file:flush()
  local lua <close> = assert(io.popen(("lua5.4 %s 2>&1"):format(script)))
  local text = lua:read "a"
  os.remove(script)
  return text
end

describe("arithmetic on texts in a host's Lua", function()
  if require "ambit.core".is_sanitized then return end -- a stock lua5.4 cannot load what the sanitizers made
  it("has Lua's results", function()
    assert.equal("-124.14 0.25 11 integer 1 8.0 nil\n", stock [[
      require "ambit"
      print(table.concat({ -"124.14", "1" / "4", "10" + 1, math.type("10" + 1), "7" % 2, "2" ^ 3,
        tostring((pcall(function() return "abc" + 1 end)) or nil) }, " ")) ]])
  end)

  it("that are exact are as good as numbers", function()
    assert.equal("0.25 2\n", stock [[
      local ambit = require "ambit"
      print(ambit.interval("1" / "4"):text(), ambit.interval("4" - 2):text(2)) ]]:gsub("\t", " "), nil)
  end)

  it("that wrapped around are refused until somebody has said what is meant, whole numbers too", function()
    for _, wrong in ipairs { '"4294967296" * "4294967296"', '"9223372036854775807" + 1', '-2 - "9223372036854775807"',
      '-"-9223372036854775808"', '"-9223372036854775808" // -1', '"0xffffffffffffffff" + 0',
      '"0x1" * " -0X10000000000000000"' } do
      local text = stock(([[
        local ambit = require "ambit"
        local x = %s
        print(select(2, pcall(ambit.number, x)))
        print((pcall(function() return ambit.number "1" + x end)))
        local still = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x } end }
        print((pcall(ambit.simulate, { still, initial = { x = "1" }, t = { "0", x } })))
        ambit.text_arithmetic(false)
        print((pcall(ambit.number, x))) ]]):format(wrong))
      assert.is_truthy(text:find ":2: Lua calculated with a text", wrong .. text)
      assert.equal("false\nfalse\ntrue\n", text:match "\n(.*)$", wrong .. text)
    end
    assert.equal("true\n", stock [[
      local ambit = require "ambit"
      local x = ("3037000499" * "3037000499" + "0x7fffffffffffffff" // "0x10") % "-7" - -"5"
      print((pcall(ambit.number, x))) ]])
  end)

  it("that are rounded are refused until somebody has said what is meant", function()
    local text = stock [[
      local ambit = require "ambit"
      local x = -"124.14"
      print(select(2, pcall(ambit.number, x)))
      print(select(2, pcall(ambit.interval, "1" / "3")))
      local still = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x } end }
      print((pcall(ambit.around, "1", "0.1" * 1)), (pcall(function() return ambit.number "2" ^ ("0.3" * 1) end)),
        (pcall(ambit.simulate, { still, initial = { x = 0 }, t = { 0, "0.3" * 1 } })),
        (pcall(ambit.simulate, { still, initial = { x = 0 }, t = { 0, 1 } })))
      print((pcall(ambit.number, 3)), (pcall(ambit.number, "124.14")))
      ambit.text_arithmetic(false)
      print((pcall(ambit.number, x)))
      ambit.text_arithmetic(true)
      print("1" / "3") ]]
    local lines = {}
    for line in text:gmatch "[^\n]+" do lines[#lines + 1] = line end
    for i = 1, 2 do
      assert.is_truthy(lines[i]:find ":2: Lua calculated with a text", lines[i])
      assert.is_truthy(lines[i]:find "ambit.text_arithmetic%(true%)", lines[i])
    end
    assert.equal("false\tfalse\tfalse\ttrue", lines[3])
    assert.equal("true\ttrue", lines[4])
    assert.equal("true", lines[5])
    assert.equal("1/3", lines[6])
  end)
end)
