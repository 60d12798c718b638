-- URDF files: what they become, and what is said about those that cannot become anything.
local ambit = require "ambit"

local function file_with(text, suffix)
  local name = os.tmpname()
  os.remove(name)
  name = name .. (suffix or ".urdf")
  local file = assert(io.open(name, "wb"))
  file:write(text)
  file:close()
  return name
end

local function load_text(text, t)
  local name = file_with(text)
  local request = { name }
  for key, value in pairs(t or {}) do request[key] = value end
  local good, result = pcall(ambit.load, request)
  os.remove(name)
  return good, result, name
end

local function loaded(text, t)
  local good, result = load_text(text, t)
  assert.is_true(good, tostring(result))
  return result
end

-- The message, without the name of the file.
local function refused(text, t)
  local good, message, name = load_text(text, t)
  assert.is_false(good)
  local place = message:find(name, 1, true)
  return place and "FILE" .. message:sub(place + #name) or message
end

local function robot(body) return '<robot name="r">\n' .. body .. "\n</robot>\n" end
local function joint(name, kind, parent, child, rest)
  return ('<joint name="%s" type="%s"><parent link="%s"/><child link="%s"/>%s</joint>\n'):format(name, kind, parent,
    child, rest or "")
end
local function inertial(mass, diagonal, origin)
  return ('<inertial>%s<mass value="%s"/><inertia ixx="%s" ixy="0" ixz="0" iyy="%s" iyz="0" izz="%s"/></inertial>')
    :format(origin or "", mass, diagonal[1], diagonal[2], diagonal[3])
end
local function link(name, body) return ('<link name="%s">%s</link>\n'):format(name, body or "") end

local function value(e, at) return ambit.evaluate { e, at = at } end
local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-14), ("%s is not %s"):format(tostring(x), y))
end

local arm = robot(link "base" .. joint("hinge", "revolute", "base", "arm",
  '<origin xyz="1 2 3" rpy="0.1 0.2 0.3"/><axis xyz="0 0 2"/>'
    .. '<limit lower="-1.5" upper="1.5" effort="10" velocity="3"/>')
  .. link("arm", inertial("2", { "0.1", "0.2", "0.25" }, '<origin xyz="0.5 0 0" rpy="0 0 0.3"/>'))
  .. joint("slide", "prismatic", "arm", "hand", '<origin xyz="1 0 0"/>') .. link("hand", inertial("0.5", { 0, 0, 0 })))

