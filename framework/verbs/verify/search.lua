-- verify/search.lua -- refining until every condition is decided or the budget is spent.
--
-- Boxes of the uncertain data that a run leaves open (verify/box.lua) are tried at single points (a violation there
-- refutes the condition: the point is data that the tolerances allow), then cut in two, the worst first. A condition is
-- proved when all boxes are, and the boxes cover the data.
local box = require "ambit.verify.box"
local carry = require "ambit.verify.carry"
local code = require "ambit.code"
local core = require "ambit.core"

local search = {}

local SINGLE = 12         -- most uncertain data that are tried one by one at their ends
local SHORTER = { 8, 64 } -- times as many steps,
local MOST_STEPS = 5000   -- but not more than so many
local OTHERS_MORE, OTHERS_LEAST = 10, 5 -- CPU time of another solver's run: times that of the first, and s at least
local WORTH = 0.8         -- of the gap that is open: what leaves less is an improvement
local TIGHTER, TIGHTEST = 1e-3, 1e-18 -- tolerances of the solver: factor, and where it stops to matter

local LEAST_WEIGHT = 1e-3 -- of a datum that moves no condition from the middle: it may do so elsewhere
-- a cut that gains less than this share of the gap makes its datum's weight so much less
local DULL, DULLER = 0.01, 0.25

-- -- points

local function middle(lo, hi)
  local m = 0.5 * lo + 0.5 * hi
  return math.min(math.max(m, lo), hi)
end

local function centre(b)
  local at = {}
  for j, lo in ipairs(b.lo) do at[j] = middle(lo, b.hi[j]) end
  return at
end

local function try_point(job, at)
  at = box.allowed(job, at)
  local point = box.run(job, { lo = at, hi = at })
  box.note(job, point)
  return point
end

-- The ends of each datum, the others in the middle, and for each open condition the corner where all are worst; and how
-- much each datum moves the conditions, which says where to cut.
local function try_ends(job, b, mid)
  local worst, moved = {}, {}
  for k in ipairs(job.conditions) do worst[k] = centre(b) end
  for j = 1, #b.lo do
    if box.is_spent(job) or not box.is_open(job, b) then return end
    local ends = {}
    for e, value in ipairs { b.lo[j], b.hi[j] } do
      local at = centre(b)
      at[j] = value
      ends[e] = try_point(job, at)
    end
    for k in ipairs(job.conditions) do
      local low, high, between = ends[1][k].hi, ends[2][k].hi, mid[k].hi
      local effect = math.max(math.abs(low - between), math.abs(high - between), math.abs(low - high))
      moved[k] = moved[k] or {}
      moved[k][j] = effect < math.huge and effect or 0
      worst[k][j] = low > high and b.lo[j] or b.hi[j]
    end
  end
  job.moved = moved
  for k, condition in ipairs(job.conditions) do
    if not condition.status and not b[k].holds and not box.is_spent(job) then try_point(job, worst[k]) end
  end
end

-- -- cutting

-- The datum that matters most in this box: by how much it moved the worst condition, relative to its part of the range,
-- and less where the last cuts across it gained nothing.
local function choose(job, b)
  local effect = {}
  for k, condition in ipairs(job.conditions) do
    if job.moved and not condition.status and not b[k].holds then
      for j, moved in ipairs(job.moved[k]) do effect[j] = math.max(effect[j] or 0, moved) end
    end
  end
  local most = 0
  for _, moved in pairs(effect) do most = math.max(most, moved) end
  local best, gain
  for j, lo in ipairs(b.lo) do
    local hi, m = b.hi[j], middle(lo, b.hi[j])
    if m > lo and m < hi then
      local share = (hi - lo) / (job.hi[j] - job.lo[j])
      local weight = most > 0 and math.max((effect[j] or 0) / most, LEAST_WEIGHT) or 1
      weight = weight * (job.worth[j] or 1)
      if not best or share * weight > gain then best, gain = j, share * weight end
    end
  end
  return best
end

