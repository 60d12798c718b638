-- suite/extreme/sizes.lua -- 1000 states, 10^6 steps, both at once, 10^4 uncertain data: done, or ended by a message
-- within the memory allowed.
local core = require "ambit.core"
local over = require "ambit.suite.extreme.over"

local function ring(a, n, t)
  local names, initial = {}, {}
  for i = 1, n do names[i], initial[i] = "x" .. i, i / n end
  local system = a.ode { states = names, equations = function(s)
    local rates = {}
    for i, name in ipairs(names) do rates[name] = s[names[i % n + 1]] - s[name] end
    return rates
  end }
  return { system, initial = initial, t = t }
end

local function decay(a, k) return a.ode { states = { "x" }, equations = function(s) return { x = -k * s.x } end } end

-- The sum of n data, each known to 1 %.
local function sum(a, n, each)
  local total = 0
  for _ = 1, n do total = total + a.around(each, "1%") end
  return total
end

local function case(name, title, fields)
  return { name = name, group = "extreme", title = title, source = fields.source or "closed form",
    question = fields.question or "simulate", quick = fields.quick or false,
    budget = { cpu = fields.cpu or 20, memory = fields.memory }, over = fields.over, make = fields.make,
    reference = fields.reference, expected = fields.expected }
end

local short = { { solver = "lohner", arithmetic = "interval", options = { step_max = 1e-6 } },
  { solver = "taylor_model", arithmetic = "interval", options = { step_max = 1e-6 } },
  { solver = "valencia", arithmetic = "interval", options = { step_max = 1e-6 } },
  { solver = "gsl", arithmetic = "real", options = { step_max = 1e-6 } } }

return {
  case("states_100", "100 states in a ring", { over = over.each(),
    make = function(a) return ring(a, 100, { 0, 1 }) end,
    expected = { default = "proved", stiff = "refused", gsl = "computed" } }),
  case("states_1000", "1000 states in a ring, with 1 GB", { over = over.each(), memory = 1e9,
    make = function(a) return ring(a, 1000, { 0, 1 }) end, expected = { default = "refused", gsl = "computed" } }),
  case("steps_million", "10^6 steps", { over = short, cpu = 30,
    make = function(a) return { decay(a, 1), initial = { x = 1 }, t = { 0, 1 }, keep = "last" } end,
    reference = { t = 1, x = { x = "[0.3678794411714423215, 0.3678794411714423216]" } },
    expected = { default = "proved", gsl = "computed" } }),
  case("states_times_steps", "10^6 steps of 1000 states, kept in 50 MB", {
    over = { { solver = "gsl", arithmetic = "real", options = { step_max = 1e-6 } } }, memory = 5e7,
    make = function(a) return ring(a, 1000, { 0, 1 }) end, expected = { default = "refused" } }),
  case("data_ten_thousand", "10^4 uncertain data in one equation", { over = over.each(), memory = 2e9,
    make = function(a) return { decay(a, sum(a, 10000, "1e-4")), initial = { x = 1 }, t = { 0, 1 } } end,
    expected = { default = "refused", gsl = "computed" } }),
  -- refused for want of memory, of which sanitized builds know no limit
  case("sum_of_ten_thousand", "The sum of 10^4 uncertain data", { question = "evaluate", quick = not core.is_sanitized,
    make = function(a) return { sum(a, 10000, 1) } end, reference = { t = 0, x = { value = "10000" } },
    expected = { interval = "proved", mpfr = "proved", real = "computed", default = "refused" } }),
}
