-- chain/tyre.lua -- m:tyre { at = hub, load = Fz, friction = mu, stiffness = ca, shape = c, drive = Fx }: the force of
-- the road on a wheel's hub, in the hub's own axes: x along the wheel, y to its left.
--
--   Fx as given,  Fy = -mu Fz sin(c atan(ca / (c mu Fz) vy / |vx|))
-- This is Pacejka's formula without curvature (Tyre and Vehicle Dynamics, 4.3): -ca times the slip angle where that is
-- small, at most mu Fz. |vx| is sqrt(vx^2 + v0^2) with v0 = `creep`, so that the law is smooth at rest and backwards.
local actuator = require "ambit.actuator"
local chain = require "ambit.chain"
local core = require "ambit.core"

local function build(m, p)
  local grip, drive = p.friction * p.load, nil
  local lateral
  m:applied_force { at = p.at, name = "road", axes = "body", force = function(_, v, t)
    local slip = v[2] / core.sqrt(core.sqr(v[1]) + core.sqr(p.creep))
    lateral = -grip * core.sin(p.shape * core.atan(p.stiffness / (p.shape * grip) * slip))
    drive = actuator.command(p.drive, "N", "tyre: drive", v, t)
    return { drive, lateral, 0 }
  end }
  return { lateral = lateral, drive = drive }
end

return chain.new({
  "tyre",
  doc = [[
A wheel's force on its hub, in the hub's axes (x along the wheel): a given drive, and sideways Pacejka's formula without
curvature. Hands out the expressions lateral and drive.]],
  ports = { at = { "frame", "the hub, turned with the steering" } },
  parameters = {
    load = { "N", nil, "on the road" },
    friction = { "1", "1", "the largest lateral force by the load" },
    stiffness = { "N/rad", nil, "lateral force per slip angle where that is small" },
    shape = { "1", "1.3", "how far the force falls behind its largest value: from 1, not at all, to 2" },
    creep = { "m/s", "0.1", "speed along the wheel below which slip is measured by this" },
    drive = { "N", "0", "along the wheel: a number, an expression or a function(velocity, t)", shape = "any" },
  },
  build = build,
}, true)
