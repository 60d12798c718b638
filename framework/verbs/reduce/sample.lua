-- reduce/sample.lua -- the true error of a reduced model from inside: both models side by side in ordinary doubles, at
-- the same draws of the data, and the error of every output as a further state z = y(x) - y_r(x_r), z' = y' - y_r'. So
-- an error far below the outputs themselves is not lost in their digits. It proves nothing: what was found is at most
-- the true error (up to rounding), and a proved error is at least that.
local carry = require "ambit.verify.carry"
local check = require "ambit.check"
local compare_table = require "ambit.compare.table"
local core = require "ambit.core"
local fresh = require "ambit.fresh"
local number = require "ambit.report.number"
local reference = require "ambit.reduce.reference"
local session = require "ambit.session"

local sample = {}

local DRAWS, NODES = 200, 200

-- -- both models as one system

local function append(list, more) table.move(more, 1, #more, #list + 1, list) end

-- The reduced model on symbols of its own, so that both can be in one system.
local function renamed(model, used)
  local names, symbols = {}, {}
  for i, name in ipairs(model.states) do
    names[i] = fresh.name(name .. " of the reduced model", used)
    symbols[i] = core.symbol(names[i], model.units[i])
  end
  local outputs = {}
  for k, output in ipairs(model.outputs) do outputs[k] = output.expression end
  return { states = names, symbols = symbols, units = model.units,
    rates = core.substitute(model.rates, model.symbols, symbols),
    outputs = core.substitute(outputs, model.symbols, symbols) }
end

local function initial_of(model, given)
  local list = {}
  for i, name in ipairs(model.states) do
    list[i] = model.initial and model.initial[name] or given.initial[name]
  end
  return list
end

-- A further state that is the value of g along the solutions; nil where g has no derivative.
local function add_quantity(system, name, g)
  local rate = carry.rate_of(system, g)
  if not rate then return nil end
  local leaves, values = table.move(system.symbols, 1, system.count, 1, {}), {}
  table.move(system.initial, 1, system.count, 1, values)
  leaves[#leaves + 1], values[#values + 1] = core.time(), core.expression(system.t_start)
  local n = #system.states + 1
  name = fresh.name(name, fresh.set(system.states))
  system.states[n], system.units[n], system.symbols[n] = name, "1", core.symbol(name, "1")
  system.rates[n], system.initial[n] = rate, core.substitute({ g }, leaves, values)[1]
  return n
end

-- Both models in a scenario, with the places of what is asked of each output: { difference, detailed, reduced }.
local function coupled(detailed, reduced, given, criterion)
  local copy = renamed(reduced, fresh.set(detailed.states, reduced.states))
  local system = { states = {}, units = {}, symbols = {}, rates = {}, initial = {}, t_start = given.times[1] }
  for _, part in ipairs { detailed, copy } do
    append(system.states, part.states)
    append(system.units, part.units)
    append(system.symbols, part.symbols)
    append(system.rates, core.substitute(part.rates, given.leaves, given.values))
  end
  append(system.initial, initial_of(detailed, given))
  append(system.initial, initial_of(reduced, given))
  system.count = #system.states
  local places = {}
  for k, output in ipairs(detailed.outputs) do
    local y, yr = table.unpack(core.substitute({ output.expression, copy.outputs[k] }, given.leaves, given.values))
    places[k] = { difference = add_quantity(system, "error of " .. output.name, y - yr) }
    if criterion == "bounds" and places[k].difference then
      places[k].detailed = add_quantity(system, output.name .. " as detailed", y)
      places[k].reduced = add_quantity(system, output.name .. " as reduced", yr)
    end
  end
  return system, places
end

-- -- what the draws say

local function grid(times)
  local from, to, list = times[1], times[#times], {}
  for k = 0, NODES do list[k + 1] = from + (to - from) * (k / NODES) end
  list[NODES + 1] = to
  return list
end

-- How far off what is known of a hull only as its middle may be.
local function slack(x) return x.lo == x.hi and x.error == x.error and x.error or 0 end

local function magnitude(x) return x:is_empty() and 0 or math.max(0, x:mag() - slack(x)) end

-- How far apart the hulls are at their ends (equation 19).
local function apart(a, b)
  if a:is_empty() or b:is_empty() then return 0 end
  return math.max(0, math.max(math.abs(a.lo - b.lo), math.abs(a.hi - b.hi)) - slack(a) - slack(b))
end

-- Fills in what was found of an output: the difference over time, the greatest error and when it is.
local function measure(found, name, place, values)
  local curve = {}
  for i, time in ipairs(place.difference and found.t or {}) do
    curve[i] = magnitude(values(i, place.difference))
    local error = place.detailed and apart(values(i, place.detailed), values(i, place.reduced)) or curve[i]
    if not found.error[name] or error > found.error[name] then found.error[name], found.when[name] = error, time end
  end
  found.curve[name] = curve
end

-- One scenario: { name, t, error = { [output] = greatest }, when, curve = { [output] = { difference at t } }, failed }.
local function one(facts, given, t)
  local system, places = coupled(facts.detailed, facts.model, given, facts.criterion)
  local times, n = grid(given.times), #system.states
  local handle = core.system(system.states, system.units, system.symbols, system.rates)
  local hulls, outcome = core.sample_system({ system = handle, solver = core.default.draws,
    options = reference.options(handle, system.initial, times), initial = system.initial, times = times },
    { draws = t.draws, seed = t.seed, threads = t.threads })
  local found = { name = given.name, t = times, error = {}, when = {}, curve = {}, failed = outcome.failed,
    reason = outcome.reason, cpu_seconds = outcome.cpu_seconds }
  for k, output in ipairs(facts.detailed.outputs) do
    measure(found, output.name, places[k], function(i, place) return hulls[(i - 1) * n + place] end)
  end
  return found
end

-- -- the result

local Sample = { __name = "sampled error" }
Sample.__index = Sample

local function ratio(proved, sampled)
  if not proved or not sampled then return nil end
  if sampled == 0 then return proved == 0 and 1 or math.huge end
  return proved / sampled
end

function Sample.__tostring(self)
  local text = self.failed == 0 and "all reached the end" or ("%d did not reach the end"):format(self.failed)
  local cells = { { "output", "sampled", "proved", "proved / sampled", "at" } }
  for _, name in ipairs(self.outputs) do
    local error = self.error[name]
    cells[#cells + 1] = { name, error and number.rank(error) or "no derivative: not sampled",
      self.proved[name] and number.up(self.proved[name]) or "not proved",
      self.over[name] and number.rank(self.over[name]) or "", error and ("t = %s s%s"):format(
        number.time(self.when[name]), #self.scenarios > 1 and ", " .. self.worst[name] or "") or "" }
  end
  local lines = compare_table.aligned(cells, { { left = true }, {}, {}, {}, { left = true } })
  return ("sampled: %s with seed %d, %s\n  %s"):format(number.count(self.draws, "draw"), self.seed, text,
    table.concat(lines, "\n  "))
end

local function request(t, what)
  t = check.table(t == nil and {} or t, what)
  check.keys(t, { "draws", "seed", "threads" }, what)
  local seed = t.seed == nil and 1 or math.tointeger(t.seed)
  if not seed then check.fail("%s: seed: expected an integer, got %s", what, check.shown(t.seed)) end
  return { draws = check.count(t.draws == nil and DRAWS or t.draws, what .. ": draws"), seed = seed,
    threads = t.threads and check.count(t.threads, what .. ": threads") }
end

-- facts: { detailed, model, given, outputs, error, criterion }, of a reduction or a certificate
function sample.of(facts, t, what)
  t = request(t, what)
  local self = setmetatable({ status = "complete", outputs = facts.outputs, proved = facts.error or {}, draws = t.draws,
    seed = t.seed, failed = 0, error = {}, when = {}, worst = {}, over = {}, scenarios = {}, cpu_seconds = 0 }, Sample)
  for k, given in ipairs(facts.given) do
    local found = one(facts, given, t)
    self.scenarios[k] = found
    self.failed, self.cpu_seconds = self.failed + found.failed, self.cpu_seconds + found.cpu_seconds
    for _, name in ipairs(facts.outputs) do
      local error = found.error[name]
      if error and (not self.error[name] or error > self.error[name]) then
        self.error[name], self.when[name], self.worst[name] = error, found.when[name], found.name
      end
    end
  end
  for _, name in ipairs(facts.outputs) do self.over[name] = ratio(self.proved[name], self.error[name]) end
  session.finish("sample", self, {}, { "draws", t.draws, "seed", t.seed })
  return self
end

return sample
