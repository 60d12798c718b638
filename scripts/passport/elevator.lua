-- A lift rides up by 20 m: a winch on a rope that gets shorter, and so stiffer, an isolated cabin. Masses +-2 %, rope
-- and rubber +-5 %.
local ambit = require "ambit"
local around, t = ambit.around, ambit.time

local frame, cabin = around(600, "2%", "frame"), around(900, "2%", "cabin")
local rope, loss = around("2.4e7", "5%", "rope, N"), around(4000, "5%", "rope damping")
local rubber, damper = around("8e5", "5%", "rubber"), around(6000, "5%", "rubber damping")

local T = 12
local lift = ambit.ode { "lift", states = { u = "m", v = "m/s", z = "m", w = "m/s" }, check_units = false,
  equations = function(x, _, time)
    local phase = 2 * ambit.pi * time / T
    local winch = 20 * (time / T - ambit.sin(phase) / (2 * ambit.pi))       -- m of rope taken in
    local speed = 20 / ambit.number(T) * (1 - ambit.cos(phase))
    local pull = rope / (30 - winch) * (winch - x.u) + loss * (speed - x.v)
    local mount = rubber * (x.u - x.z) + damper * (x.v - x.w)
    return { u = x.v, v = (pull - mount) / frame - "9.81", z = x.w, w = mount / cabin - "9.81" }
  end }

local run = ambit.simulate { lift, initial = { u = "-0.018", v = 0, z = "-0.029", w = 0 }, t = { 0, 3, 6, 9, 12 } }
print(run)
