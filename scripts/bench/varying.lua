-- varying.lua -- what varies in time: reach by the exact one, and what a robot under it takes.
--
--   ambit run scripts/bench/varying.lua [damped|undamped|slow|robot ...]
--
-- robot, which takes minutes, only if it is named.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local bench = require "bench"

local folder = (arg[0]:match ".*/" or "./") .. "../"

local function oscillator(damping, push, t)
  local system = ambit.ode { states = { "x", "v" },
    equations = function(s) return { x = s.v, v = -s.x - damping * s.v + push } end }
  return ambit.simulate { system, initial = { x = 0, v = 0 }, t = { 0, t } }
end

-- The integral of the absolute value of the impulse response, e^(-d s) sin(w s) / w, over n half turns and a rest that
-- begins one: a push that always goes with the motion.
local function exact(damping, most, t)
  local d = 0.5 * damping
  local w = math.sqrt(1 - d * d)
  local function primitive(s) return -math.exp(-d * s) * (d * math.sin(w * s) + w * math.cos(w * s)) / w end
  local sum, from, sign = 0, 0, 1
  while from < t do
    local to = math.min(t, from + math.pi / w)
    sum, from, sign = sum + sign * (primitive(to) - primitive(from)), to, -sign
  end
  return most * sum
end

local function by_exact(damping, most, t, limit)
  local number = ambit.number(("%.17g"):format(damping))
  local run = oscillator(number, ambit.varying("-" .. most, most), t)
  local reach = exact(damping, tonumber(most), t)
  local factor = run.x.x.hi / reach
  return run, ("reach %s, exact %s: %s times"):format(bench.number(run.x.x.hi), bench.number(reach),
    bench.number(factor)), ("%s times"):format(limit), run.status == "complete" and factor >= 1 - 1e-12 and factor < limit
end

-- The highest integral of sin(t - s) d(s) over [0, t] with |d| <= 1 and |d'| <= rate, by dynamic programming over d in
-- steps of rate h: less than the true one by what the steps leave.
local function exact_slow(rate, t)
  local cells = 800
  local h = 2 / cells / rate
  local n = math.floor(t / h)
  local value = {}
  for j = 0, cells do value[j] = 0 end
  for k = 1, n do
    local now, weight = {}, math.sin(t - (k - 0.5) * h) * h
    for j = 0, cells do
      local best = math.max(value[j], value[j - 1] or -math.huge, value[j + 1] or -math.huge)
      now[j] = best + weight * (2 * j / cells - 1)
    end
    value = now
  end
  return math.max(table.unpack(value, 0, cells))
end

local function by_rate(rate, t, limit)
  local push = ambit.varying(-1, 1, { rate = rate })
  local system = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x + push } end }
  local request = { system, initial = { x = 0, v = 0 }, t = { 0, t } }
  local run, reach = ambit.simulate(request), exact_slow(tonumber(rate), t)
  request.n = 1000
  local drawn = ambit.sample(request)
  local factor = run.x.x.hi / reach
  return run, ("reach %s, exact %s: %s times; samples to %s"):format(bench.number(run.x.x.hi), bench.number(reach),
    bench.number(factor), bench.number(drawn.x.x.hi)), ("%s times"):format(limit),
    run.status == "complete" and run.x.x.hi >= reach and drawn.x.x.hi <= run.x.x.hi and factor < limit
end

local function robot()
  local arm = ambit.load { folder .. "robots/ur5.urdf", gravity = { 0, 0, "-9.81" } }
  local joints = { "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3" }
  local stiffness, damping = { 2000, 2000, 1500, 300, 200, 50 }, { 300, 300, 150, 20, 15, 3 }
  local goal, initial = { "0.2", "-0.8", 1, "0.1", "-0.5", "0.3" }, {}
  for i, joint in ipairs(joints) do
    local noise = ambit.varying("-0.001", "0.001", "noise of " .. joint)
    local share = ambit.varying("0.98", "1.02", "torque of " .. joint)
    arm:joint_torque { joint = arm.joints[joint .. "_joint"], torque = function(q, v)
      return share * (stiffness[i] * (goal[i] - (q + noise)) - damping[i] * v)
    end }
    initial[joint .. "_joint"], initial[joint .. "_joint'"] = goal[i] - ambit.number "0.1", 0
  end
  local run = ambit.simulate { arm:dynamics(), initial = initial, t = { 0, 2 } }
  local good = run.status == "complete" and run.cpu_seconds < 30
  return run, ("%s, elbow +- %s rad"):format(run.status, bench.number(run.x.elbow_joint:rad())), "30 s", good
end

local cases = {
  { "damped", "x'' = -x - 0.2 x' + d, d in [-0.1, 0.1], 60 s", function() return by_exact(0.2, "0.1", 60, 1.02) end },
  { "undamped", "x'' = -x + d, d in [-1, 1], 20 s", function() return by_exact(0, "1", 20, 1.05) end },
  { "slow", "the same, d' in [-0.1, 0.1]", function() return by_rate("0.1", 20, 1.25) end },
  { "slow", "the same, 60 s", function() return by_rate("0.1", 60, 1.25) end },
  { "robot", "UR5 under PD, 2 s: torques vary by 2 %, sensors by 1 mrad", robot },
}

print "| problem | result | asked for | CPU time |"
print "|---|---|---|---|"
for _, case in ipairs(cases) do
  if bench.wants(case[1]) and (case[1] ~= "robot" or (arg or {})[1]) then
    local run, result, limit, good = case[3]()
    if not good then bench.missed = bench.missed + 1 end
    print(("| %s | %s | %s%s | %s |"):format(case[2], result, limit, good and "" or ": missed",
      bench.seconds(run.cpu_seconds)))
  end
end
if bench.missed > 0 then os.exit(1) end
