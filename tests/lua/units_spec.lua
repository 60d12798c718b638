-- Units travel with expressions (docs/units.md): each operation that does not fit is refused by a message that names
-- both, and formulas of engineers that write some numbers without units are not.
local ambit = require "ambit"
local around, between, number = ambit.around, ambit.between, ambit.number

local function fails(f, ...)
  local good, message = pcall(f)
  assert.is_false(good, "no error was raised")
  for _, part in ipairs { ... } do
    assert.is_truthy(message:find(part, 1, true), message .. "\nshould contain " .. part)
  end
  assert.is_truthy(message:find("units_spec.lua:", 1, true), message)
end

local function range(e) return ambit.evaluate { e } end

describe("units", function()
  it("of terms must agree", function()
    local length, time = number "1 m", number "1 s"
    for name, f in pairs { ["+"] = function() return length + time end, ["-"] = function() return length - "1 s" end,
      max = function() return ambit.max(length, 3, time) end, min = function() return ambit.min("1 m", "1 kg") end,
      atan2 = function() return ambit.atan2(length, time) end } do
      fails(f, name, "a length (m)", name == "min" and "a mass (kg)" or "a time (s)")
    end
    assert.is_false(pcall(function() return "1 m" + "1 s" end))
    assert.is_true(range(length + "20 cm"):contains "1.2")
    assert.is_true(range(ambit.max(length, "2 mm")):contains(1))
  end)

  it("of a datum and its tolerance, and of both ends, must agree", function()
    fails(function() return around("1 m", "2 kg") end, "around", "a length (m)", "a mass (kg)")
    fails(function() return between("1 m", "2 kg") end, "between", "a length (m)", "a mass (kg)")
    fails(function() return ambit.interval("1 m", "2 kg") end, "interval", "a length (m)", "a mass (kg)")
    fails(function() return around(number "1 m" / "1 s", "1 m") end, "a speed (m/s)")
    fails(function() return around(1, "1 mm") + "1 kg" end, "a length (m)") -- the tolerance says what it is
    fails(function() return between(1, "2 m") + "1 kg" end, "a length (m)")
    assert.is_true(range(around("1 m", "2 mm") + "1 m").hi < 2.0021)
  end)

  it("degrees take a number without a unit", function()
    for _, value in ipairs { "60 deg", "1 rad", around(60, "1 deg"), number "60 deg" } do
      fails(function() return ambit.degrees(value) end, "degrees", "converted already")
    end
    fails(function() return ambit.degrees "1 m" end, "degrees", "a length (m)")
    assert.is_true(range(ambit.degrees(60)):contains "1.0471975511965977462")
    fails(function() return ambit.degrees(60) + "1 m" end, "rad", "a length (m)")
    assert.is_true(ambit.degrees(ambit.interval(60)):contains "1.0471975511965977462")
  end)

  it("functions take numbers and angles", function()
    local length = number "1 m"
    for _, name in ipairs { "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "log" } do
      fails(function() return ambit[name](length) end, name, "expected a number or angle (rad), got a length (m)")
      fails(function() return ambit[name] "1 m" end, name, "a length (m)")
      assert.is_truthy(ambit[name](length / "2 m"))
    end
    assert.is_truthy(ambit.sin "30 deg")
    assert.is_truthy(ambit.sin(ambit.time) + ambit.cos(2 * ambit.time)) -- 1 rad/s * t, 2 rad/s * t
    fails(function() return ambit.cos(2 * length) end, "cos", "a length (m)")
  end)

  it("of products and powers are worked out, fractions too", function()
    fails(function() return number "2 kg" * "3 m/s^2" + "1 m" end, "a force (N)", "a length (m)")
    fails(function() return number "1 m" ^ 2 + "1 m" end, "an area (m^2)")
    fails(function() return ambit.sqr "1 m" + "1 m" end, "an area (m^2)")
    fails(function() return ambit.sqrt "4 m^2" + "1 kg" end, "a length (m)")
    fails(function() return ambit.sqrt "4 m" + "1 kg" end, "m^0.5")
    fails(function() return number "8 m^3" ^ "1/3" + "1 kg" end, "a length (m)")
    fails(function() return number(2) ^ number "1 m" end, "exponent", "a length (m)")
    fails(function() return number "2 m" ^ between(1, 2) end, "exponent")
    fails(function() return number "1 kN/m" * ambit.pi + "1 m" end, "a stiffness (N/m)")
    local hertz = number "2e9 N/m^1.5" * number "4 mm" ^ "1.5"
    assert.is_true(range(hertz + "1 N"):contains "505965.42562694069312")
    assert.is_true(range(number "2 kN/mm^1.5"):contains "63245553.203367586640")
    fails(function() return hertz + "1 m" end, "a force (N)")
    assert.is_truthy(number "1 m^0.5" * number "1 m^0.5" + "1 m")
  end)

  it("of derivatives and simplified formulas are worked out", function()
    local x = between("1 m", "2 m")
    fails(function() return ambit.derivative(x ^ 3, x) + "1 m" end, "an area (m^2)")
    fails(function() return ambit.simplify((x + "1 m") ^ 2) + "1 m" end, "an area (m^2)")
    assert.is_truthy(ambit.derivative(x ^ 3, x) + "1 m^2")
  end)

  it("of a number are those that it is asked for in", function()
    fails(function() return number("1 kg", "m") end, "kg", "m")
    fails(function() return number(1, "m") + "1 kg" end, "a length (m)")
    fails(function() return number(2, "1") * number "1 m" + "1 kg" end, "a length (m)")
  end)
end)

describe("docs/units.md", function()
  local function rows()
    local list = {}
    for line in io.lines "docs/units.md" do
      local cells = {}
      for cell in line:gmatch "|([^|]*)" do cells[#cells + 1] = cell:match "^%s*(.-)%s*$" end
      if #cells > 0 then list[#list + 1] = cells end
    end
    return list
  end

  it("lists every unit with its value, and every prefix", function()
    local core = require "ambit.core"
    local units, prefixes = core.units()
    local unit_of, prefix_of = {}, {}
    for _, cells in ipairs(rows()) do
      local name, value = (cells[1] or ""):match "^`([^`]+)`$", (cells[2] or ""):match "^`([^`]+)`$"
      if name and value and cells[3] then unit_of[name] = { value = value, prefix = cells[3] == "yes" } end
      for prefix in (cells[1] or ""):gmatch "`([^`]+)`" do
        if tonumber(cells[2]) then prefix_of[prefix] = tonumber(cells[2]) end
      end
    end
    for _, unit in ipairs(units) do
      local row = unit_of[unit.name]
      assert.is_truthy(row, unit.name)
      assert.equal(unit.prefix, row.prefix, unit.name)
      local angle, rest = row.value:match "^([%d*]*pi[/%d]*)%s*(.*)$"
      local value = angle and number(load("local pi = ... return " .. angle)(ambit.pi), rest ~= "" and rest or nil)
        or number(row.value)
      local off = range(number("1 " .. unit.name) - value) -- refused if the dimensions differ
      assert.is_true(off:mag() <= 1e-15 * range(value):mag(), unit.name)
      unit_of[unit.name] = nil
    end
    assert.is_nil(next(unit_of))
    for _, prefix in ipairs(prefixes) do
      assert.equal(10.0 ^ prefix.decimal, prefix_of[prefix.name], prefix.name)
      prefix_of[prefix.name] = nil
    end
    assert.is_nil(next(prefix_of))
  end)
end)

describe("the SI", function()
  -- Its units with a name of their own, by base units (SI brochure, table 4), and how they are written here.
  local named = { rad = "1", sr = "1", Hz = "1/s", N = "kg m/s^2", Pa = "kg/(m s^2)", J = "kg m^2/s^2",
    W = "kg m^2/s^3", C = "A s", V = "kg m^2/(s^3 A)", F = "s^4 A^2/(kg m^2)", ohm = "kg m^2/(s^3 A^2)",
    S = "s^3 A^2/(kg m^2)", Wb = "kg m^2/(s^2 A)", T = "kg/(s^2 A)", H = "kg m^2/(s^2 A^2)", lm = "cd", lx = "cd/m^2",
    Bq = "1/s", Gy = "m^2/s^2", Sv = "m^2/s^2", kat = "mol/s" }

  it("has all units with a name of their own, with all prefixes", function()
    local _, prefixes = require("ambit.core").units()
    local count = 0
    for name, base in pairs(named) do
      count = count + 1
      assert.equal(0, range(number("3 " .. name) - ("3 " .. base)):mag(), name)
      for _, prefix in ipairs(prefixes) do
        local off = number(("1 %s%s"):format(prefix.name, name)) - ("1e%d %s"):format(prefix.decimal, base)
        assert.is_true(range(off):mag() <= 1e-15 * 10.0 ^ prefix.decimal, prefix.name .. name)
      end
    end
    assert.equal(21, count)
    fails(function() return number "20 degC" end, "offset", "K")
  end)

  it("has capacitances", function()
    assert.is_true(range(number "10 kohm" * "100 nF" - "1 ms"):mag() < 1e-17)
    fails(function() return number "1 uF" + "1 V" end, "a capacitance (F)", "a voltage (V)")
  end)
end)

describe("numbers without a unit", function()
  it("take that of the other terms", function()
    assert.is_truthy(number "1 m" + 1 + "1 m")
    fails(function() return number "1 m" + 1 + "1 s" end, "a length (m)", "a time (s)")
  end)

  it("are numbers as factors of a quantity", function()
    local length, two = number "1 m", around(2, "1%")
    for _, twice in ipairs { 2 * length, length * two, length / two, "2" * length, 2 * (length + 1) } do
      fails(function() return twice + "1 kg" end, "a length (m)", "a mass (kg)")
      assert.is_truthy(twice + "1 m")
    end
    fails(function() return 1 / length + "1 m" end, "1/m")
    fails(function() return ambit.evaluate { length } * around("1 m", "1%") + "1 kg" end, "a length (m)")
    local arm = ambit.mechanism "arm"
    arm:point_mass { at = arm.world, mass = 2 }
    fails(function() return 2 * arm:total_mass() + length end, "a mass (kg)")
    assert.is_truthy(3 * ambit.cos(number "30 deg") + length) -- 3 m, and its cosine
  end)

  it("may be coefficients of any unit beside states and coordinates", function()
    local arm = ambit.mechanism "arm"
    local _, slide = arm:prismatic { from = arm.world, axis = "x", name = "x" }
    local x = arm:coordinates().x
    assert.is_truthy(100 * (number "3 cm" - x) + "1 N")
    arm:joint_torque { joint = slide, force = function(q, rate) return 100 * (number "3 cm" - q) - 3 * rate end }
  end)
end)

describe("an ode", function()
  local function of(states, equations, parameters)
    return function() return ambit.ode { states = states, parameters = parameters, equations = equations } end
  end

  it("has rates in the units of its states by time", function()
    local states = { x = "m", v = "m/s" }
    fails(of(states, function(s) return { x = s.v, v = s.x } end), "derivative of v", "an acceleration (m/s^2)",
      "a length (m)")
    fails(of(states, function(s) return { x = s.x, v = -1 } end), "derivative of x", "a speed (m/s)", "a length (m)")
    fails(of(states, { x = function(s) return s.v end, v = function(s) return s.v end }), "derivative of v")
    fails(of(states, function(s) return { x = s.v, v = "1 m" } end), "derivative of v", "m/s")
    fails(of(states, function(s) return { x = s.v + s.x, v = 0 } end), "a speed (m/s)", "a length (m)")
    fails(of({ phi = "rad", w = "rad/s" }, function(s) return { phi = s.w, w = -ambit.sin(s.phi) } end),
      "derivative of w", "an angular acceleration (rad/s^2)", "a number or angle (rad)")
    fails(of(states, function(s, p) return { x = s.v, v = -p.k * s.x } end, { k = "10 N/m" }), "derivative of v",
      "a force (N)")
    assert.is_truthy(of(states, function(s, p) return { x = s.v, v = -p.k / p.m * s.x } end,
      { k = "10 N/m", m = around("1 kg", "1%") })())
  end)

  it("is free to write coefficients as plain numbers", function()
    local states = { x = "m", v = "m/s" }
    assert.is_truthy(of(states, function(s, _, t)
      return { x = s.v, v = -100 * s.x - "0.5" * s.v + ambit.sin(2 * t) - "9.81" }
    end)())
    assert.is_truthy(of({ "x", "v" }, function(s) return { x = s.v, v = -s.x } end)())
    assert.is_truthy(ambit.ode { states = states, check_units = false,
      equations = function(s) return { x = s.v, v = -ambit.sin(s.x) } end })
    fails(function() return ambit.ode { states = states, check_units = 1, equations = {} } end, "check_units")
  end)

  local fall = ambit.ode { states = { y = "m", v = "m/s" }, parameters = { g = "9.81 m/s^2" },
    equations = function(s, p) return { y = s.v, v = -p.g } end }

  it("checks initial values, parameters, events, sections and conditions", function()
    local initial = { y = 1, v = 0 }
    fails(function() ambit.simulate { fall, initial = { y = number "1 m" / "1 s", v = 0 }, t = 1 } end, "initial.y",
      "a length (m)", "a speed (m/s)")
    fails(function() ambit.simulate { fall, initial = initial, t = "1 m" } end, "m")
    fails(function() ambit.evaluate { fall:rate "v" + "1 m/s" } end, "a speed (m/s)")
    fails(function()
      ambit.simulate { fall, initial = initial, t = 1, events = { { g = function(s) return s.y - s.v end } } }
    end, "a length (m)", "a speed (m/s)")
    fails(function() ambit.verify { fall, initial = initial, t = 1, safe = function(s) return s.y - "1 kg" end } end,
      "a length (m)", "a mass (kg)")
    fails(function()
      ambit.poincare { fall, initial = initial, t_max = 1, section = function(s, p) return s.v - p.g end }
    end, "a speed (m/s)")
    fails(function() ambit.certify { fall, fall, initial = initial, t = 1, outputs = { "y" }, error = { y = "1 kg" } } end,
      "error: y", "m")
    fails(function() ambit.reduce { fall, initial = initial, t = 1, outputs = { fast = function(s) return s.v end },
      error = { fast = "1 kg" } } end, "error: fast", "m/s")
    fails(function() ambit.reduce { fall, initial = initial, t = 1, outputs = { "y" }, error = { y = 1 },
      parameters = { g = "1 m" } } end, "`g`", "m/s^2")
  end)

  it("takes values in its own units, though a namesake of its states has others", function()
    local function decay(unit)
      return ambit.ode { states = { namesake = unit },
        equations = function(s) return { namesake = number "-1 1/s" * s.namesake } end }
    end
    local turning, sliding = decay "rad", decay "m"
    for _, case in ipairs { { turning, "1 rad" }, { sliding, "1 m" } } do
      local rate = ambit.evaluate { case[1]:rate "namesake", at = { namesake = case[2] } }
      assert.is_true(rate:contains(-1))
    end
    fails(function() ambit.evaluate { sliding:rate "namesake", at = { namesake = "1 kg" } } end, "at.namesake", "kg")
  end)

  it("is written to Lua so that it can be read again", function()
    local ode = ambit.ode { states = { { "x", "m" }, { "v", "m/s" } }, parameters = { k = "1 1/s^2" },
      equations = function(s, p) return { x = s.v, v = -p.k * s.x } end }
    local again = assert(load(ode:lua()))()
    assert.equal(tostring(ode:rate "v"), tostring(again:rate "v"))
  end)
end)

describe("a mechanism", function()
  local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
  local joint, shoulder = m:revolute { from = m.world, axis = "z", name = "bend" }
  local tip = m:rigid_link { from = joint, offset = { 1, 0, 0 } }
  m:point_mass { at = tip, mass = 2 }

  it("says its quantities in their units", function()
    local at = m:momentum()
    local quantities = { { m:position(tip).x, "m" }, { m:velocity(tip).y, "m/s" }, { m:acceleration(tip).y, "m/s^2" },
      { m:angular_velocity(tip).z, "rad/s" }, { m:distance(tip, m.world), "m" }, { m:energy().total, "J" },
      { m:power(), "W" }, { m:total_mass(), "kg" }, { m:centre_of_mass().x, "m" }, { at.linear.x, "N s" },
      { at.angular.z, "N m s" }, { m:coordinates()["bend'"], "rad/s" }, { m:coordinates()["bend''"], "rad/s^2" },
      { m:mass_matrix()[1][1], "kg m^2" }, { m:bias()[1], "N m" }, { m:gravity_torque()[1], "N m" },
      { m:inverse_dynamics()[1], "N m" }, { m:generalised_forces()[1], "N m" }, { m:jacobian(tip)[5][1], "m" },
      { m:forward_dynamics()[1], "rad/s^2" }, { m:dynamics():rate "bend'", "rad/s^2" },
      { m:orientation(tip)[1][1], "1" },
      { m:reaction(shoulder).force.x, "N" }, { m:reaction(shoulder).torque.z, "N m" },
      { m:relative_pose(m.world, tip).position.x, "m" }, { m:relative_velocity(m.world, tip).linear.x, "m/s" },
      { m:angle(m.world, tip), "rad" } }
    for i, entry in ipairs(quantities) do
      local good, message = pcall(number, entry[1] + number(1, entry[2]))
      assert.is_true(good, i .. " " .. tostring(message))
      assert.is_false(pcall(function() return entry[1] + "1 cd" end), i)
    end
  end)

  it("checks values of its variables, laws and parameters", function()
    fails(function() ambit.evaluate { m:position(tip).x, at = { bend = m:position(tip).y } } end, "at.bend",
      "a number or angle (rad)", "a length (m)")
    fails(function() m:joint_torque { joint = shoulder, torque = function(q) return number "3 N m" / q / "1 s" end } end,
      "torque", "a torque or energy (N m)", "a power (W)")
    fails(function()
      m:applied_force { at = tip, force = function(_, v) return { number "3 N/m" * v.x, 0, 0 } end }
    end, "force[1]", "a force (N)")
    fails(function() m:point_mass { at = tip, mass = m:distance(tip, m.world) } end, "mass", "a mass (kg)", "a length (m)")
    for _, box in ipairs { { "1 m", "2 m" }, "[1, 2] m", { 0, m:distance(tip, m.world) } } do
      fails(function() ambit.equilibria { m:dynamics(), box = { bend = box } } end, "box.bend")
    end
    local function safe(s) return s.bend - "1 m" end
    fails(function() ambit.verify { m:dynamics(), initial = { bend = 0, ["bend'"] = 0 }, t = 1, safe = safe } end,
      "a number or angle (rad)", "a length (m)")
  end)

  it("lets laws write coefficients as plain numbers, one among them", function()
    local other = ambit.mechanism "slider"
    local _, slide = other:prismatic { from = other.world, axis = "x", name = "x" }
    other:joint_torque { joint = slide, force = function(x, rate, t) return -x - x ^ 3 / 10 - rate + ambit.sin(t) end }
    other:joint_torque { joint = slide, force = function(x) return number "3 N/m" * x - "2 N" end }
  end)
end)

describe("random expressions", function()
  -- An independent calculator: dimensions as three integers in halves, of m, kg and s; nil: refused.
  local units = { { "m", { 2, 0, 0 } }, { "kg", { 0, 2, 0 } }, { "s", { 0, 0, 2 } }, { "N", { 2, 2, -4 } },
    { "m^0.5", { 1, 0, 0 } }, { "rad", { 0, 0, 0 } }, { "km/h", { 2, 0, -2 } }, { "N/m^1.5", { -1, 2, -4 } } }
  local function same(a, b) return a[1] == b[1] and a[2] == b[2] and a[3] == b[3] end
  local function combine(a, b, k) return { a[1] + k * b[1], a[2] + k * b[2], a[3] + k * b[3] } end
  local function is_number(a) return same(a, { 0, 0, 0 }) end

  local function leaf()
    local unit = units[math.random(#units)]
    local text = ("%d.%d %s"):format(math.random(1, 9), math.random(0, 9), unit[1])
    return math.random(2) == 1 and number(text) or around(text, "1%"), unit[2]
  end

  local function operate(a, da, b, db)
    local choice = math.random(9)
    if choice == 1 then return function() return a + b end, same(da, db) and da end
    if choice == 2 then return function() return a - b end, same(da, db) and da end
    if choice == 3 then return function() return ambit.max(a, b) end, same(da, db) and da end
    if choice == 4 then return function() return a * b end, combine(da, db, 1) end
    if choice == 5 then return function() return a / b end, combine(da, db, -1) end
    if choice == 6 then return function() return a ^ 2 end, combine(da, da, 1) end
    if choice == 7 then return function() return ambit.cos(a) end, is_number(da) and da end
    if choice == 8 then return function() return ambit.atan2(a, b) end, same(da, db) and { 0, 0, 0 } end
    local even = da[1] % 2 == 0 and da[2] % 2 == 0 and da[3] % 2 == 0
    if not even then return function() return -a end, da end
    return function() return ambit.sqrt(ambit.abs(a)) end, { da[1] // 2, da[2] // 2, da[3] // 2 }
  end

  local function tree(depth)
    if depth == 0 then return leaf() end
    local a, da = tree(depth - 1)
    local b, db = tree(math.random(0, depth - 1))
    if not (da and db) then return nil, nil end
    local f, d = operate(a, da, b, db)
    local good, e = pcall(f)
    assert.equal(d and true or false, good, good and tostring(e) or e)
    if not good then return nil, nil end
    return e, d
  end

  local function text_of(d)
    local function power(x) return ("%d.%d"):format(x // 2, x % 2 * 5) end
    local parts = {}
    for i, name in ipairs { "m", "kg", "s" } do
      if d[i] > 0 then parts[#parts + 1] = name .. "^" .. power(d[i]) end
      if d[i] < 0 then parts[#parts + 1] = name .. "^-" .. power(-d[i]) end
    end
    return #parts > 0 and table.concat(parts, " ") or "1"
  end

  it("are refused exactly where a calculator of dimensions refuses them", function()
    math.randomseed(12)
    local whole, refused = 0, 0
    for _ = 1, tonumber(os.getenv "AMBIT_UNIT_TRIES" or 3000) do
      local e, d = tree(math.random(1, 4))
      if e and math.max(math.abs(d[1]), math.abs(d[2]), math.abs(d[3])) < 18 then
        whole = whole + 1
        assert.is_truthy(number(e, text_of(d)))
        assert.is_false(pcall(number, e, text_of(combine(d, { 2, 0, 0 }, 1))))
      elseif not e then
        refused = refused + 1
      end
    end
    assert.is_true(whole > 500 and refused > 500)
  end)
end)
