-- four_bar.lua -- a crank and rocker, all of whose lengths and masses have a tolerance, is driven through three turns.
--   ambit run four_bar.lua [0.1%]
local ambit = require "ambit"
local acos, atan2, cos, sin = ambit.acos, ambit.atan2, ambit.cos, ambit.sin

local tolerance = arg[1] or "0.1%"
local function datum(value, name) return ambit.around(value, tolerance, name) end

local m = ambit.mechanism { "four-bar", gravity = { 0, "-9.81", 0 } }
local ground = datum("0.4", "ground")
local length = { crank = datum("0.1", "crank"), coupler = datum("0.35", "coupler"), rocker = datum("0.25", "rocker") }
local mass = { crank = datum(1, "mass of the crank"), coupler = datum(2, "mass of the coupler"),
  rocker = datum("1.5", "mass of the rocker") }

-- A slender bar on a hinge: the frame of its far end, and the hinge.
local function bar(name, from)
  local at, hinge = m:revolute { from = from, axis = "z", name = name }
  local l, moment = length[name], mass[name] * length[name] ^ 2 / 12
  m:rigid_body { at = at, mass = mass[name], centre = { l / 2, 0, 0 },
    inertia = { 0, 0, 0, 0, moment, 0, 0, 0, moment } }
  return m:rigid_link { from = at, offset = { l, 0, 0 } }, hinge
end
local tip, drive = bar("crank", m.world)
local pin = bar("coupler", tip)
local rocker = bar("rocker", m:rigid_link { from = m.world, offset = { ground, 0, 0 } })
m:close_pin { a = pin, b = rocker, name = "loop" }
m:joint_torque { joint = drive, torque = function(_, v) return 2 * (10 - v) end } -- towards 10 rad/s

-- Where coupler and rocker are for the crank's first angle: the law of cosines.
local angle = ambit.number "0.5"
local x, y = length.crank * cos(angle), length.crank * sin(angle)
local square = (ground - x) ^ 2 + y ^ 2
local inside = acos((length.coupler ^ 2 + square - length.rocker ^ 2) / (2 * length.coupler * ambit.sqrt(square)))
local coupler = atan2(-y, ground - x) + inside
local initial = { crank = angle, coupler = coupler - angle, ["crank'"] = 10,
  rocker = atan2(y + length.coupler * sin(coupler), x + length.coupler * cos(coupler) - ground) }
m:reference { crank = "0.5", coupler = "0.21", rocker = "1.7" }
m:independent { "crank" }

local times = { 0 }
for k = 1, 10 do times[k + 1] = ambit.number "1.9" * k / 10 end -- 10 rad/s: three turns in 1.885 s
local run = ambit.simulate { m:dynamics(), initial = initial, t = times }
print(run, run.x.crank)
