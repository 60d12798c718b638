-- A satellite with two flexible panels of two segments each turns by 20 degrees in 20 s under PD control. Masses +-2 %,
-- hinges +-5 %.
local ambit = require "ambit"
local around, degrees, t = ambit.around, ambit.degrees, ambit.time

local m = ambit.mechanism "satellite"
local hub, wheel = m:revolute { from = m.world, axis = "z", name = "hub" }
local hub_inertia = around(120, "2%", "hub")
m:rigid_body { at = hub, mass = 300, inertia = { { 120, 0, 0 }, { 0, 120, 0 }, { 0, 0, hub_inertia } } }

local initial = { hub = 0, ["hub'"] = 0 }
for _, side in ipairs { "left", "right" } do
  local way = side == "left" and -1 or 1
  local at = m:rigid_link { from = hub, offset = { way, 0, 0 } }
  local panel = around(6, "2%", side .. " panel")
  for i, stiffness in ipairs { 900, 1500 } do
    local name = side .. i
    local segment, hinge = m:revolute { from = at, axis = "z", name = name }
    m:joint_spring { joint = hinge, stiffness = around(stiffness, "5%", name .. " stiffness") }
    m:joint_damper { joint = hinge, damping = around(8, "5%", name .. " damping") }
    at = m:rigid_link { from = segment, offset = { "1.5" * ambit.number(way), 0, 0 } }
    m:rigid_body { at = at, mass = panel, centre = { "-0.75" * ambit.number(way), 0, 0 },
      inertia = { { "0.05", 0, 0 }, { 0, "1.1", 0 }, { 0, 0, "1.1" } } }
    initial[name], initial[name .. "'"] = 0, 0
  end
end

local s = (1 - ambit.cos(ambit.pi * t / 20)) / 2
m:joint_torque { joint = wheel, torque = function(q, w) return 60 * (degrees(20) * s - q) - 220 * w end }

local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, 5, 10, 15, 20 } }
print(run)
