-- == in equations: a comparison of an expression says nothing about its value, and is refused (docs/scenes.md). What is
-- fine stays fine: modes, names, loops, values that may be left out.
local ambit = require "ambit"
local bytecode = require "ambit.lint.bytecode"

local mode, flag = 3, false
local length = ambit.around(1, "1%")
local config = { law = "hertz", gain = 2, expression = length }
local rest = { x = 1, v = 2 }

local function ode(equations)
  return ambit.ode { states = { "x", "v" }, parameters = { k = 2 }, equations = equations }
end

local function sign(v)
  if v == 0 then return 0 end
  return v / ambit.abs(v)
end

local refused = {
  ["an integer"] = function(s) if s.x == 0 then return rest end return rest end,
  ["an integer by ~="] = function(s) if s.x ~= 0 then return rest end return rest end,
  ["a constant"] = function(s) if s.x == 0.5 then return rest end return rest end,
  ["a constant in front"] = function(s) if 0.5 == s.x then return rest end return rest end,
  ["a text"] = function(s) return { x = s.v, v = s.x == "left" and 1 or 2 } end,
  ["a number outside"] = function(s) if s.x == mode then return rest end return rest end,
  ["an enclosure"] = function(s) if s.x == ambit.interval(1) then return rest end return rest end,
  ["another state"] = function(s) if s.x == s.v then return rest end return rest end,
  ["a local"] = function(s) local x = s.x - 1 if x == 0 then return rest end return rest end,
  ["a parameter"] = function(_, p) if p.k == 2 then return rest end return rest end,
  ["the time"] = function(_, _, t) if t == 0 then return rest end return rest end,
  ["a function of Ambit"] = function(s) if ambit.abs(s.x) == 2 then return rest end return rest end,
  ["a datum outside"] = function() if length == 1 then return rest end return rest end,
  ["a datum in a table outside"] = function() if config.expression == 1 then return rest end return rest end,
  ["a state by a name"] = function(s)
    for _, name in ipairs { "x", "v" } do if s[name] == 0 then return rest end end
    return rest
  end,
  ["states in turn"] = function(s)
    for _, x in pairs(s) do if x == 0 then return rest end end
    return rest
  end,
  ["an argument of a function outside"] = function(s) return { x = s.v, v = -sign(s.v) } end,
  ["an argument of a function inside"] = function(s)
    local function choose(y) return y == 1 and 2 or 3 end
    return { x = s.v, v = choose(s.x) }
  end,
  ["a local of the function around"] = function(s)
    local x = s.x
    local function choose() return x == 1 and 2 or 3 end
    return { x = s.v, v = choose() }
  end,
  ["an expression behind what is changed elsewhere"] = function(s)
    local rates, shelf = {}, { y = 1 }
    for name in pairs(s) do rates[name], shelf[name] = s.v, 2 end
    local function note(y) rates.y = y end
    if s.x == 0 then note(1) end
    return rest
  end,
  ["what a helper returns on all its ways"] = function(s)
    local function twice(x) if mode == 4 then return 2 * x end return x + x end
    if twice(s.x) == 2 then return rest end
    return rest
  end,
  ["a local of a loop that a function inside has"] = function(s)
    for i = 1, 2 do
      local x = s.x * i
      local function choose() return x == 1 end
      if choose() then return rest end
    end
    return rest
  end,
  ["a condition"] = function(s) if s.x then return rest end return rest end,
  ["a condition with not"] = function(s) if not s.x then return rest end return rest end,
  ["a condition with and"] = function(s) return { x = s.v, v = s.x and 1 or 2 } end,
  ["the opposite"] = function(s) local a = not s.x return { x = s.v, v = a and 1 or 2 } end,
  ["an order"] = function(s) return { x = s.v, v = s.x < 1 and 1 or 2 } end,
}

local cache = {}
local shelf, list, number, helper = { x = length }, { length }, length, nil
local function sometimes(x) if mode == 4 then return 2 * x end end
local function set_number() number = 1 end
local function call(f) f() end
local hidden = { set_number }

-- Objects that answer nothing but with an error.
local function angry()
  local function no() error "do not touch" end
  return setmetatable({}, { __index = no, __newindex = no, __tostring = no, __name = 3, __pairs = no, __eq = no,
    __metatable = setmetatable({}, { __index = no }) })
end
local touchy = { angry(), angry(), inner = angry() }

