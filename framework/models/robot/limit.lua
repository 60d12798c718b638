-- robot/limit.lua -- the limits that a robot's file states: by how much each is exceeded, events for runs that are to
-- notice it, and stops that push back.
local check = require "ambit.check"
local core = require "ambit.core"
local frame = require "ambit.frame"

local methods = {}

-- Coordinate, speed and unit of a joint with one of each; nil: it has several.
local function motion(self, joint)
  local part, port = frame.place(self, joint, "joint", "limits")
  for _, out in ipairs(self.declared[part].outs) do
    if out.index == port and (out.coordinates ~= 1 or out.dof ~= 1) then return nil end
  end
  local q = core.pull(self.handle, part, port, core.COORDINATE, 1)[1]
  local v = core.pull(self.handle, part, port, core.RATE, 1)[1]
  return q, v, core.coordinate_unit(self.handle, q)
end

-- f(name, joint, limits, q, v, unit of q; nil: it follows another joint)
local function each(self, f)
  local limits = self:limits()
  for _, name in ipairs(check.sorted(limits)) do
    local joint = rawget(self.joints, name)
    local q, v, unit
    if joint then q, v, unit = motion(self, joint) end
    if q then f(name, joint, limits[name], q, v, unit) end
  end
end

-- { ["elbow upper"] = q - upper, ["elbow lower"] = lower - q, ["elbow velocity"] = abs(q') - velocity }: above 0 where
-- a limit is exceeded, so that m:verify { safe = m:limit_excess() } proves that none is.
function methods:limit_excess()
  local list = {}
  each(self, function(name, _, limits, q, v)
    if limits.lower then list[name .. " lower"] = limits.lower - q end
    if limits.upper then list[name .. " upper"] = q - limits.upper end
    if limits.velocity then list[name .. " velocity"] = core.abs(v) - limits.velocity end
  end)
  return list
end

-- Events for simulate: one for each limit, where it is passed from inside.
function methods:limit_events()
  local list = {}
  each(self, function(name, _, limits, q, v)
    local function add(what, g) list[#list + 1] = { name = name .. " " .. what, g = g, direction = "rising" } end
    if limits.lower then add("lower", limits.lower - q) end
    if limits.upper then add("upper", q - limits.upper) end
    if limits.velocity then
      add("velocity", v - limits.velocity)
      add("velocity, backwards", -v - limits.velocity)
    end
  end)
  return list
end

-- m:limit_stops { stiffness, slide_stiffness, damping }: beyond its limits a joint is pushed back by stiffness times
-- the excess e, times (1 + damping e') (Hunt & Crossley, J. Appl. Mech. 42 (1975)); the law holds as long as it leaves
-- the stop no faster than 1/damping. Returns the names of these joints.
function methods:limit_stops(t)
  check.table(t, "limit_stops")
  check.keys(t, { "stiffness", "slide_stiffness", "damping" }, "limit_stops")
  local names = {}
  each(self, function(name, joint, limits, q, v, unit)
    local key = unit == "m" and "slide_stiffness" or "stiffness"
    if not unit or not (limits.lower or limits.upper) then return end
    if t[key] == nil then
      check.fail("limit_stops: %s is missing: the joint `%s` %s", key, name, unit == "m" and "slides" or "turns")
    end
    local force = unit == "m" and "N" or "N m"
    local k = core.expression(t[key], ("%s/%s"):format(force, unit), "limit_stops: " .. key)
    local c = core.expression(t.damping or 0, ("s/%s"):format(unit), "limit_stops: damping")
    local push = core.expression(0)
    if limits.upper then push = push - k * core.max(q - limits.upper, 0) * (1 + c * v) end
    if limits.lower then push = push + k * core.max(limits.lower - q, 0) * (1 - c * v) end
    self:joint_torque { joint = joint, [unit == "m" and "force" or "torque"] = core.in_unit(push, force),
      name = name .. " stop" }
    names[#names + 1] = name
  end)
  return names
end

return { methods = methods }
