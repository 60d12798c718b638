-- Answers for a part of the data say so: in print, in .partial, in records, by exit code 3 unless `partial = true`.
local ambit = require "ambit"
local session = require "ambit.session"

local command = os.getenv "AMBIT_COMMAND" or "ambit"
local arithmetics = { "interval", "affine", "gradient", "taylor_model", "mpfr" }

local function evaluate(t)
  local result = ambit.evaluate(t)
  session.worst = "ok"
  return result
end

-- Exit code and all output of a scene.
local function scene(text)
  local name = os.tmpname()
  local file = assert(io.open(name, "w"))
  file:write('local ambit = require "ambit"\n', text)
  file:close()
  local pipe = assert(io.popen(("'%s' run --quiet --json - %s 2>&1"):format(command, name)))
  local output = pipe:read "a"
  local _, _, code = pipe:close()
  os.remove(name)
  return code, output
end

local function has(text, ...)
  for _, piece in ipairs { ... } do assert.truthy(text:find(piece, 1, true), text) end
end

describe("a partial answer", function()
  it("says so in print, in every arithmetic", function()
    for _, arithmetic in ipairs(arithmetics) do
      local x = evaluate { ambit.sqrt(ambit.between(-1, 1)), arithmetic = arithmetic }
      assert.is_true(x.partial, arithmetic)
      has(tostring(x), "partial: undefined for part of the data")
    end
  end)

  it("is told of each result by itself, with the operation to blame", function()
    local x, y = ambit.between(-1, 1), ambit.between(2, 3)
    for _, arithmetic in ipairs(arithmetics) do
      local r = evaluate { { a = ambit.sqrt(y) / y, b = y + ambit.log(x) ^ 2, c = x * y }, arithmetic = arithmetic }
      assert.is_false(r.a.partial, arithmetic)
      assert.is_true(r.b.partial, arithmetic)
      assert.is_false(r.c.partial, arithmetic)
      assert.equal("partial", r.status)
      assert.equal("unable.partial", r.code)
      assert.is_true(r.partial)
      has(r.reason, "b: `log(")
    end
  end)

  it("names the element that wrote the operation", function()
    local m = ambit.mechanism "two bars"
    local a = m:rigid_link { from = m.world, offset = { ambit.between(-1, 1), 0, 0 } }
    local r = evaluate { { d = 1 / m:distance(a, m.world) } }
    assert.equal("unable.partial", r.code)
    has(r.reason, "`")
  end)

  it("stays partial in what is made of it", function()
    local s = ambit.sqrt(ambit.interval(-1, 1))
    has(tostring(s), "partial")
    has(tostring(s + 1), "partial")
    has(tostring(s:hull(3)), "partial")
    assert.is_true(evaluate { s * 2 }.partial)
    assert.is_true(evaluate { ambit.sqrt(ambit.interval(-1, 0)) + ambit.between(0, 1) }.partial) -- of a point, [0, 0]
  end)

  it("ends a scene with 3, unless the scene says that it knows", function()
    local code, output = scene "print(ambit.evaluate { ambit.sqrt(ambit.between(-1, 1)) })"
    assert.equal(3, code)
    has(output, "unable.partial", '"partial":true')
    code, output = scene "print(ambit.evaluate { ambit.sqrt(ambit.between(-1, 1)), partial = true })"
    assert.equal(0, code)
    has(output, "ok.partial", "(partial: undefined for part of the data)")
    code, output = scene "print(ambit.evaluate { ambit.log(ambit.between(-2, -1)), partial = true })"
    assert.equal(4, code)
    has(output, "domain.undefined", "is defined for none of the data")
    assert.equal(0, (scene "ambit.evaluate { ambit.sqrt(ambit.between(0, 1)) }"))
    code, output = scene "ambit.evaluate { ambit.between(0, 1), partial = 1 }"
    assert.equal(1, code)
    has(output, "partial: expected true or false")
  end)
end)