local function optional(a, b)
  b = b or 1
  if b == nil then b = 2 end
  return a * b
end
local function given(a, b)
  if a then return a * b end
  return b
end

local accepted = {
  ["no comparison"] = function(s) return { x = s.v, v = -s.x } end,
  ["a mode"] = function(s) if mode == 3 then return { x = s.v, v = -s.x } end return rest end,
  ["a configuration"] = function(s)
    if config.law == "hertz" and config.gain ~= 3 then return { x = s.v, v = -s.x } end
    return rest
  end,
  ["an index"] = function(s)
    local sum = 0
    for i = 1, 3 do if i == 1 then sum = sum + s.x else sum = sum + i end end
    return { x = s.v, v = sum }
  end,
  ["nil"] = function(s)
    local y
    if mode == 3 then y = s.x end
    if y == nil then y = 1 end
    if s.x ~= nil then y = y + 1 end
    return { x = s.v, v = y }
  end,
  ["defaults"] = function(s, p, t)
    t = t or 0
    local k = p.k or 1
    return { x = s.v, v = k * s.x + t }
  end,
  ["arguments that may be left out"] = function(s)
    return { x = s.v, v = optional(s.x, s.v) + optional(s.x) + given(s.x, s.v) + given(nil, s.x) }
  end,
  ["names"] = function(s)
    local rates = {}
    for name in pairs(s) do rates[name] = name == "x" and s.v or -s.x end
    return rates
  end,
  ["types"] = function(s) if type(s.x) == "number" then return {} end return rest end,
  ["registers used again"] = function(s)
    local i, k, n = 1, 0, 0
    repeat
      local y = s.x * i
      i, k = i + 1, k + y
    until i == 4
    while n ~= 3 do n = n + 1 end
    return { x = s.v, v = k + n }
  end,
  ["what is changed"] = function(s)
    cache.x = cache.x or 1
    if cache.x == 1 then cache.x = 2 end
    local y = s.x
    local function set() y = 0 end
    set()
    if y == 0 then flag = true end
    return { x = s.v, v = cache.x }
  end,
  ["an expression on one way only"] = function(s)
    local y = 0
    if mode == 4 then y = s.x end
    if y == 0 then y = 1 end
    return { x = s.v, v = y }
  end,
  ["a function that returns nothing on one way"] = function(s)
    local y = sometimes(s.x)
    if y == 3 then return rest end
    if y then return { x = s.v, v = y } end
    return { x = s.v, v = -s.x }
  end,
  ["a local that is written behind the function that has it"] = function(s)
    local x = s.x
    local function choose() return x == 1 and 2 or 3 end
    x = 1
    return { x = s.v, v = choose() }
  end,
  ["a local that is written in a loop behind the function that has it"] = function(s)
    local x, choose = s.x, nil
    for i = 1, 2 do
      if i == 2 then x = 1 end
      choose = choose or function() return x end
    end
    return { x = s.v, v = choose() == 1 and 2 or 3 }
  end,
  ["a local that a function inside a function writes"] = function(s)
    local x = s.x
    local function outer() return function() x = 1 end end
    outer()()
    if x == 1 then return rest end
    return rest
  end,
  ["a table whose field has a key that is computed"] = function(s)
    for _, name in ipairs { "x", "v" } do shelf[name] = 1 end
    if shelf.x == 1 then return { x = s.v, v = -s.x } end
    return rest
  end,
  ["a table that is handed to a function of Lua"] = function(s)
    table.insert(list, 1, 1)
    if list[1] == 1 then return { x = s.v, v = -s.x } end
    return rest
  end,
  ["a variable outside that another function writes"] = function(s)
    number = length
    if mode == 3 then set_number() end
    if number == 1 then return { x = s.v, v = -s.x } end
    return rest
  end,
  ["a variable outside that a function writes, called by others"] = function(s)
    pcall(set_number)
    if number == 1 then call(set_number) end
    return { x = s.v, v = -s.x }
  end,
  ["a variable outside that a function nobody knows writes"] = function(s)
    for _, f in ipairs(hidden) do f() end
    if number == 1 then return { x = s.v, v = -s.x } end
    return rest
  end,
  ["a function that is made later"] = function(s)
    helper = helper or function(y) return y end
    if helper(1) == 1 then return { x = s.v, v = -s.x } end
    return rest
  end,
  ["objects that raise errors when they are touched"] = function(s)
    local one, two = touchy[1], touchy.inner
    local same = one ~= nil and rawequal(one, touchy[2]) or two == nil or optional == one
    local function take(object) return object end
    take(one) take(two)
    return { x = s.v, v = same and 1 or -s.x }
  end,
  ["comparisons of Ambit itself"] = function(s)
    local m = ambit.mechanism "a"
    m:point_mass { at = m.world, mass = 1 }
    return { x = s.v, v = m:centre_of_mass().x }
  end,
}
describe("equations", function()
  it("can be read as they were compiled", function() assert.is_true(bytecode.known) end)

  for name, equations in pairs(refused) do
    it("may not compare " .. name, function()
      local good, message = pcall(ode, equations)
      assert.is_false(good)
      local line = tonumber(message:match "equality_spec.lua:(%d+): ")
      local info = debug.getinfo(equations, "S")
      local own = line and line >= info.linedefined and line <= info.lastlinedefined
      assert.is_true(own or name == "an argument of a function outside", message)
      assert.is_truthy(message:find "expression", message)
    end)
  end

  for name, equations in pairs(accepted) do
    it("may use " .. name, function() assert.is_truthy(ode(equations)) end)
  end

  it("are found in functions without lines", function()
    local stripped = load(string.dump(function(s) if s.x == 0 then return s end return s end, true), "equations", "b")
    local good, message = pcall(ode, stripped)
    assert.is_false(good)
    assert.is_truthy(message:find("`x` is compared", 1, true), message)
  end)

  it("are searched whatever they are made of", function()
    local flow = require "ambit.lint.flow"
    local count = 0
    for _, module in pairs(package.loaded) do
      for _, f in pairs(type(module) == "table" and module or {}) do
        if type(f) == "function" and debug.getinfo(f, "S").what == "Lua" then
          flow.search(f, table.pack({}, length, 1, nil, "x"))
          count = count + 1
        end
      end
    end
    assert.is_true(count > 50, tostring(count))
  end)

  it("ask at run time what the search cannot see", function()
    local hidden = { function(a, b) return a == b end }
    local good, message = pcall(ode, function(s) return { x = s.v, v = hidden[1](s.x, s.v) and 1 or 2 } end)
    assert.is_false(good)
    assert.is_truthy(message:find("equality_spec.lua", 1, true) and message:find("==", 1, true), message)
  end)
end)

