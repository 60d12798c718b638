-- chain/pid.lua -- m:pid { joint = j, goal = w, proportional = kp, integral = ki, derivative = kd, limit = most }: a
-- controller that makes a joint follow.
--
--   torque = kp (w - q) + ki e + kd (w' - q'),  e' = w - q,  between -limit and limit
-- With a limit the integral stands still as the excess grows: e' = w - q - (wanted - given torque) / (ki tau), tau =
-- kp / ki, or else it would have to unwind first (back-calculation; Astrom & Hagglund, Advanced PID Control, 3.5).
-- Without a proportional part that would be 0, and `tracking` says tau.
local actuator = require "ambit.actuator"
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"

local function limited(torque, limit)
  if not limit then return torque end
  return core.max(-limit, core.min(limit, torque))
end

local function is_positive(e) return core.evaluate { expressions = { e } }[1].lo > 0 end

-- ki tau: what the excess is divided by, for the integral to stand still.
local function unwinding(p, kp, ki)
  if p.tracking ~= nil then
    local tau = core.in_unit(core.expression(p.tracking, "s", "pid: tracking"), "s")
    if not is_positive(tau) then check.fail("pid: tracking: expected a time above 0 s") end
    return ki * tau
  end
  if not is_positive(kp) then
    check.fail("pid: proportional may be 0: with `integral` and `limit`, `tracking` is needed, the time (s) in which \z
      the integral follows a torque that is held at its limit")
  end
  return kp
end

local function build(m, p)
  local q, v, unit = actuator.motion(m, p.joint, "pid: joint")
  local force = unit == "rad" and "N m" or "N"
  local function gain(name, of)
    return p[name] ~= nil and core.in_unit(core.expression(p[name], force .. "/" .. of, "pid: " .. name),
      force .. "/" .. of) or nil
  end
  local kp, kd = gain("proportional", unit), gain("derivative", unit == "rad" and "(rad/s)" or "(m/s)")
  local ki = gain("integral", ("(%s s)"):format(unit))
  local limit = p.limit ~= nil and core.in_unit(core.expression(p.limit, force, "pid: limit"), force) or nil
  local goal = actuator.command(p.goal, unit, "pid: goal", core.time())
  for _, leaf in ipairs(core.leaves { goal }) do
    if leaf.kind == "symbol" then check.fail("pid: goal: expected a function of time only, got `%s`", leaf.name) end
  end
  local off = goal - q
  local wanted = kp * off
  if kd then wanted = wanted + kd * (core.in_unit(core.derivative(goal, core.time()), unit .. "/s") - v) end
  local e
  if ki then
    local divisor = limit and unwinding(p, kp, ki)
    e = m:state { "integral", unit = unit .. " s", rate = function(_, own)
      local all = wanted + ki * own
      return limit and off - (all - limited(all, limit)) / divisor or off
    end }
    wanted = wanted + ki * e
  end
  local torque = limited(wanted, limit)
  m:joint_torque { joint = p.joint, [unit == "rad" and "torque" or "force"] = torque, name = "drive" }
  return { torque = torque, error = off, integral = e }
end

return chain.new({
  "pid",
  doc = [[
A controller that makes a joint follow a motion. With `integral` its error summed over time, NAME.integral, is a state.
Hands out the expressions torque, error and integral.]],
  ports = { joint = { "joint", "that it drives" } },
  parameters = {
    goal = { "1", nil, "the wanted coordinate: a number, an expression of time or a function(t)", shape = "any" },
    proportional = { "N m/rad", nil, "N m/rad, or N/m on a joint that slides", shape = "any" },
    integral = { "N m/(rad s)", nil, "N m/(rad s), or N/(m s)", shape = "any", optional = true },
    derivative = { "N m s/rad", nil, "N m s/rad, or N s/m", shape = "any", optional = true },
    tracking = { "s", nil, "time in which the integral follows a torque at its limit, else proportional / integral",
      shape = "any", optional = true },
    limit = { "N m", nil, "largest torque or force, with a kink where it is reached", shape = "any", optional = true },
  },
  build = build,
}, true)
