-- sample/overestimation.lua -- an enclosure held against the hull of a sample: how many times as wide it is, and
-- whether it misses what was seen.
--
-- The true range lies between the enclosure and the hull made smaller by the error of the samples. So the ratio of
-- their widths is never less than the true overestimation, and tends to it as the hull comes near the range; an
-- enclosure that does not contain that smaller hull is wrong.
local check = require "ambit.check"
local core = require "ambit.core"

local over = {}

-- A hull is a sampled range: { lo, hi, error }, made smaller by its error already
-- (framework/verbs/sample/sampled_lua.h); where it is nothing but error, lo = hi is off by `error`.

-- Width of the enclosure per width of the hull; nil: the hull is empty or nothing but error, so it says nothing.
function over.factor(enclosure, hull)
  local sure = hull.hi - hull.lo
  if not (sure > 0) then return nil end
  return enclosure:width() / sure
end

-- Does the enclosure miss a value that was seen, by more than `times` (1) what it may be off? Unknown errors excuse
-- everything.
function over.misses(enclosure, hull, times)
  local lo, hi, error = hull.lo, hull.hi, hull.error
  if not (hi >= lo) or not error or error ~= error then return false end
  if enclosure:is_empty() then return true end
  local more = error == 0 and 0 or ((times or 1) - (lo < hi and 1 or 0)) * error
  return enclosure.lo > lo + more or enclosure.hi < hi - more
end

local function complaint(name, enclosure, hull, when)
  return ("%s%s: the enclosure %s misses sampled values from %s to %s"):format(name, when or "", enclosure:text(17),
    core.literal(hull.lo), core.literal(hull.hi))
end

-- -- runs

-- The tight enclosures of a run at t by state name; nil: there are only those of whole steps, or none.
local function of_run(run, t)
  if t == run.t_start then return run.initial() end
  local i, is_end = core.track_find(run.track, t)
  if not i or not (is_end or core.track_dense(run.track, i, 1, t)) then return nil end
  return run:at(t)
end

local function factors(run, enclosures, hulls)
  local list = {}
  for _, name in ipairs(run.states) do list[name] = over.factor(enclosures[name], hulls[name]) end
  return list
end

local Over = { __name = "overestimation" }
local methods = {}

-- By state name at one of the times of the sample.
function methods:at(t)
  local facts = getmetatable(self).facts
  local hulls, enclosures = facts.sample:at(t), of_run(facts.run, t)
  if not enclosures then
    check.fail("at: the run has no tight enclosure at t = %s: put it into the list of times, or simulate with " ..
      "dense = true", core.literal(t))
  end
  return factors(facts.run, enclosures, hulls)
end

local function text(self)
  local list = {}
  for _, name in ipairs(check.sorted(self)) do list[#list + 1] = ("%s: %.4g"):format(name, self[name]) end
  return table.concat(list, ", ")
end

local function check_pair(run, sample)
  if type(sample) ~= "table" or type(sample.at) ~= "function" or not sample.states then
    check.fail("overestimation: expected what ambit.sample made of the same system, got %s", check.kind(sample))
  end
  for i, name in ipairs(run.states) do
    if sample.states[i] ~= name then
      check.fail("overestimation: the run has the states %s, the sample %s", table.concat(run.states, ", "),
        table.concat(sample.states, ", "))
    end
  end
end

-- { [state] = factor at the last common time }; besides .max (by state, the largest over the common times), .t (the
-- last one), .contradiction (text or nil), :at(t). States whose hull has no width are left out.
function over.of_run(run, sample)
  check_pair(run, sample)
  local facts, final = { run = run, sample = sample, max = {} }, {}
  for _, t in ipairs(sample.t) do
    local enclosures = of_run(run, t)
    if enclosures then
      local hulls = sample:at(t)
      final, facts.t = factors(run, enclosures, hulls), t
      for _, name in ipairs(run.states) do
        local hull = hulls[name]
        if final[name] then facts.max[name] = math.max(facts.max[name] or 0, final[name]) end
        if not facts.contradiction and run.rigorous and over.misses(enclosures[name], hull) then
          facts.contradiction = complaint(name, enclosures[name], hull, " at t = " .. core.literal(t))
        end
      end
    end
  end
  if not facts.t then
    check.fail("overestimation: the run has no tight enclosure at any time of the sample; list the same times in both")
  end
  return setmetatable(final, { __name = Over.__name, facts = facts, __tostring = text,
    __index = function(_, key) return methods[key] or facts[key] end })
end

-- -- results of evaluate

local function at_path(path) return path == "" and "" or " at " .. path:gsub("%.$", "") end

local function walk(result, sample, visit, path)
  if type(result) ~= "table" then
    if check.kind(result) ~= "enclosure" then
      check.fail("overestimation: expected what ambit.evaluate or ambit.simulate gave%s, got %s", at_path(path),
        check.kind(result))
    elseif check.kind(sample) ~= "enclosure" then
      check.fail("overestimation: expected what ambit.sample made of the same%s, got %s", at_path(path),
        check.kind(sample))
    end
    return visit(result, sample, path)
  end
  local list = {}
  for _, key in ipairs(check.sorted(result)) do
    local inner = type(sample) == "table" and sample[key]
    if inner == nil or inner == false then
      check.fail("overestimation: the sample has nothing at %s", path .. tostring(key))
    end
    list[key] = walk(result[key], inner, visit, path .. tostring(key) .. ".")
  end
  return list
end

-- Of what evaluate gave, in its shape: factors.
function over.of_result(result, sample) return walk(result, sample, over.factor, "") end

-- A run, or what evaluate gave, against a sample -> text that says what is missed and by how much, or nil.
function over.contradiction(result, sample)
  if type(result) == "table" and result.track then return over.of_run(result, sample).contradiction end
  local found
  walk(result, sample, function(x, hull, path)
    if not found and over.misses(x, hull) then found = complaint((path:gsub("%.$", "")), x, hull) end
  end, "")
  return found
end

-- The sampled range of an inner hull (sample.inner), of one state or result at one of its times.
function over.hull_of(inner, i, k) return { lo = inner.lo[i][k], hi = inner.hi[i][k], error = inner.error[i][k] } end

-- The factor of an enclosure against it, and what it misses as text, or nil.
function over.of_inner(inner, i, k, enclosure, name)
  local hull = over.hull_of(inner, i, k)
  return over.factor(enclosure, hull), over.misses(enclosure, hull) and complaint(name, enclosure, hull) or nil
end

-- ambit.overestimation(result, sample)
function over.overestimation(result, sample)
  if type(result) == "table" and result.track then return over.of_run(result, sample) end
  return over.of_result(result, sample)
end

return over
