-- simulate/choice.lua -- a run whose solver nobody named: the one that suits best, and a way back. Where it ends early,
-- makes no way, or completes with sets far wider than they need be, the next best one goes on. docs/choosing.md says
-- when.
--
-- Every piece is a proof of its own; nothing here decides what is true, only who is asked next.
local core = require "ambit.core"
local ode = require "ambit.ode"
local option = require "ambit.option"

local choice = {}

local LOOSE = 1.5       -- times the sampled hull: what is wider is worth another solver ...
local TIGHT = 1.2       -- ... and from what is not, another one can go on
local PATIENCE = 2      -- s of CPU time after which it is asked whether the end is in reach
local MORE, LEAST = 4, 8 -- CPU time of all that follows the first run: so many times its own, and at least so many s
local REACH = 8         -- times what a steady try has taken, that its rest may take for it to go on
local CUT, WORK = 24, 1e9 -- operations of the parts of a run that came to the end: times its own, and at least so many
local PART = 0.5        -- of what is left of that: what one try has without question, or one hull of draws
local AGAIN = 2         -- times what a run took that was stopped for its pace, after which it must be steady
local TOO_FAR = "unable.short-steps"
local PIECES = { 8, 64 } -- into which the data are cut where every solver fails
local RUNS = 320        -- of parts of the data, at most, where a solver gets through but is too wide
local DRAWS, MOST = 8, 128 -- draws of the hull for each datum, and at most
local VISIBLE = 1e-6    -- width of a hull, in parts of its state, below which it is mostly rounding
local NEGLIGIBLE = 1e-9 -- the same in parts of the largest state with the same unit: nobody sees a link move 1e-10 rad
                        -- where others turn by 1
local FURTHER = 1e-6    -- of the whole time, by which one run gets further than another
local SHARE = 0.01      -- of a state's widest hull, below which its width at a time does not matter

-- -- how wide is it?

