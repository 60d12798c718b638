-- reduce_arm.lua -- which parts of an arm matter? A mass, a bearing that brakes, a gearbox that gives: each is left
-- out, or made rigid, if the hand provably stays within 0.5 mm of where it would be, for every tool of 1 kg within 1 %
-- and every start within its tolerance.
local ambit = require "ambit"
local around = ambit.around

local m = ambit.mechanism { "arm", gravity = { 0, "-9.81", 0 } }
local upper, shoulder = m:revolute { from = m.world, axis = "z", name = "shoulder" }
local middle = m:rigid_link { from = upper, offset = { "0.5", 0, 0 } }
local fore, elbow = m:revolute { from = middle, axis = "z", name = "elbow" }
local hand = m:rigid_link { from = fore, offset = { "0.4", 0, 0 }, name = "hand" }
m:point_mass { at = middle, mass = 2, name = "motor" }
m:point_mass { at = hand, mass = around(1, "1%"), name = "tool" }
m:point_mass { at = hand, mass = "0.001", name = "sensor" }
m:joint_spring { joint = elbow, stiffness = 600, name = "gearbox" }
m:joint_damper { joint = elbow, damping = 8, name = "loss" }
m:joint_damper { joint = shoulder, damping = "0.01", name = "bearing" }

local small = ambit.reduce {
  m, t = { 0, "0.3" },
  initial = { shoulder = around("-1.2", "0.01"), elbow = 0, ["shoulder'"] = 0, ["elbow'"] = 0 },
  outputs = { tip = function(_, _, _, at) return at:position(hand).y end }, error = { tip = "0.5 mm" },
  elements = true, reductions = {},
}

print "part      what                        status   hand off by, mm"
for _, row in ipairs(small.terms) do
  local effect = row.effect and row.effect.tip
  print(("%-9s %-27s %-8s %s"):format(row.equation, row.text, row.status,
    effect and ("%.3f"):format(1000 * effect) or "not proved"))
end
print(("\n%d of %d states are left; the hand is proved to be off by less than %.3f mm"):format(
  small.equations_after, small.equations_before, 1000 * small.error.tip))
