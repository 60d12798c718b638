-- default_spec.lua -- what the interface says of a key that is missing, and of units, is what verbs do: with the
-- declared default a call gives what it gives without the key, and something else with another value.
local ambit = require "ambit"
local interface = require "ambit.interface"

local decay = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x } end }
local circle = ambit.ode { states = { "x", "v" }, equations = function(s) return { x = s.v, v = -s.x } end }
local van_der_pol = ambit.ode { states = { "x", "v" }, -- backwards in time
  equations = function(s) return { x = -s.v, v = s.x - (1 - s.x ^ 2) * s.v } end }
local function x_of(s) return s.x end

local function with(base, more)
  local t = {}
  for key, value in pairs(base) do t[key] = value end
  for key, value in pairs(more) do t[key] = value end
  return t
end

-- Enclosures by name, to the last digit, in the order of their names.
local function bounds(x)
  local names, list = {}, {}
  for name in pairs(x) do names[#names + 1] = name end
  table.sort(names)
  for i, name in ipairs(names) do list[i] = ("%s %a %a"):format(name, x[name].lo, x[name].hi) end
  return table.concat(list, ", ")
end

local function times(events)
  local list = {}
  for i, e in ipairs(events) do list[i] = ("%a %s"):format(e.t.lo, e.direction) end
  return table.concat(list, ", ")
end

local function seen(more)
  return times(ambit.simulate { circle, initial = { x = 1, v = 0 }, t = 7, events = { with({ g = x_of }, more) } }
    .events)
end

local function returned(more)
  local map = ambit.poincare(with({ circle, section = x_of, initial = { x = 1, v = 0 }, t_max = 5 }, more))
  return times(map.returns)
end

-- A ball that bounces: how often, and how far it comes.
local function bounced(request, guard)
  local fly = ambit.ode { states = { "y", "v" }, equations = function(s) return { y = s.v, v = -10 } end }
  guard = with({ g = function(s) return s.y end, to = "fly", reset = function(s) return { v = -s.v / 2 } end }, guard)
  local run = ambit.hybrid(with({ modes = { fly = { fly, guards = { guard } } }, initial = { y = 1, v = 0 }, t = 1 },
    request))
  return times(run.events) .. run.status
end

local function sampled(more)
  local controller = ambit.sampled(with({ period = "0.1", outputs = { "u" },
    law = function(s) return { u = -s.x } end }, more))
  local plant = ambit.ode { states = { "x" }, equations = function(s) return { x = s.u } end, sampled = controller }
  return bounds(ambit.simulate { plant, initial = { x = 1 }, t = 1 }.x)
end

local function reduced(more)
  local model = ambit.ode { states = { "x", "v" },
    equations = function(s) return { x = s.v, v = -s.x - s.v + s.x ^ 3 / 1000 } end }
  local r = ambit.reduce(with({ model, initial = { x = 1, v = 0 }, t = 1, outputs = { "x" }, error = { x = "0.1" } },
    more))
  return table.concat({ r.ranking, r.cluster, r.give_up, r.settings.levels, r.ode:text() }, " ")
end

local function certified(more, key)
  local slow = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x * "1.01" } end }
  local c = ambit.certify(with({ decay, slow, initial = { x = ambit.around(1, "1%", "x0") }, t = 1, outputs = { "x" },
    error = { x = 1 }, criterion = key == "nodes" and "bounds" or nil }, more))
  return ("%a"):format(c.error.x)
end

local function invariant(more)
  local set = ambit.invariant(with({ van_der_pol, about = { x = 0, v = 0 } }, more))
  return set.status .. bounds(set.box or {})
end

