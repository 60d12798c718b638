-- chain/dc_motor.lua -- m:dc_motor { joint = j, voltage = u, ... }: a motor with permanent magnets that turns a joint
-- by a gear.
--
--   L i' = u - R i - K n q',   torque n K i on the joint,   inertia n^2 J of the rotor
-- K the torque per current, which is the voltage per angular velocity as well (in SI units), n the ratio of the gear.
local actuator = require "ambit.actuator"
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"

local function build(m, p)
  local q, v, unit = actuator.motion(m, p.joint, "dc_motor: joint")
  if unit ~= "rad" then check.fail "dc_motor: joint: expected a joint that turns, got one that slides" end
  local gain = core.in_unit(p.ratio * p.constant, "N m/A")
  local voltage = actuator.command(p.voltage, "V", "dc_motor: voltage", q, v, core.time())
  local i = m:state { "current", unit = "A", rate = function(_, i)
    return (voltage - p.resistance * i - gain * v) / p.inductance
  end }
  m:joint_torque { joint = p.joint, name = "drive", torque = gain * i }
  m:armature { joint = p.joint, inertia = core.sqr(p.ratio) * p.rotor, name = "rotor" }
  return { current = i, voltage = voltage, torque = gain * i }
end

return chain.new({
  "dc_motor",
  doc = [[
A motor with permanent magnets and a gear: its current, NAME.current, is a state. Hands out the expressions current (A),
voltage (V) and torque (N m at the joint).]],
  ports = { joint = { "joint", "that it turns" } },
  parameters = {
    voltage = { "V", nil, "a number, an expression or a function(q, v, t) of the joint's angle, its rate and time",
      shape = "any" },
    constant = { "N m/A", nil, "torque per current, before the gear; also the voltage per angular velocity" },
    resistance = { "ohm", nil, "of the winding" },
    inductance = { "H", nil, "of the winding" },
    ratio = { "1", "1", "turns of the motor for one of the joint" },
    rotor = { "kg m^2", "0", "moment of inertia of the rotor" },
  },
  build = build,
}, true)
