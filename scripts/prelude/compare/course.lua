-- compare/course.lua -- what a run proved along its time, as plain numbers: enclosures at common instants, the widest,
-- a track to draw.
local core = require "ambit.core"

local course = {}

local DRAWN = 200 -- instants of a track

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
  local good, x = pcall(run.at, run, t.e)
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

-- The track { t, lo, hi } from the start on, and the largest width of any state at any end of a step.
function course.track(run)
  local track, initial, start = { t = {}, lo = {}, hi = {} }, run.initial(), {}
  for k, name in ipairs(run.states) do track.lo[k], track.hi[k], start[k] = {}, {}, initial[name] end
  add(track, run.t_start, start)
  local ends, width, largest = ends_of(run), {}, 0
  for i, number in ipairs(ends) do
    local _, widest = values(run, number)
    width[i], largest = widest, math.max(largest, widest)
  end
  for _, set in ipairs(start) do largest = math.max(largest, set:width()) end
  for _, i in ipairs(thinned(ends, width)) do
    local _, t = core.track_step(run.track, ends[i])
    add(track, t, (values(run, ends[i])))
  end
  return track, largest
end

return course
