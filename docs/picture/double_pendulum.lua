-- double_pendulum.lua FILE: the picture in the README: what is proved of the angles, over each step, and some simulated
-- pendulums.
local ambit = require "ambit"
local axis = require "ambit.report.axis"
local svg = require "ambit.report.svg"
local around, pi = ambit.around, ambit.pi

local m = ambit.mechanism { "double pendulum", gravity = { 0, "-9.81", 0 } }
local elbow = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "beta1" }, offset = { 0, -1, 0 } }
local hand = m:rigid_link { from = m:revolute { from = elbow, axis = "z", name = "beta2" }, offset = { 0, -1, 0 } }
m:point_mass { at = elbow, mass = 1 }
m:point_mass { at = hand, mass = 1 }

local function start(first)
  return { beta1 = first, beta2 = -11 * pi / 20, ["beta1'"] = "0.43", ["beta2'"] = "0.67" }
end

local END, PARTS = 3, 120
local times = {}
for k = 0, PARTS do times[k + 1] = END * k / PARTS end

local run = ambit.simulate {
  m:dynamics(), initial = start(around(3 * pi / 4, "1%")), t = times, solver = "taylor_model", order = 12,
}
-- -- the frame

local WIDTH, HEIGHT = 860, 420
local frame = { left = 64, right = WIDTH - 18, top = 16, bottom = HEIGHT - 52 }
local x, y = axis.linear(0, END), axis.linear(-11, 3)
local function across(t) return axis.pixel(x, t, frame.left, frame.right) end
local function up(angle) return axis.pixel(y, angle, frame.bottom, frame.top) end

local canvas = svg.canvas(WIDTH, HEIGHT, "angles of a double pendulum: proved and simulated")
for _, v in ipairs(x.ticks) do
  canvas:rule(across(v), frame.top, across(v), frame.bottom, "grid")
  canvas:text(across(v), frame.bottom + 20, ("%g"):format(v), 60, { anchor = "middle" })
end
for _, v in ipairs(y.ticks) do
  canvas:rule(frame.left, up(v), frame.right, up(v), "grid")
  canvas:text(frame.left - 8, up(v) + 4, ("%g"):format(v), 60, { anchor = "end" })
end
canvas:rule(frame.left, frame.top, frame.left, frame.bottom, "axis")
canvas:rule(frame.left, frame.bottom, frame.right, frame.bottom, "axis")
canvas:text((frame.left + frame.right) / 2, HEIGHT - 12, "time, s", 200, { anchor = "middle" })
canvas:text(22, (frame.top + frame.bottom) / 2, "angle, rad", 200, { anchor = "middle", turned = true })

-- -- what is proved, and what is simulated

local angles = { { "beta1", svg.colours[1], "first angle, proved" },
  { "beta2", svg.colours[2], "second angle, proved" } }
for step in run:steps() do
  for _, angle in ipairs(angles) do
    local range = step.tube[angle[1]]
    canvas:box(across(step.t_from), up(range.lo), across(step.t), up(range.hi), angle[2])
  end
end

for i = -3, 3 do
  local first = 3 * math.pi / 4 * (1 + i / 300)
  local sample = ambit.simulate { m:dynamics(), initial = start(first), t = times, solver = "gsl" }
  for _, t in ipairs(times) do
    if t > 0 then
      for _, angle in ipairs(angles) do canvas:dot(across(t), up(sample:at(t)[angle[1]]:mid()), 0.7, "#7788aa") end
    end
  end
end

for i, angle in ipairs(angles) do
  canvas:box(frame.left + 14, HEIGHT - 132 + 20 * i, frame.left + 38, HEIGHT - 120 + 20 * i, angle[2])
  canvas:text(frame.left + 46, HEIGHT - 121 + 20 * i, angle[3], 300)
end
canvas:dot(frame.left + 26, HEIGHT - 66, 2, "#7788aa")
canvas:text(frame.left + 46, HEIGHT - 61, "simulated pendulums", 300)

local file = assert(io.open(arg[1], "w"))
file:write(canvas:finish())
file:close()
