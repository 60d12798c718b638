-- suite/extreme/texts.lua -- data that are no data: NaN, infinities, empty sets, literals that overflow, foreign
-- digits.
local refusal = require "ambit.suite.extreme.refusal"

local NAN, INF = 0 / 0, math.huge

local function number(text) return function(a) return a.number(text) end end

local numbers = {
  { "NaN", number(NAN), "number", "NaN" },
  { "an infinite number", number(INF), "number", "infinite" },
  { "1e400", number "1e400", "number", "1e400", "beyond the largest number" },
  { "-1e400", number "-1e400", "number", "-1e400", "beyond the largest number" },
  { "a huge exponent", number "1e99999999999999999999", "number", "beyond the largest number" },
  { "a huge hexadecimal exponent", number "0x1p5000", "number", "beyond the largest number" },
  { "400 digits", number(("9"):rep(400)), "number", "too long" },
  { "100000 digits", number(("1"):rep(100000)), "number", "too long" },
  { "inf as a text", number "inf", "number", "inf", "expected" },
  { "nan as a text", number "nan", "number", "nan", "expected" },
  { "no text", number "", "number", "expected" },
  { "a quotient by zero", number "1/0", "number", "1/0", "expected" },
  { "Arabic digits", number "١", "number", "١", "expected" },
  { "a minus sign of typographers", number "−1", "number", "−1", "expected" },
  { "a fraction in one sign", number "½", "number", "½", "expected" },
  { "a decimal comma", number "1,5", "number", ",5" },
  { "a zero byte", number "1\0", "number", "zero byte" },
  { "a unit that nobody knows", number "1 furlong", "unknown unit", "furlong" },
  { "no set", number "[2, 1]", "number", "[2, 1]" },
  { "the empty set", number "[empty]", "number", "empty" },
  { "all reals", number "[entire]", "number", "not bounded" },
  { "half a line", number "[1, inf]", "number", "not bounded" },
}

local uncertain = {
  { "between NaN", function(a) return a.between(NAN, 1) end, "between", "NaN" },
  { "between infinite", function(a) return a.between(0, INF) end, "between", "infinite" },
  { "between overflowing", function(a) return a.between(1, "1e400") end, "between", "1e400", "largest" },
  { "between, reversed", function(a) return a.between(2, 1) end, "between", "2 is greater than 1" },
  { "around NaN", function(a) return a.around(NAN, 1) end, "around", "NaN" },
  { "a NaN tolerance", function(a) return a.around(1, NAN) end, "around", "tolerance", "finite" },
  { "a negative tolerance", function(a) return a.around(1, -1) end, "around", "tolerance", "not negative" },
  { "a tolerance that overflows", function(a) return a.around(1, "1e400") end, "tolerance", "finite" },
  { "interval of NaN", function(a) return a.interval(NAN) end, "interval", "NaN" },
  { "interval at infinity", function(a) return a.interval(INF) end, "interval", "empty" },
  { "interval, reversed", function(a) return a.interval(3, 2) end, "interval", "3 is greater than 2" },
}

local function motion(a, x)
  local decay = a.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
  return a.simulate { decay, initial = { x = x }, t = { 0, 1 } }
end

local function with(x) return function(a) return motion(a, x) end end

local initial = {
  { "a NaN state", with(NAN), "simulate", "initial.x", "NaN" },
  { "an infinite state", with(INF), "simulate", "initial.x", "infinite" },
  { "a state without a value", with(nil), "simulate", "initial", "`x`" },
  { "an empty state", with "[empty]", "simulate", "initial.x", "empty" },
  { "an unbounded state", with "[entire]", "simulate", "initial.x", "not bounded" },
  { "a state that overflows", with "1e400", "simulate", "initial.x", "1e400" },
  { "no number", with(true), "simulate", "initial.x", "boolean" },
  { "NaN in a parameter", function(a)
    return a.ode { states = { "x" }, parameters = { k = NAN }, equations = function(s, p) return { x = p.k * s.x } end }
  end, "ode", "parameter k", "NaN" },
  { "NaN in an equation", function(a)
    return a.ode { states = { "x" }, equations = function() return { x = NAN } end }
  end, "ode", "derivative of x", "NaN" },
  { "NaN in `at`", function(a)
    local m = a.mechanism "m"
    local frame = m:revolute { from = m.world, axis = "z", name = "q" }
    return a.evaluate { m:orientation(frame), at = { q = NAN } }
  end, "evaluate", "at.q", "NaN" },
}

-- What a text may say all the same.
local function accepted(a)
  local list = {
    { "0x1p4", a.evaluate { a.number "0x1p4" }, 16, 16 },
    { "1e-400", a.evaluate { a.number "1e-400" }, 0, 0x1p-1074 },
    { "1e-99999999999999999999", a.evaluate { a.number "1e-99999999999999999999" }, 0, 0x1p-1074 },
    { "[1e400, 1e500]", a.interval "[1e400, 1e500]", 0x1.fffffffffffffp1023, math.huge },
    { "[-1e400, 1e400]", a.interval "[-1e400, 1e400]", -math.huge, math.huge },
    { "5 µm", a.evaluate { a.number "5 µm" }, 0x1.4f8b588e368f0p-18, 0x1.4f8b588e368f1p-18 },
  }
  for _, entry in ipairs(list) do
    local x = entry[2]
    if x.lo ~= entry[3] or x.hi ~= entry[4] then
      return { outcome = "wrong", reason = ("%s is read as [%a, %a]"):format(entry[1], x.lo, x.hi) }
    end
  end
  return { outcome = "proved", steps = #list }
end

return {
  refusal.case("bad_numbers", "Numbers that are none", numbers),
  refusal.case("bad_uncertainty", "Uncertain data without a range", uncertain),
  refusal.case("bad_data", "NaN, infinite and empty data of a simulation", initial),
  { name = "odd_texts", group = "extreme", title = "Literals that overflow, underflow, are hexadecimal",
    source = "IEEE 1788-2015, clause 9.7", question = "literals", quick = true, over = { {} }, run = accepted,
    expected = { default = "proved" } },
}
