-- bricard.lua: six hinges and six rods in a ring. Counting says that nothing moves (6 - 6 = 0 degrees of freedom), yet
-- it does: one of the five closing conditions follows from the others (Bricard 1897; library of multibody benchmarks of
-- IFToMM, problem A04). Ambit finds and names it.
local ambit = require "ambit"

local m = ambit.mechanism { "Bricard's linkage", gravity = { 0, "-9.81", 0 } }

local long, thick = "1.01/12", "1/600" -- inertia of 1 m x 0.1 m x 0.1 m, 1 kg: across and along
local function rod(name, from, axis, x, y, z)
  local at = m:revolute { from = from, axis = axis, name = name }
  local inertia = { x ~= 0 and thick or long, 0, 0, 0, y ~= 0 and thick or long, 0, 0, 0, z ~= 0 and thick or long }
  m:rigid_body { at = at, mass = 1, centre = { x / 2, y / 2, z / 2 }, inertia = inertia }
  return m:rigid_link { from = at, offset = { x, y, z } }
end

local at = m.world -- edges of a cube: each rod is perpendicular to the next
at = rod("q1", at, "y", 1, 0, 0)
at = rod("q2", at, "z", 0, -1, 0)
at = rod("q3", at, "x", 0, 0, 1)
at = rod("q4", at, "y", -1, 0, 0)
at = rod("q5", at, "z", 0, 1, 0)
m:close_revolute { a = m:rigid_link { from = m.world, offset = { 0, 0, 1 } }, b = at, axis = "x", name = "ring" }

print("follows from the others: " .. table.concat(m:redundant(), ", "))
print("independent: " .. table.concat(m:independent(), ", "))

local start = { q1 = 0, q2 = 0, q3 = 0, q4 = 0, q5 = 0, ["q1'"] = 0 }
local system = m:dynamics()
print("q1'' at the start: " .. tostring(ambit.evaluate { system:rate "q1'", at = start }) .. " rad/s^2")

local run = ambit.simulate { system, initial = start, t = { 0, "0.5", 1 } }
for _, t in ipairs { 0.5, 1 } do
  if t <= run.t_reached then
    local x = run:at(t)
    print(("t = %g s: q1 = %s, q2 = %s"):format(t, x.q1, x.q2))
  end
end
print(run)
