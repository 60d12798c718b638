-- A small satellite stops its tumbling: attitude as a quaternion, torque against rate and attitude. Moments of inertia
-- +-2 %, controller's torque +-5 %, first rates within 0.001 rad/s.
local ambit = require "ambit"
local around = ambit.around

local m = ambit.mechanism "attitude"
local body = m:spherical_quaternion { from = m.world, name = "q" }
m:rigid_body { at = body, mass = 12, inertia = { { around("0.2", "2%", "Ix"), 0, 0 },
  { 0, around("0.25", "2%", "Iy"), 0 }, { 0, 0, around("0.15", "2%", "Iz") } } }

local q, gain = m:coordinates(), around(1, "5%", "torque")
local torque = {}
for i = 1, 3 do torque[i] = -gain * ("0.02" * q["q." .. i + 1] + "0.1" * q["q'." .. i]) end
m:applied_torque { at = body, torque = torque, axes = "body" }

local initial = { ["q.1"] = "0.6", ["q.2"] = "0.8", ["q.3"] = 0, ["q.4"] = 0 }
for i, rate in ipairs { "0.05", "-0.08", "0.06" } do initial["q'." .. i] = around(rate, "0.001") end

local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, 5, 10, 20, 30 } }
print(run)
