-- Limits of a robot's file: by how much they are exceeded, events, stops.
local ambit = require "ambit"

local function swing(more)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write([[
<robot name="swing">
  <link name="base"/>
  <joint name="arm" type="revolute">
    <parent link="base"/> <child link="rod"/> <axis xyz="0 1 0"/>
    <limit lower="-1" upper="0.8" velocity="6" effort="10"/>
  </joint>
  <link name="rod"><inertial><origin xyz="0 0 -1"/><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>]] .. (more or "") .. "\n</robot>")
  file:close()
  local m = ambit.load { name, gravity = { 0, 0, "-9.81" } }
  os.remove(name)
  return m
end

local slide = [[
  <joint name="tool" type="prismatic">
    <parent link="rod"/> <child link="tip"/> <axis xyz="1 0 0"/>
    <limit lower="0" upper="0.1" velocity="1" effort="1"/>
  </joint>
  <link name="tip"><inertial><mass value="0.1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="follower" type="revolute">
    <parent link="rod"/> <child link="leaf"/> <axis xyz="0 1 0"/> <mimic joint="arm" multiplier="2"/>
    <limit lower="-3" upper="1" velocity="9" effort="1"/>
  </joint>
  <link name="leaf"/>]]

local start = { arm = ambit.around("-0.9", "1%"), ["arm'"] = 0 }

describe("limits of a robot's file", function()
  it("are expressions that are above 0 beyond them, also of joints that follow", function()
    local at = { arm = "0.9", ["arm'"] = -7, tool = "-0.25", ["tool'"] = 0 }
    local x = ambit.evaluate { swing(slide):limit_excess(), at = at }
    local expected = { ["arm lower"] = -1.9, ["arm upper"] = 0.1, ["arm velocity"] = 1, ["tool lower"] = 0.25,
      ["tool upper"] = -0.35, ["tool velocity"] = -1, ["follower lower"] = -4.8, ["follower upper"] = 0.8,
      ["follower velocity"] = 5 }
    local count = 0
    for name, value in pairs(expected) do
      assert.is_true(math.abs(x[name]:mid() - value) < 1e-14, name)
      count = count + 1
    end
    for _ in pairs(x) do count = count - 1 end
    assert.equal(0, count)
  end)

  it("are watched, and proved to hold", function()
    local m = swing()
    local run = ambit.simulate { m, initial = start, t = "1.2", events = m:limit_events(), partial = true }
    assert.equal("arm upper", run.events[1].name)
    assert.is_true(run.events[1].certain and run.events[1].t.lo > 0.9 and run.events[1].t.hi < 0.95)
    assert.equal("proved", ambit.verify { m:dynamics(), initial = start, t = "0.5", safe = m:limit_excess() }.status)
    assert.equal("refuted", ambit.verify { m:dynamics(), initial = start, t = "1.1", safe = m:limit_excess() }.status)
  end)

  it("push back on request", function()
    local m = swing()
    assert.same({ "arm" }, m:limit_stops { stiffness = 500, damping = "0.2" })
    local x = ambit.evaluate { m:bias()[1] - m:gravity_torque()[1], at = { arm = "0.9", ["arm'"] = 2 } }
    assert.is_true(math.abs(x:mid() - 500 * 0.1 * 1.4) < 1e-12)
    x = ambit.evaluate { m:bias()[1] - m:gravity_torque()[1], at = { arm = "-1.1", ["arm'"] = -2 } }
    assert.is_true(math.abs(x:mid() + 500 * 0.1 * 1.4) < 1e-12)
    local run = ambit.simulate { m, initial = start, t = "1.2" }
    local hull = ambit.sample { m:dynamics(), initial = start, t = "1.2" }
    assert.equal("complete", run.status)
    assert.is_true(run.x.arm:width() < 1.5 * hull.x.arm:width())
  end)

  it("refuse what is missing", function()
    local good, message = pcall(function() swing():limit_stops {} end)
    assert.is_false(good)
    assert.is_truthy(message:find "stiffness is missing: the joint `arm` turns")
    good, message = pcall(function() swing(slide):limit_stops { stiffness = 1 } end)
    assert.is_false(good)
    assert.is_truthy(message:find "slide_stiffness is missing: the joint `tool` slides")
    good, message = pcall(function() ambit.mechanism("m"):limit_events() end)
    assert.is_false(good)
    assert.is_truthy(message:find "nothing has been loaded")
  end)
end)

describe("a model inside a controller", function()
  local function arm(name, payload, length)
    local m = ambit.mechanism { name, gravity = { 0, "-9.81", 0 } }
    local a, first = m:revolute { from = m.world, axis = "z", name = "a" }
    local elbow = m:rigid_link { from = a, offset = { length, 0, 0 } }
    local b, second = m:revolute { from = elbow, axis = "z", name = "b" }
    m:point_mass { at = elbow, mass = 2 }
    m:point_mass { at = m:rigid_link { from = b, offset = { "0.4", 0, 0 } }, mass = payload }
    return m, { a = first, b = second }
  end

  it("cancels a machine that is as the model: errors decay as linear equations", function()
    local machine, joints = arm("machine", 1, "0.5")
    local wanted, q = {}, machine:coordinates()
    for _, name in ipairs { "a", "b" } do wanted[name .. "''"] = -100 * q[name] - 20 * q[name .. "'"] end
    local torque = arm("model", 1, "0.5"):inverse_dynamics(wanted)
    for i, name in ipairs { "a", "b" } do machine:joint_torque { joint = joints[name], torque = torque[i] } end
    local run = ambit.simulate { machine, initial = { a = "0.5", b = "-0.3", ["a'"] = 0, ["b'"] = 0 }, t = "0.3" }
    local left = (1 + 3) * math.exp(-3) -- (1 + 10 t) e^(-10 t)
    assert.equal("complete", run.status)
    assert.is_true(math.abs(run.x.a:mid() - 0.5 * left) < 1e-9 and math.abs(run.x.b:mid() + 0.3 * left) < 1e-9)
  end)

  it("takes values by name, in their units", function()
    local m = arm("model", 1, "0.5")
    local tau = ambit.evaluate(m:inverse_dynamics { a = 0, b = 0, ["a'"] = 0, ["b'"] = 0, ["a''"] = 0, ["b''"] = 1 })
    assert.is_true(tau[2]:contains(0.4 * 9.81 + 0.16))
    local good, message = pcall(function() m:inverse_dynamics { c = 1 } end)
    assert.is_true(not good and message:find "inverse_dynamics: unknown key `c`" ~= nil)
    good, message = pcall(function() m:inverse_dynamics { ["a''"] = "1 m" } end)
    assert.is_true(not good and message:find "is in m" ~= nil)
  end)
end)
