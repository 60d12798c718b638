-- A five-bar parallel robot: two motors on the base, arms that meet in the tool. Both motors turn under PD control.
-- Masses +-2 %, links +-0.1 mm, damping +-5 %.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local m = ambit.mechanism { "five-bar", gravity = { 0, 0, "-9.81" } }
local function branch(name, x, length, fore)
  local base = m:rigid_link { from = m.world, offset = { x, 0, 0 } }
  local upper, motor = m:revolute { from = base, axis = "z", name = name }
  local elbow = m:rigid_link { from = upper, offset = { length, 0, 0 } }
  m:point_mass { at = elbow, mass = around("0.4", "2%", name .. " elbow") }
  local lower = m:revolute { from = elbow, axis = "z", name = name .. " elbow" }
  return m:rigid_link { from = lower, offset = { fore, 0, 0 } }, motor
end
local function length(value, name) return around(value, "0.1 mm", name) end
local one, left = branch("left", "-0.1", length("0.2", "upper left"), length("0.3", "lower left"))
local two, right = branch("right", "0.1", length("0.2", "upper right"), length("0.3", "lower right"))
m:point_mass { at = one, mass = around("0.5", "2%", "tool") }
m:close_pin { a = one, b = two, name = "tool" }

local start = m:assemble { left = 2, right = "1.1",
  guess = { ["left elbow"] = "-0.9", ["right elbow"] = "0.95" }, within = "0.3" }
m:independent { "left", "right" }
local initial = start.configuration
initial["left'"], initial["right'"] = 0, 0

local s = (1 - ambit.cos(ambit.pi * t / "0.5")) / 2
local function servo(joint, goal)
  local d = around(8, "5%", "damping")
  m:joint_torque { joint = joint, torque = function(q, w) return 80 * (goal - q) - d * w end }
end
servo(left, 2 + "0.3" * s)
servo(right, "1.1" + "0.2" * s)

local run = ambit.simulate { m:dynamics(), initial = initial, t = { 0, "0.125", "0.25", "0.375", "0.5" } }
print(run)
