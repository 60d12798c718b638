-- n_link_chain.lua [N] -- a chain of N links falls from rest: how fast do the equations grow, and what can be proved?
--
-- `segment` is an element written in Lua: a hinge, a rod and a bob. Coordinates are called after where they are
-- (segment1.hinge, segment2.hinge, ...). The articulated-body form keeps building and evaluating linear in N: try 300.
-- With few links the fall is enclosed for every length in the tolerance; one length, used N times, is one unknown.
local ambit = require "ambit"
local N = tonumber(arg and arg[1]) or 4

ambit.chain { "segment", doc = "A hinge, a rod without mass, and a bob at its end.",
  ports = { from = "frame" },
  parameters = { length = { "m", "0.25", "of the rod" }, mass = { "kg", "0.1", "of the bob" } },
  build = function(m, p)
    local hinge, joint = m:revolute { from = p.from, axis = "z", name = "hinge" }
    local tip = m:rigid_link { from = hinge, offset = { p.length, 0, 0 } }
    m:point_mass { at = tip, mass = p.mass }
    return { to = tip, joint = joint }
  end,
}

local m = ambit.mechanism { "chain", gravity = { 0, "-9.81", 0 } }
local length, at, rest, untouched = ambit.around("0.25", "0.1%"), m.world, {}, {}
for i = 1, N do
  at = m:segment { from = at, length = length }
  local hinge = ("segment%d.hinge"):format(i)
  rest[hinge], rest[hinge .. "'"] = 0, 0
  untouched[hinge], untouched[hinge .. "'"], untouched["tau_" .. hinge] = 0, 0, 0
end

local start = os.clock()
local fall = ambit.evaluate { m:forward_dynamics { form = "articulated" }, at = untouched, arithmetic = "real" }
print(("%d links: built and evaluated in %.3f s"):format(N, os.clock() - start))
for i = 1, math.min(N, 2) do print(("hinge %d starts to turn with %.6g rad/s^2"):format(i, fall[i]:mid())) end

if N <= 4 then
  local run = ambit.simulate { m:dynamics(), initial = rest, t = { 0, "0.1" }, solver = "lohner" }
  local bent = {}
  for name, x in pairs(run.x) do if not name:find "'" then bent[name] = x end end
  print(("the tip at t = %s s, m: %s"):format(run.t_reached, tostring(ambit.evaluate { m:position(at), at = bent })))
  print(run)
end
