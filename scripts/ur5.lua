-- ur5.lua -- a UR5 whose lengths, joint angles and masses are known only within tolerances: where its tool can be, and
-- which torques hold it, in one pose and while it sweeps through a range of poses.
--
-- Enclosures hold for every arm within the tolerances. The sampled hull is the estimate from inside, which proves
-- nothing: the truth lies between the two.
local ambit = require "ambit"
local around, between = ambit.around, ambit.between

local arm = ambit.load {
  "robots/ur5.urdf", gravity = { 0, 0, "-9.81" },
  tolerances = {
    ["*_joint.offset"] = "0.2%", ["tool0_fixed_joint.offset"] = 0, -- seven lengths
    ["*_link.mass"] = "2%", ["base_link.mass"] = 0,            -- six masses
  },
}
local joints = { "shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint",
  "wrist_3_joint" }
local pose = { "0.1", "-0.5", "0.9", "0.3", "-0.7", "1.1" } -- rad

local function posture(angle)
  local at = {}
  for i, name in ipairs(joints) do at[name] = angle(pose[i], i) end
  return at
end

local draws = 100000

-- One row for each arithmetic, the last one for the sampled hull; the width of each component.
local function compare(title, names, components, at)
  local function row(name, result, seconds)
    local widths = {}
    for i = 1, #components do widths[i] = ("%10.6f"):format(result[i]:width()) end
    print(("  %-13s %s %9.3f ms"):format(name, table.concat(widths), 1000 * seconds))
  end
  print(("%s\n  %-13s %10s%10s%10s %12s"):format(title, "", names[1], names[2], names[3], "time"))
  local best
  for _, arithmetic in ipairs { "interval", "affine", "taylor_model" } do
    best = ambit.evaluate { components, at = at, arithmetic = arithmetic }
    row(arithmetic, best, best.cpu_seconds)
  end
  local hull = ambit.sample { components, at = at, n = draws }
  row("sampled hull", hull, hull.cpu_seconds)
  local excess = 0
  for i = 1, #components do
    if hull[i]:width() > 0 then excess = math.max(excess, best[i]:width() / hull[i]:width() - 1) end
  end
  print(("  taylor_model is at most %.1f %% wider than the hull"):format(100 * excess))
  return best
end

local tip = arm:position(arm.links.tool0)
local tool, xyz = { tip.x, tip.y, tip.z }, { "x", "y", "z" }
local torque = arm:gravity_torque()
local held, motors = { torque[2], torque[3], torque[4] }, { "shoulder", "elbow", "wrist 1" } -- the others bear nothing

-- 12 uncertain data: seven lengths, five angles (the last joint turns the tool on the spot)
local set = posture(function(q) return around(q, "0.5 deg") end)
local box = compare("width of the box of the tool, m: lengths +-0.2 %, angles +-0.5 degrees", xyz, tool, set)
print("  the tool is in", box[1], box[2], box[3])
ambit.view { arm, at = set, points = { tool = arm.links.tool0, elbow = arm.links.forearm_link } }

-- the same lengths, six masses
local moments = compare("\nwidth of the torques that hold the pose, N m: lengths +-0.2 %, masses +-2 %", motors, held,
  posture(function(q) return q end))
for i = 1, 3 do print(("  %-20s"):format(joints[i + 1]), moments[i]) end

-- the shoulder and the elbow swing by +-0.1 rad
local swept = posture(function(q, i)
  return (i == 2 or i == 3) and between(tonumber(q) - 0.1, tonumber(q) + 0.1) or q
end)
local limits = arm:limits()
compare("\nwidth of the box of the tool, m, while the shoulder lifts and the elbow bends by +-0.1 rad", xyz, tool,
  swept)
local range = compare("\nwidth of the holding torques, N m, in that range", motors, held, swept)
for i = 1, 3 do
  local most = limits[joints[i + 1]].effort
  local share = ambit.evaluate { range[i] / most }
  print(("  %-20s at most %.1f %% of what the motor gives"):format(joints[i + 1], 100 * share:mag()))
end
