-- Tolerances laid on the data of a file by pattern.
local ambit = require "ambit"

local text = [[
<robot name="r">
  <link name="base"/>
  <joint name="shoulder_joint" type="revolute">
    <parent link="base"/><child link="upper_arm"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
  </joint>
  <link name="upper_arm"><inertial><origin xyz="0.2 0 0"/><mass value="4"/>
    <inertia ixx="0.1" ixy="0.01" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial></link>
  <joint name="elbow_joint" type="revolute">
    <parent link="upper_arm"/><child link="forearm"/><origin xyz="0.4 0 0" rpy="0.1 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <link name="forearm"><inertial><mass value="2"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
</robot>]]

local function load_with(t, ...)
  local name = os.tmpname()
  os.remove(name)
  name = name .. ".urdf"
  local file = assert(io.open(name, "w"))
  file:write(text)
  file:close()
  local good, result = pcall(ambit.load, { name, tolerances = t, ... })
  os.remove(name)
  return good, result
end

local function loaded(t)
  local good, result = load_with(t)
  assert.is_true(good, tostring(result))
  return result
end

-- { ["upper_arm.mass"] = enclosure, ... }
local function laid(m)
  local list = {}
  for _, datum in ipairs(m:tolerances()) do list[datum.name] = ambit.evaluate { datum.value } end
  return list
end