-- The listed times that the run reached, on its clock.
local function times_of(run)
  local list = { run.times[1] }
  local forward = run.times[#run.times] >= run.times[1]
  for i = 2, #run.times do
    local t = run.times[i]
    if forward and t <= run.t_reached or not forward and t >= run.t_reached then list[#list + 1] = t end
  end
  if list[#list] ~= run.t_reached then list[#list + 1] = run.t_reached end
  return list
end

local function tight_at(run, t)
  local i, is_end = core.track_find(run.track, t)
  return i and is_end and i
end

-- The widest set of state i at the listed times.
local function widest_of(run, i)
  local widest = 0
  for _, t in ipairs(times_of(run)) do
    local step = tight_at(run, t)
    if step then widest = math.max(widest, core.track_value(run.track, step, i):width()) end
  end
  return widest
end

-- Of each state the width from which on it counts beside others that are measured in the same unit; size(i): how large
-- state i is. Of states whose unit nobody said each counts for itself.
local function least_widths(run, size)
  local largest, least = {}, {}
  for i in ipairs(run.states) do
    local unit = ode.unit(run.system, i)
    if unit then largest[unit] = math.max(largest[unit] or 0, size(i)) end
  end
  for i in ipairs(run.states) do least[i] = NEGLIGIBLE * (largest[ode.unit(run.system, i) or ""] or 0) end
  return least
end

-- Are all sets at the end hardly wider than they are to first order in the data? Then they are tight, and nothing need
-- be drawn to see it. A state that has come to rest, whose set was far wider before, does not count. A solver whose set
-- is not a function of the data says nothing about it.
local function is_plainly_tight(run)
  local linear = core.track_linear(run.track)
  if not linear then return false end
  local least = least_widths(run, function(i) return run.x[run.states[i]]:mag() end)
  for i, name in ipairs(run.states) do
    local x = run.x[name]
    local width = x:width()
    local counts = width > VISIBLE * x:mag() and width > least[i]
    if counts and width > LOOSE * linear[i] and width >= SHARE * widest_of(run, i) then
      return false
    end
  end
  return true
end

-- The hull of draws at these times by state, or nil if there is none, or none in so many seconds: { t, lo = { [state] =
-- { [time] } }, hi }.
local function hull_of(q, times, unknowns, seconds)
  local inner = require "ambit.sample".inner(q, math.min(MOST, DRAWS * (unknowns + 2)), 1,
    { t = times, threads = 1, cpu = seconds })
  return inner and inner.failed == 0 and inner or nil
end

-- counts(i, k): does state i count at time k of the hull: is it seen to be wide there?
local function counted(run, hull)
  local widths, sizes = {}, {}
  for i in ipairs(run.states) do
    widths[i], sizes[i] = 0, 0
    for k = 2, #hull.t do
      local lo, hi = hull.lo[i][k], hull.hi[i][k]
      widths[i], sizes[i] = math.max(widths[i], hi - lo), math.max(sizes[i], math.abs(lo), math.abs(hi))
    end
  end
  local least = least_widths(run, function(i) return sizes[i] end)
  return function(i, k)
    local widest = widths[i]
    return widest > VISIBLE * sizes[i] and widest > least[i] and hull.hi[i][k] - hull.lo[i][k] >= SHARE * widest
  end
end

-- The largest factor of width by sampled width, of which state, and when; nil: not known.
local function worst(run, hull)
  local most, which, when
  local counts = counted(run, hull)
  for i, name in ipairs(run.states) do
    for k = 2, #hull.t do
      local step = tight_at(run, hull.t[k])
      local width = hull.hi[i][k] - hull.lo[i][k]
      local factor = step and counts(i, k) and core.track_value(run.track, step, i):width() / width
      if factor and (not most or factor > most) then most, which, when = factor, name, hull.t[k] end
    end
  end
  return most, which, when
end

-- run.overestimate of a run that nobody has looked at yet: estimated, not proved; nil: nothing is uncertain, or no
-- sample reaches the end.
function choice.overestimate(run, q)
  local unknowns = run.report and run.report.unknowns or 0
  if unknowns == 0 or #times_of(run) < 2 then return nil end
  local hull = hull_of(q, times_of(run), unknowns)
  if hull then return worst(run, hull) end
end

-- Did it come to the end? "partial": it is not certain which events happen.
local function is_through(run) return run.status == "complete" or run.status == "partial" end

-- -- the CPU time of everything that follows the first run

-- Other solvers may take half of it, so that there is as much for cutting the data.
local function budget_after(seconds) return core.cpu() + math.max(LEAST, MORE * seconds) / 2 end

local function budget_of_parts(state)
  return math.max(core.cpu(), state.ends) + math.max(LEAST, MORE * state.first_seconds) / 2
end

-- What the next try or hull has of it; not positive: nothing is left.
local function part_of(ends, is_last) return (is_last and 1 or PART) * (ends - core.cpu()) end

-- -- who goes on?

-- Those of the list that prove their results, one by one: each is loaded when it is its turn.
function choice.proving(list)
  local i = 0
  return function()
    repeat i = i + 1 until not list[i] or option.declaration("solver", list[i].solver).rigorous
    return list[i]
  end
end

-- Calls `run` with the CPU time of this process limited, within a limit that holds already. Was this limit reached?
function choice.within(seconds, run)
  local outer = core.deadline(nil)
  local own = core.cpu() + seconds
  core.deadline(outer and math.min(outer, own) or own)
  local good, problem = pcall(run)
  core.deadline(outer)
  if not good then error(problem, 0) end
  return not (outer and core.cpu() >= outer) and core.cpu() >= own
end

local function describe(run)
  if run.status == "complete" and run.overestimate then
    return ("complete, with sets about %.3g times as wide as sampled ones"):format(run.overestimate)
  end
  return ("%s at t = %s"):format(run.status, core.literal(run.t_reached))
end

-- Is `run` better than `best`? Whoever got further; of complete ones, the narrower.
local function is_better(run, best)
  if run.status == "complete" and best.status == "complete" then
    return (run.overestimate or math.huge) < (best.overestimate or math.huge)
  end
  if run.status == "complete" or best.status == "complete" then return run.status == "complete" end
  local first, last = run.times[1], run.times[#run.times]
  return math.abs(run.t_reached - first) > math.abs(best.t_reached - first) + FURTHER * math.abs(last - first)
end

-- Sets what is known of the width; a run that came to the end needs no other solver if that is little.
local function judge(run, q, hull, ends)
  if not is_through(run) then return false end
  local is_tight = run.report.unknowns == 0 or is_plainly_tight(run)
  if is_tight and not hull.made then return true end
  if not hull.made and part_of(ends) <= 0 then return true end
  if not hull.made then hull.made, hull.draws = true, hull_of(q, times_of(run), run.report.unknowns, part_of(ends)) end
  if not hull.draws then return true end -- nothing to hold it against
  run.overestimate = worst(run, hull.draws)
  return is_tight or not run.overestimate or run.overestimate <= LOOSE
end

-- Can a run that ended early be gone on from: is what it reached still tight, and are its times those of the scene?
local function goes_on(run, q, ends)
  local times = q.times
  if run.status ~= "unable" or q.events or times.shift or times.final or run.t_reached == times[1] then return false end
  local unknowns = run.report.unknowns
  if unknowns == 0 or not core.track_set(run.track) or part_of(ends) <= 0 then return false end
  local hull = hull_of(q, times_of(run), unknowns, part_of(ends))
  local factor = hull and worst(run, hull)
  return factor and factor <= TIGHT
end

-- The request of what is left of a run.
local function rest_of(q, run)
  local times, initial, set = { run.t_reached }, {}, run:set()
  local forward = q.times[#q.times] > q.times[1]
  for _, t in ipairs(q.times) do
    if forward and t > run.t_reached or not forward and t < run.t_reached then times[#times + 1] = t end
  end
  for i, name in ipairs(q.system.states) do initial[i] = set[name] end
  return { initial = initial, times = times }
end

-- Did a run that goes on from the end of the best one get further? Only then the two become one: the first is changed.
local function gains(run, state)
  return is_better({ status = run.status, t_reached = run.t_reached, times = state.q.times }, state.best)
end

-- The second run behind the first.
local function joined(first, second, q)
  core.track_join(first.track, second.track)
  second.track, second.initial, second.times, second.t_start = first.track, first.initial, q.times, first.t_start
  second.question = first.question
  second.cpu_seconds, second.step_count = first.cpu_seconds + second.cpu_seconds, first.step_count + second.step_count
  rawset(second, "x", nil)
  table.insert(second.parts, 1, { solver = first.solver, t_from = first.parts[1].t_from, t = first.t_reached })
  return second
end

-- Does no ordinary run reach the end either? Then the solutions end, or are too hard to follow.
local function is_beyond(run, q)
  if run.status == "complete" then return false end
  local times = { q.times[1], q.times[#q.times] }
  local inner = require "ambit.sample".inner(q, DRAWS, 1, { t = times, cpu = math.max(1, run.cpu_seconds) })
  return inner and inner.failed >= inner.draws
end

-- May another solver be asked after this? Not where the run was stopped from outside, or where nothing is to be gained.
local function may_go_on(run) return is_through(run) or run.status == "unable" end

local function record_way(state, try)
  local last, from = state.tried[#state.tried], try.from
  local fields = { "solver", try.solver, "t", from and from.t_reached or state.q.times[1], "after", last.solver,
    "because", last.outcome }
  if try.pieces then table.move({ "pieces", try.pieces }, 1, 2, #fields + 1, fields) end
  core.record("way_back", fields)
end

-- One try: -> the run, is it the best one until now, is it good? Its records are kept only if it is the best.
local function try_one(state, try)
  local left, from = try.left or {}, try.from
  record_way(state, try)
  local is_cut = try.pieces or try.band
  left.patience = not is_cut and not try.reach and PATIENCE or nil -- pieces pass the instants late, all at once
  left.band = try.band
  if not try.band then
    left.due, left.reach = part_of(state.ends, try.pieces == PIECES[#PIECES]), try.reach or REACH
  elseif not try.is_counted then
    left.due = math.max(LEAST, MORE * state.first_seconds)
  end
  local run = state.ask(try, left)
  local gained = not from or gains(run, state)
  if from and gained then run = joined(from, run, state.q) end
  local good = gained and judge(run, state.q, state.hull, state.ends)
  local pieces = is_cut and run.pieces or nil
  state.tried[#state.tried + 1] = { solver = try.solver, pieces = pieces, outcome = describe(run), run = run }
  local better = gained and is_better(run, state.best)
  if better then state.best, state.by = run, try end
  return run, better, good
end

-- One after the other of the ways to go on, while there is CPU time left -> is the best run good, or was it stopped?
local function try_all(state, ways)
  for try in ways do
    if not try.band and part_of(state.ends) <= 0 then
      state.untried[#state.untried + 1] = { solver = try.solver, pieces = try.pieces }
    else
      core.records_hold()
      local called, run, better, good = pcall(try_one, state, try)
      core.records_release(called and better)
      if not called then error(run, 0) end
      if good or not may_go_on(run) then return true end
      if try.pieces and not better then return false end
    end
  end
  return false
end

-- The next best solvers, the first of which goes on from what the run reached, if that is tight.
local function other_solvers(state)
  local next_one = choice.proving(state.q.suggestion.others)
  local from = goes_on(state.best, state.q, state.ends) and state.best or nil
  return function()
    local other = next_one()
    if not other then return nil end
    local try = { solver = other.solver, reason = other.reason, from = from, left = from and rest_of(state.q, from) }
    from = nil
    return try
  end
end

-- What core.simulate cuts again: parts whose sets are wider than LOOSE allows, half of that on each side of the hull.
-- It is known what they take, so that this is counted: the same for the same hull, whatever the machine.
local function band_of(run, hull)
  local operations = run.report.operations
  local band = { lo = {}, hi = {}, limit = 0.5 * (LOOSE - 1), runs = operations > 0 and RUNS or PIECES[#PIECES],
    work = math.max(WORK, CUT * operations) }
  local counts = counted(run, hull)
  for k = 2, #hull.t do
    for i in ipairs(run.states) do
      local lo, hi = hull.lo[i][k], hull.hi[i][k]
      if not counts(i, k) then lo, hi = 0, 0 end
      band.lo[#band.lo + 1], band.hi[#band.hi + 1] = lo, hi
    end
  end
  return band
end

-- The best solver until now, which got through, with the data cut where its sets are too wide.
local function cut_where_wide(state)
  local reason = "%s; the data are cut where the sets are too wide whole"
  local try = { solver = state.by.solver, reason = reason:format(state.by.reason),
    band = band_of(state.best, state.hull.draws), is_counted = state.best.report.operations > 0, left = {} }
  return function()
    local own = try
    try = nil
    return own
  end
end

-- The best solver until now, with the data that matter most cut.
local function cut_data(state)
  local i = 0
  state.ends = budget_of_parts(state)
  if state.q.events then return function() end end
  local hull = is_through(state.best) and state.hull.draws
  if hull and #hull.t == #state.q.times then return cut_where_wide(state) end
  return function()
    i = i + 1
    local n = PIECES[i]
    if not n then return nil end
    return { solver = state.by.solver, pieces = n, left = { pieces = n },
      reason = ("%s; the data are cut into %d parts, since whole they get too wide"):format(state.by.reason, n) }
  end
end

-- The best run was stopped for its pace, and nobody got further: it is done again, for as long as it goes on steadily.
local function carry_on(state)
  local best, by, is_asked = state.best, state.by, false
  state.ends = core.cpu() + best.cpu_seconds / PART * AGAIN
  return function()
    if is_asked then return nil end
    is_asked = true
    return { solver = by.solver, reason = by.reason, reach = math.huge }
  end
end

-- q: a request with a suggestion; ask({ solver, reason }, changes) -> its run. changes: what is not as in the request.
function choice.solve(q, ask)
  local others = q.suggestion.others
  local began = core.cpu()
  local first = ask(q.suggestion, { patience = #others > 0 and PATIENCE or nil })
  local hull, first_seconds = {}, core.cpu() - began
  local ends = budget_after(first_seconds)
  if judge(first, q, hull, ends) or #others == 0 or not may_go_on(first) then return first end
  if q.run_options.pieces or q.run_options.cuts then return first end
  if is_beyond(first, q) then
    require "ambit.simulate.choice_reason".say_beyond(q, first)
    return first
  end
  local state = { q = q, ask = ask, hull = hull, ends = ends, first_seconds = first_seconds,
    best = first, by = q.suggestion, untried = {},
    tried = { { solver = first.solver, outcome = describe(first), run = first } } }
  local good = try_all(state, other_solvers(state))
  good = good or first.report.unknowns > 0 and try_all(state, cut_data(state))
  if not good and state.best.code == TOO_FAR and not state.by.pieces and not state.by.band and not state.by.from then
    try_all(state, carry_on(state))
  end
  local best = state.best
  if best.status == "unable" then
    require "ambit.simulate.choice_reason".add(q, best, state, choice.within)
  end
  for _, try in ipairs(state.tried) do try.run = nil end
  best.tried = state.tried
  return best
end

return choice
