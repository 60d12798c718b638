-- Several mechanisms and systems as one: coupled laws against the same built in one mechanism, bad input.
local ambit = require "ambit"
local around = ambit.around

local function cart(m, name, mass)
  local at, joint = m:prismatic { from = m.world, axis = "x", name = name }
  m:point_mass { at = at, mass = mass, name = name .. " mass" }
  return joint
end

local function expect_error(f, pattern)
  local good, message = pcall(f)
  assert.is_false(good, pattern)
  assert.is_truthy(tostring(message):find(pattern), message)
end

-- Two carts with a spring between them, and a tank that one of them fills; k and the masses uncertain.
local function build(first, second)
  local k = around(40, "5%", "k")
  local a, b = cart(first, "a", around(1, "5%", "first")), cart(second, "b", around(2, "5%", "second"))
  local force = k * (second:coordinates().b - first:coordinates().a)
  first:joint_torque { joint = a, force = force }
  second:joint_torque { joint = b, force = -force }
end

describe("joined systems", function()
  it("are those of one mechanism", function()
    local first, second, both = ambit.mechanism "first", ambit.mechanism "second", ambit.mechanism "both"
    build(first, second)
    build(both, both)
    local tank = ambit.ode { "tank", states = { "level" }, parameters = { leak = around(1, "2%") },
      equations = function(s, p) return { level = first:coordinates().a - p.leak * s.level } end }
    local joined = ambit.join { "all", first, second:dynamics(), tank }
    assert.same({ "a", "a'", "b", "b'", "level" }, joined.states)
    assert.equal("all", joined.name)
    local start = { a = around(0, "0.01"), b = "0.5", ["a'"] = 0, ["b'"] = 0, level = 0 }
    local filled = ambit.simulate { joined, initial = start, t = 1 }
    assert.equal("complete", filled.status)
    assert.is_true(filled.x.level.lo > 0)
    start.level = nil
    local run = ambit.simulate { ambit.join { first, second }, initial = start, t = 1, solver = "zonotope" }
    local other = ambit.simulate { both, initial = start, t = 1, solver = "zonotope" }
    assert.equal("complete", run.status)
    for _, name in ipairs { "a", "b", "a'", "b'" } do
      assert.is_true(math.abs(run.x[name]:width() / other.x[name]:width() - 1) < 0.02, name)
      assert.is_true(math.abs(run.x[name]:mid() - other.x[name]:mid()) < 0.02 * other.x[name]:width(), name)
      assert.is_false(filled.x[name]:intersect(run.x[name]):is_empty(), name)
    end
    assert.equal("proved", ambit.verify { joined, t = 1, safe = first:coordinates().a - 1,
      initial = { a = 0, b = "0.5", ["a'"] = 0, ["b'"] = 0, level = 0 } }.status)
  end)

  it("need names of their own, and no loops", function()
    local first, second = ambit.mechanism "first", ambit.mechanism "second"
    cart(first, "a", 1)
    cart(second, "a", 1)
    expect_error(function() ambit.join { first, second } end, "`first` and `second` both have a state `a`")
    expect_error(function() ambit.join { first } end, "at least two")
    expect_error(function() ambit.join { first, 3 } end, "entry 2: expected a mechanism or an ambit.ode, got number")
    expect_error(function() ambit.join { first, second, solver = "x" } end, "unknown key `solver`")
    local ball = ambit.mechanism "ball"
    local at = ball:spherical_quaternion { from = ball.world, name = "q" }
    ball:rigid_body { at = at, mass = 1, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
    expect_error(function() ambit.join { first, ball } end, "`ball` has closed loops or quaternions")
  end)
end)