local function names(m)
  local list = {}
  for _, datum in ipairs(m:tolerances()) do list[#list + 1] = datum.name end
  table.sort(list)
  return list
end

local function says(t, part)
  local good, message = load_with(t)
  assert.is_false(good)
  assert.truthy(message:find(part, 1, true), ("%q does not say %q"):format(message, part))
end

describe("a tolerance", function()
  it("is laid on all data of its kind", function()
    local m = loaded { mass = "2%" }
    assert.same({ "forearm.mass", "upper_arm.mass" }, names(m))
    local mass = laid(m)
    assert.is_true(mass["upper_arm.mass"]:contains(ambit.interval(3.92, 4.08)))
    assert.is_true(mass["upper_arm.mass"]:width() < 0.16 + 1e-14)
    assert.equal("2%", m:tolerances()[1].tolerance)
  end)

  it("is one fresh unknown for each number", function()
    local m = loaded { mass = "2%" }
    local a, b = m:tolerances()[1].value, m:tolerances()[2].value
    assert.equal(0, ambit.evaluate({ a - a }):width())
    assert.is_true(ambit.evaluate({ a - b }):width() > 0.2)
  end)

  it("is correlated wherever the datum is used", function()
    local m = loaded { ["shoulder_joint.offset"] = "1 cm" }
    local upper, fore = m:position(m.links.upper_arm), m:position(m.links.forearm)
    local at = { shoulder_joint = 0, elbow_joint = 0 }
    assert.is_true(ambit.evaluate({ fore.z, at = at }):width() > 0.0199)
    assert.is_true(ambit.evaluate({ fore.z - upper.z, at = at }):width() < 1e-15)
  end)

  it("takes units, plain numbers and components", function()
    local m = loaded { ["elbow_*.offset.x"] = "5 mm", ["shoulder_joint.offset.z"] = 0.25, ["*.angle.roll"] = "1 deg" }
    assert.same({ "elbow_joint.angle.roll", "elbow_joint.offset.x", "shoulder_joint.angle.roll",
      "shoulder_joint.offset.z" }, names(m))
    local list = laid(m)
    assert.is_true(math.abs(list["elbow_joint.offset.x"].hi - 0.405) < 1e-15)
    assert.equal(0.25, list["shoulder_joint.offset.z"].lo)
    assert.is_true(math.abs(list["shoulder_joint.angle.roll"].hi - math.rad(1)) < 1e-15)
  end)

  it("prefers the more specific pattern", function()
    local list = laid(loaded { mass = "2%", ["upper_arm.mass"] = "0.5%", ["*arm.centre"] = "1 mm",
      ["*arm.centre.x"] = "2 mm" })
    assert.is_true(math.abs(list["upper_arm.mass"]:width() - 0.04) < 1e-14)
    assert.is_true(math.abs(list["forearm.mass"]:width() - 0.08) < 1e-14)
    assert.is_true(math.abs(list["forearm.centre.x"]:width() - 0.004) < 1e-14)
    assert.is_true(math.abs(list["forearm.centre.y"]:width() - 0.002) < 1e-14)
  end)

  it("leaves out what is zero in per cent, and what has tolerance 0", function()
    assert.same({ "elbow_joint.offset.x", "shoulder_joint.offset.z" }, names(loaded { offset = "1%" }))
    assert.same({ "upper_arm.mass" }, names(loaded { mass = "2%", ["forearm.mass"] = 0 }))
    assert.same({ "upper_arm.inertia" }, names(loaded { inertia = "2%", ["forearm.inertia"] = "0%" }))
    assert.same({ "upper_arm.centre.x", "upper_arm.centre.z" },
      names(loaded { ["upper_arm.centre"] = "1 mm", ["upper_arm.centre.y"] = "0 mm" }))
  end)

  it("leaves masses and inertias above zero", function()
    says({ mass = "100%" }, "`mass`: within 100% the mass of `upper_arm` can be zero or less")
    says({ ["forearm.mass"] = "3 kg" }, "`forearm.mass`: within 3 kg the mass of `forearm`")
    says({ inertia = "120%" }, "the inertia of `upper_arm` can be zero or less")
    loaded { mass = "99%", inertia = "99%", centre = "200%", offset = "100%" }
  end)

  it("scales an inertia as a whole, so that it stays one of a body", function()
    local m = loaded { inertia = "10%" }
    assert.same({ "forearm.inertia", "upper_arm.inertia" }, names(m))
    -- shoulder: izz f + m c^2 + ..., with one factor f in [0.9, 1.1]
    local M = ambit.evaluate { m:mass_matrix()[2][2], at = { shoulder_joint = 0, elbow_joint = 0 } }
    assert.is_true(math.abs(M.lo - 0.09) < 1e-14 and math.abs(M.hi - 0.11) < 1e-14)
    m = loaded { ["upper_arm.inertia.xy"] = "50%" }
    assert.same({ "upper_arm.inertia.xy" }, names(m))
    m = loaded { ["upper_arm.inertia"] = "0.001 kg m^2" }
    assert.equal(6, #names(m))
  end)

  it("can be said before loading", function()
    local name = os.tmpname()
    os.remove(name)
    name = name .. ".urdf"
    local file = assert(io.open(name, "w"))
    file:write(text)
    file:close()
    local m = ambit.mechanism "two"
    m:tolerances { mass = "1%", ["left.forearm.mass"] = "3%" }
    m:load { name, from = m.world, name = "left", tolerances = { ["forearm.centre"] = "1 mm" } }
    os.remove(name)
    local list = laid(m)
    assert.is_true(math.abs(list["left.forearm.mass"]:width() - 0.12) < 1e-14)
    assert.is_true(math.abs(list["left.upper_arm.mass"]:width() - 0.08) < 1e-14)
    assert.truthy(list["left.forearm.centre.y"])
  end)

  it("that meets nothing is a mistake", function()
    says({ ["forarm.mass"] = "2%" },
      "`forarm.mass` meets nothing: there is no such link with a body; did you mean `forearm`?")
    says({ ["elbow*.mass"] = "2%" }, "`elbow*.mass` meets nothing: there is no such link")
    says({ ["base.mass"] = "2%" }, "`base.mass` meets nothing: there is no such link with a body")
    says({ ["elbow.offset"] = "2 mm" }, "there is no such joint (there is: shoulder_joint, elbow_joint)")
    says({ ["forearm.centre"] = "2%" },
      "`forearm.centre` changes nothing: every number that it meets is 0, and 2% of that is 0")
  end)

  it("is a tolerance of a datum", function()
    says({ mas = "2%" }, "`mas` does not end in a datum; did you mean `mass`?")
    says({ ["forearm.mass.x"] = "2%" }, "mass has no component `x`")
    says({ ["offset.w"] = "2%" }, "offset has no component `w`")
    says({ mass = "2 m" }, "tolerances: mass: `2 m` is in m, but kg is expected")
    says({ offset = "1 kg" }, "tolerances: offset: `1 kg` is in kg, but m is expected")
    says({ mass = "-2%" }, "tolerances: mass: a tolerance is finite and not negative")
    says({ mass = -1 }, "tolerances: mass: a tolerance is finite and not negative")
    says({ mass = "much" }, "tolerances: mass:")
    says({ mass = {} }, 'tolerances: mass: expected a tolerance such as "2%" or "1 kg", got table')
    says({ "2%" }, "expected pattern = tolerance, got an entry [1]")
    says("2%", "tolerances: expected a table")
    says({ ["upper_*.mass"] = "1%", ["*er_arm.mass"] = "2%", ["forearm.mass"] = "1%" }, "both meet mass of `upper_arm`")
  end)
end)
