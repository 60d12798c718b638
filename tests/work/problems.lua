-- problems.lua -- a dozen small problems whose work is counted: the ones that validated solvers are measured by, cut
-- short, each by the solvers that suit it; a robot's kinematics in each arithmetic; roots; draws.
local ambit = require "ambit"
local around = ambit.around
local problems = dofile "scripts/bench/problems.lua"

local list = {}

local function simulate(name, problem, t, settings)
  list[#list + 1] = { name = name, run = function() ambit.simulate(problems.request(problem, t, settings)) end }
end

simulate("double pendulum, an angle within 1 %, lohner", problems.P1, 0.4, { solver = "lohner" })
simulate("double pendulum, an angle within 1 %, taylor_model", problems.P1, 0.4, { solver = "taylor_model" })
simulate("double pendulum, an angle within 1 %, in pieces", problems.P1, 0.4, { solver = "lohner", threads = 1,
  split = { beta1 = 4 } })
simulate("double pendulum from a point, lohner", problems.P2, 2, { solver = "lohner" })
simulate("double pendulum from a point, valencia", problems.P2, 0.5, { solver = "valencia" })
simulate("Lorenz, lohner", problems.P3, 5, { solver = "lohner" })
simulate("Lorenz, taylor_model", problems.P3, 1, { solver = "taylor_model" })
simulate("Van der Pol, a box, taylor_model", problems.P4, 1, { solver = "taylor_model" })
simulate("fast decay, stiff", problems.P5_linear, 1, { solver = "stiff" })
simulate("Robertson, stiff", problems.robertson(1), 1, { solver = "stiff" })
simulate("pendulum, lohner", problems.P6_pendulum, 20, { solver = "lohner" })
simulate("pendulum, gsl", problems.P6_pendulum, 20, { solver = "gsl" })

-- A UR5 whose lengths and joint angles are uncertain: where its tool is.
local robot = ambit.load { "scripts/robots/ur5.urdf", tolerances = { ["*_joint.offset"] = "0.2%" } }
local pose = { shoulder_pan_joint = "0.1", shoulder_lift_joint = "-0.5", elbow_joint = "0.9", wrist_1_joint = "0.3",
  wrist_2_joint = "-0.7", wrist_3_joint = "1.1" }
local at = {}
for name, angle in pairs(pose) do at[name] = around(angle, "0.5 deg") end -- a set: the order does not matter
for _, arithmetic in ipairs { "real", "interval", "affine", "taylor_model", "gradient", "mpfr" } do
  list[#list + 1] = { name = "tool of a UR5, " .. arithmetic, run = function()
    ambit.evaluate { robot:position(robot.links.tool0), at = at, arithmetic = arithmetic }
  end }
end

list[#list + 1] = { name = "postures of a double pendulum, krawczyk", run = function()
  local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
  local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "a" }, offset = { 0, -1, 0 } }
  local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "b" }, offset = { 0, -1, 0 } }
  m:point_mass { at = elbow, mass = 1 }
  m:point_mass { at = hand, mass = 1 }
  ambit.equilibria { m:dynamics(), box = { a = { "-3.15", 1 }, b = { "-3.15", 1 } } }
end }

return list
