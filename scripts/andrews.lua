-- andrews.lua: Andrews' squeezer, seven bodies in a plane and three loops (Schiehlen, Multibody Systems Handbook, 1990;
-- data of the IVP Test Set). What a drive torque of 0.033 N m does in the first 10 ms, proved.
--   ambit run andrews.lua [0.03 [0.1%]]     for as many seconds; masses and moments of inertia within a tolerance
local ambit = require "ambit"

local finish, tolerance = tonumber(arg and arg[1]) or 0.01, arg and arg[2]
local function datum(value, name) return tolerance and ambit.around(value, tolerance, name) or value end

local m = ambit.mechanism "Andrews' squeezer"

local function hinge(name, from, x, y)
  local at = m:rigid_link { from = from, offset = { x, y, 0 } }
  return m:revolute { from = at, axis = "z", name = name }
end
local function body(at, mass, x, y, inertia)
  mass, inertia = datum(mass, "mass"), datum(inertia, "moment of inertia")
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
local widest = 0
for _, x in pairs(start.configuration) do widest = math.max(widest, x:width()) end
print(("assembly: %s, no wider than %.1e rad, in %.2f ms"):format(start.status, widest, 1000 * start.cpu_seconds))

m:independent { "beta" } -- the other six speeds follow from it
local initial = start.configuration
initial["beta'"] = 0

local times = { 0 }
for k = 1, 5 do times[k + 1] = finish * k / 5 end
local run = ambit.simulate { m:dynamics(), initial = initial, t = times }

-- What the drive has put in is what energy has grown by.
local energy = m:of_states { m:energy().total }[1]
local function energy_of(state) return ambit.evaluate { energy, at = state } end
local before = energy_of(initial)

local columns = "%-5s  %-42s  %-42s  %-38s  %s"
print(columns:format("t, s", "beta, rad", "theta, rad", "beta', rad/s", "work - growth of energy, J"))
for k = 2, #times do
  if times[k] <= run.t_reached then
    local x = run:at(times[k])
    local work = ambit.interval "0.033" * (x.beta - initial.beta)
    print(columns:format(("%.3f"):format(times[k]), x.beta, x.theta, x["beta'"], work - (energy_of(x) - before)))
  end
end
print(run)

-- The last moment in full: the other speeds, and the accelerations, follow from the states.
local q, final = m:coordinates(), run.x
columns = "%-7s  %-42s  %-42s  %s"
print(columns:format("angle", "rad", "rad/s", "rad/s^2"))
for _, name in ipairs(m:coordinate_names()) do
  local now = ambit.evaluate { m:of_states { q[name .. "'"], q[name .. "''"] }, at = final }
  print(columns:format(name, final[name], now[1], now[2]))
end
print(("%.3f s of CPU time"):format(run.cpu_seconds))
ambit.view { m, run = run, points = { loop = e } }
