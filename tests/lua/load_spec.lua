-- ambit.load: which files, what options; a robot whose numbers others have published.
local ambit = require "ambit"

local function write(name, text)
  local file = assert(io.open(name, "wb"))
  file:write(text)
  file:close()
  return name
end

local function temporary(text, suffix)
  local name = os.tmpname()
  os.remove(name)
  return write(name .. suffix, text)
end

local function fails(request, ...)
  local good, message = pcall(ambit.load, request)
  assert.is_false(good)
  for _, part in ipairs { ... } do
    assert.truthy(message:find(part, 1, true), ("%q does not say %q"):format(message, part))
  end
end

local small = '<robot name="small"><link name="a"/><link name="b"/>'
  .. '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint></robot>'

describe("ambit.load", function()
  it("goes by suffix, else by content", function()
    for _, suffix in ipairs { ".urdf", ".xml", ".URDF", ".txt", "" } do
      local name = temporary("\xEF\xBB\xBF \n" .. small, suffix)
      local good, m = pcall(ambit.load, name)
      os.remove(name)
      assert.is_true(good, tostring(m))
      assert.equal("small", m.name)
    end
    local name = temporary("return { frames = { { name = 'f', parent = 'ROOT' } } }", ".lua")
    assert.truthy(ambit.load(name).links.f)
    os.remove(name)
    name = temporary("hello", ".txt")
    fails(name, name, "expected a URDF file (.urdf, .xml) or a Lua table of RBDL (.lua)")
    os.remove(name)
  end)

  it("says which file cannot be read", function()
    fails("/no/such/robot.urdf", "load: cannot read the file: /no/such/robot.urdf: No such file")
    fails("/tmp", "load: cannot read the file", "directory")
    fails({}, "load: the file: expected text, got nil")
    fails(nil, "load: expected a table")
    fails({ "x.urdf", tolerance = {} }, "unknown key `tolerance`; did you mean `tolerances`?")
    fails({ "x.urdf", damping = 3 }, "damping: expected true or false, got number")
    fails({ "x.urdf", base = 3 }, "cannot read the file")
  end)

  it("takes a base, a name and gravity", function()
    local name = temporary(small, ".urdf")
    local m = ambit.load { name, name = "mine", gravity = { 0, 0, "-9.81" } }
    assert.equal("mine", m.name)
    local host = ambit.mechanism "host"
    local at = host:rigid_link { from = host.world, offset = { 0, 0, 2 } }
    assert.equal(host, ambit.load { name, base = at, name = "guest" })
    assert.equal(2, ambit.evaluate({ host:position(host.links["guest.b"]).z }).lo)
    host:load { name, from = at }
    fails({ name, base = at }, "the mechanism has a link `", "` already: say with `name` which robot is which")
    fails({ name, base = 3 }, "base: expected a frame or a mechanism, got number")
    fails({ name, base = at, gravity = { 0, 0, 1 } }, "gravity: say it with m:gravity")
    local _, problem = pcall(function() ambit.mechanism("x"):link "a" end)
    assert.truthy(problem:find("nothing has been loaded", 1, true))
    os.remove(name)
  end)

  it("says where lxp is missing", function()
    local real, name = package.loaded.lxp, temporary(small, ".urdf")
    package.loaded.lxp = nil
    package.preload.lxp = function() error "not here" end
    fails(name, "the Lua module `lxp` is needed", "lua-expat")
    package.preload.lxp, package.loaded.lxp = nil, real
    os.remove(name)
  end)

  it("loads a chain of 2000 links in less than two seconds", function()
    local words = { "<robot name='long'><link name='l0'/>" }
    for i = 1, 2000 do
      words[#words + 1] = ("<link name='l%d'/><joint name='j%d' type='revolute'><parent link='l%d'/><child link='l%d'/>"
        .. "<origin xyz='1 0 0'/></joint>"):format(i, i, i - 1, i)
    end
    local name, start = temporary(table.concat(words, "\n") .. "</robot>", ".urdf"), os.clock()
    local m = ambit.load(name)
    os.remove(name)
    assert.truthy(m.links.l2000)
    assert.is_true(os.clock() - start < 2)
  end)
end)

-- Mass matrix (upper triangle) and gravity torques: recursive Newton-Euler in 50 digits on the published model
-- (github.com/ros-industrial/universal_robot, ur_description); RBDL and Pinocchio 3.7.0 agree to 7e-15.
local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
  "wrist_3_joint" }
