-- slider_crank_loop.lua: a slider-crank as a loop: crank and rod form one chain, the pin of the piston is a point on a
-- line. The loop is closed by a constraint instead of a formula; compare slider_crank.lua.
local ambit = require "ambit"

local m = ambit.mechanism { "slider-crank", gravity = { 0, "-9.81", 0 } }

local function bar(name, from, length, mass)
  local at = m:revolute { from = from, axis = "z", name = name }
  local third = ambit.number(mass, "kg") * ambit.number(length, "m") ^ 2 / 12
  m:rigid_body { at = at, mass = mass, centre = { ambit.number(length, "m") / 2, 0, 0 },
    inertia = { 0, 0, 0, 0, third, 0, 0, 0, third } }
  return m:rigid_link { from = at, offset = { length, 0, 0 } }
end

local pin = bar("rod", bar("crank", m.world, "0.1", 1), "0.3", 2)
m:point_mass { at = pin, mass = "0.5" }
m:point_on_line { a = m.world, b = pin, axis = "x", name = "guide" }
m:independent { "crank" }

-- For every crank angle there is one rod angle, and the crank moves the rod: proved over the whole turn at once.
print("rank over a turn: " .. m:rank { box = { crank = { 0, "6.3" }, rod = { "-6.8", "0.5" } } }.status)

local angle = ambit.number "0.5"
local start = { crank = angle, rod = -angle - ambit.asin(ambit.sin(angle) / 3), ["crank'"] = 10 }
local run = ambit.simulate { m:dynamics(), initial = start, t = { 0, "0.2", "0.4", "0.6" } }

local wanted = { pin = m:position(pin).x, side = m:multipliers()["guide.1"] }
local columns = "%-5s  %-38s  %-40s  %s"
print(columns:format("t, s", "crank, rad", "pin, m", "force of the guide, N"))
for _, t in ipairs { 0.2, 0.4, 0.6 } do
  if t <= run.t_reached then
    local x = run:at(t)
    local now = ambit.evaluate { wanted, at = x }
    print(columns:format(t, x.crank, now.pin, now.side))
  end
end
print(run)
