-- chain/lqr.lua -- m:lqr { joints = { a, b }, goal = { q = 1 }, weights = { q = 10, ["q'"] = 1 }, effort = 1 }: a
-- linear-quadratic regulator about a state of rest, with the drives of some joints or all.
--
--   effort = effort at rest - K (x - goal),  K minimising the integral of sum weight_i (x_i - goal_i)^2 + sum r_k u_k^2
-- for the equations linearised at the goal, with all uncertain data at their middles: the nominal model that a designer
-- has. The gains are doubles (riccati.lua), and a run encloses what they do to every machine within the tolerances.
local actuator = require "ambit.actuator"
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"
local riccati = require "ambit.riccati"

local AT_REST = 1e-9 -- acceleration at the goal by that of gravity or 1

-- The speeds and coordinates in the same order; every coordinate is one that a speed is the rate of.
local function states_of(m)
  local coordinates, speeds = core.coordinates(m.handle), core.speeds(m.handle)
  if #core.own_states(m.handle) > 0 then check.fail "lqr: expected a mechanism without states of its own" end
  for i, c in ipairs(coordinates) do
    if not speeds[i] or speeds[i].name ~= c.name .. "'" then
      check.fail("lqr: expected joints of one degree of freedom without loops, got `%s`", c.name)
    end
  end
  return coordinates, speeds
end

local function numbers(t, known, default, what)
  local list = {}
  if t == nil then t = {} end
  if type(t) == "table" then check.keys(t, known, what) end
  for i, name in ipairs(known) do
    local value = type(t) == "table" and t[name] or t
    if value == nil or type(value) == "table" then value = default end
    list[i] = core.evaluate({ expressions = { core.expression(value, nil, what) } })[1]:mid()
  end
  return list
end

-- Values of expressions at the goal, all data at their middles.
local function at_goal(list, point)
  local values = core.evaluate { expressions = list, leaves = point.leaves, values = point.values }
  for i, x in ipairs(values) do values[i] = x:mid() end
  return values
end

