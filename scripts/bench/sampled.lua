-- sampled.lua -- controllers that sample: how long runs of them take, and how wide their sets are beside sampled ones.
--
--   ambit run scripts/bench/sampled.lua [pendulum|network|pid ...]
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"

local folder = (arg[0]:match ".*/" or "./") .. "../"

local function pendulum(law)
  local control = ambit.sampled { period = "10 ms", outputs = { "u" }, law = law }
  return (ambit.ode { states = { "x", "v" }, sampled = control,
    equations = function(s) return { x = s.v, v = ambit.sin(s.x) + s.u } end })
end

local function arm()
  local robot = ambit.load { folder .. "robots/ur5.urdf", gravity = { 0, 0, "-9.81" } }
  local joints = { "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3" }
  local stiffness, damping = { 2000, 2000, 1500, 300, 200, 50 }, { 300, 300, 150, 20, 15, 3 }
  local goal = { "0.2", "-0.8", 1, "0.1", "-0.5", "0.3" }
  local outputs, memory, initial = {}, {}, {}
  for i, joint in ipairs(joints) do
    outputs[i], memory["sum" .. i] = { "torque" .. i, "N m" }, 0
    initial[joint .. "_joint"] = ambit.around(goal[i] - ambit.number "0.1", "0.001")
    initial[joint .. "_joint'"] = 0
  end
  local pid = ambit.sampled { period = "1 ms", outputs = outputs, memory = memory, law = function(s, m)
    local torque, sum = {}, {}
    for i, joint in ipairs(joints) do
      local off = goal[i] - s[joint .. "_joint"]
      torque["torque" .. i] = stiffness[i] * off - damping[i] * s[joint .. "_joint'"] + m["sum" .. i]
      sum["sum" .. i] = m["sum" .. i] + stiffness[i] * ambit.number "0.001" * off
    end
    return torque, sum
  end }
  local held = robot:sampled(pid)
  for i, joint in ipairs(joints) do
    robot:joint_torque { joint = robot.joints[joint .. "_joint"], torque = held["torque" .. i] }
  end
  return robot:dynamics(), initial
end

local cases = {
  { name = "pendulum", what = "pendulum under PD at 100 Hz, 2 s", state = "x", t = 2, limit = 0.3, make = function()
    return pendulum(function(s) return -8 * s.x - 3 * s.v end), { x = ambit.around(1, "1%"), v = 0 }
  end },
  { name = "network", what = "pendulum under a network of 12 neurons at 100 Hz, 2 s", state = "x", t = 2, make = function()
    local net = ambit.network(folder .. "networks/pendulum.txt")
    return pendulum(function(s) return net { s.x, s.v }[1] end), { x = ambit.around("0.3", "0.02"), v = 0 }
  end },
  { name = "pid", what = "UR5 under PID at 1 kHz, 1 s", state = "elbow_joint", t = 1, limit = 30, make = arm },
}

print "| loop | samples | CPU time | asked for | width by that of draws |"
print "|---|---|---|---|---|"
for _, case in ipairs(cases) do
  if bench.wants(case.name) then
    local system, initial = case.make()
    local run = ambit.simulate { system, initial = initial, t = { 0, case.t } }
    local inner = ambit.sample { system, initial = initial, t = { 0, case.t }, n = 100 }
    local factor = run.x[case.state]:width() / (inner.x[case.state].hi - inner.x[case.state].lo)
    local good = run.status == "complete" and (not case.limit or run.cpu_seconds < case.limit)
    if not good then bench.missed = bench.missed + 1 end
    print(("| %s | %d | %s | %s | %s |"):format(case.what, math.floor(case.t / (case.name == "pid" and 0.001 or 0.01) + 0.5),
      bench.seconds(run.cpu_seconds), case.limit and bench.seconds(case.limit) or "", bench.number(factor)))
  end
end
if bench.missed > 0 then os.exit(1) end
