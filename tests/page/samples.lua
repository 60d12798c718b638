-- samples.lua -- comparisons and results of the stability suite as their commands make them, of made-up numbers: the
-- usual ones, and whatever a page has to bear.
local samples = {}

local huge, nan = math.huge, 0 / 0

-- -- plots of a run

local function plotted(options)
  local ambit = require "ambit"
  local run = ambit.simulate { ambit.ode { states = { x = "m", ["<b>v"] = "m/s" }, equations = function(s)
    return { x = s["<b>v"], ["<b>v"] = -s.x / "1 s^2" }
  end }, initial = { x = ambit.around("1 m", "5%"), ["<b>v"] = 0 }, t = { 0, 3 } }
  options[1], options.title = run, "</script><b>a title"
  return ambit.plot(options)
end

function samples.over_time() return plotted { limits = { x = { "-2 m", "2 m" }, ["<b>v"] = { "0 m/s" } } } end

function samples.plane() return plotted { against = "x" } end

-- -- comparisons

-- Enclosures of a decaying swing, w wide at the start, at so many instants; with_tube: and between them.
local function track(names, w, rate, count, with_tube)
  local t, lo, hi, tube = {}, {}, {}, { lo = {}, hi = {} }
  for k = 1, #names do
    lo[k], hi[k], tube.lo[k], tube.hi[k] = {}, {}, {}, {}
    for i = 1, count do
      local function x(at) return math.cos(k * at) * math.exp(-at / 3) end
      local at, h = 4 * (i - 1) / (count - 1), 4 / (count - 1)
      local r = w * k * math.exp(rate * (at + h))
      local least, most = math.huge, -math.huge
      for j = 0, 16 do least, most = math.min(least, x(at + h * j / 16)), math.max(most, x(at + h * j / 16)) end
      t[i], lo[k][i], hi[k][i] = at, x(at) - r, x(at) + r
      if i < count then tube.lo[k][i], tube.hi[k][i] = least - r - k * h * h, most + r + k * h * h end
    end
  end
  return { t = t, lo = lo, hi = hi, tube = with_tube and tube or nil }
end

local function row(names, family, order, width, seconds)
  return { label = ("%s, order %d"):format(family, order), family = family, solver = family:match "%S+",
    arithmetic = "interval", options = { "order", tostring(order) }, axis = "order", value = order, rigorous = true,
    status = "complete", t_reached = 4, seconds_run = seconds, seconds_build = 2e-4, repeats = 3, steps = 100 // order,
    memory = 1200000 + 1000 * order, width = width, width_max = 1.5 * width, over_tightest = width / 1e-9,
    over_sample = 1 + width * 1e8, over_sample_max = 2 + width * 1e8, error = width / 3,
    work = { evaluations = 1000 * order, operations = 123456 * order, seconds_run = seconds },
    track = track(names, width / 2, 0.2, 70 + order % 23, true) } -- each has instants of its own
end

local function fail(from, status, reason, t)
  from.status, from.reason, from.t_reached = status, reason, t
  for _, name in ipairs { "width", "width_max", "over_tightest", "over_sample", "over_sample_max", "error" } do
    from[name] = nil
  end
  return from
end

