-- stewart.lua: a Stewart platform: six legs, each a universal joint, a slider and a ball, carry a plate. Six loops,
-- eighteen closing conditions, six degrees of freedom, and a workspace that is proved to be free of singular positions.
local ambit = require "ambit"
local cos, sin, degrees = ambit.cos, ambit.sin, ambit.degrees

local m = ambit.mechanism { "Stewart platform", gravity = { 0, 0, "-9.81" } }
local plate = m:free { from = m.world, name = "plate" } -- angles plate.1 to .3, displacements plate.4 to .6
m:rigid_body { at = plate, mass = 20, inertia = { "0.5", 0, 0, 0, "0.5", 0, 0, 0, 1 } }

local height = ambit.number "0.8"
local home = { ["plate.6"] = height }
for i = 1, 5 do home["plate." .. i] = 0 end

local function on_circle(radius, angle) return radius * cos(degrees(angle)), radius * sin(degrees(angle)) end

for i = 1, 6 do
  local third, side = 120 * ((i - 1) // 2), i % 2 == 0 and 1 or -1
  local bx, by = on_circle(ambit.number "0.5", third + 10 * side)
  local px, py = on_circle(ambit.number "0.3", third + 50 * side)
  local foot, cylinder = "foot" .. i, "leg" .. i
  local swivel = m:universal { from = m:rigid_link { from = m.world, offset = { bx, by, 0 } }, name = foot }
  local rod, stroke = m:prismatic { from = swivel, axis = "z", name = cylinder }
  m:rigid_body { at = swivel, mass = 1, centre = { 0, 0, "0.2" },
    inertia = { "0.01", 0, 0, 0, "0.01", 0, 0, 0, "0.001" } }
  m:point_mass { at = rod, mass = "0.5" }
  m:joint_torque { joint = stroke, force = 45 }
  m:close_point { a = rod, b = m:rigid_link { from = plate, offset = { px, py, 0 } }, name = "ball" .. i }

  local x, y = px - bx, py - by -- how the leg lies at home
  local length = ambit.sqrt(x ^ 2 + y ^ 2 + height ^ 2)
  home[foot .. ".1"], home[foot .. ".2"], home[cylinder] = -ambit.atan(y / height), ambit.asin(x / length), length
end

m:reference(home)
m:independent { "plate.1", "plate.2", "plate.3", "plate.4", "plate.5", "plate.6" }

local worst = 0
for _, gap in pairs(ambit.evaluate { m:constraints(), at = home }) do worst = math.max(worst, gap:mag()) end
print(("gap of the loops at home < %.1e m"):format(worst))

-- Within 5 cm and 0.1 rad of home the plate determines all legs.
local box = {}
for name, value in pairs(home) do
  local middle = ambit.evaluate { value }:mid()
  local reach = name:find "^plate.[456]$" and 0.05 or name:find "^plate" and 0.1 or 0.25
  box[name] = { middle - reach, middle + reach }
end
print("rank in the workspace: " .. m:rank { box = box }.status)

local start = {}
for _, name in ipairs(m:dynamics().states) do start[name] = home[name] or 0 end
local run = ambit.simulate { m:dynamics(), initial = start, t = { 0, "0.1", "0.2" } }
for _, t in ipairs { 0.1, 0.2 } do
  if t <= run.t_reached then
    local x = run:at(t)
    print(("t = %g s: height %s m, leg 1 %s m"):format(t, x["plate.6"], x.leg1))
  end
end
print(run)
ambit.view { m, run = run, points = { plate = plate } }