describe("a URDF", function()
  it("gives frames by link and coordinates by joint", function()
    local m = loaded(arm)
    assert.equal("r", m.name)
    local x = m:coordinates()
    assert.truthy(x.hinge and x["hinge'"] and x.slide)
    near(value(m:position(m.links.hand), { hinge = 0, slide = 0 }).z, 3 - math.sin(0.2))
    assert.equal(m.links.arm, m:link "arm")
    local _, problem = pcall(function() return m.links.hamd end)
    assert.truthy(problem:find("there is no link `hamd`; did you mean `hand`?", 1, true))
  end)

  it("takes the x axis where a joint names none", function()
    local m = loaded(arm)
    local p = value(m:position(m.links.hand), { hinge = 0, slide = "0.7" })
    local pitch, yaw = 0.2, 0.3
    near(p.x, 1 + 1.7 * math.cos(yaw) * math.cos(pitch))
    near(p.y, 2 + 1.7 * math.sin(yaw) * math.cos(pitch))
    near(p.z, 3 - 1.7 * math.sin(pitch))
  end)

  it("turns by Rz(yaw) Ry(pitch) Rx(roll)", function()
    local m = loaded(arm)
    local r, c, s = value(m:orientation(m.links.arm), { hinge = 0 }), math.cos, math.sin
    local a, b, g = 0.1, 0.2, 0.3 -- roll, pitch, yaw
    local expected = {
      { c(g) * c(b), c(g) * s(b) * s(a) - s(g) * c(a), c(g) * s(b) * c(a) + s(g) * s(a) },
      { s(g) * c(b), s(g) * s(b) * s(a) + c(g) * c(a), s(g) * s(b) * c(a) - c(g) * s(a) },
      { -s(b), c(b) * s(a), c(b) * c(a) },
    }
    for i = 1, 3 do
      for j = 1, 3 do near(r[i][j], expected[i][j], 1e-15) end
    end
  end)

  it("turns the inertia of a body with its origin", function()
    local m = loaded(robot(link "base" .. joint("q", "revolute", "base", "body", '<axis xyz="1 0 0"/>')
      .. link("body", inertial("1", { 1, 2, "2.5" }, '<origin rpy="0.4 0.5 0.6"/>'))))
    -- the moment about x of R diag(1, 2, 2.5) R^T is the sum over R_1i^2 I_i
    local a, b, g = 0.4, 0.5, 0.6
    local c, s = math.cos, math.sin
    local row = { c(g) * c(b), c(g) * s(b) * s(a) - s(g) * c(a), c(g) * s(b) * c(a) + s(g) * s(a) }
    near(value(m:mass_matrix()[1][1], { q = 1 }), row[1] ^ 2 + 2 * row[2] ^ 2 + 2.5 * row[3] ^ 2, 1e-15)
  end)

  it("takes decimals as decimals", function()
    local m = loaded(robot(link "a" .. joint("j", "fixed", "a", "b", '<origin xyz="0.1 0.2 +3e-1"/>') .. link "b"))
    local p = value(m:position(m.links.b))
    for i, text in ipairs { "0.1", "0.2", "0.3" } do
      local exact = ambit.interval(text)
      assert.equal(exact.lo, p[i].lo)
      assert.equal(exact.hi, p[i].hi)
    end
  end)

  it("welds fixed joints without a cost", function()
    local function size(kind)
      local m = loaded(robot(link "base" .. joint("q", "revolute", "base", "a") .. link("a", inertial(1, { 1, 1, 1 }))
        .. (kind and joint("f", "fixed", "a", "b", kind) .. link "b" or "")))
      return ambit.evaluate({ m:mass_matrix(), at = { q = 1 } }).report.tape_instructions
    end
    assert.equal(size(nil), size "")
    assert.equal(size(nil), size '<origin xyz="1 2 3" rpy="1 2 3"/>')
  end)

  it("carries bodies behind fixed joints rigidly", function()
    local m = loaded(robot(link "base" .. joint("q", "continuous", "base", "a", '<axis xyz="0 0 1"/>') .. link "a"
      .. joint("f", "fixed", "a", "b", '<origin xyz="2 0 0" rpy="0 0 1"/>')
      .. link("b", inertial("3", { 1, 1, "0.5" }, '<origin xyz="1 0 0"/>'))))
    local x, y = 2 + math.cos(1), math.sin(1)
    near(value(m:mass_matrix()[1][1], { q = 1 }), 0.5 + 3 * (x ^ 2 + y ^ 2), 1e-13)
  end)

  it("has floating and planar joints", function()
    local m = loaded(robot(link "w" .. joint("f", "floating", "w", "a") .. link("a", inertial(1, { 1, 1, 1 }))))
    assert.equal(6, #m:mass_matrix())
    for _, axis in ipairs { "1 0 0", "0 -1 0", "0 0 3", "1 2 3", "-2 0 1" } do
      m = loaded(robot(link "w" .. joint("p", "planar", "w", "a", ('<axis xyz="%s"/>'):format(axis))
        .. link("a", inertial(1, { 1, 1, 1 }))))
      local n = {}
      for word in axis:gmatch "%S+" do n[#n + 1] = tonumber(word) end
      local p = value(m:position(m.links.a), { ["p.1"] = "0.3", ["p.2"] = "-0.7" })
      near(n[1] * p.x + n[2] * p.y + n[3] * p.z, 0) -- in the plane
      near(p.x * p.x + p.y * p.y + p.z * p.z, 0.09 + 0.49)
      local r = value(m:orientation(m.links.a), { ["p.3"] = 1 })
      near(r[1][1] + r[2][2] + r[3][3], 1 + 2 * math.cos(1)) -- turned by 1 about ...
      near(r[1][1] * n[1] + r[1][2] * n[2] + r[1][3] * n[3], n[1]) -- ... the axis
      if axis == "0 0 3" then near(p.x, 0.3) end
      local length = math.sqrt(n[1] ^ 2 + n[2] ^ 2 + n[3] ^ 2)
      near(r[2][1] - r[1][2], 2 * math.sin(1) * n[3] / length)
    end
  end)

  it("keeps limits as exact numbers", function()
    local m = loaded(arm)
    local limits = m:limits().hinge
    local swept = ambit.evaluate { m:coordinates().hinge, at = { hinge = ambit.between(limits.lower, limits.upper) } }
    assert.equal(-1.5, swept.lo)
    assert.equal(1.5, swept.hi)
    assert.equal("10", tostring(limits.effort))
    assert.same({}, m:limits().slide)
  end)

  it("lets joints mimic others", function()
    local m = loaded(robot(link "base"
      .. joint("right", "prismatic", "base", "b",
        '<axis xyz="0 -1 0"/><mimic joint="left" multiplier="2" offset="0.1"/>')
      .. link("b", inertial(3, { 0, 0, 0 }))
      .. joint("left", "prismatic", "base", "a", '<axis xyz="0 1 0"/>') .. link("a", inertial(5, { 0, 0, 0 }))))
    near(value(m:position(m.links.b), { left = "0.25" }).y, -0.6)
    assert.equal(1, #m:mass_matrix())
    near(value(m:mass_matrix()[1][1], { left = 0 }), 5 + 4 * 3)
  end)

  it("adds what the file says about friction only when asked", function()
    local text = robot(link "base" .. joint("q", "prismatic", "base", "a", '<dynamics damping="4" friction="0"/>')
      .. link("a", inertial(2, { 0, 0, 0 })))
    local plain, damped = loaded(text), loaded(text, { damping = true })
    near(value(plain:dynamics():rate "q'", { q = 0, ["q'"] = 3 }), 0)
    near(value(damped:dynamics():rate "q'", { q = 0, ["q'"] = 3 }), -6)
    assert.truthy(plain.links.a and damped.links.a) -- held until here: the names of a mechanism go with it
  end)

  it("passes over what has nothing to do with mechanics", function()
    local m = loaded('<?xml version="1.0" encoding="utf-8"?>\n<!-- a comment -->\n' .. robot('<material name="grey"/>'
      .. link("base", '<visual><geometry><mesh filename="package://a/b.dae"/></geometry></visual><collision/>'
        .. '<drake:proximity_properties/>')
      .. joint("j", "fixed", "base", "tip", '<axis xyz="0 0 0"/><safety_controller k_velocity="x"/>') .. link "tip"
      .. '<transmission name="t"><joint name="j"><hardwareInterface>e</hardwareInterface></joint></transmission>'
      .. '<gazebo reference="base"><plugin name="x"/></gazebo><drake:collision_filter_group name="g"/>'
      .. '<frame name="f" link="base" xyz="0 0 1"/>'))
    assert.truthy(m.links.tip)
  end)

  it("takes a massless link as a frame", function()
    local m = loaded(robot(link("base", inertial(0, { 0, 0, 0 })) .. joint("q", "revolute", "base", "a")
      .. link("a", inertial(1, { 1, 1, 1 })) .. joint("f", "fixed", "a", "b") .. link("b", inertial(0, { 0, 0, 0 }))))
    near(value(m:mass_matrix()[1][1], { q = 1 }), 1)
  end)

  it("may have a link called world that weighs something", function()
    local m = loaded(robot(link("world", inertial(2, { 1, 1, 1 })) .. joint("q", "revolute", "world", "a")
      .. link("a", inertial(1, { 1, 1, 1 }))))
    assert.equal(m.world, m.links.world)
    near(value(m:mass_matrix()[1][1], { q = 1 }), 1)
    m = loaded(robot(link "base" .. joint("q", "revolute", "base", "world") .. link("world", inertial(1, { 3, 1, 3 }))))
    near(value(m:mass_matrix()[1][1], { q = 1 }), 3)
  end)

  it("goes into a mechanism twice", function()
    local m = ambit.mechanism { "two", gravity = { 0, 0, "-9.81" } }
    local column = m:rigid_link { from = m.world, offset = { 0, 0, 10 } }
    local name = file_with(arm)
    local left = m:load { name, from = column, name = "left" }
    local right = m:load { name, from = m.world, name = "right" }
    os.remove(name)
    assert.equal(left.hand, m.links["left.hand"])
    near(value(m:position(left.base)).z, 10)
    near(value(m:position(right.base)).z, 0)
    assert.equal(4, #m:mass_matrix())
    assert.truthy(m:coordinates()["left.hinge"])
    assert.truthy(m:limits()["right.hinge"].lower)
  end)

  it("uses joints as connections", function()
    local m = loaded(arm)
    m:joint_torque { joint = m.joints.slide, force = "0.5" }
    near(value(m:dynamics():rate "slide'", { hinge = 0, slide = 0, ["hinge'"] = 0, ["slide'"] = 0 }), 1, 2)
  end)
end)

describe("a bad URDF", function()
  local function says(text, ...)
    local message = refused(text)
    for _, part in ipairs { ... } do
      assert.truthy(message:find(part, 1, true), ("%q does not say %q"):format(message, part))
    end
  end
  local one = link "a"

  it("that is not XML is named with line and column", function()
    says("<robot>\n<link name='a'>\n</robot>", "FILE:3:", "mismatched tag")
    says("", "FILE:1:", "no element found")
    says("hello", "FILE:1:", "syntax error")
    says("<robot><link name='a' name='b'/></robot>", "FILE:1:", "duplicate attribute")
  end)

  it("that is another kind of XML is named", function()
    says("<sdf><model/></sdf>", "FILE:1: expected a URDF", "got <sdf>")
    says("<robot/>", "FILE:1: there is no link in the file")
  end)

  it("needs every link", function()
    says(robot(one .. "\n" .. joint("elbow", "revolute", "a", "forarm") .. link "forearm"),
      "FILE:4: joint `elbow`: its child link `forarm` is not in the file; did you mean `forearm`?")
    says(robot(one .. joint("j", "revolute", "b", "a")), "FILE:3: joint `j`: its parent link `b` is not in the file")
  end)

  it("has one root", function()
    says(robot(one .. link "b"), "FILE:3: link `b`: hangs on no joint, like link `a` in line 2: a robot has one root")
  end)

  it("has no cycle and no link that hangs twice", function()
    says(robot(one .. link "b" .. joint("j", "fixed", "a", "b") .. joint("k", "fixed", "b", "a")),
      "in a cycle: `a`, `b`, `a`")
    says(robot(one .. joint("j", "fixed", "a", "a")), "in a cycle: `a`, `a`")
    says(robot(one .. link "b" .. link "c" .. joint("j", "fixed", "a", "b") .. joint("k", "fixed", "c", "b")),
      "FILE:6: joint `k`: link `b` hangs on a joint already: `j`, line 5")
  end)

  it("uses a name once", function()
    says(robot(one .. one), "FILE:3: link `a`: the name is taken already, in line 2")
    says(robot(one .. link "b" .. link "c" .. joint("j", "fixed", "a", "b") .. joint("j", "fixed", "a", "c")),
      "FILE:6: joint `j`: the name is taken already, in line 5")
  end)

  it("knows the types of joints", function()
    says(robot(one .. link "b" .. joint("j", "revolut", "a", "b")),
      "FILE:4: joint `j`: unknown type `revolut`; did you mean `revolute`?")
    says(robot(one .. link "b" .. '<joint name="j"><parent link="a"/><child link="b"/></joint>'),
      "FILE:4: joint `j`: <joint> needs the attribute `type`")
  end)

  it("says what is missing", function()
    says(robot "<link/>", "FILE:2: a <link> without a name")
    says(robot(one .. link "b" .. '<joint name="j" type="fixed"><parent link="a"/></joint>'),
      "FILE:4: joint `j`: <joint> has no <child>")
    says(robot(one .. link "b" .. '<joint name="j" type="fixed"><parent/><child link="b"/></joint>'),
      "FILE:4: joint `j`: <parent> needs the attribute `link`")
    says(robot(link("a", "<inertial><mass value='1'/></inertial>")), "FILE:2: link `a`: <inertial> has no <inertia>")
    says(robot(link("a", "<inertial><mass value='1'/><inertia ixx='1'/></inertial>")),
      "FILE:2: link `a`: <inertia> needs the attribute `ixy`")
    says(robot(link("a", "<inertial><mass/><inertia/></inertial>")), "<mass> needs the attribute `value`")
    says(robot(one .. link "b" .. joint("j", "revolute", "a", "b", "<axis/>")), "<axis> needs the attribute `xyz`")
    says(robot(one .. link "b" .. joint("j", "fixed", "a", "b", "<origin/><origin/>")), "a second <origin>")
  end)

  it("has numbers that are numbers", function()
    local function axis(text) return robot(one .. link "b" .. joint("j", "revolute", "a", "b", text)) end
    says(axis '<axis xyz="0 0 one"/>', "FILE:4: joint `j`: xyz of <axis>: expected a number, got `one`")
    says(axis '<axis xyz="0 1"/>', "xyz of <axis>: expected three numbers, got 2")
    says(axis '<origin rpy="0 nan 0"/>', "rpy of <origin>: expected a number, got `nan`")
    says(axis '<origin rpy="0 0x10 0"/>', "expected a number, got `0x10`")
    says(axis '<origin xyz="0 1e999 0"/>', "1e999 is too large")
    says(axis '<origin xyz="0 ${x} 0"/>', "is an expression of xacro")
    says(axis '<limit lower="" upper="1"/>', "lower of <limit>: expected one number, got 0")
    says(axis '<axis xyz="0 0 0"/>', "FILE:4: joint `j`: the axis is zero")
    says(axis '<dynamics damping="high"/>', "damping of <dynamics>: expected a number, got `high`")
    says(robot(link("a", inertial("5 kg", { 1, 1, 1 }))),
      "FILE:2: link `a`: value of <mass>: expected one number, got 2")
    says(robot(link("a", inertial("5kg", { 1, 1, 1 }))), "value of <mass>: expected a number, got `5kg`")
  end)

  it("has bodies that can exist", function()
    says(robot(link("a", inertial("-1", { 1, 1, 1 }))), "FILE:2: link `a`: the mass is negative: -1 kg")
    says(robot(link("a", inertial("0", { 1, 1, 1 }))), "FILE:2: link `a`: has moments of inertia but no mass")
    says(robot(link("a", inertial("1", { 3, 1, 1 }))), "FILE:2: link `a`: no body has this inertia")
    says(robot(link("a", inertial("1", { 1, -1, 1 }))), "no body has this inertia")
    says(robot(link("a", '<inertial><mass value="1"/>'
      .. '<inertia ixx="1" iyy="1" izz="1" ixy="2" ixz="0" iyz="0"/></inertial>')),
      "no body has this inertia")
    says(robot(one .. joint("j", "revolute", "a", "b") .. link("b", inertial("0", { 0, 0, 0 }))),
      "FILE:4: link `b`: the mass is zero, and joint `j` (line 3) moves nothing else")
  end)

  it("takes inertias of no body on request", function()
    local text = robot(link("a", inertial("1", { 0.0333, 0.0333, 0.0667 })))
    says(text, "`physical = false` takes it as it is")
    loaded(text, { physical = false })
  end)

  it("mimics what can be mimicked", function()
    local function follower(of, more)
      return robot(one .. link "b" .. link "c" .. joint("j", "revolute", "a", "b", '<mimic joint="' .. of .. '"/>')
        .. joint("k", "revolute", "a", "c", more))
    end
    says(follower "kk", "FILE:5: joint `j`: mimics joint `kk`, which is not in the file")
    says(follower "j", "mimic each other in a cycle: `j`, `j`")
    says(follower("k", '<mimic joint="j"/>'), "mimic each other in a cycle: `j`, `k`, `j`")
    says(robot(one .. link "b" .. link "c" .. joint("j", "revolute", "a", "b", '<mimic joint="k"/>')
      .. joint("k", "fixed", "b", "c")), "cannot mimic `k`: that is fixed")
    says(robot(one .. link "b" .. link "c" .. joint("j", "revolute", "a", "b", '<mimic joint="k"/>')
      .. joint("k", "revolute", "b", "c")), "FILE:5: joint `j`: mimics joint `k`, which hangs on it")
  end)

  it("does not hide what would change the motion", function()
    says(robot(one .. '<loop_joint name="l"/>'), "FILE:3: <loop_joint> is a joint that closes a loop")
    says(robot(one .. '<drake:joint name="l" type="ball"/>'), "<drake:joint> is a joint")
    says(robot(one .. '<xacro:arm parent="a"/>'), "FILE:3: <xacro:arm> is a command of xacro: expand the file")
  end)

  it("has names that can be names", function()
    says(robot(one .. link "b" .. joint("q'", "revolute", "a", "b")), "FILE:4: joint `q'`:", "cannot end in `'`")
  end)
end)

describe("mutilated files", function()
  -- whatever is cut out or changed: loaded, or one message that names the file; no crash, no endless loop
  local function try(text)
    local good, result, name = load_text(text)
    if good then
      assert.equal("mechanism", getmetatable(result).__name)
    else
      assert.truthy(tostring(result):find(name .. ":", 1, true), tostring(result))
    end
  end

  it("cut off anywhere", function()
    for length = 0, #arm, 7 do try(arm:sub(1, length)) end
  end)

  it("with changed bytes and pieces", function()
    local state = 1
    local function random(n)
      state = (state * 1103515245 + 12345) % 2147483648
      return state // 65536 % n + 1
    end
    for _ = 1, 400 do
      local text = arm
      for _ = 1, random(4) do
        local i, j = random(#text), random(12)
        local pieces = { "", "0", "-", '"', "<", "/>", "\0", "link", "9e99", text:sub(j, j + 20), "\xff", "a" }
        local piece = pieces[random(#pieces)]
        text = text:sub(1, i - 1) .. piece .. text:sub(i + j)
      end
      try(text)
    end
  end)
end)
