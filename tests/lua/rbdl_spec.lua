-- Lua tables of RBDL.
local ambit = require "ambit"

local function load_text(text)
  local name = os.tmpname()
  os.remove(name)
  name = name .. ("_long"):rep(12) .. ".lua"
  local file = assert(io.open(name, "wb"))
  file:write(text)
  file:close()
  local good, result = pcall(ambit.load, name)
  os.remove(name)
  return good, result, name
end

local function loaded(text)
  local good, result = load_text(text)
  assert.is_true(good, tostring(result))
  return result
end

local function says(text, ...)
  local good, message, name = load_text(text)
  assert.is_false(good)
  local place = message:find(name, 1, true)
  message = place and "FILE" .. message:sub(place + #name) or message
  for _, part in ipairs { ... } do
    assert.truthy(message:find(part, 1, true), ("%q does not say %q"):format(message, part))
  end
end

local function value(e, at) return ambit.evaluate { e, at = at } end
local function near(x, y, tolerance)
  assert.is_true(math.abs(x:mid() - y) <= (tolerance or 1e-14), ("%s is not %s"):format(tostring(x), y))
end

local body = "{ mass = 2, com = { 0.5, 0, 0 }, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }"

local function frames(list, more) return "return { frames = {\n" .. list .. "\n}, " .. (more or "") .. " }\n" end
local function frame(name, parent, rest) return ('{ name = "%s", parent = "%s", %s },\n'):format(name, parent, rest) end

describe("a table of RBDL", function()
  it("gives a mechanism", function()
    local m = loaded(frames(frame("upper", "ROOT", "joint = { { 0, 0, 1, 0, 0, 0 } }, body = " .. body)
      .. frame("lower", "upper",
        "joint_frame = { r = { 1, 0, 0 } }, joint = { { 0, 0, 1, 0, 0, 0 } }, body = " .. body),
      "gravity = { 0, -9.81, 0 }"))
    local at = { upper = "0.3", lower = "0.5" }
    near(value(m:position(m.links.lower), at).x, math.cos(0.3))
    local M = value(m:mass_matrix(), at)
    near(M[2][2], 1 + 2 * 0.25)
    near(M[1][1], 1 + 0.5 + 1 + 2 * (1 + 0.25 + math.cos(0.5)), 1e-13)
    local e = value(m:energy(), { upper = "0.3", lower = "0.5", ["upper'"] = 0, ["lower'"] = 0 })
    near(e.potential, 9.81 * 2 * (0.5 * math.sin(0.3) + math.sin(0.3) + 0.5 * math.sin(0.8)), 1e-13)
  end)

  it("reads E as turning the parent's axes into the joint's", function()
    -- RBDL: v_child = E v_parent; the rows of E are the axes of the child
    for _, case in ipairs {
      { "{ { 0, 1, 0 }, { -1, 0, 0 }, { 0, 0, 1 } }", { { 0, -1, 0 }, { 1, 0, 0 }, { 0, 0, 1 } } },
      { "{ { 0, 0, -1 }, { 0, 1, 0 }, { 1, 0, 0 } }", { { 0, 0, 1 }, { 0, 1, 0 }, { -1, 0, 0 } } },
      { "{ { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } }", { { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 0 } } },
      { "{ { 0, 0, -1 }, { -1, 0, 0 }, { 0, 1, 0 } }", { { 0, -1, 0 }, { 0, 0, 1 }, { -1, 0, 0 } } },
      { "{ { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 } }", { { -1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 } } },
      { "{ { 0.6, 0.8, 0 }, { -0.8, 0.6, 0 }, { 0, 0, 1 } }", { { 0.6, -0.8, 0 }, { 0.8, 0.6, 0 }, { 0, 0, 1 } } },
      { "{ { 0.36, 0.48, -0.8 }, { -0.8, 0.6, 0 }, { 0.48, 0.64, 0.6 } }",
        { { 0.36, -0.8, 0.48 }, { 0.48, 0.6, 0.64 }, { -0.8, 0, 0.6 } } },
    } do
      local m = loaded(frames(frame("f", "ROOT", "joint_frame = { E = " .. case[1] .. " }")))
      local r = value(m:orientation(m.links.f))
      for i = 1, 3 do
        for j = 1, 3 do near(r[i][j], case[2][i][j], 1e-15) end
      end
    end
    local m = loaded(frames(frame("f", "ROOT", "joint_frame = { E = { { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } } }")))
    assert.equal(0, value(m:orientation(m.links.f))[1][1]:width()) -- axes of coordinates stay exact
  end)

  it("puts the motions of a joint one behind the other", function()
    local m = loaded(frames(frame("f", "ROOT",
      "joint = { { 0, 0, 0, 1, 0, 0 }, { 0, 0, 1, 0, 0, 0 }, { 0, 1, 0, 0, 0, 0 } }, body = " .. body)))
    local at = { ["f.1"] = "0.5", ["f.2"] = "0.25", ["f.3"] = 1 }
    near(value(m:position(m.links.f), at).x, 0.5)
    near(value(m:orientation(m.links.f), at)[1][1], math.cos(0.25) * math.cos(1))
    assert.equal(3, #m:mass_matrix())
  end)

  it("knows types of joints, and screws", function()
    for kind, dof in pairs { JointTypeFixed = 0, JointTypeRevoluteY = 1, JointTypeTranslationXYZ = 3,
      JointTypeEulerZYX = 3, JointTypeEulerXYZ = 3, JointTypeEulerYXZ = 3, JointTypeSpherical = 3,
      JointTypeFloatingBase = 6 } do
      local m = loaded(frames(frame("f", "ROOT", ('joint = { "%s" }, body = '):format(kind) .. body)
        .. frame("g", "f", 'joint = "JointTypeRevoluteX", body = ' .. body)))
      assert.equal(dof + 1, #m:mass_matrix(), kind)
    end
    local m = loaded(frames(frame("f", "ROOT", "joint = { { 0, 0, 1, 0, 0, -0.5 } }")))
    near(value(m:position(m.links.f), { f = 2 }).z, -1)
  end)

  it("takes what the format takes for granted", function()
    local m = loaded(frames(frame("f", "ROOT",
      "joint = { { 0, 0, 1, 0, 0, 0 } }, body = { mass = 1 }, visuals = {}, points = {}")))
    near(value(m:mass_matrix()[1][1], { f = 0 }), 1)
  end)

  it("may compute its numbers", function()
    local m = loaded([[
local list = {}
print "hello"
for i = 1, 5 do
  table.insert(list, { name = "link" .. i, parent = i == 1 and "ROOT" or "link" .. i - 1,
    joint = { { 0, 0, 1, 0, 0, 0 } }, joint_frame = { r = { math.sqrt(i * i), 0, 0 } }, body = { mass = 1 } })
end
return { frames = list }]])
    assert.equal(5, #m:mass_matrix())
    near(value(m:position(m.links.link5), { link1 = 0, link2 = 0, link3 = 0, link4 = 0, link5 = 0 }).x, 15)
  end)
end)

describe("a bad table of RBDL", function()
  it("is named with the line of its program", function()
    says("return {", "FILE:1:", "expected")
    says("local x = nil\nreturn x.frames", "FILE:2:", "index a nil value")
    says("\nreturn os.execute 'true'", "FILE:2:", "os")
    says("\nio.open 'x'", "FILE:2:", "io")
    says("require 'x'", "FILE:1:", "require")
    says("model = {}", "FILE:1: expected a file that returns the table of a model, got nil")
    says("return {}", "FILE:1: expected a model with a list `frames`")
    says("return { frame = {} }", "did you mean `frame`?")
    says(frames(frame("f", "ROOT", ""), "\n gravity = { 0, 9 }"),
      "FILE:5: gravity: expected a list of 3 numbers, got a list of 2")
    says("error 'no'", "FILE:1: no")
    says("error {}", "FILE: table")
    says("local function f() return f() + 1 end\nf()", "FILE:1:", "stack overflow")
    says("\27Lua", "FILE")
    says("while true do end", "FILE:1: it ran for more than 1 s")
  end)

  it("is named with the frame", function()
    says(frames "1", "FILE:1: frames[1]: expected a table, got number")
    says(frames "{ parent = 'ROOT' }", "FILE:1: frames[1]: expected a name")
    says(frames "{ name = 'pelvis', parent_frame = 'ROOT' }", "FILE:2: frame `pelvis`: parent: expected the name")
    says(frames(frame("f", "ROOT", "jiont = {}")), "FILE:2: frame `f`: unknown key `jiont`; did you mean `joint`?")
    says(frames(frame("f", "ROOT", "") .. frame("g", "h", "")),
      "FILE:3: joint `g`: its parent link `h` is not in the file")
    says(frames(frame("f", "ROOT", "") .. frame("f", "ROOT", "")), "link `f`: the name is taken already")
    says(frames(frame("f", "ROOT", "joint = { 0, 0, 1, 0, 0, 0 }")), "write { { ... } }")
    says(frames(frame("f", "ROOT", "joint = { { 0, 0, 1 } }")),
      "joint[1]: expected a list of 6 numbers, got a list of 3")
    says(frames(frame("f", "ROOT", "joint = { { 0, 0, 0, 0, 0, 0 } }")), "the axis is zero")
    says(frames(frame("f", "ROOT", "joint = { { 0, 0, 2, 0, 0, 0 } }")), "the axis has length 2")
    says(frames(frame("f", "ROOT", "joint = { { 0, 0, 1, 1, 0, 0 } }")),
      "turns about one axis and slides along another")
    says(frames(frame("f", "ROOT", "joint = { 'JointTypeSpherica' }")), "did you mean `JointTypeSpherical`?")
    says(frames(frame("f", "ROOT", "joint_frame = { r = { 0, 0, 'x' } }")), "r[3]: expected a number, got x")
    says(frames(frame("f", "ROOT", "joint_frame = { r = { 0, 0, 1/0 } }")), "r[3]: expected a number, got inf")
    says(frames(frame("f", "ROOT", "joint_frame = { E = { { 1, 0, 0 }, { 0, 1, 0 } } }")), "E: expected three rows")
    says(frames(frame("f", "ROOT", "joint_frame = { E = { { 2, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }")),
      "E is not a rotation")
    says(frames(frame("f", "ROOT", "joint_frame = { E = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, -1 } } }")),
      "E is a reflection")
    says(frames(frame("f", "ROOT", "body = {}")), "FILE:2: frame `f`: body: mass: expected a number, got nil")
    says(frames(frame("f", "ROOT", "body = { mass = -1 }")), "FILE:2: link `f`: the mass is negative")
    says(frames(frame("f", "ROOT", "body = { mass = 1, inertia = { { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }")),
      "the inertia is not symmetric")
    says(frames(frame("f", "ROOT", "body = { mass = 1, inertia = { { 9, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }")),
      "no body has this inertia")
    says(frames(frame("a", "b", "") .. frame("b", "a", "")), "in a cycle")
  end)
end)

describe("mutilated tables", function()
  it("are loaded, or named with a line", function()
    local text = frames(frame("upper", "ROOT", "joint = { { 0, 0, 1, 0, 0, 0 } }, body = " .. body)
      .. frame("lower", "upper", 'joint = { "JointTypeSpherical" }, joint_frame = { r = { 1, 0, 0 } }'),
      "gravity = { 0, 0, -9.81 }")
    local state = 7
    local function random(n)
      state = (state * 1103515245 + 12345) % 2147483648
      return state // 65536 % n + 1
    end
    for _ = 1, 300 do
      local pieces = { "", "0", "-", "{", "}", ",", "nil", "\0", '"', "1e999", "0/0", "name" }
      local i = random(#text)
      local changed = text:sub(1, i - 1) .. pieces[random(#pieces)] .. text:sub(i + random(5) - 1)
      local good, result, name = load_text(changed)
      assert.is_true(good or tostring(result):find(name .. ":", 1, true) ~= nil, tostring(result))
    end
  end)
end)
