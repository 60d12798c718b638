-- random_parts.lua -- what random mechanisms have besides links and springs: joints that follow others (mimic joints,
-- gears), joints with a given motion, friction, PD control, and bodies of which everything is known. For
-- random_mechanism.lua.
local ambit = require "ambit"

local parts = {}

-- A joint of one coordinate on a body with mass, whose motion no loop asks for.
local function is_single(plan, i)
  local b = plan.bodies[i]
  return b.mass > 0 and not b.compound and (b.count or 1) == 1 and b.state == b.name and
    not (plan.dependent and plan.dependent[i])
end

-- Earlier joints that i may follow: of the same kind, and no followers themselves.
local function leaders(plan, i)
  local list = {}
  for k = 1, i - 1 do
    if is_single(plan, k) and not plan.tied[k] and plan.bodies[k].slides == plan.bodies[i].slides then
      list[#list + 1] = k
    end
  end
  return list
end

local function tie(r, plan, i, kind)
  local list = kind == "given" and {} or leaders(plan, i)
  if kind ~= "given" and #list == 0 then return end
  if kind == "gear" and plan.bodies[i].slides then kind = "mimic" end
  local t = { follower = i, leader = 0, ratio = 0, swing = 0, tempo = 0, kind = kind, offset = plan.q[i] }
  if kind == "given" then
    t.swing, t.tempo = r.between(-0.5, 0.5), r.between(1, 6)
    plan.v[i] = t.swing * t.tempo
  else
    t.leader, t.ratio = r.one_of(list), r.between(0.3, 2) * r.one_of { 1, -1 }
    t.offset = plan.q[i] - t.ratio * plan.q[t.leader]
    plan.v[i] = t.ratio * plan.v[t.leader]
  end
  plan.ties[#plan.ties + 1], plan.tied[i] = t, kind
end

-- Does the coordinate of body i follow from no other?
function parts.is_free(plan, i) return not plan.tied[i] and not (plan.dependent and plan.dependent[i]) end

local function count_free(plan)
  local n = 0
  for i = 1, #plan.bodies do
    if parts.is_free(plan, i) then n = n + 1 end
  end
  return n
end

function parts.add(r, plan)
  plan.ties, plan.tied = {}, {}
  for i, b in ipairs(plan.bodies) do
    b.friction, b.creep, b.proportional, b.derivative, b.goal, b.swing, b.tempo = 0, 0, 0, 0, 0, 0, 0
    b.exact = r.chance(0.3)
    if is_single(plan, i) and count_free(plan) > 1 and r.chance(0.25) then
      tie(r, plan, i, i == 1 and "given" or r.one_of { "mimic", "gear", "given" })
    end
    local driven = is_single(plan, i) and (not plan.tied[i] or plan.tied[i] == "gear")
    if is_single(plan, i) and r.chance(0.25) then b.friction, b.creep = r.between(0.05, 1), r.between(0.05, 0.3) end
    if driven and r.chance(0.25) then
      b.proportional, b.derivative = r.between(5, 100), r.between(0.5, 10)
      b.goal, b.swing, b.tempo = r.between(-0.5, 0.5), r.between(-0.5, 0.5), r.between(1, 6)
    end
  end
  if #plan.ties > 0 then plan.name = plan.name .. (", %d tied"):format(#plan.ties) end
end

local function tie_of(plan, i)
  for _, t in ipairs(plan.ties) do if t.follower == i then return t end end
end

-- What makes the joint of body i one that follows, or one with a given motion: keys of the element.
function parts.motion(plan, i, value, joints)
  local t = tie_of(plan, i)
  if not t or t.kind == "gear" then return {} end
  if t.kind == "mimic" then
    return { mimic = { joint = joints[t.leader], multiplier = value(t, "ratio"), offset = value(t, "offset") } }
  end
  local motion = value(t, "offset") + value(t, "swing") * ambit.sin(value(t, "tempo") * ambit.time)
  return { [plan.bodies[i].slides and "displacement" or "angle"] = motion }
end

function parts.add_gears(m, plan, value, joints)
  for _, t in ipairs(plan.ties) do
    if t.kind == "gear" then
      m:gear { driver = joints[t.leader], driven = joints[t.follower], ratio = value(t, "ratio"),
        offset = value(t, "offset") }
    end
  end
end

-- Friction and control of a joint.
function parts.add_to_joint(m, b, value, joint)
  if b.friction ~= 0 then
    m:joint_friction { joint = joint, coulomb = value(b, "friction"), velocity = value(b, "creep") }
  end
  if b.proportional == 0 then return end
  local goal, swing, tempo = value(b, "goal"), value(b, "swing"), value(b, "tempo")
  m:pid { joint = joint, name = b.name .. "_control", proportional = value(b, "proportional"),
    derivative = value(b, "derivative"), goal = function(t) return goal + swing * ambit.sin(tempo * t) end }
end

-- Initial values: of the crank, if its motion is given, and of what gears drive.
function parts.angle_of_crank(plan, value, initial)
  local t = tie_of(plan, 1)
  return t and value(t, "offset") or initial.crank
end

function parts.start(plan, value, initial)
  for _, t in ipairs(plan.ties) do
    if t.kind == "gear" then
      local leader = initial[plan.bodies[t.leader].state]
      initial[plan.bodies[t.follower].state] = value(t, "ratio") * leader + value(t, "offset")
    end
  end
end

-- Says which coordinates are independent, where there are loops or gears. With a ball joint as a quaternion, of which
-- the speeds have no coordinates of their own, the choice is left to the mechanism.
function parts.choose_independent(m, plan)
  local closed, free, middle, named = #plan.loops > 0, {}, {}, true
  for i, b in ipairs(plan.bodies) do
    named = named and not (b.compound and b.compound:find "quaternion")
    local tied = plan.tied[i]
    closed = closed or tied == "gear"
    if parts.is_free(plan, i) then free[#free + 1] = b.state end
    if not tied or tied == "gear" then middle[b.state] = plan.q[i] end
  end
  if not closed then return end
  m:reference(middle)
  if named then m:independent(free) end
end

return parts
