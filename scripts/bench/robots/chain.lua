-- chain.lua -- a chain of N links in a plane, point masses at their ends, is let go from horizontal rest.
--   ambit run chain.lua [N] [T] [TOLERANCE|exact] [DAMPING]
local ambit = require "ambit"

local n, finish, tolerance, damping = tonumber(arg[1] or 3), arg[2] or "1", arg[3] or "1%", arg[4]

local function datum(value, name)
  if tolerance == "exact" then return ambit.number(value) end
  return ambit.around(value, tolerance, name)
end

local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
local at, initial = m.world, {}
for i = 1, n do
  local turned, joint = m:revolute { from = at, axis = "z", name = "q" .. i }
  at = m:rigid_link { from = turned, offset = { datum("0.5", "length" .. i), 0, 0 } }
  m:point_mass { at = at, mass = datum(1, "mass" .. i) }
  if damping then m:joint_damper { joint = joint, damping = damping } end
  initial["q" .. i], initial["q" .. i .. "'"] = 0, 0
end

local times = { 0 }
for k = 1, 10 do times[k + 1] = ambit.number(finish) * k / 10 end
local run = ambit.simulate { m:dynamics(), initial = initial, t = times }
print(run)
for i = 1, n, math.max(1, n // 5) do print("q" .. i, run.x["q" .. i]) end
