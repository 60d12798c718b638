-- double_pendulum.lua DATA-FOLDER: the data of the picture in the README, for docs/picture/double_pendulum.gp
-- boxes.dat: t_from t_to lo hi of beta1, then of beta2, over each step; samples.dat: t beta1 beta2 of simulated
-- pendulums
local ambit = require "ambit"
local folder = arg[1] or "."
local around, pi = ambit.around, ambit.pi

local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
m:point_mass { at = hand, mass = 1 }

local function start(first)
  return { beta1 = first, beta2 = -11 * pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" }
end

local END, PARTS = 3, 120
local times = {}
for k = 0, PARTS do times[k + 1] = END * k / PARTS end

local run = ambit.simulate {
  m:dynamics(), initial = start(around(3 * pi / 4, "1%")), t = times, solver = "taylor_model", order = 12,
}
local boxes = assert(io.open(folder .. "/boxes.dat", "w"))
for step in run:steps() do
  local a, b = step.tube.beta1, step.tube.beta2
  boxes:write(("%.17g %.17g %.17g %.17g %.17g %.17g\n"):format(step.t_from, step.t, a.lo, a.hi, b.lo, b.hi))
end
boxes:close()

local samples = assert(io.open(folder .. "/samples.dat", "w"))
for i = -3, 3 do
  local first = 3 * math.pi / 4 * (1 + i / 300)
  local sample = ambit.simulate { m:dynamics(), initial = start(first), t = times, solver = "gsl" }
  for _, t in ipairs(times) do
    if t > 0 then
      local x = sample:at(t)
      samples:write(("%.17g %.17g %.17g\n"):format(t, x.beta1:mid(), x.beta2:mid()))
    end
  end
end
samples:close()