describe("other formulas are searched as well:", function()
  local system = ode(function(s) return { x = s.v, v = -s.x } end)
  local initial = { x = 1, v = 0 }
  local function bad(s) return s.x == 0 and 1 or 2 end

  local function fails(what, f)
    local good, message = pcall(f)
    assert.is_false(good)
    assert.is_truthy(message:find(what, 1, true) and message:find("`x` is compared", 1, true), message)
  end

  it("events, conditions, sections", function()
    fails("events[1].g", function() ambit.simulate { system, initial = initial, t = 1, events = { { g = bad } } } end)
    fails("safe", function() ambit.verify { system, initial = initial, t = 1, safe = bad } end)
    fails("section", function() ambit.poincare { system, initial = initial, t_max = 1, section = bad } end)
  end)

  it("resets, outputs, roots, laws", function()
    fails("reset", function()
      ambit.hybrid { modes = { a = { system, guards = { { g = function(s) return s.x end, to = "a",
        reset = function(s) return { x = bad(s) } end } } } }, initial = initial, t = 1 }
    end)
    fails("outputs", function()
      ambit.reduce { system, initial = initial, t = 1, outputs = { y = bad }, error = { y = 1 } }
    end)
    fails("roots", function() ambit.roots { bad, box = { x = { 0, 1 } } } end)
    local m = ambit.mechanism "m"
    local _, joint = m:revolute { from = m.world, axis = "z", name = "q" }
    local good, message = pcall(function()
      m:joint_torque { joint = joint, torque = function(q) if q == 0 then return 0 end return 1 end }
    end)
    assert.is_false(good)
    assert.is_truthy(message:find("joint_torque: torque", 1, true), message)
  end)

  it("outside of formulas == says whether two are the same formula", function()
    local x = ambit.between(0, 1)
    assert.is_true(x + 1 == 1 + x)
    assert.is_false(x == ambit.between(0, 1))
  end)
end)
