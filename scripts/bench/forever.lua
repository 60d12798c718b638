-- forever.lua -- sets that nothing leaves: how large they are, and what they take.
--
--   ambit run scripts/bench/forever.lua [arm|robot|upright|orbit ...]
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

local function tanh(x)
  local e = math.exp(-2 * math.abs(x))
  return (x < 0 and -1 or 1) * (1 - e) / (1 + e)
end

-- Does the pendulum of this mass come to rest from here? By Runge and Kutta's steps, in floats.
local function rests(x, v, mass)
  local h = 0.04
  local function rate(a, b) return b, 9.81 * math.sin(a) - 8 / mass * tanh((20 * a + 6 * b) / 8) end
  for _ = 1, 1000 do
    local a1, b1 = rate(x, v)
    local a2, b2 = rate(x + h / 2 * a1, v + h / 2 * b1)
    local a3, b3 = rate(x + h / 2 * a2, v + h / 2 * b2)
    local a4, b4 = rate(x + h * a3, v + h * b3)
    x, v = x + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4), v + h / 6 * (b1 + 2 * b2 + 2 * b3 + b4)
  end
  return math.abs(x) < 1e-3 and math.abs(v) < 1e-3
end

local GRID = 40 -- starts in each direction

-- A pendulum upside down, mass 1 kg +- 10 %, held by a torque of 8 N m at most.
local function upright()
  local mass = ambit.around(1, "10%", "mass")
  local system = ambit.ode { states = { "x", "v" }, equations = function(s)
    return { x = s.v, v = "9.81" * ambit.sin(s.x) - 8 / mass * ambit.tanh((20 * s.x + 6 * s.v) / 8) }
  end }
  local region = ambit.attraction { system, about = { x = 0 }, within = { x = { -1, 1 }, v = { -2, 2 } },
    split = { [mass] = 4 }, budget = 1200 }
  local sampled, proved, outside = 0, 0, 0
  for i = 1, GRID do
    for j = 1, GRID do
      local x, v = 2 * (i - 0.5) / GRID - 1, 4 * (j - 0.5) / GRID - 2
      local rested, inside = rests(x, v, 0.9) and rests(x, v, 1) and rests(x, v, 1.1), region:contains { x = x, v = v }
      if rested then sampled = sampled + 1 end
      if rested and inside then proved = proved + 1 end
      if inside and not rested then outside = outside + 1 end
    end
  end
  return region, ("%s of the %d starts of a grid that come to rest for three masses; %d others"):format(
    ("%.0f %%"):format(100 * proved / sampled), sampled, outside), "90 %, 0 others",
    proved >= 0.9 * sampled and outside == 0
end

-- Van der Pol's orbit, and all of a start set about it.
local function orbit()
  local system = ambit.ode { states = { "x", "y" }, equations = function(s)
    return { x = s.y, y = (1 - s.x ^ 2) * s.y - s.x }
  end }
  local map = ambit.poincare { system, section = function(s) return s.y end, direction = "falling", t_max = 8,
    initial = { x = ambit.around("2.0086", "0.02"), y = 0 } }
  local found = map:orbit()
  local attracting = found.proved and found.attracting -- the longer run is now in the map's time
  return map, attracting and ("proved for x = 2.0086 +- 0.02 on the section, multiplier in [%.2g, %.2g]"):format(
    found.derivative.x.x.lo, found.derivative.x.x.hi) or tostring(found.reason), "proved", attracting
end

print "| problem | result | asked for | CPU time |"
print "|---|---|---|---|"
for _, case in ipairs {
  { "arm", "two-link arm under PD, 6 data of 5 %: within 5 degrees for ever", arm },
  { "upright", "pendulum upside down, mass +-10 %: proved region of attraction", upright },
  { "orbit", "Van der Pol's orbit attracts, mu = 1", orbit },
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
