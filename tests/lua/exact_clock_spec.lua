-- Samples, and times that were asked for, are compared as the numbers that they are, however near they lie. The oracle
-- is arithmetic on decimal digits: a double is a decimal, too, which C's printf writes down to the last digit.
local ambit = require "ambit"
local core = require "ambit.core"

-- -- numbers >= 0 as digits with 70 places behind the point

local PLACES = 70

-- of a decimal text or a double, times a whole number
local function digits(x, factor)
  local whole, part = (type(x) == "number" and ("%.70f"):format(x) or x):match "^(%d+)%.?(%d*)$"
  assert(part and #part <= PLACES, tostring(x))
  local text, carry, list = whole .. part .. ("0"):rep(PLACES - #part), 0, {}
  for i = #text, 1, -1 do
    local v = tonumber(text:sub(i, i)) * (factor or 1) + carry
    table.insert(list, 1, tostring(math.tointeger(v % 10)))
    carry = v // 10
  end
  return (("%d"):format(carry) .. table.concat(list)):gsub("^0+", "")
end

local function compare(a, b)
  if #a ~= #b then return #a < #b and -1 or 1 end
  return a < b and -1 or a > b and 1 or 0
end

-- How many of the instants 0, p / q, 2 p / q, ... are before x? p: a decimal text or a double, q: a whole number
local function before(x, p, q)
  local target = digits(x, q)
  local value = (type(p) == "number" and p or tonumber(p)) / q
  local k = math.max(0, math.floor((type(x) == "number" and x or tonumber(x)) / value) - 2)
  while compare(digits(p, k), target) < 0 do k = k + 1 end
  return k
end

local function ulps_beside(x)
  local function bits(y, n)
    return (string.unpack("<d", string.pack("<i8", string.unpack("<i8", string.pack("<d", y)) + n)))
  end
  return { bits(x, -1), x, bits(x, 1) }
end

-- k p / q to 22 places, and 3 units of the last one before and behind; p, q: whole numbers
local function texts_beside(p, q, k)
  local whole, rest, places, list = k * p // q, k * p % q, "", {}
  for _ = 1, 22 do
    places, rest = places .. ("%d"):format(rest * 10 // q), rest * 10 % q
  end
  for off = -3, 3 do
    local last = tonumber(places:sub(-6)) + off
    if last >= 0 and last <= 999999 then
      list[#list + 1] = ("%d.%s%06d"):format(whole, places:sub(1, -7), math.tointeger(last))
    end
  end
  return list
end

-- n counts the samples
local function counting(clock)
  local count = ambit.sampled { period = clock.period, start = clock.start, outputs = { "n" },
    law = function(s) return s.n + 1 end }
  return ambit.ode { states = { "x" }, sampled = count, equations = function(s) return { x = s.n } end }
end

local function holds(x, n, what)
  assert.is_true(x:contains(n) and x:width() < 0.5, ("%s: %s misses %d"):format(what, tostring(x), n))
end

local function complete(t)
  local run = ambit.simulate(t)
  assert.equal("complete", run.status, run.reason)
  return run
end

describe("a clock and a time that was asked for", function()
  it("are in the order of the numbers that they are", function()
    local tries = 0
    for _, clock in ipairs { { 1, 10 }, { 3, 10 }, { 1, 3 }, { 7, 30 }, { 2, 7 }, { 1, 8 } } do
      local p, q = clock[1], clock[2]
      local plant = counting { period = ("%d/%d"):format(p, q) }
      local all = complete { plant, initial = { x = 0 }, t = { 0, 13 * p / q }, dense = true }
      for k = 1, 12 do
        local list = texts_beside(p, q, k)
        table.move(ulps_beside(k * p / q), 1, 3, #list + 1, list)
        for _, t in ipairs(list) do
          local what, n = ("%s with %d/%d"):format(tostring(t), p, q), before(t, tostring(p), q)
          holds(all:at(t).n, n, what) -- between steps
          holds(complete { plant, initial = { x = 0 }, t = { 0, t, 20 * p / q } }:at(t).n, n, what) -- listed
          local run = complete { plant, initial = { x = 0 }, t = { 0, t } }
          holds(run.x.n, n, what) -- the end
          holds(core.evaluate { expressions = { run:set().n } }[1], n, what)
          tries = tries + 1
        end
        assert.equal("proved", ambit.verify { plant, initial = { x = 0 }, t = ("%d/%d"):format(k * p, q),
          at_end = function(s) return ambit.abs(s.n - k) - 0.5 end }.status)
      end
    end
    assert.is_true(tries > 550, tostring(tries))
  end)

  it("are one instant, if they are one number, whatever it looks like", function()
    for _, names in ipairs { { "0.1", "3/30", "1/10", "1e-1", "0.10000" }, { "1/3", "2/6", "0.7/2.1" } } do
      for _, period in ipairs(names) do
        local run = complete { counting { period = period }, initial = { x = 0 }, t = { 0, names[1], 2 } }
        for _, t in ipairs(names) do holds(run:at(t).n, 1, t .. " with " .. period) end
      end
    end
    local period = ambit.number(0.3) / 7 -- of doubles, as a formula
    holds(complete { counting { period = period }, initial = { x = 0 }, t = { 0, period * 5 } }.x.n, 5, "formula")
  end)

  it("are in order also where a formula uses a part of itself again and again", function()
    local period = ambit.number "1"
    for _ = 1, 60 do period = period / (1 + period) end -- 1/61, but 2^60 ways to its parts
    local plant = counting { period = period }
    for k, n in pairs { [3] = 3, [3.5] = 4 } do
      holds(complete { plant, initial = { x = 0 }, t = { 0, period * k } }.x.n, n, "deep formula")
    end
  end)

  it("does not answer behind the true end", function()
    local run = complete { counting { period = "0.1" }, initial = { x = 0 }, t = { 0, "0.3" }, dense = true }
    assert.is_false((pcall(run.at, run, 0.3 + 0x1p-54)))
    assert.is_false((pcall(run.at, run, "0.30000000000000000001")))
    holds(run:at("0.29999999999999999999").n, 3, "0.3-")
  end)
end)

-- -- two clocks: a counts the samples of the first, b has what a was at the last sample of the second

local function pair(first, second, swapped, equations)
  local a = ambit.sampled { "a", period = first, outputs = { "a" }, law = function(s) return s.a + 1 end }
  local b = ambit.sampled { "b", period = second, outputs = { "b" }, law = function(s) return s.a end }
  return ambit.ode { states = { "x" }, sampled = swapped and { b, a } or { a, b },
    equations = equations or function(s) return { x = s.a - s.b } end }
end

-- a and b after all samples before t; periods { p, q } as in `before`
local function follow(t, first, second, swapped)
  local a, b, n, m = 0, 0, before(t, first[1], first[2]), before(t, second[1], second[2])
  local i, j = 0, 0
  while i < n or j < m do
    local side = compare(digits(first[1], i * second[2]), digits(second[1], j * first[2]))
    if j >= m or i < n and (side < 0 or side == 0 and not swapped) then
      a, i = a + 1, i + 1
    else
      b, j = a, j + 1
    end
  end
  return a, b
end

describe("two clocks", function()
  local cases = { -- texts of the periods, and what they are
    { "0.1", "3/30", { "0.1", 1 }, { "3", 30 } },
    { "1/3", "1/3", { "1", 3 }, { "1", 3 } },
    { "0.1", "0.15", { "0.1", 1 }, { "0.15", 1 } },
    { "1/3", "0.25", { "1", 3 }, { "0.25", 1 } },
  }

  it("act in the order of their instants, and in that of the list at one instant only", function()
    local crowded = 0 -- a sample and the end of the run beside one double
    for _, case in ipairs(cases) do
      for _, swapped in ipairs { false, true } do
        local plant = pair(case[1], case[2], swapped)
        local run = complete { plant, initial = { x = 0 }, t = { 0, "0.1", "2/3", 2.05 }, dense = true }
        local function check(x, t)
          local a, b = follow(t, case[3], case[4], swapped)
          local what = ("%s and %s%s at %s"):format(case[1], case[2], swapped and ", swapped" or "", t)
          holds(x.a, a, what)
          holds(x.b, b, what)
        end
        check(run.x, 2.05)
        for k = 1, 6 do
          local list = texts_beside(k, case[3][2] == 3 and 3 or 10, 1)
          table.move(ulps_beside(k / (case[3][2] == 3 and 3 or 10)), 1, 3, #list + 1, list)
          for _, t in ipairs(list) do check(run:at(t), t) end
        end
        for _, t in ipairs { "0.1", "0.3", 0.1, 0.3, "0.35", "0.6" } do
          local to_t = ambit.simulate { plant, initial = { x = 0 }, t = { 0, t }, partial = true }
          if to_t.status == "complete" then check(to_t.x, t) else crowded = crowded + 1 end
        end
      end
    end
    assert.is_true(crowded <= 4, tostring(crowded))
  end)

  it("are refused with a sentence where nothing tells their order", function()
    local run = ambit.simulate { pair(ambit.sqrt(2) / 10, ambit.sqrt(2) * "0.1"), initial = { x = 0 }, t = 1,
      partial = true }
    assert.equal("unable", run.status)
    assert.is_truthy(run.reason:find("cannot be told whether two samples", 1, true))
    assert.equal("complete", ambit.simulate { pair(ambit.pi / 10, ambit.pi / 10), initial = { x = 0 }, t = 1 }.status)
    for _, periods in ipairs { { "0.1", "0.100000000000000001" }, { "0.1", 0.1 }, { 0.1, "0.2" },
      { "1/3", "0.33333333333333333333" } } do -- no double is between their instants
      run = ambit.simulate { pair(table.unpack(periods)), initial = { x = 0 }, t = 1.5 }
      assert.equal("unable", run.status)
      assert.is_truthy(run.reason:find("nearer to each other than doubles can tell", 1, true))
    end
  end)
end)

-- -- events: the zero of each g is at a sample, or some 1e-22 s before or behind

-- whole + n 1e-22 as a decimal text; |n| < 10^8
local function beside(whole, n)
  if n < 0 then return ("%d.%s%08d"):format(whole - 1, ("9"):rep(14), 100000000 + n) end
  return ("%d.%s%08d"):format(whole, ("0"):rep(14), n)
end

-- Does the event hold (whole + n 1e-22) / q?
local function check_time(e, whole, n, q, what)
  local t = digits(beside(whole, n))
  what = ("%s: %s misses %s / %d"):format(what, e and tostring(e.t), beside(whole, n), q)
  assert.is_true(e and compare(digits(e.t.lo, q), t) <= 0 and compare(t, digits(e.t.hi, q)) <= 0, what)
  assert.is_true(e.t:width() < 1e-13, what)
end

local offs = { -300000, -1, 0, 1, 300000 }

-- Events of x' = rate(s): the zeros of x and of x + t and of t beside the instants k p / q. x_of: k -> x there, as
-- text; rates: k -> x' before and behind.
local function check_events(plant, p, q, most, x_of, rates, what)
  local list, wanted = {}, {}
  for k = 1, most do
    local before_it, behind_it = rates(k)
    for _, off in ipairs(offs) do
      local t = ("%d/%d"):format(k * p, q) + ambit.number("1e-22") * off
      local x = ambit.number(x_of(k)) + ambit.number("1e-22") * off * (off > 0 and behind_it or before_it)
      for _, g in ipairs { function(s) return s.x - x end, function(s, _, time) return s.x + time - x - t end,
        function(_, _, time) return time - t end } do
        list[#list + 1], wanted[#wanted + 1] = { g = g, name = ("%d"):format(#list + 1) }, { k * p, off * q }
      end
    end
  end
  local run = complete { plant, initial = { x = 0 }, t = { 0, (most + 1) * p / q }, events = list }
  assert.equal(#list, #run.events)
  for _, e in ipairs(run.events) do
    assert.is_true(e.certain, e.reason)
    check_time(e, wanted[e.index][1], wanted[e.index][2], q, what .. ", event " .. e.name)
  end
  return #list
end

describe("events at samples", function()
  it("are at their true instants, whatever doubles the solver leaps on", function()
    local count = 0
    for _, clock in ipairs { { 1, 10 }, { 3, 10 }, { 1, 3 }, { 2, 7 }, { 7, 30 }, { 1, 8 } } do
      local p, q = clock[1], clock[2]
      local counter = ambit.sampled { period = ("%d/%d"):format(p, q), outputs = { "n" },
        law = function(s) return s.n + 1 end }
      local plant = ambit.ode { states = { "x" }, sampled = counter, equations = function(s) return { x = s.n } end }
      count = count + check_events(plant, p, q, 6, function(k) return ("%d/%d"):format(p * k * (k + 1) // 2, q) end,
        function(k) return k, k + 1 end, ("%d/%d"):format(p, q))
    end
    assert.equal(6 * 6 * #offs * 3, count)
  end)

  it("are at those of two clocks", function()
    for _, swapped in ipairs { false, true } do
      local plant = pair("0.1", "0.15", swapped, function(s) return { x = 1 + s.a + s.b } end)
      local function rate(text)
        local a, b = follow(text, { "0.1", 1 }, { "0.15", 1 }, swapped)
        return 1 + a + b
      end
      local x, rates = { 0 }, {}
      for k = 1, 14 do
        rates[k] = rate(("%d.%02d"):format(k * 5 // 100, k * 5 % 100))
        x[k + 1] = x[k] + rates[k]
      end
      check_events(plant, 1, 20, 13, function(k) return ("%d/20"):format(x[k + 1]) end,
        function(k) return rates[k], rates[k + 1] end, "two clocks")
    end
  end)

  it("are not certain where g turns round at a sample", function()
    local turn = ambit.sampled { period = "0.3", outputs = { "u" }, law = function() return 1 end, start = "0.3" }
    local plant = ambit.ode { states = { "x" }, sampled = turn, equations = function(s) return { x = 2 * s.u - 1 } end }
    for _, off in ipairs { 0, 1, 300000 } do -- zeros at 0.3 -+ off 1e-22: one, or two
      local run = ambit.simulate { plant, initial = { x = 0 }, t = { 0, 0.5 }, partial = true,
        events = { { g = function(s) return s.x + "0.3" - ambit.number("1e-22") * off end } } }
      assert.equal(1, #run.events)
      assert.is_false(run.events[1].certain)
      check_time(run.events[1], 3, -10 * off, 10, "turns")
      check_time(run.events[1], 3, 10 * off, 10, "turns")
    end
  end)
end)

describe("a schedule of 10^6 samples", function()
  it("has them all, in order, each beside its instant", function()
    local schedule = core.schedule(pair("0.1", "0.3").system, 0, 5e4)
    for _, k in ipairs { 1, 7, 12345, 250000, 499999 } do
      local low = ("%d.%d"):format(k // 10, k % 10)
      local from, till = core.schedule_around(schedule, core.expression(low))
      assert.is_true(from < till and compare(digits(till), digits(low)) <= 0 and tonumber(low) - till < 1e-11)
    end
  end)
end)

describe("conditions with time", function()
  it("hold at the true instant of a sample, which no double is", function()
    -- u is 0 until the sample at 1/10, where 8 t is more than at the double before; and 1 from there on, where it is
    -- less than at the double behind
    local step = ambit.sampled { period = "0.1", outputs = { "u" }, law = function() return 1 end, start = "0.1" }
    local plant = ambit.ode { states = { "x" }, sampled = step, equations = function() return { x = 0 } end }
    local down, _, up = table.unpack(ulps_beside(0.1))
    if compare(digits(0.1), digits "0.1") < 0 then down = 0.1 else up = 0.1 end
    local function status(g) return ambit.verify { plant, initial = { x = 0 }, t = 0.15, safe = g }.status end
    assert.are_not.equal("proved", status(function(s, _, t) return 8 * (t - down) - "1e-20" - s.u end)) -- 7e-17 at 1/10
    assert.are_not.equal("proved", status(function(s, _, t) return 8 * (up - t) - "1e-20" - (1 - s.u) end))
    assert.equal("proved", status(function(s, _, t) return 8 * t - "0.8000000000001" - s.u end))
    assert.equal("proved", status(function(s, _, t) return "0.7999999999" - 8 * t - (1 - s.u) end))
  end)
end)
