-- A planar drone flies 2 m to the side and 1 m up under a cascade of PD controllers. Mass and inertia +-2 %, thrust
-- constant +-5 %, arms +-0.1 mm.
local ambit = require "ambit"
local around, sin, cos = ambit.around, ambit.sin, ambit.cos

local mass, inertia = around("0.8", "2%", "mass"), around("0.006", "2%", "inertia")
local lift, arm = around(1, "5%", "thrust"), around("0.18", "0.1 mm", "arm")

local drone = ambit.ode { "drone", states = { "x", "y", "angle", "vx", "vy", "rate" }, check_units = false,
  equations = function(s, _, t)
    local goal = 1 - ambit.exp(-t ^ 2)
    local tilt = "0.25" * (s.x - 2 * goal) + "0.3" * s.vx                     -- wanted angle, positive to the left
    local up = "0.8" * ("9.81" + 6 * (goal - s.y) - 4 * s.vy)
    local turn = 4 * (tilt - s.angle) - "0.5" * s.rate
    local thrust, torque = lift * up, lift * arm * turn
    return { x = s.vx, y = s.vy, angle = s.rate, vx = -thrust * sin(s.angle) / mass,
      vy = thrust * cos(s.angle) / mass - "9.81", rate = torque / inertia }
  end }

local run = ambit.simulate { drone, initial = { x = 0, y = 0, angle = 0, vx = 0, vy = 0, rate = 0 },
  t = { 0, 1, 2, 3, 4 } }
print(run)
