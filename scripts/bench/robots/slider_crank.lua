-- slider_crank.lua -- a slider-crank, all of whose lengths and masses have a tolerance, is driven through three turns.
--   ambit run slider_crank.lua [0.1%]
local ambit = require "ambit"

local tolerance = arg[1] or "0.1%"
local function datum(value, name) return ambit.around(value, tolerance, name) end

local m = ambit.mechanism { "slider-crank", gravity = { 0, "-9.81", 0 } }
local length = { crank = datum("0.1", "crank"), rod = datum("0.3", "rod") }
local mass = { crank = datum(1, "mass of the crank"), rod = datum(2, "mass of the rod") }

-- A slender bar on a hinge: the frame of its far end, and the hinge.
local function bar(name, from)
  local at, hinge = m:revolute { from = from, axis = "z", name = name }
  local l, moment = length[name], mass[name] * length[name] ^ 2 / 12
  m:rigid_body { at = at, mass = mass[name], centre = { l / 2, 0, 0 },
    inertia = { 0, 0, 0, 0, moment, 0, 0, 0, moment } }
  return m:rigid_link { from = at, offset = { l, 0, 0 } }, hinge
end
local tip, drive = bar("crank", m.world)
local pin = bar("rod", tip)
m:point_mass { at = pin, mass = datum("0.5", "piston") }
m:point_on_line { a = m.world, b = pin, axis = "x", name = "guide" }
m:joint_torque { joint = drive, torque = function(_, v) return 2 * (10 - v) end } -- towards 10 rad/s
m:independent { "crank" }

local angle = ambit.number "0.5"
local rod = -angle - ambit.asin(length.crank / length.rod * ambit.sin(angle))
local initial = { crank = angle, rod = rod, ["crank'"] = 10 }
local times = { 0 }
for k = 1, 10 do times[k + 1] = ambit.number "1.9" * k / 10 end -- 10 rad/s: three turns in 1.885 s
local run = ambit.simulate { m:dynamics(), initial = initial, t = times }
print(run, run.x.crank)
