-- A windscreen wiper: a motor with a falling torque turns the crank of a crank-rocker whose rocker carries the blade,
-- which rubs on the glass. Masses +-2 %, friction +-5 %, lengths +-0.1 mm.
local ambit = require "ambit"
local around = ambit.around

local m = ambit.mechanism { "wiper", gravity = { 0, "-9.81", 0 } }
local w = m:four_bar { from = m.world, name = "w",
  ground = around("200 mm", "0.1 mm", "ground"), crank = around("45 mm", "0.1 mm", "crank"),
  coupler = around("190 mm", "0.1 mm", "coupler"), rocker = around("80 mm", "0.1 mm", "rocker") }
local blade = m:rigid_link { from = w.rocker, offset = { "0.4", 0, 0 } }
m:point_mass { at = blade, mass = around("0.25", "2%", "blade") }
m:point_mass { at = w.tip, mass = around("0.1", "2%", "coupler mass") }
m:rigid_body { at = w.crank, mass = 1, inertia = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, around("0.03", "2%", "motor") } },
  physical = false }
m:joint_torque { joint = w.joint, torque = function(_, rate) return 12 - 2 * rate end }
m:joint_friction { joint = w.rocker_joint, coulomb = around(1, "5%", "glass"), velocity = "0.2" }

local run = ambit.simulate { m:dynamics(), initial = { ["w.crank"] = 0, ["w.crank'"] = 5 },
  t = { 0, "0.5", 1, "1.5", 2 } }
print(run)
