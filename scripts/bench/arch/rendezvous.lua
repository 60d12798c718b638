-- rendezvous.lua: SPRE22, a spacecraft that comes to a station on a geostationary orbit: approach, from 100 m on an
-- attempt with a stiffer controller, and a passive drift when that is given up at some time in [120, 150] min. Metres
-- and minutes.
--
-- While it attempts it stays in the line of sight, y >= x tan 20 deg, and below 3.3 m/min; while it drifts it stays
-- out of the square of +-2 m about the station. The time of giving up is cut into parts, in each of which it is one
-- more unknown: every solution is followed with its own. The distance from the line of sight is a state, so that it
-- keeps what x and y have in common. The steps in which some solutions have switched and others have not know too
-- little of the speed: there the bound is not proved.
local ambit = require "ambit"
local n = ambit.number

local FIRST, LAST, END = 120, 150, 200
local mu, r, mass = n "3.986e14" * 60 ^ 2, n "42164e3", 500
local rate = ambit.sqrt(mu / r ^ 3)
local gains = {
  approach = { { "-28.8287", "0.1005", "-1449.9754", "0.0046" }, { "-0.087", "-33.2562", "0.00462", "-1451.5013" } },
  attempt = { { "-288.0288", "0.1312", "-9614.9898", "0" }, { "-0.1312", "-288", "0", "-9614.9883" } },
}

local slope = ambit.sin(ambit.degrees(20)) / ambit.cos(ambit.degrees(20))

local function orbit(gain)
  return ambit.ode { states = { "x", "y", "vx", "vy", "sight" }, equations = function(s)
    local push = { 0, 0 }
    for i, k in ipairs(gain or {}) do
      push[i] = (n(k[1]) * s.x + n(k[2]) * s.y + n(k[3]) * s.vx + n(k[4]) * s.vy) / mass
    end
    local pull = mu / ((r + s.x) ^ 2 + s.y ^ 2) ^ n "1.5"
    return { x = s.vx, y = s.vy, sight = s.vy - slope * s.vx,
      vx = rate ^ 2 * s.x + 2 * rate * s.vy + mu / r ^ 2 - pull * (r + s.x) + push[1],
      vy = rate ^ 2 * s.y - 2 * rate * s.vx - pull * s.y + push[2] }
  end }
end

local x, y = ambit.between(-925, -875), ambit.between(-425, -375)
local initial = { x = x, y = y, vx = ambit.between(0, 5), vy = ambit.between(0, 5), sight = y - slope * x }

-- All that give up between two times.
local function follow(from, to)
  return ambit.hybrid {
    modes = {
      approach = { orbit(gains.approach), guards = { { g = function(s) return s.x + 100 end, direction = "rising",
        name = "near", to = "attempt" } } },
      attempt = { orbit(gains.attempt), guards = { { g = function(_, _, t) return t - ambit.between(from, to) end,
        direction = "rising", name = "give up", to = "drift" } } },
      drift = { orbit() },
    },
    mode = "approach", initial = initial, t = { 0, END }, solver = "taylor_model", order = 2,
    tolerance = 1e-8, pieces_max = 1,
  }
end

-- Does a part of a run keep its conditions? Steps in which solutions switch count for both modes.
local function is_safe(run, near, last)
  for step in run:steps() do
    local s = step.tube
    if step.t > near.lo and step.t_from < last.hi then
      local fast = s.vx:mag() ^ 2 + s.vy:mag() ^ 2 >= 3.3 ^ 2
      if s.sight.lo < 0 or fast then return false, ("at %g min in the attempt"):format(step.t) end
    end
    if step.t > last.lo and s.x.lo <= 2 and s.x.hi >= -2 and s.y.lo <= 2 and s.y.hi >= -2 then
      return false, ("at %g min in the drift"):format(step.t)
    end
  end
  return true
end

local function run()
  local row = { status = "complete", t_reached = END, steps = 0, seconds = 0, proved = true, widths = {} }
  for from = FIRST, LAST - 1 do
    local part = follow(from, from + 1)
    row.steps, row.seconds = row.steps + part.step_count, row.seconds + part.cpu_seconds
    if part.status ~= "complete" then
      row.status, row.t_reached, row.reason, row.proved = part.status, part.t_reached, part.reason, false
      return row
    end
    local safe, reason = is_safe(part, part.events[1].t, part.events[2].t)
    if not safe then row.proved, row.reason = false, reason end
    for _, name in ipairs { "x", "y" } do
      row.widths[name] = math.max(row.widths[name] or 0, part.x[name]:width())
    end
  end
  return row
end

return { { problem = "SPRE22", property = "line of sight, below 3.3 m/min, then clear of the station", run = run } }
