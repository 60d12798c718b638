-- The oracle of random_mechanisms.lua against digits that others have computed: it is right about trees, too.
local multibody = require "multibody"

local function bar(parent, offset)
  return { parent = parent, axis = { 0, 0, 1 }, turn_axis = { 0, 0, 1 }, offset = offset, mass = 1,
    centre = { 0, -1, 0 } }
end

describe("the oracle of mechanisms", function()
  it("knows the double pendulum of the ValEncIA-IVP paper", function()
    local times, motion = { 0.1, 0.2, 0.5 }, nil
    motion = multibody.run { bodies = { bar(0, { 0, 0, 0 }), bar(1, { 0, -1, 0 }) }, gravity = { 0, -9.81, 0 },
      q = { 3 * math.pi / 4, -11 * math.pi / 20 }, v = { 0.43, 0.67 }, times = times, tolerance = 1e-18 }
    -- quadruple precision, Gragg-Bulirsch-Stoer, from 3 pi/4; doubles around the start and the times cost the rest
    local known = {
      { 2.3605206206822492638, -1.6571172660241730451, -0.33027832204171666032, 0.73176457106421326610 },
      { 2.2912247313906951392, -1.5801374976193939292, -1.0580225702145183939, 0.83530165694424799620 },
      { 1.5907483260442350924, -1.0012509592734642656, -3.8906086376761385861, 4.2683224500661727099 },
    }
    for k in ipairs(times) do
      for i = 1, 4 do assert.near(known[k][i], motion[k][i], 1e-14) end
    end
  end)

  -- The UR5 of scripts/robots: accelerations in 50 digits, which RBDL and Pinocchio confirm.
  it("knows the accelerations of a UR5", function()
    local function link(parent, offset, axis, turn, mass, z, x, izz)
      return { parent = parent, offset = offset, axis = axis, turn_axis = { 0, 1, 0 }, turn = turn, mass = mass,
        centre = { 0, 0, z }, inertia = { x, 0, 0, x, 0, izz } }
    end
    local right, y, z = 1.57079632679, { 0, 1, 0 }, { 0, 0, 1 }
    local bodies = {
      link(0, { 0, 0, 0.089159 }, z, 0, 3.7, 0, 0.010267495893, 0.00666),
      link(1, { 0, 0.13585, 0 }, y, right, 8.393, 0.28, 0.22689067591, 0.0151074),
      link(2, { 0, -0.1197, 0.425 }, y, 0, 2.275, 0.25, 0.049443313556, 0.004095),
      link(3, { 0, 0, 0.39225 }, y, right, 1.219, 0, 0.111172755531, 0.21942),
      link(4, { 0, 0.093, 0 }, z, 0, 1.219, 0, 0.111172755531, 0.21942),
      link(5, { 0, 0, 0.09465 }, y, 0, 0.1879, 0, 0.0171364731454, 0.033822),
    }
    local cases = {
      { q = { 0.1, -0.5, 0.9, 0.3, -0.7, 1.1 }, v = { 0.5, -0.3, 0.8, -0.2, 0.6, -0.4 },
        tau = { 1.5, -2, 3, 0.5, -0.25, 0.125 },
        a = { 1.2307432285600118, 14.911849282988322, 2.6429537521660533, -15.615923496879,
          -0.18908472751532081, 5.2344731434387279 } },
      { q = { -1.2, 0.7, -1.9, 2.5, 0.6, -0.3 }, v = { -1, 0.75, 1.25, 2, -1.5, 0.5 },
        tau = { -4, 6, 2, -1, 0.5, -0.75 },
        a = { -3.3367219215185583, 22.564652501878439, 1.5294693885000352, -23.707025978549441,
          4.8319737836107335, -50.32070295038693 } },
    }
    for _, case in ipairs(cases) do
      for i, b in ipairs(bodies) do b.torque = case.tau[i] end
      local a = multibody.accelerations { bodies = bodies, gravity = { 0, 0, -9.81 }, q = case.q, v = case.v }
      for i = 1, 6 do assert.near(case.a[i], a[i], 1e-12) end
    end
  end)

  -- Wheels about their centres, in closed form.
  local function wheel(inertia, more)
    local b = { parent = 0, axis = { 0, 0, 1 }, turn_axis = { 0, 0, 1 }, mass = 1,
      inertia = { 1, 0, 0, 1, 0, inertia } }
    for key, x in pairs(more or {}) do b[key] = x end
    return b
  end
  local function motion(t)
    t.gravity, t.times, t.tolerance = { 0, 0, 0 }, { 0.3, 1 }, 1e-17
    return multibody.run(t)
  end

  it("knows gears, and joints that follow others", function()
    local found = motion { bodies = { wheel(2, { torque = 3 }), wheel(0.5), wheel(0.25) }, q = { 0.1, 0, 0 },
      v = { 0.2, 0, 0 }, ties = { { follower = 2, leader = 1, ratio = -1.5, offset = 0.7 },
        { follower = 3, leader = 2, ratio = 2, offset = 0.1 } } }
    local a = 3 / (2 + 0.5 * 1.5 ^ 2 + 0.25 * 3 ^ 2)
    for k, t in ipairs { 0.3, 1 } do
      local q, v = 0.1 + 0.2 * t + a * t * t / 2, 0.2 + a * t
      local expected = { q, 0.7 - 1.5 * q, 0.1 + 2 * (0.7 - 1.5 * q), v, -1.5 * v, -3 * v }
      for i = 1, 6 do assert.near(expected[i], found[k][i], 1e-15) end
    end
  end)

  it("knows given motions", function()
    local found = motion { bodies = { wheel(2) }, q = { 0 }, v = { 0 },
      ties = { { follower = 1, leader = 0, offset = 0.3, swing = 0.5, tempo = 4 } } }
    for k, t in ipairs { 0.3, 1 } do
      assert.near(0.3 + 0.5 * math.sin(4 * t), found[k][1], 1e-15)
      assert.near(2 * math.cos(4 * t), found[k][2], 1e-15)
    end
  end)

  it("knows friction", function()
    local found = motion { bodies = { wheel(2, { friction = 0.4, creep = 0.2 }) }, q = { 0 }, v = { 0.9 } }
    for k, t in ipairs { 0.3, 1 } do -- sinh(v / creep) falls as e^(-friction t / (I creep))
      local s = math.exp(-0.4 * t / (2 * 0.2)) * (math.exp(4.5) - math.exp(-4.5)) / 2
      assert.near(0.2 * math.log(s + math.sqrt(s * s + 1)), found[k][2], 1e-15)
    end
  end)

  it("knows PD control", function()
    -- I = 1, kp = 25, kd = 6: the error w - q obeys e'' + 6 e' + 25 e = w'', whose steady part is a wave
    local control = { proportional = 25, derivative = 6, goal = 0.2, swing = 0.5, tempo = 2 }
    local found = motion { bodies = { wheel(1, control) }, q = { 0.1 }, v = { 0.3 } }
    local b, c = 25 - 4, 12 -- of e = A sin 2t + B cos 2t: b A - c B = -2, c A + b B = 0
    local A = -2 * b / (b * b + c * c)
    local B = -c * A / b
    local C = 0.1 - B -- e(0) = 0.1, e'(0) = 1 - 0.3
    local D = (0.7 - 2 * A + 3 * C) / 4
    for k, t in ipairs { 0.3, 1 } do
      local steady = A * math.sin(2 * t) + B * math.cos(2 * t)
      local e = steady + math.exp(-3 * t) * (C * math.cos(4 * t) + D * math.sin(4 * t))
      assert.near(0.2 + 0.5 * math.sin(2 * t) - e, found[k][1], 1e-15)
    end
  end)
end)
