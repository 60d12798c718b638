-- rendezvous.lua: SPRE22, a spacecraft that comes to a station on a geostationary orbit: approach, from 100 m on an
-- attempt with a stiffer controller, and a passive drift when that is given up at some time T in [120, 150] min. Metres
-- and minutes.
--
-- While it attempts it stays in the line of sight, |y| <= -x tan 20 deg, and below 3.3 m/min; while it drifts it stays
-- out of the square of +-2 m about the station.
--
-- A switch is met at another time by each solution, and while some have switched and others have not little is known of
-- the speed. So each phase is run in its own clock, by which all solutions switch at once: the approach by the share of
-- the way to x = -100 m, once all of them come nearer; the attempt by the minutes since the switch; the drift by the
-- share of what is left to the end. How long an attempt lasts is cut into parts, in each of which what it lasts beyond
-- the part's beginning is one datum more, and its share the clock: every solution is followed with its own. All lengths
-- from 120 min less the latest switch to 150 min less the earliest are taken with all starts, which is more than asked.
-- Minutes of a share are functions of the data like the states. The distance from the line of sight is a state, so that
-- it keeps what x and y have in common.
local ambit = require "ambit"
local condense = require "ambit.leg.condense"
local n = ambit.number

local FIRST, LAST, END = 120, 150, 200
local PART = 1 -- min
local mu, r, mass = n "3.986e14" * 60 ^ 2, n "42164e3", 500
local rate = ambit.sqrt(mu / r ^ 3)
local gains = {
  approach = { { "-28.8287", "0.1005", "-1449.9754", "0.0046" }, { "-0.087", "-33.2562", "0.00462", "-1451.5013" } },
  attempt = { { "-288.0288", "0.1312", "-9614.9898", "0" }, { "-0.1312", "-288", "0", "-9614.9883" } },
}
local slope = ambit.sin(ambit.degrees(20)) / ambit.cos(ambit.degrees(20))
local SLOPE = 0.3639 -- below tan 20 deg

-- `pace(s)`: minutes of one unit of the clock. `stretch` keeps what it needs to know of the start of the phase, `t` is
-- the time in minutes.
local function orbit(gain, pace)
  local states = { "x", "y", "vx", "vy", "sight", "t", "stretch" }
  return ambit.ode { states = states, equations = function(s)
    local push = { 0, 0 }
    for i, k in ipairs(gain or {}) do
      push[i] = (n(k[1]) * s.x + n(k[2]) * s.y + n(k[3]) * s.vx + n(k[4]) * s.vy) / mass
    end
    local pull, minutes = mu / ((r + s.x) ^ 2 + s.y ^ 2) ^ n "1.5", pace(s)
    return { x = s.vx * minutes, y = s.vy * minutes, sight = (s.vy - slope * s.vx) * minutes,
      vx = (rate ^ 2 * s.x + 2 * rate * s.vy + mu / r ^ 2 - pull * (r + s.x) + push[1]) * minutes,
      vy = (rate ^ 2 * s.y - 2 * rate * s.vx - pull * s.y + push[2]) * minutes, t = minutes, stretch = 0 }
  end }
end

local function minute() return 1 end
local function way(s) return s.stretch / s.vx end -- stretch: metres to x = -100
local function share(s) return s.stretch end      -- stretch: minutes

-- A run from `initial`, noted in `row`; nil if it does not come to its end.
local function follow(row, system, initial, duration)
  local run = ambit.simulate { system, initial = initial, t = { 0, duration }, solver = "taylor_model", order = 2,
    pieces_max = 1, tolerance = 1e-8 }
  row.steps, row.seconds = row.steps + run.step_count, row.seconds + run.cpu_seconds
  if run.status == "complete" then return run end
  row.status, row.t_reached, row.reason, row.proved = run.status, run.x.t.lo, run.reason, false
end

-- The set at the end of a run, to go on from; what was added on the way is kept in few unknowns beside `data`.
local function going_on(run, data, stretch)
  local set, names, list = run:set(), run.states, {}
  for i, name in ipairs(names) do list[i] = set[name] end
  local initial = {}
  for i, e in ipairs(condense.few(list, data)) do initial[names[i]] = e end
  if stretch then initial.stretch = stretch(initial) end
  return initial
end

local function is_in_sight(s) return s.sight.lo >= 0 and s.y.hi <= -SLOPE * s.x.hi and s.x.hi < 0 end
local function is_slow(s) return s.vx:mag() ^ 2 + s.vy:mag() ^ 2 < 3.3 ^ 2 end
local function is_clear(s) return s.x.lo > 2 or s.x.hi < -2 or s.y.lo > 2 or s.y.hi < -2 end

-- Do all steps that some solution begins before `last` keep this? Else `row` tells where the first does not.
local function keeps(row, run, condition, what, last)
  for step in run:steps() do
    if step.tube.t.lo < last and not condition(step.tube) then
      row.reason = row.reason or ("%s is not proved near %.5g min"):format(what, step.tube.t:mid())
      row.proved = false
      return
    end
  end
end

local function keeps_attempt(row, run)
  keeps(row, run, is_in_sight, "the line of sight", LAST)
  keeps(row, run, is_slow, "the speed", LAST)
end

-- those that give up between `from` and `from` + PART minutes after the switch
local function give_up(row, attempt, data)
  local more = ambit.between(0, PART)
  local rest = follow(row, orbit(gains.attempt, share), going_on(attempt, data, function() return more end), 1)
  if not rest then return end
  keeps_attempt(row, rest)
  local left = going_on(rest, { more, table.unpack(data) }, function(s) return END - s.t end)
  local drift = follow(row, orbit(nil, share), left, 1)
  if not drift then return end
  keeps(row, drift, is_clear, "the distance from the station", END)
  for _, name in ipairs { "x", "y" } do
    row.widths[name] = math.max(row.widths[name] or 0, drift.x[name]:width())
  end
end

-- all that start from these positions
local function from(row, x, y)
  local vx, vy = ambit.between(0, 5), ambit.between(0, 5)
  local data = { x, y, vx, vy }
  local start = follow(row, orbit(gains.approach, minute), { x = x, y = y, vx = vx, vy = vy, sight = y - slope * x,
    t = 0, stretch = 0 }, 2)
  local near = start and follow(row, orbit(gains.approach, way),
    going_on(start, data, function(s) return -100 - s.x end), 1)
  if not near then return end
  local first = math.floor((FIRST - near.x.t.hi) / PART) * PART
  local attempt, after = follow(row, orbit(gains.attempt, minute), going_on(near, data), first), first
  if attempt then keeps_attempt(row, attempt) end
  while attempt and row.proved and after < LAST - near.x.t.lo do
    give_up(row, attempt, data)
    attempt, after = follow(row, orbit(gains.attempt, minute), going_on(attempt, data), PART), after + PART
  end
end

-- The start in four parts, which together are all of it: of the whole the distance from the line of sight is known too
-- roughly in the end, where 0.5 m of it are left.
local function run()
  local row = { status = "complete", t_reached = END, steps = 0, seconds = 0, proved = true, widths = {} }
  for _, x in ipairs { { -925, -900 }, { -900, -875 } } do
    for _, y in ipairs { { -425, -400 }, { -400, -375 } } do
      if row.proved then from(row, ambit.between(x[1], x[2]), ambit.between(y[1], y[2])) end
    end
  end
  return row
end

return { { problem = "SPRE22", property = "line of sight, below 3.3 m/min, then clear of the station", run = run } }