local function half(b, j, lo, hi)
  local part = { lo = table.move(b.lo, 1, #b.lo, 1, {}), hi = table.move(b.hi, 1, #b.hi, 1, {}), part_of = b }
  part.lo[j], part.hi[j] = lo, hi
  return part
end

-- The worst box of the list, taken out; of equals the one that was made first.
local function take_worst(job, boxes)
  local at, most
  for i, b in ipairs(boxes) do
    local bad = box.badness(job, b)
    if not at or bad > most then at, most = i, bad end
  end
  return table.remove(boxes, at)
end

local function still_open(job, boxes)
  local list = {}
  for _, b in ipairs(boxes) do
    if box.is_open(job, b) then list[#list + 1] = b else job.done[#job.done + 1] = b end
  end
  return list
end

-- Are the halves of a box nearer to a proof than it was? Where nothing is bounded, a run that gets further is.
local function is_gain(job, b, parts)
  local worst, reached, first = -math.huge, math.huge, job.times[1]
  for _, part in ipairs(parts) do
    worst = math.max(worst, box.badness(job, part))
    reached = math.min(reached, math.abs(part.outcome.t_reached - first))
  end
  local before = box.badness(job, b)
  if before < math.huge then return before - worst > DULL * box.gap(job, b) end
  return worst < math.huge or reached > (1 + DULL) * math.abs(b.outcome.t_reached - first)
end

-- Both halves across datum j, and the middle of the second.
local function cut_box(job, b, j, boxes)
  local m = middle(b.lo[j], b.hi[j])
  local parts = { half(b, j, b.lo[j], m), half(b, j, m, b.hi[j]) }
  for _, part in ipairs(parts) do
    box.run(job, part)
    if job.sound_points then box.note(job, part) end
    boxes[#boxes + 1] = part
  end
  if not is_gain(job, b, parts) then job.worth[j] = (job.worth[j] or 1) * DULLER end
  local last = boxes[#boxes]
  if job.sound_points and box.is_open(job, last) and not box.is_spent(job) then try_point(job, centre(last)) end
end

-- What one half of the root gains across each datum, by the most: conditions may not depend on what makes their bounds
-- wide, and a cut across a datum that gains nothing leaves two boxes in the place of one.
local function probe(job, root)
  local gains, most = {}, 0
  for j, lo in ipairs(root.lo) do
    if box.is_spent(job) then return end
    local part = box.run(job, half(root, j, lo, middle(lo, root.hi[j])))
    gains[j] = math.max(0, box.badness(job, root) - box.badness(job, part))
    most = math.max(most, gains[j])
  end
  if not (most > DULL * box.gap(job, root) and most < math.huge) then return end
  job.moved = nil
  for j, gain in ipairs(gains) do job.worth[j] = math.max(gain / most, LEAST_WEIGHT) end
end

local function cut(job, root)
  job.worth = {}
  if #job.lo > 1 and #job.lo <= SINGLE and box.is_open(job, root) then probe(job, root) end
  local boxes, stuck = still_open(job, { root }), {}
  while #boxes > 0 and not box.is_spent(job) do
    local b = take_worst(job, boxes)
    local j = choose(job, b)
    if j then cut_box(job, b, j, boxes) else stuck[#stuck + 1] = b end
    boxes = still_open(job, boxes)
  end
  return table.move(stuck, 1, #stuck, #boxes + 1, boxes)
end

-- -- shorter steps, between which solvers know less than at their ends

-- The times of the request and n equal parts of the whole span.
local function refined(times, n)
  local list, first, last = {}, times[1], times[#times]
  local direction = last > first and 1 or -1
  local i = 1
  for k = 0, n do
    local t = k == 0 and first or k == n and last or first + (last - first) * (k / n)
    while i <= #times and times[i] * direction <= t * direction do
      list[#list + 1], i = times[i], i + 1
    end
    if list[#list] ~= t and t * direction < last * direction then list[#list + 1] = t end
  end
  return list
end

-- The whole box once more in another way, which `undo` takes back if little is gained. -> the tighter root, gained?
local function again(job, root, undo)
  local before = box.gap(job, root)
  local next_root = box.run(job, { lo = root.lo, hi = root.hi, part_of = root })
  box.note(job, next_root)
  local complete, after = next_root.outcome.status == "complete", box.gap(job, next_root)
  local gained = complete and after < math.huge and after <= WORTH * before
  if not gained then undo() end
  return complete and next_root or root, gained
end

local function is_refinable(job, root)
  return box.is_open(job, root) and root.outcome.status == "complete" and not box.is_spent(job)
end

local function shorten(job, root)
  local steps, gained = job.report.steps, true
  for _, factor in ipairs(SHORTER) do
    if not gained or not is_refinable(job, root) or factor * steps > MOST_STEPS then break end
    local before = job.times
    job.times = refined(job.request.times, factor * steps)
    root, gained = again(job, root, function() job.times = before end)
  end
  return root
end

local function carry_conditions(job, root)
  if not is_refinable(job, root) or #job.lo == 0 or job.request.system.sampled then return root end
  local before = job.request
  local function undo() job.request, job.outputs = before, {} end
  job.request, job.outputs = carry.of(before, job.conditions)
  local good, better = pcall(again, job, root, undo)
  if good then return better end
  if code.is_broken(better) then error(better, 0) end
  undo() -- the solver refuses the rate of a condition, which is no reason to refuse the condition
  return root
end

-- -- other solvers, where the one that suits best left something open

-- -> the root, whether another solver took over
local function ask_others(job, root)
  if #job.others == 0 or not box.is_open(job, root) then return root, false end
  local choice = require "ambit.simulate.choice" -- seldom needed
  local limit, taken = math.max(OTHERS_LEAST, OTHERS_MORE * (core.cpu() - job.start)), false
  for other in choice.proving(job.others) do
    if not box.is_open(job, root) or box.is_spent(job) then break end
    local request, outputs, report, gained, was_limit = job.request, job.outputs, job.report, nil, nil
    job.request, job.outputs, job.report = job.asked.by(other.solver), {}, nil
    was_limit = choice.within(limit, function()
      root, gained = again(job, root, function() job.request, job.outputs, job.report = request, outputs, report end)
    end)
    taken = taken or gained
    if was_limit then job.stopped = false end
  end
  if taken then job.tolerance = job.tolerance_of(job.request) end
  return root, taken
end

-- -- without uncertain data there is only the solver to be made more careful

local function tighten(job, root)
  local q = job.request
  while job.tolerance and job.tolerance * TIGHTER >= TIGHTEST and box.is_open(job, root) and not box.is_spent(job) do
    job.tolerance = job.tolerance * TIGHTER
    local options = table.move(q.options, 1, #q.options, 1, {})
    for i = #options - 1, 1, -2 do
      if options[i] == "tolerance" then
        table.remove(options, i + 1)
        table.remove(options, i)
      end
    end
    options[#options + 1], options[#options + 2] = "tolerance", core.literal(job.tolerance)
    q.options = options
    root = box.run(job, { lo = root.lo, hi = root.hi, part_of = root })
    box.note(job, root)
  end
  return { root }
end

-- -- verdicts

local function conclude(job, boxes)
  table.move(job.done, 1, #job.done, #boxes + 1, boxes)
  job.nowhere = boxes[1].outcome -- the boxes cover the data: there is no solution if there is none in any
  for _, b in ipairs(boxes) do job.nowhere = b.outcome.impossible and job.nowhere end
  for k, condition in ipairs(job.conditions) do
    local all, worst = true, nil
    for _, b in ipairs(boxes) do
      all = all and b[k].holds
      if not worst or b[k].hi > worst[k].hi then worst = b end
    end
    condition.hi, condition.worst = job.nowhere and -math.huge or worst[k].hi, worst
    all = all and condition.hi > -math.huge -- some part may hold a start: nothing is said about an empty set
    condition.status = condition.status or job.nowhere and "impossible" or all and "proved" or "undecided"
  end
end

-- From what costs least to what costs most.
local function refine(job, root)
  local mid
  if root.outcome.impossible then return { root } end
  if #job.lo > 0 and job.sound_points and box.is_open(job, root) and not box.is_spent(job) then
    mid = try_point(job, centre(root))
  end
  root = carry_conditions(job, shorten(job, root))
  local by_another
  root, by_another = ask_others(job, root)
  if by_another then root = carry_conditions(job, shorten(job, root)) end
  if not box.is_open(job, root) or box.is_spent(job) then return { root } end
  if #job.lo == 0 then return tighten(job, root) end
  if mid and #job.lo <= SINGLE then try_ends(job, root, mid) end
  return cut(job, root)
end

-- A run broke its contract: nothing that was found is believed.
local function forget(job, outcome)
  job.broken = outcome
  for _, condition in ipairs(job.conditions) do
    condition.status, condition.lo, condition.hi = "broken", -math.huge, math.huge
  end
end

local function decide(job)
  job.runs, job.done, job.start, job.times, job.outputs = 0, {}, core.cpu(), job.request.times, {}
  job.tolerance = job.tolerance_of(job.request)
  for _, condition in ipairs(job.conditions) do condition.lo = -math.huge end
  local root = box.run(job, { lo = job.lo, hi = job.hi })
  box.note(job, root)
  local boxes = refine(job, root)
  job.spent = box.is_spent(job)
  conclude(job, boxes)
end

function search.run(job)
  local broken = code.until_given_up(decide, job)
  if broken then forget(job, broken) end
end

return search