-- Random expressions of one or two data, by Lua's own numbers as the oracle: wherever a sampled point has no value, the
-- result that depends on it is partial; where the graph proves that all is defined, it is not.
describe("partial, of random expressions,", function()
  local seed = 12345
  local function random(n)
    seed = (seed * 1103515245 + 12345) % 2147483648
    return (seed >> 8) % n
  end
  local unary = {
    { "sqrt", function(a) return a >= 0 and math.sqrt(a) or nil end },
    { "log", function(a) return a > 0 and math.log(a) or nil end },
    { "asin", function(a) return a >= -1 and a <= 1 and math.asin(a) or nil end },
    { "acos", function(a) return a >= -1 and a <= 1 and math.acos(a) or nil end },
    { "sin", math.sin }, { "atan", math.atan }, { "abs", math.abs },
    { "sqr", function(a) return a * a end },
  }
  local binary = {
    { function(a, b) return a + b end, function(a, b) return a + b end },
    { function(a, b) return a - b end, function(a, b) return a - b end },
    { function(a, b) return a * b end, function(a, b) return a * b end },
    { function(a, b) return a / b end, function(a, b) return b ~= 0 and a / b or nil end },
  }

  -- { build(data) -> expression, value(numbers) -> number or nil }
  local function grow(depth)
    local kind = depth == 0 and random(2) or 2 + random(8)
    if kind == 0 then
      local i = 1 + random(2)
      return { function(d) return d[i] end, function(x) return x[i] end }
    elseif kind == 1 then
      local c = (random(17) - 8) / 4
      return { function() return ambit.number(c) end, function() return c end }
    elseif kind < 7 then
      local f, a = unary[1 + random(#unary)], grow(depth - 1)
      return { function(d) return ambit[f[1]](a[1](d)) end, function(x)
        local y = a[2](x)
        if y then return f[2](y) end
      end }
    end
    local f, a, b = binary[1 + random(#binary)], grow(depth - 1), grow(depth - 1)
    return { function(d) return f[1](a[1](d), b[1](d)) end, function(x)
      local y, z = a[2](x), b[2](x)
      if y and z then return f[2](y, z) end
    end }
  end

  it("is set wherever a point has no value", function()
    local tries = tonumber(os.getenv "AMBIT_PARTIAL_COUNT") or 150
    local undefined = 0
    for try = 1, tries do
      local lo, hi, d = {}, {}, {}
      for i = 1, 2 do
        lo[i] = (random(17) - 8) / 4
        hi[i] = lo[i] + random(9) / 4
        d[i] = ambit.between(lo[i], hi[i])
      end
      local list, expressions = {}, {}
      for k = 1, 4 do
        list[k] = grow(3)
        expressions[k] = list[k][1](d)
      end
      for _, arithmetic in ipairs(arithmetics) do
        local r = evaluate { expressions, arithmetic = arithmetic }
        for k = 1, 4 do
          for p = 0, 15 do
            local x = { lo[1] + (p % 4) / 3 * (hi[1] - lo[1]), lo[2] + (p // 4) / 3 * (hi[2] - lo[2]) }
            if list[k][2](x) == nil and (p % 3 == 0 and p // 4 % 3 == 0) then -- corners: exact numbers
              undefined = undefined + 1
              assert.is_true(r[k].partial, ("try %d, result %d, %s"):format(try, k, arithmetic))
            end
          end
        end
      end
    end
    assert.is_true(undefined > tries)
  end)
end)

-- The same of every verb: the answer for a part of the data is `partial`, exit code 3, and 0 if the scene knows.
describe("a partial answer of another verb", function()
  local verbs = {
    roots = [[local p = ambit.between(4, 16)
      r = ambit.roots { function(s) return s.x ^ 2 - p end, box = { x = { 0, 3 } }, partial = %s }
      assert(#r.partly == 1 and #r.proved == 0)]],
    ["roots that leave the box"] = [[local p = ambit.between("0.5", "1.5")
      r = ambit.roots { function(s) return s.x - p end, box = { x = { 0, 1 } }, partial = %s }
      assert(#r.proved == 1 and not r.proved[1].inside)]],
    ["equilibria that leave the box"] = [[local p = ambit.between("0.5", "1.5")
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = p - s.x } end }
      r = ambit.equilibria { f, box = { x = { 0, 1 } }, partial = %s }
      assert(#r.proved == 1 and not r.proved[1].inside)]],
    equilibria = [[local p = ambit.between(4, 16)
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = p - s.x ^ 2 } end }
      r = ambit.equilibria { f, box = { x = { 0, 3 } }, partial = %s }
      assert(#r.partly == 1)]],
    inverse_kinematics = [[local m = ambit.mechanism "arm"
      local tip = m:rigid_link { from = m:revolute { from = m.world, axis = "z", name = "q" }, offset = { 1, 0, 0 } }
      r = ambit.inverse_kinematics { m, at = tip, position = { ambit.between("0.2", "0.8") },
        box = { q = { "0.3", 1 } }, partial = %s }
      assert(#r.partly == 1 and #r.proved == 0)]],
    assemble = [[local m = ambit.mechanism "loop"
      local post = m:rigid_link { from = m.world, offset = { 0, 1, 0 } }
      local slider = m:prismatic { from = m.world, axis = "x", name = "x" }
      m:close_distance { a = slider, b = post, length = ambit.between("1.2", 2) }
      r = m:assemble { box = { x = { 0, "1.2" } }, partial = %s }
      assert(#r.partly == 1 and not r.configuration)]],
    sample = [[r = ambit.sample { { root = ambit.sqrt(ambit.between(-1, 1)) }, n = 50, partial = %s }
      assert(r.root.partial)]],
    eigenvalues = [[local x = ambit.between(-1, 1)
      r = ambit.eigenvalues { { ambit.sqrt(x), 0 }, { 0, 1 }, partial = %s }
      assert(#r > 0)]],
    events = [[local f = ambit.ode { states = { "x" }, equations = function() return { x = 1 } end }
      r = ambit.simulate { f, initial = { ambit.between(0, "0.5") }, t = { 0, 1 }, partial = %s,
        events = { { name = "there", g = function(s) return s.x - "1.25" end } } }
      assert(#r.events == 1 and not r.events[1].certain)]],
  }
  for name, text in pairs(verbs) do
    it("is told by " .. name, function()
      local check = "\nassert(r.status == 'partial' and r.partial, r.status) print(r.code, r.reason)"
      local code, output = scene("local r\n" .. text:format "false" .. check)
      assert.equal(3, code, output)
      has(output, "unable.partial", "partial = true")
      code, output = scene("local r\n" .. text:format "true" .. check)
      assert.equal(0, code, output)
      has(output, "ok.partial")
      code, output = scene("local r\n" .. text:format "7")
      assert.equal(1, code, output)
      has(output, "partial: expected true or false, got number")
    end)
  end

  it("is none of a sensitivity: what is not defined for all data is not proved", function()
    local code, output = scene [[
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
      local initial = { ambit.sqrt(ambit.between(-1, 1)) }
      print(ambit.sensitivity { f, initial = initial, t = { 0, 1 }, wrt = { "x" } }.status)]]
    assert.equal(1, code, output)
    has(output, "not defined for all values of their uncertain data")
    code, output = scene [[
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
      ambit.sensitivity { f, initial = { 1 }, t = { 0, 1 }, partial = true }]]
    assert.equal(1, code, output)
    has(output, "sensitivity: partial: there is nothing to allow")
    code, output = scene [[
      local f = ambit.ode { states = { "x" }, equations = function(s) return { x = -ambit.sqrt(s.x) } end }
      ambit.sensitivity { f, initial = { ambit.between(0, 1) }, t = { 0, 1 }, wrt = { "x" } }]]
    assert.equal(3, code, output)
    has(output, '"verb":"sensitivity","status":"unable"')
  end)

  it("of a sample says how many draws have a value, and that none has is no answer", function()
    local r = ambit.sample { { ambit.sqrt(ambit.between(-1, 1)), ambit.between(0, 1) }, n = 50 }
    assert.is_true(r[1].partial and not r[2].partial)
    session.worst = "ok"
    has(r.reason, "of 5", "draws have no value")
    r = ambit.sample { { ambit.sqrt(ambit.between(-2, -1)) }, n = 50, partial = true }
    session.worst = "ok"
    assert.equal("unable", r.status)
  end)
end)

describe("verdicts count for the exit code:", function()
  it("an assembly that is not decided, and none that is proved", function()
    local m = [[local m = ambit.mechanism "loop"
      local tip = m:prismatic { from = m.world, axis = "x", name = "x" }
      local goal = m:prismatic { from = m.world, axis = "x", name = "goal" }
      m:close_point { a = tip, b = goal }
      ]]
    local code, output = scene(m .. [[local r = m:assemble { goal = ambit.between(1, 2), box = { x = { 0, 3 } } }
      assert(r.code == "ok")]])
    assert.equal(0, code, output)
    has(output, '"verb":"assemble","status":"unique","code":"ok"')
    code, output = scene(m .. [[local r = m:assemble { goal = 5, box = { x = { 0, 3 } } } assert(r.code == "ok.none")]])
    assert.equal(0, code, output)
    has(output, '"status":"none","code":"ok.none"')
    code, output = scene [[local m = ambit.mechanism "loop"
      local post = m:rigid_link { from = m.world, offset = { 0, 1, 0 } }
      m:close_distance { a = m:prismatic { from = m.world, axis = "x", name = "x" }, b = post, length = 1 }
      local r = m:assemble { box = { x = { -1, 2 } } } -- x = 0 is a double root
      assert(r.status == "undecided" and r.code:match "^unable", r.status)]]
    assert.equal(3, code, output)
    has(output, '"verb":"assemble","status":"undecided","code":"unable.')
  end)

  it("a rank that is not decided, and one that is lost", function()
    local m = [[local m = ambit.mechanism "loop"
      m:close_distance { a = m:prismatic { from = m.world, axis = "x", name = "x" },
        b = m:prismatic { from = m.world, axis = "y", name = "y" }, length = ambit.between("1.5", 2) }
      ]]
    local code, output = scene(m .. [[local r = m:rank { box = { x = { "0.5", 2 }, y = { "0.5", 2 } } }
      assert(r.code == "ok")]])
    assert.equal(0, code, output)
    has(output, '"verb":"rank","status":"proved","code":"ok"')
    code, output = scene(m .. [[local r = m:rank { box = { x = { 3, 4 }, y = { 3, 4 } } }
      assert(r.code == "ok.none", r.code)]])
    assert.equal(0, code, output)
    has(output, '"verb":"rank","status":"empty","code":"ok.none"')
    code, output = scene(m .. [[local r = m:rank { box = { x = { -3, 3 }, y = { -3, 3 } }, boxes = 2 }
      assert(r.status == "undecided", r.status) print(r.reason)]])
    assert.equal(3, code, output)
    has(output, '"verb":"rank","status":"undecided","code":"unable.undecided"', "may lose rank; narrow the box")
  end)

  it("stability that is not decided, when somebody asks for it", function()
    local text = [[local f = ambit.ode { states = { "x", "v" }, equations = function(s)
        return { x = 2 * s.v, v = -s.x - %s * s.v } end }
      local r = ambit.equilibria { f, box = { x = { -1, 1 }, v = { -1, 1 } } }
      assert(r.status == "complete") ]]
    local code, output = scene(text:format "0")
    assert.equal(0, code, output)
    code, output = scene(text:format "0" .. "print(r.proved[1].stability, r.proved[1].eigenvalues)")
    assert.equal(3, code, output)
    has(output, '"verb":"stability","status":"undecided","code":"unable.undecided"')
    local _, count = output:gsub('"verb":"stability"', "")
    assert.equal(1, count)
    code, output = scene(text:format "1" .. "assert(r.proved[1].stability == 'stable')")
    assert.equal(0, code, output)
    has(output, '"verb":"stability","status":"stable","code":"ok"')
  end)

  it("a detailed model without a proof", function()
    local text = [[local boom = ambit.ode { states = { "x" }, equations = function(s) return { x = s.x ^ 2 } end }
      local small = ambit.ode { states = { "x" }, equations = function() return { x = 0 } end }
      local t = { outputs = { "x" }, error = { x = 1 }, t = { 0, 2 }, initial = { x = 1 } }
      ]]
    local code, output = scene(text .. "t[1], t[2] = boom, small print(ambit.certify(t))")
    assert.equal(3, code, output)
    has(output, '"verb":"certify","status":"unable","code":"unable.', "the detailed model itself cannot be proved")
    code, output = scene(text .. "t[1] = boom print(ambit.reduce(t))")
    assert.equal(3, code, output)
    has(output, '"verb":"reduce","status":"unable","code":"unable.', "the detailed model itself cannot be proved")
  end)

  it("eigenvalues that are not enclosed, and a matrix that does not exist", function()
    local code, output = scene "local r = ambit.eigenvalues { { ambit.exp(ambit.between(0, 1e300)) } } assert(#r == 0)"
    assert.equal(3, code, output)
    has(output, '"verb":"eigenvalues","status":"unable","code":"unable.eigenvalues"')
    code, output = scene "ambit.eigenvalues { { ambit.log(ambit.between(-2, -1)) } }"
    assert.equal(4, code, output)
    has(output, '"status":"impossible","code":"domain.undefined"')
    code, output = scene "ambit.eigenvalues { { 1, 2 }, { 3, 4 } }"
    assert.equal(0, code, output)
    has(output, '"verb":"eigenvalues","status":"complete","code":"ok"')
  end)
end)
