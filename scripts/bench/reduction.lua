-- reduction.lua: what model reduction gains, what it proves and what it costs, over the scenes of this tree.
-- ambit run scripts/bench/reduction.lua [NAME ...]   prints tables; exit 1 if a required figure is missed. NAME: of a
-- scene, `clusters` or `rankings`; none: all. Times are CPU seconds of this one run: their ratios are what travels.
--
-- The reductions are those of the scenes themselves: each scene runs silently, and what it asks of ambit.reduce and
-- ambit.certify is listened to.
package.path = (arg[0]:match ".*/" or "./") .. "?.lua;" .. package.path
local ambit = require "ambit"
local core = require "ambit.core"
local bench = require "bench"
local reference = require "ambit.reduce.reference"

local function verdict(ok)
  if not ok then bench.missed = bench.missed + 1 end
  return ok and "reached" or "**missed**"
end

local function number(x) return x and ("%.3g"):format(x) or "-" end

-- What a scene asks of ambit.reduce, and of ambit.certify.
local function listen(name)
  local calls, proofs = {}, {}
  for _, call in ipairs(bench.listen(name, { "reduce", "certify" })) do
    local list = call.verb == "reduce" and calls or proofs
    list[#list + 1] = call
  end
  return calls, proofs
end

local function changed(t, changes)
  local copy = {}
  for key, value in pairs(t) do copy[key] = value end
  for key, value in pairs(changes) do copy[key] = value end
  return copy
end

-- -- run times

local REPEATS = 5

-- CPU seconds of one run of all equations of a model in a scenario, the least of several; nil: it did not come through.
local function seconds(model, given, solver, options)
  local initial, least = {}, nil
  for i, name in ipairs(model.states) do initial[i] = given.initial[name] end
  local rates = core.substitute(model.rates, given.leaves, given.values)
  local system = core.system(model.states, model.units, model.symbols, rates)
  for _ = 1, REPEATS do
    local _, facts = core.simulate { system = system, solver = solver, initial = initial, times = given.times,
      options = options or reference.options(system, initial, given.times) }
    if facts.status ~= "complete" then return nil end
    least = math.min(least or math.huge, facts.cpu_seconds)
  end
  return least
end

local function speed_up(result, solver, options)
  local before = seconds(result.detailed, result.given[1], solver, options)
  local after = seconds(result.model, result.given[1], solver, options)
  return before and after and after > 0 and before / after
end

-- -- the table of all scenes

local scenes = { -- name, is every reduction in it that of a linear system?
  { "one_track" }, { "two_track" }, { "reduce_double_pendulum" }, { "reduce_ur5" }, { "rc_ladder", linear = true },
  { "pollu" }, { "reduce_arm" },
}

local function of(before, after) return ("%d -> %d"):format(before, after) end

local ROUNDING = 1e-10 -- of the sampled runs, which are ordinary ones

-- The output that takes most of its bound.
local function tightest(result)
  local worst, share = 1, -1
  for k, name in ipairs(result.outputs) do
    local part = (result.error[name] or math.huge) / result.bounds[k]
    if part > share then worst, share = k, part end
  end
  return result.outputs[worst], result.bounds[worst]
end

local function row_of(title, result, linear)
  local sampled = result:sample { draws = 200 }
  local name, bound = tightest(result)
  local over, settings = sampled.over[name], result.settings
  local solver = settings.solver or "lohner"
  local inside = (sampled.error[name] or 0) <= 1.001 * (result.error[name] or 0) + ROUNDING
  local ok = result.error[name] and result.error[name] <= bound and inside and not (linear and over and over > 2)
  bench.line(title,
    of(result.terms_before, result.terms_after), of(result.equations_before, result.equations_after),
    of(result.operations_before, result.operations_after), number(speed_up(result, "gsl")),
    number(speed_up(result, solver, settings.options)), number(bound), number(result.error[name]),
    number(sampled.error[name]), number(over), result.proofs, number(result.cpu_seconds), verdict(ok))
end

local function table_of_scenes()
  bench.head("reduction", "terms", "equations", "operations", "gsl x", "validated x",
    "bound", "proved", "sampled", "proved / sampled", "proofs", "s", "")
  local certificates = {}
  local function measure(scene)
    local calls, proofs = listen(scene[1])
    for k, call in ipairs(calls) do
      local title = #calls == 1 and scene[1] or ("%s %d"):format(scene[1], k)
      row_of(title, call.result, scene.linear)
    end
    for k, call in ipairs(proofs) do
      certificates[#certificates + 1] = { ("%s %d: %s"):format(scene[1], k, call.t[2].name), call.result }
    end
  end
  for _, scene in ipairs(scenes) do
    if bench.wants(scene[1]) then
      local good, problem = pcall(measure, scene)
      if not good then bench.line(scene[1], tostring(problem), verdict(false)) end
    end
  end
  return certificates
end

-- Models that scenes prove without a search.
local function table_of_certificates(certificates)
  if #certificates == 0 then return end
  print()
  bench.head("given model", "criterion", "output", "bound", "proved", "sampled", "proved / sampled", "verdict")
  for _, entry in ipairs(certificates) do
    local c = entry[2]
    local sampled = c:sample { draws = 200 }
    for _, name in ipairs(c.outputs) do
      bench.line(entry[1], c.criterion, name, number(c.bounds[name]),
        number(c.error[name]), number(sampled.error[name]), number(sampled.over[name]), c.status)
    end
  end
end

-- -- clusters against one by one, and what the residual ranking costs

local function clusters()
  print()
  bench.head("50-stage RC ladder", "required", "measured", "")
  local t = listen("rc_ladder")[1].t
  local single = ambit.reduce(changed(t, { strategy = "clusters", cluster = 1, give_up = math.huge }))
  local paper = ambit.reduce(changed(t, { ranking = "residual", strategy = "clusters", give_up = math.huge }))
  local many = ambit.reduce(t)
  bench.figure("proofs, one by one / clusters as predicted", "at least 5", ("%d / %d = %s"):format(single.proofs,
    many.proofs, number(single.proofs / many.proofs)), single.proofs >= 5 * many.proofs)
  bench.line("proofs, clusters within a factor of 10 of the residual", "", paper.proofs, "")
  bench.line("terms left, one by one / predicted / by the residual", "", ("%d / %d / %d"):format(single.terms_after,
    many.terms_after, paper.terms_after), "")
  local run = seconds(paper.detailed, paper.given[1], paper.settings.solver or "lohner", paper.settings.options)
  local rank = paper.cpu_seconds_rank / math.max(#paper.rankings, 1)
  bench.figure("residual ranking of a pass / one validated run", "below 1", ("%s s / %s s = %s"):format(number(rank),
    number(run), number(rank / run)), rank < run)
end

-- -- rankings against the exact one

local function rankings()
  print()
  bench.head("ranking against exact effect (Spearman)", "pass", "candidates", "residual", "one_step", "adjoint",
    "lowered_order")
  for _, name in ipairs { "rc_ladder", "reduce_double_pendulum", "one_track" } do
    local call = listen(name)[1]
    local result = ambit.reduce(changed(call.t, { reductions = { "neglect" },
      ranking = { "residual", "one_step", "adjoint", "lowered_order", "exact" } }))
    local passes, order = {}, {}
    for _, row in ipairs(result:judge()) do
      if not passes[row.pass] then
        passes[row.pass] = { candidates = row.candidates }
        order[#order + 1] = row.pass
      end
      passes[row.pass][row.ranking] = row.correlation
    end
    for _, pass in ipairs(order) do
      local p = passes[pass]
      bench.line(name, pass, p.candidates, number(p.residual),
        number(p.one_step), number(p.adjoint), number(p.lowered_order))
    end
  end
end

table_of_certificates(table_of_scenes())
if bench.wants "clusters" then clusters() end
if bench.wants "rankings" then rankings() end
bench.leave()
