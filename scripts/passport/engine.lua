-- A one-cylinder compressor crank that coasts for four turns against the gas in its cylinder: lengths +-0.1 mm, masses
-- +-2 %, gas stiffness +-5 %.
local ambit = require "ambit"
local around = ambit.around

local m = ambit.mechanism { "compressor", gravity = { 0, "-9.81", 0 } }
local r, l = around("32 mm", "0.1 mm", "crank"), around("110 mm", "0.1 mm", "rod")
local e = m:slider_crank { from = m.world, crank = r, rod = l, name = "e" }
m:point_mass { at = e.slider, mass = around("0.28", "2%", "piston") }
m:rigid_body { at = e.rod, mass = around("0.35", "2%", "rod mass"), centre = { "0.04", 0, 0 },
  inertia = { { "5e-5", 0, 0 }, { 0, "6e-4", 0 }, { 0, 0, "6e-4" } } }
m:rigid_body { at = e.crank, mass = 4, inertia = { { "0.01", 0, 0 }, { 0, "0.01", 0 }, { 0, 0, "0.02" } } }

local x = m:position(e.slider).x
local gap = "0.008" + (r + l) - x                     -- what is left of the cylinder, m
local gas = around(600, "5%", "gas") * ("0.008" / gap) ^ "1.3"
m:applied_force { at = e.slider, force = { -gas, 0, 0 } }
m:joint_damper { joint = e.joint, damping = around("0.002", "5%", "bearing") }

local run = ambit.simulate { m:dynamics(), initial = { ["e.crank"] = "0.5", ["e.crank'"] = "1500 rpm" },
  t = { 0, "0.04", "0.08", "0.12", "0.16" } }
print(run)
