-- globals_spec.lua -- Ambit's own modules do not see what a scene makes of globals and libraries; nor does a scene see
-- globals of theirs.
local command = os.getenv "AMBIT_COMMAND"

local function shell(text)
  local pipe = assert(io.popen(text))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  return output, code
end

local function run(scene)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  assert(file:write(scene))
  file:close()
  local output, code = shell(("'%s' run --quiet %s 2>&1"):format(command, name))
  os.remove(name)
  output = output:gsub("[%d.]+ [mµ]+s", "TIME"):gsub(name, "SCENE"):gsub("SCENE, SHA%-256 %x+", "SCENE")
  return output, code
end

-- Everything that a scene can take away, methods of strings too.
local spoil = [[
local ambit, print, pairs = require "ambit", print, pairs
local stay = { _G = true }
getmetatable("").__index = function() return function() return "x" end end
for _, name in pairs { "string", "table", "math", "os", "io", "debug", "coroutine", "utf8" } do
  for key in pairs(_G[name]) do _G[name][key] = 3 end
end
for name in pairs(_G) do if not stay[name] then _G[name] = "spoilt" end end
]]

local body = [[
local f = ambit.ode { states = { "x" }, parameters = { k = ambit.around(1, "1%") },
  equations = function(s, p) return { x = -p.k * s.x } end }
print(ambit.evaluate { ambit.sin(ambit.around(1, "1%")), arithmetic = "affine" })
print(ambit.simulate { f, initial = { x = 1 }, t = 1, events = { { name = "half", g = function(s) return s.x - "0.5" end } } })
print(ambit.verify { f, initial = { x = 1 }, t = 1, safe = function(s) return 2 - s.x end })
print(ambit.sensitivity { f, initial = { x = 1 }, t = 1 })
print(ambit.roots { function(x) return x.x^2 - 2 end, box = { x = { 0, 2 } } })
print(ambit.sample { f, initial = { x = 1 }, t = 1, n = 3 })
print(ambit.reduce { f, initial = { x = 1 }, t = 1, outputs = { "x" }, error = { x = "0.1" } })
local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { ambit.around(1, "1%"), 0, 0 } }
m:point_mass { at = tip, mass = 1 }
print(ambit.equilibria { m:dynamics(), box = { q = { -1, 1 } } })
print(m:position(tip).x, m:mass_matrix())
]]

