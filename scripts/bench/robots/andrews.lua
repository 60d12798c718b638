-- andrews.lua -- Andrews' squeezer (scripts/andrews.lua) with seven masses and seven moments of inertia that are known
-- within a tolerance, under its drive torque of 0.033 N m.
--   ambit run andrews.lua [0.03] [0.1%]
local ambit = require "ambit"

local finish, tolerance = arg[1] or "0.03", arg[2] or "0.1%"
local m = ambit.mechanism "Andrews' squeezer"

local function hinge(name, from, x, y)
  local at = m:rigid_link { from = from, offset = { x, y, 0 } }
  return m:revolute { from = at, axis = "z", name = name }
end
local function body(at, mass, x, y, inertia)
  mass, inertia = ambit.around(mass, tolerance, "mass"), ambit.around(inertia, tolerance, "moment of inertia")
  m:rigid_body { at = at, mass = mass, centre = { x, y, 0 }, inertia = { inertia, 0, 0, 0, inertia, 0, 0, 0, inertia } }
end
local function point(at, x, y) return m:rigid_link { from = at, offset = { x, y, 0 } } end

local k1 = hinge("beta", m.world, 0, 0)
local k2 = hinge("theta", k1, "0.007", 0)
local k3 = hinge("gamma", m.world, "-0.03635", "0.03273")
local k5 = hinge("delta", m.world, "-0.06934", "-0.00227")
local k4 = hinge("phi", k5, "0.04", 0)
local k7 = hinge("epsilon", m.world, "-0.06934", "-0.00227")
local k6 = hinge("omega", k7, 0, "-0.04")

body(k1, "0.04325", "0.00092", 0, "2.194e-6")
body(k2, "0.00365", "-0.0115", 0, "4.41e-7")
body(k3, "0.02373", "0.01043", "-0.01874", "5.255e-6")
body(k4, "0.00706", 0, "-0.00579", "5.667e-7")
body(k5, "0.0705", "-0.00916", "-0.02308", "1.169e-5")
body(k6, "0.00706", "0.00579", 0, "5.667e-7")
body(k7, "0.05498", "-0.00449", "-0.01228", "1.912e-5")

local e = point(k2, "-0.028", 0)
m:close_point { a = point(k3, 0, "-0.035"), b = e, name = "loop_3" }
m:close_point { a = point(k4, 0, "-0.02"), b = e, name = "loop_4" }
m:close_point { a = point(k6, "0.02", 0), b = e, name = "loop_6" }

m:spring_damper { from = point(m.world, "0.014", "0.072"), to = point(k3, "0.02", "-0.018"), stiffness = 4530,
  length = "0.07785" }
m:joint_torque { joint = k1, torque = "0.033" }

-- The start: theta = 0, the others as published to 30 digits. In the box of +-1e-3 there is exactly one assembly.
local start = m:assemble {
  theta = 0,
  guess = {
    beta = "-0.0617138900142764496358948458001", gamma = "0.455279819163070380255912382449",
    phi = "0.222668390165885884674473185609", delta = "0.487364979543842550225598953530",
    omega = "-0.222668390165885884674473185609", epsilon = "1.23054744454982119249735015568",
  },
  within = "1e-3",
}
m:independent { "beta" } -- the other six speeds follow from it
local initial = start.configuration
initial["beta'"] = 0

local times = { 0 }
for k = 1, 10 do times[k + 1] = ambit.number(finish) * k / 10 end
local run = ambit.simulate { m:dynamics(), initial = initial, t = times }
print(run, run.x.beta)