-- x' = -x + x^3: attracted from (-1, 1), so that cells near the ends are never all proved
local function attracted(more, key)
  local model = ambit.ode { states = { "x" }, equations = function(s) return { x = -s.x + s.x ^ 3 } end }
  local base = { model, about = { x = 0 }, within = { x = { -2, 2 } }, budget = key ~= "budget" and 10 or nil }
  local good, region = pcall(ambit.attraction, with(base, more))
  return good and ("%a %d"):format(region.share, #region.cells) or region
end

local function verified(more)
  local start = { x = ambit.around(1, "1%", "x0"), v = ambit.around(0, "0.01", "v0") }
  local v = ambit.verify(with({ circle, initial = start, t = 7,
    safe = function(s) return s.x ^ 2 + s.v ^ 2 - "1.0202" end }, more))
  return v.status .. v.refinements
end

local function drawn(more)
  local run = ambit.simulate { decay, initial = { x = ambit.around(1, "1%", "x0") }, t = { 0, 1 } }
  return run:plot(more):text "svg"
end

-- By class: { what a call gives with further keys, another value by key }.
local cases = {
  ["event"] = { seen, direction = "rising" },
  ["plot.options"] = { drawn, sample = 2, against = "x" },
  ["run.request"] = { function(more)
    return tostring(ambit.simulate(with({ circle, initial = { x = 1, v = 0 }, t = { 0, 1, 2 } }, more)):steps()().t_from)
  end, keep = "last" },
  ["poincare.request"] = { returned, direction = "rising", t_start = "0.5", returns = 2 },
  ["guard"] = { function(more) return bounced({}, more) end, direction = "rising" },
  ["hybrid.request"] = { function(more) return bounced(more, {}) end, switches_max = 1 },
  ["sample.request"] = { function(more, key)
    local base = { ambit.exp(ambit.between(0, 3, "d")), n = key ~= "n" and 100 or nil }
    for _, off in ipairs { "corners", "polish" } do if key ~= off then base[off] = false end end
    return bounds { ambit.sample(with(base, more)) }
  end, n = 10, seed = 2, corners = false, polish = false },
  ["verify.request"] = { verified, budget = 1 },
  ["invariant.request"] = { invariant, budget = 1 },
  ["attraction.request"] = { attracted, budget = 1, solver = "nobody" },
  ["roots.options"] = { function(more)
    local good, found = pcall(ambit.roots, with({ function(s) return s.x ^ 2 - 2 end, box = { x = { 0, 3 } } }, more))
    return good and found.solver .. found.arithmetic .. bounds { x = found.proved[1].x } or found
  end, solver = "nobody", arithmetic = "affine" },
  ["certify.problem"] = { function(more, key)
    return certified(more, key)
  end, criterion = "bounds", nodes = 3 },
  ["reduce.request"] = { reduced, ranking = "residual", cluster = 1, give_up = 2, levels = 0 },
  ["comparison.settings"] = { function(more)
    local s = ambit.compare(with({ }, more)).settings
    return table.concat({ s.repeats, s.limit, s.memory, s.seed }, " ")
  end, repeats = 1, limit = 1, memory = 1e8, seed = 2 },
  ["ode.request"] = { function(more)
    return tostring(pcall(ambit.ode, with({ states = { x = "m" },
      equations = function(s) return { x = s.x } end }, more)))
  end, check_units = false },
  ["map.request"] = { function(more)
    return tostring(pcall(ambit.map, with({ states = { x = "m" }, next = function(s) return { x = s.x ^ 2 } end }, more)))
  end, check_units = false },
  ["sampled.request"] = { sampled, delay = 1, start = "0.05" },
  ["network.layer"] = { function(more)
    return bounds { ambit.evaluate { ambit.network { with({ weights = { { 1 } } }, more) } { 2 } [1] } }
  end, activation = "tanh" },
}

describe("the default of", function()
  for _, entry in ipairs(interface.list) do
    for _, member in ipairs(entry.class and entry or {}) do
      if member.default then
        local key = interface.name(member)
        it(("`%s` in %s is %s"):format(key, entry.class, member.default), function()
          local case = assert(cases[entry.class], "no case for " .. entry.class)
          local value = assert(load("return " .. member.default))()
          local ask, other = case[1], case[key]
          assert.is_not_nil(other, "no other value for " .. key)
          local plain = ask({}, key)
          assert.equal(plain, ask({ [key] = value }, key))
          assert.not_equal(plain, ask({ [key] = other }, key))
        end)
      end
    end
  end
end)

describe("units", function()
  it("are declared of all times", function()
    local missing = {}
    for _, entry in ipairs(interface.list) do
      for _, member in ipairs(entry.class and entry or {}) do
        local key = interface.name(member)
        local is_time = key == "t" or key:find "^t_" or key:find "seconds" or key == "horizon"
        local is_number = member[2]:find "number" or member[2]:find "enclosure" or member[2]:find "datum"
        if is_time and is_number and not interface.parameters(member) and member.unit ~= "s" then
          missing[#missing + 1] = entry.class .. "." .. key
        end
      end
    end
    assert.same({}, missing)
  end)

  it("are those that a datum with a unit must have", function()
    local tried = 0
    local ask = { period = sampled, start = sampled, horizon = attracted }
    for _, entry in ipairs(interface.list) do
      for _, member in ipairs(entry.class and entry or {}) do
        local key = interface.name(member)
        if member.unit and ask[key] and member[2]:find "datum" then
          local function said(value)
            local good, found = pcall(ask[key], { [key] = value }, key)
            return tostring(found), good
          end
          assert.is_nil(said("0.1 " .. member.unit):find("kg", 1, true), key)
          assert.is_truthy(said("0.1 kg"):find("kg", 1, true), key)
          tried = tried + 1
        end
      end
    end
    assert.equal(3, tried)
  end)
end)
