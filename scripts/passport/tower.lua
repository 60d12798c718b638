-- A building of three storeys with a tuned mass on its roof is shaken at its base. Masses +-2 %, stiffness and damping
-- +-5 %.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism "tower"
local ground = m:prismatic { from = m.world, axis = "x",
  displacement = "0.02" * ambit.sin(6 * t) * (1 - ambit.exp(-t)) }
local at, initial = ground, {}
local storeys = { { "floor1", 20000, "1.2e7", 40000 }, { "floor2", 20000, "1.1e7", 40000 },
  { "floor3", 18000, "0.9e7", 30000 }, { "absorber", 900, "32000", 1100 } }
for _, storey in ipairs(storeys) do
  local name, mass, k, d = table.unpack(storey)
  local floor, joint = m:prismatic { from = at, axis = "x", name = name }
  m:point_mass { at = floor, mass = around(mass, "2%", name) }
  m:joint_spring { joint = joint, stiffness = around(k, "5%", name .. " stiffness") }
  m:joint_damper { joint = joint, damping = around(d, "5%", name .. " damping") }
  initial[name], initial[name .. "'"] = 0, 0
  at = floor
end

local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, 1, 2, 4, 6 } }
print(run)
