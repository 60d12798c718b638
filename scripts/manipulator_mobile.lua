-- manipulator_mobile.lua: the same arm as manipulator.lua, by the paper's own formulas and plain interval arithmetic.
--
-- MOBILE keeps for each frame the rotation R and the position r in the frame's OWN axes, so every joint turns the box r
-- once more: wrapping makes the result ten times too wide. The published interval row is 1.047 by 1.041 (SmartMOBILE
-- 2007, table 1; the lengths there are within 0.1 %).
local ambit = require "ambit"
local interval, sin, cos, degrees = ambit.interval, ambit.sin, ambit.cos, ambit.degrees

local lengths = { "6.5", "4", "4", "4", "3.5" }  -- m
local angles  = { 60, -20, -20, -20, -30 }       -- degrees
local play    = interval "[0, 0.002]"            -- m
local turn    = interval(0, 2 * ambit.pi)        -- any direction

local R = { { interval(1), interval(0) }, { interval(0), interval(1) } }
local r = { interval(0), interval(0) }

for i = 1, 5 do
  -- sloppy joint: R <- R Rot(phi); r <- Rot(phi)^T r + l (cos alpha, sin alpha)
  local phi = degrees(interval(angles[i]) + interval "[-0.1, 0.1]")
  local c, s = cos(phi), sin(phi)
  for row = 1, 2 do
    local a, b = R[row][1], R[row][2]
    R[row] = { a * c + b * s, b * c - a * s }
  end
  r = { c * r[1] + s * r[2] + play * cos(turn), c * r[2] - s * r[1] + play * sin(turn) }
  -- rigid link: r <- r + (L, 0)
  r[1] = r[1] + interval(lengths[i]) * interval "[0.999, 1.001]"
end

local x = R[1][1] * r[1] + R[1][2] * r[2]
local y = R[2][1] * r[1] + R[2][2] * r[2]
print("x", x, ("width %.3f m"):format(x:width()))
print("y", y, ("width %.3f m"):format(y:width()))
