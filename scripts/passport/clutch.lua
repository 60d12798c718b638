-- An engine is coupled to a car by a clutch with friction that slips, then holds. Inertias +-2 %, friction +-5 %.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism "clutch"
local engine, shaft = m:revolute { from = m.world, axis = "x", name = "engine" }
m:rigid_body { at = engine, mass = 1, physical = false,
  inertia = { { around("0.25", "2%", "engine"), 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }
local car, wheel = m:revolute { from = m.world, axis = "x", name = "car" }
m:rigid_body { at = car, mass = 1, physical = false,
  inertia = { { around("1.6", "2%", "car"), 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }

local q = m:coordinates()
local slip = q["engine'"] - q["car'"]
local grip = around(180, "5%", "clutch") * (1 - ambit.exp(-t / "0.2")) * ambit.tanh(slip / 2)
m:joint_torque { joint = shaft, torque = 60 - grip }
m:joint_torque { joint = wheel, torque = grip - "0.05" * q["car'"] }

local run = ambit.simulate { m:dynamics(),
  initial = { engine = 0, car = 0, ["engine'"] = 150, ["car'"] = 0 }, t = { 0, "0.25", "0.5", 1, 2 } }
print(run)
