-- `ambit explain`: the model tree.
local command = os.getenv "AMBIT_COMMAND" or "ambit"

local function explain(scene, options)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write('local ambit = require "ambit"\n', scene)
  file:close()
  local pipe = assert(io.popen(("%s explain %s %s 2>&1"):format(command, options or "", name)))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  os.remove(name)
  assert.equal(0, code, output)
  return output
end

local function lines_say(output, ...)
  for _, pattern in ipairs { ... } do
    assert.truthy(output:find("\n" .. pattern .. "\n"), ("%s\ndoes not have the line %q"):format(output, pattern))
  end
end

local arm = [[
local m = ambit.mechanism { "arm", gravity = { 0, 0, "-9.81" } }
local upper = m:revolute { from = m.world, axis = "y", name = "shoulder" }
local elbow = m:rigid_link { from = upper, offset = { 1, 0, 0 }, name = "upper" }
m:point_mass { at = elbow, mass = ambit.around(2, "5%"), name = "weight" }
local fore = m:revolute { from = elbow, axis = "y", name = "elbow" }
m:rigid_body { at = fore, mass = "0.5", name = "hand" }
local other = m:spherical { from = elbow, name = "ball" }
m:joint_torque { joint = fore, torque = "0.1", name = "motor" }
ambit.evaluate { m:position(fore), at = { shoulder = 1 } }
]]

describe("ambit explain", function()
  it("prints parts, what they hang on, coordinates and masses", function()
    local output = explain(arm)
    lines_say(output,
      ' mechanism "arm": 9 parts, %d+ of %d+ quantities built, %d+ left out %(%d+ %%%); %d+ coordinates; .*',
      "  shoulder +%d of +%d+  revolute +on world; coordinate shoulder", "  upper +%d of +%d+  rigid_link +on shoulder",
      "    weight +%d of +%d+  point_mass +on upper; %[1.89+, 2.10+1%] kg",
      "    elbow +%d of +%d+  revolute +on upper; coordinate elbow",
      "      hand +%d of +%d+  rigid_body +on elbow; 0.5 kg",
      "    ball +%d of +%d+  spherical +on upper; coordinate .*",
      "      motor +%d of +%d+  joint_torque +on elbow", " not built: nothing was asked of 5 parts",
      "  built: +pose 4 of 5, coordinate 1 of 3", "  never asked for: twist %(5%).*",
      "  gravity1 weight hand ball motor")
  end)

  it("writes JSON lines", function()
    local output = "\n" .. explain(arm, "--json")
    local part = '{"record":"part","mechanism":"arm",'
    lines_say(output, '{"record":"mechanism","name":"arm","parts":9,"pulled":%d+,"available":%d+,.*"loops":0}',
      part .. '"name":"weight","type":"point_mass","on":"upper","pulled":0,"available":7,"built":"",' ..
      '"mass":%[1.[89]%d*,2.1.*%]}',
      part .. '"name":"elbow","type":"revolute","on":"upper","pulled":2,"available":14,' ..
      '"built":"to.pose, joint.coordinate","coordinates":"elbow"}')
  end)

  it("says which joints have no coordinate of their own", function()
    local output = explain [[
local m = ambit.mechanism "gripper"
local left, drive = m:prismatic { from = m.world, axis = "x", name = "drive" }
m:prismatic { from = m.world, axis = "x", name = "right", mimic = drive }
m:rigid_link { from = left, offset = { 1, 0, 0 }, name = "pad" }
]]
    lines_say(output, "  drive +%d of +%d+  prismatic +on world; coordinate drive",
      "  right +%d of +%d+  prismatic +on world; motion given",
      "  pad +%d of +%d+  rigid_link +on drive")
  end)

  it("shows closed loops and chains", function()
    local output = explain [[
ambit.chain { "leg", ports = { from = "frame" }, build = function(m, p)
  local knee = m:revolute { from = p.from, axis = "z", name = "knee" }
  return { foot = m:rigid_link { from = knee, offset = { 1, 0, 0 }, name = "shank" } }
end }
local m = ambit.mechanism "walker"
local left, right = m:leg { from = m.world, name = "left" }, m:leg { from = m.world, name = "right" }
m:close_point { a = left.foot, b = right.foot, name = "hold" }
]]
    lines_say(output, "  left.knee +%d of +%d+  revolute +on world; coordinate left.knee",
      "  left.shank +%d of +%d+  rigid_link +on left.knee", " chains", "  left: leg, 2 parts", " closed loops",
      "  hold +%d of +%d+  close_point +on left.shank; and right.shank")
  end)

  it("shows robots from files", function()
    local output = explain 'ambit.load "scripts/robots/ur5.urdf"'
    lines_say(output,
      "  wrist_3_joint +%d of +%d+  revolute +on wrist_3_joint.origin; coordinate wrist_3_joint",
      "    upper_arm_link +%d of +%d+  rigid_body +on shoulder_lift_joint; 8.393 kg")
  end)

  it("stays readable with thousands of parts", function()
    local output = explain [[
local m = ambit.mechanism "chain"
local at = m.world
for i = 1, 1500 do
  at = m:revolute { from = at, axis = "z" }
  at = m:rigid_link { from = at, offset = { 1, 0, 0 } }
end]]
    lines_say(output, ' mechanism "chain": 3001 parts, 0 of %d+ .*',
      "  rigid_link8 +%d of +%d+  rigid_link +on revolute8",
      "  ... and 2984 more alike: 1492 revolute, 1492 rigid_link",
      " not built: nothing was asked of 3000 parts", ".* ... and 2970 more")
    assert.falsy(output:find "rigid_link9 ")
    local _, lines = output:gsub("\n", "")
    assert.is_true(lines < 100, lines)
  end)
end)
