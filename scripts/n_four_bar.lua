-- n_four_bar.lua: N + 1 equal rods side by side, joined on top by N rods of the same length: N loops, one freedom
-- (library of multibody benchmarks of IFToMM, problem A02). When all rods lie flat the position is singular: the loops
-- may go on as parallelograms or fold. Ambit says so instead of crossing blindly.
--   ambit run n_four_bar.lua 10
local ambit = require "ambit"
local pi = ambit.pi
local loops = tonumber(arg and arg[1]) or 2

-- As loops that are closed by constraints, or with the parallelogram written down: then theta moves every rod, and the
-- closing conditions vanish identically.
local function build(parallelogram)
  local m = ambit.mechanism { "N-four-bar", gravity = { 0, "-9.81", 0 } }
  local function rod(name, from, angle)
    local at = m:revolute { from = from, axis = "z", name = name, angle = angle }
    m:rigid_body { at = at, mass = 1, centre = { 0.5, 0, 0 }, inertia = { 0, 0, 0, 0, "1/12", 0, 0, 0, "1/12" } }
    return m:rigid_link { from = at, offset = { 1, 0, 0 } }
  end
  local top = rod("theta", m.world)
  local theta = parallelogram and m:coordinates().theta or nil
  for k = 1, loops do
    local over = rod("coupler" .. k, top, theta and -theta)
    top = rod("rod" .. k, m:rigid_link { from = m.world, offset = { k, 0, 0 } }, theta)
    m:close_point { a = top, b = over, name = "loop" .. k }
  end
  return m
end

-- Every joint's angle and the speed at the start, if the first rod stands at that angle and turns with that speed.
local function start(m, angle, speed)
  local at = { theta = angle, ["theta'"] = speed }
  for k = 1, loops do at["coupler" .. k], at["rod" .. k] = -angle, angle end
  m:reference { theta = angle, coupler1 = -angle, rod1 = angle }
  m:independent { "theta" }
  return at
end

local function gap(m, x)
  local worst = 0
  local at = setmetatable({}, { __index = x })
  for _, name in ipairs(m:coordinate_names()) do at[name] = x[name] end
  for _, g in pairs(ambit.evaluate { m:constraints(), at = at }) do worst = math.max(worst, g:mag()) end
  return worst
end

local function show(what, m, run, times)
  print(what)
  for _, t in ipairs(times) do
    if tonumber(t) <= run.t_reached then
      local x = run:at(t)
      print(("  t = %-4s  theta = %-42s  gap of the loops up to %.2g m"):format(t, x.theta, gap(m, x)))
    end
  end
  print("  " .. tostring(run))
end

local swing = build(false) -- hanging, pushed: away from the flat position
local run = ambit.simulate { swing, initial = start(swing, -pi / 2, 1), t = { 0, "0.5", 1 } }
show("hanging rods that swing", swing, run, { "0.5", "1" })

local fall = build(false) -- upright, pushed over: flat at t = 0.71 s
run = ambit.simulate { fall, initial = start(fall, pi / 2, -1), t = { 0, "0.3", "0.6", "0.69" } }
show("upright rods that fall", fall, run, { "0.3", "0.6", "0.69" })
local flat = {}
for _, name in ipairs(fall:coordinate_names()) do flat[name] = 0 end
print("  flat: " .. fall:rank { box = flat }.status)

local chain = build(true)
run = ambit.simulate { chain, initial = { theta = pi / 2, ["theta'"] = -1 }, t = { 0, "0.3", "0.6", "1" } }
show("upright rods that fall as parallelograms", chain, run, { "0.3", "0.6", "1" })
