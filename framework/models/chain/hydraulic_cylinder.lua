-- chain/hydraulic_cylinder.lua -- m:hydraulic_cylinder { joint = j, area = A, head_flow = Q, ... }: a double-acting
-- cylinder that pushes a joint which slides; its two pressures are states.
--
--   (V + A x) p1' = B (Q1 - A x'),   (W + a (s - x)) p2' = B (Q2 + a x'),   force A p1 - a p2
-- x the displacement from the start of the stroke s, V and W dead volumes, B the bulk modulus (Merritt, Hydraulic
-- Control Systems, 6-1). Flows are into the chambers.
local actuator = require "ambit.actuator"
local chain = require "ambit.chain"
local check = require "ambit.check"
local core = require "ambit.core"

local function build(m, p)
  local q, v, unit = actuator.motion(m, p.joint, "hydraulic_cylinder: joint")
  if unit ~= "m" then check.fail "hydraulic_cylinder: joint: expected a joint that slides, got one that turns" end
  local x, t = q - p.start, core.time()
  local flow = { head = p.head_flow, rod = p.rod_flow }
  local pressure = {}
  local function chamber(name, volume, displaced)
    return m:state { name, unit = "Pa", rate = function(_, own)
      local what = ("hydraulic_cylinder: %s_flow"):format(name)
      local into = actuator.command(flow[name], "m^3/s", what, own, q, t)
      return p.bulk * (into - displaced * v) / volume
    end }
  end
  pressure.head = chamber("head", p.dead_volume + p.area * x, p.area)
  pressure.rod = chamber("rod", p.dead_volume + p.rod_area * (p.stroke - x), -p.rod_area)
  local force = p.area * pressure.head - p.rod_area * pressure.rod
  m:joint_torque { joint = p.joint, force = force, name = "piston" }
  return { head = pressure.head, rod = pressure.rod, force = force }
end

return chain.new({
  "hydraulic_cylinder",
  doc = [[
A double-acting cylinder on a joint that slides: the pressures NAME.head and NAME.rod are states. Hands out the
expressions head, rod (Pa) and force (N).]],
  ports = { joint = { "joint", "a joint that slides; the cylinder pushes it along its coordinate" } },
  parameters = {
    area = { "m^2", nil, "of the piston on the head's side" },
    rod_area = { "m^2", nil, "of the piston on the rod's side" },
    stroke = { "m", nil, "length of the stroke" },
    start = { "m", "0", "coordinate of the joint where the piston is at the head's end" },
    dead_volume = { "m^3", nil, "of each chamber and its line where the piston is at its end" },
    bulk = { "Pa", "1.4e9", "bulk modulus of the oil with its lines" },
    head_flow = { "m^3/s", nil, "into the chamber at the head: a number, an expression or a function(p, x, t)",
      shape = "any" },
    rod_flow = { "m^3/s", nil, "into the chamber at the rod, likewise", shape = "any" },
  },
  build = build,
}, true)
