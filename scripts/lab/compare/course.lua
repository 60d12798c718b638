-- compare/course.lua -- what a run proved along its time, as plain numbers: enclosures at common instants, the widest,
-- a track to draw.
local core = require "ambit.core"

local course = {}

local DRAWN = 200 -- instants of a track
local PIECES = 16 -- of a step, if there are few steps

-- Enclosures of all states within step i, or at its end; nil: the solver says nothing that is tight there.
local function enclosures(run, t)
  local i, is_end = core.track_find(run.track, t)
  if not i then return nil end
  local lo, hi = {}, {}
  for k in ipairs(run.states) do
    local x
    if is_end then x = core.track_value(run.track, i, k, false) else x = core.track_dense(run.track, i, k, t) end
    if not x or x:is_empty() then return nil end
    lo[k], hi[k] = x.lo, x.hi
  end
  return { lo = lo, hi = hi }
end

-- { [k] = { lo, hi } } for those of the instants that the run reached.
function course.at(run, instants)
  local list, first, last = {}, run.t_start, run.t_reached
  for k, t in ipairs(instants) do
    if t ~= first and (t - first) * (last - first) > 0 and math.abs(t - first) <= math.abs(last - first) then
      list[k] = enclosures(run, t)
    end
  end
  return list
end

-- The same over a bracket (instant.lua).
function course.over(run, t)
  local good, x = pcall(run.at, run, t.value)
  if not good then return nil end
  local lo, hi = {}, {}
  for k, name in ipairs(run.states) do lo[k], hi[k] = x[name].lo, x[name].hi end
  return { lo = lo, hi = hi }
end

local function ends_of(run)
  local list = {}
  for step in run:steps() do list[#list + 1] = step.number end
  return list
end

-- Equally many steps go into each place of the track, the widest of them stands for all; the last one stays.
local function thinned(ends, width)
  local list, n = {}, #ends
  local per = math.max(1, math.ceil(n / (DRAWN - 2)))
  for first = 1, n - 1, per do
    local widest = first
    for i = first + 1, math.min(first + per - 1, n - 1) do if width[i] > width[widest] then widest = i end end
    list[#list + 1] = widest
  end
  list[#list + 1] = n > 0 and n or nil
  return list
end

local function add(track, t, x)
  track.t[#track.t + 1] = t
  for k, set in ipairs(x) do
    track.lo[k][#track.t], track.hi[k][#track.t] = set.lo, set.hi
  end
end

local function values(run, i)
  local list, widest = {}, 0
  for k in ipairs(run.states) do
    list[k] = core.track_value(run.track, i, k, false)
    widest = math.max(widest, list[k]:width())
  end
  return list, widest
end

local function add_tube(track, k, x)
  track.tube.lo[k][#track.t], track.tube.hi[k][#track.t] = x and x.lo or 0 / 0, x and x.hi or 0 / 0
end

-- Where each state is from the end of step `first` - 1 on to that of step `last`: bounds of the tubes; NaN without one,
-- or where steps before it were not kept.
local function add_tubes(track, run, ends, first, last)
  local whole = core.track_step(run.track, ends[first]) == track.t[#track.t]
  for k in ipairs(run.states) do
    local all
    for i = first, whole and last or first - 1 do
      local x = core.track_value(run.track, ends[i], k, true)
      if not x then all = nil break end
      all = all and all:hull(x) or x
    end
    add_tube(track, k, all)
  end
end

-- A long step, cut into so many pieces in time by its dense enclosure: instants within it, and the tubes between them.
local function add_pieces(track, run, number, pieces)
  local from, _, to = track.t[#track.t], core.track_step(run.track, number)
  for j = 1, pieces do
    local t, till, inside = track.t[#track.t], j == pieces and to or from + (to - from) * (j / pieces), {}
    for k in ipairs(run.states) do
      add_tube(track, k, core.track_dense(run.track, number, k, math.min(t, till), math.max(t, till)))
      inside[k] = core.track_dense(run.track, number, k, till)
    end
    if j < pieces then add(track, till, inside) end
  end
end

-- The track { t, lo, hi, tube = { lo, hi } } from the start on, and the largest width of any state at any end of a
-- step. The tube at k holds at all times from t[k] to t[k + 1].
function course.track(run)
  local track, initial, start = { t = {}, lo = {}, hi = {}, tube = { lo = {}, hi = {} } }, run.initial(), {}
  for k, name in ipairs(run.states) do
    track.lo[k], track.hi[k], start[k] = {}, {}, initial[name]
    track.tube.lo[k], track.tube.hi[k] = {}, {}
  end
  add(track, run.t_start, start)
  local ends, width, largest = ends_of(run), {}, 0
  for i, number in ipairs(ends) do
    local _, widest = values(run, number)
    width[i], largest = widest, math.max(largest, widest)
  end
  for _, set in ipairs(start) do largest = math.max(largest, set:width()) end
  local before, pieces = 0, math.min(PIECES, (DRAWN - 2) // math.max(1, #ends))
  for _, i in ipairs(thinned(ends, width)) do
    local is_next = core.track_step(run.track, ends[i]) == track.t[#track.t]
    if pieces > 1 and is_next and core.track_dense(run.track, ends[i], 1, track.t[#track.t]) then
      add_pieces(track, run, ends[i], pieces)
    else
      add_tubes(track, run, ends, before + 1, i)
    end
    before = i
    local _, t = core.track_step(run.track, ends[i])
    add(track, t, (values(run, ends[i])))
  end
  return track, largest
end

return course
