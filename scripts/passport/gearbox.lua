-- A two-stage gearbox: motor, pinion, two wheels and a load, with elastic meshes and shafts. Moments of inertia +-2 %,
-- stiffness and damping +-5 %. The motor's torque rises smoothly.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism "gearbox"
local inertia = { "0.02", "0.003", "0.01", "0.4" }
local joint, initial = {}, {}
for i, value in ipairs(inertia) do
  local disc
  disc, joint[i] = m:revolute { from = m.world, axis = "x", name = "disc" .. i }
  m:rigid_body { at = disc, mass = 1, inertia = { { around(value, "2%"), 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    physical = false }
  initial["disc" .. i], initial["disc" .. i .. "'"] = 0, 0
end

-- a shaft or mesh between two discs, the second of which turns `ratio` times as fast
local q = m:coordinates()
local function mesh(a, b, ratio, k, d)
  k, d = around(k, "5%"), around(d, "5%")
  local na, nb = "disc" .. a, "disc" .. b
  local torque = k * (ratio * q[na] - q[nb]) + d * (ratio * q[na .. "'"] - q[nb .. "'"])
  m:joint_torque { joint = joint[a], torque = -ratio * torque }
  m:joint_torque { joint = joint[b], torque = torque }
end
mesh(1, 2, 1, 20000, 4)
mesh(2, 3, ambit.number "0.4", 150000, 12)
mesh(3, 4, ambit.number "0.25", 30000, 40)
m:joint_torque { joint = joint[1], torque = 15 * (1 - ambit.exp(-t / "0.05")) }
m:joint_torque { joint = joint[4], torque = function(_, w) return -20 * w end }

local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, "0.1", "0.25", "0.5" } }
print(run)
