-- Mechanisms that cannot be meant: one clear message that names the element, at the script's own file:line.
local ambit = require "ambit"

local function fails(f, ...)
  local good, problem = pcall(f)
  assert.is_false(good, "no error was raised")
  problem = tostring(problem)
  assert.truthy(problem:find "bad_structure_spec%.lua:%d+: ", problem)
  for _, text in ipairs { ... } do assert.truthy(problem:find(text, 1, true), problem) end
end

local count = 0
local function define(t)
  count = count + 1
  t[1] = t[1] or "bad_chain" .. count
  return ambit.chain(t), t[1]
end

describe("connections", function()
  it("to what belongs to another mechanism", function()
    local m, other = ambit.mechanism "m", ambit.mechanism "other"
    local frame, joint = other:revolute { from = other.world, name = "hinge" }
    fails(function() m:rigid_link { from = frame } end, "frame of hinge", "belongs to another mechanism, `other`")
    fails(function() m:joint_torque { joint = joint, torque = 1 } end, "joint of hinge", "`other`")
    fails(function() m:revolute { from = m.world, mimic = joint } end, "`other`")
    fails(function() m:gear { driver = joint, driven = joint, ratio = 1 } end, "gear: driver", "`other`")
    fails(function() m:position(frame) end, "`other`")
  end)

  it("to nothing: every frame hangs on the world by way of the frames before it", function()
    local m = ambit.mechanism "m"
    fails(function() m:rigid_link { offset = { 1, 0, 0 } } end, "rigid_link: port `from` is not connected")
    fails(function() m:rigid_body { mass = 1 } end, "rigid_body: port `at` is not connected")
    fails(function() m:gear { driver = m.world, ratio = 2 } end, "gear: ")
  end)

  it("of a loop to itself", function()
    local m = ambit.mechanism "m"
    local a, joint = m:revolute { from = m.world, name = "a" }
    fails(function() m:gear { driver = joint, driven = joint, ratio = 2 } end, "`driver` and `driven`",
      "are the same joint", "joint of a")
    fails(function() m:gear { driver = a, driven = joint, ratio = 2 } end, "the same joint")
    fails(function() m:close_point { a = a, b = a } end, "`a` and `b` are the same frame", "frame of a")
  end)

  it("of a loop that is closed already", function()
    local m = ambit.mechanism "m"
    local a = m:revolute { from = m.world, name = "a" }
    local b = m:revolute { from = m.world, name = "b" }
    local c = m:revolute { from = m.world, name = "c" }
    m:gear { driver = a, driven = b, ratio = 2, name = "first" }
    fails(function() m:gear { driver = a, driven = b, ratio = 3 } end, "the same joints as the gear `first`",
      "bad_structure_spec.lua:")
    fails(function() m:gear { driver = b, driven = a, ratio = "0.5" } end, "the same joints as the gear `first`")
    m:gear { driver = a, driven = c, ratio = 2 } -- another pair
    m:close_point { a = a, b = b, name = "pin" }
    fails(function() m:close_point { a = b, b = a } end, "the same frames as the close_point `pin`")
  end)

  it("of a loop that was refused may be made again", function()
    local m = ambit.mechanism "m"
    local a, b = m:revolute { from = m.world, name = "a" }, m:revolute { from = m.world, name = "b" }
    fails(function() m:close_distance { a = a, b = b, length = -1 } end, "must be positive")
    fails(function() m:close_distance { a = a, b = b, length = -1 } end, "must be positive")
    fails(function() m:close_point { a = a, b = b, nonsense = 1 } end, "unknown key `nonsense`")
    m:close_point { a = a, b = b }
  end)

  it("with a list that contains itself", function()
    local m = ambit.mechanism "m"
    local a, b, list = m:revolute { from = m.world, name = "a" }, m:revolute { from = m.world, name = "b" }, { 1, 2 }
    list[3] = list
    fails(function() m:close_revolute { a = a, b = b, axis = list } end, "close_revolute: axis", "lists within lists")
    fails(function() m:rigid_link { from = a, offset = list } end, "rigid_link: offset", "lists within lists")
  end)

  it("of a joint with several coordinates to what drives one", function()
    local m = ambit.mechanism "m"
    local ball = m:spherical { from = m.world, name = "ball" }
    local a = m:revolute { from = m.world, name = "a" }
    fails(function() m:gear { driver = a, driven = ball, ratio = 2 } end, "gear", "1 degree", "`ball` has 3")
    fails(function() m:gear { driver = a, driven = m.world, ratio = 2 } end, "driven", "joint")
  end)
end)

