-- poincare/once.lua -- one return to a section, from a set that is known as expressions of the uncertain data.
local core = require "ambit.core"
local leg = require "ambit.leg"
local surface = require "ambit.leg.surface"

-- From x at time t (expressions). Times of a leg count from 0. -> the set on the section, the event; or nil, why not,
-- status, code
return function(q, system, g, x, t, latest)
  local start = core.evaluate({ expressions = { t } })[1]
  local list = { { g = g, name = "section", direction = q.direction, stop = true } }
  local found = leg.to_event(q, system, x, { 0.0, latest - start.lo }, list, { true })
  if found.status == "complete" then
    return nil, ("some solutions do not return to the section by t = %s"):format(core.literal(latest)), "unable",
      "unable.event"
  elseif found.status ~= "event" then
    return nil, found.reason, found.status, found.code
  end
  local image = surface.onto(q, system, g, found.x, t + found.t)
  if image.run.status ~= "complete" then
    return nil, "on the way onto the section: " .. image.run.reason, image.run.status, image.run.code
  end
  if image.when.hi > latest then
    return nil, ("some solutions do not return to the section by t = %s"):format(core.literal(latest)), "unable",
      "unable.event"
  end
  return image, found.event
end