describe("what a scene makes of globals", function()
  it("changes no answer", function()
    local expected, code = run("local ambit = require 'ambit'\n" .. body)
    assert.equal(0, code, expected)
    local spoilt, spoilt_code = run(spoil .. body)
    assert.equal(expected, spoilt)
    assert.equal(0, spoilt_code)
  end)

  it("changes no message", function()
    for _, mistake in ipairs {
      "ambit.simulate { f, inital = 1 }", "ambit.evaluate { ambit.number 'one' }", "ambit.around(1)", "ambit.mechanism(3)",
      "ambit.ode { states = { 'x' }, equations = function(s) return { y = s.x } end }", "local x = ambit.nothing + 1",
      "ambit.ode { states = { 'x' }, equations = function(s) if s.x == 0 then return s end return s end }",
      "ambit.roots { box = {} }", "ambit.mechanism 'a':revolute { form = 1 }",
    } do
      local _, lines = spoil:gsub("\n", "")
      local expected, code = run("local ambit = require 'ambit'" .. ("\n"):rep(lines) .. mistake)
      local spoilt, spoilt_code = run(spoil .. mistake)
      assert.equal(1, code, mistake)
      assert.equal(expected, spoilt)
      assert.equal(1, spoilt_code)
    end
  end)

  it("holds in the scene: its methods of strings are its own", function()
    local output, code = run [[
local ambit = require "ambit"
local rep, format = string.rep, string.format
function string.twice(s) return rep(s, 2) end
function string.format() return "mine" end
print(("ab"):twice(), ("%d"):format(3), tostring(ambit.interval(1, 2)), ("x").nothing)
string = { rep = rep }
print(("ab"):rep(2), ("%d"):format(3))
ambit.evaluate { ambit.number "one" }]]
    assert.equal(1, code)
    assert.truthy(output:find("abab\tmine\t[1, 2]\tnil\nabab\tmine\n", 1, true), output)
    assert.truthy(output:find("\"one\" is no number: expected for example", 1, true), output)
  end)

  it("changes no number that is written, with a locale whose decimal point is a comma", function()
    local folder = os.tmpname()
    os.remove(folder)
    local made = os.execute(("mkdir %s && localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 2>/dev/null"):format(folder, folder))
    if not made then
      os.execute("rm -rf " .. folder)
      return print "localedef has no de_DE: not tried"
    end
    local scene = [[
print(os.setlocale(...))
local pieces = ambit.reduce { ambit.ode { states = { "x" }, equations = function(s) return { x = -"1.5" * s.x + "0.0001" } end },
  initial = { x = "0.5" }, t = { 0, "0.1" }, outputs = { "x" }, error = { x = "0.05" } }
print(pieces, pieces.ode:lua())
]] .. body
    local function answer(locale)
      local name = os.tmpname()
      local file = assert(io.open(name, "w"))
      assert(file:write("local ambit = require 'ambit'\n", scene))
      file:close()
      local output, code = shell(("LOCPATH=%s '%s' run --quiet %s %s 2>&1"):format(folder, command, name, locale))
      os.remove(name)
      output = output:gsub("[%d.,]+ [mµ]+s", "TIME"):gsub(name, "SCENE"):gsub("SCENE, SHA%-256 %x+", "SCENE")
      return output:gsub("^[^\n]*", ""), code, output:match "^[^\n]*"
    end
    local expected, code = answer "C"
    assert.equal(0, code, expected)
    local found, found_code, said = answer "de_DE.UTF-8"
    os.execute("rm -rf " .. folder)
    assert.equal("de_DE.UTF-8", said)
    assert.equal(expected, found)
    assert.equal(0, found_code)
  end)

  it("cannot take the place of Ambit's modules, nor forget what was not proved", function()
    local escape = [[
local f = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x^2 } end }
assert(ambit.simulate { f, initial = { 1 }, t = { 0, 2 } }.status == "unable")
]]
    for _, before in ipairs {
      "for name in pairs(package.loaded) do package.loaded[name] = nil end", "package.loaded['ambit.session'] = nil",
      "package.loaded['ambit.session'] = { worst = 'ok', add = print, finish = print, remember = print }",
      "for name in pairs(package.preload) do package.preload[name] = function() return {} end end package.searchers = {}",
      "require, package = nil",
    } do
      local output, code = run(("local ambit, require = require 'ambit', require\n%s\n%s"):format(before, escape))
      assert.equal(3, code, before .. "\n" .. output)
    end
    local output, code = run [[
local ambit = require "ambit"
for name in pairs(package.loaded) do package.loaded[name] = nil end
print(require "ambit" == ambit)]]
    assert.equal("true\n", output)
    assert.equal(0, code)
  end)

  it("holds of the metatable of strings in the scene, and changes no answer", function()
    local expected = run("local ambit = require 'ambit'\n" .. body)
    local output, code = run([[
local ambit = require "ambit"
local meta = getmetatable ""
assert(meta.__index == string and meta == getmetatable "other" and meta.__metatable == nil)
meta.__index = function(s, k) if type(k) == "number" then return string.sub(s, k, k) end return string[k] end
assert(("abc")[2] == "b" and ("abc"):rep(2) == "abcabc")
meta.__call = function(s, n) return s .. n end
assert(("abc")(1) == "abc1" and meta.__call)
local found = {}
for key, value in pairs(meta) do found[key] = value end
assert(found.__index == meta.__index and found.__call == meta.__call and found.__add and not found.__metatable)
meta.__index = { rep = function() return "mine" end }
assert(("abc"):rep(2) == "mine" and ("abc").sub == nil)
meta.__index = nil
local good, message = pcall(function() return ("abc"):rep(2) end)
assert(not good and string.find(message, "attempt to index a string value", 1, true))
]] .. body)
    assert.equal(expected, output)
    assert.equal(0, code)
  end)

  it("is not what Ambit makes of them", function()
    local known = {}
    for name in pairs(_G) do known[name] = true end
    local output, code = run [[
local known = {}
for name in pairs(_G) do known[name] = true end
local ambit = require "ambit"
ambit.evaluate { ambit.around(1, "1%") }
for name in pairs(_G) do if not known[name] then print(name) end end]]
    assert.equal("", output)
    assert.equal(0, code)
  end)
end)