-- Variables are symbols that are found by name: two with one name would be one and the same.
describe("names of variables", function()
  local function two(name)
    local m = ambit.mechanism "m"
    local a, drive = m:revolute { from = m.world, name = "a" }
    local b, driven = m:revolute { from = m:rigid_link { from = a, offset = { 1, 0, 0 } }, name = name }
    m:point_mass { at = m:rigid_link { from = a, offset = { 1, 0, 0 } }, mass = 1 }
    m:point_mass { at = m:rigid_link { from = b, offset = { 1, 0, 0 } }, mass = 1 }
    return m, drive, driven, b
  end

  it("of a joint and a multiplier", function()
    local m, drive, driven = two "lambda_mesh"
    m:gear { driver = drive, driven = driven, ratio = 2, name = "mesh" }
    fails(function() m:dynamics() end, "gear `mesh`", "its multiplier `lambda_mesh`", "the name of another variable")
  end)

  it("of a joint and a force", function()
    local m = two "tau_a"
    fails(function() m:forward_dynamics() end, "joint `tau_a`", "the force along `a`")
    m:dynamics()
  end)

  it("of a joint and a speed", function()
    local m = ambit.mechanism "m"
    local ball = m:spherical_quaternion { from = m.world, name = "ball" }
    fails(function() m:revolute { from = ball, name = "ball'.1" } end, "revolute `ball'.1`", "before a dot")
    fails(function() m:revolute { from = ball, name = "ball''.2" } end, "before a dot")
    m:revolute { from = ball, name = "ball.1" }
    fails(function() m:dynamics() end, "its coordinate `ball.1` has the name of another variable")
  end)

  it("of rows of two loops", function()
    local m, drive, _, frame = two "b"
    local pin = m:rigid_link { from = frame, offset = { 1, 0, 0 } }
    local rocker, joint = m:revolute { from = m:rigid_link { from = m.world, offset = { 1, 0, 0 } }, name = "c" }
    m:close_pin { a = pin, b = m:rigid_link { from = rocker, offset = { "1.2", 0, 0 } }, name = "loop" }
    m:gear { driver = drive, driven = joint, ratio = 2, name = "loop.2" }
    fails(function() m:constraints() end, "the constraint `loop.2`", "one of `loop`")
    fails(function() m:dynamics() end, "the constraint `loop.2`")
  end)
end)

