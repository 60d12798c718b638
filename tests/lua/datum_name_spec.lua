-- One datum, one name: what verify, sensitivity, explain, split, reasons and expressions call an uncertain datum.
local ambit = require "ambit"
local core = require "ambit.core"
local session = require "ambit.session"
local uncertain = require "ambit.run.uncertain"

local around, between = ambit.around, ambit.between

local function names(...)
  local list = {}
  for i, leaf in ipairs(uncertain.leaves { ... }) do list[i] = leaf.name end
  return list
end

-- A pendulum whose arm and mass are uncertain, released from an uncertain angle.
local function pendulum(length)
  local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
  local joint = m:revolute { from = m.world, axis = "z", name = "angle" }
  local tip = m:rigid_link { from = joint, offset = { length, 0, 0 }, name = "upper" }
  m:point_mass { at = tip, mass = between(1, 2), name = "bob" }
  m:applied_force { at = tip, force = { "0.1", 0, 0 } }
  return m, tip
end

local start = { angle = 0, ["angle'"] = 0 }

local function has(text, part)
  if not tostring(text):find(part, 1, true) then error(("expected %q in %s"):format(part, tostring(text)), 2) end
end

describe("the name of a datum", function()
  it("is that of the element's parameter", function()
    local length = around(1, "1%")
    local m = pendulum(length)
    assert.same({ "upper.offset.x" }, names(length))
    local found = {}
    for _, name in ipairs(names(table.unpack(m:dynamics().rates))) do found[name] = true end
    assert.same({ ["upper.offset.x"] = true, ["bob.mass"] = true }, found)
  end)

  it("is the same in verify, sensitivity, split and reasons", function()
    local m, tip = pendulum(around(1, "1%"))
    local initial = { angle = around(0, "0.01"), ["angle'"] = 0 }
    local r = ambit.verify { m:dynamics(), initial = initial, t = { 0, "0.1" }, safe = 1 - m:position(tip).x }
    session.worst = "ok"
    assert.equal("refuted", r.status)
    has(r, "upper.offset.x = ")
    has(r, "bob.mass = ")
    has(r, "initial angle = ")
    assert.is_true(r.counterexample.data["upper.offset.x"].hi <= 1.01)
    assert.is_true(r.counterexample.data["initial angle"].hi <= 0.01)
    local s = ambit.sensitivity { m:dynamics(), initial = start, t = { 0, "0.1" } }
    has(table.concat(s.wrt, " "), "upper.offset.x")
    has(table.concat(s.wrt, " "), "bob.mass")
    s = ambit.sensitivity { m:dynamics(), initial = start, t = { 0, "0.1" }, wrt = { "bob.mass" } }
    assert.is_true(s:d("angle", "bob.mass"):is_bounded())
    local run = ambit.simulate { m:dynamics(), initial = start, t = { 0, "0.1" }, solver = "lohner",
      split = { ["upper.offset.x"] = 2 }, width_max = 1e-9 }
    session.worst = "ok"
    has(run.reason, "upper.offset.x in [0.99, 1]")
  end)

  it("is a parameter's, a state's at the start, or that of the equation it stands in", function()
    local k, x = around(2, "1%"), around(1, "1%")
    local inside = between(0, 1)
    local f = ambit.ode { states = { "x" }, parameters = { k = k },
      equations = function(s, p) return { x = inside - p.k * s.x } end }
    ambit.simulate { f, initial = { x = x }, t = { 0, "0.01" } }
    assert.same({ "k", "initial x", "derivative of x" }, names(k, x, inside))
  end)

  it("is that of its first use", function()
    local d = around(2, "1%")
    ambit.ode { states = { "x" }, parameters = { b = 2 * d, a = d },
      equations = function(s, p) return { p.a + p.b } end }
    assert.same({ "a" }, names(d))
  end)

  it("is what the script says, wherever the datum is used", function()
    local m = pendulum(around(1, "1%", "arm length"))
    has(table.concat(ambit.sensitivity { m:dynamics(), initial = start, t = { 0, "0.1" } }.wrt, " "), "arm length")
    assert.same({ "speed" }, names(between(1, 2, "speed")))
    assert.same({ "load" }, names(2 + around(between(1, 2, "load"), 0))) -- no tolerance: the same datum
    has(select(2, pcall(between, 1, 2, 3)), "between: expected a name for the datum")
    has(select(2, pcall(around, 1, 2, "")), "around: expected a name for the datum")
  end)

  it("tells two data of one parameter apart", function()
    local m = pendulum(between(1, 2) + between(0, "0.1"))
    has(table.concat(names(table.unpack(m:dynamics().rates)), ", "), "upper.offset.x, upper.offset.x (2)")
  end)

  it("tells data of one given name apart by their lines", function()
    local first = between(1, 2, "gap")
    local second = between(1, 2, "gap")
    local both = names(first, second)
    assert.truthy(both[1]:find "^gap %(.*datum_name_spec.lua:%d+%)$", both[1])
    assert.not_equal(both[1], both[2])
    local same = {}
    for i = 1, 2 do same[i] = between(i, 3, "gap") end
    both = names(same[1], same[2])
    assert.equal(both[1] .. " (2)", both[2])
  end)

  it("is made of the range and the line where a datum was not used yet", function()
    assert.truthy(names(between(1, 2))[1]:find "^datum in %[1, 2%] %(.*datum_name_spec.lua:%d+%)$")
    assert.equal("2*[1, 2]", tostring(2 * between(1, 2)))
  end)

  it("is a part's where the part makes the datum", function()
    local m = ambit.mechanism "m"
    local at = m:sloppy_joint { from = m.world, axis = "z", angle = 0, play = "0.1", name = "elbow" }
    assert.same({ "elbow.play", "elbow.play (2)" }, names(m:position(at).x, m:position(at).y))
  end)

  it("stays apart from states of the same name, where scenarios replace data", function()
    local x = between(1, 2, "x")
    local function model() return ambit.ode { states = { "x" }, equations = function(s) return { x = x - s.x } end } end
    local r = ambit.certify { model(), model(), t = { 0, 1 }, initial = { x = 0 }, outputs = { "x" },
      parameters = { [x] = between(1, 3) }, error = { x = 1 } }
    assert.equal("proved", r.status)
    assert.is_true(r.error.x < 1e-9)
  end)
end)