local configurations = {
  { q = { "0.1", "-0.5", "0.9", "0.3", "-0.7", "1.1" },
    mass = {
      { 3.5004975789891914, -0.1652026446941581, 0.030642308541884996, 0.00060155768463522817, -0.18023062685750224,
        0.0071119178826621386 },
      { 3.4389654043211496, 1.2535162964392014, 0.23755891370090366, -0.0043453090043355868, 0.013106697602869633 },
      { 0.83819412696725327, 0.24460374266615721, -0.0043453090043355868, 0.013106697602869633 },
      { 0.24666531003981116, -0.0043453090043355868, 0.013106697602869633 },
      { 0.23998951097473691, 0 },
      { 0.0171364731454 },
    },
    gravity = { 0, -52.496773424004599, -14.333367123992111, 0.11239553273557667, 0, 0 },
    rate = { "0.5", "-0.3", "0.8", "-0.2", "0.6", "-0.4" }, torque = { "1.5", -2, 3, "0.5", "-0.25", "0.125" },
    bias = { -0.48763508077929075, -52.750723827241178, -14.194982168573566, 0.092818863286544181,
      0.025621005589180322, 0.0011343389744165863 },
    acceleration = { 1.2307432285600118, 14.911849282988322, 2.6429537521660533, -15.615923496879,
      -0.18908472751532081, 5.2344731434387279 } },
  { q = { "-1.2", "0.7", "-1.9", "2.5", "0.6", "-0.3" },
    mass = {
      { 1.923927153034751, 0.19314758495557525, -0.070014830622773842, 0.0018851055875905673, -0.07109835244703018,
        -0.0093233702917816807 },
      { 2.1511902437077861, 0.60499759467220998, 0.23318705421366286, -0.0026598492028267274, 0.014143341600841898 },
      { 0.82893188404663388, 0.2374549113362393, -0.0026598492028267274, 0.014143341600841898 },
      { 0.24162989030059471, -0.0026598492028267274, 0.014143341600841898 },
      { 0.25178481635601662, 0 },
      { 0.0171364731454 },
    },
    gravity = { 0, -38.7757156046076, -5.5150465616270932, 0.16811031071970149, 0, 0 },
    rate = { -1, "0.75", "1.25", 2, "-1.5", "0.5" }, torque = { -4, 6, 2, -1, "0.5", "-0.75" },
    bias = { -1.9125356137151325, -36.568979069912091, -6.7991014854015152, -0.16579349157878606,
      -0.95282344618487763, 0.075735051018645975 },
    acceleration = { -3.3367219215185583, 22.564652501878439, 1.5294693885000352, -23.707025978549441,
      4.8319737836107335, -50.32070295038693 } },
}

local function configuration(c)
  local at = {}
  for i, name in ipairs(joints) do at[name], at[name .. "'"], at["tau_" .. name] = c.q[i], c.rate[i], c.torque[i] end
  return at
end

local function some(at, prefix, suffix)
  local list = {}
  for _, name in ipairs(joints) do
    list[name] = at[name]
    list[prefix .. name .. suffix] = at[prefix .. name .. suffix]
  end
  return list
end

-- Six values near to the expected ones, relative to `unit` where these are smaller.
local function check_list(got, expected, arithmetic, unit)
  for i = 1, 6 do
    local size = math.max(math.abs(expected[i]), unit)
    assert.is_true(math.abs(got[i]:mid() - expected[i]) <= 1e-12 * size, tostring(got[i]))
    assert.is_true(arithmetic == "real" or got[i]:width() <= 1e-11 * size, tostring(got[i]:width()))
    assert.is_true(arithmetic == "real" or got[i].lo - 1e-15 * size <= expected[i]
      and expected[i] <= got[i].hi + 1e-15 * size)
  end
end

local function check_arm(path)
  local m = ambit.load { path, gravity = { 0, 0, "-9.81" } }
  for _, c in ipairs(configurations) do
    local at = configuration(c)
    for _, arithmetic in ipairs { "interval", "real" } do
      local function value(e, t) return ambit.evaluate { e, at = t, arithmetic = arithmetic } end
      local mass = value(m:mass_matrix(), some(at, "", ""))
      for i = 1, 6 do
        for j = i, 6 do
          local expected, got = c.mass[i][j - i + 1], mass[i][j]
          assert.is_true(math.abs(got:mid() - expected) <= 1e-12 * math.max(math.abs(expected), 1e-3))
          assert.is_true(arithmetic == "real" or got:width() <= 1e-11 * math.max(math.abs(expected), 1e-3))
        end
      end
      check_list(value(m:gravity_torque(), some(at, "", "")), c.gravity, arithmetic, 1)
      check_list(value(m:bias(), some(at, "", "'")), c.bias, arithmetic, 1)
      check_list(value(m:forward_dynamics(), at), c.acceleration, arithmetic, 1)
    end
  end
end

describe("the UR5", function()
  it("moves as others have computed", function() check_arm "scripts/robots/ur5.urdf" end)

  it("does so also from the published file", function()
    local folder = os.getenv "AMBIT_REFERENCE"
    local path = folder and folder .. "/robots/ur5_robot.urdf"
    local file = path and io.open(path)
    if not file then
      print "AMBIT_REFERENCE does not name a folder with robots/ur5_robot.urdf: not tried"
      return
    end
    file:close()
    check_arm(path)
  end)
end)
