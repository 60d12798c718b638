-- stewart.lua -- a Stewart platform on six servo legs, with radii and masses within a tolerance, moves from one height
-- to another and tilts on the way.
--   ambit run stewart.lua [0.1%]
local ambit = require "ambit"
local cos, sin, degrees = ambit.cos, ambit.sin, ambit.degrees

local tolerance = arg[1] or "0.1%"
local function datum(value, name) return ambit.around(value, tolerance, name) end

local m = ambit.mechanism { "Stewart platform", gravity = { 0, 0, "-9.81" } }
local plate = m:free { from = m.world, name = "plate" } -- angles plate.1 to .3, displacements plate.4 to .6
local scale = datum(1, "inertia of the plate")
m:rigid_body { at = plate, mass = datum(20, "plate"),
  inertia = { "0.5" * scale, 0, 0, 0, "0.5" * scale, 0, 0, 0, scale } }

local height = ambit.number "0.8"
local base, top = datum("0.5", "radius of the base"), datum("0.3", "radius of the plate")
local initial, home = {}, {}
for i = 1, 6 do
  initial["plate." .. i], initial["plate." .. i .. "'"] = i == 6 and height or 0, 0
  home["plate." .. i] = initial["plate." .. i]
end

local function on_circle(radius, angle) return radius * cos(degrees(angle)), radius * sin(degrees(angle)) end

-- Angles and length of a leg by what it reaches to.
local function leg(into, i, x, y)
  local length = ambit.sqrt(x ^ 2 + y ^ 2 + height ^ 2)
  into["foot" .. i .. ".1"], into["foot" .. i .. ".2"] = -ambit.atan(y / height), ambit.asin(x / length)
  into["leg" .. i] = length
end

for i = 1, 6 do
  local third, side = 120 * ((i - 1) // 2), i % 2 == 0 and 1 or -1
  local bx, by = on_circle(base, third + 10 * side)
  local px, py = on_circle(top, third + 50 * side)
  local swivel = m:universal { from = m:rigid_link { from = m.world, offset = { bx, by, 0 } }, name = "foot" .. i }
  local rod, stroke = m:prismatic { from = swivel, axis = "z", name = "leg" .. i }
  m:rigid_body { at = swivel, mass = datum(1, "cylinder" .. i), centre = { 0, 0, "0.2" },
    inertia = { "0.01", 0, 0, 0, "0.01", 0, 0, 0, "0.001" } }
  m:point_mass { at = rod, mass = datum("0.5", "rod" .. i) }
  local wanted = ambit.number "0.86" + ambit.number(i) / 200 -- each leg is asked for another length
  m:joint_torque { joint = stroke, force = function(l, v) return 45 + 4000 * (wanted - l) - 400 * v end }
  m:close_point { a = rod, b = m:rigid_link { from = plate, offset = { px, py, 0 } }, name = "ball" .. i }
  leg(initial, i, px - bx, py - by)
  local hx, hy = on_circle(ambit.number "0.5", third + 10 * side)
  local tx, ty = on_circle(ambit.number "0.3", third + 50 * side)
  leg(home, i, tx - hx, ty - hy)
end
m:reference(home)
m:independent { "plate.1", "plate.2", "plate.3", "plate.4", "plate.5", "plate.6" }

local times = { 0 }
for k = 1, 10 do times[k + 1] = ambit.number(k) / 10 end
local run = ambit.simulate { m:dynamics(), initial = initial, t = times }
print(run, run.x["plate.6"])
