-- Systems that step: ambit.map; networks and tables as formulas.
local ambit = require "ambit"

describe("a system that steps", function()
  it("is followed step by step, with its data", function()
    local henon = ambit.map { "henon", states = { "x", "y" }, parameters = { a = ambit.around("1.4", "1e-4") },
      next = function(s, p) return { x = 1 - p.a * s.x * s.x + s.y, y = "0.3" * s.x } end }
    local initial, t = { x = 0, y = 0 }, { 0, 1, 5, 10 }
    local run = ambit.simulate { henon, initial = initial, t = t }
    assert.equal("complete", run.status)
    local least, most = math.huge, -math.huge
    for k = -10, 10 do
      local a, x, y = 1.4 + 1e-5 * k, 0, 0
      for n = 1, 10 do
        x, y = 1 - a * x * x + y, 0.3 * x
        if n == 5 then assert.is_true(run:at(5).x.lo <= x and x <= run:at(5).x.hi) end
      end
      assert.is_true(run.x.x.lo <= x + 1e-13 and x <= run.x.x.hi + 1e-13)
      least, most = math.min(least, x), math.max(most, x)
    end
    assert.is_true(run.x.x:width() < 1.01 * (most - least))
    local inner = ambit.sample { henon, initial = initial, t = t, n = 50 }
    assert.is_true(run.x.x.lo <= inner.x.x.lo and inner.x.x.hi <= run.x.x.hi)
  end)

  it("comes to terms of degree three that no step before has held", function()
    local p, q, r = ambit.between(-1, 1), ambit.between(-1, 1), ambit.between(-1, 1)
    local system = ambit.map { states = { "x", "y", "z" },
      next = function(s) return { y = p * q, x = s.y * r, z = s.x + 1 } end }
    local rest = { x = 0, y = 0, z = 0 }
    local run = ambit.simulate { system, initial = rest, t = { 0, 1, 2, 3, 4 } }
    local set = ambit.simulate({ system, initial = rest, t = { 0, 3 } }):set()
    for _, x in ipairs { run:at(2).x, run:at(3).x, run.x.x, ambit.evaluate { set.x }, run:at(3).z - 1, run.x.z - 1,
      ambit.evaluate { set.z - 1 } } do
      assert.is_true(x:contains(-1) and x:contains(1) and x:width() < 2.001)
    end
    assert.is_true(run:at(1).x:width() < 1e-9)
  end)

  it("takes what varies anew at each step", function()
    local noisy = ambit.map { states = { "x" },
      next = function(s) return { x = 0.5 * s.x + ambit.varying(-1, 1) } end }
    local run = ambit.simulate { noisy, initial = { x = 0 }, t = { 0, 20 } }
    local reach = 2 * (1 - 2.0 ^ -20)
    assert.is_true(run.x.x.hi >= reach and run.x.x.hi < reach + 1e-7 and run.x.x.lo <= -reach)
    local function verdict(limit)
      return ambit.verify { noisy, initial = { x = 0 }, t = 20, safe = function(s) return s.x - limit end }.status
    end
    assert.equal("proved", verdict(2))
    assert.equal("undecided", verdict(1.9))
  end)

  it("knows its step, and rotates without being boxed", function()
    local turning = ambit.map { states = { "x", "y", "n" }, next = function(s, _, k)
      return { x = "0.6" * s.x - "0.8" * s.y, y = "0.8" * s.x + "0.6" * s.y, n = s.n + k }
    end }
    local run = ambit.simulate { turning, initial = { x = ambit.around(1, "0.1"), y = ambit.around(0, "0.1"), n = 0 },
      t = { 0, 1000 } }
    assert.is_true(run.x.n:contains(999 * 1000 / 2))
    assert.is_true(run.x.x:width() < 0.2 * 1.4143)
  end)

  it("refuses what it does not know", function()
    assert.has_error(function() ambit.map { states = { "x" } } end,
      "map: next: expected a function(s, p, k) that returns the next state, got nil")
    local one = ambit.map { states = { "x" }, next = function(s) return { x = s.x } end }
    assert.has_error(function() ambit.simulate { one, initial = {}, t = 1 } end,
      "simulate: initial: the state `x` has no value")
  end)
end)

