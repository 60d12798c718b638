-- inverse_kinematics.lua -- all eight postures in which a UR5 holds its tool at a given place, proved; then for every
-- arm whose lengths are within their tolerances.
--
-- Each line is one posture: no other one exists with the shoulder, elbow and wrist turned within half a turn.
local ambit = require "ambit"

local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
  "wrist_3_joint" }
local want = { position = { "0.4", "-0.2", "0.5" }, orientation = { rpy = { "2.8", "0.3", "0.7" } } } -- m, rad

local function solve(tolerance)
  local arm = ambit.load { "robots/ur5.urdf", tolerances = { ["*_joint.offset"] = tolerance } }
  local found = ambit.inverse_kinematics {
    arm, at = arm.links.tool0, position = want.position, orientation = want.orientation,
  }
  print(("lengths +-%s: %s, %d postures, %d undecided"):format(tolerance, found.status, #found.proved,
    #found.undecided))
  for _, posture in ipairs(found.proved) do
    local row, widest = {}, 0
    for i, name in ipairs(joints) do
      row[i] = ("%8.4f"):format(posture[name]:mid())
      widest = math.max(widest, posture[name]:width())
    end
    print(("  %s   each within %.1e rad"):format(table.concat(row), widest))
  end
  return arm, found
end

solve "0"
local arm, found = solve "0.1%"
ambit.view { arm, at = found.proved[1], points = { tool = arm.links.tool0 } }
