-- forever.lua -- sets that nothing leaves: how large they are, and what they take.
--
--   ambit run scripts/bench/forever.lua [arm|robot ...]
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"

local folder = (arg[0]:match ".*/" or "./") .. "../"

-- Two links, with 5 % on lengths, masses and stiffnesses: within 5 degrees of the goal for ever.
local function arm()
  local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
  local f1, j1 = m:revolute { from = m.world, axis = "z", name = "a" }
  local elbow = m:rigid_link { from = f1, offset = { ambit.around(1, "5%"), 0, 0 } }
  m:point_mass { at = elbow, mass = ambit.around(1, "5%") }
  local f2, j2 = m:revolute { from = elbow, axis = "z", name = "b" }
  local tip = m:rigid_link { from = f2, offset = { ambit.around(1, "5%"), 0, 0 } }
  m:point_mass { at = tip, mass = ambit.around(1, "5%") }
  local k1, k2 = ambit.around(400, "5%"), ambit.around(200, "5%")
  m:joint_torque { joint = j1, torque = function(q, v) return k1 * ("0.5" - q) - 60 * v end }
  m:joint_torque { joint = j2, torque = function(q, v) return k2 * ("0.7" - q) - 25 * v end }
  local safe = {}
  for name, goal in pairs { a = ambit.number "0.5", b = ambit.number "0.7" } do
    safe[name .. " above"] = function(s) return s[name] - goal - ambit.degrees(5) end
    safe[name .. " below"] = function(s) return goal - s[name] - ambit.degrees(5) end
  end
  local answer = ambit.verify { m:dynamics(), t = math.huge, safe = safe,
    initial = { a = ambit.around("0.45", "0.01"), b = ambit.around("0.68", "0.01"), ["a'"] = 0, ["b'"] = 0 } }
  return answer, answer.status, "proved, 10 s", answer.status == "proved" and answer.cpu_seconds < 10
end

-- Masses and damping of a UR5 under PD, 2 % each: a ball about rest.
local function robot()
  local m = ambit.load { folder .. "robots/ur5.urdf", gravity = { 0, 0, "-9.81" },
    tolerances = { ["*_link.mass"] = "2%" } }
  local joints = { "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3" }
  local stiffness, damping = { 2000, 2000, 1500, 300, 200, 50 }, { 300, 300, 150, 20, 15, 3 }
  local goal, about = { "0.2", "-0.8", 1, "0.1", "-0.5", "0.3" }, {}
  for i, joint in ipairs(joints) do
    local d = ambit.around(damping[i], "2%")
    m:joint_torque { joint = m.joints[joint .. "_joint"], torque = function(q, v)
      return stiffness[i] * (goal[i] - q) - d * v
    end }
    about[joint .. "_joint"] = goal[i]
  end
  local set = ambit.invariant { m, about = about }
  local least = math.huge
  for _, joint in ipairs(set.box and joints or {}) do least = math.min(least, set.box[joint .. "_joint"]:rad()) end
  return set, ("%s, angles +- %s rad and more"):format(set.status, bench.number(least)), "proved",
    set.status == "proved"
end

print "| problem | result | asked for | CPU time |"
print "|---|---|---|---|"
for _, case in ipairs {
  { "arm", "two-link arm under PD, 6 data of 5 %: within 5 degrees for ever", arm },
  { "robot", "UR5 under PD, masses and dampings of 2 %: a set about rest", robot },
} do
  if bench.wants(case[1]) then
    local found, result, asked, good = case[3]()
    if not good then bench.missed = bench.missed + 1 end
    print(("| %s | %s | %s%s | %s |"):format(case[2], result, asked, good and "" or ": missed",
      bench.seconds(found.cpu_seconds)))
  end
end
if bench.missed > 0 then os.exit(1) end