describe("chains", function()
  it("that are not defined properly", function()
    local build = function() return {} end
    fails(function() ambit.chain "leg" end, "chain", "table")
    fails(function() ambit.chain { build = build } end, "chain: name")
    fails(function() define { "two words", build = build } end, "two words")
    fails(function() define { "revolute", build = build } end, "there is an element of that name")
    fails(function() define { "position", build = build } end, "a mechanism has a method of that name")
    fails(function() define { "four_bar", build = build } end, "Ambit has a chain of that name")
    fails(function() define { parameter = {}, build = build } end, "`parameters`")
    fails(function() define {} end, "build", "function")
    fails(function() define { ports = { from = "fram" }, build = build } end, "from", "fram", "`frame`")
    fails(function() define { ports = { name = "frame" }, build = build } end, "`name` is taken")
    fails(function() define { ports = { x = "frame" }, parameters = { x = { "m" } }, build = build } end,
      "`x` is taken")
    fails(function() define { parameters = { x = { "metre" } }, build = build } end, "x", "metre")
    fails(function() define { parameters = { x = { "m", shape = "round" } }, build = build } end, "x", "round")
    fails(function() define { parameters = { x = { "m", "3 kg" } }, build = build } end, "x", "kg")
    fails(function() define { parameters = { x = { "m", "1,2", "doc", shape = "3" } }, build = build } end, "x")
    fails(function() define { parameters = { { "m" } }, build = build } end, "[1]")
  end)

  it("of one name", function()
    ambit.chain { "bad_twice", build = function() return {} end }
    fails(function() ambit.chain { "bad_twice", build = function() return {} end } end, "chain `bad_twice`",
      "taken by the chain of", "bad_structure_spec.lua:")
  end)

  it("used with wrong keys, values and connections", function()
    local leg, name = define { ports = { from = "frame", hinge = { "joint", optional = true } },
      parameters = { length = { "m", nil, "of the leg" }, side = { "1", "left", shape = "left|right" } },
      build = function(_, p) return { to = p.from } end }
    local m = ambit.mechanism "m"
    fails(function() m[name](m, { from = m.world, lenght = 1 }) end, "lenght", "`length`")
    fails(function() m[name](m, { from = m.world }) end, "length is required (of the leg)")
    fails(function() m[name](m, { length = 1 }) end, "port `from` is not connected")
    fails(function() m[name](m, { from = 3, length = 1 }) end, "from", "frame", "number")
    fails(function() m[name](m, { from = m.world, length = "3 s" }) end, "length", "s")
    fails(function() m[name](m, { from = m.world, length = {} }) end, "length", "table")
    fails(function() m[name](m, { from = m.world, length = 1, side = "rihgt" }) end, "side", "`right`")
    fails(function() m[name](m, { from = m.world, length = 1, hinge = m.world }) end, "hinge")
    fails(function() m[name](m, { from = m.world, length = 1, name = 3 }) end, "name")
    fails(function() m[name](m, { from = m.world, length = 1, name = "" }) end, "empty")
    fails(function() m[name](m, { from = m.world, length = 1, name = "x'" }) end, "time derivatives")
    fails(function() m[name] { from = m.world } end, "colon")
    fails(function() leg({}, {}) end, "expected a mechanism")
    fails(function() m:bad_chaim {} end, "did you mean `bad_chain")
  end)

  it("that return nothing, or what is none of theirs", function()
    local m, other = ambit.mechanism "m", ambit.mechanism "other"
    local _, nothing = define { build = function() end }
    fails(function() m[nothing](m, {}) end, nothing .. " `", "returned nothing", "return {")
    local _, number = define { build = function() return 3 end }
    fails(function() m[number](m, {}) end, "returned a number")
    local _, foreign = define { build = function() return { to = other.world } end }
    fails(function() m[foreign](m, {}) end, "another mechanism, `other`", "`to`")
    local _, empty = define { build = function() return {} end }
    local e = m[empty](m, {})
    fails(function() return e.foot end, "has no `foot`")
    fails(function() m:rigid_link { from = e } end, "from: expected a frame, got chain", "which has none")
    local _, several = define { ports = { from = "frame" },
      build = function(_, p) return { foot = p.from, knee = p.from } end }
    local s = m[several](m, { from = m.world })
    fails(function() m:rigid_link { from = s } end, "has several", "foot, knee")
    fails(function() return s.fot end, "`foot`")
  end)

  it("that ask for parameters they do not have, or change them", function()
    local m = ambit.mechanism "m"
    local _, asks = define { parameters = { length = { "m", 1 } }, build = function(_, p) return { p.lenght } end }
    fails(function() m[asks](m, {}) end, "no parameter `lenght`", "`length`")
    local _, sets = define { parameters = { length = { "m", 1 } }, build = function(_, p) p.length = 2 end }
    fails(function() m[sets](m, {}) end, "cannot be assigned")
  end)

  it("whose names clash", function()
    local m = ambit.mechanism "m"
    local _, name = define { ports = { from = "frame" },
      build = function(inner, p) return inner:revolute { from = p.from, name = "knee" } end }
    m[name](m, { from = m.world, name = "left" })
    fails(function() m[name](m, { from = m.world, name = "left" }) end, "`left`: the name is taken by the " .. name,
      "bad_structure_spec.lua:")
    fails(function() m:revolute { from = m.world, name = "left" } end, "revolute `left`",
      "the name is taken by the " .. name)
    fails(function() m:revolute { from = m.world, name = "left.knee" } end, "taken by the revolute `left.knee`")
    m:revolute { from = m.world, name = "hip" }
    fails(function() m[name](m, { from = m.world, name = "hip" }) end, "`hip`: the name is taken by the revolute `hip`")
    local _, twice = define { build = function(inner)
      inner:revolute { from = inner.world, name = "a" }
      inner:revolute { from = inner.world, name = "a" }
    end }
    fails(function() m[twice](m, { name = "c" }) end, "`c.a`", "taken")
  end)

  it("that build themselves without end", function()
    local m = ambit.mechanism "m"
    local name
    _, name = define { build = function(inner) return inner[name](inner, { name = "x" }) end }
    fails(function() m[name](m, {}) end, "chains within chains", "does `" .. name .. "` build itself without end?")
    local a = m:revolute { from = m.world, name = "after" }
    assert.equal("frame of after", tostring(a))
  end)
end)