local function joint_names(m, joints)
  local names = {}
  if type(joints) ~= "table" or (not frame.is(joints) and #joints == 0) then
    check.fail("lqr: joints: expected a joint or a list of joints, got %s", check.kind(joints))
  end
  for k, joint in ipairs(frame.is(joints) and { joints } or joints) do
    names[k] = core.part_name(m.handle, (frame.place(m, joint, "joint", "lqr: joints")))
  end
  return names
end

-- The goal as values of all leaves of the equations: coordinates given, speeds 0, drives by name.
local function point_of(m, p, coordinates, speeds, forward, holding)
  local names, point = {}, { leaves = {}, values = {} }
  for i, c in ipairs(coordinates) do names[i] = c.name end
  local goal = numbers(p.goal, names, 0, "lqr: goal")
  for i, c in ipairs(coordinates) do
    table.move({ c.q, speeds[i].u }, 1, 2, 2 * i - 1, point.leaves)
    table.move({ core.expression(goal[i]), core.expression(0) }, 1, 2, 2 * i - 1, point.values)
  end
  local drives = {}
  for _, leaf in ipairs(core.leaves(forward)) do
    local name = leaf.kind == "symbol" and leaf.name:match "^tau_(.*)$"
    if name then
      drives[name], point.leaves[#point.leaves + 1] = leaf.expression, leaf.expression
      point.values[#point.values + 1] = core.expression(holding[name] or 0)
    end
  end
  return point, goal, drives
end

-- What the drives have to hold at the goal: there it must be at rest without the others.
local function holding_at(m, joints, coordinates, speeds, p)
  local driven, holding = {}, {}
  for _, name in ipairs(joints) do driven[name] = true end
  local inverse = core.inverse(m.handle)
  local point = point_of(m, p, coordinates, speeds, {}, {})
  for _, s in ipairs(speeds) do
    point.leaves[#point.leaves + 1], point.values[#point.values + 1] = s.du, core.expression(0)
  end
  local values, size = at_goal(inverse, point), 1
  for _, x in ipairs(values) do size = math.max(size, math.abs(x)) end
  for i, c in ipairs(coordinates) do
    if driven[c.name] then
      holding[c.name] = values[i]
    elseif math.abs(values[i]) > AT_REST * size then
      check.fail("lqr: goal: no state of rest: joint `%s`, which is not driven, would have to hold %.3g", c.name,
        values[i])
    end
  end
  return holding
end

-- A and B of x' = A x + B u, x all coordinates, then all speeds.
local function linearised(coordinates, speeds, forward, joints, drives, point)
  local n, A, B, list = #coordinates, {}, {}, {}
  local function row(e)
    for _, c in ipairs(coordinates) do list[#list + 1] = core.derivative(e, c.q) end
    for _, s in ipairs(speeds) do list[#list + 1] = core.derivative(e, s.u) end
    for _, name in ipairs(joints) do list[#list + 1] = core.derivative(e, drives[name]) end
  end
  for i = 1, n do
    A[i], B[i] = {}, {}
    for j = 1, 2 * n do A[i][j] = j == n + i and 1 or 0 end
    for k in ipairs(joints) do B[i][k] = 0 end
    row(forward[i])
  end
  local values = at_goal(list, point)
  for i = 1, n do
    local from = (i - 1) * (2 * n + #joints)
    A[n + i] = table.move(values, from + 1, from + 2 * n, 1, {})
    B[n + i] = table.move(values, from + 2 * n + 1, from + 2 * n + #joints, 1, {})
  end
  return A, B
end

local function build(m, p)
  local coordinates, speeds = states_of(m)
  local joints, known = joint_names(m, p.joints), {}
  for i, c in ipairs(coordinates) do known[i], known[#coordinates + i] = c.name, speeds[i].name end
  local holding, forward = holding_at(m, joints, coordinates, speeds, p), core.forward(m.handle, nil)
  local point, goal, drives = point_of(m, p, coordinates, speeds, forward, holding)
  for _, name in ipairs(joints) do
    if not drives[name] then check.fail("lqr: joints: `%s` moves nothing", name) end
  end
  local A, B = linearised(coordinates, speeds, forward, joints, drives, point)
  local K = riccati.gains(A, B, numbers(p.weights, known, 0, "lqr: weights"),
    numbers(p.effort, joints, 1, "lqr: effort"))
  if not K then check.fail "lqr: no gains were found: is every motion that has no weight stable or driven?" end
  local outs = { gains = K, efforts = {} }
  for k, joint in ipairs(frame.is(p.joints) and { p.joints } or p.joints) do
    local _, _, unit = actuator.motion(m, joint, "lqr: joints")
    local u = core.expression(holding[joints[k]])
    for i, c in ipairs(coordinates) do
      u = u - K[k][i] * (c.q - goal[i]) - K[k][#coordinates + i] * speeds[i].u
    end
    m:joint_torque { joint = joint, name = "drive" .. k, [unit == "rad" and "torque" or "force"] = u }
    outs.efforts[joints[k]] = u
  end
  return outs
end

return chain.new({
  "lqr",
  doc = [[
A linear-quadratic regulator about a state of rest of the mechanism as it is so far (springs, dampers and drives that
come later are not known to it). Hands out efforts, expressions by joint, and gains, one row for each joint: all
coordinates, then all speeds.]],
  ports = {},
  parameters = {
    joints = { "1", nil, "those that it drives: a joint or a list", shape = "any" },
    goal = { "1", nil, "coordinates at rest by name, in rad and m; 0 unless given", shape = "any", optional = true },
    weights = { "1", nil, "of squares of coordinates and speeds by name; 0 unless given", shape = "any" },
    effort = { "1", nil, "of squares of torques and forces: a number, or by joint; 1 unless given", shape = "any",
      optional = true },
  },
  build = build,
}, true)