describe("a network", function()
  it("is the formula of its layers", function()
    local net = ambit.network { { weights = { { 1, -2 }, { 0.5, 0 }, { -1, 1 } }, bias = { 0.25, 0, -1 },
      activation = "relu" }, { weights = { { 1, 2, 3 } }, bias = { -0.5 } } }
    for _, x in ipairs { { 1, 2 }, { -1, 0.5 }, { 3, -2 }, { 0, 0 } } do
      local h = { x[1] - 2 * x[2] + 0.25, 0.5 * x[1], -x[1] + x[2] - 1 }
      local y = -0.5
      for i, v in ipairs(h) do y = y + i * math.max(0, v) end
      local got = ambit.evaluate { net(x)[1], arithmetic = "interval" }
      assert.is_true(got:contains(y) and got:width() < 1e-14)
    end
    assert.has_error(function() net { 1 } end, "network: expected 2 inputs, got 1")
    assert.has_error(function() ambit.network { { weights = { { 1 }, { 2 } }, bias = { 1 } } } end,
      "network: layer 1: expected a bias for each of 2 rows of weights, got 1")
  end)

  it("is read from a file, whose faults are told by line", function()
    local name = os.tmpname()
    local function with(text)
      local file = assert(io.open(name, "w"))
      file:write(text)
      file:close()
      return pcall(ambit.network, name)
    end
    local good, net = with "inputs 2 # angle, speed\n\ndense 2 tanh\n1 2 3\n-1 0.5 0\ndense 1 sigmoid\n1 1 0\n"
    assert.is_true(good)
    assert.equal("network 2 - 2 tanh - 1 sigmoid", tostring(net))
    local y = ambit.evaluate { net { 0.5, -1 }[1], arithmetic = "interval" }
    local function tanh(x) return 1 - 2 / (1 + math.exp(2 * x)) end
    local sum = tanh(0.5 - 2 + 3) + tanh(-0.5 - 0.5)
    assert.is_true(math.abs(y:mid() - 1 / (1 + math.exp(-sum))) < 1e-14 and y:width() < 1e-13)
    for text, fault in pairs {
      ["dense 1 relu\n"] = ":1: expected `inputs` and their number",
      ["inputs 2\ndense 1 relu\n1 2\n"] = ":3: expected 2 weights and a bias, got 2 numbers",
      ["inputs 2\ndense 1 rely\n1 2 3\n"] = ":2: expected one of linear, relu, sigmoid, tanh, got",
      ["inputs 2\ndense 1 relu\n1 x 3\n"] = ":3: expected a number, got `x`",
      ["inputs 2\ndense 2 relu\n1 2 3\n"] = ": the file ends before neuron 2 of its layer",
      ["inputs 2\n"] = "network: expected at least one layer",
    } do
      local is_read, message = with(text)
      assert.is_true(not is_read and tostring(message):find(fault, 1, true) ~= nil, tostring(message))
    end
    os.remove(name)
    assert.is_false((pcall(ambit.network, name)))
  end)

  it("controls a plant whose trajectories stay inside", function()
    local net = ambit.network { { weights = { { 2, 1 }, { -2, -1 }, { 1, 0.5 } }, bias = { 0, 0, 0.5 },
      activation = "relu" }, { weights = { { -1.5, 1.5, 0.25 } }, bias = { -0.125 } } }
    local control = ambit.sampled { period = 0.0625, outputs = { "u" }, law = function(s) return net { s.x, s.v }[1] end }
    local plant = ambit.ode { states = { "x", "v" }, sampled = control,
      equations = function(s) return { x = s.v, v = s.u } end }
    local t = { 0 }
    for k = 1, 48 do t[k + 1] = k / 16 end
    local run = ambit.simulate { plant, t = t, initial = { x = ambit.between(0.75, 1), v = ambit.between(-0.25, 0) } }
    assert.equal("complete", run.status)
    local least, most = math.huge, -math.huge
    for i = 0, 8 do
      for j = 0, 8 do
        local x, v = 0.75 + i / 32, -j / 32
        for k = 1, 48 do
          local a, b, c = math.max(0, 2 * x + v), math.max(0, -2 * x - v), math.max(0, x + 0.5 * v + 0.5)
          local u = -1.5 * a + 1.5 * b + 0.25 * c - 0.125
          x, v = x + v / 16 + u / 512, v + u / 16
          local at = run:at(k / 16)
          assert.is_true(at.x.lo <= x + 1e-12 and x <= at.x.hi + 1e-12 and at.v.lo <= v + 1e-12 and v <= at.v.hi + 1e-12)
        end
        least, most = math.min(least, x), math.max(most, x)
      end
    end
    assert.is_true(run.x.x:width() < 4 * (most - least), tostring(run.x.x))
  end)
end)

describe("a lookup table", function()
  it("draws lines between its points, and stays beyond them", function()
    local f = ambit.lookup { x = { 0, 1, 2 }, y = { 0, 3, 4 } }
    for x, y in pairs { [-1] = 0, [0] = 0, [0.5] = 1.5, [1] = 3, [1.5] = 3.5, [2] = 4, [3] = 4 } do
      assert.is_true(ambit.evaluate { f(x), arithmetic = "interval" }:contains(y))
    end
    assert.has_error(function() ambit.lookup { x = { 0, 0 }, y = { 1, 2 } } end,
      "lookup: x: expected rising numbers, but entry 2 is not above the one before")
    for _, t in ipairs { { x = { 0, ambit.around(1, "1%") }, y = { 1, 2 } },
      { x = { 0, 1 }, y = { 1, ambit.around(1, "1%") } } } do
      assert.has_error(function() ambit.lookup(t) end, "lookup: point 2: expected known numbers")
    end
    assert.has_error(function() ambit.lookup { x = { 0, 1 }, y = { 1 } } end,
      "lookup: expected as many numbers in x as in y, two at least, got 2 and 1")
  end)
end)
