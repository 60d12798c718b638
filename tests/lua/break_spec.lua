-- What was found by trying to break the verbs: each mistake is one message, at the scene's own line, that names the
-- thing.
local ambit = require "ambit"

local function message(f)
  local good, problem = pcall(f)
  assert.is_false(good, "no error was raised")
  problem = tostring(problem)
  assert.truthy(problem:find "break_spec%.lua:%d+: ", problem)
  return problem
end

local function fails(f, text) assert.truthy(message(f):find(text, 1, true), message(f)) end

local function pendulum()
  local m = ambit.mechanism { "m", gravity = { 0, "-9.81", 0 } }
  local hinge, joint = m:revolute { from = m.world, axis = "z", name = "a" }
  m:point_mass { at = m:rigid_link { from = hinge, offset = { 1, 0, 0 } }, mass = 1 }
  return m, joint
end

local function five_bar()
  local m = ambit.mechanism "loop"
  local at = m.world
  for i = 1, 4 do
    at = m:rigid_link { from = m:revolute { from = at, axis = "z", name = "q" .. i }, offset = { 1, 0, 0 } }
    m:point_mass { at = at, mass = 1 }
  end
  m:close_pin { a = at, b = m:rigid_link { from = m.world, offset = { 1, 0, 0 } }, name = "pin" }
  return m
end

describe("roots and equilibria", function()
  local box = { a = { -1, 1 } }

  it("want a table as `at`", function()
    local m = pendulum()
    for _, at in ipairs { 5, true, false } do
      fails(function() ambit.roots { ambit.sin(m:coordinates().a), box = box, at = at } end,
        "roots: at: expected a table")
      fails(function() ambit.equilibria { m, box = box, at = at } end, "equilibria: at: expected a table")
    end
  end)

  it("want an equation and an unknown", function()
    local m = pendulum()
    fails(function() ambit.roots { {}, box = box } end, "roots: there is no equation")
    fails(function() ambit.roots { ambit.sin(m:coordinates().a), box = {} } end, "roots: box is empty")
    fails(function() ambit.equilibria { m, box = {} } end, "equilibria: box is empty")
  end)

  it("refuse an option that contains itself, at once", function()
    local list = {}
    list[1] = list
    local m = pendulum()
    fails(function() ambit.roots { ambit.sin(m:coordinates().a), box = box, tolerance = list } end,
      "tolerance[1][1]: expected a number or a word, got lists within lists")
  end)
end)

describe("loops", function()
  it("refuse a coordinate that is named twice", function()
    fails(function() five_bar():independent { "q1", "q1" } end, "independent: `q1` is named twice")
    fails(function() five_bar():independent { 0 / 0 } end, "independent: there is no coordinate")
  end)

  it("refuse an empty range of any coordinate", function()
    fails(function() five_bar():rank { box = { q1 = { 1, 0 }, q2 = 0, q3 = 0, q4 = 0 } } end,
      "rank: box.q1: the range is empty: 1 is greater than 0")
  end)
end)

describe("chains", function()
  it("refuse a default that is an empty text", function()
    fails(function() ambit.chain { "blank", parameters = { x = { "m", "" } }, build = function() return {} end } end,
      "blank: x: the default is an empty text")
  end)

  it("show a NUL in a name as \\0", function()
    fails(function() ambit.chain { "a\0b", build = function() return {} end } end, "chain: `a\\0b` is no name")
  end)
end)
