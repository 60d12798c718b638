-- manipulator.lua: where can the hand be, with every length, angle and joint play at its tolerance?
--
-- Five arms with sloppy joints (Auer, Kecskemethy, Taendl and Traczinski: SmartMOBILE, 2007, table 1). Lengths +-0.1 %,
-- angles +-0.1 degrees, and a play of up to 2 mm in any direction at each joint. The true range is 0.1027 m by 0.2236
-- m.
local ambit = require "ambit"
local around, degrees = ambit.around, ambit.degrees

local lengths = { "6.5", 4, 4, 4, "3.5" }        -- m
local angles  = { 60, -20, -20, -20, -30 }       -- degrees

local arm = ambit.mechanism "five-arm manipulator"
local at  = arm.world
for i = 1, 5 do
  at = arm:sloppy_joint { from = at, axis = "z", angle = degrees(around(angles[i], "0.1")), play = "0.002" }
  at = arm:rigid_link   { from = at, offset = { around(lengths[i], "0.1%"), 0, 0 } }
end

print "position of the hand, m"
print "arithmetic     x                    y                    width of x  width of y"
local function show(x) return x:width() > 0 and tostring(x) or ("%.6f"):format(x:mid()) end
for _, arithmetic in ipairs { "real", "interval", "affine", "taylor_model", "gradient" } do
  local tip = ambit.evaluate { arm:position(at), arithmetic = arithmetic }
  local row = "%-13s  %-19s  %-19s  %-10.4f  %.4f"
  print(row:format(arithmetic, show(tip.x), show(tip.y), tip.x:width(), tip.y:width()))
end
