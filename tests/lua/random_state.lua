-- random_state.lua -- states of Ambit and coordinates of the oracle, where a ball joint is a quaternion here and three
-- angles there. For random_mechanism.lua.
local state = {}

-- A ball joint's unit quaternion and angular velocity in the moving axes, from the angles a, b, c about z, y, x and
-- their rates. f: sin and cos, of numbers or of expressions
local function quaternion(f, a, b, c, da, db, dc)
  local ca, cb, cc, sa, sb, sc = f.cos(a / 2), f.cos(b / 2), f.cos(c / 2), f.sin(a / 2), f.sin(b / 2), f.sin(c / 2)
  return { ca * cb * cc + sa * sb * sc, ca * cb * sc - sa * sb * cc, ca * sb * cc + sa * cb * sc,
    sa * cb * cc - ca * sb * sc }, { dc - da * f.sin(b), db * f.cos(c) + da * f.sin(c) * f.cos(b),
    da * f.cos(c) * f.cos(b) - db * f.sin(c) }
end

-- Calls put(name of a state of Ambit, value) for the joint that starts with body i; x(i), v(i): coordinates of the
-- oracle and their rates.
function state.each(plan, i, f, x, v, put)
  local b = plan.bodies[i]
  local slides = b.compound == "free_quaternion" and 3 or b.compound == "spherical_quaternion" and 0
  if not slides then
    for k = i, i + (b.count or 1) - 1 do
      local c, tied = plan.bodies[k], plan.tied[k]
      if not tied or tied == "gear" then put(c.state, x(k)) end
      if not tied and not (plan.dependent and plan.dependent[k]) then put(c.state .. "'", v(k)) end
    end
    return
  end
  local at = i + slides
  local q, w = quaternion(f, x(at), x(at + 1), x(at + 2), v(at), v(at + 1), v(at + 2))
  for k = 1, 4 do put(("%s.%d"):format(b.name, k), q[k]) end
  for k = 1, 3 do put(("%s'.%d"):format(b.name, k), w[k]) end
  for k = 1, slides do
    put(("%s.%d"):format(b.name, 4 + k), x(i + k - 1))
    put(("%s'.%d"):format(b.name, 3 + k), v(i + k - 1))
  end
end

-- Numbers of the bodies with which joints start.
function state.joints(plan)
  local list, i = {}, 1
  while i <= #plan.bodies do
    list[#list + 1] = i
    i = i + (plan.bodies[i].count or 1)
  end
  return list
end

-- Values of Ambit's states by name, from what the oracle found: { q..., v... }.
function state.of(plan, found)
  local n, states = #plan.bodies, {}
  for _, i in ipairs(state.joints(plan)) do
    state.each(plan, i, math, function(k) return found[k] end, function(k) return found[n + k] end,
      function(name, x) states[name] = x end)
  end
  return states
end

return state