local function pendulum(names)
  local rows = {}
  for k, family in ipairs { "lohner interval", "taylor_model", "valencia affine" } do
    for order = 5, 25, 5 do
      rows[#rows + 1] = row(names, family, order, 1e-3 * 10 ^ (-order / (2 + k)), 1e-3 * k * order)
    end
  end
  for order = 1, 5 do rows[order].pareto = true end -- the fastest for each width
  rows[#rows + 1] = fail(row(names, "valencia interval", 5, 1, 0.08), "unable",
    "the enclosure grew wider than 1e3 at t = 1.25; reduce the tolerances or take solver \"lohner\"", 1.25)
  rows[#rows].track = track(names, 1e-3, 4, 30) -- says nothing between its steps
  rows[#rows + 1] = fail(row(names, "krawczyk", 1, 1, 0), "refused", "solves no differential equation", nil)
  rows[#rows].seconds_run, rows[#rows].track = nil, nil
  for order = 2, 8, 3 do
    local real = row(names, "gsl", order, 1, 2e-4 * order)
    real.error, real.rigorous, real.width, real.over_sample, real.track = 10.0 ^ -(2 + order), false, nil, nil, nil
    rows[#rows + 1] = real
  end
  return rows
end

-- A usual comparison.
function samples.usual(title)
  local names = { "beta1", "beta2", "omega1", "omega2" }
  local reference = { t = { 0, 2, 4 }, x = {}, source = "50 digits" }
  for k, name in ipairs(names) do
    reference.x[name] = {}
    for i, t in ipairs(reference.t) do reference.x[name][i] = math.cos(k * t) * math.exp(-t / 3) end
  end
  local sample = track(names, 4e-4, 0.1, 60)
  sample.draws, sample.failed, sample.error = 1000, 2, {}
  for k in ipairs(names) do
    sample.error[k] = {}
    for i in ipairs(sample.t) do sample.error[k][i] = 1e-9 end
  end
  sample.hi[1][31] = sample.lo[1][31] -- nothing but error
  return { verb = "simulate", place = "double_pendulum.lua:41", title = title or "double pendulum", t = { 0, 4 },
    names = names, measure = "width", units = { "rad", "rad", "rad/s", "rad/s" }, status = "complete",
    advice = "For widths down to 1e-4 take lohner interval, order 5 (5 ms); for the tightest take lohner interval, "
      .. "order 25: no other is tighter, and it takes 25 ms.",
    settings = { repeats = 3, limit = 10, n = 1000, seed = 1 }, cpu_seconds = 1.25, rows = pendulum(names),
    sample = sample, reference = reference }
end

-- All final widths are the same but for little; what was widest on the way is not.
function samples.alike()
  local comparison = samples.usual("a fold")
  for i, one in ipairs(comparison.rows) do
    one.error, one.pareto = nil, nil
    one.width = one.width and 1.27 + 1e-5 * i
    one.width_max, one.over_sample, one.over_sample_max = one.width, one.width, one.width and 1 + 0.3 * i
  end
  comparison.reference = nil
  return comparison
end

local wicked = "</script><script>window.owned = 1</script><!-- & \"double\" 'single' \xff\0\n\u{2028} @DATA@ %1"

-- Names of any bytes; widths of zero, without bound, and no numbers; one instant.
function samples.odd()
  local names = { wicked, "" }
  local list = { row(names, wicked, 1, 0, 0), row(names, wicked, 2, huge, 1e-3), row(names, "nan", 3, nan, nan),
    row(names, "tiny", 4, 5e-324, 1e-9), row(names, "vast", 5, 1e308, 1e5), row(names, "none", 6, nil or 1, 1) }
  list[3].track = { t = { 0, nan, 2 }, lo = { { -1, nan, -huge }, { nan, nan, nan } }, hi = { { 1, nan, huge }, {} } }
  list[4].track = { t = { 1 }, lo = { { 1 }, { 2 } }, hi = { { 1 }, { 2 } } }
  list[5].track = { t = {}, lo = {}, hi = {} }
  list[6].width, list[6].status, list[6].reason, list[6].label = nil, "out of memory", wicked, wicked
  return { verb = "evaluate", place = wicked, title = wicked, names = names, units = {}, status = "complete",
    advice = { wicked, "A second sentence." }, settings = wicked, rows = list, interrupted = true }
end

-- Enclosures at one instant: some of no width, without bounds, of nothing.
function samples.evaluated()
  local bounds = { { -1, 1.5 }, { -1.1, 1.4 }, { -huge, huge }, { huge, -huge }, { -1, 1e300 }, { 0, 0 } }
  local rows = {}
  for i, x in ipairs(bounds) do
    rows[i] = row({}, "arithmetic " .. i, i, math.max(x[2] - x[1], 0), 1e-6 * i)
    rows[i].track, rows[i].enclosures = nil, { { lo = x[1], hi = x[2] }, { lo = 1, hi = 1 } }
  end
  return { verb = "evaluate", place = "arm.lua:3", title = "an arm", names = { "x", "" },
    units = { "m", "" }, rows = rows, measure = "over_sample", status = "complete",
    sample = { t = { 0 }, lo = { { -0.9 }, { huge } }, hi = { { 1.2 }, { -huge } }, draws = 1000, failed = 0 } }
end

function samples.failed()
  local names, rows = { "x" }, {}
  for i, status in ipairs { "unable", "crashed", "late", "out of memory", "stopped", "failed", "refused", "skipped" } do
    rows[i] = fail(row(names, "solver " .. i, 4, 1, 10.0 ^ -i), status, "the reason of " .. status, 0.1 * i)
    rows[i].track = nil
  end
  rows[2].seconds_run = nil
  return { verb = "simulate", place = "failed.lua:1", title = "all failed", t = { 0, 1 }, names = names,
    units = { "m" }, status = "unable", reason = "no combination could prove anything", rows = rows }
end

function samples.single()
  local comparison = samples.usual "one row"
  comparison.rows, comparison.sample, comparison.reference, comparison.settings = { comparison.rows[2] }, nil, nil, nil
  comparison.advice = nil
  return comparison
end

function samples.empty()
  return { verb = "simulate", place = "empty.lua:1", title = "no rows", names = {}, rows = {} }
end

function samples.many()
  local comparison, names = samples.usual "two hundred rows", {}
  for i = 1, 20 do names[i] = "q" .. i end
  comparison.names, comparison.units, comparison.rows, comparison.sample, comparison.reference = names, {}, {}, nil, nil
  for i = 1, 200 do
    local family = ("solver %d"):format(1 + (i - 1) // 10)
    comparison.rows[i] = row(names, family, i % 10 + 1, 10.0 ^ -(i % 13), 1e-4 * i)
    comparison.rows[i].track = i % 20 == 0 and track(names, 1e-3, 0.1, 200) or nil
  end
  return comparison
end

-- -- results of the stability suite

local outcomes = { "proved", "proved", "computed", "unable", "refused", "late", "out of memory", "crashed", "wrong" }

local function suite_row(i, name)
  local what = outcomes[(i * 7) % #outcomes + 1]
  local bad = what == "crashed" or what == "wrong"
  local row = { solver = ({ "lohner", "taylor_model", "valencia", "stiff" })[i % 4 + 1],
    arithmetic = i % 3 == 0 and "affine" or "interval", options = i % 5 == 0 and "order = 20" or "", outcome = what,
    t_reached = what == "unable" and 12.5 or 40, t_end = 40, seconds = 0.01 * i, steps = 31 * i, memory = 1e6 * i,
    expected = bad and "proved" or what, verdict = bad and "changed" or "as expected",
    changed = bad and what or nil, least = i % 2 == 0 and { t_reached = 40, digits = 4 } or nil }
  if what == "proved" then row.width, row.digits = 10.0 ^ -(i % 9), i % 9 + 0.25 end
  if what == "unable" then row.reason = "at t = 12.5 the enclosure of " .. name .. " grew too wide: raise `order`" end
  return row
end

-- cases of three groups, with rows each
function samples.suite(cases, rows)
  local result = { quick = true, version = "0.1.0", cpu_seconds = 12.5, changed = 0, cases = {} }
  for i = 1, cases do
    local case = { name = "case_" .. i, group = ({ "stiff", "chaotic", "extreme" })[(i - 1) % 3 + 1],
      title = ("Problem %d of the test set"):format(i), source = "Hairer, Wanner: Solving ODEs II, 1996, p. " .. i,
      question = "simulate", rows = {} }
    for k = 1, rows do
      case.rows[k] = suite_row(i + k, case.name)
      if case.rows[k].verdict == "changed" then result.changed = result.changed + 1 end
    end
    result.cases[i] = case
  end
  return result
end

function samples.odd_suite()
  local result = samples.suite(1, 1)
  result.quick, result.interrupted = false, true
  result.cases[1] = { name = wicked, group = wicked, title = wicked, source = wicked, question = wicked, rows = {
    { solver = wicked, arithmetic = wicked, options = wicked, outcome = "wrong", reason = wicked, t_reached = nan,
      t_end = 1, width = nan, digits = -huge, seconds = 0, steps = 0, memory = 0, verdict = "changed",
      changed = wicked },
    { solver = "lohner", outcome = "proved", t_reached = huge, t_end = 0, width = huge, digits = huge,
      verdict = "better" }, { outcome = "an outcome of tomorrow", width = 0, verdict = "as expected" } } }
  return result
end

function samples.empty_suite() return { quick = true, version = "0.1.0", cpu_seconds = 0, changed = 0, cases = {} } end

return samples
