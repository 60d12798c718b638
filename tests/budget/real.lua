-- real.lua -- a simulation in plain doubles: no enclosing arithmetic has any business in the process.
local ambit = require "ambit"
local m = ambit.mechanism { "pendulum", gravity = { 0, "-9.81", 0 } }
local joint = m:revolute { from = m.world, axis = "z", name = "q" }
m:point_mass { at = m:rigid_link { from = joint, offset = { 0, -1, 0 } }, mass = 1 }
local run = ambit.simulate { m:dynamics(), initial = { q = 1, ["q'"] = 0 }, t = { 0, 2 }, solver = "gsl" }
print(run.x.q)
